#include "apps/lab/plot_scale.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr int kWantedTicks = 5;
constexpr double kFarBelow = -10.0;  ///< position of values without a logarithm, in axis lengths; a line to there is clipped at the edge

/// The step 1, 2 or 5 times a power of ten that gives about the wanted number.
double tick_step(double span) {
    const double rough = span / kWantedTicks, power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (rough <= factor * power * 1.0001) return factor * power;
    return 10.0 * power;
}

/// A number with a typographic minus and without negative zero.
std::string tick_text(double value) {
    std::string text = fmt::format("{:.6g}", value == 0.0 ? 0.0 : value);
    if (text.starts_with('-')) text.replace(0, 1, "\u2212");
    return text;
}

std::string power_of_ten(int exponent) {
    if (exponent >= -2 && exponent <= 3) return tick_text(std::pow(10.0, exponent));
    return fmt::format("10<tspan dy=\"-4\" font-size=\"8\">{}</tspan>", tick_text(exponent));
}

}  // namespace

PlotScale::PlotScale(const PlotAxis& axis, const std::vector<double>& values)
    : min_(axis.min), max_(axis.max), step_(axis.step), log_(axis.log) {
    if (min_ == max_) {
        std::vector<double> usable;
        std::copy_if(values.begin(), values.end(), std::back_inserter(usable),
                     [&](double v) { return std::isfinite(v) && (!log_ || v > 0); });
        if (!usable.empty()) {
            min_ = *std::min_element(usable.begin(), usable.end());
            max_ = *std::max_element(usable.begin(), usable.end());
        } else {
            min_ = log_ ? 1 : 0;
            max_ = min_;
        }
        if (log_) {
            min_ = std::pow(10.0, std::floor(std::log10(min_)));
            max_ = std::pow(10.0, std::ceil(std::log10(max_)));
            if (min_ == max_) max_ *= 10;
        } else {
            if (min_ == max_) max_ = min_ + 1;
            const double step = step_ > 0 ? step_ : tick_step(max_ - min_);
            min_ = std::floor(min_ / step) * step;
            max_ = std::ceil(max_ / step) * step;
        }
    }
    if (log_) {
        min_ = std::log10(min_);
        max_ = std::log10(max_);
    }
}

double PlotScale::place(double value) const {
    if (log_ && value <= 0) return kFarBelow;
    return ((log_ ? std::log10(value) : value) - min_) / (max_ - min_);
}

std::vector<PlotTick> PlotScale::ticks() const {
    if (log_) return log_ticks();
    std::vector<PlotTick> ticks;
    const double step = step_ > 0 ? step_ : tick_step(max_ - min_);
    const auto first = static_cast<int>(std::ceil(min_ / step - 1e-6)), last = static_cast<int>(std::floor(max_ / step + 1e-6));
    for (int i = first; i <= last; ++i) ticks.push_back({i * step, tick_text(i * step)});
    return ticks;
}

std::vector<PlotTick> PlotScale::log_ticks() const {
    std::vector<PlotTick> ticks;
    const int first = static_cast<int>(std::floor(min_)), last = static_cast<int>(std::floor(max_ + 1e-6));
    const bool short_axis = max_ - min_ < 1.5;  // also label 2 and 5: decades alone would be too few
    const int every = std::max(1, (last - first + kWantedTicks) / (kWantedTicks + 2));
    for (int exponent = first; exponent <= last; ++exponent)
        for (int digit = 1; digit <= 9; ++digit) {
            const double value = digit * std::pow(10.0, exponent), at = std::log10(value);
            if (at < min_ - 1e-6 || at > max_ + 1e-6) continue;
            if (digit == 1)
                ticks.push_back({value, (exponent - first) % every == 0 ? power_of_ten(exponent) : ""});
            else if (every == 1)
                ticks.push_back({value, short_axis && (digit == 2 || digit == 5) ? tick_text(value) : ""});
        }
    return ticks;
}

}  // namespace halflit::cli
