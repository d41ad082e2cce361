#include "raster/view/culling.hpp"

#include "raster/detail/view_math.hpp"

namespace halflit::raster {
namespace {

/// Bound on the rounding error of a clip coordinate, relative to the sum of its terms' magnitudes: twice that of three products and three
/// sums in float32.
constexpr double kClipError = 5e-7;
/// Bound on the rounding error of a clip coordinate among denormals: six roundings to multiples of 1.4e-45.
constexpr double kDenormalError = 1e-44;
/// From this size on a clip coordinate may be infinite in float32. Its triangles must be kept, because they are counted as not finite.
constexpr double kHuge = 1e37;

double length3(const double (&v)[3]) { return __builtin_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
double dot3(const double (&a)[3], const double (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

Mat4 multiply_in_double(const Mat4& a, const Mat4& b) {
    Mat4 out;
    const Vec4f* ac = a.c;
    for (int j = 0; j < 4; ++j) {
        const Vec4f v = b.c[j];
        const auto row = [&](float x0, float x1, float x2, float x3) {
            return static_cast<float>(((static_cast<double>(x0) * v.x + static_cast<double>(x1) * v.y) + static_cast<double>(x2) * v.z) +
                                      static_cast<double>(x3) * v.w);
        };
        out.c[j] = {row(ac[0].x, ac[1].x, ac[2].x, ac[3].x), row(ac[0].y, ac[1].y, ac[2].y, ac[3].y),
                    row(ac[0].z, ac[1].z, ac[2].z, ac[3].z), row(ac[0].w, ac[1].w, ac[2].w, ac[3].w)};
    }
    return out;
}

Culler::Culler(const View& view, const Mat4& m, bool mirrored, bool back_faces, double margin_px)
    : row_{{{m.c[0].x, m.c[1].x, m.c[2].x}, m.c[3].x},
           {{m.c[0].y, m.c[1].y, m.c[2].y}, m.c[3].y},
           {{m.c[0].z, m.c[1].z, m.c[2].z}, m.c[3].z},
           {{m.c[0].w, m.c[1].w, m.c[2].w}, m.c[3].w}},
      guard_x_(view.viewport.guard_x),
      guard_y_(view.viewport.guard_y),
      half_width_(view.viewport.half_width),
      half_height_(view.viewport.half_height),
      side_(mirrored ? -1.0 : 1.0),
      back_faces_(back_faces) {
    // Sides of the region in ndc, one pixel outside of what is drawn, but never outside the window, but for the margin.
    const Region& r = view.region;
    const auto ndc = [](double pixel, double half) { return pixel / half - 1.0; };
    const double end_x = 1.0 + margin_px / half_width_, end_y = 1.0 + margin_px / half_height_;
    const double left = larger(-end_x, ndc(r.x - 1 - margin_px, half_width_)),
                 right = -larger(-end_x, -ndc(r.x + r.width + 1 + margin_px, half_width_));
    const double top = larger(-end_y, ndc(r.y - 1 - margin_px, half_height_)),
                 bottom = -larger(-end_y, -ndc(r.y + r.height + 1 + margin_px, half_height_));
    const auto plane = [&](int a, double factor_a, double factor_w) {
        Plane p{};
        const Row &row = row_[a], &w = row_[3];
        for (int k = 0; k < 3; ++k) {
            p.g[k] = factor_a * row.g[k] + factor_w * w.g[k];
            p.size[k] = magnitude(row.g[k]) + larger(1.0, magnitude(factor_w)) * magnitude(w.g[k]);
        }
        p.offset = factor_a * row.offset + factor_w * w.offset;
        p.size_offset = magnitude(row.offset) + larger(1.0, magnitude(factor_w)) * magnitude(w.offset);
        return p;
    };
    plane_[0] = plane(0, 1.0, -left);   // x >= left w
    plane_[1] = plane(0, -1.0, right);  // x <= right w
    plane_[2] = plane(1, -1.0, -top);   // -y >= top w: the window's y points down
    plane_[3] = plane(1, 1.0, bottom);  // -y <= bottom w
    plane_[4] = plane(2, 1.0, 0.0);     // z >= 0: not beyond the far plane
    plane_[5] = plane(2, -1.0, 1.0);    // z <= w: not before the near plane

    // A triangle with w > 0 has the doubled area D / (w0 w1 w2) in ndc, where D is the determinant of its corners' clip (x, y, w). Let C be
    // the first three columns of the matrix rows x, y and w, and c3 their fourth column. Then D = c3 . cof(C) N + det(C) N . p, where
    // N = (p1 - p0) x (p2 - p0) is the triangle's normal and p any of its points.
    const Vec3d c[4] = {
        {m.c[0].x, m.c[0].y, m.c[0].w}, {m.c[1].x, m.c[1].y, m.c[1].w}, {m.c[2].x, m.c[2].y, m.c[2].w}, {m.c[3].x, m.c[3].y, m.c[3].w}};
    determinant_ = dot(c[0], cross(c[1], c[2]));
    eye_[0] = dot(c[3], cross(c[1], c[2]));
    eye_[1] = dot(c[3], cross(c[2], c[0]));
    eye_[2] = dot(c[3], cross(c[0], c[1]));
}

Culler::Range Culler::range(const Row& row, const double (&middle)[3], const double (&half)[3]) {
    Range out{row.offset, 0.0, magnitude(row.offset)};
    for (int k = 0; k < 3; ++k) {
        out.middle += row.g[k] * middle[k];
        out.half += magnitude(row.g[k]) * half[k];
        out.size += magnitude(row.g[k]) * (magnitude(middle[k]) + half[k]);
    }
    return out;
}

Culler::Verdict Culler::box(const float (&min)[3], const float (&max)[3]) const {
    double middle[3], half[3], most[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (static_cast<double>(min[k]) + max[k]);
        half[k] = 0.5 * (static_cast<double>(max[k]) - min[k]);
        most[k] = larger(magnitude(min[k]), magnitude(max[k]));
    }
    bool inside = true, outside = false;
    for (const Plane& p : plane_) {
        double value = p.offset, spread = 0.0, size = p.size_offset;
        for (int k = 0; k < 3; ++k) {
            value += p.g[k] * middle[k];
            spread += magnitude(p.g[k]) * half[k];
            size += p.size[k] * most[k];
        }
        if (!(size < kHuge)) return Verdict::crossing;
        const double error = kClipError * size + kDenormalError;
        outside |= value + spread < -error;
        inside &= value - spread > error;
    }
    return outside ? Verdict::outside : inside ? Verdict::inside : Verdict::crossing;
}

bool Culler::faces_away(const Cluster& cluster) const {
    if (!back_faces_ || !(cluster.cone_sine <= 1.0f) || !cluster.finite) return false;
    double middle[3], half[3], axis[3], towards[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (static_cast<double>(cluster.min[k]) + cluster.max[k]);
        half[k] = 0.5 * (static_cast<double>(cluster.max[k]) - cluster.min[k]);
        axis[k] = cluster.cone_axis[k];
        towards[k] = -side_ * (eye_[k] + determinant_ * middle[k]);
    }
    // least: lower bound of N . towards over all unit normals N in the cone and all points of the box.
    const double along = dot3(axis, towards), length = length3(towards);
    const double across = __builtin_sqrt(larger(0.0, length * length - along * along)) + 1e-6 * length;
    const double least = along * cluster.cone_cosine - across * cluster.cone_sine - magnitude(determinant_) * length3(half);
    if (!(least > 0.0)) return false;

    // No triangle may need clipping, and each must be so thick in the window that snapping its corners cannot turn it over.
    const Range x = range(row_[0], middle, half), y = range(row_[1], middle, half), z = range(row_[2], middle, half),
                w = range(row_[3], middle, half);
    if (!(x.size + y.size + z.size + w.size < kHuge)) return false;
    const double error_w = kClipError * w.size + kDenormalError, w_min = w.middle - w.half - error_w, w_max = w.middle + w.half;
    if (!(w_min > 4.0 * error_w && w_min > 10.0 * kLeastW)) return false;  // smaller w is clipped
    if (!(w_min - (z.middle + z.half) > kClipError * z.size + kDenormalError)) return false;
    const double x_most = (magnitude(x.middle) + x.half) / w_min, y_most = (magnitude(y.middle) + y.half) / w_min;
    if (!(x_most < 0.99 * guard_x_ && y_most < 0.99 * guard_y_)) return false;
    // dx, dy: upper bounds on the extent in the window, pixels times w_min, of an edge of length 1 in object space.
    const double w_slope = length3(row_[3].g);
    const double dx = half_width_ * (length3(row_[0].g) + x_most * w_slope), dy = half_height_ * (length3(row_[1].g) + y_most * w_slope);
    const double altitude =
        cluster.least_altitude * least * half_width_ * half_height_ * w_min / (w_max * w_max * w_max * __builtin_sqrt(dx * dx + dy * dy));
    // moved: bound on the displacement of a corner in x or y, pixels. Half a step of the grid, plus the float32 rounding of clip x and w,
    // of the division and of the window mapping.
    const auto error = [&](const Range& coordinate, double most, double half_size) {
        return half_size * (1.01 * kClipError * (coordinate.size + most * w.size) / w_min + 5e-7 * (most + 1.0));
    };
    const double moved = 1.0 / 512.0 + larger(error(x, x_most, half_width_), error(y, y_most, half_height_));
    // Moving each corner by d changes the doubled area by at most 4 d L + 4 d^2, where L is the longest edge. That is less than the doubled
    // area if the altitude is at least 5 d. d is at most sqrt(2) times the larger of the displacements in x and y.
    return altitude > 5.0 * 1.41421357 * moved;
}

}  // namespace halflit::raster
