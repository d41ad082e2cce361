#include "shading/irradiance_map.hpp"

#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::shading {
namespace {

constexpr int kFewestRows = 64, kMostRows = 512;

/// An eighth of the largest second differences of the values in either direction, by which the bilinear function is off where the light
/// bends between them no more than at them.
Vec3d step_error(const std::vector<Vec3f>& values, int rows) {
    const auto width = static_cast<std::size_t>(2 * rows + 1);
    Vec3d down{}, across{};
    const auto bend = [](Vec3f a, Vec3f b, Vec3f c, Vec3d& most) {
        const auto one = [](float x, float y, float z, double& m) {
            m = std::max(m, std::fabs(static_cast<double>(x) - 2.0 * static_cast<double>(y) + static_cast<double>(z)));
        };
        one(a.x, b.x, c.x, most.x), one(a.y, b.y, c.y, most.y), one(a.z, b.z, c.z, most.z);
    };
    for (std::size_t j = 0; j <= static_cast<std::size_t>(rows); ++j)
        for (std::size_t i = 0; i + 1 < width; ++i) {
            const Vec3f* const at = &values[j * width + i];
            if (j > 0 && j < static_cast<std::size_t>(rows)) bend(*(at - width), *at, *(at + width), down);
            bend(i > 0 ? *(at - 1) : *(at + width - 2), *at, *(at + 1), across);
        }
    return (down + across) * 0.125;
}

}  // namespace

IrradianceMap make_irradiance_map(const sh::Projection& environment, const sh::WrapLobe& lobe, double tolerance) {
    const sh::LobeSpectrum spectrum = sh::lobe_spectrum(lobe);
    IrradianceMap map;
    for (map.rows = kFewestRows;; map.rows *= 2) {
        check_time();
        const std::vector<Vec3f> values = environment.weighted_on_globe(spectrum.f, map.rows);
        map.error = step_error(values, map.rows);
        if (map.rows < kMostRows && sh::largest(map.error) > tolerance) continue;
        map.rgba.reserve(values.size());
        for (const Vec3f& v : values) map.rgba.push_back({v.x > 0.0f ? v.x : 0.0f, v.y > 0.0f ? v.y : 0.0f, v.z > 0.0f ? v.z : 0.0f, 0.0f});
        return map;
    }
}

}  // namespace halflit::shading
