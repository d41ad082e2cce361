// Results of `halflit trade` as one HTML page: plots, table, pictures.
#include "apps/engine/pictures/html_page.hpp"
#include "apps/lab/svg_plot.hpp"
#include "apps/lab/trade_report.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr double kLeastShown = 1e-3;  ///< codes; the plot shows smaller errors as this value
constexpr double kPlotWidth = 900, kPlotHeight = 520;
constexpr double kLabelGap = 13;           ///< least vertical distance of two labels, pixels
constexpr std::size_t kMostPictures = 12;  ///< rows of the front that are shown

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>halflit: time and error of {0}</title>
<style>
body {{ max-width: 66rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff }}
svg {{ max-width: 100%; height: auto }}
table {{ border-collapse: collapse; font-size: 13px; margin: 1rem 0 }}
th, td {{ padding: .2rem .4rem; text-align: right; vertical-align: top; border-bottom: 1px solid #e4e4e4 }}
th {{ vertical-align: bottom; line-height: 1.25 }}
td {{ white-space: nowrap }}
table.all th:nth-child(-n+2), table.all td:nth-child(-n+2), table.offers :is(th, td):last-child {{ text-align: left; white-space: normal }}
table.all td:nth-child(2) {{ min-width: 14rem }}
table.all td:last-child {{ white-space: normal; min-width: 5rem }}
tr.front {{ background: #eef5fb }}
tr.front td:nth-child(2) {{ font-weight: 600 }}
tr.broken td {{ color: #b00020 }}
code {{ display: block; font: 12px/1.4 ui-monospace, monospace; color: #444; user-select: all; overflow-wrap: anywhere }}
.offers code {{ font-size: 13px }}
.pictures {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(18rem, 1fr)); gap: 1rem }}
figure {{ margin: 0 }}
figcaption {{ font-size: 13px; color: #444 }}
img {{ width: 100%; height: auto; border: 1px solid #ddd }}
</style>
</head>
<body>
<h1>Time and error of {0}</h1>
)";

double shown(double error) { return std::max(error, kLeastShown); }

/// Groups of rows, with their colours in the plot.
struct Kind {
    const char* name;
    const char* color;
    bool (*has)(const TradeRow&);
};
constexpr Kind kKinds[] = {{"settings", "#56b4e9", [](const TradeRow& r) { return !r.bound && r.choice.accuracy == Accuracy::exact; }},
                           {"budgets", "#cc79a7", [](const TradeRow& r) { return r.bound.has_value(); }}};

/// Plot of error against time for one lobe, without the reference, which takes far longer.
Plot plot_of(const std::vector<TradeRow>& rows, std::optional<std::size_t> lobe, const std::string& title) {
    Plot plot;
    plot.title = title;
    plot.legend = LegendPlace::bottom_left;  // no row takes little time and is exact, so this corner is empty
    plot.width = kPlotWidth;
    plot.height = kPlotHeight;
    plot.x.label = "time, exact = 1";
    plot.y = {.label = "error that 99.9 % of the pixels keep, 8-bit codes", .log = true};
    std::vector<const TradeRow*> here;
    double largest = 0, slowest = 1;
    for (const TradeRow* row : rows_by_time(rows))
        if (row->choice.lobe == lobe && row->choice.accuracy != Accuracy::reference) {
            here.push_back(row);
            largest = std::max(largest, shown(row->error.p999));
            slowest = std::max(slowest, row->ratio);
        }
    plot.x.max = std::ceil(slowest * 10.2) / 10;
    plot.y.min = kLeastShown / 1.5;  // leaves room for dots at kLeastShown
    plot.y.max = std::clamp(std::pow(10.0, std::ceil(std::log10(largest))), 1.0, 300.0);
    for (const Kind& kind : kKinds) {
        PlotSeries dots{.name = kind.name, .points = {}, .color = kind.color, .mark = PlotSeries::Mark::dots};
        for (const TradeRow* row : here)
            if (kind.has(*row)) dots.points.push_back({row->ratio, shown(row->error.p999)});
        plot.series.push_back(std::move(dots));
    }
    PlotSeries front{.name = "Pareto front", .points = {}, .color = "#222", .mark = PlotSeries::Mark::line_and_dots};
    const double pixels_a_decade = (kPlotHeight - 80) / std::log10(plot.y.max / plot.y.min);
    double last_labelled = INFINITY;  // the front falls, so a label can overlap only the one before it
    for (const TradeRow* row : here) {
        if (!row->front) continue;
        const double y = shown(row->error.p999), height = pixels_a_decade * std::log10(y);
        front.points.push_back({row->ratio, y});
        const bool room = last_labelled - height >= kLabelGap;
        front.labels.push_back(room ? fmt::format("{} {}", row->number, row->name) : "");
        if (room) last_labelled = height;
    }
    plot.series.push_back(std::move(front));
    return plot;
}

/// The flags as text that one click selects.
std::string flags_html(const TradeRow& row) { return row.flags.empty() ? "" : "<code>" + xml_escaped(row.flags) + "</code>"; }

std::string bound_text(const TradeRow& row) {
    if (!row.bound) return "";
    const char* state = !row.kept() ? ", violated" : row.bound->within ? "" : ", above the budget";
    return fmt::format("{:.3g}{}", row.bound->codes, state);
}

std::string table_row(const TradeRow& row) {
    return fmt::format(
        "<tr class=\"{}{}\"><td>{}</td><td>{}{}</td><td title=\"{:.2f} ms; {:.2f} to {:.2f}; CPU time {:.2f}\">{:.2f}</td>"
        "<td>{:.3g}</td><td>{:.3g}</td>"
        "<td>{:.3g}</td><td>{}</td><td>{:.3g} %</td><td>{}</td></tr>\n",
        row.front ? "front" : "", row.kept() ? "" : " broken", row.number > 0 ? fmt::format("{}", row.number) : "", xml_escaped(row.name),
        flags_html(row), row.ms, row.ratio_min, row.ratio_max, row.cpu_ratio, row.ratio, row.error.max, row.error.p999, row.error.mean,
        row.error.psnr ? fmt::format("{:.1f}", *row.error.psnr) : "", 100 * row.error.share_off, bound_text(row));
}

std::string table_of(const std::vector<TradeRow>& rows) {
    std::string html =
        "<table class=\"all\">\n<tr><th></th><th>settings, and flags to copy</th><th>time</th>"
        "<th>largest error</th><th>error of 99.9 %</th><th>mean error</th><th>PSNR, dB</th><th>pixels off by 1</th>"
        "<th>bound</th></tr>\n";
    for (const TradeRow* row : rows_by_time(rows)) html += table_row(*row);
    return html + "</table>\n";
}

/// The settings to use, by the error that is allowed.
std::string offers_of(const std::vector<TradeRow>& rows, const TradeSpace& space) {
    const std::vector<TradeOffer> offers = trade_offers(rows, space);
    if (offers.empty()) return "";
    std::string html = "<table class=\"offers\">\n<tr><th>error of 99.9 % at most</th><th>time</th><th>flags to copy</th></tr>\n";
    for (const TradeOffer& offer : offers)
        html += fmt::format("<tr><td>{:g}</td><td>{:.2f}</td><td>{}</td></tr>\n", offer.codes, offer.row->ratio, flags_html(*offer.row));
    return html + "</table>\n";
}

/// Gain of a difference picture: the largest power of two from 1 to 2^14 that keeps `error`, in codes, within 200.
double gain_for(double error) { return std::exp2(std::clamp(std::floor(std::log2(200 / std::max(error, 1e-9))), 0.0, 14.0)); }

Result<std::string> pictures_of(const TradeRow& row, TradeBench& bench) {
    const auto image = bench.draw(row.choice);
    if (!image) return tl::unexpected(image.error());
    const std::string number = row.number > 0 ? fmt::format("{} ", row.number) : "";
    auto html =
        embedded_figure(*image, fmt::format("{}{}: time {:.2f}, 99.9 % within {:.3g} codes", number, row.name, row.ratio, row.error.p999));
    if (!html) return html;
    const double gain = gain_for(row.error.p999);
    const auto difference = embedded_figure(bench.reference(row.choice.lobe).difference(*image, gain),
                                            fmt::format("{}{}: difference from the reference, times {:g}", number, row.name, gain));
    if (!difference) return difference;
    return *html + *difference;
}

/// Pictures of the references, of exact, of the front, and of the row with the largest error.
Result<std::string> all_pictures(const std::vector<TradeRow>& rows, TradeBench& bench) {
    std::string html = "<div class=\"pictures\">\n";
    std::vector<const TradeRow*> wanted{&exact_row(rows, bench.space())};
    const TradeRow* worst = wanted[0];
    std::size_t front = 0;
    for (const TradeRow* row : rows_by_time(rows)) {
        if (row->error.p999 > worst->error.p999) worst = row;
        if (row->front && row != wanted[0] && row->choice.accuracy != Accuracy::reference && front++ < kMostPictures) wanted.push_back(row);
    }
    if (std::find(wanted.begin(), wanted.end(), worst) == wanted.end()) wanted.push_back(worst);
    for (const TradeRow& row : rows) {
        if (row.choice.accuracy != Accuracy::reference) continue;
        const auto one = embedded_figure(bench.reference_picture(row.choice.lobe), fmt::format("{}: time {:.0f}", row.name, row.ratio));
        if (!one) return one;
        html += *one;
    }
    for (const TradeRow* row : wanted) {
        const auto one = pictures_of(*row, bench);
        if (!one) return one;
        html += *one;
    }
    return html + "</div>\n";
}

}  // namespace

Result<std::string> trade_page(const std::vector<TradeRow>& rows, TradeBench& bench) {
    const RenderJob& job = bench.job();
    const TradeRow& exact = exact_row(rows, bench.space());
    std::string html = fmt::format(kHead, xml_escaped(job.source.name));
    html += "<p><b>";
    for (const std::string& line : trade_verdict(rows, bench.space())) html += xml_escaped(line) + "<br>\n";
    html += "</b></p>\n";
    html += fmt::format(
        "<p>{}x{} pixels, {} samples per pixel; geometry covers {} pixels. Exact takes {:.2f} ms. Times are medians of {} frames, "
        "each drawn in turn with a frame of exact, and divided by its time; exact against itself gave {:.2f} to {:.2f}. An error is the "
        "difference from the float64 reference in a pixel's worst channel, in 8-bit sRGB codes before rounding. A bound is what a budget "
        "proves beforehand. Numbered rows are the Pareto front: settings that no other setting beats in both time and error.</p>\n",
        job.width, job.height, job.settings.samples, bench.reference(std::nullopt).pixels_drawn(), bench.exact_ms(), exact.frames,
        exact.ratio_min, exact.ratio_max);
    for (std::size_t i = 0; i <= bench.space().lobes.size(); ++i) {
        const auto lobe = i == 0 ? std::nullopt : std::optional(i - 1);
        const std::string title = lobe ? "Lobe " + bench.space().lobes[*lobe].name : "Error against time";
        html += plot_svg(plot_of(rows, lobe, title));
    }
    html += "<h2>Cheapest settings</h2>\n<p>Settings that were faster than exact in every pair of frames, by more than the noise.</p>\n" +
            offers_of(rows, bench.space());
    html += "<h2>All settings, by time</h2>\n" + table_of(rows) + "<h2>Pictures</h2>\n";
    const auto pictures = all_pictures(rows, bench);
    if (!pictures) return pictures;
    return html + *pictures + "</body>\n</html>\n";
}

}  // namespace halflit::cli
