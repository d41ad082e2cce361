// The peer: Mesa's llvmpipe, off screen through EGL without a window system.
#pragma once

#include "halflit/math.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace halflit::peer {

class Mesa {
public:
    /// Null with a reason when this machine has no software OpenGL ES 3 by llvmpipe.
    static std::unique_ptr<Mesa> create(std::string& reason);
    ~Mesa();

    [[nodiscard]] const std::string& renderer() const { return renderer_; }

    /// Draws the triangles in order without a depth test, given in clip coordinates. Row 0 is the top row; 0 where nothing is drawn,
    /// else 1 + the triangle's number.
    [[nodiscard]] std::vector<std::uint32_t> ids(int width, int height, std::span<const Vec4f> clip_positions);

private:
    Mesa() = default;
    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string renderer_;
    unsigned program_ = 0;
};

}  // namespace halflit::peer
