#include "raster/built_in/demo_parts.hpp"

#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit::raster::detail {

namespace {

Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

/// Adds two triangles for each cell of a grid of vertices. Seen from the front, columns run to the right and rows down.
void add_quads(Mesh& mesh, int columns, int rows) {
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i), b = a + 1;
            const auto c = a + static_cast<std::uint32_t>(columns) + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, d, a, d, b});
        }
}

/// Share of the cosine-weighted sky that the occluder hides from a point of the floor at this distance from its foot.
double hidden_share(const Occluder& o, double distance) {
    const double r = o.radius;
    if (o.height == 0.0f) {
        // A ball at height r, D from its centre: cos(angle to the centre) * sin^2(angular radius) = (r / D) (r / D)^2.
        const double d2 = r * r + distance * distance;
        return r * r * r / (d2 * __builtin_sqrt(d2));
    }
    // A wall of height h at distance g hides (1 - g / sqrt(g^2 + h^2)) / 2. A round one hides less, because it curves away.
    const double g = std::max(0.0, distance - r), h = o.height;
    return 0.5 * (1.0 - g / __builtin_sqrt(g * g + h * h)) * std::min(1.0, r / std::max(distance, 1e-6));
}

/// Grid positions from `from` to `to`, with steps of `fine` within [low, high] and of `coarse` outside.
std::vector<double> graded(double from, double low, double high, double to, double fine, double coarse) {
    std::vector<double> steps;
    const auto run = [&](double a, double b, double step) {
        const int count = std::max(1, static_cast<int>((b - a) / step + 0.5));
        for (int i = 0; i < count; ++i) steps.push_back(a + (b - a) * i / count);
    };
    run(from, low, coarse);
    run(low, high, fine);
    run(high, to, coarse);
    steps.push_back(to);
    return steps;
}

}  // namespace

Mesh make_cyclorama(float half_width, Vec3f tint, std::span<const Occluder> occluders) {
    constexpr double kFront = 8.0, kBack = -5.0, kBend = 3.5, kTop = 9.0;  // z of the floor's ends, radius of the bend, top of the wall
    struct Station {
        double y, z;
        Vec3f normal;
    };
    // Profile: from the wall's top down, and forward over the floor.
    std::vector<Station> profile;
    for (int i = 0; i < 8; ++i) profile.push_back({kTop + (kBend - kTop) * i / 8, kBack - kBend, {0, 0, 1}});
    for (int i = 0; i < 48; ++i) {
        const SinCos a = sin_cos(0.5 * kPi * i / 48);
        profile.push_back({kBend - kBend * a.sin, kBack - kBend * a.cos, to_float({0, a.sin, a.cos})});
    }
    for (const double z : graded(kBack, -4.6, 1.4, kFront, 0.06, 0.4)) profile.push_back({0.0, z, {0, 1, 0}});

    Mesh mesh;
    mesh.name = "backdrop";
    const std::vector<double> across = graded(-half_width, -3.8, 3.8, half_width, 0.06, 0.6);
    for (const Station& s : profile)
        for (const double x : across) {
            double open = 1.0;
            for (const Occluder& o : occluders) open *= 1.0 - hidden_share(o, length(Vec3d{x - o.foot.x, s.y - o.foot.y, s.z - o.foot.z}));
            const auto sky = static_cast<float>(open);
            mesh.positions.push_back(to_float({x, s.y, s.z}));
            mesh.normals.push_back(s.normal);
            mesh.colors.push_back({tint.x * sky, tint.y * sky, tint.z * sky, 1});
        }
    add_quads(mesh, static_cast<int>(across.size()) - 1, static_cast<int>(profile.size()) - 1);
    return mesh;
}

Mesh make_trefoil(float radius, float swing, float tube, int slices, int sides) {
    Mesh mesh;
    mesh.name = "trefoil";
    for (int j = 0; j <= sides; ++j)
        for (int i = 0; i <= slices; ++i) {
            const double t = 2.0 * kPi * (i % slices) / slices;
            const SinCos around = sin_cos(2.0 * t), wave = sin_cos(3.0 * t);
            const double reach = radius + swing * wave.cos;
            const Vec3d center{reach * around.cos, reach * around.sin, -swing * wave.sin};
            const Vec3d along = unit({-3.0 * swing * wave.sin * around.cos - 2.0 * reach * around.sin,
                                      -3.0 * swing * wave.sin * around.sin + 2.0 * reach * around.cos, -3.0 * swing * wave.cos});
            // The torus's normal is perpendicular to the curve and periodic along it; a parallel-transported frame is not periodic.
            const Vec3d out{wave.cos * around.cos, wave.cos * around.sin, -wave.sin};
            const Vec3d side = cross(along, out);
            const SinCos turn = sin_cos(2.0 * kPi * (j % sides) / sides);
            const Vec3d normal = out * turn.cos + side * turn.sin;
            mesh.positions.push_back(to_float(center + normal * static_cast<double>(tube)));
            mesh.normals.push_back(to_float(normal));
        }
    add_quads(mesh, slices, sides);
    return mesh;
}

Mesh make_plinth_side(float radius, float height, int repeats, int slices) {
    Mesh mesh;
    mesh.name = "plinth side";
    for (int j = 0; j <= 1; ++j)
        for (int i = 0; i <= slices; ++i) {
            const SinCos a = sin_cos(2.0 * kPi * (i % slices) / slices);
            mesh.positions.push_back(to_float({radius * a.sin, j == 0 ? height : 0.0, radius * a.cos}));
            mesh.normals.push_back(to_float({a.sin, 0, a.cos}));
            mesh.tangents.push_back({static_cast<float>(a.cos), 0, static_cast<float>(-a.sin), 1});
            mesh.uv0.push_back({static_cast<float>(repeats * static_cast<double>(i) / slices), static_cast<float>(j)});
        }
    add_quads(mesh, slices, 1);
    return mesh;
}

Mesh make_plinth_lid(float radius, float lip, int slices, const Occluder& contact) {
    // Outline: from the middle of the top outwards, down around the rim and back under it to the side.
    constexpr int kRim = 12, kTop = 24;
    struct Station {
        double r, y, out, up;  // position and normal
    };
    std::vector<Station> outline;
    for (int i = 0; i < kTop; ++i) outline.push_back({radius * static_cast<double>(i) / kTop, 2.0 * lip, 0, 1});
    for (int i = 0; i <= kRim; ++i) {
        const SinCos a = sin_cos(kPi * i / kRim);
        outline.push_back({radius + lip * a.sin, lip + lip * a.cos, a.sin, a.cos});
    }
    outline.push_back({radius - lip, 0, 0, -1});
    Mesh mesh;
    mesh.name = "plinth lid";
    for (const Station& s : outline)
        for (int i = 0; i <= slices; ++i) {
            const SinCos a = sin_cos(2.0 * kPi * (i % slices) / slices);
            const Vec3d place{s.r * a.sin, s.y, s.r * a.cos};
            const double hidden = hidden_share(contact, length(place - Vec3d{contact.foot.x, contact.foot.y, contact.foot.z}));
            const auto open = static_cast<float>(s.up > 0.0 ? 1.0 - hidden : 1.0);
            mesh.positions.push_back(to_float(place));
            mesh.normals.push_back(to_float({s.out * a.sin, s.up, s.out * a.cos}));
            mesh.colors.push_back({open, open, open, 1});
        }
    add_quads(mesh, slices, static_cast<int>(outline.size()) - 1);
    return mesh;
}

}  // namespace halflit::raster::detail
