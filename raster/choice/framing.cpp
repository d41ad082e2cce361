#include "halflit/camera.hpp"

#include "halflit/scene.hpp"
#include "raster/choice/framed_part.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
#include "sh/arc.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>

namespace halflit {

using namespace raster;
namespace {

constexpr double kMaxCoordinate = 1e36;  // bounds are clamped to this, so that the camera's position is a finite float

struct Axes {
    Vec3d right, up, back;  // camera x, y, z in world space
};

/// Axes of a viewer on a sphere around the origin. The poles are no special case; beyond them the view is upside down.
Axes orbit_axes(double azimuth_deg, double elevation_deg) {
    const SinCos az = sin_cos(finite(azimuth_deg) ? azimuth_deg * (kPi / 180.0) : 0.0);
    const SinCos el = sin_cos(finite(elevation_deg) ? elevation_deg * (kPi / 180.0) : 0.0);
    return {{az.cos, 0.0, -az.sin}, {-el.sin * az.sin, el.cos, -el.sin * az.cos}, {az.sin * el.cos, el.sin, az.cos * el.cos}};
}

double usable_margin(double share) { return share > 0.0 ? share < 0.9 ? share : 0.9 : 0.0; }

/// Box that is finite, not empty, and not smaller than the resolution of float coordinates at its position.
struct Box {
    Vec3d center, half;
};

Box usable_box(const Bounds& bounds) {
    if (bounds.empty) return {{0, 0, 0}, {0.5, 0.5, 0.5}};
    const auto low = [](float a) { return clamped(a, -kMaxCoordinate, kMaxCoordinate); };
    const Vec3d a{low(bounds.min.x), low(bounds.min.y), low(bounds.min.z)}, b{low(bounds.max.x), low(bounds.max.y), low(bounds.max.z)};
    Box box{(a + b) * 0.5, (b - a) * 0.5};
    if (!(length(box.half) > 1e-6 * length(box.center))) {
        const double least = length(box.half) > 0.0 || length(box.center) > 0.0 ? larger(1e-6 * length(box.center), 1e-30) : 0.5;
        box.half = {larger(box.half.x, least), larger(box.half.y, least), larger(box.half.z, least)};
    }
    return box;
}

/// Points on one axis of the picture, as seen from any distance along z. A point (y, z) appears at (y - o) / (d - z) to an eye at (o, d).
/// It lies within +-tangent of the view's middle if o is in [y + tangent z - tangent d, y - tangent z + tangent d].
struct Extent {
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
struct Span {
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
        const auto has = [radius](const Span& span, double at) { return span.has(at - radius) && span.has(at + radius); };
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
        for (Extent* const extent : {&x_, &y_}) extent->add_ball(radius);
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
        const auto close = [&](const Extent& e) { return magnitude(e.balanced(distance_) - e.tangent) < 1e-3 * tan_y_; };
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
    Axes axes_;
    double tan_y_;
    double used_x_, used_y_;  // shares of half the picture within the margin
    Extent x_, y_;
    double aspect_;
    Span wide_, tall_;       // of orthographic views
    double back_ = 1e300;    // coordinate of the farthest point along `back`, of orthographic views
    double front_ = -1e300;  // coordinate of the nearest point along `back`
    double distance_ = 0.0;  // of the eye along `back`, from the origin
};

/// A factor on lengths in a placed object, at least the largest one.
double largest_scale(const Mat4& world_from_object) {
    const auto column_of = [&](int k) { return Vec3d{world_from_object.c[k].x, world_from_object.c[k].y, world_from_object.c[k].z}; };
    const Vec3d axis[3] = {column_of(0), column_of(1), column_of(2)};
    // The square of the largest is the largest eigenvalue of a matrix, which is no larger than a sum over a row.
    double most = 0.0;
    for (const Vec3d& a : axis) {
        double sum = 0.0;
        for (const Vec3d& b : axis) sum += magnitude(dot(a, b));
        most = larger(most, sum);
    }
    return std::sqrt(most);
}

/// True if no vertex of the instance can change the fit, judged by its box, or by a ball around it. In scenes of many instances few are at
/// the rim. radius: of that ball, object space; negative: not known.
template <class Fit>
bool is_seen_already(const Fit& fit, const FramedVertices& used, double radius, const Mat4& world_from_object, Vec3d center) {
    if (used.bounds.empty) return true;
    if (radius >= 0.0) {
        const double scale = largest_scale(world_from_object);
        const Vec3d middle = to_double(transform_point(world_from_object, used.bounds.center()));
        // Points are rounded to float32.
        const double slack = 1e-6 * (length(middle) + scale * length(to_double(used.bounds.center())));
        if (fit.has_ball(middle - center, (1.0 + 1e-6) * scale * radius + slack)) return true;
    }
    const Vec3f &low = used.bounds.min, &high = used.bounds.max;
    const PlacedBox box({low.x, low.y, low.z}, {high.x, high.y, high.z}, world_from_object);
    for (int k = 0; k < 8; ++k) {
        const Vec3d corner{k & 1 ? box.high[0] : box.low[0], k & 2 ? box.high[1] : box.low[1], k & 4 ? box.high[2] : box.low[2]};
        if (!fit.has(corner - center)) return false;
    }
    return true;
}

/// Squared distance of the farthest point from the origin.
class Ball {
public:
    [[nodiscard]] bool has(Vec3d p) const { return dot(p, p) <= squared_; }
    [[nodiscard]] bool has_ball(Vec3d p, double radius) const { return length(p) + radius <= std::sqrt(squared_) * (1.0 - 1e-12); }
    void add(Vec3d p) { squared_ = larger(squared_, dot(p, p)); }
    [[nodiscard]] double radius() const { return std::sqrt(squared_); }

private:
    double squared_ = 0.0;
};

/// The points that a view is fitted to, relative to the middle of their box: the framed part's vertices, or the corners of a box.
class FramedPoints {
public:
    FramedPoints(const Scene& scene, const Bounds& bounds) : scene_(&scene), part_(framed_part(scene)) {
        const Bounds& framed = part_.whole ? bounds : part_.bounds;
        box_ = usable_box(framed);
        by_box_ = framed.empty || !(framed.radius() > 1e-5 * length(box_.center)) || !(framed.radius() < kMaxCoordinate);
        if (!by_box_) measure_balls();
    }
    explicit FramedPoints(const Bounds& bounds) : box_(usable_box(bounds)) {}

