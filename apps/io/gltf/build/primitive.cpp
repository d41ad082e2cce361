#include "apps/io/gltf/build/primitive.hpp"

#include "apps/io/gltf/build/vertex_values.hpp"
#include "apps/io/gltf/codecs/spz.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace halflit::io::detail {

namespace {

using enum Component;
constexpr Component kFloat[] = {f32}, kUnsigned[] = {u8, u16}, kSigned[] = {i8, i16}, kSmall[] = {u8, i8, u16, i16};
constexpr AttributeRule kPosition{"POSITION", 3, 3, kFloat, {}, kSmall, kSmall};
constexpr AttributeRule kNormal{"NORMAL", 3, 3, kFloat, {}, {}, kSigned};
constexpr AttributeRule kTangent{"TANGENT", 4, 4, kFloat, {}, {}, kSigned};
constexpr AttributeRule kUv0{"TEXCOORD_0", 2, 2, kFloat, kUnsigned, kSmall, kSigned};
constexpr AttributeRule kUv1{"TEXCOORD_1", 2, 2, kFloat, kUnsigned, kSmall, kSigned};
constexpr AttributeRule kColor{"COLOR_0", 3, 4, kFloat, kUnsigned, {}, {}};
constexpr AttributeRule kPositionDelta{"POSITION", 3, 3, kFloat, {}, kSigned, kSigned};
constexpr AttributeRule kNormalDelta{"NORMAL", 3, 3, kFloat, {}, kSigned, kSigned};
constexpr AttributeRule kTangentDelta{"TANGENT", 3, 3, kFloat, {}, kSigned, kSigned};
constexpr AttributeRule kUv0Delta{"TEXCOORD_0", 2, 2, kFloat, kSmall, kSigned, {}};
constexpr AttributeRule kUv1Delta{"TEXCOORD_1", 2, 2, kFloat, kSmall, kSigned, {}};
constexpr AttributeRule kColorDelta{"COLOR_0", 3, 4, kFloat, kSmall, {}, {}};

constexpr std::size_t kMaxIndices = std::numeric_limits<std::int32_t>::max();

bool contains(std::span<const Component> list, Component component) { return std::find(list.begin(), list.end(), component) != list.end(); }

std::vector<Vec3f> read_vec3(const Accessor& accessor, std::span<const std::uint32_t> vertices) {
    std::vector<Vec3f> out(vertices.size());
    float value[4];
    for (std::size_t i = 0; i < out.size(); ++i) {
        accessor.read_floats(vertices[i], value);
        out[i] = {value[0], value[1], value[2]};
    }
    return out;
}

std::vector<Vec2f> read_vec2(const Accessor& accessor, std::span<const std::uint32_t> vertices) {
    std::vector<Vec2f> out(vertices.size());
    float value[4] = {};
    for (std::size_t i = 0; i < out.size(); ++i) {
        accessor.read_floats(vertices[i], value);
        out[i] = {value[0], value[1]};
    }
    return out;
}

/// `w` is the fourth component of values that have three.
std::vector<Vec4f> read_vec4(const Accessor& accessor, std::span<const std::uint32_t> vertices, float w) {
    std::vector<Vec4f> out(vertices.size());
    float value[4] = {0, 0, 0, w};
    for (std::size_t i = 0; i < out.size(); ++i) {
        accessor.read_floats(vertices[i], value);
        out[i] = {value[0], value[1], value[2], value[3]};
    }
    return out;
}

Topology topology_of(file::Mode mode) {
    using enum file::Mode;
    return mode == points                                             ? Topology::points
           : mode == lines || mode == line_loop || mode == line_strip ? Topology::lines
                                                                      : Topology::triangles;
}

/// Converts strips and loops to lines, strips and fans to triangles, all with the winding of the first (glTF 2.0, 3.7.2.1).
std::vector<std::uint32_t> as_list(file::Mode mode, std::vector<std::uint32_t> run) {
    if (mode == file::Mode::triangles || mode == file::Mode::lines || mode == file::Mode::points) return run;
    std::vector<std::uint32_t> out;
    if (topology_of(mode) == Topology::lines) {
        if (run.size() < 2) return out;
        out.reserve(2 * run.size());
        for (std::size_t i = 0; i + 1 < run.size(); ++i) out.insert(out.end(), {run[i], run[i + 1]});
        if (mode == file::Mode::line_loop) out.insert(out.end(), {run.back(), run.front()});
        return out;
    }
    if (run.size() < 3) return out;
    out.reserve(3 * (run.size() - 2));
    for (std::size_t i = 0; i + 2 < run.size(); ++i) {
        if (mode == file::Mode::triangle_fan)
            out.insert(out.end(), {run[i + 1], run[i + 2], run[0]});
        else
            out.insert(out.end(), {run[i], run[i + 1 + i % 2], run[i + 2 - i % 2]});
    }
    return out;
}

}  // namespace

