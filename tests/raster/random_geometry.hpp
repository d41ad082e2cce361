// Random meshes, instances and cameras of all shapes and sizes, for tests of bounds and culling.
#pragma once

#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include <cmath>
#include <utility>

namespace halflit::raster::test {

using halflit::test::Random;

inline Vec3f random_point(Random& random, double reach) {
    return {random.real32(-reach, reach), random.real32(-reach, reach), random.real32(-reach, reach)};
}

/// Number from low to high whose logarithm is evenly distributed.
inline float random_decades(Random& random, double low, double high) {
    return static_cast<float>(std::pow(10.0, random.real(std::log10(low), std::log10(high))));
}

inline Mat4 random_rotation(Random& random) {
    const Vec4f q{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1), random.real32(0.1, 1)};
    const float inv = 1.0f / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return rotation(q * inv);
}

/// Rotation, uneven scale of about `size`, often mirrored, then a move by up to `reach`.
inline Mat4 random_place(Random& random, double reach, double size = 1.0) {
    Vec3f scale{random.real32(0.3, 1.5), random.real32(0.3, 1.5), random.real32(0.3, 1.5)};
    if (random.chance(0.3)) scale.x = -scale.x;
    if (random.chance(0.1)) scale.y *= 0.01f;
    const Mat4 turn = random_rotation(random);
    return translation(random_point(random, reach)) * turn * scaling(scale * static_cast<float>(size));
}

/// `count` triangles without order. thin: the third corner close to the line through the others, or on it.
inline Mesh triangle_soup(Random& random, int count, double size, bool thin) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3f a = random_point(random, 1), b = a + random_point(random, size);
        const Vec3f c = thin ? a + (b - a) * random.real32(-1, 2) + random_point(random, random.chance(0.3) ? 0.0 : size * 1e-4)
                             : a + random_point(random, size);
        for (const Vec3f p : {a, b, c}) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(p);
        }
    }
    return mesh;
}

inline void shuffle_triangles(Random& random, Mesh& mesh) {
    for (std::size_t t = mesh.indices.size() / 3; t > 1; --t) {
        const auto other = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(t) - 1));
        for (std::size_t k = 0; k < 3; ++k) std::swap(mesh.indices[3 * (t - 1) + k], mesh.indices[3 * other + k]);
    }
}

/// Some triangles lose their area: two corners become one vertex, or two at one place.
inline void collapse_some(Random& random, Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        if (!random.chance(0.02)) continue;
        if (random.chance(0.5))
            mesh.indices[i + static_cast<std::size_t>(random.index(2))] = mesh.indices[i + 2];
        else
            mesh.positions[mesh.indices[i]] = mesh.positions[mesh.indices[i + 1]];
    }
}

/// Positions and indices of a closed shape, a ground, a heap of triangles or one triangle; about one unit large.
inline Mesh random_mesh(Random& random, int most_triangles = 6000) {
    Mesh mesh;
    switch (random.index(8)) {
        case 0:
        case 1:
            mesh = make_sphere_of(random.real32(0.2, 1), random.integer(12, most_triangles));
            break;
        case 2:
            mesh = make_plane(1, static_cast<int>(random.integer(1, static_cast<int>(std::sqrt(most_triangles / 2)))));
            for (Vec3f& p : mesh.positions) p.y += random.real32(-0.02, 0.02);
            break;
        case 3:
            mesh = make_torus(0.7f, random.real32(0.05, 0.4), static_cast<int>(random.integer(3, 40)),
                              static_cast<int>(random.integer(3, 30)));
            break;
        case 4: {
            const double size = random_decades(random, 1e-3, 1);
            mesh = triangle_soup(random, static_cast<int>(random.integer(1, 800)), size, false);
            break;
        }
        case 5:
            mesh = triangle_soup(random, static_cast<int>(random.integer(1, 800)), 1, true);
            break;
        case 6:
            mesh = make_box({random.real32(0, 1), random.real32(0, 1), random.real32(0, 1)});
            break;
        default:
            mesh = triangle_soup(random, 1, 1, false);
            break;
    }
    mesh.normals.clear();
    mesh.uv0.clear();
    if (random.chance(0.2)) shuffle_triangles(random, mesh);
    if (random.chance(0.2)) collapse_some(random, mesh);
    return mesh;
}

/// Camera that looks at a point near the origin from any distance, also from inside objects of size 1.
inline Camera random_camera(Random& random) {
    const Vec3f eye = random_point(random, random_decades(random, 0.1, 30)), target = random_point(random, 1);
    Camera camera = halflit::test::camera_at(eye, target, random.real32(0.2, 2.2), random_decades(random, 1e-3, 0.3));
    if (random.chance(0.3)) camera.far_z = random_decades(random, 1, 100);
    if (random.chance(0.3)) {
        camera.orthographic = true;
        camera.half_height = random_decades(random, 0.1, 5);
    }
    return camera;
}

/// Part of a picture, of any size and place.
inline Region random_region(Random& random, int width, int height) {
    Region region;
    region.width = static_cast<int>(random.integer(1, width));
    region.height = static_cast<int>(random.integer(1, height));
    region.x = static_cast<int>(random.integer(0, width - region.width));
    region.y = static_cast<int>(random.integer(0, height - region.height));
    return region;
}

}  // namespace halflit::raster::test
