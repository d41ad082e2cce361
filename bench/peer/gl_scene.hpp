// A bench scene in OpenGL ES: buffers, textures, shaders.
#pragma once

#include "bench/peer/gl_shaders.hpp"
#include "bench/peer/scenes.hpp"

#include <string>

namespace halflit::peer {

/// Storage of textures. rgba16: halflit's own texels. srgb8: each of halflit's levels rounded to 8 bits, colours as sRGB, as most users
/// would have it.
enum class TextureStorage { rgba16, srgb8 };
/// The power of highlights. usual: by the function pow; special: whole exponents by products, as someone who knows them would write it.
enum class PeerShader { usual, special };

struct GlSceneOptions {
    TextureStorage storage = TextureStorage::rgba16;
    PeerShader shader = PeerShader::usual;
    PeerOutputs outputs = PeerOutputs::colour;
};

/// Belongs to the context that is current when it is made, and to its last day: nothing is freed before.
class GlScene {
public:
    /// Uploads a scene and compiles its shaders. Fails with the driver's reason.
    static bool make(const BenchScene& bench, const GlSceneOptions& options, GlScene& out, std::string& reason);

    /// The view of the frames that follow. sample: where a pixel is looked at, from its centre, as a part of half the picture; y down.
    void look(const Camera& camera, float aspect, Vec2f sample = {}) const;
    /// Draws into the bound framebuffer; with a depth pre-pass the colours are computed where depths are equal.
    void draw(bool depth_first) const;

private:
    /// A program, and the places of what differs from view to view.
    struct Program {
        unsigned name = 0;
        int clip_from_world = -1, eye = -1;
        bool make(const std::string& vertex, const std::string& fragment, std::string& reason);
    };
    Program program_, depth_program_;
    unsigned vertex_array_ = 0;
    int corner_count_ = 0;
};

}  // namespace halflit::peer
