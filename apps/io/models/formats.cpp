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

/// Marks that count as a format's own, whatever else the file has.
constexpr int kCertain = 1'000'000;
constexpr int certain_if(bool is) { return is ? kCertain : 0; }

/// Lines of OBJ: two points for a statement with its numbers, one for its other words.
int like_obj(const FileBegin& begin) {
    static constexpr std::string_view kWithNumbers[] = {"v", "vn", "vt", "vp", "f", "fo", "l", "p"};
    static constexpr std::string_view kOthers[] = {"o",    "g",        "s",        "mtllib",     "usemtl", "newmtl", "mg",
                                                   "lod",  "cstype",   "deg",      "bevel",      "surf",   "curv",   "curv2",
                                                   "parm", "c_interp", "d_interp", "shadow_obj", "maplib", "usemap", "call"};
    const auto is_in = [](std::string_view word, const auto& list) {
        return std::find(std::begin(list), std::end(list), word) != std::end(list);
    };
    int score = 0;
    for (const std::string_view line : begin.lines) {
        Words words(line);
        const std::string_view word = words.next();
        const std::string_view value = words.next();
        if (is_in(word, kWithNumbers) && parse_loosely(value.substr(0, value.find('/')))) score += 2;
        if (is_in(word, kOthers)) ++score;
    }
    return score;
}

/// Words of STL: a keyword with what has to come next, wherever lines end.
int like_stl_text(const FileBegin& begin) {
    int score = 0;
    for (const std::string_view line : begin.lines) {
        Words words(line);
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const std::string_view after = Words(words.rest()).next();
            const bool is_pair = (same_word(word, "facet") && same_word(after, "normal")) ||
                                 (same_word(word, "outer") && same_word(after, "loop")) ||
                                 (same_word(word, "vertex") && parse_loosely(after.substr(0, after.find_first_of(",;"))));
            if (is_pair) score += 2;
            if (same_word(word, "endloop") || same_word(word, "endfacet") || same_word(word, "endsolid")) ++score;
        }
        Words first(line);
        if (same_word(first.next(), "solid")) ++score;
    }
    return score;
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

int like_stl(const FileBegin& begin) {
    if (fits_binary_stl(begin.bytes)) return kCertain;
    if (begin.is_text) return like_stl_text(begin);
    const bool says_solid = same_word(begin.word().substr(0, 5), "solid");
    return says_solid || looks_like_binary_stl(begin.bytes) ? 1 : 0;
}

/// JSON begins with a bracket, some behind a comment.
int like_gltf(const FileBegin& begin) {
    const bool comment = begin.word().starts_with("//") || begin.word().starts_with("/*");
    const auto has_bracket = [](std::string_view line) { return line.find('{') != line.npos; };
    return certain_if(begin.word().starts_with('{') || (comment && std::any_of(begin.lines.begin(), begin.lines.end(), has_bracket)));
}

bool is_zip(std::string_view text) { return text.starts_with("PK\3\4") || text.starts_with("PK\5\6"); }

bool is_ply(std::string_view text) {
    return text.size() > 3 && same_word(text.substr(0, 3), "ply") && (is_line_end(text[3]) || is_blank(text[3]));
}

/// A reader that does not need the file's name.
template <auto kRead>
auto by_bytes(const ModelFile& file, const LoadOptions& options) {
    return kRead(file.bytes, file.folder, options);
}

