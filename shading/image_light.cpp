#include "shading/image_light.hpp"

namespace halflit::shading {

ImageLight::ImageLight(int width, int height, std::vector<float> rgb, const sh::Projection& projection)
    : width_(width), height_(height), rgb_(std::move(rgb)), radiance_(projection.radiance()), grid_(std::in_place, projection) {}

ImageLight::ImageLight(ImageLightParts parts)
    : width_(parts.width),
      height_(parts.height),
      rgb_(std::move(parts.rgb)),
      radiance_(parts.radiance),
      bounds_(std::move(parts.bounds)),
      reflections_(std::make_shared<const ReflectionMap>(std::move(parts.reflections))) {}

sh::OrderBounds ImageLight::order_bounds(const sh::WrapLobe& lobe) const {
    constexpr std::size_t kMostLobes = 64;  // a host may go through any number of them
    const std::scoped_lock lock(mutex_);
    for (const auto& [known, bounds] : bounds_)
        if (known == lobe) return bounds;
    if (!grid_) grid_.emplace(sh::Projection(image()));
    const sh::OrderBounds bounds = grid_->order_bounds(sh::lobe_spectrum(lobe));
    if (bounds_.size() < kMostLobes) bounds_.emplace_back(lobe, bounds);
    return bounds;
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
