#include "shading/reference/shadow.hpp"

#include "shading/reference/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace halflit::shading::reference {
namespace {

/// A point in a map: texel coordinates, distance along the map's axis, which of its six faces.
struct MapPoint {
    double u = 0, v = 0, distance = 0;
    int face = 0;
    bool inside = false;
    double margin = 0;  ///< distance to the rim or to the next face, world units
    double texel = 0;   ///< width of a texel at the surface
};

double apply(const float (&row)[4], Vec3d p) { return double{row[0]} * p.x + double{row[1]} * p.y + double{row[2]} * p.z + double{row[3]}; }

/// Distance by which a receiver is moved off its surface. along_axis: cosine of the angle between the normal and the map's axis.
double off_surface(const ShadowMapPlan& map, double texel, double along_axis) {
    return double{map.offset} * texel * std::sqrt(std::max(0.0, 1 - along_axis * along_axis));
}

/// A point in the map of the face that `surface`, the point before it is moved, belongs to.
MapPoint cube_point(const ShadowMapPlan& map, Vec3d surface, Vec3d normal) {
    const auto from_light = [&](Vec3d p) {
        return std::array{p.x - double{map.origin[0]}, p.y - double{map.origin[1]}, p.z - double{map.origin[2]}};
    };
    const auto before = from_light(surface);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::fabs(before[i]) > std::fabs(before[axis])) axis = i;
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    MapPoint at;
    at.texel = double{map.texel_size} * std::fabs(before[axis]);
    const auto offset = from_light(surface + normal * off_surface(map, at.texel, std::array{normal.x, normal.y, normal.z}[axis]));
    const double sign = before[axis] < 0 ? -1 : 1, half = 0.5 * (map.size - 2 * kShadowBorder);
    at.distance = sign * offset[axis];
    at.inside = at.distance > 0;
    if (!at.inside) return at;
    at.face = static_cast<int>(2 * axis + (sign < 0 ? 1 : 0));
    at.u = offset[next] / at.distance * half + 0.5 * map.size;
    at.v = sign * offset[last] / at.distance * half + 0.5 * map.size;
    at.margin = std::fabs(before[axis]) - std::max(std::fabs(before[next]), std::fabs(before[last]));
    return at;
}

MapPoint map_point(const ShadowMapPlan& map, Vec3d surface, Vec3d normal) {
    if (map.kind == ShadowMapPlan::Kind::cube) return cube_point(map, surface, normal);
    double texel = map.texel_size;
    if (map.kind == ShadowMapPlan::Kind::perspective) texel *= std::max(0.0, apply(map.rows[2], surface));
    const Vec3d axis{map.rows[2][0], map.rows[2][1], map.rows[2][2]};
    const Vec3d p = surface + normal * off_surface(map, texel, dot(normal, axis));
    MapPoint at{apply(map.rows[0], p), apply(map.rows[1], p), apply(map.rows[2], p), 0, true, 0, texel};
    double width = map.texel_size;
    if (map.kind == ShadowMapPlan::Kind::perspective) {
        if (!(at.distance > 0)) return {0, 0, at.distance, 0, false, -at.distance, texel};
        at.u /= at.distance;
        at.v /= at.distance;
        width *= at.distance;
    }
    const double rim = std::min({at.u, at.v, map.size - at.u, map.size - at.v}) - 2.0;  // the filter's reach
    at.inside = rim > 0;
    at.margin = std::fabs(rim) * width;
    return at;
}

/// The point in the first of a light's cascades that holds all that the filter reads, with `map` set to that map; its margin is the least
/// of those looked at.
MapPoint cascade_point(const ShadowMapPlan*& map, Vec3d surface, Vec3d normal) {
    const ShadowMapPlan* last = map + map->coarser;
    MapPoint at = map_point(*map, surface, normal);
    while (!at.inside && map < last) {
        const double margin = at.margin;
        at = map_point(*++map, surface, normal);
        at.margin = std::min(at.margin, margin);
    }
    return at;
}

/// Weight of the texel whose centre is at `centre` in a box three texels wide around `at`, one side.
double box_weight(double centre, double at) { return std::clamp(2.0 - std::fabs(centre - at), 0.0, 1.0) / 3.0; }

