// The peer: visible triangles by Mesa's llvmpipe.
#pragma once

#include "halflit/math.hpp"
#include "tests/peer/mesa_context.hpp"

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

    [[nodiscard]] const std::string& renderer() const { return context_->renderer(); }

    /// Draws the triangles in order without a depth test, given in clip coordinates. Row 0 is the top row; 0 where nothing is drawn,
    /// else 1 + the triangle's number.
    [[nodiscard]] std::vector<std::uint32_t> ids(int width, int height, std::span<const Vec4f> clip_positions);

private:
    Mesa() = default;
    std::unique_ptr<MesaContext> context_;
    unsigned program_ = 0;
};

}  // namespace halflit::peer
