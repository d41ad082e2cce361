// Views from which a light sees all that can cast a shadow, and as little else as possible.
#pragma once

#include "halflit/mesh.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
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

struct Range {
    double low = 1e300, high = -1e300;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double half() const { return 0.5 * (high - low); }
};
[[nodiscard]] inline Range common(const Range& a, const Range& b) { return {std::max(a.low, b.low), std::min(a.high, b.high)}; }

/// Part of a view's plane, from the view's middle. Directional: world units; otherwise tangents.
struct Extent {
    Range x, y;
};

/// Least tangent of half a light's view: cameras are no narrower (kMinFov).
inline constexpr double kNarrowestView = 1e-5;

/// A square view. Directional: half is half its side, and the middle of its near side is the eye.
struct FittedView {
    ViewAxes axes;
    Vec3d eye;
    double half = 0;    ///< directional: world units; otherwise the tangent of half the angle
    double near_z = 0;  ///< distance of the nearest thing that may cast a shadow; 0 or less: some of them lie behind the eye
    double far_z = 0;   ///< distance of the farthest thing
    Extent content;     ///< where the boxes are
};

/// A view from a light that is not fitted to anything. half: the tangent of half its angle.
[[nodiscard]] inline FittedView fixed_view(Vec3d position, Vec3d back, double half) {
    return {axes_for(back), position, half, 0.0, 0.0, {{-half, half}, {-half, half}}};
}

/// The view along parallel light that shows all of `boxes`; its depth is that of `scene`. boxes: at least one.
[[nodiscard]] FittedView fit_directional(Vec3d to_light, std::span<const Bounds> boxes, const Bounds& scene);

/// The view from a light that shows all of `boxes`; nothing if it would be wider than `widest`, the tangent of half its angle.
[[nodiscard]] std::optional<FittedView> fit_lamp(Vec3d position, std::span<const Bounds> boxes, const Bounds& scene, double widest);

}  // namespace halflit::raster
