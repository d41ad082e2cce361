#include "apps/io/gltf/build/deform.hpp"

#include "apps/io/files/double_box.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <utility>

namespace halflit::io::detail {

namespace {

/// The middle of the points if they are far from the origin; otherwise the origin. Not inline: where g++ 12 vectorises a rounding to float
/// whose result goes back to double, it leaves out the rounding.
[[gnu::noinline]] Vec3f place_of(const std::vector<Vec3d>& points) {
    DoubleBox box;
    for (const Vec3d& p : points)
        if (shading::finite(to_float(p))) box.include(p);
    return box.is_far() ? to_float(box.center()) : Vec3f{};
}

void add(Vec2f& to, float weight, Vec2f delta) {
    to.x += weight * delta.x;
    to.y += weight * delta.y;
}

template <class T>
void add_xyz(T& to, float weight, Vec3f delta) {
    to.x += weight * delta.x;
    to.y += weight * delta.y;
    to.z += weight * delta.z;
}

/// Adds the targets to all but the positions.
void morph(Mesh& mesh, const MeshSource& source, std::span<const float> weights) {
    bool colors = false;
    for (std::size_t t = 0; t < weights.size(); ++t) {
        const float weight = weights[t];
        if (weight == 0.0f) continue;
        const MorphTarget& target = source.targets[t];
        for (std::size_t i = 0; i < target.normals.size(); ++i) add_xyz(mesh.normals[i], weight, target.normals[i]);
        for (std::size_t i = 0; i < target.tangents.size(); ++i) add_xyz(mesh.tangents[i], weight, target.tangents[i]);
        for (std::size_t i = 0; i < target.uv0.size(); ++i) add(mesh.uv0[i], weight, target.uv0[i]);
        for (std::size_t i = 0; i < target.uv1.size(); ++i) add(mesh.uv1[i], weight, target.uv1[i]);
        colors |= !target.colors.empty();
        for (std::size_t i = 0; i < target.colors.size(); ++i) {
            const Vec4f delta = target.colors[i];
            add_xyz(mesh.colors[i], weight, {delta.x, delta.y, delta.z});
            mesh.colors[i].w += weight * delta.w;
        }
    }
    if (!colors) return;
    const auto unit = [](float x) { return x > 0.0f ? std::min(x, 1.0f) : 0.0f; };
    for (Vec4f& c : mesh.colors) c = {unit(c.x), unit(c.y), unit(c.z), unit(c.w)};
}

std::vector<Vec3d> morphed_positions(const Mesh& base, const MeshSource& source, std::span<const float> weights) {
    std::vector<Vec3d> out(base.positions.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = to_double(base.positions[i]);
    for (std::size_t t = 0; t < weights.size(); ++t) {
        if (weights[t] == 0.0f) continue;
        const std::vector<Vec3f>& deltas = source.targets[t].positions;
        for (std::size_t i = 0; i < deltas.size(); ++i) out[i] = out[i] + to_double(deltas[i]) * static_cast<double>(weights[t]);
    }
    return out;
}

/// Weighted mean of a vertex' joints; the skin's first joint if it has none.
Affine blended(std::span<const Influence> influences, std::span<const Affine> joints) {
    Affine blend{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    double sum = 0.0;
    for (const Influence& set : influences) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(set.weight[k] > 0.0f)) continue;
            for (std::size_t c = 0; c < 4; ++c) blend.c[c] = blend.c[c] + joints[set.joint[k]].c[c] * double{set.weight[k]};
            sum += double{set.weight[k]};
        }
    }
    if (!(sum > 0.0)) return joints.empty() ? Affine{} : joints[0];
    for (Vec3d& c : blend.c) c = c * (1.0 / sum);
    return blend;
}

/// Moves the positions, and the mesh's normals and tangents.
void skin(Mesh& mesh, std::vector<Vec3d>& positions, const MeshSource& source, std::span<const Affine> joints) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Affine blend = blended(std::span(source.influences).subspan(v * source.sets, source.sets), joints);
        positions[v] = transform_direction(blend, positions[v]) + blend.c[3];
        const Mat4 m = to_mat4(blend);
        if (!mesh.normals.empty()) {
            const NormalMatrix n = normal_matrix(m);
            const Vec3f from = mesh.normals[v];
            mesh.normals[v] = normalize_or((n.c[0] * from.x + n.c[1] * from.y) + n.c[2] * from.z, from);
        }
        if (!mesh.tangents.empty()) {
            const Vec4f from = mesh.tangents[v];
            const Vec3f t = normalize_or(transform_vector(m, {from.x, from.y, from.z}), {from.x, from.y, from.z});
            mesh.tangents[v] = {t.x, t.y, t.z, from.w};
        }
    }
}

}  // namespace

std::vector<Affine> joint_matrices(const Skin& skin, std::span<const Affine> world_from_node) {
    std::vector<Affine> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
        matrices.push_back(world_from_node[static_cast<std::size_t>(skin.joints[j])] * skin.inverse_bind[j]);
    return matrices;
}

Posed pose_mesh(Mesh base, const MeshSource& source, std::span<const double> weights, std::span<const Affine> joints,
                std::optional<Vec3d> place) {
    std::vector<float> used;
    for (std::size_t t = 0; t < std::min(weights.size(), source.targets.size()); ++t)
        used.push_back(static_cast<float>(std::clamp(weights[t], -1e30, 1e30)));
    const bool morphs = std::any_of(used.begin(), used.end(), [](float weight) { return weight != 0.0f; });
    const bool skinned = source.sets > 0;
    Posed out{std::move(base), {}};
    Mesh& mesh = out.mesh;
    if (morphs) morph(mesh, source, used);
    if (morphs || skinned) {
        std::vector<Vec3d> positions = morphed_positions(mesh, source, morphs ? std::span<const float>(used) : std::span<const float>());
        if (skinned) {
            skin(mesh, positions, source, joints);
            out.place = place ? *place : to_double(place_of(positions));
        }
        for (std::size_t v = 0; v < positions.size(); ++v) mesh.positions[v] = to_float(positions[v] - out.place);
    }
    if (source.flat_normals) generate_flat_normals(mesh);
    if (source.tangents_of >= 0) generate_tangents(mesh, source.tangents_of);
    return out;
}

}  // namespace halflit::io::detail
