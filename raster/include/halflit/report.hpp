// Report of a frame: times, counts, warnings.
#pragma once

#include "halflit/isa.hpp"
#include "halflit/shading.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace halflit {

/// Series of spherical harmonics by which the materials of one lobe take the light of the scene's environment.
struct EnvironmentUse {
    int bands = 0;       ///< length of the series, 1..10; 0: a map of 64 bands' light
    double bound = 0;    ///< largest error of the light over all normals, white surface, worst channel, before exposure
    bool within = true;  ///< true if bound times exposure is within the tolerance
};

/// Amount of shading work, in lanes. The counts show that stages which are not required do not run. They do not depend on threads or
/// instruction set. Counts of light depend on the tile size, because it decides which fragments share a block: a light is left out of a
/// block that its range or cone does not reach, and ShadingRate::flat lights a triangle once per block.
struct WorkCounts {
    /// Lanes that ran a stage, indexed by its bit in Stage. A lane is a fragment, or a vertex or triangle for light at a lower rate.
    std::array<std::uint64_t, kStageCount> stage_lanes{};
    std::uint64_t alpha_test_lanes = 0;          ///< fragments that had an alpha test; its stages count in stage_lanes too
    std::array<std::uint64_t, 3> light_lanes{};  ///< pairs of a light and a lane, by LightType
    std::uint64_t shadow_lookup_lanes = 0;       ///< pairs whose light has a shadow map

    /// stage_lanes of one stage.
    [[nodiscard]] std::uint64_t lanes(Stage stage) const {
        return stage_lanes[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(stage)))];
    }
    /// Adds the counts of another frame, or of another part of this one.
    WorkCounts& operator+=(const WorkCounts& other) {
        for (std::size_t i = 0; i < stage_lanes.size(); ++i) stage_lanes[i] += other.stage_lanes[i];
        for (std::size_t i = 0; i < light_lanes.size(); ++i) light_lanes[i] += other.light_lanes[i];
        alpha_test_lanes += other.alpha_test_lanes;
        shadow_lookup_lanes += other.shadow_lookup_lanes;
        return *this;
    }
    friend bool operator==(const WorkCounts&, const WorkCounts&) = default;
};

/// A budget that is measured: a share of the pixels, in percent, is within some 8-bit codes of the picture in full quality.
struct ShareBudget {
    double codes = 2;     ///< 0 to 255
    double percent = 99;  ///< above 0 and below 100
};
inline constexpr ShareBudget kFastQuality{2, 99};   ///< --quality fast
inline constexpr ShareBudget kDraftQuality{8, 95};  ///< --quality draft

/// The cheapest settings that keep a ShareBudget, and how far probes show that they do.
struct MeasuredShare {
    ShareBudget asked;  ///< the budget
    /// share that the probes show, with a confidence of 95 % in each view; 100: the settings are those of full quality
    double percent = 100;
    int probes = 0, outside = 0;                       ///< pixels that were chosen, and those of them outside; of several views together
    int samples = 0, anisotropy = 0, shadow_size = 0;  ///< the settings of that name
};

/// Times are milliseconds of wall clock.
struct RenderReport {
    /// Time of each step. They do not overlap; what is between them is in total_ms alone.
    struct StageTimes {
        double prepare = 0;                   ///< preparing the scene; 0 if it was prepared before
        double plan = 0;                      ///< near 0 if the last frame's plan is used again
        double shadows = 0;                   ///< shadow maps
        double cull = 0;                      ///< instances and clusters out of view or facing away
        double transform = 0;                 ///< vertices to the window, vertex records, light at vertices
        double bin = 0;                       ///< triangle set-up and tile lists
        double tiles = 0;                     ///< visibility, shading, blending, resolving, lines of edges
    } ms;                                     ///< the steps' times
    double total_ms = 0;                      ///< of the whole call
    int threads = 1;                          ///< threads that the frame could use; 0: a host's loop
    Isa isa = Isa::scalar;                    ///< instruction set of the kernels
    std::uint64_t triangles_submitted = 0;    ///< triangles of the scene, over all instances
    std::uint64_t triangles_drawn = 0;        ///< set up for tiles, without copies; pieces of clipped triangles count singly
    std::uint64_t triangles_not_finite = 0;   ///< dropped for a NaN or infinite vertex
    std::uint64_t pixels_visible = 0;         ///< pixels of the region of which an opaque or masked surface covers a sample, or splats show
    std::uint64_t fragments_shaded = 0;       ///< pairs of a pixel and a triangle whose colour was computed
    std::uint64_t nan_pixels = 0;             ///< fragments with a NaN in their colour; it is written as 0
    WorkCounts work;                          ///< shading work, stage by stage
    std::vector<EnvironmentUse> environment;  ///< series of the drawn materials, one per lobe
    ErrorBound error;                         ///< the promised bound; only with an error budget
    std::vector<std::string> warnings;        ///< one line each, UTF-8
};

}  // namespace halflit
