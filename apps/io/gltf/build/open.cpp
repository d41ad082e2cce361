#include "apps/io/gltf/build/open.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/codecs/draco.hpp"
#include "apps/io/gltf/codecs/meshopt.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "apps/io/gltf/file/json.hpp"
#include "apps/io/gltf/file/versions.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "apps/io/gltf/text/json_place.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace halflit::io::detail {

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{32} << 20;  // memory that any file may use
constexpr std::uint64_t kBytesPerByte = 96;  // more for each byte of the file; the most that one needs is 76, a flat-shaded u8 index

void fetch_buffers(Document& document) {
    std::uint64_t total = 0;
    document.owned_buffers.reserve(document.file.buffers.size());
    document.buffers.resize(document.file.buffers.size());
    for (std::size_t i = 0; i < document.file.buffers.size(); ++i) {
        if (!document.used.has(Target::buffers, i)) continue;
        const file::Buffer& entry = document.file.buffers[i];
        const std::string where = fmt::format("buffers[{}]", i);
        std::span<const std::byte> bytes;
        try {
            if (entry.uri) {
                bytes = document.owned_buffers.emplace_back(document.read_uri(*entry.uri, where + ".uri"));
            } else if (i == 0 && document.glb.has_bin) {
                bytes = document.glb.bin;
            } else {
                refuse(where, "has no uri, and the file has no BIN chunk for it");
            }
        } catch (const LoadFailure& failure) {
            document.go_on_without(failure, "what is in it is left out");
            continue;
        }
        if (bytes.size() < entry.byte_length) {
            const std::string what =
                fmt::format("{}.byteLength: is {}, but only {} bytes are there", where, entry.byte_length, bytes.size());
            document.go_on_without({{ErrorCode::bad_input, what}}, "these are read");
        }
        total += bytes.size();
        if (total > document.options.limits.max_total_bytes)
            refuse(where,
                   fmt::format("the buffers have more than {} bytes, which is max_total_bytes", document.options.limits.max_total_bytes),
                   ErrorCode::limit);
        document.buffers[i] = document.options.strict ? bytes.first(static_cast<std::size_t>(entry.byte_length)) : bytes;
    }
}

void check_buffer_views(Document& document) {
    const file::File& file = document.file;
    for (std::size_t i = 0; i < file.buffer_views.size(); ++i) {
        const file::BufferView& view = file.buffer_views[i];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= file.buffers.size()) continue;  // noted, and not used
        const std::uint64_t end = view.byte_offset + view.byte_length;                                  // both at most 2^53
        const std::uint64_t size = file.buffers[static_cast<std::size_t>(view.buffer)].byte_length;
        const bool used = document.used.has(Target::buffer_views, i);
        if (end <= size || (!used && document.warnings_are_full())) continue;
        const std::string what = fmt::format("byteOffset {} and byteLength {} end at {}, but buffer {} has {} bytes", view.byte_offset,
                                             view.byte_length, end, view.buffer, size);
        if (used && document.options.strict) refuse(fmt::format("bufferViews[{}]", i), what);
        document.warn(fmt::format("bufferViews[{}]: {}; {}", i, what, used ? "what is there is read" : kNothingUsesIt));
    }
}

void fill_info(Document& document, std::span<const std::byte> bytes) {
    SceneInfo& info = document.info;
    const file::File& file = document.file;
    info.format = is_glb(bytes) ? "GLB" : "glTF";
    info.unit_m = 1.0;
    info.version = file.version;
    info.generator = printable(file.generator, 100);
    constexpr std::size_t kMembers = 10;  // of ExactMeasures
    for (std::size_t i = 0; i + kMembers <= file.measures.size(); i += kMembers) {
        const double* const m = &file.measures[i];
        if (m[1] <= m[4] && m[2] <= m[5] && m[3] <= m[6] && m[0] >= 0 && m[0] < static_cast<double>(file.nodes.size()))
            info.exact.push_back({static_cast<int>(m[0]), {m[1], m[2], m[3]}, {m[4], m[5], m[6]}, m[7], m[8], m[9] > 0 ? 1 : 0});
    }
    for (const std::string_view warning : file.import_warnings) document.warn(printable(warning, 200));
    info.scenes = file.scenes.size();
    info.meshes = file.meshes.size();
    info.primitives = file.primitives;
    info.nodes = file.nodes.size();
    info.materials = file.materials.size();
    info.textures = file.textures.size();
    info.images = file.images.size();
    info.animations = file.animations.size();
    info.skins = file.skins.size();
    info.cameras = file.cameras.size();
    info.lights = file.lights.size();
    info.morph_targets = file.morph_targets;
    const auto list = [](const std::vector<std::string_view>& names, std::vector<std::string>& shown) {
        std::set<std::string_view> seen;
        TimeCheck check;
        for (const std::string_view name : names) {
            check();
            if (seen.insert(name).second) shown.push_back(printable(name, 80));
        }
    };
    list(file.extensions_used, info.extensions_used);
    list(file.extensions_required, info.extensions_required);
}

/// Gives the document a JSON text of its own, without what breaks the rules of JSON alone. It is as long as the file's, so that places in
/// it are places in the file.
std::string& own_text(Document& document) {
    if (document.mended.empty()) document.mended = document.text;
    document.text = document.mended;
    return document.mended;
}

