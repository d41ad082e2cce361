#include "raster/camera.hpp"

#include "sh/trig.hpp"

#include <limits>

namespace halflit::raster {

namespace {

constexpr double kMinFov = 1e-5, kMaxFov = 3.1415;  // rad; tan of the half angle stays within [5e-6, 2.2e4]
constexpr double kFrameMargin = 0.08;               // share of the half picture that stays free on the tighter side
constexpr double kMaxCoordinate = 1e36;             // bounds are cut here so that the camera's place is a finite float

// NaN and infinity minus themselves are not zero.
template <class T>
bool finite(T x) {
    return x - x == T(0);
}

double magnitude(double x) { return x < 0 ? -x : x; }
double larger(double a, double b) { return a < b ? b : a; }
double clamped(double x, double low, double high) { return x < low ? low : high < x ? high : x; }

double half_angle_tangent(double fov_rad) {
    const SinCos h = sin_cos(0.5 * fov_rad);
    return h.sin / h.cos;
}

/// atan(t), t >= 0: Newton on sin h - t cos h, which is proportional to sin(h - atan t). From pi/4 the error is at most pi/4,
/// where the iteration u - tan u converges cubically: 0.785, 0.215, 3.4e-3, 1e-8, below 2^-52.
double arc_tangent(double t) {
    double h = 0.25 * kPi;
    for (int i = 0; i < 6; ++i) {
        const SinCos a = sin_cos(h);
        h = h - (a.sin - t * a.cos) / (a.cos + t * a.sin);
    }
    return h;
}

/// Half extents of the view: tangents for a perspective camera, lengths for an orthographic one.
struct HalfView {
    double x, y;
};

/// The picture shows at least what the camera asks for: of the two extents one is as asked, the other at least so.
HalfView widen_to(HalfView asked, double aspect) {
    if (asked.x < asked.y * aspect) return {asked.y * aspect, asked.y};
    return {asked.x, asked.x / aspect};
}

double usable_aspect(float aspect) { return aspect > 0.0f && finite(aspect) ? clamped(aspect, 1e-6, 1e6) : 1.0; }

double usable_fov(float fov_rad) { return finite(fov_rad) ? clamped(fov_rad, kMinFov, kMaxFov) : 0.25 * kPi; }

HalfView half_view(const Camera& camera, double aspect) {
    HalfView asked{};
    if (camera.orthographic) {
        asked.x = finite(camera.half_width) ? magnitude(camera.half_width) : 0.0;
        asked.y = finite(camera.half_height) ? magnitude(camera.half_height) : 0.0;
        if (asked.y == 0.0) asked.y = asked.x == 0.0 ? 1.0 : asked.x / aspect;
        if (asked.x == 0.0) asked.x = asked.y * aspect;
    } else {
        asked.y = half_angle_tangent(usable_fov(camera.fov_y_rad));
        asked.x = asked.y * (camera.aspect > 0.0f && finite(camera.aspect) ? usable_aspect(camera.aspect) : aspect);
    }
    return widen_to(asked, aspect);
}

/// Rows 2 and 3 of the projection: clip z = z_scale * z_vs + z_offset.
struct DepthMap {
    double z_scale, z_offset;
};

DepthMap perspective_depth(const Camera& camera) {
    const bool has_far = finite(camera.far_z) && camera.far_z > 0.0f;
    double near_z = camera.near_z;
    if (!finite(camera.near_z) || !(camera.near_z > 0.0f)) near_z = has_far ? clamped(camera.far_z * 1e-3, 1e-6, 0.1) : 0.1;
    const double far_z = camera.far_z;
    if (!has_far || !(far_z > near_z)) return {0.0, near_z};
    return {near_z / (far_z - near_z), near_z * far_z / (far_z - near_z)};
}

DepthMap orthographic_depth(const Camera& camera, HalfView half) {
    const double near_z = finite(camera.near_z) ? camera.near_z : 0.0;
    double far_z = camera.far_z;
    // Without a usable far limit: a thousand views deep, and more than the rounding of `near`.
    if (!finite(camera.far_z) || !(far_z > near_z)) far_z = near_z + 1000.0 * larger(half.y, 1e-3 * magnitude(near_z));
    return {1.0 / (far_z - near_z), far_z / (far_z - near_z)};
}

struct Axes {
    Vec3d right, up, back;  // camera x, y, z in world space
};

/// The viewer on a sphere around the origin: no special case at the poles, and past them the view turns over.
Axes orbit_axes(const ViewSettings& view) {
    const SinCos az = sin_cos(finite(view.azimuth_deg) ? view.azimuth_deg * (kPi / 180.0) : 0.0);
    const SinCos el = sin_cos(finite(view.elevation_deg) ? view.elevation_deg * (kPi / 180.0) : 0.0);
    return {{az.cos, 0.0, -az.sin}, {-el.sin * az.sin, el.cos, -el.sin * az.cos}, {az.sin * el.cos, el.sin, az.cos * el.cos}};
}

/// Finite, not empty, and not smaller than what float coordinates at that place can resolve.
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

}  // namespace

void Bounds::add(Vec3f p) {
    if (!finite(p.x) || !finite(p.y) || !finite(p.z)) return;
    if (empty) {
        min = max = p;
        empty = false;
        return;
    }
    min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
    max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
}

Vec3f Bounds::center() const {
    const Vec3d a{min.x, min.y, min.z}, b{max.x, max.y, max.z};
    const Vec3d c = (a + b) * 0.5;
    return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

float Bounds::radius() const {
    const Vec3d a{min.x, min.y, min.z}, b{max.x, max.y, max.z};
    return static_cast<float>(clamped(0.5 * length(b - a), 0.0, std::numeric_limits<float>::max()));
}

Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view) {
    const Axes axes = orbit_axes(view);
    const Box box = usable_box(bounds);
    const double tan_y = half_angle_tangent(usable_fov(static_cast<float>(view.fov_y_deg * (kPi / 180.0))));
    const HalfView inner{tan_y * usable_aspect(aspect) * (1.0 - kFrameMargin), tan_y * (1.0 - kFrameMargin)};

    // The camera stands at center + right * ox + up * oy + back * d. A corner (x, y, z) in those axes is inside when
    // |x - ox| <= inner.x (d - z), i.e. ox lies in [x + inner.x z - inner.x d, x - inner.x z + inner.x d]: the smallest d leaves
    // one ox for all corners, the middle of what is left. Likewise for y.
    struct Slab {
        double low = -1e300, high = 1e300;
    } slab_x, slab_y;
    double front = 0.0;  // the nearest corner, along `back`
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p{corner & 1 ? box.half.x : -box.half.x, corner & 2 ? box.half.y : -box.half.y, corner & 4 ? box.half.z : -box.half.z};
        const double x = dot(p, axes.right), y = dot(p, axes.up), z = dot(p, axes.back);
        slab_x = {larger(slab_x.low, x + inner.x * z), -larger(-slab_x.high, -(x - inner.x * z))};
        slab_y = {larger(slab_y.low, y + inner.y * z), -larger(-slab_y.high, -(y - inner.y * z))};
        front = larger(front, z);
    }
    const double fit = larger((slab_x.low - slab_x.high) / (2.0 * inner.x), (slab_y.low - slab_y.high) / (2.0 * inner.y));
    const double radius = length(box.half);
    const double distance = larger(fit, front + 1e-3 * radius);  // a flat box may be seen edge on
    const Vec3d eye = ((box.center + axes.right * (0.5 * (slab_x.low + slab_x.high))) + axes.up * (0.5 * (slab_y.low + slab_y.high))) +
                      axes.back * distance;

