// Settings of a picture. tile_size, threads, isa and parallel_for change speed, never a pixel.
#pragma once

#include "raster/parallel_for.hpp"
#include "shading/isa.hpp"
#include "shading/plan/plan.hpp"
#include "shading/result.hpp"

#include <cstddef>
#include <functional>

namespace halflit::raster {

/// The part of the picture to draw, in pixels; width 0 means all of it. Pixels outside are not touched.
struct Region {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const Region&, const Region&) = default;
};

struct Settings {
    Region region{};
    int samples = 1;                                    ///< per pixel: 1, 4 or 8
    int tile_size = 64;                                 ///< 16, 32 or 64; changes speed, never a pixel
    int threads = 0;                                    ///< 0: one per core; changes speed, never a pixel
    Result<shading::Isa> isa = shading::default_isa();  ///< changes speed, never a pixel
    Vec4f background_linear{0, 0, 0, 0};                ///< linear colour, not premultiplied; w = 0 is transparent
    bool background_environment = false;                ///< true: the scene's environment, if it kept its image
    float exposure = 1.0f;                              ///< factor on all light, > 0
    shading::PlanOptions shading{};
    shading::ShadowMode shadows = shading::ShadowMode::soft_split;
    int shadow_size = 2048;  ///< texels on a side of a shadow map, a power of two from 64 to 4096; a cube's faces have half
    std::size_t shadow_memory_limit = std::size_t{256} << 20;  ///< bytes; shadow maps are halved in size until all fit
    /// soft_split: distance to the blocker from which on wrapped light is 0, world units; 0: from object size and wrap.
    float shadow_fade = 0.0f;
    bool shadow_terminator_offset = false;             ///< look-ups on the smooth surface given by the vertex normals, for coarse meshes
    ParallelFor parallel_for{};                        ///< hook for a host's own threads; empty: those of this build
    const std::function<bool()>* cancelled = nullptr;  ///< called before each tile; true stops the frame with an error
};

/// Fails if a setting is out of range, excludes another one, or names an instruction set that this CPU does not run.
[[nodiscard]] Result<void> check_settings(const Settings& settings, int width, int height);

/// True if two frames of one scene, camera and size have the same plan: all that changes pixels is equal, and so is the tile size.
[[nodiscard]] bool same_plan(const Settings& a, const Settings& b);

}  // namespace halflit::raster
