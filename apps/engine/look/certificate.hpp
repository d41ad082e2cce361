// The certificate of `halflit look --certify`: for each triangle of a model, a picture that shows it, or why there is none.
#pragma once

#include "apps/engine/look/view_shot.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halflit::engine {

enum class TriangleStatus : std::uint8_t {
    seen,      ///< a picture shows it with at least Certificate::least pixels
    less,      ///< pictures show it, all with fewer pixels
    hidden,    ///< in none of the directions from which it would cover at least Certificate::least pixels did a pixel show it
    unknown,   ///< no picture shows it, and it is not known to be hidden: it was seen in a view that is not among the pictures, or would
               ///< cover too few pixels from every direction
    no_area,   ///< two of its corners are one place, or all lie on a line
    not_drawn  ///< of an instance that is not shown, is transparent, or only takes shadow
};

/// The status of a triangle, and the picture that shows it best.
struct TriangleView {
    TriangleStatus status = TriangleStatus::unknown;
    int view = -1;                ///< index into Certificate::shots of the picture that shows it with the most pixels; -1: none
    std::int32_t pixels = 0;      ///< that show it there
    std::int32_t directions = 0;  ///< hidden: from which it would have covered enough pixels
};

/// A direction from which the whole model was looked at.
struct LookedFrom {
    std::string name;  ///< as --view has it
    Camera camera;     ///< of parallel rays
};

struct Certificate {
    int least = 0;                   ///< pixels that count as seen
    std::vector<LookedFrom> looked;  ///< directions that were looked from
    std::vector<ViewShot> shots;     ///< the pictures: first those that were given, then those that were added
    std::size_t added = 0;           ///< of the pictures
    std::vector<std::size_t> first;  ///< of each instance's triangles in `triangles`
    std::vector<TriangleView> triangles;

    /// Every triangle that is drawn and has an area is seen, or hidden.
    [[nodiscard]] bool complete() const { return count(TriangleStatus::less) == 0 && count(TriangleStatus::unknown) == 0; }
    /// Triangles of a status, of some instances; of all if `instances` is empty.
    [[nodiscard]] std::size_t count(TriangleStatus status, std::span<const int> instances = {}) const;
};

/// Limits of the work.
struct CertificateLimits {
    int least_pixels = 4;         ///< from 1
    std::size_t most_views = 24;  ///< pictures in all, those that were given included
    ShotPlanes kept{};            ///< of pictures that are added
};

/// Looks for pictures until every triangle is seen. given: the pictures that are there in any case. Others are added as long as they show
/// more: views of the whole model by parallel rays from up to 126 directions, the one that shows most new triangles first, then close-ups
/// of what is left. The search ends early if no further direction can say anything new; what is hidden needs all of them. The result is the
/// same for every number of threads. Each thread draws directions of its own where the model has at most 2^20 triangles, at most 16
/// threads.
[[nodiscard]] Result<Certificate> certify(RenderJob& job, Renderer& renderer, std::vector<ViewShot> given, const CertificateLimits& limits);

}  // namespace halflit::engine
