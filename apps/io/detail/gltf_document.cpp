#include "apps/io/detail/gltf_document.hpp"

#include "apps/io/detail/glb_container.hpp"
#include "apps/io/detail/gltf_json.hpp"
#include "apps/io/detail/uri.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{32} << 20;  // memory that any file may use
constexpr std::uint64_t kBytesPerByte = 96;  // more for each byte of the file; the most that one needs is 76, a flat-shaded u8 index

std::vector<std::byte> fetch(const Document& document, const file::Buffer& entry, std::string_view where) {
    const std::size_t limit = document.options.limits.max_file_bytes;
    if (is_data_uri(*entry.uri)) return take(decode_data_uri(*entry.uri, limit), where);
    return take(document.folder.read(take(decode_file_uri(*entry.uri), where), limit), where);
}

void load_buffers(Document& document, const GlbParts& glb) {
    std::uint64_t total = 0;
    document.owned_buffers.reserve(document.file.buffers.size());
    for (std::size_t i = 0; i < document.file.buffers.size(); ++i) {
        const file::Buffer& entry = document.file.buffers[i];
        const std::string where = fmt::format("buffers[{}]", i);
        std::span<const std::byte> bytes;
        if (entry.uri) {
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
    for (std::size_t i = 0; i < document.file.buffer_views.size(); ++i) {
        const file::BufferView& view = document.file.buffer_views[i];
        const std::uint64_t end = view.byte_offset + view.byte_length;  // both at most 2^53
        const std::size_t size = document.buffers[static_cast<std::size_t>(view.buffer)].size();
        if (end > size)
            refuse(fmt::format("bufferViews[{}]", i), fmt::format("byteOffset {} and byteLength {} end at {}, but buffer {} has {} bytes",
                                                                  view.byte_offset, view.byte_length, end, view.buffer, size));
    }
}

void fill_info(Document& document) {
    SceneInfo& info = document.info;
    const file::File& file = document.file;
    info.version = file.version;
    info.generator = printable(file.generator, 100);
    info.scenes = file.scenes.size();
    info.meshes = file.meshes.size();
    info.primitives = file.primitives;
    info.nodes = file.nodes.size();
    info.materials = file.materials.size();
    info.textures = file.textures.size();
    info.images = file.images.size();
    info.animations = file.animations;
    info.skins = file.skins.size();
    info.cameras = file.cameras.size();
    info.lights = file.lights.size();
    info.morph_targets = file.morph_targets;
    for (const std::string_view name : file.extensions_used) info.extensions_used.push_back(printable(name, 80));
    for (const std::string_view name : file.extensions_required) info.extensions_required.push_back(printable(name, 80));
}

}  // namespace

void Document::warn(std::string what) {
    constexpr std::size_t kMost = 100;
    if (std::find(warnings.begin(), warnings.end(), what) != warnings.end()) return;
    if (warnings.size() < kMost)
        warnings.push_back(std::move(what));
    else
        ++warnings_left_out;
}

const std::byte* Document::view_data(int buffer_view) const {
    const file::BufferView& view = file.buffer_views[static_cast<std::size_t>(buffer_view)];
    return buffers[static_cast<std::size_t>(view.buffer)].data() + view.byte_offset;
}

std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    if (bytes.size() > options.limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {}", bytes.size(), options.limits.max_file_bytes), ErrorCode::limit);
    if (bytes.empty()) refuse("", "expected a glTF file, found no bytes at all");
    auto document = std::make_unique<Document>(options, base_dir);
    take(document->folder.check(), "");
    GlbParts glb;
    glb.json = bytes;
    if (is_glb(bytes)) glb = take(split_glb(bytes), "");
    for (std::string& warning : glb.warnings) document->warn(std::move(warning));

    const std::string_view text(reinterpret_cast<const char*>(glb.json.data()), glb.json.size());
    const JsonScanLimits scan{options.limits.max_json_depth, options.limits.max_json_tokens};
    document->file = read_gltf_json(text, scan, Budget("its objects", kFreeBytes + kBytesPerByte * text.size()), document->warnings);
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
