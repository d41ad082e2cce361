// Report of a frame: times, counts, warnings.
#pragma once

#include "raster/work_counts.hpp"
#include "shading/isa.hpp"
#include "shading/plan/accuracy.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::raster {

/// Series of spherical harmonics by which the materials of one lobe take the light of the scene's environment.
struct EnvironmentUse {
    int bands = 0;          ///< length of the series, 1..10
    double bound = 0;       ///< largest error of the light over all normals, white surface, worst channel, before exposure
    bool within = true;     ///< true if bound times exposure is within the tolerance, or the bound in codes within the budget
    bool specular = false;  ///< true: mirrored light, whose error may be twice the tolerance; false: diffuse light
};

/// Times are milliseconds of wall clock.
struct RenderReport {
    struct StageTimes {
        double prepare = 0;    ///< preparing the scene; 0 if it was prepared before
        double plan = 0;       ///< near 0 if the last frame's plan is used again
        double shadows = 0;    ///< shadow maps
        double cull = 0;       ///< instances and clusters out of view or facing away
        double transform = 0;  ///< vertices to the window, vertex records, light at vertices
        double bin = 0;        ///< triangle set-up and tile lists
        double tiles = 0;      ///< visibility, shading, blending, resolving
    } ms;
    double total_ms = 0;
    int threads = 1;
    shading::Isa isa = shading::Isa::scalar;
    std::uint64_t triangles_submitted = 0, triangles_drawn = 0;  ///< drawn: set up for tiles; pieces of clipped triangles count singly
    std::uint64_t triangles_not_finite = 0;                      ///< dropped for a NaN or infinite vertex
    std::uint64_t pixels_visible = 0, fragments_shaded = 0;
    std::uint64_t nan_pixels = 0;             ///< fragments with a NaN in their colour; it is written as 0
    WorkCounts work;                          ///< shading work, stage by stage
    std::vector<EnvironmentUse> environment;  ///< series of the drawn materials, one per lobe
    shading::ErrorBound error;                ///< the promised bound; only with an error budget
    std::vector<std::string> warnings;
};

}  // namespace halflit::raster
