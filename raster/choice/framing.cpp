#include "raster/choice/framing.hpp"

#include "halflit/scene.hpp"
#include "raster/choice/view_fit.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
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

/// True if nothing in a placed box can change the fit. center: what the fit's points are relative to.
template <class Fit>
bool has_box(const Fit& fit, const Bounds& bounds, const Mat4& world_from_object, Vec3d center) {
    if (bounds.empty) return true;
    const Vec3f &low = bounds.min, &high = bounds.max;
    const PlacedBox box({low.x, low.y, low.z}, {high.x, high.y, high.z}, world_from_object);
    for (int k = 0; k < 8; ++k) {
        const Vec3d corner{k & 1 ? box.high[0] : box.low[0], k & 2 ? box.high[1] : box.low[1], k & 4 ? box.high[2] : box.low[2]};
        if (!fit.has(corner - center)) return false;
    }
    return true;
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
    return has_box(fit, used.bounds, world_from_object, center);
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
    FramedPoints(const Scene& scene, const FramedPart& part, const Bounds& bounds) : scene_(&scene), part_(&part) {
        const Bounds& framed = part.whole ? bounds : part.bounds;
        box_ = usable_box(framed);
        by_box_ = framed.empty || !(framed.radius() > 1e-5 * length(box_.center)) || !(framed.radius() < kMaxCoordinate);
        if (!by_box_) measure_balls();
    }
    explicit FramedPoints(const Bounds& bounds) : box_(usable_box(bounds)) {}

    [[nodiscard]] const Box& box() const { return box_; }
    /// True if there are triangles, which cast a shadow.
    [[nodiscard]] bool any_triangles() const {
        return part_ != nullptr && std::any_of(part_->instances.begin(), part_->instances.end(), [&](int i) {
                   const int mesh = scene_->instances[static_cast<std::size_t>(i)].mesh;
                   return triangles_of(scene_->meshes[static_cast<std::size_t>(mesh)]) > 0;
               });
    }

    /// fit: has add(p), and has(p), which is true if adding p would change nothing.
    template <class Fit>
    void add_to(Fit& fit) const {
        const Vec3d& half = box_.half;
        if (by_box_)
            for (int k = 0; k < 8; ++k) fit.add({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
        TimeCheck check;
        for (const int i : by_box_ ? std::vector<int>{} : part_->instances) {
            check();
            const Instance& instance = scene_->instances[static_cast<std::size_t>(i)];
            const Mesh& mesh = scene_->meshes[static_cast<std::size_t>(instance.mesh)];
            const FramedVertices& vertices = part_->meshes[static_cast<std::size_t>(instance.mesh)];
            const double radius = radii_[static_cast<std::size_t>(instance.mesh)];
            if (is_seen_already(fit, vertices, radius, instance.world_from_object, box_.center)) continue;
            for (std::size_t b = 0; b < vertices.blocks.size(); ++b) {
                check();
                if (has_box(fit, vertices.blocks[b], instance.world_from_object, box_.center)) continue;
                const std::size_t first = b * FramedVertices::kBlock,
                                  end = std::min(first + FramedVertices::kBlock, vertices.vertices.size());
                for (std::size_t k = first; k < end; ++k) {
                    check();
                    const Vec3f p = transform_point(instance.world_from_object, mesh.positions[vertices.vertices[k]]);
                    if (finite(p)) fit.add(to_double(p) - box_.center);
                }
            }
            for (const Vec3f& point : vertices.points) fit.add(to_double(transform_point(instance.world_from_object, point)) - box_.center);
        }
    }

private:
    /// Sets the radii of meshes that several instances have.
    void measure_balls() {
        std::vector<int> instances(scene_->meshes.size());
        for (const int i : part_->instances) {
            const Instance& instance = scene_->instances[static_cast<std::size_t>(i)];
            ++instances[static_cast<std::size_t>(instance.mesh)];
        }
        radii_.assign(scene_->meshes.size(), -1.0);
        TimeCheck check;
        for (std::size_t m = 0; m < radii_.size(); ++m) {
            if (instances[m] < 2 || part_->meshes[m].bounds.empty) continue;
            const Vec3d center = to_double(part_->meshes[m].bounds.center());
            double squared = 0.0;
            const auto add = [&](const Vec3f& at) {
                check();
                const Vec3d p = to_double(at) - center;
                if (finite(at)) squared = larger(squared, dot(p, p));
            };
            for (const std::uint32_t v : part_->meshes[m].vertices) add(scene_->meshes[m].positions[v]);
            for (const Vec3f& at : part_->meshes[m].points) add(at);
            radii_[m] = std::sqrt(squared);
        }
    }

    const Scene* scene_ = nullptr;
    const FramedPart* part_ = nullptr;
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

/// The box around all that lies a little above the lowest point, across the ground.
class Foot {
public:
    explicit Foot(const Box& box) : top_(-box.half.y + kHeight * 2.0 * box.half.y + 1e-6 * length(box.half)) {}
    [[nodiscard]] bool has(Vec3d p) const { return p.y > top_; }
    [[nodiscard]] bool has_ball(Vec3d p, double radius) const { return p.y - radius > top_; }
    void add(Vec3d p) {
        if (!has(p)) x_.add(p.x), z_.add(p.z);
    }
    /// Calls visit(x, z) for points of a rectangle with round corners, so far around the foot.
    template <class Visit>
    void each_around(double distance, const Visit& visit) const {
        constexpr double kDiagonal = 0.70710678118654752;
        for (const double side_x : {-1.0, 1.0})
            for (const double side_z : {-1.0, 1.0}) {
                const double x = side_x < 0.0 ? x_.low : x_.high, z = side_z < 0.0 ? z_.low : z_.high;
                visit(x + side_x * distance, z);
                visit(x, z + side_z * distance);
                visit(x + side_x * kDiagonal * distance, z + side_z * kDiagonal * distance);
            }
    }

private:
    static constexpr double kHeight = 0.02;  ///< of the box
    double top_;
    FitSpan x_, z_;
};

/// Moves a camera down and away so far that the contact shadow below what it sees is not cut off by the picture's border: up to some
/// hundredths of its side. The model keeps a margin above.
Camera with_room_for_shadow(const FramedPoints& points, float aspect, const ViewSettings& view, const Camera& fitted_camera) {
    constexpr double kSeen = 0.24;       // reach of the shadow beside the foot as far as it is seen, over the longest side
    constexpr double kMostMoved = 0.07;  // over half the picture's height
    constexpr double kSmallest = 0.945;  // factor on the model's size
    const ViewSettings usual;
    const bool as_usual = view.margin_x == usual.margin_x && view.margin_y == usual.margin_y && view.zoom <= 1.0f && !view.any_side;
    if (!as_usual || view.orthographic || !points.any_triangles() || !(view.elevation_deg > 0.0f && view.elevation_deg < 90.0f))
        return fitted_camera;
    const Vec3d half = points.box().half;
    Foot foot(points.box());
    points.add_to(foot);
    const Mat4& m = fitted_camera.world_from_camera;
    const double tan_y = half_angle_tangent(usable_fov(static_cast<float>(view.fov_y_deg * (kPi / 180.0))));
    double across = 0.0, below = 0.0, distance = 0.0;
    foot.each_around(kSeen * 2.0 * larger(larger(half.x, half.y), half.z), [&](double x, double z) {
        const Vec3d p = points.box().center + Vec3d{x, -half.y, z} - axis(m, 3);
        const double depth = -dot(p, axis(m, 2));
        if (!(depth > 0.0)) return;
        across = larger(across, magnitude(dot(p, axis(m, 0))) / (depth * tan_y * usable_aspect(aspect)));
        below = larger(below, -dot(p, axis(m, 1)) / (depth * tan_y));
    });
    distance = -dot(points.box().center - axis(m, 3), axis(m, 2));
    const double moved = clamped(below - 1.0, 0.0, kMostMoved);
    const double size = clamped(1.0 / larger(larger(across, below / (1.0 + moved)), 1.0), kSmallest, 1.0);
    if (!(distance > 0.0) || (moved == 0.0 && size == 1.0)) return fitted_camera;
    ViewSettings smaller = view;
    smaller.margin_x = 1.0 - (1.0 - view.margin_x) * size, smaller.margin_y = 1.0 - (1.0 - view.margin_y) * size;
    Camera camera = size < 1.0 ? fitted(points, aspect, smaller) : fitted_camera;
    const Vec3d eye = axis(camera.world_from_camera, 3) - axis(camera.world_from_camera, 1) * (moved * tan_y * distance / size);
    camera.world_from_camera.c[3] = column(eye, 1);
    return camera;
}

}  // namespace

Mat4 orbit(Vec3d target, double azimuth_deg, double elevation_deg, double distance) {
    const FpEnvironment environment_of_host;
    const OrbitAxes axes = orbit_axes(azimuth_deg, elevation_deg);
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
    return raster::frame_with_shadow(scene, framed_part(scene), bounds, aspect, view);
}

Camera raster::frame_with_shadow(const Scene& scene, const FramedPart& part, const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FramedPoints points(scene, part, bounds);
    return with_room_for_shadow(points, aspect, view, fitted(points, aspect, view));
}

std::vector<Camera> frame_each(const Scene& scene, const Bounds& bounds, float aspect, std::span<const ViewSettings> views) {
    const FpEnvironment environment_of_host;
    const FramedPart part = framed_part(scene);
    const FramedPoints points(scene, part, bounds);
    std::vector<Camera> cameras;
    for (const ViewSettings& view : views) cameras.push_back(with_room_for_shadow(points, aspect, view, fitted(points, aspect, view)));
    return cameras;
}

std::vector<Camera> frame_views(const Scene& scene, const Bounds& bounds, float aspect, std::span<const ViewSettings> views) {
    const FpEnvironment environment_of_host;
    const FramedPart part = framed_part(scene);
    return fitted_together(FramedPoints(scene, part, bounds), aspect, views);
}

}  // namespace halflit
