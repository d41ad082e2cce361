#include "apps/io/detail/gltf_document.hpp"

#include "apps/io/detail/glb_container.hpp"
#include "apps/io/text.hpp"
#include "apps/io/detail/uri.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{32} << 20;  // that any file may cost
constexpr std::uint64_t kBytesPerByte = 96;                    // and for each of its own; a flat-shaded u8 index becomes 76

std::vector<std::byte> fetch(const Document& document, const BufferEntry& entry, std::string_view where) {
    const std::size_t limit = document.options.limits.max_file_bytes;
    if (is_data_uri(entry.uri)) return take(decode_data_uri(entry.uri, limit), where);
    return take(document.folder.read(take(decode_file_uri(entry.uri), where), limit), where);
}

void load_buffers(Document& document, const GlbParts& glb) {
    std::uint64_t total = 0;
    document.owned_buffers.reserve(document.json.buffers.size());
    for (std::size_t i = 0; i < document.json.buffers.size(); ++i) {
        const BufferEntry& entry = document.json.buffers[i];
        const std::string where = fmt::format("buffers[{}]", i);
        std::span<const std::byte> bytes;
        if (entry.has_uri) {
            bytes = document.owned_buffers.emplace_back(fetch(document, entry, where + ".uri"));
        } else if (i == 0 && glb.has_bin) {
            bytes = glb.bin;
        } else {
            refuse(where, "has no uri, and the file has no BIN chunk for it");
        }
        if (bytes.size() < entry.byte_length)
            refuse(where, fmt::format("byteLength is {}, but only {} bytes are there", entry.byte_length, bytes.size()));
        total += bytes.size();
        if (total > document.options.limits.max_total_bytes)
            refuse(where, fmt::format("the buffers have more than {} bytes, which is the limit", document.options.limits.max_total_bytes),
                   ErrorCode::limit);
        document.buffers.push_back(bytes.first(static_cast<std::size_t>(entry.byte_length)));
    }
}

void check_buffer_views(const Document& document) {
    for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = document.model.bufferViews[i];
        const std::uint64_t end = std::uint64_t{view.byteOffset} + view.byteLength;  // both at most 2^53
        const std::size_t size = document.buffers[static_cast<std::size_t>(view.buffer)].size();
        if (end > size)
            refuse(fmt::format("bufferViews[{}]", i), fmt::format("byteOffset {} and byteLength {} end at {}, but buffer {} has {} bytes",
                                                                  view.byteOffset, view.byteLength, end, view.buffer, size));
    }
}

void parse_model(Document& document) {
    tinygltf::TinyGLTF parser;
    std::string error, warning;
    const std::string& text = document.json.for_tinygltf;
    const bool parsed = parser.LoadASCIIFromString(&document.model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "",
                                                   tinygltf::NO_REQUIRE);
    document.json.for_tinygltf = {};
    if (!parsed) {
        while (!error.empty() && (error.back() == '\n' || error.back() == '.')) error.pop_back();
        throw LoadFailure{{ErrorCode::bad_input, printable(error)}};
    }
    const auto same = [&](Target target, std::size_t size) { return document.json.count(target) == size; };
    const tinygltf::Model& m = document.model;
    if (!(same(Target::accessors, m.accessors.size()) && same(Target::buffer_views, m.bufferViews.size()) &&
          same(Target::nodes, m.nodes.size()) && same(Target::meshes, m.meshes.size()) && same(Target::materials, m.materials.size()) &&
          same(Target::textures, m.textures.size()) && same(Target::samplers, m.samplers.size()) && same(Target::skins, m.skins.size()) &&
          same(Target::scenes, m.scenes.size()) && same(Target::cameras, m.cameras.size()) && same(Target::lights, m.lights.size())))
        throw LoadFailure{{ErrorCode::internal, "the JSON parser left elements out"}};
}

void fill_info(Document& document) {
    SceneInfo& info = document.info;
    const Precheck& json = document.json;
    info.version = document.model.asset.version;
    info.generator = printable(document.model.asset.generator, 100);
    info.scenes = json.count(Target::scenes);
    info.meshes = json.count(Target::meshes);
    info.primitives = json.primitives;
    info.nodes = json.count(Target::nodes);
    info.materials = json.count(Target::materials);
    info.textures = json.count(Target::textures);
    info.images = json.count(Target::images);
    info.animations = json.animations;
    info.skins = json.count(Target::skins);
    info.cameras = json.count(Target::cameras);
    info.lights = json.count(Target::lights);
    for (const tinygltf::Mesh& mesh : document.model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives) info.morph_targets += primitive.targets.size();
    for (const std::string& name : json.extensions_used) info.extensions_used.push_back(printable(name, 80));
    for (const std::string& name : json.extensions_required) info.extensions_required.push_back(printable(name, 80));
}

}  // namespace

void Budget::take(std::uint64_t bytes) {
    if (bytes > left())
        throw LoadFailure{{ErrorCode::limit,
                           fmt::format("{} would take more than {} MB, which is the limit for a file of this size", what_, limit_ >> 20)}};
    used_ += bytes;
}

void Document::warn(std::string what) {
    constexpr std::size_t kMost = 100;
    if (std::find(warnings.begin(), warnings.end(), what) != warnings.end()) return;
    if (warnings.size() < kMost)
        warnings.push_back(std::move(what));
    else
        ++warnings_left_out;
}

const std::byte* Document::view_data(int buffer_view) const {
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(buffer_view)];
    return buffers[static_cast<std::size_t>(view.buffer)].data() + view.byteOffset;
}

void refuse(std::string_view where, std::string_view what, ErrorCode code) {
    throw LoadFailure{{code, fmt::format("{}{}{}", where, where.empty() ? "" : ": ", what)}};
}

std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    if (bytes.size() > options.limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {}", bytes.size(), options.limits.max_file_bytes), ErrorCode::limit);
    if (bytes.empty()) refuse("", "expected a glTF file, found no bytes at all");
    auto document = std::make_unique<Document>(options, base_dir);
    GlbParts glb;
    glb.json = bytes;
    if (is_glb(bytes)) glb = take(split_glb(bytes), "");
    for (std::string& warning : glb.warnings) document->warn(std::move(warning));

    const std::string_view text(reinterpret_cast<const char*>(glb.json.data()), glb.json.size());
    const JsonScanLimits scan{options.limits.max_json_depth, options.limits.max_json_tokens};
    document->json = take(precheck_gltf(text, scan, kFreeBytes + kBytesPerByte * text.size()), "");
    for (std::string& warning : document->json.warnings) document->warn(std::move(warning));
    parse_model(*document);
    load_buffers(*document, glb);
    check_buffer_views(*document);
    fill_info(*document);

    std::uint64_t size = bytes.size();
    for (const auto& buffer : document->owned_buffers) size += buffer.size();
    document->geometry = Budget("the geometry", std::min(options.limits.max_geometry_bytes, kFreeBytes + kBytesPerByte * size));
    document->encoded_images = Budget("reading the pictures", options.limits.max_total_bytes);
    return document;
}

}  // namespace halflit::io::detail
