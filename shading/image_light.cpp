#include "shading/image_light.hpp"

namespace halflit::shading {

std::shared_ptr<const ReflectionMap> ImageLight::reflections(const ForEachRow& for_each_row) const {
    const auto known = [&] {
        const std::scoped_lock lock(making_);
        return reflections_;
    };
    if (auto map = known()) return map;
    // Made without the lock: for_each_row may run other work on this thread, which may ask for the same map. Whoever is first keeps his.
    auto made = std::make_shared<const ReflectionMap>(make_reflection_map(image(), for_each_row));
    const std::scoped_lock lock(making_);
    if (reflections_ == nullptr) reflections_ = std::move(made);
    return reflections_;
}

}  // namespace halflit::shading
