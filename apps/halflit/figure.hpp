// A figure: rows of pictures and of plots under one caption, and the files that it becomes.
#pragma once

#include "apps/halflit/svg_plot.hpp"
#include "raster/framebuffer.hpp"
#include "shading/result.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace halflit::cli {

/// Pictures of one size in rows and columns.
struct PictureGrid {
    std::string title{};
    std::vector<std::string> columns;       ///< labels above
    std::vector<std::string> rows;          ///< labels on the left; one or more, may be empty text
    double width = 150;                     ///< of one picture on the page; its height follows
    std::vector<raster::Image> pictures{};  ///< row by row
};

using PlotRow = std::vector<Plot>;

struct Figure {
    std::string caption;  ///< what was computed: model, parameters, light
    std::vector<std::variant<PictureGrid, PlotRow>> parts;
};

/// What is known of a figure before it is made.
struct FigureEntry {
    const char* name;  ///< as users type it, and the file's name
    const char* title;
    const char* source;  ///< the figure that it remakes; keys resolve in sh/README.md
    Result<Figure> (*make)();
};

/// All of them, in the order of the sources.
[[nodiscard]] std::span<const FigureEntry> all_figures();

enum class FigureFormat : std::uint8_t {
    svg,  ///< one page with pictures, plots and caption
    png   ///< the pictures without text, as one sheet; plots stay SVG
};

struct FigureFile {
    std::string name;
    std::vector<std::uint8_t> bytes;
};

/// NAME.svg or NAME.png, and where there are plots NAME.csv with their numbers. In PNG form a figure with both pictures and plots also has
/// NAME.svg, with the plots.
[[nodiscard]] Result<std::vector<FigureFile>> figure_files(const FigureEntry& entry, const Figure& figure, FigureFormat format);

/// index.html: every figure with its caption. `files[i]` are those of `entries[i]`.
struct MadeFigure {
    const FigureEntry* entry;
    std::string caption;
    std::vector<std::string> files;
};
[[nodiscard]] std::string figure_index(std::span<const MadeFigure> figures);

}  // namespace halflit::cli
