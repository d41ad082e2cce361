#include "apps/io/gltf/build/skin.hpp"

#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

using enum Component;
constexpr Component kSmallUnsigned[] = {u8, u16}, kFloatOnly[] = {f32};

}  // namespace

Skin read_skin(Document& document, const std::vector<Accessor>& accessors, int index) {
    const file::Skin& skin = document.file.skins[static_cast<std::size_t>(index)];
    const std::string where = fmt::format("skins[{}].inverseBindMatrices", index);
    const Accessor* inverse_bind = skin.inverse_bind_matrices < 0 ? nullptr : &usable(accessors, skin.inverse_bind_matrices);
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
    for (const int joint : skin.joints)
        if (joint < 0) refuse(fmt::format("skins[{}].joints", index), "a joint is not there");
    document.geometry.take(skin.joints.size() * (sizeof(Affine) + sizeof(int)));
    Skin out;
    out.joints = skin.joints;
    out.inverse_bind.resize(skin.joints.size());
    for (std::size_t j = 0; inverse_bind != nullptr && j < skin.joints.size(); ++j) {
        float m[16];
        inverse_bind->read_floats(j, m);
        Affine& bind = out.inverse_bind[j];
        for (std::size_t c = 0; c < 4; ++c) bind.c[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
        if (!is_finite(bind)) {
            document.go_on_without({{ErrorCode::bad_input, fmt::format("{}: matrix {} is not finite", where, j)}}, "read as the identity");
            bind = {};
        }
        if ((m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) && !document.warnings_are_full())
            document.warn(fmt::format("{}: the last row of matrix {} is not 0 0 0 1, read as if it were", where, j));
    }
    return out;
}

bool read_influences(Document& document, const std::vector<Accessor>& accessors, PrimitiveReader& reader, int skin,
                     const file::Primitive& primitive, ReadMesh& read) {
    const std::string list = read.where + ".attributes";
    struct Set {
        const Accessor *joints, *weights;
    };
    std::vector<Set> sets;
    for (int set = 0;; ++set) {
        check_time();
        charge_work(8 * primitive.attributes.size());
        const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
        const Accessor* joint_accessor =
            reader.attribute(list, primitive.attributes, {joints.c_str(), 4, 4, kSmallUnsigned, {}, {}, {}}, std::nullopt);
        const Accessor* weight_accessor =
            reader.attribute(list, primitive.attributes, {weights.c_str(), 4, 4, kFloatOnly, kSmallUnsigned, {}, {}}, std::nullopt);
        if ((joint_accessor == nullptr) != (weight_accessor == nullptr))
            document.warn(fmt::format("{}: {} is there without {}, ignored", list, joint_accessor != nullptr ? joints : weights,
                                      joint_accessor != nullptr ? weights : joints));
        if (joint_accessor == nullptr || weight_accessor == nullptr) break;
        const std::size_t count = usable(accessors, file::find(primitive.attributes, "POSITION")).count();
        const std::size_t least = std::min(joint_accessor->count(), weight_accessor->count());
        if (least < count || (document.options.strict && (joint_accessor->count() != count || weight_accessor->count() != count)))
            refuse(read.where, fmt::format("{} and {}: expected {} elements as in POSITION, found {} and {}", joints, weights, count,
                                           joint_accessor->count(), weight_accessor->count()));
        sets.push_back({joint_accessor, weight_accessor});
    }
    if (sets.empty()) return false;

    const std::size_t joint_count = document.file.skins[static_cast<std::size_t>(skin)].joints.size();
    const std::size_t vertices = read.source_vertices.size();
    document.geometry.take(std::uint64_t{vertices} * (sets.size() * sizeof(Influence) + sizeof(Vec3d)));
    read.source.sets = sets.size();
    read.source.influences.reserve(vertices * sets.size());
    std::size_t negative = 0, without = 0, other_sum = 0, out_of_range = 0, not_finite = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        double sum = 0.0;
        bool has_not_finite = false, has_negative = false;
        for (const Set& set : sets) {
            Influence& influence = read.source.influences.emplace_back();
            set.joints->read_unsigned(read.source_vertices[v], influence.joint);
            set.weights->read_floats(read.source_vertices[v], influence.weight);
            for (std::size_t k = 0; k < 4; ++k) {
                const float weight = influence.weight[k];
                const bool finite = shading::finite(weight);
                has_not_finite = has_not_finite || !finite;
                has_negative = has_negative || (finite && weight < 0.0f);
                if (!finite || !(weight > 0.0f)) {
                    influence.weight[k] = 0.0f;
                    continue;
                }
                if (influence.joint[k] >= joint_count) {
                    const std::string what = fmt::format("{}: a vertex names joint {}, but skin {} has {}", set.joints->name(),
                                                         influence.joint[k], skin, joint_count);
                    if (document.options.strict) refuse(read.where, what);
                    if (out_of_range++ == 0) document.warn(fmt::format("{}: {}; without such weights", read.where, what));
                    influence.joint[k] = 0;
                    influence.weight[k] = 0.0f;
                    continue;
                }
                sum += double{weight};
            }
        }
        if (has_not_finite) ++not_finite;
        if (has_negative) ++negative;
        constexpr double kTolerance = 0.02;  // weights in 8-bit integers, each rounded alone, are wrong by up to 0.008 together
        if (!(sum > 0.0))
            ++without;
        else if (!(sum > 1 - kTolerance && sum < 1 + kTolerance))
            ++other_sum;
    }
    const auto found = [&](std::size_t count, const char* what) {
        return fmt::format("{}.WEIGHTS_0: {} of {} vertices have {}", list, count, vertices, what);
    };
    const auto warn = [&](std::size_t count, const char* what) {
        if (count > 0) document.warn(found(count, what));
    };
    if (not_finite > 0)
        document.go_on_without({{ErrorCode::bad_input, found(not_finite, "weights that are not finite")}}, "these are left out");
    warn(negative, "negative weights, which are left out");
    warn(without, "no weights, moved by the skin's first joint");
    warn(other_sum, "weights whose sum is not 1, drawn divided by it");
    return true;
}

}  // namespace halflit::io::detail
