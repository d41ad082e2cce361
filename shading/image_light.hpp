// The parts of an image's light that take time to make and that no turn of the image changes.
#pragma once

#include "sh/coefficients.hpp"
#include "sh/order.hpp"
#include "sh/project.hpp"
#include "shading/irradiance_map.hpp"
#include "shading/reflection_map.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace halflit::shading {

/// Bounds on the light that the first N bands add to, or lack of, that of all ten through a lobe, at any normal, [N - 1]: channel by
/// channel, and as a share of the light of all ten, worst channel. Both have the roundings of float32.
struct BandErrors {
    Vec3d absolute[sh::kMaxBands];
    double relative[sh::kMaxBands]{};
    Vec3d least;  ///< the least light of all ten at any normal, channel by channel; may be below 0
};
[[nodiscard]] BandErrors band_errors(const sh::RadianceSh& radiance, const sh::WrapLobe& lobe);

/// Bounds on an image's light through a lobe; empty until they are asked for.
struct LobeLight {
    sh::WrapLobe lobe;
    std::optional<sh::OrderBounds> bounds;
    std::optional<BandErrors> errors;
    std::weak_ptr<const IrradianceMap> map;  ///< while a plan has it
};

/// An image's light as numbers that were made before.
struct ImageLightParts {
    int width = 0, height = 0;  ///< of the image
    std::vector<float> rgb;     ///< three floats per pixel
    sh::RadianceSh radiance;
    std::vector<LobeLight> lobes;  ///< some lobes, with all that is known of them
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
    /// As band_errors() of the radiance, or of it turned; computed when they are first asked for.
    [[nodiscard]] BandErrors band_errors(const sh::WrapLobe& lobe) const;
    /// Before any turn. Made where no plan has it.
    [[nodiscard]] std::shared_ptr<const IrradianceMap> irradiance(const sh::WrapLobe& lobe) const;
    /// Made when it is first asked for.
    [[nodiscard]] std::shared_ptr<const ReflectionMap> reflections(const ForEachRow& for_each_row) const;

private:
    [[nodiscard]] const sh::Projection& projection() const;
    [[nodiscard]] LobeLight& known(const sh::WrapLobe& lobe) const;  ///< in the list, or `other_`; an empty one if it is new

    int width_, height_;
    std::vector<float> rgb_;
    sh::RadianceSh radiance_;
    mutable std::mutex mutex_;  ///< guards all below
    mutable std::optional<sh::Projection> projection_;
    mutable std::optional<sh::BandGrid> grid_;
    mutable std::vector<LobeLight> lobes_;
    mutable LobeLight other_;  ///< of a lobe for which the list has no room
    mutable std::shared_ptr<const ReflectionMap> reflections_;
};

}  // namespace halflit::shading
