#include "raster/geometry/section_cap.hpp"

#include "raster/geometry/section_fill.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <utility>

namespace halflit::raster {
namespace {

/// Unit axes of a plane, x to the right and y up seen against the normal, where the normal is not vertical.
struct PlaneAxes {
    Vec3d x, y;

    explicit PlaneAxes(Vec3d n) {
        const Vec3d up = absolute(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, n.y > 0.0 ? -1.0 : 1.0};
        const Vec3d right = cross(up, n);
        x = right * (1.0 / length(right));
        y = cross(n, x);
    }
    [[nodiscard]] Vec2<double> at(Vec3d p) const { return {dot(x, p), dot(y, p)}; }
};

/// The inverse of an affine transform in double.
class ObjectSpace {
public:
    explicit ObjectSpace(const Mat4& m) : origin_(axis(m, 3)) {
        const Vec3d a = axis(m, 0), b = axis(m, 1), c = axis(m, 2);
        const double det = dot(a, cross(b, c));
        is_regular_ = absolute(det) > 1e-12 * length(a) * length(b) * length(c);
        if (!is_regular_) return;
        rows_[0] = cross(b, c) * (1.0 / det);
        rows_[1] = cross(c, a) * (1.0 / det);
        rows_[2] = cross(a, b) * (1.0 / det);
    }
    [[nodiscard]] bool is_regular() const { return is_regular_; }
    [[nodiscard]] Vec3d point(Vec3d world) const {
        const Vec3d p = world - origin_;
        return {dot(rows_[0], p), dot(rows_[1], p), dot(rows_[2], p)};
    }

private:
    Vec3d origin_, rows_[3];
    bool is_regular_ = false;
};

double area_of(const Mesh& mesh, const Mat4& world_from_object) {
    double doubled = 0.0;
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t c) { return placed_in_double(world_from_object, mesh.positions[mesh.indices[i + c]]); };
        const Vec3d a = corner(0);
        doubled += length(cross(corner(1) - a, corner(2) - a));
    }
    return 0.5 * doubled;
}

/// Keeps what all planes but one keep.
void clip(CapMesh& cap, std::span<const UnitPlane> planes, std::size_t own) {
    bool is_clipped = false;
    for (std::size_t p = 0; p < planes.size() && !cap.mesh.indices.empty(); ++p) {
        if (p == own) continue;
        const MeshCut cut(cap.mesh, cap.world_from_object, planes[p]);
        const Left left = cut.left();
        if (left == Left::all) continue;
        Mesh kept = left == Left::some ? cut.kept() : Mesh{};
        cap.mesh = std::move(kept);
        is_clipped = true;
    }
    if (is_clipped) cap.area = area_of(cap.mesh, cap.world_from_object);
}

}  // namespace

CapMesh make_cap(const PlaneSection& section, std::span<const UnitPlane> planes, std::size_t plane, double uv_scale) {
    const Vec3d normal = planes[plane].normal;
    const PlaneAxes axes(normal);
    std::vector<Vec2<double>> points;
    std::vector<PlaneSegment> segments;
    points.reserve(2 * section.segments.size());
    segments.reserve(section.segments.size());
    for (const CutSegment& segment : section.segments) {
        const auto first = static_cast<std::uint32_t>(points.size());
        points.push_back(axes.at(segment.from.world));
        points.push_back(axes.at(segment.to.world));
        segments.push_back({first, first + 1});
    }
    const PlaneFill fill = fill_segments(points, segments);
    CapMesh cap;
    cap.color = section.color;
    cap.filled_area = cap.area = fill.area;
    cap.open_ends = fill.open_ends;
    cap.too_complex = fill.too_complex;
    if (fill.triangles.empty()) return cap;

    const ObjectSpace space(section.world_from_object.value_or(Mat4{}));
    const bool shared = section.world_from_object && space.is_regular();
    if (shared) cap.world_from_object = *section.world_from_object;
    const Mat4& place = cap.world_from_object;
    const Vec3f object_normal =
        normalize_or(to_float(Vec3d{dot(axis(place, 0), normal), dot(axis(place, 1), normal), dot(axis(place, 2), normal)}), {0, 1, 0});
    // Whole repeats of the texture are taken away, so that float keeps the rest.
    const auto whole = [&](double x) { return static_cast<double>(static_cast<std::int64_t>(std::clamp(x * uv_scale, -1e15, 1e15))); };
    const Vec2<double> start{whole(points[0].x), whole(points[0].y)};
    Mesh& mesh = cap.mesh;
    mesh.name = "section";
    for (const FillPoint& p : fill.points) {
        Vec3f position;
        if (p.source >= 0) {
            const CutSegment& segment = section.segments[static_cast<std::size_t>(p.source) / 2];
            const CutPoint& end = p.source % 2 == 0 ? segment.from : segment.to;
            position = shared ? end.object : to_float(end.world);
        } else {
            const Vec3d world = (axes.x * p.at.x + axes.y * p.at.y) + normal * planes[plane].offset;
            position = to_float(shared ? space.point(world) : world);
        }
        mesh.positions.push_back(position);
        mesh.normals.push_back(object_normal);
        mesh.uv0.push_back({static_cast<float>(p.at.x * uv_scale - start.x), static_cast<float>(start.y - p.at.y * uv_scale)});
    }
    mesh.indices = fill.triangles;
    if (determinant3(place) < 0.0)
        for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    clip(cap, planes, plane);
    return cap;
}

}  // namespace halflit::raster