PrimitiveReader::PrimitiveReader(Document& document, const std::vector<Accessor>& accessors)
    : document_(document), accessors_(accessors), quantized_(document.file.uses("KHR_mesh_quantization")) {}

const Accessor* PrimitiveReader::attribute(const std::string& list, const file::Attributes& attributes, const AttributeRule& rule,
                                           std::optional<std::size_t> count) {
    try {
        return checked_attribute(list, attributes, rule, count);
    } catch (const LoadFailure& failure) {
        if (!count) throw;
        document_.go_on_without(failure, fmt::format("{} is left out", rule.name));
        return nullptr;
    }
}

const Accessor* PrimitiveReader::checked_attribute(const std::string& list, const file::Attributes& attributes, const AttributeRule& rule,
                                                   std::optional<std::size_t> count) {
    const int found = file::find(attributes, rule.name);
    if (found < 0) return nullptr;
    const Accessor* read = &usable(accessors_, found);
    const Accessor& accessor = *read;
    const std::string where = fmt::format("{}.{}", list, rule.name);
    if (accessor.components() < rule.min_components || accessor.components() > rule.max_components)
        refuse(where, fmt::format("{}: expected {} components, found {}", accessor.name(), rule.max_components, accessor.components()));
    const Component type = accessor.component();
    const bool base = contains(accessor.normalized() && type != f32 ? rule.normalized : rule.plain, type);
    const bool more = contains(accessor.normalized() ? rule.more_normalized : rule.more_plain, type);
    if (!base && !(more && quantized_)) {
        const std::string what =
            fmt::format("{}: found {}component type {}, which glTF does not allow here{}", accessor.name(),
                        accessor.normalized() ? "normalized " : "", static_cast<int>(type), more ? " without KHR_mesh_quantization" : "");
        const bool scaled = !more && !accessor.normalized() && contains(rule.normalized, type);
        if (document_.options.strict || !(more || scaled)) refuse(where, what);
        document_.warn(fmt::format("{}: {}; read as {}", where, what, scaled ? "normalized" : "it is"));
        if (scaled) read = &normalized_.try_emplace(found, accessor.as_normalized()).first->second;
    }
    if (count && accessor.count() != *count) {
        const std::string what =
            fmt::format("{}: expected {} elements as in POSITION, found {}", accessor.name(), *count, accessor.count());
        if (document_.options.strict || accessor.count() < *count) refuse(where, what);
        document_.warn(fmt::format("{}: {}; the first ones are read", where, what));
    }
    warn_of_layout(where, found);
    return read;
}

/// Vertex attributes lie at multiples of 4 bytes, and those that share a bufferView have a stride (glTF 2.0, 3.6.1.1 and 3.6.2.4).
void PrimitiveReader::warn_of_layout(const std::string& where, int index) {
    const file::Accessor& source = element(document_.file.accessors, index, "accessors");
    if (source.buffer_view < 0 || document_.warnings_are_full()) return;
    const Accessor& accessor = element(accessors_, index, "accessors");
    if (source.byte_offset % 4 != 0 && size_of(accessor.component()) < 4)
        document_.warn(fmt::format("{}.byteOffset: expected a multiple of 4 for vertices, found {}, read as it is", accessor.name(),
                                   source.byte_offset));
    if (accessor.stride() % 4 != 0)
        document_.warn(fmt::format("{}: {}: the elements are {} bytes apart, expected a multiple of 4; read as they are", where,
                                   accessor.name(), accessor.stride()));
    const auto view = static_cast<std::size_t>(source.buffer_view);
    if (document_.file.buffer_views[view].byte_stride != 0) return;
    if (const auto [first, is_new] = attribute_of_view_.try_emplace(view, index); !is_new && first->second != index)
        document_.warn(fmt::format(
            "bufferViews[{}].byteStride: is not there, but several vertex attributes share the bufferView; read as packed", view));
}

