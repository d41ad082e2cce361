#include "tests/look/ray_view.hpp"

#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halflit::test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3d column(const Camera& camera, std::size_t i) {
    const Vec4f& c = camera.world_from_camera.c[i];
    return {c.x, c.y, c.z};
}

/// A triangle in the picture: corners in pixels, y down, and depths along the rays.
struct Flat {
    double x[3], y[3], z[3], area2;
    double slope = 0.0;  ///< of the depth, units per pixel

    /// Least distance of a point from the three edges' lines, pixels, above 0 within; and the depth there.
    bool look(double px, double py, double& inside, double& depth) const {
        double weight[3];
        inside = kFar;
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            const double dx = x[b] - x[a], dy = y[b] - y[a], size = std::hypot(dx, dy);
            if (!(size > 0.0)) return false;
            const double cross = (px - x[a]) * dy - (py - y[a]) * dx;
            weight[k] = cross / -area2;
            inside = std::min(inside, (area2 > 0 ? -cross : cross) / size);
        }
        depth = weight[0] * z[0] + weight[1] * z[1] + weight[2] * z[2];
        return true;
    }
};

/// The nearest depths at a pixel.
struct Nearest {
    double sure = kFar;                     ///< most of a surface that the ray meets for sure
    double possible = kFar, second = kFar;  ///< the least depths of surfaces that it may meet, of two triangles
    std::size_t who = 0;                    ///< the triangle of `possible`
};

}  // namespace

std::vector<RayTriangle> ray_triangles(const Scene& scene) {
    std::vector<RayTriangle> out;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const int number = instance.material >= 0 ? instance.material : mesh.material;
        const Material material = number >= 0 ? scene.materials[static_cast<std::size_t>(number)] : Material{};
        const Mat4& m = instance.world_from_object;
        const auto column_of = [&](std::size_t i) { return Vec3d{m.c[i].x, m.c[i].y, m.c[i].z}; };
        const bool mirrored = dot(cross(column_of(0), column_of(1)), column_of(2)) < 0.0;
        for (std::size_t i = 0; mesh.topology == Topology::triangles && i + 2 < mesh.indices.size(); i += 3) {
            RayTriangle one;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3d p = to_double(mesh.positions[mesh.indices[i + k]]);
                one.corners[k] = column_of(0) * p.x + column_of(1) * p.y + column_of(2) * p.z + column_of(3);
            }
            if (mirrored) std::swap(one.corners[1], one.corners[2]);
            one.two_sided = material.double_sided;
            one.drawn = instance.visible && material.alpha_mode != AlphaMode::blend;
            out.push_back(one);
        }
    }
    return out;
}

