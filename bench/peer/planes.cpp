#include "bench/peer/planes.hpp"

#include "raster/view/projection.hpp"

#include <cmath>

namespace halflit::peer {
namespace {

constexpr double kDepthTolerance = 1e-4;  // as a share of the depth

std::size_t index_of(const Planes& planes, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(planes.width) + static_cast<std::size_t>(x);
}

/// True if all pixels around (x, y) show what it shows.
bool is_inner(const Planes& planes, int x, int y) {
    const std::uint32_t triangle = planes.triangle[index_of(planes, x, y)];
    for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) {
            const bool inside = u >= 0 && v >= 0 && u < planes.width && v < planes.height;
            if (!inside || planes.triangle[index_of(planes, u, v)] != triangle) return false;
        }
    return true;
}

struct Place {
    double x, y;  ///< pixels from the middle of the picture, y up
};

/// The point that a pixel's triangle and weights name.
Place place_of(const Planes& planes, std::size_t pixel, const Mesh& mesh, const Mat4& clip_from_world) {
    const double second = double{planes.barycentric[2 * pixel]}, third = double{planes.barycentric[2 * pixel + 1]};
    const std::size_t first_index = 3 * (std::size_t{planes.triangle[pixel]} - 1);
    const auto corner = [&](std::size_t c) {
        const Vec3f p = mesh.positions[mesh.indices[first_index + c]];
        return Vec3d{p.x, p.y, p.z};
    };
    const Vec3d point = corner(0) * (1 - second - third) + corner(1) * second + corner(2) * third;
    const raster::ClipPlace at = raster::clip_place(clip_from_world, point);
    return {at.x / at.w * 0.5 * planes.width, at.y / at.w * 0.5 * planes.height};
}

}  // namespace

Planes Planes::make(int width, int height) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Planes planes{width, height, {}, {}, {}, {}};
    planes.rgba8.resize(4 * count), planes.depth.resize(count), planes.triangle.resize(count), planes.barycentric.resize(2 * count);
    return planes;
}

Target Planes::target() {
    Target target{width, height, rgba8.data()};
    target.depth = depth.data();
    target.triangle = triangle.data();
    target.barycentric = barycentric.data();
    return target;
}

void PlanesDifference::add(const Planes& a, const Planes& b, const Mesh& mesh, const Camera& camera, double point_tolerance) {
    const Mat4 clip_from_world = raster::clip_from_world(camera, static_cast<float>(a.width) / static_cast<float>(a.height));
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const std::size_t i = index_of(a, x, y);
            if (a.triangle[i] == 0 && b.triangle[i] == 0) continue;
            const bool inner = is_inner(a, x, y) && is_inner(b, x, y);
            const auto count = [inner](Differing& differing, bool same) {
                differing.all += !same;
                differing.inner += inner && !same;
            };
            ++pixels;
            count(triangles, a.triangle[i] == b.triangle[i]);
            if (a.triangle[i] != b.triangle[i]) continue;
            count(depths, std::abs(double{a.depth[i]} - double{b.depth[i]}) <= kDepthTolerance * double{b.depth[i]});
            const Place p = place_of(a, i, mesh, clip_from_world), q = place_of(b, i, mesh, clip_from_world);
            count(points, std::hypot(p.x - q.x, p.y - q.y) <= point_tolerance);
        }
}

}  // namespace halflit::peer
