#include "raster/view/shadow_fit.hpp"

#include "raster/detail/view_math.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

/// Extent of the boxes as a light sees them, as tangents.
struct Tangents : Extent {
    bool in_front = true;
};

Tangents tangents_of(std::span<const Bounds> boxes, const ViewAxes& axes, Vec3d eye) {
    Tangents seen;
    for (const Bounds& box : boxes)
        for_corners(box, [&](Vec3d p) {
            const Vec3d q = p - eye;
            const double depth = -dot(q, axes.back);
            // Beyond 89.9 degrees nothing fits, and the quotients may overflow.
            seen.in_front &= depth > 1e-3 * length(q);
            if (!seen.in_front) return;
            seen.x.add(dot(q, axes.right) / depth);
            seen.y.add(dot(q, axes.up) / depth);
        });
    return seen;
}

}  // namespace

ViewAxes axes_for(Vec3d back) {
    const double ay = back.y < 0 ? -back.y : back.y;
    const Vec3d right = unit(cross(ay < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, back));
    return {right, cross(back, right), back};
}

FittedView fit_directional(Vec3d to_light, std::span<const Bounds> boxes, const Bounds& scene) {
    const ViewAxes axes = axes_for(unit(to_light));
    Range x, y, z;
    double largest = 0.0;
    for (const Bounds& box : boxes)
        for_corners(box, [&](Vec3d p) {
            x.add(dot(p, axes.right));
            y.add(dot(p, axes.up));
            largest = std::max(largest, length(p));
        });
    for_corners(scene, [&](Vec3d p) { z.add(dot(p, axes.back)); });
    FittedView view;
    view.axes = axes;
    // Below the resolution of float32 coordinates a view shows nothing.
    view.half = std::max({x.half(), y.half(), 1e-5 * largest, 1e-30});
    const double depth = std::max(z.half() * 1.01, view.half * 1e-3);
    view.eye = (axes.right * x.middle() + axes.up * y.middle()) + axes.back * (z.middle() + depth);
    view.near_z = 0.0;
    view.far_z = 2.0 * depth;
    view.content = {{-x.half(), x.half()}, {-y.half(), y.half()}};
    return view;
}

std::optional<FittedView> fit_lamp(Vec3d position, std::span<const Bounds> boxes, const Bounds& scene, double widest) {
    Bounds all;
    for (const Bounds& box : boxes) all.include(box);
    const Vec3d middle = to_double(all.center()) - position;
    if (!(length(middle) > 1e-30)) return std::nullopt;
    FittedView view;
    view.axes = axes_for(unit(middle) * -1.0);
    view.eye = position;
    Tangents seen = tangents_of(boxes, view.axes, position);
    if (!seen.in_front) return std::nullopt;
    // Turned to the middle of what it sees, the view is narrowest.
    const Vec3d ahead = (view.axes.right * seen.x.middle() + view.axes.up * seen.y.middle()) - view.axes.back;
    view.axes = axes_for(unit(ahead) * -1.0);
    seen = tangents_of(boxes, view.axes, position);
    if (!seen.in_front) return std::nullopt;
    view.half = std::max({seen.x.high, -seen.x.low, seen.y.high, -seen.y.low, kNarrowestView});
    if (!(view.half <= widest)) return std::nullopt;
    Range depth;
    for_corners(scene, [&](Vec3d p) { depth.add(-dot(p - position, view.axes.back)); });
    view.near_z = 0.99 * depth.low;
    view.far_z = depth.high;
    view.content = seen;
    return view;
}

}  // namespace halflit::raster
