// A bench scene in OpenGL ES: buffers, textures, shaders.
#pragma once

#include "bench/peer/scenes.hpp"

#include <string>

namespace halflit::peer {

/// Storage of textures. rgba16: halflit's own texels. srgb8: each of halflit's levels rounded to 8 bits, colours as sRGB, as most users
/// would have it.
enum class TextureStorage { rgba16, srgb8 };
/// The power of highlights. usual: by the function pow; special: whole exponents by products, as someone who knows them would write it.
enum class PeerShader { usual, special };

/// Belongs to the context that is current when it is made, and to its last day: nothing is freed before.
class GlScene {
public:
    /// Uploads a scene and compiles its shaders. Fails with the driver's reason.
    static bool make(const BenchScene& bench, float aspect, TextureStorage storage, PeerShader shader, GlScene& out, std::string& reason);

    /// Clears the bound framebuffer and draws into it; with a depth pre-pass the colours are computed where depths are equal.
    void draw(bool depth_first) const;

private:
    unsigned program_ = 0, depth_program_ = 0, vertex_array_ = 0;
    int index_count_ = 0;
};

}  // namespace halflit::peer
