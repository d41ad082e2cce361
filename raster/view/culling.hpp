// What of an instance a view can leave out because it would draw nothing of it: clusters outside the view, and clusters that face away.
// A cluster is left out only where every one of its triangles is sure to be dropped later on, whatever float32 and the window's grid
// make of its vertices; so culling changes no pixel and no count of drawn triangles.
#pragma once

#include "raster/scene/prepared_mesh.hpp"
#include "raster/view/view.hpp"

namespace halflit::raster {

/// a * b with each entry summed in double and rounded once, so that large offsets which cancel keep their low bits.
[[nodiscard]] Mat4 multiply_in_double(const Mat4& a, const Mat4& b);

class Culler {
public:
    /// `back_faces`: these are left out. `mirrored`: the instance's placing turns its outside in.
    Culler(const View& view, const Mat4& clip_from_object, bool mirrored, bool back_faces);

    enum class Verdict { outside, inside, crossing };
    /// A box in object space: `outside` where nothing in it is seen, `inside` where no side of the view cuts it.
    [[nodiscard]] Verdict box(const float (&min)[3], const float (&max)[3]) const;

    /// Whether all triangles of a cluster turn their backs, and surely so: a triangle may be turned round when its corners snap to the
    /// window's grid of 1/256 pixel, if it is thinner there than a hundredth of a pixel.
    [[nodiscard]] bool faces_away(const Cluster& cluster) const;

private:
    static constexpr int kPlanes = 6;
    /// g . p + offset >= 0 inside; |g| and |offset| sums for rounding errors.
    struct Plane {
        double g[3], offset, size[3], size_offset;
    };
    /// clip x, y, z or w as a function of the position.
    struct Row {
        double g[3], offset;
    };
    struct Range {
        double middle, half, size;  ///< over a box; `size` bounds the sum of its terms' magnitudes
    };
    [[nodiscard]] static Range range(const Row& row, const double (&middle)[3], const double (&half)[3]);

    Row row_[4];
    Plane plane_[kPlanes];
    double guard_x_, guard_y_, half_width_, half_height_;
    double determinant_, eye_[3];  ///< D = N . (eye + determinant p): see culling.cpp
    double side_;                  ///< D side < 0 for back faces
    bool back_faces_;
};

}  // namespace halflit::raster
