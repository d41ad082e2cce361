#include "shading/image_light.hpp"

#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "sh/zonal.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>

namespace halflit::shading {

LightRange light_range(const sh::RadianceSh& radiance, const sh::WrapLobe& lobe) {
    constexpr int kRows = 64, kColumns = 128;
    // The light has degree 9, and lies within half its range of its middle, so its second derivative along a great circle is at most 81
    // times half the range (Bernstein). Every direction is within 0.035 rad of a grid point. So minimum and maximum are beyond the grid's
    // by at most 0.0249 of the range, and the range is at most 1 / (1 - 0.0498) times the grid's.
    constexpr double kBetweenPoints = 0.0263;
    const sh::PreconvolvedSh light = sh::convolve(radiance, sh::zonal_bands(lobe), sh::kMaxBands);
    LightRange range{{1e300, 1e300, 1e300}, {0, 0, 0}};
    for (int row = 0; row < kRows; ++row) {
        const SinCos polar = sin_cos(kPi * (row + 0.5) / kRows);
        for (int column = 0; column < kColumns; ++column) {
            const SinCos around = sin_cos(2.0 * kPi * column / kColumns);
            const Vec3d value = sh::evaluate(light, Vec3d{polar.sin * around.cos, polar.sin * around.sin, polar.cos});
            range.least = {std::min(range.least.x, value.x), std::min(range.least.y, value.y), std::min(range.least.z, value.z)};
            range.most = {std::max(range.most.x, value.x), std::max(range.most.y, value.y), std::max(range.most.z, value.z)};
        }
    }
    const Vec3d margin = (range.most - range.least) * kBetweenPoints;
    return {range.least - margin, range.most + margin};
}

ImageLight::ImageLight(int width, int height, std::vector<float> rgb, const sh::Projection& projection)
    : width_(width), height_(height), rgb_(std::move(rgb)), radiance_(projection.radiance()), grid_(std::in_place, projection) {}

ImageLight::ImageLight(ImageLightParts parts)
    : width_(parts.width),
      height_(parts.height),
      rgb_(std::move(parts.rgb)),
      radiance_(parts.radiance),
      lobes_(std::move(parts.lobes)),
      reflections_(std::make_shared<const ReflectionMap>(std::move(parts.reflections))),
      steps_(parts.reflection_steps) {}

LobeLight& ImageLight::known(const sh::WrapLobe& lobe) const {
    constexpr std::size_t kMostLobes = 64;  // a host may go through any number of them
    const auto found = std::find_if(lobes_.begin(), lobes_.end(), [&](const LobeLight& one) { return one.lobe == lobe; });
    if (found != lobes_.end()) return *found;
    if (lobes_.size() < kMostLobes) return lobes_.emplace_back(LobeLight{lobe, {}, {}});
    return other_ = {lobe, {}, {}};
}

sh::OrderBounds ImageLight::order_bounds(const sh::WrapLobe& lobe) const {
    const std::scoped_lock lock(mutex_);
    LobeLight& light = known(lobe);
    if (!light.bounds) {
        if (!grid_) grid_.emplace(sh::Projection(image()));
        light.bounds = grid_->order_bounds(sh::lobe_spectrum(lobe));
    }
    return *light.bounds;
}

LightRange ImageLight::range(const sh::WrapLobe& lobe) const {
    const std::scoped_lock lock(mutex_);
    LobeLight& light = known(lobe);
    if (!light.range) light.range = light_range(radiance_, lobe);
    return *light.range;
}

ReflectionSteps ImageLight::steps() const {
    const std::scoped_lock lock(mutex_);
    HALFLIT_ASSERT(reflections_ != nullptr);
    if (!steps_) steps_ = reflection_steps(*reflections_);
    return *steps_;
}

std::shared_ptr<const ReflectionMap> ImageLight::reflections(const ForEachRow& for_each_row) const {
    const auto known = [&] {
        const std::scoped_lock lock(mutex_);
        return reflections_;
    };
    if (auto map = known()) return map;
    // Made without the lock: for_each_row may run other work on this thread, which may ask for the same map. The first one made is kept.
    auto made = std::make_shared<const ReflectionMap>(make_reflection_map(image(), for_each_row));
    const std::scoped_lock lock(mutex_);
    if (reflections_ == nullptr) reflections_ = std::move(made);
    return reflections_;
}

}  // namespace halflit::shading
