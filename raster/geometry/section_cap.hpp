// The cap of a section: a flat mesh.
#pragma once

#include "raster/geometry/section_mesh.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace halflit::raster {

/// A plane's section of a part.
struct PlaneSection {
    int instance = -1;                        // the first of the part that is cut; -1: none yet
    std::optional<Mat4> world_from_object{};  // that all its instances have; none: they differ
    std::vector<CutSegment> segments{};
    Vec3f color{1, 1, 1};  // mean of the mesh's colours
};

struct CapMesh {
    Mesh mesh;  // no triangles: nothing is filled, or other planes remove it
    Mat4 world_from_object;
    Vec3f color{1, 1, 1};
    double filled_area = 0.0;  // by the plane alone, square world units
    double area = 0.0;         // less what other planes remove
    std::size_t open_ends = 0;
    bool too_complex = false;
};

/// Fills the section of planes[plane], and keeps what the other planes keep of it. Corners of segments are vertices with the same bits, in
/// the space of the instances if they have one matrix. Texture coordinates are those in the plane times uv_scale.
[[nodiscard]] CapMesh make_cap(const PlaneSection& section, std::span<const UnitPlane> planes, std::size_t plane, double uv_scale);

}  // namespace halflit::raster