std::vector<RayCount> count_by_rays(const std::vector<RayTriangle>& triangles, const Camera& camera, int width, int height, RayPlace place,
                                    RayTolerance tolerance) {
    const Vec3d right = column(camera, 0), up = column(camera, 1), back = column(camera, 2), eye = column(camera, 3);
    const double pixels = 0.5 * height / camera.half_height;  // per unit
    std::vector<Flat> flats;
    double near_z = kFar, far_z = -kFar;
    for (const RayTriangle& one : triangles) {
        Flat& flat = flats.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const Vec3d p = one.corners[k] - eye;
            flat.x[k] = 0.5 * width + dot(p, right) * pixels;
            flat.y[k] = 0.5 * height - dot(p, up) * pixels;
            flat.z[k] = -dot(p, back);
            near_z = std::min(near_z, flat.z[k]), far_z = std::max(far_z, flat.z[k]);
        }
        flat.area2 = (flat.x[1] - flat.x[0]) * (flat.y[2] - flat.y[0]) - (flat.x[2] - flat.x[0]) * (flat.y[1] - flat.y[0]);
        const Vec3d normal = cross(one.corners[1] - one.corners[0], one.corners[2] - one.corners[0]);
        const double towards = std::abs(dot(normal, back));
        flat.slope = towards > 0.0 ? std::hypot(dot(normal, right), dot(normal, up)) / towards / pixels : kFar;
    }
    const double close = tolerance.depth_share * (far_z - near_z);
    std::vector<Nearest> nearest(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto each_pixel = [&](std::size_t i, const auto& see) {
        const Flat& flat = flats[i];
        const double extent = std::max({flat.x[0], flat.x[1], flat.x[2]}) - std::min({flat.x[0], flat.x[1], flat.x[2]}) +
                              std::max({flat.y[0], flat.y[1], flat.y[2]}) - std::min({flat.y[0], flat.y[1], flat.y[2]});
        const bool front = flat.area2 < 0.0;  // y is down
        // A triangle seen edge on: rounding may show it or its back, or nothing.
        const bool doubtful = std::abs(flat.area2) <= 2.0 * tolerance.edge_px * extent;
        if (!triangles[i].drawn || (!front && !triangles[i].two_sided && !doubtful) || flat.area2 == 0.0) return;
        const auto low = [](const double(&v)[3]) { return std::min({v[0], v[1], v[2]}); };
        const auto high = [](const double(&v)[3]) { return std::max({v[0], v[1], v[2]}); };
        const int x0 = std::clamp(static_cast<int>(std::floor(low(flat.x) - 1.0)), 0, width);
        const int x1 = std::clamp(static_cast<int>(std::ceil(high(flat.x) + 1.0)), 0, width);
        const int y0 = std::clamp(static_cast<int>(std::floor(low(flat.y) - 1.0)), 0, height);
        const int y1 = std::clamp(static_cast<int>(std::ceil(high(flat.y) + 1.0)), 0, height);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                double inside, depth;
                if (!flat.look(x + place.x, y + place.y, inside, depth) || inside < -tolerance.edge_px) continue;
                // Depths change with a vertex that is rounded. Beside a sharp corner the plane goes on far past the triangle.
                const double margin = flat.slope * tolerance.edge_px;
                see(nearest[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)],
                    inside > tolerance.edge_px && !doubtful, std::clamp(depth - margin, low(flat.z), high(flat.z)) - close,
                    std::clamp(depth + margin, low(flat.z), high(flat.z)) + close);
            }
    };
    for (std::size_t i = 0; i < triangles.size(); ++i)
        each_pixel(i, [&](Nearest& at, bool sure, double least, double most) {
            if (sure) at.sure = std::min(at.sure, most);
            if (least < at.possible)
                at.second = at.possible, at.possible = least, at.who = i;
            else
                at.second = std::min(at.second, least);
        });
    std::vector<RayCount> counts(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        each_pixel(i, [&](const Nearest& at, bool sure, double least, double most) {
            counts[i].sure += sure && most < (at.who == i ? at.second : at.possible) ? 1 : 0;
            counts[i].possible += least <= at.sure ? 1 : 0;
        });
    return counts;
}

bool is_blocked(const std::vector<RayTriangle>& triangles, Vec3d point, Vec3d direction, std::size_t without, double least_distance) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const RayTriangle& one = triangles[i];
        if (i == without || !one.drawn) continue;
        const Vec3d e1 = one.corners[1] - one.corners[0], e2 = one.corners[2] - one.corners[0];
        const Vec3d normal = cross(e1, e2);
        const double facing = dot(normal, direction);  // above 0: its front looks towards the viewer at the ray's end
        if (facing == 0.0 || (facing < 0.0 && !one.two_sided)) continue;
        const Vec3d from = point - one.corners[0];
        const double distance = -dot(normal, from) / facing;
        if (!(distance > least_distance)) continue;
        const Vec3d q = cross(direction, from) * (1.0 / facing);
        // Barycentric weights of the hit, by Cramer's rule.
        const double u = dot(e2, q), v = -dot(e1, q);
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) return true;
    }
    return false;
}

}  // namespace halflit::test
