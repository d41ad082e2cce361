// Data that slicers write into a 3MF file beside the model: filaments, volumes that are not printed, plates, and painted facets.
#pragma once

#include "apps/io/files/double_box.hpp"
#include "apps/io/models/three_mf_model.hpp"
#include "apps/io/models/three_mf_package.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail {

struct SlicerProject {
    /// A part of an object: a component (Bambu Studio, OrcaSlicer), or a run of its triangles (PrusaSlicer).
    struct Volume {
        bool is_drawn = true;  ///< false: a modifier, a negative volume, a blocker or an enforcer of supports
        int filament = 0;      ///< 1 is the first; 0: that of the object
    };
    struct Run {
        std::uint32_t first = 0, last = 0;  ///< triangles
        Volume volume;
    };
    struct Placed {
        std::uint32_t object = 0, instance = 0;
    };

    std::vector<Vec4f> filaments;                                     ///< colours, linear; empty: the file names none
    std::map<std::uint32_t, int> objects;                             ///< filament of an object; 0: the first one
    std::map<std::pair<std::uint32_t, std::uint32_t>, Volume> parts;  ///< by object and component
    std::map<std::uint32_t, std::vector<Run>> runs;
    std::map<int, std::vector<Placed>> plates;  ///< by number, from 1

    [[nodiscard]] Volume volume_of(std::uint32_t object, std::uint32_t part) const;
    /// The colour of a filament, from 1 on: the file's, or one of five of a printer's.
    [[nodiscard]] Vec4f color_of(int filament) const;
    /// The filament of a volume of an object.
    [[nodiscard]] int filament_of(std::uint32_t object, const Volume& volume) const;
};

/// Reads the project of a package, if it holds one. Damaged files of it are left out, with a warning.
[[nodiscard]] SlicerProject read_slicer_project(ThreeMfPackage& package, Document& document);

/// Plates of objects, by number from 1, where a project does not name them: slicers lay plates side by side, a fifth of their width between
/// them. The objects, in millimetres, belong to several if each stands in a cell of such a grid, of the largest usual printer that this
/// holds for; rows count from the top, columns from the left. Otherwise all are on plate 1.
[[nodiscard]] std::vector<int> plates_by_place(std::span<const DoubleBox> objects);

/// A triangle of a painted facet, and the filament that paints it; 0: none.
struct PaintedTriangle {
    std::array<std::uint32_t, 3> vertex{};
    int filament = 0;
};

/// Divides a facet as its paint says ("paint_color", "mmu_segmentation": a tree in hexadecimal digits, the last one first; each division
/// halves one, two or three sides). New vertices go behind `vertices`. What is cut off or deeper than 24 divisions is not painted.
/// Appends to `out`.
void divide_painted(const std::array<std::uint32_t, 3>& facet, std::string_view paint, std::vector<Vec3d>& vertices,
                    std::vector<PaintedTriangle>& out);

}  // namespace halflit::io::detail
