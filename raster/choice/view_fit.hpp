// Cameras that see a set of points.
#pragma once

#include "halflit/camera.hpp"
#include "raster/detail/view_math.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <cmath>

namespace halflit::raster {

struct OrbitAxes {
    Vec3d right, up, back;  // camera x, y, z in world space
};

/// Axes of a viewer on a sphere around the origin. The poles are no special case; beyond them the view is upside down.
inline OrbitAxes orbit_axes(double azimuth_deg, double elevation_deg) {
    const SinCos az = sin_cos(finite(azimuth_deg) ? azimuth_deg * (kPi / 180.0) : 0.0);
    const SinCos el = sin_cos(finite(elevation_deg) ? elevation_deg * (kPi / 180.0) : 0.0);
    return {{az.cos, 0.0, -az.sin}, {-el.sin * az.sin, el.cos, -el.sin * az.cos}, {az.sin * el.cos, el.sin, az.cos * el.cos}};
}

inline double usable_margin(double share) { return share > 0.0 ? share < 0.9 ? share : 0.9 : 0.0; }

/// Points on one axis of the picture, as seen from any distance along z. A point (y, z) appears at (y - o) / (d - z) to an eye at (o, d).
/// It lies within +-tangent of the view's middle if o is in [y + tangent z - tangent d, y - tangent z + tangent d].
struct FitExtent {
    struct Point {
        double y = 0.0, z = 0.0;
    };
    double tangent;
    double low = -1e300, high = 1e300;  ///< largest y + tangent z, least y - tangent z
    Point at_low{}, at_high{};          ///< the points that they are of

    [[nodiscard]] bool has(double y, double z) const { return low >= y + tangent * z && high <= y - tangent * z; }
    /// The same of all points within a distance of (y, z).
    [[nodiscard]] bool has_ball(double y, double z, double radius) const {
        const double most = radius * std::sqrt(1.0 + tangent * tangent);
        return low >= y + tangent * z + most && high <= y - tangent * z - most;
    }
    void add(double y, double z) {
        if (y + tangent * z > low) low = y + tangent * z, at_low = {y, z};
        if (y - tangent * z < high) high = y - tangent * z, at_high = {y, z};
    }
    /// All points (y, z) within a distance of (0, 0).
    void add_ball(double radius) {
        const double most = radius * std::sqrt(1.0 + tangent * tangent);
        if (most > low) low = most;
        if (-most < high) high = -most;
    }
    /// Least distance from which all points lie within the tangent.
    [[nodiscard]] double distance() const { return (low - high) / (2.0 * tangent); }
    /// The same for an eye at this place.
    [[nodiscard]] double distance_from(double o) const { return larger(low - o, o - high) / tangent; }
    /// Place of an eye that has the two outermost points equally far from the view's middle, if the tangent is their angle's.
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    /// That tangent, for an eye at distance d: a step of Newton's method to low - high = 2 tangent d.
    [[nodiscard]] double balanced(double d) const {
        const double depth = (d - at_low.z) + (d - at_high.z);
        return depth > 0.0 ? (at_low.y - at_high.y) / depth : tangent;
    }
    /// The place nearest to o from which all points lie within the tangent.
    [[nodiscard]] double nearest(double o, double d) const { return clamped(o, low - tangent * d, high + tangent * d); }
};

/// Least and largest of the numbers added.
struct FitSpan {
    double low = 1e300, high = -1e300;
    [[nodiscard]] bool has(double x) const { return low <= x && x <= high; }
    void add(double x) { low = x < low ? x : low, high = larger(high, x); }
};

/// Finds the nearest camera in a given direction that sees a set of points, then a place for it that has equal margins left and right, and
/// above and below. Each step is a pass over the points.
class ViewFit {
public:
    ViewFit(Vec3d origin, float aspect, const ViewSettings& view)
        : view_(view),
          origin_(origin),
          axes_(orbit_axes(view.azimuth_deg, view.elevation_deg)),
          tan_y_(half_angle_tangent(usable_fov(static_cast<float>(view.fov_y_deg * (kPi / 180.0))))),
          used_x_(1.0 - usable_margin(view.margin_x)),
          used_y_(1.0 - usable_margin(view.margin_y)),
          x_{tan_y_ * usable_aspect(aspect) * used_x_},
          y_{tan_y_ * used_y_},
          aspect_(usable_aspect(aspect)) {}

    /// True if adding the point would change nothing.
    [[nodiscard]] bool has(Vec3d p) const {
        const double x = dot(p, axes_.right), y = dot(p, axes_.up), z = dot(p, axes_.back);
        return x_.has(x, z) && y_.has(y, z) && front_ >= z && (!view_.orthographic || (wide_.has(x) && tall_.has(y) && back_ <= z));
    }

    /// The same of all points within a distance of p.
    [[nodiscard]] bool has_ball(Vec3d p, double radius) const {
        const double x = dot(p, axes_.right), y = dot(p, axes_.up), z = dot(p, axes_.back);
        const auto has = [radius](const FitSpan& span, double at) { return span.has(at - radius) && span.has(at + radius); };
        return x_.has_ball(x, z, radius) && y_.has_ball(y, z, radius) && front_ >= z + radius &&
               (!view_.orthographic || (has(wide_, x) && has(tall_, y) && back_ <= z - radius));
    }