std::vector<std::uint32_t> PrimitiveReader::list_indices(const file::Primitive& primitive, const std::string& where,
                                                         std::size_t vertex_count) {
    const Accessor* accessor = primitive.indices == -1 ? nullptr : &usable(accessors_, primitive.indices);
    const auto mode = static_cast<file::Mode>(primitive.mode);
    std::size_t count = vertex_count;
    if (accessor != nullptr) {
        const Component type = accessor->component();
        if (accessor->components() != 1 || accessor->normalized() || !(type == u8 || type == u16 || type == u32))
            refuse(where + ".indices", fmt::format("{}: expected unsigned integers of one component, found {} of component type {}",
                                                   accessor->name(), accessor->components(), static_cast<int>(type)));
        count = accessor->count();
        const file::Accessor& source = document_.file.accessors[static_cast<std::size_t>(primitive.indices)];
        if (source.buffer_view >= 0 && document_.file.buffer_views[static_cast<std::size_t>(source.buffer_view)].byte_stride != 0)
            document_.warn(fmt::format("bufferViews[{}].byteStride: expected none for indices, read with it", source.buffer_view));
    }
    const std::size_t corners = corners_of(topology_of(mode));
    const char* const what = corners == 3 ? "triangles" : corners == 2 ? "lines" : "points";
    const bool is_list = mode == file::Mode::triangles || mode == file::Mode::lines || mode == file::Mode::points;
    const std::size_t most = is_list ? kMaxIndices : kMaxIndices / corners;
    if (count > most) refuse(where, fmt::format("{} indices, the limit is {}", count, most), ErrorCode::limit);
    document_.geometry.take(std::uint64_t{count} * (is_list ? 4 : 4 * corners));

    std::vector<std::uint32_t> run(count);
    if (accessor == nullptr) {
        for (std::size_t i = 0; i < count; ++i) run[i] = static_cast<std::uint32_t>(i);
    } else {
        // glTF reserves the largest value of the type, which other systems take as "restart".
        const std::uint32_t restart = accessor->component() == u8 ? 0xFFu : accessor->component() == u16 ? 0xFFFFu : 0xFFFFFFFFu;
        for (std::size_t i = 0; i < count; ++i) {
            accessor->read_unsigned(i, &run[i]);
            if (run[i] < vertex_count && run[i] != restart) continue;
            if (document_.options.strict)
                refuse(where + ".indices",
                       fmt::format("{}: entry {} is {}, {}", accessor->name(), i, run[i],
                                   run[i] < vertex_count ? "which glTF reserves" : fmt::format("but there are {} vertices", vertex_count)));
            run[i] = 0xFFFFFFFFu;
        }
    }
    if (is_list && count % corners != 0) {
        if (document_.options.strict && corners == 3) refuse(where, fmt::format("{} indices, expected a multiple of {}", count, corners));
        document_.warn(fmt::format("{}: {} indices are not a multiple of {}, the last ones left out", where, count, corners));
        run.resize(count - count % corners);
    }
    std::vector<std::uint32_t> list = as_list(mode, std::move(run));
    if (!document_.options.strict) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < list.size(); i += corners) {
            bool good = true;
            for (std::size_t c = 0; c < corners; ++c) good &= list[i + c] < vertex_count;
            for (std::size_t c = 0; good && c < corners; ++c) list[kept++] = list[i + c];
        }
        if (kept != list.size())
            document_.warn(fmt::format("{}: {} {} with indices out of range left out", where, (list.size() - kept) / corners, what));
        list.resize(kept);
    }
    return list;
}

/// Returns the file's vertices that the mesh needs. If there are more vertices than indices, these are only the ones in use, and the
/// indices are changed to match, because many primitives may share one long list of vertices. Otherwise they are all vertices, in order.
std::vector<std::uint32_t> PrimitiveReader::gather_vertices(std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
    std::vector<std::uint32_t> vertices;
    if (vertex_count <= indices.size()) {
        vertices.resize(vertex_count);
        for (std::size_t i = 0; i < vertex_count; ++i) vertices[i] = static_cast<std::uint32_t>(i);
        return vertices;
    }
    if (stamp_of_.size() < vertex_count) {
        const std::size_t highest = std::size_t{*std::max_element(indices.begin(), indices.end())} + 1;
        if (stamp_of_.size() < highest) {
            document_.geometry.take(8 * std::uint64_t{highest - stamp_of_.size()});
            stamp_of_.resize(highest, 0);
            new_number_.resize(highest, 0);
        }
    }
    ++stamp_;
    for (std::uint32_t& index : indices) {
        if (stamp_of_[index] != stamp_) {
            stamp_of_[index] = stamp_;
            new_number_[index] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(index);
        }
        index = new_number_[index];
    }
    return vertices;
}

