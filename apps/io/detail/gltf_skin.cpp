#include "apps/io/detail/gltf_skin.hpp"

#include "apps/io/detail/double_box.hpp"
#include "sh/mat4.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {

namespace {

using enum Component;
constexpr Component kSmallUnsigned[] = {u8, u16}, kFloatOnly[] = {f32};

std::vector<Affine> joint_matrices(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, int index) {
    const file::Skin& skin = document.file.skins[static_cast<std::size_t>(index)];
    const std::string where = fmt::format("skins[{}].inverseBindMatrices", index);
    const Accessor* inverse_bind =
        skin.inverse_bind_matrices < 0 ? nullptr : &accessors[static_cast<std::size_t>(skin.inverse_bind_matrices)];
    if (inverse_bind != nullptr && (inverse_bind->components() != 16 || inverse_bind->component() != f32))
        refuse(where, fmt::format("{}: expected MAT4 of float", inverse_bind->name()));
    if (inverse_bind != nullptr && inverse_bind->count() < skin.joints.size())
        refuse(where, fmt::format("{}: expected {} matrices, one per joint, found {}", inverse_bind->name(), skin.joints.size(),
                                  inverse_bind->count()));
    if (inverse_bind != nullptr) {
        const int view = document.file.accessors[static_cast<std::size_t>(skin.inverse_bind_matrices)].buffer_view;
        if (view >= 0 && document.file.buffer_views[static_cast<std::size_t>(view)].byte_stride != 0)
            document.warn(fmt::format("bufferViews[{}].byteStride: expected none for matrices, read with it", view));
    }
    document.geometry.take(skin.joints.size() * sizeof(Affine));
    std::vector<Affine> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        Affine bind;
        float m[16];
        if (inverse_bind != nullptr) {
            inverse_bind->read_floats(j, m);
            for (std::size_t c = 0; c < 4; ++c) bind.c[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
            if (!is_finite(bind) && !document.warnings_are_full()) document.warn(fmt::format("{}: matrix {} is not finite", where, j));
            if ((m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) && !document.warnings_are_full())
                document.warn(fmt::format("{}: the last row of matrix {} is not 0 0 0 1, read as if it were", where, j));
        }
        matrices.push_back(tree.world_from_node[static_cast<std::size_t>(skin.joints[j])] * bind);
    }
    return matrices;
}

/// The middle of the points, rounded to float, if they are far from the origin; otherwise the origin.
Vec3d place_of(const std::vector<Vec3d>& points) {
    DoubleBox box;
    for (const Vec3d& p : points)
        if (shading::finite(to_float(p))) box.include(p);
    return box.is_far() ? to_double(to_float(box.center())) : Vec3d{};
}

struct Influences {
    const Accessor* joints;
    const Accessor* weights;
};

}  // namespace

std::optional<Vec3d> apply_skin(Document& document, const std::vector<Accessor>& accessors, PrimitiveReader& reader, const NodeTree& tree,
                                int skin, const file::Primitive& primitive, ReadMesh& read) {
    const std::string list = read.where + ".attributes";
    std::vector<Influences> sets;
    for (int set = 0;; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
        const Accessor* joint_accessor =
            reader.attribute(list, primitive.attributes, {joints.c_str(), 4, 4, kSmallUnsigned, {}, {}, {}}, std::nullopt);
        const Accessor* weight_accessor =
            reader.attribute(list, primitive.attributes, {weights.c_str(), 4, 4, kFloatOnly, kSmallUnsigned, {}, {}}, std::nullopt);
        if ((joint_accessor == nullptr) != (weight_accessor == nullptr))
            document.warn(fmt::format("{}: {} is there without {}, ignored", list, joint_accessor != nullptr ? joints : weights,
                                      joint_accessor != nullptr ? weights : joints));
        if (joint_accessor == nullptr || weight_accessor == nullptr) break;
        const std::size_t count = accessors[static_cast<std::size_t>(file::find(primitive.attributes, "POSITION"))].count();
        if (joint_accessor->count() != count || weight_accessor->count() != count)
            refuse(read.where, fmt::format("{} and {}: expected {} elements as in POSITION, found {} and {}", joints, weights, count,
                                           joint_accessor->count(), weight_accessor->count()));
        sets.push_back({joint_accessor, weight_accessor});
    }
    if (sets.empty()) return std::nullopt;

    const std::vector<Affine> matrices = joint_matrices(document, accessors, tree, skin);
    Mesh& mesh = read.mesh;
    document.geometry.take(mesh.positions.size() * sizeof(Vec3d));
    std::vector<Vec3d> positions(mesh.positions.size());
    std::size_t negative = 0, without = 0, other_sum = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Affine blend{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
        double sum = 0.0;
        for (const Influences& set : sets) {
            std::uint32_t joint[4];
            float weight[4];
            set.joints->read_unsigned(read.source_vertices[v], joint);
            set.weights->read_floats(read.source_vertices[v], weight);
            for (std::size_t k = 0; k < 4; ++k) {
                if (weight[k] < 0.0f) ++negative;
                if (!(weight[k] > 0.0f)) continue;
                if (joint[k] >= matrices.size())
                    refuse(read.where, fmt::format("{}: a vertex names joint {}, but skin {} has {}", set.joints->name(), joint[k], skin,
                                                   matrices.size()));
                for (std::size_t c = 0; c < 4; ++c) blend.c[c] = blend.c[c] + matrices[joint[k]].c[c] * double{weight[k]};
                sum += double{weight[k]};
            }
        }
        constexpr double kTolerance = 0.02;  // weights in 8-bit integers, each rounded alone, are wrong by up to 0.008 together
        if (!(sum > 0.0))
            ++without;
        else if (!(sum > 1 - kTolerance && sum < 1 + kTolerance))
            ++other_sum;
        if (!(sum > 0.0))
            blend = matrices.empty() ? Affine{} : matrices[0];
        else
            for (Vec3d& c : blend.c) c = c * (1.0 / sum);
        const Vec3f p = mesh.positions[v];
        positions[v] = transform_direction(blend, to_double(p)) + blend.c[3];
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
    const auto warn = [&](std::size_t count, const char* what) {
        if (count > 0) document.warn(fmt::format("{}.WEIGHTS_0: {} of {} vertices have {}", list, count, mesh.positions.size(), what));
    };
    warn(negative, "negative weights, which are left out");
    warn(without, "no weights, moved by the skin's first joint");
    warn(other_sum, "weights whose sum is not 1, drawn divided by it");
    const Vec3d place = document.options.recentre ? place_of(positions) : Vec3d{};
    for (std::size_t v = 0; v < positions.size(); ++v) mesh.positions[v] = to_float(positions[v] - place);
    return place;
}

}  // namespace halflit::io::detail
