// Scale of a plot's axis: maps values to positions, and chooses ticks.
#pragma once

#include "apps/lab/svg_plot.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

struct PlotTick {
    double value = 0;
    std::string label;  ///< SVG content; empty: a small tick without a number
};

/// An axis with known limits.
class PlotScale {
public:
    /// `values`: the data, which gives the limits that the axis leaves open.
    PlotScale(const PlotAxis& axis, const std::vector<double>& values);

    /// Position of a value: 0 at the lower limit, 1 at the upper one; not finite if the value is not. On a logarithmic axis, 0 and negative
    /// values are far below the lower limit.
    [[nodiscard]] double place(double value) const;
    [[nodiscard]] std::vector<PlotTick> ticks() const;

private:
    [[nodiscard]] std::vector<PlotTick> log_ticks() const;

    double min_ = 0, max_ = 1;
    double step_ = 0;
    bool log_ = false;
};

}  // namespace halflit::cli
