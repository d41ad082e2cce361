// Bodies of the trials, their vertices' oddities, and the camera.
#include "halflit/shapes.hpp"
#include "shading/material_properties.hpp"
#include "tests/adversary/trial.hpp"
#include "tests/support/cameras.hpp"

#include <algorithm>
#include <limits>

namespace halflit::adversary {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Mesh some_shape(Genes& genes) {
    const int kind = genes.pick(4), cuts = genes.pick(4);
    constexpr int kCuts[] = {1, 2, 4, 8};
    const int c = kCuts[cuts];
    switch (kind) {
        case 0:
            return make_plane(1, c);
        case 1:
            return make_sphere(1, 6 * c + 6, 4 * c + 4);
        case 2:
            return make_box({0.8f, 0.5f, 0.7f});
        default:
            return make_torus(0.8f, 0.3f, 6 * c + 6, 4 * c + 4);
    }
}

/// Affine: scales of 2^-10 to 2^10, other scales on each axis, a shear, a place up to 1000 sizes away.
Mat4 some_transform(Genes& genes) {
    const float scale = genes.chance(0.25) ? genes.octaves32(0x1p-10, 20) : 1.0f;
    if (scale == 1.0f) genes.skip(1);
    Vec3f axes{1, 1, 1};
    if (genes.chance(0.25))
        axes = {genes.octaves32(1, 4), genes.octaves32(1, -4), genes.octaves32(1, 2)};
    else
        genes.skip(3);
    Mat4 m;
    m.c[0] = {scale * axes.x, 0, 0, 0};
    m.c[1] = {0, scale * axes.y, 0, 0};
    m.c[2] = {0, 0, scale * axes.z, 0};
    if (genes.chance(0.2)) {
        const float shear = genes.real32(0, 3) * scale;
        m.c[1].x = shear;
        m.c[2].y = -shear;
    } else {
        genes.skip(1);
    }
    if (genes.chance(0.2)) {
        const Vec3f direction = some_direction(genes), place = direction * (genes.octaves32(1, 10) * scale);
        m.c[3] = {place.x, place.y, place.z, 1};
    } else {
        genes.skip(4);
    }
    return m;
}

/// Normals that files have: of other lengths, opposed to the side that they are on, none, any.
void change_normals(Genes& genes, AvoidSet avoid, Mesh& mesh) {
    const int kind = genes.pick(16);
    Numbers numbers(genes.seed());
    const double share = genes.next();
    const float length = genes.octaves32(0x1p-20, 40);
    for (Vec3f& n : mesh.normals) {
        if (kind < 10 || numbers.real(0, 1) < share) continue;
        if (kind <= 11) n = n * length;
        if (kind == 12) n = n * -1.0f;
        if (kind == 13) n = {0, 0, 0};
        const Vec3f any{static_cast<float>(numbers.real(-1, 1)), static_cast<float>(numbers.real(-1, 1)),
                        static_cast<float>(numbers.real(-1, 1))};
        if (kind == 14) n = n + any;
        if (kind == 15) n = any;
    }
    if ((avoid & kAvoidZeroNormals) != 0)
        for (Vec3f& n : mesh.normals)
            if (n == Vec3f{0, 0, 0}) n = {0, 1, 0};
}

/// Coordinates that files have: scaled, huge, the same at all vertices, NaN at some.
void change_coordinates(Genes& genes, AvoidSet avoid, Mesh& mesh) {
    const int kind = genes.pick(16);
    const float scale = genes.octaves32(0x1p-6, 26);
    Numbers numbers(genes.seed());
    for (std::size_t i = 0; i < mesh.uv0.size(); ++i) {
        Vec2f& uv = mesh.uv0[i];
        if (kind == 11 || kind == 12) uv = uv * (kind == 11 ? scale : -1.0f);
        if (kind == 13) uv = {0.3f, 0.7f};
        if (kind == 14) uv = uv + Vec2f{scale, -scale};
        if (kind == 15 && numbers.below(4) == 0) uv = (avoid & kAvoidOddCoordinates) != 0 ? Vec2f{0, 0} : Vec2f{kNan, 0.5f};
    }
}

Vec3f moved(const Mat4& m, Vec3f p, float w) {
    return Vec3f{m.c[0].x, m.c[0].y, m.c[0].z} * p.x + Vec3f{m.c[1].x, m.c[1].y, m.c[1].z} * p.y +
           Vec3f{m.c[2].x, m.c[2].y, m.c[2].z} * p.z + Vec3f{m.c[3].x, m.c[3].y, m.c[3].z} * w;
}

/// Normals turn by the cofactors of the matrix.
Vec3f turned(const Mat4& m, Vec3f n) {
    const Vec3f x{m.c[0].x, m.c[0].y, m.c[0].z}, y{m.c[1].x, m.c[1].y, m.c[1].z}, z{m.c[2].x, m.c[2].y, m.c[2].z};
    return normalize_or(cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z, {0, 1, 0});
}

}  // namespace