constexpr FormatRow kFormats[] = {
    {ModelFormat::glb, "GLB", ".glb", [](const FileBegin& begin) { return certain_if(is_glb(begin.bytes)); }, by_bytes<read_gltf>,
     by_bytes<files_of_gltf>},
    {ModelFormat::three_mf, "3MF", ".3mf", [](const FileBegin& begin) { return certain_if(is_zip(as_text(begin.bytes))); },
     by_bytes<read_three_mf>, nullptr},
    {ModelFormat::ply, "PLY", ".ply", [](const FileBegin& begin) { return certain_if(is_ply(as_text(begin.bytes))); }, by_bytes<read_ply>,
     by_bytes<files_of_ply>},
    {ModelFormat::gltf, "glTF", ".gltf", like_gltf, by_bytes<read_gltf>, by_bytes<files_of_gltf>},
    {ModelFormat::stl, "STL", ".stl", like_stl, by_bytes<read_stl>, nullptr},
    {ModelFormat::obj, "OBJ", ".obj", like_obj, read_obj, files_of_obj},
    {ModelFormat::off, "OFF", ".off", [](const FileBegin& begin) { return certain_if(is_off_header(begin.word())); }, by_bytes<read_off>,
     nullptr},
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

std::string_view begin_of(std::span<const std::byte> bytes) { return as_text(bytes.first(std::min<std::size_t>(bytes.size(), 1024))); }

/// True for a ZIP file whose first entry is a scene of USD.
bool begins_with_usd(std::span<const std::byte> bytes) {
    constexpr std::size_t kNameSize = 26, kName = 30;
    const std::string_view text = begin_of(bytes);
    if (!is_zip(text) || text.size() <= kName) return false;
    const std::string_view name = text.substr(kName, u32_at(bytes, kNameSize) & 0xFFFFu);
    return name.ends_with(".usdc") || name.ends_with(".usda") || name.ends_with(".usd");
}

constexpr std::string_view kByBlender = "convert it by Blender to GLB",
                           kByCad = "export it from a CAD program (FreeCAD, CadQuery) as STL or 3MF",
                           kByCloud = "convert it by CloudCompare or PDAL to PLY";
constexpr ForeignFormat kForeign[] = {
    {"FBX", "Kaydara FBX Binary", kByBlender},
    {"FBX (text)", "; FBX ", kByBlender},
    {"Blender", "BLENDER", "export it from Blender as GLB"},
    {"a compressed Blender file", "\x28\xB5\x2F\xFD", "decompress it; export Blender files as GLB"},
    {"USD", "PXR-USDC", kByBlender},
    {"USD (text)", "#usda", kByBlender},
    {"STEP or IFC", "ISO-10303-21", kByCad},
    {"IGES", "S      1", kByCad, 72},
    {"DWG", "AC10", kByCad},
    {"JT", "Version ", kByCad, 0,
     [](std::span<const std::byte> bytes) { return begin_of(bytes).substr(0, 80).find("DM ") != std::string_view::npos; }},
    {"OpenCASCADE BREP", "DBRep_DrawableShape", kByCad},
    {"OpenCASCADE BREP", "CASCADE Topology", kByCad},
    {"LAS or LAZ", "LASF", kByCloud},
    {"E57", "ASTM-E57", kByCloud},
    {"PCD", "# .PCD", kByCloud},
    {"VTK", "# vtk DataFile", "export it from ParaView as GLB or PLY"},
    {"VRML", "#VRML", kByBlender},
    {"Alembic", "Ogawa", kByBlender},
    {"3DS", "MM", kByBlender, 0, [](std::span<const std::byte> bytes) { return bytes.size() >= 6 && u32_at(bytes, 2) == bytes.size(); }},
    {"LightWave", "FORM", kByBlender},
    {"a RAR file", "Rar!", "unpack it"},
    {"a 7z file", "7z\xBC\xAF", "unpack it"},
    {"a gzip file", "\x1F\x8B", "unpack it"},
    {"a PNG picture", "\x89PNG", "it holds no shape"},
    {"a JPEG picture", "\xFF\xD8\xFF", "it holds no shape"},
    {"a PDF document", "%PDF", "it holds no shape that is read"},
    {"COLLADA", "<", kByBlender, 0,
     [](std::span<const std::byte> bytes) { return begin_of(bytes).find("<COLLADA") != std::string_view::npos; }},
    {"AMF", "<", "convert it by a slicer to 3MF", 0,
     [](std::span<const std::byte> bytes) { return begin_of(bytes).find("<amf") != std::string_view::npos; }},
    {"X3D", "<", kByBlender, 0, [](std::span<const std::byte> bytes) { return begin_of(bytes).find("<X3D") != std::string_view::npos; }},
    {"USDZ", "PK", kByBlender, 0, begins_with_usd},
};

}  // namespace

const ForeignFormat* find_foreign_format(std::span<const std::byte> bytes) {
    if (fits_binary_stl(bytes)) return nullptr;  // whose title is free
    const std::string_view text = begin_of(bytes);
    for (const ForeignFormat& row : kForeign)
        if (text.size() > row.offset && text.substr(row.offset).starts_with(row.begins) && (row.is_it == nullptr || row.is_it(bytes)))
            return &row;
    return nullptr;
}

std::span<const FormatRow> formats() { return kFormats; }

const FormatRow* find_format(std::span<const std::byte> bytes) {
    const FileBegin begin(bytes);
    const FormatRow* found = nullptr;
    int most = 0;
    for (const FormatRow& row : kFormats) {
        const int score = row.likeness(begin);
        if (score > most) most = score, found = &row;
        if (most >= kCertain) break;
    }
    return found;
}

FileBegin::FileBegin(std::span<const std::byte> whole) : bytes(whole), is_text(begins_as_text(whole)) {
    constexpr std::size_t kMostLines = 256, kMostBytes = 65536, kMostSkipped = std::size_t{1} << 20;
    const std::string_view text = as_text(whole);
    Lines all(text.substr(0, kMostSkipped));
    std::size_t first = 0;
    for (std::string_view line; lines.size() < kMostLines && all.next(line);) {
        const std::string_view words = Words(line).rest();
        const auto at = static_cast<std::size_t>(line.data() - text.data());
        if (words.empty() || words[0] == '#') continue;
        if (lines.empty()) first = at;
        if (at > first + kMostBytes) break;
        lines.push_back(words.substr(0, kMostBytes));
        if (!is_text) break;
    }
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
