#include "apps/io/models/formats.hpp"

#include "apps/io/files/little_endian.hpp"
#include "apps/io/gltf/loader.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace halflit {

namespace io::detail {

namespace {

/// Statements with which an OBJ file may begin.
bool is_obj_statement(std::string_view word) {
    static constexpr std::array kWords{"v",   "vn",    "vt",       "vp",       "f",          "fo",     "l",      "p",
                                       "o",   "g",     "s",        "mtllib",   "usemtl",     "mg",     "lod",    "cstype",
                                       "deg", "bevel", "c_interp", "d_interp", "shadow_obj", "maplib", "usemap", "call"};
    return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// The first word of a text, past lines that are empty or a comment.
std::string_view first_word(std::string_view text) {
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) {
        const std::string_view word = Words(line).next();
        if (!word.empty() && word[0] != '#') return word;
    }
    return {};
}

/// A binary STL file that was cut off, or has more behind its triangles: a number of triangles, and a first triangle, that may be meant.
bool looks_like_binary_stl(std::span<const std::byte> bytes) {
    constexpr std::size_t kTitle = 80, kFirst = 84, kRecord = 50;
    if (bytes.size() < kFirst + kRecord) return false;
    const std::uint32_t count = u32_at(bytes, kTitle);
    if (count > 1u << 27 || (count == 0 && (bytes.size() - kFirst) % kRecord != 0)) return false;
    for (std::size_t i = 0; i < 12; ++i) {  // the normal, then three corners
        const float value = std::bit_cast<float>(u32_at(bytes, kFirst + 4 * i)), size = value < 0 ? -value : value;
        if (!(size <= (i < 3 ? 1.5f : 1e9f)) || (size > 0 && size < 1e-12f)) return false;
    }
    return true;
}

Likeness certain_if(bool is) { return is ? Likeness::certain : Likeness::none; }

Likeness like_stl(const FileBegin& begin) {
    const bool says_solid = begin.word.size() >= 5 && same_word(begin.word.substr(0, 5), "solid");
    if (says_solid || fits_binary_stl(begin.bytes)) return Likeness::certain;
    return looks_like_binary_stl(begin.bytes) ? Likeness::perhaps : Likeness::none;
}

bool is_zip(std::string_view text) { return text.starts_with("PK\3\4") || text.starts_with("PK\5\6"); }

bool is_ply(std::string_view text) { return text.starts_with("ply") && text.size() > 3 && is_line_end(text[3]); }

constexpr FormatRow kFormats[] = {
    {ModelFormat::glb, "GLB", ".glb", [](const FileBegin& begin) { return certain_if(is_glb(begin.bytes)); }, read_gltf, files_of_gltf},
    {ModelFormat::three_mf, "3MF", ".3mf", [](const FileBegin& begin) { return certain_if(is_zip(as_text(begin.bytes))); }, read_three_mf,
     nullptr},
    {ModelFormat::ply, "PLY", ".ply", [](const FileBegin& begin) { return certain_if(is_ply(as_text(begin.bytes))); }, read_ply,
     files_of_ply},
    {ModelFormat::gltf, "glTF", ".gltf", [](const FileBegin& begin) { return certain_if(begin.word.starts_with('{')); }, read_gltf,
     files_of_gltf},
    {ModelFormat::stl, "STL", ".stl", like_stl, read_stl, nullptr},
    {ModelFormat::obj, "OBJ", ".obj", [](const FileBegin& begin) { return certain_if(is_obj_statement(begin.word)); }, read_obj,
     files_of_obj},
    {ModelFormat::off, "OFF", ".off", [](const FileBegin& begin) { return certain_if(is_off_header(begin.word)); }, read_off, nullptr},
};

constexpr bool each_format_has_a_row() {
    for (std::size_t format = 0; format < std::size(kFormats); ++format) {
        int rows = 0;
        for (const FormatRow& row : kFormats) rows += static_cast<std::size_t>(row.format) == format ? 1 : 0;
        if (rows != 1) return false;
    }
    return true;
}
static_assert(each_format_has_a_row());

}  // namespace

std::span<const FormatRow> formats() { return kFormats; }

const FormatRow* find_format(std::span<const std::byte> bytes) {
    const FileBegin begin{bytes, first_word(as_text(bytes))};
    const FormatRow* likely = nullptr;
    for (const FormatRow& row : kFormats) {
        const Likeness likeness = row.likeness(begin);
        if (likeness == Likeness::certain) return &row;
        if (likeness == Likeness::perhaps && likely == nullptr) likely = &row;
    }
    return likely;
}

std::string list_of_formats(std::string_view FormatRow::*column) {
    std::array<std::string_view, std::size(kFormats)> words;
    for (const FormatRow& row : kFormats) words[static_cast<std::size_t>(row.format)] = row.*column;
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) list.append(i == 0 ? "" : i + 1 == words.size() ? " or " : ", ").append(words[i]);
    return list;
}

}  // namespace io::detail

std::string_view model_format_name(ModelFormat format) {
    const auto rows = io::detail::formats();
    return std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.format == format; })->name;
}

std::optional<ModelFormat> find_model_format(std::span<const std::byte> bytes) {
    const io::detail::FormatRow* const row = io::detail::find_format(bytes);
    return row == nullptr ? std::nullopt : std::optional(row->format);
}

}  // namespace halflit
