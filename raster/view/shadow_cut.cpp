#include "raster/view/shadow_cut.hpp"

#include "raster/detail/view_math.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <algorithm>
#include <iterator>

namespace halflit::raster {
namespace {

/// Convex body with six sides. Corner k lies on the high side of axis a where bit a of k is set.
struct Hexahedron {
    Vec3d corner[8];
    HalfSpace side[6];  ///< 2 a: the low side of axis a; 2 a + 1: the high one
};

/// The sides of each body in the other one: the surface of their common part.
std::vector<Polygon> common_surface(const Hexahedron& a, const Hexahedron& b) {
    std::vector<Polygon> surface;
    Polygon scratch;
    for (const auto& [own, other] : {std::pair{&a, &b}, std::pair{&b, &a}})
        for (int axis = 0; axis < 3; ++axis)
            for (int high = 0; high < 2; ++high) {
                const int first = high << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
                Polygon side;
                for (const int k : {first, first + u, first + u + v, first + v}) side.push_back(own->corner[k]);
                for (const HalfSpace& keep : other->side) clip(side, keep, scratch);
                surface.push_back(std::move(side));
            }
    return surface;
}

/// Hexahedron of the points whose coordinates along three rows are in the ranges; the rows have the inverse `dual`.
struct Row {
    Vec3d direction, dual;
    double low, high;
};
Hexahedron parallelepiped(const Row (&rows)[3]) {
    Hexahedron out;
    for (int k = 0; k < 8; ++k) {
        out.corner[k] = {};
        for (int a = 0; a < 3; ++a) out.corner[k] = out.corner[k] + rows[a].dual * (k >> a & 1 ? rows[a].high : rows[a].low);
    }
    for (int a = 0; a < 3; ++a) {
        out.side[2 * a] = {rows[a].direction, -rows[a].low};
        out.side[2 * a + 1] = {rows[a].direction * -1.0, rows[a].high};
    }
    return out;
}

/// The bounds, larger by more than the roundings of float32 positions.
Hexahedron enlarged(const Bounds& b) {
    constexpr double kShare = 1e-5;
    const double margin = larger(kShare * largest_coordinate(b), 1e-30);
    const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    return parallelepiped({{x, x, b.min.x - margin, b.max.x + margin},
                           {y, y, b.min.y - margin, b.max.y + margin},
                           {z, z, b.min.z - margin, b.max.z + margin}});
}

/// Clip coordinate x, y, z or w of a view.
HalfSpace clip_row(const Mat4& m, int i) {
    const auto at = [i](const Vec4f& c) -> double { return i == 0 ? c.x : i == 1 ? c.y : i == 2 ? c.z : c.w; };
    return {{at(m.c[0]), at(m.c[1]), at(m.c[2])}, at(m.c[3])};
}

/// A share of the distance by which the view begins before the near plane and ends behind the far plane.
constexpr double kDepthMargin = 1e-3;

/// Distance along the view's axis of the nearest and the farthest thing; low > high: nothing is in view.
Range depths_in_view(const HalfSpace& w, const DepthMap& depth, const Hexahedron& box) {
    Range range;
    for (const Vec3d& p : box.corner) range.add(w.at(p));
    const double near_z = depth.distance(1.0), far_z = depth.distance(0.0);  // infinite without a far plane
    range.low = std::max(range.low, near_z * (1.0 - kDepthMargin));
    range.high = std::min(range.high, far_z * (1.0 + kDepthMargin));
    return range;
}

/// Share of a view that a window of rung k is: 1, 1/2, 1/3, 1/4, 1/6, 1/8, ..
constexpr int kRungs = 48;
double share(int k) { return k == 0 ? 1.0 : (k & 1 ? 0.5 : 1.0 / 3.0) / static_cast<double>(1 << (k - 1) / 2); }

/// A texel has to be wider than this share of the largest coordinate. Casters are drawn, and receivers looked up, with six roundings of
/// float32 each: then neither is off by more than 0.36 of a texel.
constexpr double kFinestTexel = 1e-6;

/// Square part of a view's plane: its middle and half its width.
struct Window {
    double x, y, half;
};

/// The window of rung k that shows `needed`; nothing if that is too wide.
std::optional<Window> window(const FittedView& view, int k, int size, const Extent& needed) {
    const double width = 2.0 * view.half * share(k);
    const double step = width * (size / 8) / (size - 2 * shading::kShadowBorder);
    const auto low_end = [&](const Range& r) { return __builtin_floor((r.low + view.half) / step) * step - view.half; };
    const double x = low_end(needed.x), y = low_end(needed.y);
    // Whether the range fits does not depend on its place among the steps: a camera that moves does not change the width for that.
    if (!(needed.x.high - needed.x.low <= width - step) || !(needed.y.high - needed.y.low <= width - step)) return std::nullopt;
    return Window{x + 0.5 * width, y + 0.5 * width, 0.5 * width};
}

double texel_of(const Window& w, int size) { return 2.0 * w.half / (size - 2 * shading::kShadowBorder); }

/// Extent of the seen volume in the plane of a view (perspective: as tangents). min_depth: perspective: nothing nearer can lie in a shadow.
Extent in_plane(const FittedView& view, bool orthographic, const SeenVolume& seen, double min_depth, Range& depth) {
    Extent out;
    const HalfSpace in_front{view.axes.back * -1.0, dot(view.axes.back, view.eye) - min_depth};
    Polygon scratch;
    for (Polygon side : seen.sides) {
        if (!orthographic) clip(side, in_front, scratch);
        for (const Vec3d p : side) {
            const Vec3d q = p - view.eye;
            const double z = -dot(q, view.axes.back), inv = orthographic ? 1.0 : 1.0 / std::max(z, 0.5 * min_depth);
            depth.add(z);
            out.x.add(dot(q, view.axes.right) * inv);
            out.y.add(dot(q, view.axes.up) * inv);
        }
    }
    return out;
}

/// The part of a view's plane that a map has to show; nothing if no shadow falls on what is seen. depth: of what is seen.
std::optional<Extent> needed_of(const FittedView& view, bool orthographic, int size, const SeenVolume& seen, Range& depth) {
    const Extent all = in_plane(view, orthographic, seen, 0.99 * view.near_z, depth);
    // The filter carries a shadow a little beyond its outline.
    const double rim = shading::kShadowBorder * texel_of({0, 0, view.half}, size);
    const auto with_rim = [&](const Range& r) { return Range{r.low - rim, r.high + rim}; };
    const Extent needed{common(all.x, with_rim(view.content.x)), common(all.y, with_rim(view.content.y))};
    if (!(needed.x.low <= needed.x.high) || !(needed.y.low <= needed.y.high)) return std::nullopt;
    return needed;
}

/// Rung of the narrowest window that shows `needed`.
int narrowest(const FittedView& view, int size, const Extent& needed) {
    int k = 0;
    while (k < kRungs && window(view, k + 1, size, needed)) ++k;
    return k;
}

/// Moves a directional view to its window. Its depth becomes that of the scene in the window. Nothing if the window is empty.
std::optional<FittedView> at_window(const FittedView& view, const Window& w, int size, const Hexahedron& scene) {
    const double half = w.half * size / (size - 2 * shading::kShadowBorder);
    FittedView out = view;
    out.eye = view.eye + (view.axes.right * w.x + view.axes.up * w.y);
    out.half = w.half;
    const auto row = [&](Vec3d axis, double low, double high) {
        return Row{axis, axis, dot(axis, out.eye) + low, dot(axis, out.eye) + high};
    };
    const Hexahedron prism = parallelepiped(
        {row(view.axes.right, -half, half), row(view.axes.up, -half, half), row(view.axes.back, -1.01 * view.far_z, 0.01 * view.far_z)});
    Range z;
    for (const Polygon& side : common_surface(prism, scene))
        for (const Vec3d p : side) z.add(dot(p - out.eye, view.axes.back));
    if (!(z.low <= z.high)) return std::nullopt;
    const double depth = std::max(1.01 * z.half(), 1e-3 * w.half);
    out.eye = out.eye + view.axes.back * (z.middle() + depth);
    out.far_z = 2.0 * depth;
    return out;
}

}  // namespace

std::optional<SeenVolume> seen_volume(const View& picture, const DepthMap& depth, const Bounds& scene) {
    const Mat4& m = picture.clip_from_world;
    const HalfSpace x = clip_row(m, 0), y = clip_row(m, 1), z = clip_row(m, depth.orthographic ? 2 : 3);
    const double volume = dot(x.normal, cross(y.normal, z.normal));
    if (!(absolute(volume) > 1e-6 * length(x.normal) * length(y.normal) * length(z.normal)) || !(absolute(volume) < 1e300))
        return std::nullopt;
    const Vec3d dual[3] = {cross(y.normal, z.normal) * (1.0 / volume), cross(z.normal, x.normal) * (1.0 / volume),
                           cross(x.normal, y.normal) * (1.0 / volume)};
    const Hexahedron box = enlarged(scene);
    // A pixel at the rim may be shaded at its centre, half a pixel outside of what is seen; a whole one is added.
    const double wide = 1.001 + 1.0 / picture.viewport.half_width, high = 1.001 + 1.0 / picture.viewport.half_height;
    const double pixel = 1.0 / std::max(picture.viewport.half_width * length(x.normal), picture.viewport.half_height * length(y.normal));
    Hexahedron view;
    if (depth.orthographic) {
        const double margin = kDepthMargin;
        view = parallelepiped({{x.normal, dual[0], -wide - x.offset, wide - x.offset},
                               {y.normal, dual[1], -high - y.offset, high - y.offset},
                               {z.normal, dual[2], -margin - z.offset, 1.0 + margin - z.offset}});
        SeenVolume seen;
        seen.sides = common_surface(view, box);
        seen.pixel = pixel;
        return seen;
    }
    const Range range = depths_in_view(z, depth, box);
    if (!(range.low < range.high)) return SeenVolume{};
    for (int k = 0; k < 8; ++k) {
        const double t = k & 4 ? range.high : range.low;
        view.corner[k] = (dual[0] * ((k & 1 ? wide : -wide) * t - x.offset) + dual[1] * ((k & 2 ? high : -high) * t - y.offset)) +
                         dual[2] * (t - z.offset);
    }
    for (int side = 0; side < 2; ++side) {
        const double sign = side == 0 ? 1.0 : -1.0;
        view.side[side] = {x.normal * sign + z.normal * wide, x.offset * sign + z.offset * wide};
        view.side[2 + side] = {y.normal * sign + z.normal * high, y.offset * sign + z.offset * high};
    }
    view.side[4] = {z.normal, z.offset - range.low};
    view.side[5] = {z.normal * -1.0, range.high - z.offset};
    SeenVolume seen{common_surface(view, box), pixel, true, z, range, {}, {}};
    std::copy(std::begin(view.side), std::end(view.side), std::begin(seen.view));
    std::copy(view.corner, view.corner + 4, std::begin(seen.near_corner));
    return seen;
}

SeenVolume up_to(const SeenVolume& seen, double depth) {
    SeenVolume out = seen;
    const HalfSpace keep{seen.axis.normal * -1.0, depth - seen.axis.offset};
    Polygon scratch;
    for (Polygon& side : out.sides) clip(side, keep, scratch);
    out.depth.high = std::min(out.depth.high, depth);
    return out;
}

bool can_see(const ViewAxes& axes, Vec3d eye, double half, const SeenVolume& seen) {
    bool front = false, left = false, right = false, below = false, above = false;
    for (const Polygon& side : seen.sides)
        for (const Vec3d p : side) {
            const Vec3d q = p - eye;
            const double x = dot(q, axes.right), y = dot(q, axes.up), width = -dot(q, axes.back) * half;
            front |= width >= 0.0;
            left |= -x <= width, right |= x <= width, below |= -y <= width, above |= y <= width;
        }
    return front && left && right && below && above;
}

double nearest_if_all_seen(const FittedView& view, const SeenVolume& seen) {
    double nearest = 1e300;
    for (const Polygon& side : seen.sides)
        for (const Vec3d p : side) {
            const Vec3d q = p - view.eye;
            const double z = -dot(q, view.axes.back), width = z * view.half;
            if (!(absolute(dot(q, view.axes.right)) <= width && absolute(dot(q, view.axes.up)) <= width)) return 0.0;
            nearest = std::min(nearest, z);
        }
    return nearest;
}

std::optional<int> ladder_rung(const FittedView& view, int size, const SeenVolume& seen) {
    Range depth;
    const auto needed = needed_of(view, true, size, seen, depth);
    if (!needed) return std::nullopt;
    return narrowest(view, size, *needed);
}

double ladder_width(const FittedView& view, int rung) { return 2.0 * view.half * share(rung); }

double ladder_texel(const FittedView& view, int rung, int size) { return texel_of({0, 0, view.half * share(rung)}, size); }

MapUse cut_view(FittedView& view, bool orthographic, int size, const SeenVolume& seen, const Bounds& scene) {
    Range depth;
    const auto needed = needed_of(view, orthographic, size, seen, depth);
    if (!needed) return MapUse::none;
    const Hexahedron box = enlarged(scene);
    for (int k = narrowest(view, size, *needed); k > 0; --k) {
        const Window w = *window(view, k, size, *needed);
        // Triangles that cross the window may be as large as the scene, and so are the roundings of their corners.
        if (texel_of(w, size) * (orthographic ? 1.0 : depth.low) < kFinestTexel * largest_coordinate(scene)) continue;
        if (!orthographic && w.half < kNarrowestView) continue;
        if (orthographic) {
            const auto moved = at_window(view, w, size, box);
            if (!moved) continue;
            view = *moved;
            return MapUse::cut;
        }
        // A view that is not around its axis: tangents are measured from the window's middle.
        view.axes.right = view.axes.right + view.axes.back * w.x;
        view.axes.up = view.axes.up + view.axes.back * w.y;
        view.half = w.half;
        return MapUse::cut;
    }
    return MapUse::whole;
}

}  // namespace halflit::raster
