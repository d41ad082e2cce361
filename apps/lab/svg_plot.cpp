#include "apps/lab/svg_plot.hpp"

#include "apps/lab/plot_scale.hpp"
#include "apps/lab/rich_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace halflit::cli {
namespace {

constexpr const char* kAxisColor = "#444";
constexpr const char* kGridColor = "#e4e4e4";

/// Okabe and Ito's colours, which people with any common colour vision can tell apart.
constexpr std::array<const char*, 7> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555"};

std::string line_element(double x0, double y0, double x1, double y1, const char* color, const char* more = "") {
    return fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\"{}/>\n", x0, y0, x1, y1, color, more);
}

std::string color_of(const Plot& plot, std::size_t i) {
    return plot.series[i].color.empty() ? kPalette[i % kPalette.size()] : xml_escaped(plot.series[i].color);
}

bool has_line(const PlotSeries& series) { return series.mark != PlotSeries::Mark::dots; }
bool has_dots(const PlotSeries& series) { return series.mark != PlotSeries::Mark::line; }

std::string stroke(const PlotSeries& series, std::string_view color) {
    const std::string dash = series.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", xml_escaped(series.dash));
    return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" stroke-linejoin=\"round\"{}", color, series.line_width, dash);
}

std::vector<double> coordinates(const Plot& plot, double Vec2<double>::*which) {
    std::vector<double> values;
    for (const PlotSeries& series : plot.series)
        for (const Vec2<double>& point : series.points) values.push_back(point.*which);
    return values;
}

/// Draws one plot with its upper left corner at the origin.
class PlotWriter {
public:
    explicit PlotWriter(const Plot& plot)
        : plot_(plot), x_(plot.x, coordinates(plot, &Vec2<double>::x)), y_(plot.y, coordinates(plot, &Vec2<double>::y)) {
        top_ = plot.title.empty() ? 12 : 32;
        bottom_ = plot.height - (plot.x.label.empty() ? 26 : 44);
        left_ = plot.y.label.empty() ? 42 : 60;
        right_ = plot.width - 14;
    }

    std::string write() {
        if (!plot_.title.empty())
            out_ += text_element((left_ + right_) / 2, 18, rich_svg(plot_.title, 13), {.size = 13, .anchor = "middle", .bold = true});
        add_axes();
        // A nested svg element clips at the axes without needing an id.
        out_ += fmt::format("<svg x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" overflow=\"hidden\">\n", left_, top_,
                            width(), height());
        for (const PlotMark& mark : plot_.marks) add_mark(mark);
        for (std::size_t i = 0; i < plot_.series.size(); ++i) add_series(i);
        out_ += "</svg>\n";
        out_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"none\" stroke=\"{}\"/>\n", left_,
                            top_, width(), height(), kAxisColor);
        if (plot_.legend != LegendPlace::none) add_legend();
        return out_;
    }

