// Culling: leaves out the clusters of an instance that lie outside a view or face away from it. A cluster is left out only if each of its
// triangles would certainly be dropped later, whichever way float32 and the window's grid of 1/256 pixel round its vertices. So culling
// changes no pixel and no count of drawn triangles.
#pragma once

#include "raster/scene/prepared_mesh.hpp"
#include "raster/view/view.hpp"

namespace halflit::raster {

/// a * b with each entry summed in double and rounded once, so that large offsets which cancel keep their low bits.
[[nodiscard]] Mat4 multiply_in_double(const Mat4& a, const Mat4& b);

class Culler {
public:
    /// back_faces: true leaves out back faces. mirrored: the instance's transform has a negative determinant. margin_px: how far outside of
    /// its box an object is drawn, as lines and points are.
    Culler(const View& view, const Mat4& clip_from_object, bool mirrored, bool back_faces, double margin_px = 0.0);

    enum class Verdict { outside, inside, crossing };
    /// Tests a box in object space. outside: the view sees nothing of it. inside: no plane of the view cuts it.
    [[nodiscard]] Verdict box(const float (&min)[3], const float (&max)[3]) const;

    /// True if all triangles of a cluster are certainly back faces. Triangles thinner than about a hundredth of a pixel are not certain:
    /// snapping their corners to the window's grid of 1/256 pixel may turn them over.
    [[nodiscard]] bool faces_away(const Cluster& cluster) const;

private:
    static constexpr int kPlanes = 6;
    /// Inside: g . p + offset >= 0. size, size_offset: sums of the magnitudes that make up g and offset, for the rounding error.
    struct Plane {
        double g[3], offset, size[3], size_offset;
    };
    /// Clip coordinate x, y, z or w of a position p: g . p + offset.
    struct Row {
        double g[3], offset;
    };
    /// Values of a row over a box: from middle - half to middle + half. size: bound on the sum of the magnitudes of the row's terms.
    struct Range {
        double middle, half, size;
    };
    [[nodiscard]] static Range range(const Row& row, const double (&middle)[3], const double (&half)[3]);

    Row row_[4];
    Plane plane_[kPlanes];
    double guard_x_, guard_y_, half_width_, half_height_;
    double determinant_, eye_[3];  ///< D = N . (eye + determinant p), see culling.cpp
    double side_;                  ///< -1 if mirrored, else +1: D side < 0 for back faces
    bool back_faces_;
};

}  // namespace halflit::raster