    [[nodiscard]] const Box& box() const { return box_; }

    /// fit: has add(p), and has(p), which is true if adding p would change nothing.
    template <class Fit>
    void add_to(Fit& fit) const {
        const Vec3d& half = box_.half;
        if (by_box_)
            for (int k = 0; k < 8; ++k) fit.add({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
        TimeCheck check;
        for (const int i : by_box_ ? std::vector<int>{} : part_.instances) {
            check();
            const Instance& instance = scene_->instances[static_cast<std::size_t>(i)];
            const Mesh& mesh = scene_->meshes[static_cast<std::size_t>(instance.mesh)];
            const FramedVertices& vertices = part_.meshes[static_cast<std::size_t>(instance.mesh)];
            const double radius = radii_[static_cast<std::size_t>(instance.mesh)];
            if (is_seen_already(fit, vertices, radius, instance.world_from_object, box_.center)) continue;
            for (const std::uint32_t v : vertices.vertices) {
                check();
                const Vec3f p = transform_point(instance.world_from_object, mesh.positions[v]);
                if (finite(p)) fit.add(to_double(p) - box_.center);
            }
        }
    }

private:
    /// Sets the radii of meshes that several instances have.
    void measure_balls() {
        std::vector<int> instances(scene_->meshes.size());
        for (const int i : part_.instances) {
            const Instance& instance = scene_->instances[static_cast<std::size_t>(i)];
            ++instances[static_cast<std::size_t>(instance.mesh)];
        }
        radii_.assign(scene_->meshes.size(), -1.0);
        TimeCheck check;
        for (std::size_t m = 0; m < radii_.size(); ++m) {
            if (instances[m] < 2 || part_.meshes[m].bounds.empty) continue;
            const Vec3d center = to_double(part_.meshes[m].bounds.center());
            double squared = 0.0;
            for (const std::uint32_t v : part_.meshes[m].vertices) {
                check();
                const Vec3d p = to_double(scene_->meshes[m].positions[v]) - center;
                if (finite(scene_->meshes[m].positions[v])) squared = larger(squared, dot(p, p));
            }
            radii_[m] = std::sqrt(squared);
        }
    }

    const Scene* scene_ = nullptr;
    FramedPart part_;
    std::vector<double> radii_;  ///< of each mesh, a ball around the middle of its bounds; negative: not known
    Box box_;
    bool by_box_ = true;
};

/// Views from one distance, with the middle of the box in the middle of each picture.
std::vector<Camera> fitted_together(const FramedPoints& points, float aspect, std::span<const ViewSettings> views) {
    Ball ball;
    if (std::any_of(views.begin(), views.end(), [](const ViewSettings& view) { return view.any_side; })) points.add_to(ball);
    std::vector<ViewFit> fits;
    double distance = 0.0, half_height = 0.0;
    for (const ViewSettings& view : views) {
        ViewFit& fit = fits.emplace_back(points.box().center, aspect, view);
        if (view.any_side)
            fit.add_ball(ball.radius());
        else
            points.add_to(fit);
        distance = larger(distance, fit.distance_before_origin(length(points.box().half)));
        half_height = larger(half_height, fit.half_height_before_origin());
    }
    std::vector<Camera> cameras;
    for (const ViewFit& fit : fits) cameras.push_back(fit.camera_before_origin(distance, half_height));
    return cameras;
}

Camera fitted(const FramedPoints& points, float aspect, const ViewSettings& view) {
    constexpr int kMostPasses = 5;
    if (view.any_side) return fitted_together(points, aspect, {&view, 1}).front();
    const double radius = length(points.box().half);
    ViewFit seen(points.box().center, aspect, view);
    points.add_to(seen);
    seen.choose_distance(radius);
    if (view.orthographic) return seen.camera(seen);  // parallel rays: the first pass has the extents
    ViewFit fit = seen;
    for (int pass = 1; pass < kMostPasses && (pass == 1 || !fit.is_centred()); ++pass) {
        fit = fit.centring();
        points.add_to(fit);
    }
    return fit.camera(seen);
}

}  // namespace

Mat4 orbit(Vec3d target, double azimuth_deg, double elevation_deg, double distance) {
    const FpEnvironment environment_of_host;
    const Axes axes = orbit_axes(azimuth_deg, elevation_deg);
    return {{column(axes.right, 0), column(axes.up, 0), column(axes.back, 0), column(target + axes.back * distance, 1)}};
}

Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    return fitted(FramedPoints(bounds), aspect, view);
}

Camera frame_scene(const Scene& scene, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    return frame_scene(scene, scene_bounds(scene), aspect, view);
}

Camera frame_scene(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    return fitted(FramedPoints(scene, bounds), aspect, view);
}

std::vector<Camera> frame_each(const Scene& scene, const Bounds& bounds, float aspect, std::span<const ViewSettings> views) {
    const FpEnvironment environment_of_host;
    const FramedPoints points(scene, bounds);
    std::vector<Camera> cameras;
    for (const ViewSettings& view : views) cameras.push_back(fitted(points, aspect, view));
    return cameras;
}

std::vector<Camera> frame_views(const Scene& scene, const Bounds& bounds, float aspect, std::span<const ViewSettings> views) {
    const FpEnvironment environment_of_host;
    return fitted_together(FramedPoints(scene, bounds), aspect, views);
}

}  // namespace halflit