    /// Adds a point, given relative to the origin.
    void add(Vec3d p) {
        const double x = dot(p, axes_.right), y = dot(p, axes_.up), z = dot(p, axes_.back);
        x_.add(x, z);
        y_.add(y, z);
        front_ = larger(front_, z);
        if (view_.orthographic) wide_.add(x), tall_.add(y), back_ = back_ < z ? back_ : z;
    }

    /// Adds all points within a distance of the origin.
    void add_ball(double radius) {
        for (FitExtent* const extent : {&x_, &y_}) extent->add_ball(radius);
        front_ = larger(front_, radius);
        if (view_.orthographic)
            for (const double x : {-radius, radius}) wide_.add(x), tall_.add(x), back_ = back_ < x ? back_ : x;
    }

    /// Sets the distance. radius: size of the set of points; keeps the camera off a set that is seen edge on.
    void choose_distance(double radius) { distance_ = larger(larger(x_.distance(), y_.distance()), front_ + 1e-3 * radius); }
    /// Least distance of an eye before the origin.
    [[nodiscard]] double distance_before_origin(double radius) const {
        return larger(larger(x_.distance_from(0.0), y_.distance_from(0.0)), front_ + 1e-3 * radius);
    }
    /// The same for half the height of a picture by parallel rays.
    [[nodiscard]] double half_height_before_origin() const {
        return larger(larger(-tall_.low, tall_.high) / used_y_, larger(-wide_.low, wide_.high) / aspect_ / used_x_);
    }
    /// An eye before the origin, at a distance that others share.
    [[nodiscard]] Camera camera_before_origin(double distance, double half_height) const {
        ViewFit placed = *this;
        placed.distance_ = distance;
        return placed.camera_at(0.0, 0.0, half_height);
    }

    /// The fit of the next pass, which is nearer to equal margins.
    [[nodiscard]] ViewFit centring() const {
        ViewFit next = *this;
        next.x_ = {x_.balanced(distance_)};
        next.y_ = {y_.balanced(distance_)};
        return next;
    }
    /// True if margins differ by less than a 500th of the picture's side.
    [[nodiscard]] bool is_centred() const {
        const auto close = [&](const FitExtent& e) { return magnitude(e.balanced(distance_) - e.tangent) < 1e-3 * tan_y_; };
        return close(x_) && close(y_);
    }

    /// seen: the fit of the first pass.
    [[nodiscard]] Camera camera(const ViewFit& seen) const {
        const double x = seen.x_.nearest(x_.middle(), distance_), y = seen.y_.nearest(y_.middle(), distance_);
        if (!view_.orthographic) return camera_at(x, y, 0.0);
        // Parallel rays: the extents of the points themselves, in the middle of the picture.
        const double half_x = 0.5 * (seen.wide_.high - seen.wide_.low), half_y = 0.5 * (seen.tall_.high - seen.tall_.low);
        return seen.camera_at(0.5 * (seen.wide_.low + seen.wide_.high), 0.5 * (seen.tall_.low + seen.tall_.high),
                              larger(half_y / used_y_, half_x / aspect_ / used_x_));
    }

private:
    /// The eye at (x, y) across the view; half_height: of the picture by parallel rays.
    [[nodiscard]] Camera camera_at(double x, double y, double half_height) const {
        const Vec3d eye = ((origin_ + axes_.right * x) + axes_.up * y) + axes_.back * distance_;

        // Zoom changes the field of view, not the position; the tangent scales exactly.
        const double zoom = finite(view_.zoom) && view_.zoom > 0.0f ? view_.zoom : 1.0;
        Camera camera;
        camera.world_from_camera = {{column(axes_.right, 0), column(axes_.up, 0), column(axes_.back, 0), column(eye, 1)}};
        camera.fov_y_rad = static_cast<float>(clamped(2.0 * arc_tangent(tan_y_ / zoom), kMinFov, kMaxFov));
        // Near plane: half way to the nearest point, or 1e-4 of the camera's distance if that is more.
        camera.near_z = static_cast<float>(larger(0.5 * (distance_ - front_), 1e-4 * distance_));
        camera.far_z = 0.0f;
        if (view_.orthographic) make_parallel(x, y, half_height, zoom, camera);
        return camera;
    }

    void make_parallel(double x, double y, double half_height, double zoom, Camera& camera) const {
        const double depth = front_ - back_;
        const double half = larger(half_height, 1e-9 * larger(depth, 1e-9));
        // The eye is as far from the nearest point as the set is deep: both planes keep clear of it.
        const double room = larger(depth, half);
        const Vec3d eye = ((origin_ + axes_.right * x) + axes_.up * y) + axes_.back * (front_ + room);
        camera.world_from_camera.c[3] = {static_cast<float>(eye.x), static_cast<float>(eye.y), static_cast<float>(eye.z), 1};
        camera.orthographic = true;
        camera.half_height = static_cast<float>(half / zoom);
        camera.near_z = 0.0f;
        camera.far_z = static_cast<float>(2.0 * room + depth);
    }

    ViewSettings view_;
    Vec3d origin_;
    OrbitAxes axes_;
    double tan_y_;
    double used_x_, used_y_;  // shares of half the picture within the margin
    FitExtent x_, y_;
    double aspect_;
    FitSpan wide_, tall_;    // of orthographic views
    double back_ = 1e300;    // coordinate of the farthest point along `back`, of orthographic views
    double front_ = -1e300;  // coordinate of the nearest point along `back`
    double distance_ = 0.0;  // of the eye along `back`, from the origin
};

}  // namespace halflit::raster
