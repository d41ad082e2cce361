#include "halflit/model.hpp"

#include "apps/io/detail/glb_container.hpp"
#include "apps/io/detail/little_endian.hpp"
#include "apps/io/detail/model_readers.hpp"
#include "apps/io/detail/model_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace halflit {

using namespace io::detail;

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
    if (count == 0 || count > 1u << 27) return false;
    for (std::size_t i = 0; i < 12; ++i) {  // the normal, then three corners
        const float value = std::bit_cast<float>(u32_at(bytes, kFirst + 4 * i)), size = value < 0 ? -value : value;
        if (!(size <= (i < 3 ? 1.5f : 1e9f)) || (size > 0 && size < 1e-12f)) return false;
    }
    return true;
}

}  // namespace

std::string_view model_format_name(ModelFormat format) {
    constexpr std::string_view kNames[] = {"glTF", "GLB", "STL", "PLY", "OBJ", "3MF"};
    return kNames[static_cast<std::size_t>(format)];
}

std::optional<ModelFormat> find_model_format(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (is_glb(bytes)) return ModelFormat::glb;
    if (text.starts_with("PK\3\4") || text.starts_with("PK\5\6")) return ModelFormat::three_mf;
    if (text.starts_with("ply") && text.size() > 3 && is_line_end(text[3])) return ModelFormat::ply;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    const std::string_view word = first_word(text);
    if (word.starts_with('{')) return ModelFormat::gltf;
    const bool says_solid = word.size() >= 5 && same_word(word.substr(0, 5), "solid");
    if (says_solid || fits_binary_stl(bytes)) return ModelFormat::stl;
    if (is_obj_statement(word)) return ModelFormat::obj;
    if (looks_like_binary_stl(bytes)) return ModelFormat::stl;
    return std::nullopt;
}

}  // namespace halflit
