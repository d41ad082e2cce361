// Off-screen target in OpenGL ES: 8-bit colours that the driver encodes as sRGB, and float depth.
#pragma once

#include "bench/peer/planes.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::peer {

/// Waits until the frame is drawn.
void wait_until_drawn();

class GlTarget {
public:
    /// samples: 1, or those of multisampling, which resolve() averages in linear light.
    static bool make(int width, int height, int samples, GlTarget& out, std::string& reason);

    /// Binds the framebuffer that is drawn into, and clears it.
    void begin() const;
    /// Averages samples. Before read().
    void resolve() const;
    /// Copies the picture into memory, four bytes a pixel.
    void read(std::vector<std::uint8_t>& rgba8) const;

private:
    int width_ = 0, height_ = 0, samples_ = 1;
    unsigned drawn_ = 0, resolved_ = 0;
};

/// Off-screen target for planes, one sample a pixel: those of PeerOutputs, each in a buffer of its own, and colours if wanted. In one
/// buffer of four numbers a pixel they are no faster.
class GlPlanes {
public:
    static bool make(int width, int height, bool with_colour, GlPlanes& out, std::string& reason);

    /// Binds the framebuffer, and clears it.
    void begin() const;
    /// Copies the planes into memory. Colours stay as they are if there are none.
    void read(Planes& planes) const;

private:
    int width_ = 0, height_ = 0;
    bool with_colour_ = false;
    unsigned name_ = 0;
};

}  // namespace halflit::peer
