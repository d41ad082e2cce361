// Words that begin a statement of OBJ.
#pragma once

#include "apps/io/files/text.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace halflit::io::detail {

enum class ObjStatement : std::uint8_t {
    position,
    uv,
    normal,
    face,
    lines,
    points,
    object,
    smoothing,
    material,
    library,
    of_mtl,
    free_form,
    passed_over  ///< it does not change the picture
};

struct ObjWord {
    std::string_view word;
    ObjStatement statement;
    int score;         ///< of a line that begins with it, by which a text is known for OBJ
    bool with_number;  ///< if a number follows
};

/// The common ones first.
inline constexpr ObjWord kObjWords[] = {
    {"v", ObjStatement::position, 2, true},
    {"f", ObjStatement::face, 2, true},
    {"vt", ObjStatement::uv, 2, true},
    {"vn", ObjStatement::normal, 2, true},
    {"fo", ObjStatement::face, 2, true},
    {"l", ObjStatement::lines, 2, true},
    {"p", ObjStatement::points, 2, true},
    {"o", ObjStatement::object, 1, false},
    {"s", ObjStatement::smoothing, 1, false},
    {"usemtl", ObjStatement::material, 1, false},
    {"mtllib", ObjStatement::library, 1, false},
    {"newmtl", ObjStatement::of_mtl, 1, false},
    {"surf", ObjStatement::free_form, 1, false},
    {"curv", ObjStatement::free_form, 1, false},
    {"curv2", ObjStatement::free_form, 1, false},
    {"g", ObjStatement::passed_over, 1, false},
    {"vp", ObjStatement::passed_over, 2, true},
    {"mg", ObjStatement::passed_over, 1, false},
    {"lod", ObjStatement::passed_over, 1, false},
    {"cstype", ObjStatement::passed_over, 1, false},
    {"deg", ObjStatement::passed_over, 1, false},
    {"bevel", ObjStatement::passed_over, 1, false},
    {"parm", ObjStatement::passed_over, 1, false},
    {"c_interp", ObjStatement::passed_over, 1, false},
    {"d_interp", ObjStatement::passed_over, 1, false},
    {"shadow_obj", ObjStatement::passed_over, 1, false},
    {"maplib", ObjStatement::passed_over, 1, false},
    {"usemap", ObjStatement::passed_over, 1, false},
    {"call", ObjStatement::passed_over, 1, false},
    {"bmat", ObjStatement::passed_over, 0, false},
    {"step", ObjStatement::passed_over, 0, false},
    {"trim", ObjStatement::passed_over, 0, false},
    {"hole", ObjStatement::passed_over, 0, false},
    {"scrv", ObjStatement::passed_over, 0, false},
    {"sp", ObjStatement::passed_over, 0, false},
    {"end", ObjStatement::passed_over, 0, false},
    {"con", ObjStatement::passed_over, 0, false},
    {"ctech", ObjStatement::passed_over, 0, false},
    {"stech", ObjStatement::passed_over, 0, false},
    {"trace_obj", ObjStatement::passed_over, 0, false},
    {"csh", ObjStatement::passed_over, 0, false},
};

/// Null: OBJ has no such word, in any case.
[[nodiscard]] inline const ObjWord* find_obj_word(std::string_view word) {
    const auto* const found =
        std::find_if(std::begin(kObjWords), std::end(kObjWords), [&](const ObjWord& row) { return same_word(word, row.word); });
    return found == std::end(kObjWords) ? nullptr : found;
}

}  // namespace halflit::io::detail
