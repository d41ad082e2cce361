#include "apps/io/gltf/codecs/draco.hpp"

#include "apps/io/codecs/codec_libraries.hpp"
#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/gltf/file/accessor.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

namespace halflit::io {

bool has_draco() { return HALFLIT_HAS_DRACO != 0; }

}  // namespace halflit::io

namespace halflit::io::detail {

Result<std::unique_ptr<DracoMesh>> DracoMesh::decode(std::span<const std::byte> stream, std::uint64_t memory) {
    if (!has_draco()) return fail(ErrorCode::bad_input, "Draco meshes need the library Draco, which this build lacks");
    const auto libraries = codec_libraries();
    if (!libraries) return tl::unexpected(libraries.error());
    return (*libraries)->decode_draco(stream, memory);
}

namespace {

/// Meshes with streams, by the bufferView of the stream: those that share one are decoded together.
using Streams = std::map<int, std::vector<std::pair<std::size_t, std::size_t>>>;

Streams streams_of(const Document& document) {
    Streams streams;
    for (std::size_t m = 0; m < document.file.meshes.size(); ++m) {
        if (!document.used.has(Target::meshes, m)) continue;
        const auto& primitives = document.file.meshes[m].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (primitives[p].draco < 0) continue;
            streams[document.file.draco[static_cast<std::size_t>(primitives[p].draco)].buffer_view].emplace_back(m, p);
        }
    }
    return streams;
}

class StreamReader {
public:
    StreamReader(Document& document, int view) : document_(document), where_(fmt::format("bufferViews[{}]", view)), mesh_(open(view)) {}

    void replace(file::Primitive& primitive, const std::string& where) {
        file::File& file = document_.file;
        const file::Draco source = file.draco[static_cast<std::size_t>(primitive.draco)];
        const auto mode = static_cast<file::Mode>(primitive.mode);
        if (primitive.mode < static_cast<int>(file::Mode::triangles))
            refuse(where + ".mode", fmt::format("expected triangles, which Draco compresses, found mode {}", primitive.mode));
        if (primitive.indices >= 0 && mode == file::Mode::triangles)
            check_count(where + ".indices", primitive.indices, 3 * mesh_->triangles());
        const auto [indices, is_new] = made_.try_emplace({primitive.indices, -1}, -1);
        if (is_new) indices->second = add_indices(primitive.indices);
        primitive.indices = indices->second;
        primitive.mode = static_cast<int>(file::Mode::triangles);
        for (auto& [name, accessor] : primitive.attributes) {
            const int id = file::find(source.attributes, name);
            if (id < 0) continue;
            const std::string at = fmt::format("{}.attributes.{}", where, name);
            if (!document_.used.has(Target::accessors, static_cast<std::size_t>(accessor))) continue;
            check_count(at, accessor, mesh_->vertices());
            const auto [values, first] = made_.try_emplace({accessor, id}, -1);
            if (first) values->second = add_values(accessor, id, at);
            accessor = values->second;
        }
    }

private:
    std::unique_ptr<DracoMesh> open(int view) {
        check_time();
        constexpr std::uint64_t kTables = 8 << 10;  // bytes that stand for the time that the tables of a small stream take
        document_.geometry.take(kTables);
        auto mesh = take(DracoMesh::decode(document_.view_data(view), document_.geometry.left()), where_);
        document_.geometry.take(kTables * mesh->attributes());
        return mesh;
    }

    /// Exporters round, and count triangles that Draco leaves out.
    void check_count(const std::string& where, int accessor, std::size_t there) {
        const std::uint64_t count = document_.file.accessors[static_cast<std::size_t>(accessor)].count;
        if (count == there) return;
        const std::string what = fmt::format("accessors[{}].count is {}, but the Draco stream has {}", accessor, count, there);
        if (document_.options.strict) refuse(where, what);
        document_.warn(fmt::format("{}: {}, which are drawn", where, what));
    }

    /// Returns the new accessor.
    int append(file::Accessor accessor, int stands_for, std::vector<std::byte> data, std::size_t stride) {
        file::File& file = document_.file;
        file::BufferView view;
        view.byte_length = data.size();
        view.byte_stride = static_cast<int>(stride);
        view.decoded = static_cast<int>(document_.decoded.size());
        document_.decoded.push_back(std::move(data));
        file.buffer_views.push_back(view);
        document_.used.add(Target::buffer_views, file.buffer_views.size() - 1);
        accessor.buffer_view = static_cast<int>(file.buffer_views.size() - 1);
        accessor.byte_offset = 0;
        accessor.sparse = -1;
        accessor.stands_for = stands_for;
        file.accessors.push_back(accessor);
        document_.used.add(Target::accessors, file.accessors.size() - 1);
        return static_cast<int>(file.accessors.size() - 1);
    }

    int add_indices(int stands_for) {
        file::Accessor accessor;
        accessor.component_type = static_cast<int>(Component::u32);
        accessor.count = 3 * mesh_->triangles();
        document_.geometry.take(4 * accessor.count);
        return append(accessor, stands_for, mesh_->indices(), 0);
    }

    int add_values(int index, int id, const std::string& where) {
        file::Accessor accessor = document_.file.accessors[static_cast<std::size_t>(index)];
        accessor.count = mesh_->vertices();
        DracoRequest request{static_cast<std::uint32_t>(id), accessor.component_type, accessor.components, 0, accessor.normalized};
        const auto size = size_of(static_cast<Component>(accessor.component_type)) * static_cast<std::size_t>(accessor.components);
        request.stride = (size + 3) / 4 * 4;  // vertices lie at multiples of 4
        document_.geometry.take(std::uint64_t{request.stride} * mesh_->vertices());
        bool converted = false;
        std::vector<std::byte> values = take(mesh_->values(request, document_.options.strict ? nullptr : &converted), where);
        if (converted)
            document_.warn(fmt::format("{}: the Draco stream has floats, which become integers of component type {} as accessors[{}] has",
                                       where, accessor.component_type, index));
        return append(accessor, index, std::move(values), request.stride);
    }

    Document& document_;
    std::string where_;
    std::unique_ptr<DracoMesh> mesh_;
    std::map<std::pair<int, int>, int> made_;  // new accessors, by accessor and attribute; attribute -1: indices
};

}  // namespace

std::uint64_t draco_bytes(const Document& document) {
    std::uint64_t bytes = 0;
    for (const auto& [view, primitives] : streams_of(document))
        if (view >= 0) bytes += document.file.buffer_views[static_cast<std::size_t>(view)].byte_length;
    return bytes;
}

void decode_draco(Document& document) {
    for (const auto& [view, primitives] : streams_of(document)) {
        std::optional<StreamReader> reader;
        for (const auto& [mesh, number] : primitives) {
            file::Primitive& primitive = document.file.meshes[mesh].primitives[number];
            try {
                if (!reader) reader.emplace(document, view);
                reader->replace(primitive, fmt::format("meshes[{}].primitives[{}]", mesh, number));
            } catch (const LoadFailure& failure) {
                document.go_on_without(failure, "the primitive is left out");
                primitive.indices = kBadIndex;
            }
        }
    }
}

}  // namespace halflit::io::detail
