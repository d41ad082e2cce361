#include "reference.hpp"

#include <cmath>
#include <limits>

namespace halflit::raster::reference {
namespace {

/// Twice the signed area of the triangle a, b, p. Differences are below 2^31, so nothing overflows.
std::int64_t doubled_area(FixedPoint a, FixedPoint b, FixedPoint p) { return (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y); }

int sign(std::int64_t v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

/// True if the line through a and b is a left or a top edge of the triangle whose third corner is c.
bool owns_its_points(FixedPoint a, FixedPoint b, FixedPoint c) {
    if (a.y == b.y) return c.y > a.y;  // level: y points down, so the triangle lies below it
    // Going down the line with y down, everything on its right has negative area: (0, 0), (0, 1), (1, 0) gives -1.
    const FixedPoint upper = a.y < b.y ? a : b, lower = a.y < b.y ? b : a;
    return doubled_area(upper, lower, c) < 0;
}

/// An edge, with its test of a point of the triangle: on the same side as the third corner, or on the line if the edge owns its points.
struct Side {
    FixedPoint a, b;
    int inner_sign;
    bool owns;
    [[nodiscard]] bool admits(FixedPoint p) const {
        const std::int64_t area = inner_sign * doubled_area(a, b, p);
        return area > 0 || (area == 0 && owns);
    }
};

Side side_of(const FixedTriangle& t, int k) {
    const FixedPoint a = t.corner[k], b = t.corner[(k + 1) % 3], c = t.corner[(k + 2) % 3];
    return {a, b, sign(doubled_area(a, b, c)), owns_its_points(a, b, c)};
}

}  // namespace

bool covers(const FixedTriangle& triangle, FixedPoint p) {
    if (doubled_area(triangle.corner[0], triangle.corner[1], triangle.corner[2]) == 0) return false;
    return side_of(triangle, 0).admits(p) && side_of(triangle, 1).admits(p) && side_of(triangle, 2).admits(p);
}

void cover_window(const FixedTriangle& triangle, PixelWindow window, int dx, int dy, std::span<std::uint8_t> covered) {
    const bool has_area = doubled_area(triangle.corner[0], triangle.corner[1], triangle.corner[2]) != 0;
    const Side side[3] = {side_of(triangle, 0), side_of(triangle, 1), side_of(triangle, 2)};
    for (int j = 0; j < window.height; ++j) {
        for (int i = 0; i < window.width; ++i) {
            const FixedPoint p{256 * static_cast<std::int64_t>(window.x + i) + dx, 256 * static_cast<std::int64_t>(window.y + j) + dy};
            const bool in = has_area & side[0].admits(p) & side[1].admits(p) & side[2].admits(p);
            covered[static_cast<std::size_t>(j) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(i)] = in ? 1 : 0;
        }
    }
}

double HomogeneousTriangle::Plane::distance(double value) const {
    const double slope = std::hypot(dx, dy);
    return slope > 0 ? value / slope : value < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

HomogeneousTriangle::HomogeneousTriangle(const double (&clip)[3][4], int width, int height) {
    // The inverse of the matrix with columns (x_i, y_i, w_i) has the rows cross(v_j, v_k) / det.
    const auto cross = [&](int j, int k, double(&row)[3]) {
        const double *a = clip[j], *b = clip[k];
        row[0] = a[1] * b[3] - a[3] * b[1];
        row[1] = a[3] * b[0] - a[0] * b[3];
        row[2] = a[0] * b[1] - a[1] * b[0];
    };
    double rows[3][3];
    for (int i = 0; i < 3; ++i) cross((i + 1) % 3, (i + 2) % 3, rows[i]);
    const double det = (clip[0][0] * rows[0][0] + clip[0][1] * rows[0][1]) + clip[0][3] * rows[0][2];
    degenerate_ = !(std::abs(det) > 0.0) || !std::isfinite(det);
    front_facing_ = det > 0.0;
    if (degenerate_) return;
    // X = 2 x / width - 1, Y = 1 - 2 y / height
    for (int i = 0; i < 3; ++i) {
        const double gx = rows[i][0] / det, gy = rows[i][1] / det;
        weight_[i] = {rows[i][2] / det - gx + gy, 2.0 * gx / width, -2.0 * gy / height};
        sum_ = {sum_.at0 + weight_[i].at0, sum_.dx + weight_[i].dx, sum_.dy + weight_[i].dy};
        depth_ = {depth_.at0 + clip[i][2] * weight_[i].at0, depth_.dx + clip[i][2] * weight_[i].dx, depth_.dy + clip[i][2] * weight_[i].dy};
    }
}

HomogeneousTriangle::Point HomogeneousTriangle::at(double x_px, double y_px) const {
    Point p{};
    const double sum = sum_(x_px, y_px);
    for (int i = 0; i < 3; ++i) {
        const double k = weight_[i](x_px, y_px);
        p.barycentric[i] = k / sum;
        p.edge_px[i] = weight_[i].distance(k);
    }
    p.depth = depth_(x_px, y_px);
    p.near_px = depth_.distance(1.0 - p.depth);
    p.far_px = depth_.distance(p.depth);
    return p;
}

HomogeneousTriangle::Slope HomogeneousTriangle::barycentric_slope(int i, double x_px, double y_px) const {
    const double sum = sum_(x_px, y_px), b = weight_[i](x_px, y_px) / sum;
    return {(weight_[i].dx - b * sum_.dx) / sum, (weight_[i].dy - b * sum_.dy) / sum};
}

}  // namespace halflit::raster::reference