/// Bytes that are not UTF-8 become '?'.
void mend_bytes(Document& document) {
    std::size_t bad = find_invalid_utf8(document.text);
    if (bad == std::string_view::npos) return;
    document.warn(fmt::format("{}: the byte \"{}\" is not UTF-8; such bytes are read as '?'", named_place(document.text, bad),
                              printable(document.text.substr(bad, 1))));
    std::string& text = own_text(document);
    TimeCheck check;
    for (std::size_t at = bad; at < text.size();) {
        check();
        const int length = utf8_sequence(text, at);
        if (length == 0) text[at] = '?';
        at += static_cast<std::size_t>(std::max(1, length));
    }
}

/// Blanks what is in front of a key that is there twice: the last one counts, as in JavaScript.
void mend_twins(Document& document) {
    const std::vector<Twin> twins = std::move(document.notes.twins);
    for (const Twin& twin : twins)
        if (!document.warnings_are_full())
            document.warn(fmt::format("{}: the key {} is there twice, the last one is read", named_place(document.text, twin.again),
                                      printable(document.text.substr(twin.again, document.text.substr(twin.again + 1, 60).find('"') + 2))));
    std::string& text = own_text(document);
    for (const Twin& twin : twins)
        std::fill(text.begin() + static_cast<std::ptrdiff_t>(twin.first), text.begin() + static_cast<std::ptrdiff_t>(twin.next), ' ');
    document.notes = {};
}

JsonScanLimits scan_limits(const LoadOptions& options) { return {options.limits.max_json_depth, options.limits.max_json_tokens}; }

}  // namespace

void set_geometry_limit(Document& document) {
    std::uint64_t size = document.file_bytes;
    for (const auto& buffer : document.owned_buffers) size += buffer.size();
    size += std::min(size, compressed_bytes(document) + draco_bytes(document));  // several views may have the same bytes
    document.geometry.set_limit(std::min(document.options.limits.max_geometry_bytes, kFreeBytes + kBytesPerByte * size));
}

std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    if (bytes.size() > options.limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {} (max_file_bytes)", bytes.size(), options.limits.max_file_bytes),
               ErrorCode::limit);
    if (bytes.empty()) refuse("", "the file is empty, expected a glTF file");
    auto document = std::make_unique<Document>(options, base_dir);
    take(document->folder.check(), "");
    document->file_bytes = bytes.size();
    document->glb.json = bytes;
    if (is_glb(bytes)) document->glb = take(split_glb(bytes, options.strict), "");
    for (std::string& warning : document->glb.warnings) document->warn(std::move(warning));

    const std::string_view text(reinterpret_cast<const char*>(document->glb.json.data()), document->glb.json.size());
    document->text = trimmed(text, document->warnings, options.strict);
    if (!options.strict) mend_bytes(*document);
    const auto read = [&] {
        document->file = read_gltf_json(document->text, scan_limits(options),
                                        Budget("its objects", kFreeBytes + kBytesPerByte * text.size()), document->notes, options.strict);
    };
    read();
    if (!document->notes.twins.empty()) {
        mend_twins(*document);
        read();
    }
    check_extensions(*document);
    choose_forms(document->file);
    fill_info(*document, bytes);
    set_geometry_limit(*document);
    document->encoded_images = Budget("reading the pictures", options.limits.max_total_bytes);
    return document;
}

void settle(Document& document, std::span<const int> drawn_nodes, std::span<const int> parents) {
    document.used = find_used(document.file, document.animations, drawn_nodes, parents);
    const auto drawn = [&](const Owner& owner) { return document.used.has(owner.target, owner.element); };
    const JsonScanLimits limits = scan_limits(document.options);
    for (Note& fault : document.notes.faults) {
        if (!drawn(fault.owner)) continue;
        const LoadFailure failure = failure_at(document.text, limits, fault.offset, fault.what, ErrorCode::bad_input);
        if (document.options.strict) throw failure;
        fault.instead = "ignored";
        if (fault.owner.target != Target::animations) {
            if (!document.first_failure) document.first_failure = failure.error;
            continue;
        }
        fault.instead = "the animation is left out";
        std::erase_if(document.animations.used,
                      [&](const AnimationUse::Used& used) { return used.animation == static_cast<int>(fault.owner.element); });
    }

    std::vector<Note> notes = std::move(document.notes.warnings);
    for (Note& fault : document.notes.faults) notes.push_back(std::move(fault));
    const std::size_t most = std::min(notes.size(), Notes::kMostWarnings);
    std::partial_sort(notes.begin(), notes.begin() + static_cast<std::ptrdiff_t>(most), notes.end(),
                      [](const Note& a, const Note& b) { return a.offset < b.offset; });
    document.warnings_left_out += document.notes.warnings_left_out + notes.size() - most;
    notes.resize(most);
    std::vector<std::size_t> offsets;
    for (const Note& note : notes) offsets.push_back(note.offset);
    const std::vector<std::string> paths = json_paths_at(document.text, offsets, limits);
    for (std::size_t i = 0; i < notes.size(); ++i) {
        const bool counts = notes[i].owner.target == Target::none || drawn(notes[i].owner);
        document.warn(fmt::format("{}: {}, {}", paths[i].empty() ? "the text" : printable(paths[i], 120), notes[i].what,
                                  counts ? notes[i].instead : kNothingUsesIt));
    }
    document.notes = {};
}

void load_buffers(Document& document) {
    fetch_buffers(document);
    check_buffer_views(document);
    set_geometry_limit(document);
    decode_views(document);
    decode_draco(document);
}

}  // namespace halflit::io::detail
