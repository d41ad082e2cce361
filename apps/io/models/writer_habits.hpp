// Habits of the programs that write models: values that a format permits, and that stand for "no colour" where a whole model has no other.
// A new one is a row.
#pragma once

#include "halflit/model.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace halflit::io::detail {

struct WriterHabit {
    ModelFormat format;
    std::uint32_t value;       ///< STL: attribute of all triangles; others: colour of all vertices or faces, 0xRRGGBB
    std::string_view writers;  ///< who writes it
};

inline constexpr WriterHabit kNoColors[] = {
    {ModelFormat::stl, 0x0000, "MeshLab and VCGlib, behind a header with COLOR="},
    {ModelFormat::stl, 0xffff, "Autodesk Meshmixer"},
    {ModelFormat::stl, 0x8000, "writers that mark each facet as coloured"},
    {ModelFormat::ply, 0x000000, "Open3D, PCL and others, whose colours were never set"},
    {ModelFormat::obj, 0x000000, "writers of vertex colours that were never set"},
    {ModelFormat::off, 0x000000, "writers of vertex colours that were never set"},
};
/// Colour of a whole STL file that is a program's default: MeshLab writes "COLOR=\x7f\x7f\x7f\xff MATERIAL=" into each header.
inline constexpr std::uint32_t kDefaultStlHeader = 0x7f7f7f;

/// Whether `is` holds for a value by which writers of the format mean no colour.
template <class Is>
[[nodiscard]] constexpr bool means_no_color(ModelFormat format, const Is& is) {
    return std::any_of(std::begin(kNoColors), std::end(kNoColors),
                       [&](const WriterHabit& row) { return row.format == format && is(row.value); });
}

}  // namespace halflit::io::detail
