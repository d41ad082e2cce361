// A figure: rows of pictures and of plots under one caption, and the files made from it.
#pragma once

#include "apps/lab/svg_plot.hpp"
#include "halflit/error.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace halflit::cli {

/// Pictures of one size in rows and columns.
struct PictureGrid {
    std::string title{};
    std::vector<std::string> columns;  ///< labels above
    std::vector<std::string> rows;     ///< labels on the left; one or more, may be empty text
    double width = 150;                ///< width of one picture on the page; its height follows
    std::vector<Image> pictures{};     ///< row by row
};

using PlotRow = std::vector<Plot>;

struct Figure {
    std::string caption;  ///< says what was computed: model, parameters, light; may have the marks of rich_text.hpp
    std::vector<std::variant<PictureGrid, PlotRow>> parts;
};

/// A figure's name, title and source, and the function that makes it.
struct FigureEntry {
    const char* name;  ///< name on the command line and of the files
    const char* title;
    const char* source;  ///< the figure that it remakes; the page lists what the keys name
    Result<Figure> (*make)();
};

/// All figures, in the order of their sources.
[[nodiscard]] std::span<const FigureEntry> all_figures();

enum class FigureFormat : std::uint8_t {
    svg,  ///< one page with pictures, plots and caption
    png   ///< the pictures without text, as one sheet; plots stay SVG
};

struct FigureFile {
    std::string name;
    std::vector<std::uint8_t> bytes;
};

/// NAME.svg or NAME.png, and for a figure with plots NAME.csv with their numbers. As PNG, a figure with both pictures and plots also has
/// NAME.svg, with the plots.
[[nodiscard]] Result<std::vector<FigureFile>> figure_files(const FigureEntry& entry, const Figure& figure, FigureFormat format);

/// A figure whose files have been written.
struct MadeFigure {
    const FigureEntry* entry;
    std::string caption;
    std::vector<std::string> files;  ///< names
};
/// The text of index.html: every figure with its caption.
[[nodiscard]] std::string figure_index(std::span<const MadeFigure> figures);

}  // namespace halflit::cli
