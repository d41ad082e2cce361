// What an image's light takes time to make, and no turn of the image changes.
#pragma once

#include "sh/coefficients.hpp"
#include "sh/order.hpp"
#include "sh/project.hpp"
#include "shading/reflection_map.hpp"

#include <memory>
#include <mutex>
#include <vector>

namespace halflit::shading {

/// Light of an image from all around. It never changes, so environments share it, any number of threads too.
class ImageLight {
public:
    /// rgb: three floats per pixel. projection: of the same image.
    ImageLight(int width, int height, std::vector<float> rgb, const sh::Projection& projection)
        : width_(width), height_(height), rgb_(std::move(rgb)), radiance_(projection.radiance()), grid_(projection) {}

    [[nodiscard]] sh::EquirectView image() const { return {width_, height_, rgb_}; }
    [[nodiscard]] const sh::RadianceSh& radiance() const { return radiance_; }
    /// As sh::BandGrid::order_bounds().
    [[nodiscard]] sh::OrderBounds order_bounds(const sh::LobeSpectrum& lobe) const { return grid_.order_bounds(lobe); }
    /// Made when it is first asked for.
    [[nodiscard]] std::shared_ptr<const ReflectionMap> reflections(const ForEachRow& for_each_row) const;

private:
    int width_, height_;
    std::vector<float> rgb_;
    sh::RadianceSh radiance_;
    sh::BandGrid grid_;
    mutable std::mutex making_;  ///< guards reflections_
    mutable std::shared_ptr<const ReflectionMap> reflections_;
};

}  // namespace halflit::shading
