#include "raster/view/light_culling.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

using shading::LightPlan;

constexpr std::size_t kGroupSize = 16;

/// Safety factor for rounding errors of distances, the kernel's and those here; far larger than both.
constexpr double kMargin = 1.0 + 1e-4;

/// Squared distance from which on the light is zero; 0: there is none.
double end_squared(const LightPlan& light) {
    const double range = light.inv_range_squared > 0.0f ? 1.0 / light.inv_range_squared : 0.0, cutoff = light.cutoff_squared;
    return range > 0.0 && cutoff > 0.0 ? std::min(range, cutoff) : std::max(range, cutoff);
}

double cutoff_radius(const LightPlan& light) { return kMargin * __builtin_sqrt(end_squared(light)); }

/// Morton code: ten bits of each coordinate, interleaved. Neighbours in space are mostly neighbours in this order.
std::uint32_t morton(const LightPlan& light, const double (&low)[3], const double (&scale)[3]) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::uint32_t>(std::clamp((light.position[axis] - low[axis]) * scale[axis], 0.0, 1023.0));
        for (int bit = 0; bit < 10; ++bit) code |= ((cell >> bit) & 1u) << (3 * bit + axis);
    }
    return code;
}

/// True if the light is certainly zero at every point of the box [low, high].
bool zero_in(const LightPlan& light, const double (&low)[3], const double (&high)[3]) {
    double nearest_squared = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double p = light.position[axis];
        const double d = p < low[axis] ? low[axis] - p : p > high[axis] ? p - high[axis] : 0.0;
        nearest_squared += d * d;
    }
    const double end = end_squared(light);
    if (end > 0.0 && nearest_squared > end * kMargin) return true;
    if (!kind_of(light.type).cone || nearest_squared == 0.0) return false;
    // The box's bounding sphere has radius r and distance d: from the light it fills a cone of half angle asin(r / d).
    double offset[3], r_squared = 0.0, d_squared = 0.0, along = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        offset[axis] = 0.5 * (low[axis] + high[axis]) - light.position[axis];
        const double half = 0.5 * (high[axis] - low[axis]);
        r_squared += half * half;
        d_squared += offset[axis] * offset[axis];
        along -= offset[axis] * light.to_light[axis];
    }
    if (r_squared * 1.0001 >= d_squared) return false;
    // The light is zero if the angle between its axis and the sphere's centre exceeds outer angle + asin(r / d); compared by cosines.
    const double inv_d = 1.0 / __builtin_sqrt(d_squared);
    const double cos_axis = along * inv_d, sin_axis = __builtin_sqrt(std::max(0.0, 1.0 - cos_axis * cos_axis));
    const double sin_size = __builtin_sqrt(r_squared) * inv_d, cos_size = __builtin_sqrt(1.0 - sin_size * sin_size);
    const double cos_outer = 1.0 - static_cast<double>(light.cone_cutoff);
    if (cos_axis > cos_size) return false;  // the axis passes through the sphere
    return cos_axis * cos_size + sin_axis * sin_size < cos_outer - 1e-4;
}

}  // namespace

LightCuller::LightCuller(std::span<const LightPlan> lights) {
    light_count_ = lights.size();
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const LightPlan& light = lights[i];
        if (!kind_of(light.type).placed || end_squared(light) == 0.0) {
            always_.push_back(i);
            any_spot_ |= kind_of(light.type).cone;
            continue;
        }
        ranged_.push_back(i);
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min<double>(low[axis], light.position[axis]);
            high[axis] = std::max<double>(high[axis], light.position[axis]);
        }
    }
    double scale[3];
    for (int axis = 0; axis < 3; ++axis) scale[axis] = high[axis] > low[axis] ? 1023.0 / (high[axis] - low[axis]) : 0.0;
    std::stable_sort(ranged_.begin(), ranged_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return morton(lights[a], low, scale) < morton(lights[b], low, scale); });
    for (std::size_t first = 0; first < ranged_.size(); first += kGroupSize) {
        Group group{{{3e38f, 3e38f, 3e38f}, {-3e38f, -3e38f, -3e38f}}, first, std::min(first + kGroupSize, ranged_.size())};
        for (std::size_t k = group.first; k < group.end; ++k) {
            const LightPlan& light = lights[ranged_[k]];
            const double radius = cutoff_radius(light);
            for (int axis = 0; axis < 3; ++axis) {
                group.extent.min[axis] =
                    std::min(group.extent.min[axis], static_cast<float>(std::max(light.position[axis] - radius, -3e38)));
                group.extent.max[axis] =
                    std::max(group.extent.max[axis], static_cast<float>(std::min(light.position[axis] + radius, 3e38)));
            }
        }
        groups_.push_back(group);
    }
}

shading::LightList LightCuller::select(std::span<const LightPlan> lights, const shading::FragmentBlock& block, int count,
                                       LightSelection& scratch) const {
    HALFLIT_ASSERT(lights.size() == light_count_);
    const shading::LightList all{lights.data(), static_cast<int>(lights.size())};
    if (ranged_.empty() && !any_spot_) return all;
    PositionBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        const float* p = block.lane[shading::kPosX + axis];
        float least = p[0], most = p[0];
        for (int l = 1; l < count; ++l) {
            least = p[l] < least ? p[l] : least;
            most = p[l] > most ? p[l] : most;
        }
        if (!(most - least < 3e38f)) return all;  // not finite
        box.low[axis] = least;
        box.high[axis] = most;
    }
    return select(lights, box, scratch);
}

shading::LightList LightCuller::select(std::span<const LightPlan> lights, const PositionBox& box, LightSelection& scratch) const {
    HALFLIT_ASSERT(lights.size() == light_count_);
    const shading::LightList all{lights.data(), static_cast<int>(lights.size())};
    if (ranged_.empty() && !any_spot_) return all;
    const auto& [low, high] = box;
    std::vector<std::uint32_t>& kept = scratch.index;
    kept.clear();
    for (const std::uint32_t i : always_)
        if (!kind_of(lights[i].type).cone || !zero_in(lights[i], low, high)) kept.push_back(i);
    for (const Group& group : groups_) {
        bool apart = false;
        for (int axis = 0; axis < 3; ++axis) apart |= group.extent.min[axis] > high[axis] || group.extent.max[axis] < low[axis];
        if (apart) continue;
        for (std::size_t k = group.first; k < group.end; ++k)
            if (!zero_in(lights[ranged_[k]], low, high)) kept.push_back(ranged_[k]);
    }
    if (kept.size() == lights.size()) return all;
    std::sort(kept.begin(), kept.end());
    scratch.lights.clear();
    for (const std::uint32_t i : kept) scratch.lights.push_back(lights[i]);
    return {scratch.lights.data(), static_cast<int>(scratch.lights.size())};
}

}  // namespace halflit::raster
