// From values to places along an axis, and the ticks between.
#pragma once

#include "apps/halflit/svg_plot.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

struct PlotTick {
    double value = 0;
    std::string label;  ///< as SVG content; empty: a small tick without a number
};

/// An axis whose limits are known.
class PlotScale {
public:
    /// `values` are the data's, for limits that the axis leaves open.
    PlotScale(const PlotAxis& axis, const std::vector<double>& values);

    /// 0 at the lower limit, 1 at the upper one; not finite where the value is not. On a logarithmic axis what has no logarithm is far
    /// below.
    [[nodiscard]] double place(double value) const;
    [[nodiscard]] std::vector<PlotTick> ticks() const;

private:
    [[nodiscard]] std::vector<PlotTick> log_ticks() const;

    double min_ = 0, max_ = 1;
    double step_ = 0;
    bool log_ = false;
};

}  // namespace halflit::cli
