// Plots as SVG: axes, curves, scattered points, legends. Dark on white; alone, on a page with others, or inline in HTML. Titles, names of
// series and labels of axes and marks may have superscripts and subscripts (rich_text.hpp).
#pragma once

#include "apps/lab/svg_page.hpp"
#include "halflit/math.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace halflit::cli {

struct PlotSeries {
    enum class Mark : std::uint8_t { line, dots, line_and_dots };

    std::string name;                  ///< name in the legend; empty: not listed
    std::vector<Vec2<double>> points;  ///< one that is not finite is a gap in the line; on a logarithmic axis 0 is below the edge
    std::string color{};               ///< an SVG colour; empty: chosen by the series' index from a palette for all colour vision
    Mark mark = Mark::line;
    std::string dash{};                 ///< lengths on and off, such as "6 3"; empty: solid
    std::vector<std::string> labels{};  ///< beside the points; none, or one per point
    double line_width = 1.8;
};

struct PlotAxis {
    std::string label{};
    double min = 0, max = 0;  ///< limits; if equal, taken from the data
    bool log = false;
    double step = 0;  ///< between ticks of a linear axis; 0: a round number is chosen
};

/// A dashed vertical line over the whole plot.
struct PlotMark {
    double x = 0;
    std::string label{};
};

enum class LegendPlace : std::uint8_t { none, top_left, top_right, bottom_left, bottom_right };

struct Plot {
    std::string title{};
    PlotAxis x{}, y{};
    std::vector<PlotSeries> series{};
    std::vector<PlotMark> marks{};
    LegendPlace legend = LegendPlace::top_right;
    double width = 430, height = 300;  ///< pixels, with labels
};

void add_plot(SvgPage& page, double x, double y, const Plot& plot);

/// A document with one plot.
[[nodiscard]] std::string plot_svg(const Plot& plot);

/// "plot,series,x,y" and a line for each point: the numbers that were drawn, 10 digits.
[[nodiscard]] std::string plots_csv(std::span<const Plot> plots);

}  // namespace halflit::cli
