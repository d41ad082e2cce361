#include "raster/explain/splat_shares.hpp"

#include "raster/view/projection.hpp"
#include "raster/view/splat_view.hpp"
#include "sh/power.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <functional>

namespace halflit::raster {

void tell_splats(const PreparedData& data, const Camera& camera, double most_depth, PixelStory& story) {
    const auto [width, height] = story.size;
    const SplatEye eye(camera, clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height)), width, height,
                       data.bounds());
    constexpr std::uint64_t kUnitsASplat = 100;
    struct Found {
        double distance;
        SplatShare share;
    };
    std::vector<Found> found;
    std::vector<SplatRecord> records(kSplatsAtOnce);
    std::vector<double> distances(kSplatsAtOnce);
    std::vector<std::uint32_t> numbers(kSplatsAtOnce);
    each_splats(data.scene(), [&](std::size_t i, const Instance& instance, const Mesh& mesh) {
        SplatView view = eye.view_of(instance.world_from_object, mesh.splats->reference, {story.x, story.y, 1, 1});
        view.least_log2 = -24.0f;
        for (std::size_t first = 0; first < mesh.splats->opacities.size(); first += kSplatsAtOnce) {
            const int count = raster_kernels(Isa::scalar)
                                  .project_splats(view, splat_batch(mesh, first, static_cast<std::uint32_t>(first)), records.data(),
                                                  distances.data(), numbers.data());
            check_time();
            charge_work(kUnitsASplat * kSplatsAtOnce);
            for (int k = 0; k < count; ++k) {
                const SplatRecord& s = records[static_cast<std::size_t>(k)];
                if (!(double{s.z} < most_depth)) continue;
                const double dx = story.x - s.x - double{s.x_part}, dy = story.y - s.y - double{s.y_part},
                             u = double{s.m00} * dx + double{s.m01} * dy, w = double{s.m10} * dx + double{s.m11} * dy;
                SplatShare share;
                share.instance = i, share.mesh = static_cast<std::size_t>(instance.mesh);
                share.splat = numbers[static_cast<std::size_t>(k)];
                share.depth = double{s.z};
                share.alpha = std::min(double{kMostSplatAlpha}, exp2_of(double{s.log2_opacity} - u * u - w * w));
                for (std::size_t c = 0; c < 3; ++c) share.color[c] = double{s.color[c]};
                found.push_back({distances[static_cast<std::size_t>(k)], share});
            }
        }
    });
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.distance < b.distance; });
    double passed = 1.0;
    std::vector<double> weights;
    for (Found& one : found) {
        one.share.weight = passed * one.share.alpha;
        passed -= one.share.weight;
        weights.push_back(one.share.weight);
    }
    story.splats_passed = passed;
    // The heaviest, in their order.
    double least = 0.0;
    if (weights.size() > kMostSplats) {
        std::nth_element(weights.begin(), weights.begin() + kMostSplats, weights.end(), std::greater<>());
        least = weights[kMostSplats];
    }
    constexpr double kLeast = 1.0 / 1024;
    for (const Found& one : found) {
        if (one.share.weight > least && one.share.weight >= kLeast)
            story.splats.push_back(one.share);
        else
            ++story.splats_left_out;
    }
}

}  // namespace halflit::raster
