#include "raster/view/soft_shadows.hpp"

#include "sh/arc.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

using shading::LightPlan, shading::ShadowMapPlan;

Vec3d vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

void set(float (&to)[3], Vec3d v) { to[0] = static_cast<float>(v.x), to[1] = static_cast<float>(v.y), to[2] = static_cast<float>(v.z); }

/// Distance from the centre of a ball of radius 1 of the point that has the share u of all points nearer to the centre. With the density
/// (1 - r^2)^(-1/2) they project to an even disc: the share within r is 2 / pi (asin r - r sqrt(1 - r^2)).
double radius_of_share(double u) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 50; ++i) {
        const double r = 0.5 * (low + high), other = __builtin_sqrt(1.0 - r * r);
        (2.0 / kPi * (angle_of(r, other) - r * other) < u ? low : high) = r;
    }
    return 0.5 * (low + high);
}

/// The least number from about n times the golden ratio on that has no divisor in common with n.
int stride_of(int n) {
    const auto divisor = [](int a, int b) {
        while (b != 0) a = std::exchange(b, a % b);
        return a;
    };
    int stride = std::max(1, static_cast<int>(kGoldenTurn * n));
    while (divisor(n, stride) != 1) ++stride;
    return stride;
}

}  // namespace

std::vector<LightPlan> light_points(const LightPlan& light, int n) {
    std::vector<LightPlan> points(static_cast<std::size_t>(n), light);
    if (n == 1) return points;
    const auto radius = static_cast<double>(light.shadow_radius);
    if (!kind_of(light.type).placed) {
        const Vec3d axis = unit(vector_of(light.to_light));
        const Vec3d side = unit(cross(axis, absolute(axis.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0})), other = cross(axis, side);
        const SinCos angle = sin_cos(radius);
        for (int k = 0; k < n; ++k) {
            const double r = __builtin_sqrt((k + 0.5) / n) * (angle.sin / angle.cos);
            const SinCos turn = sin_cos(2.0 * kPi * kGoldenTurn * k);
            set(points[static_cast<std::size_t>(k)].to_light, unit(axis + side * (r * turn.cos) + other * (r * turn.sin)));
        }
        return points;
    }
    // Lattice and distances both rise with k, so they are paired in another order.
    const std::vector<Vec3d> directions = shading::sky_directions(n);
    const int stride = stride_of(n);
    for (int k = 0; k < n; ++k) {
        const Vec3d direction = directions[static_cast<std::size_t>(k * stride % n)];
        set(points[static_cast<std::size_t>(k)].position,
            vector_of(light.position) + direction * (radius * radius_of_share((k + 0.5) / n)));
    }
    return points;
}

namespace {

/// Maps for `n` points of each light, one light after the other.
Result<ShadowViews> plan_points(const std::vector<LightPlan>& lights, int n, const PreparedData& scene, const SeenVolume* seen,
                                const Settings& settings, const ShadowSizes& sizes) {
    std::vector<LightPlan> points;
    for (const LightPlan& light : lights) {
        const std::vector<LightPlan> of_light = light_points(light, n);
        points.insert(points.end(), of_light.begin(), of_light.end());
    }
    auto views = plan_shadow_views(points, scene, seen, settings, sizes);
    if (views) views->map_of_light.resize(points.size(), -1);  // without shadows there are none
    return views;
}

}  // namespace

Result<ShadowViews> plan_light_shadows(std::vector<LightPlan>& lights, const PreparedData& scene, const SeenVolume* seen,
                                       const Settings& settings, const ShadowSizes& sizes) {
    const auto has_size = [](const LightPlan& light) { return light.shadow_radius > 0.0f; };
    if (std::none_of(lights.begin(), lights.end(), has_size)) return plan_shadow_views(lights, scene, seen, settings, sizes);
    std::vector<LightPlan> sharp, soft;
    for (const LightPlan& light : lights) (has_size(light) ? soft : sharp).push_back(light);
    Settings of_sharp = settings;
    if (!sharp.empty()) of_sharp.shadow_memory_limit /= 2;
    auto out = plan_shadow_views(sharp, scene, seen, of_sharp, sizes);
    if (!out) return out;
    Settings of_soft = settings;
    of_soft.shadow_softness_deg = 0.0f;
    of_soft.shadow_memory_limit -= std::min(of_soft.shadow_memory_limit, out->bytes());
    const ShadowSizes half{halved_shadow_size(sizes.most), 2.0 * sizes.texel_px};
    int n = settings.soft_shadow_maps;
    auto views = plan_points(soft, n, scene, seen, of_soft, half);
    while (!views && views.error().code == ErrorCode::limit && n > 1) views = plan_points(soft, n /= 2, scene, seen, of_soft, half);
    if (!views) return views;
    if (n < settings.soft_shadow_maps)
        views->warning = "soft shadows by " + std::to_string(n) + " maps a light instead of " + std::to_string(settings.soft_shadow_maps) +
                         ", to stay within " + std::to_string(of_soft.shadow_memory_limit) + " bytes";
    out->map_of_light.resize(sharp.size(), -1);
    // Links the maps of each light, then gives each light its first one.
    std::vector<std::int32_t> first(soft.size(), -1);
    for (std::size_t l = 0; l < first.size(); ++l) {
        std::int32_t last = -1;
        for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
            const std::int32_t map = views->map_of_light[l * static_cast<std::size_t>(n) + k];
            if (map < 0) continue;
            if (last < 0)
                first[l] = map;
            else
                views->maps[static_cast<std::size_t>(last)].next = map - last;
            last = map;
        }
    }
    const std::vector<std::int32_t> map_of_sharp = std::move(out->map_of_light);
    const auto before = static_cast<std::int32_t>(append(*out, std::move(*views)));
    out->map_of_light.clear();
    std::size_t next_sharp = 0, next_soft = 0;
    for (LightPlan& light : lights) {
        if (!has_size(light)) {
            out->map_of_light.push_back(map_of_sharp[next_sharp++]);
            continue;
        }
        const std::int32_t map = first[next_soft++];
        out->map_of_light.push_back(map < 0 ? -1 : map + before);
        light.shadow_points = n;
    }
    return out;
}

}  // namespace halflit::raster