/// Share of wrapped light that is left at u, the blocker's distance over the distance where none is left: T(u) = (1-u)^2 (1 + 2u) between 0
/// and 1, 1 below, 0 above.
double fade(double u) {
    const double t = std::clamp(u, 0.0, 1.0);
    return (1 - t) * (1 - t) * (1 + 2 * t);
}

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// As the kernels' wide_share.
struct Wide {
    double hard = 0, soft = 0, behind = 0, margin = kEndless;
};
template <class Faded>
Wide wide_share(const ShadowMapPlan& map, const MapPoint& at, double receiver, int k, const Faded& faded) {
    const int step = 1 << k;
    Wide sum;
    const int first_i = static_cast<int>(std::floor(at.u / step - 0.5)) - 1, first_j = static_cast<int>(std::floor(at.v / step - 0.5)) - 1;
    for (int j = first_j; j < first_j + 4; ++j)
        for (int i = first_i; i < first_i + 4; ++i) {
            const auto texel = [&](int index) { return std::clamp(index * step + step / 2, 0, map.size - 1); };
            const double behind = receiver - double{map.distance[texel(j) * map.size + texel(i)]};
            sum.margin = std::min(sum.margin, std::fabs(behind));
            if (!(behind > 0)) continue;
            const double weight = box_weight(i + 0.5, at.u / step) * box_weight(j + 0.5, at.v / step);
            sum.hard += weight, sum.behind += weight * behind, sum.soft += weight * faded(behind);
        }
    return sum;
}

/// As the kernels' penumbra_share.
template <class Faded>
void widen(const ShadowMapPlan& map, const MapPoint& at, double receiver, Vec3d normal, const Faded& faded, Hidden& hidden) {
    const double cosine = std::fabs(dot(normal, Vec3d{map.rows[2][0], map.rows[2][1], map.rows[2][2]}));
    const double tangent = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / std::max(cosine, 0.1);
    const double shift = at.texel * double{kPenumbraBias} * std::min(tangent, double{kSteepestPenumbra});
    const auto wide = [&](int k) { return wide_share(map, at, receiver - shift * ((1 << k) - 1), k, faded); };
    const Wide widest = wide(kPenumbraLevels);
    hidden.margin = std::min(hidden.margin, widest.margin);
    if (!(widest.hard > 0)) return;
    const double width = widest.behind / widest.hard * double{map.penumbra} / (3 * at.texel);
    const Hidden sharp = hidden;
    hidden.hard = hidden.soft = 0;
    double share = 1;
    for (int k = 0; k <= kPenumbraLevels; ++k) {
        const double wider = k == kPenumbraLevels ? 0 : std::clamp(width / (1 << k) - 1, 0.0, 1.0);
        const Wide level = k == 0 ? Wide{sharp.hard, sharp.soft} : wide(k);
        hidden.margin = std::min(hidden.margin, level.margin);
        hidden.hard += (share - wider) * level.hard, hidden.soft += (share - wider) * level.soft;
        share = wider;
    }
}

}  // namespace

Hidden hidden_share(const ShadowMapPlan& first, Vec3d position, Vec3d surface_normal, Vec3d to_light, const MaterialPlan& material,
                    ShadowMode mode) {
    if (mode == ShadowMode::off) return {};
    const double cosine = dot(surface_normal, to_light);
    const ShadowMapPlan* chosen = &first;
    const MapPoint at = cascade_point(chosen, position, surface_normal);
    const ShadowMapPlan& map = *chosen;
    Hidden hidden{0, 0, at.margin};
    if (!at.inside) return hidden;
    const double receiver = at.distance - double{kShadowDepthBias} * at.texel - double{kShadowRelativeBias} * at.distance;
    const bool fades = mode == ShadowMode::soft_split && material.shadow_fade_scale > 0;
    // A body's own thickness towards the light, as a share of d0, is not counted where it turns away from the light.
    const double own = std::clamp(-cosine * double{material.shadow_turn_scale}, 0.0, double{kOwnThickness});
    const auto faded = [&](double behind) {
        return fades ? 1 - fade((behind * double{material.shadow_fade_scale} - own) / (1 - own)) : 1.0;
    };
    const double u = at.u, v = at.v;
    const float* texels = map.distance + static_cast<std::size_t>(at.face) * static_cast<std::size_t>(map.size * map.size);
    const int first_i = static_cast<int>(std::floor(u - 1.5)), first_j = static_cast<int>(std::floor(v - 1.5));
    for (int j = std::max(first_j, 0); j < std::min(first_j + 4, map.size); ++j) {
        for (int i = std::max(first_i, 0); i < std::min(first_i + 4, map.size); ++i) {
            const double weight = box_weight(i + 0.5, u) * box_weight(j + 0.5, v);
            const double behind = receiver - double{texels[j * map.size + i]};
            hidden.margin = std::min(hidden.margin, std::fabs(behind));
            if (!(behind > 0)) continue;
            hidden.hard += weight;
            hidden.soft += weight * faded(behind);
        }
    }
    if (map.penumbra > 0) widen(map, at, receiver, surface_normal, faded, hidden);
    return hidden;
}

double shadowed_lobe(const Lobe& lobe, double x, const Hidden& hidden, ShadowMode mode) {
    const double f = lobe_value(lobe, x), scale = double{lobe.scale()};
    const double core = mode == ShadowMode::soft_split ? std::min(f, scale * std::max(0.0, x)) : f;
    return f - hidden.hard * core - hidden.soft * (f - core);
}

}  // namespace halflit::shading::reference
