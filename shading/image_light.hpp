// What an image's light takes time to make, and no turn of the image changes.
#pragma once

#include "sh/coefficients.hpp"
#include "sh/order.hpp"
#include "sh/project.hpp"
#include "shading/reflection_map.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace halflit::shading {

/// An image's light as numbers that were made before.
struct ImageLightParts {
    int width = 0, height = 0;  ///< of the image
    std::vector<float> rgb;     ///< three floats per pixel
    sh::RadianceSh radiance;
    std::vector<std::pair<sh::WrapLobe, sh::OrderBounds>> bounds;  ///< of some lobes
    ReflectionMap reflections;
};

/// Light of an image from all around. It never changes, so environments share it, any number of threads too.
class ImageLight {
public:
    /// rgb: three floats per pixel. projection: of the same image.
    ImageLight(int width, int height, std::vector<float> rgb, const sh::Projection& projection);
    explicit ImageLight(ImageLightParts parts);

    [[nodiscard]] sh::EquirectView image() const { return {width_, height_, rgb_}; }
    [[nodiscard]] const sh::RadianceSh& radiance() const { return radiance_; }
    /// As sh::BandGrid::order_bounds(); computed when they are first asked for.
    [[nodiscard]] sh::OrderBounds order_bounds(const sh::WrapLobe& lobe) const;
    /// Made when it is first asked for.
    [[nodiscard]] std::shared_ptr<const ReflectionMap> reflections(const ForEachRow& for_each_row) const;

private:
    int width_, height_;
    std::vector<float> rgb_;
    sh::RadianceSh radiance_;
    mutable std::mutex mutex_;  ///< guards all below
    mutable std::optional<sh::BandGrid> grid_;
    mutable std::vector<std::pair<sh::WrapLobe, sh::OrderBounds>> bounds_;
    mutable std::shared_ptr<const ReflectionMap> reflections_;
};

}  // namespace halflit::shading
