// Flags of a picture, and scenes made by code, decoded from a fuzz input.
#pragma once

#include "tests/fuzz/input.hpp"

#include "halflit/environment.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"

#include <optional>

namespace halflit::fuzz {

struct RenderFlags {
    int width = 1, height = 1;
    std::size_t padding = 0;  ///< pixels between rows
    bool bgra = false, premultiplied = false, planes = false;
    bool own_camera = false;   ///< of the flags; false: as auto_setup() chooses
    bool environment = false;  ///< lit by a small image
    bool scalar_twin = false;  ///< draw again by scalar code, other tiles and two threads: the same bits
    bool frame_twin = false;   ///< draw again by the same Renderer: the same bits
    Camera camera;
    Settings settings;
    int tile_size = 64;
};

[[nodiscard]] RenderFlags read_flags(Input& input);

/// Up to five small meshes with materials, textures and lights. Values are mostly sound, sometimes NaN, infinite or huge.
[[nodiscard]] Scene scene_by_code(Input& input);

/// 8 x 4 pixels, each finite and not negative.
[[nodiscard]] EnvironmentImage small_environment(Input& input);

}  // namespace halflit::fuzz
