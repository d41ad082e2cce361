// Off-screen target in OpenGL ES: 8-bit colours that the driver encodes as sRGB, and float depth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::peer {

class GlTarget {
public:
    /// samples: 1, or those of multisampling, which resolve() averages in linear light.
    static bool make(int width, int height, int samples, GlTarget& out, std::string& reason);

    /// Binds the framebuffer that is drawn into.
    void bind() const;
    /// Ends a frame: averages samples, and waits until all is drawn.
    void finish() const;
    /// Copies the picture into memory, four bytes a pixel.
    void read(std::vector<std::uint8_t>& rgba8) const;

private:
    int width_ = 0, height_ = 0, samples_ = 1;
    unsigned drawn_ = 0, resolved_ = 0;
};

}  // namespace halflit::peer
