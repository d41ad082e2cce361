#include "apps/io/models/formats.hpp"

#include "apps/io/files/little_endian.hpp"
#include "apps/io/gltf/loader.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/obj_words.hpp"
#include "apps/io/models/splat_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace halflit {

namespace io::detail {

namespace {

/// Marks that count as a format's own, whatever else the file has.
constexpr int kCertain = 1'000'000;
constexpr int certain_if(bool is) { return is ? kCertain : 0; }

int like_obj(const FileBegin& begin) {
    int score = 0;
    for (const std::string_view line : begin.lines) {
        Words words(line);
        const ObjWord* const row = find_obj_word(words.next());
        std::string_view value = words.next();
        value.remove_prefix(std::min(value.find_first_not_of("([{"), value.size()));
        if (row != nullptr && (!row->with_number || parse_loosely(value.substr(0, value.find_first_of("/,;)]}"))))) score += row->score;
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
    {ModelFormat::ply, "PLY", ".ply", [](const FileBegin& begin) { return certain_if(same_word(begin.word(), "ply")); }, by_bytes<read_ply>,
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

bool names(std::span<const std::byte> zip, std::string_view part) { return as_text(zip).find(part) != std::string_view::npos; }
/// True for a ZIP file that is not 3MF, whose package may hold files of any kind.
bool is_no_package(std::span<const std::byte> bytes) { return !names(bytes, "[Content_Types].xml") && !names(bytes, ".model"); }
bool holds_sog(std::span<const std::byte> bytes) { return names(bytes, "meta.json") && names(bytes, ".webp") && is_no_package(bytes); }

/// True for a ZIP file whose first entry is a scene of USD.
bool begins_with_usd(std::span<const std::byte> bytes) {
    constexpr std::size_t kNameSize = 26, kName = 30;
    const std::string_view text = begin_of(bytes);
    if (!is_zip(text) || text.size() <= kName) return false;
    const std::string_view name = text.substr(kName, u32_at(bytes, kNameSize) & 0xFFFFu);
    return name.ends_with(".usdc") || name.ends_with(".usda") || name.ends_with(".usd");
}

/// True for a first line of section S, whose columns 73 to 80 are "S" and its number, behind blanks or zeros.
bool is_iges(std::span<const std::byte> bytes) {
    constexpr std::size_t kNumber = 73, kEnd = 80;
    const std::string_view text = begin_of(bytes).substr(0, kEnd);
    return text.size() == kEnd && text.find_first_not_of(" 0", kNumber) == kEnd - 1 && text[kEnd - 1] == '1';
}

constexpr std::string_view kByBlender = "convert it by Blender to GLB",
                           kByImporter =
                               "halflit-import-cad, of the package halflit-cad, reads it: it is neither beside this program nor in PATH",
                           kByCad = "export it from a CAD program (FreeCAD, CadQuery) as STEP, STL or 3MF",
                           kByItsCad = "export it from its program as STEP, STL, 3MF or GLB",
                           kByCloud = "convert it by CloudCompare or PDAL to PLY",
                           kBySplat = "convert it by SuperSplat or splat-transform to PLY", kByAssimp = "convert it by assimp to GLB",
                           kByParaView = "export it from ParaView as GLB or PLY", kByMeshio = "convert it by meshio to STL or PLY",
                           kDamaged = "it may be damaged, or cut off", kUnpack = "unpack it", kNoShape = "it holds no shape",
                           kSliced = "draw the model that it was sliced from";
constexpr ForeignFormat kForeign[] = {
    {"FBX", "fbx", "Kaydara FBX Binary", kByBlender},
    {"FBX (text)", "", "; FBX ", kByBlender},
    {"Blender", "blend", "BLENDER", "export it from Blender as GLB"},
    {"a compressed Blender file", "blend", "\x28\xB5\x2F\xFD", "decompress it; export Blender files as GLB"},
    {"USD", "usd usdc", "PXR-USDC", kByBlender},
    {"USD (text)", "usda", "#usda", kByBlender},
    {"IFC", "ifc", "ISO-10303-21", "convert it by IfcConvert (IfcOpenShell) to GLB", "IFC"},
    {"STEP", "step stp p21", "ISO-10303-21", kByImporter, "", 0, nullptr, read_cad},
    {"IGES", "iges igs", "S", kByImporter, "", 72, is_iges, read_cad},
    {"DXF", "dxf", "AutoCAD Binary DXF", kByCad},
    {"DXF", "dxf", "", kByCad, "SECTION", 0,
     [](std::span<const std::byte> bytes) {
         Words words(begin_of(bytes));
         return words.next() == "0" && words.next() == "SECTION";
     }},
    {"DWG", "dwg", "AC10", kByCad},
    {"JT", "jt", "Version ", kByCad, "DM "},
    {"BREP", "brep brp", "DBRep_DrawableShape", kByImporter, "", 0, nullptr, read_cad},
    {"BREP", "brep brp", "CASCADE Topology", kByImporter, "", 0, nullptr, read_cad},
    {"BREP", "brep brp", "Open CASCADE Topology", kByImporter, "", 0, nullptr, read_cad},
    {"Parasolid", "x_t x_b", "**ABCDEF", kByItsCad},
    {"ACIS", "sat sab", "", kByItsCad},
    {"OpenSCAD", "scad csg", "", "export it by OpenSCAD (openscad -o part.stl part.scad)"},
    {"FreeCAD", "fcstd", "PK", kByItsCad, "Document.xml", 0, is_no_package},
    {"Rhino", "3dm", "3D Geometry File Format", kByItsCad},
    {"SketchUp", "skp", "\xFF\xFE\xFF\x0E", kByItsCad},
    {"SolidWorks", "sldprt sldasm", "", kByItsCad},
    {"Inventor", "ipt iam", "", kByItsCad},
    {"Cinema 4D", "c4d", "", kByItsCad},
    {"3ds Max", "max", "", kByItsCad},
    {"Maya", "ma", "//Maya ASCII", kByItsCad},
    {"Maya", "mb", "", kByItsCad},
    {"LAS or LAZ", "las laz", "LASF", kByCloud},
    {"E57", "e57", "ASTM-E57", kByCloud},
    {"PCD", "pcd", "# .PCD", kByCloud},
    {"points as text", "xyz pts asc", "", kByCloud},
    {"3D Gaussians as KSPLAT", "ksplat", "", kBySplat},
    {"3D Gaussians as SPLAT", "splat", "", kDamaged, "", 0, nullptr, read_splat_file},
    {"a gzip file", "gz tgz", "\x1F\x8B", kUnpack, "", 0, nullptr, read_spz_file},
    {"3D Gaussians as SPZ", "spz", "\x1F\x8B", kDamaged, "", 0, nullptr, read_spz_file},
    {"3D Gaussians as SPZ", "spz", "NGSP", kDamaged, "", 0, nullptr, read_spz_file},
    {"3D Gaussians as SOG", "sog", "PK", kBySplat, "", 0, holds_sog, read_sog_file},
    {"VTK", "vtk", "# vtk DataFile", kByParaView},
    {"VTK", "vtu vtp vti vts vtr vtm", "<", kByParaView, "<VTKFile"},
    {"Gmsh", "msh", "$MeshFormat", kByMeshio},
    {"VRML", "wrl vrml", "#VRML", kByBlender},
    {"Alembic", "abc", "Ogawa", kByBlender},
    {"3DS", "3ds", "MM", kByBlender, "", 0,
     [](std::span<const std::byte> bytes) { return bytes.size() >= 6 && u32_at(bytes, 2) == bytes.size(); }},
    {"LightWave", "lwo lws", "FORM", kByBlender},
    {"DirectX", "x", "xof ", kByAssimp},
    {"AC3D", "ac", "AC3D", kByAssimp},
    {"Quake MD2", "md2", "IDP2", kByAssimp},
    {"Quake MD3", "md3", "IDP3", kByAssimp},
    {"MikuMikuDance", "pmx", "PMX ", kByBlender},
    {"MagicaVoxel", "vox", "VOX ", "export it from MagicaVoxel as OBJ"},
    {"3D Tiles", "b3dm i3dm", "b3dm", "take the GLB that it holds, by 3d-tiles-tools"},
    {"Draco", "drc", "DRACO", "convert it by draco_decoder to OBJ or PLY"},
    {"binary G-code", "bgcode", "GCDE", kSliced},
    {"G-code", "gcode gco g", ";", kSliced, "generated by", 0, nullptr, read_gcode_picture},
    {"a RAR file", "rar", "Rar!", kUnpack},
    {"a 7z file", "7z", "7z\xBC\xAF", kUnpack},
    {"a PNG picture", "png", "\x89PNG", kNoShape},
    {"a JPEG picture", "jpg jpeg", "\xFF\xD8\xFF", kNoShape},
    {"a PDF document", "pdf", "%PDF", "it holds no shape that is read"},
    {"COLLADA", "dae", "<", kByBlender, "<COLLADA"},
    {"AMF", "amf", "<", "convert it by a slicer to 3MF", "<amf"},
    {"X3D", "x3d", "<", kByBlender, "<X3D"},
    {"URDF", "urdf", "<", "draw the meshes that it names", "<robot"},  // some have an element <mujoco>
    {"a model of MuJoCo", "mjcf", "<", "load it in MuJoCo and draw its scenes with halflit.compat.mujoco", "<mujoco"},
    {"USDZ", "usdz", "PK", kByBlender, "", 0, begins_with_usd},
};

bool has_extension(std::string_view name, const ForeignFormat& row) {
    const std::size_t point = name.rfind('.');
    if (point == std::string_view::npos) return false;
    Words words(row.extensions);
    for (std::string_view one = words.next(); !one.empty(); one = words.next())
        if (same_word(name.substr(point + 1), one)) return true;
    return false;
}

}  // namespace

const ForeignFormat* find_foreign_format(const ModelFile& file) {
    if (fits_binary_stl(file.bytes)) return nullptr;  // whose title is free
    const std::string_view text = begin_of(file.bytes);
    const std::size_t first = text.find_first_not_of("\r\n");  // BREP files begin with a line break
    const ForeignFormat* found = nullptr;
    for (const ForeignFormat& row : kForeign) {
        const std::size_t offset = row.offset > 0 ? row.offset : first;
        const bool is_like = text.size() > offset && text.substr(offset).starts_with(row.begins) &&
                             text.find(row.holds) != std::string_view::npos && (row.is_it == nullptr || row.is_it(file.bytes));
        if (!is_like || (row.begins.empty() && row.holds.empty())) continue;
        if (has_extension(file.name, row)) return &row;
        if (found == nullptr) found = &row;
    }
    return found;
}

const ForeignFormat* find_foreign_name(std::string_view name) {
    const auto found =
        std::find_if(std::begin(kForeign), std::end(kForeign), [&](const ForeignFormat& row) { return has_extension(name, row); });
    return found == std::end(kForeign) ? nullptr : found;
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
        if (words.empty() || words[0] == '#' || words.starts_with("//")) continue;
        if (lines.empty()) first = at;
        if (at > first + kMostBytes) break;
        lines.push_back(words.substr(0, kMostBytes));
        if (!is_text) break;
    }
}

bool is_model_name(std::string_view name) {
    return std::any_of(std::begin(kFormats), std::end(kFormats),
                       [&](const FormatRow& row) { return ends_with_word(name, row.extension); }) ||
           std::any_of(std::begin(kForeign), std::end(kForeign),
                       [&](const ForeignFormat& row) { return row.is_drawn() && has_extension(name, row); });
}

std::string list_of_formats(std::string_view FormatRow::*column) {
    std::vector<std::string> words(std::size(kFormats));
    for (const FormatRow& row : kFormats) words[static_cast<std::size_t>(row.format)] = row.*column;
    const bool is_name = column == &FormatRow::name;
    for (const ForeignFormat& row : kForeign) {
        std::string word = fmt::format("{}{}", is_name ? "" : ".", row.extensions.substr(0, row.extensions.find(' ')));
        if (is_name)
            for (char& letter : word) letter = static_cast<char>(letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter);
        if (row.is_drawn() && word != words.back()) words.push_back(word);
    }
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