private:
    [[nodiscard]] double width() const { return right_ - left_; }
    [[nodiscard]] double height() const { return bottom_ - top_; }

    void add_axes() {
        for (const PlotTick& tick : x_.ticks()) {
            const double x = left_ + x_.place(tick.value) * width();
            if (!tick.label.empty()) {
                out_ += line_element(x, top_, x, bottom_, kGridColor);
                out_ += text_element(x, bottom_ + 15, tick.label, {.size = 11, .anchor = "middle"});
            }
            out_ += line_element(x, bottom_, x, bottom_ - (tick.label.empty() ? 3 : 5), kAxisColor);
        }
        for (const PlotTick& tick : y_.ticks()) {
            const double y = bottom_ - y_.place(tick.value) * height();
            if (!tick.label.empty()) {
                out_ += line_element(left_, y, right_, y, kGridColor);
                out_ += text_element(left_ - 6, y + 4, tick.label, {.size = 11, .anchor = "end"});
            }
            out_ += line_element(left_, y, left_ + (tick.label.empty() ? 3 : 5), y, kAxisColor);
        }
        out_ += text_element((left_ + right_) / 2, plot_.height - 8, rich_svg(plot_.x.label, 12), {.anchor = "middle"});
        if (!plot_.y.label.empty())
            out_ += text_element(14, (top_ + bottom_) / 2, rich_svg(plot_.y.label, 12), {.anchor = "middle", .turn_deg = -90});
    }

    void add_mark(const PlotMark& mark) {
        const double x = x_.place(mark.x) * width();
        out_ += line_element(x, 0, x, height(), "#777", " stroke-dasharray=\"3 3\"");
        out_ += text_element(x + 4, 13, rich_svg(mark.label, 10), {.size = 10, .color = "#555"});
    }

    /// Position of a point in pixels. Far values are clamped, so that coordinates stay small.
    [[nodiscard]] Vec2<double> on_page(Vec2<double> point) const {
        const double x = x_.place(point.x), y = y_.place(point.y);
        if (!std::isfinite(x) || !std::isfinite(y)) return {NAN, NAN};
        return {std::clamp(x, -10.0, 11.0) * width(), (1 - std::clamp(y, -10.0, 11.0)) * height()};
    }

    void add_series(std::size_t i) {
        const PlotSeries& series = plot_.series[i];
        const std::string color = color_of(plot_, i);
        std::string path, dots;
        bool pen_down = false;
        for (std::size_t k = 0; k < series.points.size(); ++k) {
            const Vec2<double> at = on_page(series.points[k]);
            if (std::isnan(at.x)) {
                pen_down = false;
                continue;
            }
            path += fmt::format("{}{:.2f} {:.2f}", pen_down ? " L" : path.empty() ? "M" : " M", at.x, at.y);
            pen_down = true;
            dots += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3.2\" fill=\"{}\"/>\n", at.x, at.y, color);
            if (k < series.labels.size()) add_label(at, series.labels[k]);
        }
        if (has_line(series) && !path.empty()) out_ += fmt::format("<path d=\"{}\" {}/>\n", path, stroke(series, color));
        if (has_dots(series)) out_ += dots;
    }

    /// Adds a label beside its point, on the right if there is room.
    void add_label(Vec2<double> at, const std::string& label) {
        const bool right = at.x + 6 + text_width(label, 10) < width();
        out_ += text_element(at.x + (right ? 6 : -6), at.y - 5, xml_escaped(label), {.size = 10, .anchor = right ? "start" : "end"});
    }

    void add_legend() {
        constexpr double kLine = 16, kSample = 24, kPad = 7;
        double widest = 0;
        int rows = 0;
        for (const PlotSeries& series : plot_.series) {
            if (series.name.empty()) continue;
            widest = std::max(widest, text_width(series.name, 11));
            ++rows;
        }
        if (rows == 0) return;
        const bool at_right = plot_.legend == LegendPlace::top_right || plot_.legend == LegendPlace::bottom_right;
        const bool at_top = plot_.legend == LegendPlace::top_left || plot_.legend == LegendPlace::top_right;
        const double w = kSample + 3 * kPad + widest, h = kLine * rows + kPad;
        const double x = at_right ? right_ - w - 8 : left_ + 8, y = at_top ? top_ + 8 : bottom_ - h - 8;
        out_ += fmt::format(
            "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"white\" fill-opacity=\"0.85\" stroke=\"#bbb\"/>\n",
            x, y, w, h);
        double line = y + kPad / 2 + kLine / 2;
        for (std::size_t i = 0; i < plot_.series.size(); ++i) {
            const PlotSeries& series = plot_.series[i];
            if (series.name.empty()) continue;
            const std::string color = color_of(plot_, i);
            const double start = x + kPad;
            if (has_line(series))
                out_ += fmt::format("<path d=\"M{:.2f} {:.2f} h{:g}\" {}/>\n", start, line, kSample, stroke(series, color));
            if (has_dots(series))
                out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3.2\" fill=\"{}\"/>\n", start + kSample / 2, line, color);
            out_ += text_element(start + kSample + kPad, line + 4, rich_svg(series.name, 11), {.size = 11});
            line += kLine;
        }
    }

    const Plot& plot_;
    PlotScale x_, y_;
    double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
    std::string out_;
};

/// A field of a CSV line, quoted if necessary.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

}  // namespace

void add_plot(SvgPage& page, double x, double y, const Plot& plot) {
    page.svg(fmt::format("<g transform=\"translate({:.2f} {:.2f})\">\n{}</g>\n", x, y, PlotWriter(plot).write()));
}

std::string plot_svg(const Plot& plot) {
    SvgPage page;
    add_plot(page, 0, 0, plot);
    return page.finish(plot.width, plot.height, plot.title);
}

std::string plots_csv(std::span<const Plot> plots) {
    std::string text = "plot,series,x,y\n";
    for (const Plot& plot : plots)
        for (const PlotSeries& series : plot.series)
            for (const Vec2<double>& point : series.points)
                text += fmt::format("{},{},{:.10g},{:.10g}\n", csv_field(rich_plain(plot.title)), csv_field(rich_plain(series.name)),
                                    point.x, point.y);
    return text;
}

}  // namespace halflit::cli