Aim add_bodies(const Genome& genome, AvoidSet avoid, Trial& trial) {
    Aim aim{};
    for (int i = 0; i < kBodies; ++i) {
        Genes genes(genome, kBody + i, trial.read);
        if (i > 0 && !genes.chance(0.5)) break;
        Mesh mesh = some_shape(genes);
        Mat4 place = some_transform(genes);
        const auto vertex = static_cast<std::size_t>(genes.next() * static_cast<double>(mesh.positions.size()));
        if (i == 0) {
            aim.point = moved(place, mesh.positions[vertex] * 0.9f, 1);
            aim.normal = turned(place, mesh.normals[vertex]);
            aim.size =
                std::max({length(moved(place, {1, 0, 0}, 0)), length(moved(place, {0, 1, 0}, 0)), length(moved(place, {0, 0, 1}, 0))});
        } else {
            // The second body lies about the first, so that they meet in the picture and in the shadows.
            const Vec3f direction = some_direction(genes), aside = aim.point + direction * (aim.size * genes.real32(0.2, 2));
            place.c[3] = {aside.x, aside.y, aside.z, 1};
            for (int k = 0; k < 3; ++k) place.c[k] = place.c[k] * aim.size;
        }
        change_normals(genes, avoid, mesh);
        if (genes.chance(0.15)) {
            Numbers numbers(genes.seed());
            for (std::size_t k = 0; k < mesh.positions.size(); ++k)
                mesh.colors.push_back({static_cast<float>(numbers.real(0, 1)), static_cast<float>(numbers.real(0, 1)),
                                       static_cast<float>(numbers.real(0, 1)), 1});
        } else {
            genes.skip(1);
        }
        mesh.material = i;
        const Material& material = trial.scene.materials[static_cast<std::size_t>(i)];
        mesh.uv1 = mesh.uv0;
        for (Vec2f& uv : mesh.uv1) uv = {uv.y * 3.0f, uv.x + 0.5f};
        if (const auto uv_set = shading::tangent_uv_set(material)) generate_tangents(mesh, *uv_set);
        change_coordinates(genes, avoid, mesh);
        trial.scene.meshes.push_back(std::move(mesh));
        trial.scene.instances.push_back({i, place});
    }
    return aim;
}

void place_camera(const Genome& genome, Aim& aim, Trial& trial) {
    Genes genes(genome, kView, trial.read);
    // From straight above the surface to grazing, near and far, through lenses of 2 radians to a thousandth.
    const Vec3f side = some_direction(genes);
    const float tilt = genes.chance(0.7) ? genes.octaves32(0x1p-6, 12) : 0.5f;
    aim.to_eye = normalize_or(aim.normal + side * tilt, aim.normal);
    genes.skip(tilt == 0.5f ? 1 : 0);
    const float distance = genes.chance(0.4) ? genes.octaves32(0x1p-6, 12) : 3.0f;
    genes.skip(distance == 3.0f ? 1 : 0);
    const float fov = genes.chance(0.4) ? std::min(2.0f, genes.octaves32(0x1p-10, 11)) : 0.8f;
    genes.skip(fov == 0.8f ? 1 : 0);
    aim.distance = distance * aim.size;
    trial.camera = halflit::test::camera_at(aim.point + aim.to_eye * aim.distance, aim.point, fov, aim.distance * 0x1p-7f);
    if (genes.chance(0.1)) {
        trial.camera.orthographic = true;
        trial.camera.half_height = aim.distance * 0.5f * fov;
        trial.camera.near_z = 0;
        trial.camera.far_z = aim.distance * 8;
    }
}

}  // namespace halflit::adversary