void PrimitiveReader::read_targets(const file::Primitive& primitive, std::size_t vertex_count, std::span<const double> weights,
                                   ReadMesh& out) {
    const Mesh& mesh = out.source.mesh;
    const std::span<const std::uint32_t> vertices = out.source_vertices;
    for (std::size_t t = 0; t < std::min(primitive.targets.size(), weights.size()); ++t) {
        if (weights[t] == 0.0) continue;
        check_time();
        const std::string where = fmt::format("{}.targets[{}]", out.where, t);
        // Null for what the mesh itself lacks.
        const auto deltas = [&](const AttributeRule& rule, bool has_base, std::size_t bytes) {
            const Accessor* const found = has_base ? attribute(where, primitive.targets[t], rule, vertex_count) : nullptr;
            if (found != nullptr) document_.geometry.take(std::uint64_t{vertices.size()} * bytes);
            return found;
        };
        document_.geometry.take((t + 1 - out.source.targets.size()) * sizeof(MorphTarget));
        out.source.targets.resize(t + 1);
        MorphTarget& target = out.source.targets[t];
        if (const Accessor* a = deltas(kPositionDelta, true, 12)) target.positions = read_vec3(*a, vertices);
        if (const Accessor* a = deltas(kNormalDelta, !mesh.normals.empty(), 12)) target.normals = read_vec3(*a, vertices);
        if (const Accessor* a = deltas(kTangentDelta, !mesh.tangents.empty(), 12)) target.tangents = read_vec3(*a, vertices);
        if (const Accessor* a = deltas(kUv0Delta, !mesh.uv0.empty(), 8)) target.uv0 = read_vec2(*a, vertices);
        if (const Accessor* a = deltas(kUv1Delta, !mesh.uv1.empty(), 8)) target.uv1 = read_vec2(*a, vertices);
        if (const Accessor* a = deltas(kColorDelta, !mesh.colors.empty(), 16)) target.colors = read_vec4(*a, vertices, 0.0f);
        mend_deltas(document_, where, "POSITION", target.positions);
        mend_deltas(document_, where, "NORMAL", target.normals);
        mend_deltas(document_, where, "TANGENT", target.tangents);
        mend_deltas(document_, where, "TEXCOORD_0", target.uv0);
        mend_deltas(document_, where, "TEXCOORD_1", target.uv1);
        mend_deltas(document_, where, "COLOR_0", target.colors);
    }
}

void PrimitiveReader::read_splats(const file::Primitive& primitive, const std::string& list, const Accessor& position, ReadMesh& out) {
    const std::size_t count = position.count();
    const auto read = [&](std::string_view name, int components) {
        const std::string whole = std::string(file::kSplatAttributes) + std::string(name);
        return attribute(list, primitive.attributes, {whole.c_str(), components, components, kFloat, kSmall, {}, {}}, count);
    };
    const Accessor *const rotation = read("ROTATION", 4), *const scale = read("SCALE", 3), *const opacity = read("OPACITY", 1);
    if (rotation == nullptr || scale == nullptr || opacity == nullptr) return;
    std::vector<const Accessor*> harmonics;
    int degree = -1;
    while (degree < 4) {
        std::vector<const Accessor*> band;
        for (int n = 0; n < 2 * degree + 3; ++n)
            if (const Accessor* const one = read(fmt::format("SH_DEGREE_{}_COEF_{}", degree + 1, n), 3); one != nullptr)
                band.push_back(one);
        if (static_cast<int>(band.size()) < 2 * degree + 3) break;
        harmonics.insert(harmonics.end(), band.begin(), band.end());
        ++degree;
    }
    SplatCloud cloud;
    cloud.reserve(document_, count, std::max(degree, 0));
    float p[4] = {}, q[4] = {}, s[4] = {}, o[4] = {}, c[4] = {};
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0) check_time();
        position.read_floats(i, p), rotation->read_floats(i, q), scale->read_floats(i, s), opacity->read_floats(i, o);
        cloud.add({p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]}, o[0]);
        for (const Accessor* const one : harmonics) {
            one->read_floats(i, c);
            cloud.splats.harmonics.insert(cloud.splats.harmonics.end(), c, c + 3);
        }
    }
    if (harmonics.empty()) cloud.splats.harmonics.resize(3 * count, 0.0f);
    take_splats(std::move(cloud), primitive, out);
}

