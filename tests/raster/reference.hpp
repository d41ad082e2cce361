// Reference rasterizer for tests, written for clarity and not for speed. Coverage tests every pixel against every triangle in exact
// integers; depth and attributes solve the projection equation in float64. Nothing here is shared with the kernels.
#pragma once

#include <cstdint>
#include <span>

namespace halflit::raster::reference {

/// Window position in 24.8 fixed point, y down; the centre of pixel (i, j) is (256 i, 256 j). Coordinates below 2^30 in magnitude.
struct FixedPoint {
    std::int64_t x = 0, y = 0;
};

/// A triangle of either winding; one without area covers nothing.
struct FixedTriangle {
    FixedPoint corner[3];
};

/// Fill rule: a point inside is covered. A point on an edge is covered if that edge is a left edge (the triangle lies to its right) or a
/// top edge (level, and the triangle lies below it). A corner is covered if both its edges are such edges.
[[nodiscard]] bool covers(const FixedTriangle& triangle, FixedPoint p);

/// Window of pixels in the picture, stored row by row.
struct PixelWindow {
    int x = 0, y = 0, width = 0, height = 0;
};

/// covered[j * width + i] = 1 where the sample (dx, dy) / 256 pixels from the centre of pixel (x + i, y + j) is covered, else 0.
void cover_window(const FixedTriangle& triangle, PixelWindow window, int dx, int dy, std::span<std::uint8_t> covered);

/// A triangle in homogeneous clip coordinates, rasterized without clipping (Olano and Greer, Triangle Scan Conversion
/// using 2D Homogeneous Coordinates, 1997): for the point with ndc (X, Y) the weights k that solve
/// sum k_i (x_i, y_i, w_i) = (X, Y, 1) are affine in X and Y. The point lies on the triangle, in front of the eye, where
/// all k_i >= 0; its depth is sum k_i z_i, and its barycentric coordinates on the triangle are k_i / sum k.
class HomogeneousTriangle {
public:
    /// clip[i] = x, y, z, w of corner i. Picture of width x height pixels.
    HomogeneousTriangle(const double (&clip)[3][4], int width, int height);

    /// True if the triangle is seen edge on, or has no extent.
    [[nodiscard]] bool degenerate() const { return degenerate_; }
    /// Counter-clockwise as seen by the viewer (y up).
    [[nodiscard]] bool front_facing() const { return front_facing_; }

    struct Point {
        double barycentric[3];   ///< perspective-correct; their sum is 1
        double depth;            ///< z / w
        double edge_px[3];       ///< distance to the line of the edge opposite corner i; positive on the triangle's side
        double near_px, far_px;  ///< distance to the lines where the triangle's plane has depth 1 and depth 0; positive between
    };
    /// Values at window position (x, y), pixels, y down; the centre of the first pixel is (0.5, 0.5).
    [[nodiscard]] Point at(double x_px, double y_px) const;

    /// Change of depth for a step of one pixel to the right, and down.
    [[nodiscard]] double depth_dx() const { return depth_.dx; }
    [[nodiscard]] double depth_dy() const { return depth_.dy; }
    /// Change of barycentric coordinate i for an infinitesimal step, per pixel.
    struct Slope {
        double dx, dy;
    };
    [[nodiscard]] Slope barycentric_slope(int i, double x_px, double y_px) const;

private:
    /// f(x, y) = at0 + dx x + dy y over window positions.
    struct Plane {
        double at0 = 0, dx = 0, dy = 0;
        [[nodiscard]] double operator()(double x, double y) const { return at0 + dx * x + dy * y; }
        [[nodiscard]] double distance(double value) const;  ///< value over the length of the gradient
    };
    Plane weight_[3], sum_, depth_;
    bool degenerate_ = false, front_facing_ = false;
};

}  // namespace halflit::raster::reference
