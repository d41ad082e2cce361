// Views from which a light sees all that can cast a shadow, and as little else as possible.
#pragma once

#include "halflit/mesh.hpp"
#include "sh/vec3d.hpp"

#include <optional>
#include <span>

namespace halflit::raster {

[[nodiscard]] inline Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

/// Calls f for the eight corners.
template <class F>
void for_corners(const Bounds& b, const F& f) {
    for (int k = 0; k < 8; ++k) f(Vec3d{k & 1 ? b.max.x : b.min.x, k & 2 ? b.max.y : b.min.y, k & 4 ? b.max.z : b.min.z});
}

/// Axes of a camera that looks along -back.
struct ViewAxes {
    Vec3d right, up, back;
};
/// right and up are chosen; `back` is a unit vector.
[[nodiscard]] ViewAxes axes_for(Vec3d back);

/// A square view. Directional: half is half its side, and the middle of its near side is the eye.
struct FittedView {
    ViewAxes axes;
    Vec3d eye;
    double half = 0;    ///< directional: world units; otherwise the tangent of half the angle
    double near_z = 0;  ///< distance of the nearest thing that may cast a shadow; 0 or less: some of them lie behind the eye
    double far_z = 0;   ///< distance of the farthest thing
};

/// The view along parallel light that shows all of `boxes`; its depth is that of `scene`. boxes: at least one.
[[nodiscard]] FittedView fit_directional(Vec3d to_light, std::span<const Bounds> boxes, const Bounds& scene);

/// The view from a lamp that shows all of `boxes`; nothing if it would be wider than `widest`, the tangent of half its angle.
[[nodiscard]] std::optional<FittedView> fit_lamp(Vec3d position, std::span<const Bounds> boxes, const Bounds& scene, double widest);

}  // namespace halflit::raster