void PrimitiveReader::take_splats(SplatCloud&& cloud, const file::Primitive& primitive, ReadMesh& out) {
    cloud.splats.reference = SplatReference::khr;
    cloud.splats.linear_light = primitive.linear_splats;
    Mesh made = splat_mesh(std::move(cloud), document_);
    if (made.splats->opacities.empty()) return;
    made.name = std::move(out.source.mesh.name);
    made.material = out.source.mesh.material;
    out.source.mesh = std::move(made);
    out.source_vertices.resize(out.source.mesh.positions.size());
    std::iota(out.source_vertices.begin(), out.source_vertices.end(), 0u);
}

std::optional<ReadMesh> PrimitiveReader::read(std::size_t mesh_index, std::size_t primitive_index, std::span<const double> morph_weights) {
    const file::Primitive& primitive = document_.file.meshes[mesh_index].primitives[primitive_index];
    ReadMesh out;
    out.where = fmt::format("meshes[{}].primitives[{}]", mesh_index, primitive_index);
    if (primitive.mode > static_cast<int>(file::Mode::triangle_fan))
        refuse(out.where + ".mode", fmt::format("expected 0 to 6, found {}", primitive.mode));
    const Topology topology = topology_of(static_cast<file::Mode>(primitive.mode));
    if (topology != Topology::triangles) ++document_.info.point_and_line_primitives;
    Mesh& mesh = out.source.mesh;
    mesh.name = document_.file.meshes[mesh_index].name;
    mesh.material = std::max(primitive.material, -1);
    mesh.topology = topology;
    if (primitive.spz >= 0) {
        auto cloud = read_spz(document_.view_data(primitive.spz), document_);
        if (!cloud) refuse(out.where, fmt::format("bufferViews[{}]: expected an SPZ file, which may be damaged", primitive.spz));
        take_splats(*std::move(cloud), primitive, out);
        return mesh.splats != nullptr ? std::optional(std::move(out)) : std::nullopt;
    }
    const std::string list = out.where + ".attributes";
    const Accessor* position = attribute(list, primitive.attributes, kPosition, std::nullopt);
    if (position == nullptr) {
        document_.warn(fmt::format("{}: has no POSITION, not drawn", out.where));
        return std::nullopt;
    }
    const std::size_t count = position->count();
    if (count > kMaxIndices) refuse(out.where, fmt::format("{} vertices, the limit is {}", count, kMaxIndices), ErrorCode::limit);
    const Accessor* normal = attribute(list, primitive.attributes, kNormal, count);
    const Accessor* tangent = normal == nullptr ? nullptr : attribute(list, primitive.attributes, kTangent, count);
    const Accessor* uv0 = attribute(list, primitive.attributes, kUv0, count);
    const Accessor* uv1 = attribute(list, primitive.attributes, kUv1, count);
    const Accessor* color = attribute(list, primitive.attributes, kColor, count);

    mesh.indices = list_indices(primitive, out.where, count);
    if (mesh.indices.empty()) {
        document_.warn(fmt::format("{}: has no {}", out.where,
                                   topology == Topology::triangles ? "triangles"
                                   : topology == Topology::lines   ? "lines"
                                                                   : "points"));
        return std::nullopt;
    }
    out.source_vertices = gather_vertices(mesh.indices, count);
    const std::span<const std::uint32_t> vertices = out.source_vertices;
    document_.geometry.take(std::uint64_t{vertices.size()} *
                            (16 + (normal ? 12 : 0) + (tangent ? 16 : 0) + (uv0 ? 8 : 0) + (uv1 ? 8 : 0) + (color ? 16 : 0)));
    mesh.positions = read_vec3(*position, vertices);
    if (normal != nullptr) mesh.normals = read_vec3(*normal, vertices);
    if (tangent != nullptr) mesh.tangents = read_vec4(*tangent, vertices, 1.0f);
    if (uv0 != nullptr) mesh.uv0 = read_vec2(*uv0, vertices);
    if (uv1 != nullptr) mesh.uv1 = read_vec2(*uv1, vertices);
    if (color != nullptr) mesh.colors = read_vec4(*color, vertices, 1.0f);
    mend_values(document_, list, mesh);
    if (topology == Topology::points) {
        read_splats(primitive, list, *position, out);
        if (mesh.splats != nullptr) return out;
    }
    read_targets(primitive, count, morph_weights, out);
    for (Vec4f& t : mesh.tangents) t.w = t.w < 0.0f ? -1.0f : 1.0f;
    return out;
}

}  // namespace halflit::io::detail
