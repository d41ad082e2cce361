// What a frame did.
#pragma once

#include "raster/work_counts.hpp"
#include "shading/isa.hpp"
#include "shading/plan/accuracy.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::raster {

/// How the frame's materials of one lobe take the light of the scene's environment.
struct EnvironmentUse {
    int bands = 0;          ///< of spherical harmonics, 1..10
    double bound = 0;       ///< no normal's light is off by more, white surface, worst channel, before exposure
    bool within = true;     ///< whether that times the exposure is within the tolerance
    bool specular = false;  ///< what surfaces reflect like mirrors, which may be off by twice the tolerance; otherwise diffuse light
};

/// Times in milliseconds of wall clock.
struct RenderReport {
    struct StageTimes {
        double prepare = 0;    ///< of the scene: 0 for one that was prepared beforehand
        double plan = 0;       ///< 0 where the last frame's plan still holds
        double shadows = 0;    ///< shadow maps
        double cull = 0;       ///< instances and clusters out of view or facing away
        double transform = 0;  ///< vertices to the window, and vertex records
        double bin = 0;        ///< triangle set-up and tile lists
        double tiles = 0;      ///< visibility, shading, blending, resolving
    } ms;
    double total_ms = 0;
    int threads = 1;
    shading::Isa isa = shading::Isa::scalar;
    std::uint64_t triangles_submitted = 0, triangles_drawn = 0;  ///< drawn: those that reached a tile's list
    std::uint64_t triangles_not_finite = 0;                      ///< dropped for a NaN or infinite vertex
    std::uint64_t pixels_visible = 0, fragments_shaded = 0;
    std::uint64_t nan_pixels = 0;             ///< written as 0
    WorkCounts work;                          ///< of fragments_shaded, stage by stage
    std::vector<EnvironmentUse> environment;  ///< of the materials that are drawn, each lobe once
    shading::ErrorBound error;                ///< with a budget: what was promised
    std::vector<std::string> warnings;
};

}  // namespace halflit::raster