    // Zoom is the lens, not the place: nothing comes nearer, and the tangent scales exactly.
    const double zoom = finite(view.zoom) && view.zoom > 0.0f ? view.zoom : 1.0;
    const auto column = [](Vec3d v, float w) {
        return Vec4f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
    };
    Camera camera;
    camera.world_from_camera = {{column(axes.right, 0), column(axes.up, 0), column(axes.back, 0), column(eye, 1)}};
    camera.fov_y_rad = static_cast<float>(clamped(2.0 * arc_tangent(tan_y / zoom), kMinFov, kMaxFov));
    // Half way to the nearest corner at least; what lies outside the bounds in front of that is not part of the scene.
    camera.near_z = static_cast<float>(larger(0.5 * (distance - front), 1e-4 * distance));
    camera.far_z = 0.0f;
    return camera;
}

Mat4 clip_from_world(const Camera& camera, float picture_aspect) {
    const HalfView half = half_view(camera, usable_aspect(picture_aspect));
    const DepthMap depth = camera.orthographic ? orthographic_depth(camera, half) : perspective_depth(camera);

    // Inverse of the rigid placing and the product with the projection, in double and rounded once.
    const Mat4& m = camera.world_from_camera;
    const Vec3d axis[3] = {{m.c[0].x, m.c[0].y, m.c[0].z}, {m.c[1].x, m.c[1].y, m.c[1].z}, {m.c[2].x, m.c[2].y, m.c[2].z}};
    const Vec3d eye{m.c[3].x, m.c[3].y, m.c[3].z};
    const auto clip_column = [&](double x_vs, double y_vs, double z_vs, double one) {
        const double w = camera.orthographic ? one : -z_vs;
        return Vec4f{static_cast<float>(x_vs / half.x), static_cast<float>(y_vs / half.y),
                     static_cast<float>(depth.z_scale * z_vs + depth.z_offset * one), static_cast<float>(w)};
    };
    return {{clip_column(axis[0].x, axis[1].x, axis[2].x, 0.0), clip_column(axis[0].y, axis[1].y, axis[2].y, 0.0),
             clip_column(axis[0].z, axis[1].z, axis[2].z, 0.0),
             clip_column(-dot(axis[0], eye), -dot(axis[1], eye), -dot(axis[2], eye), 1.0)}};
}

}  // namespace halflit::raster
