#include "apps/lab/trade_report.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/plan_names.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace halflit::cli {
namespace {

constexpr std::array kAllowances{0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};  ///< errors in the summary, codes

std::string lobe_name(const TradeRow& row, const TradeSpace& space) { return row.choice.lobe ? space.lobes[*row.choice.lobe].name : "own"; }

/// The accuracy's name, or "budget".
std::string accuracy_of(const TradeRow& row) { return row.bound ? "budget" : std::string(accuracy_name(row.choice.accuracy)); }

/// Another picture, in less time by all of the interval, and by more than exact against itself varies.
bool surely_cheaper(const TradeRow& row, const TradeRow& exact) { return !row.same && row.ratio_max < 1 && row.ratio < exact.ratio_min; }

Json row_json(const TradeRow& row, const TradeSpace& space) {
    const TradeChoice& choice = row.choice;
    Json json{{"name", row.name},
              {"flags", row.flags},
              {"lobe", lobe_name(row, space)},
              {"accuracy", accuracy_of(row)},
              {"max_error", choice.max_error_codes > 0 ? Json(choice.max_error_codes) : Json(nullptr)},
              {"order", choice.order > 0 ? Json(choice.order) : Json("auto")},
              {"orders_used", row.orders},
              {"rate", rate_name(choice.rate)},
              {"texture_filter", texture_detail_name(choice.texture)},
              {"shadows", shadow_mode_name(choice.shadows)},
              {"shadow_size", choice.shadow_size},
              {"samples", choice.samples},
              {"anisotropy", choice.anisotropy},
              {"lobes_computed_as", row.lobe_paths},
              {"specular_power", row.specular_tier.empty() ? Json(nullptr) : Json(row.specular_tier)},
              {"frames", row.frames},
              {"ms", row.ms},
              {"ratio", row.ratio},
              {"ratio_range", {row.ratio_min, row.ratio_max}},
              {"wall_ratio", row.wall_ratio},
              {"changes_nothing", row.same},
              {"error",
               {{"max", row.error.max},
                {"mean", row.error.mean},
                {"p999", row.error.p999},
                {"psnr", row.error.psnr ? Json(*row.error.psnr) : Json(nullptr)},
                {"share_off_by_one", row.error.share_off}}}};
    json["bound"] = nullptr;
    if (row.bound) {
        json["bound"] = error_bound_json(*row.bound);
        json["bound"]["off_exact"] = row.off_exact;
        json["bound"]["kept"] = row.kept();
    }
    json["front"] = row.front;
    return json;
}

std::string bound_text(const TradeRow& row) {
    if (!row.bound) return "";
    return fmt::format("{:.3g}{}", row.bound->codes, row.kept() ? "" : ", violated");
}

std::vector<const TradeRow*> rows_by_time(const std::vector<TradeRow>& rows) {
    std::vector<const TradeRow*> sorted;
    for (const TradeRow& row : rows) sorted.push_back(&row);
    std::stable_sort(sorted.begin(), sorted.end(), [](const TradeRow* a, const TradeRow* b) { return a->ratio < b->ratio; });
    return sorted;
}

}  // namespace

std::string trade_table(const std::vector<TradeRow>& rows, const TradeBench& bench) {
    std::string text = fmt::format(
        "# Time and error of {}\n\n```\n{}```\n\n"
        "Geometry covers {} pixels. Times are medians of the processor's time, divided by exact's; \"same\": the picture is exact's. "
        "Errors are differences from the float64 reference in a pixel's worst channel, in 8-bit codes before rounding. A bound is what a "
        "budget proves beforehand of the difference from the exact picture. Numbered rows are the Pareto "
        "front: settings that no other setting beats in both time and error.\n\n"
        "| | settings | flags | time | largest error | of 99.9 % | mean | PSNR, dB | off by 1, % | bound |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        bench.job().source.name, trade_summary(rows, bench), bench.reference(std::nullopt).pixels_drawn());
    for (const TradeRow* row : rows_by_time(rows))
        text +=
            fmt::format("| {} | {} | {} | {} | {:.3g} | {:.3g} | {:.3g} | {} | {:.3g} | {} |\n",
                        row->number > 0 ? fmt::format("{}", row->number) : "", row->name, row->flags.empty() ? "" : "`" + row->flags + "`",
                        row->same ? "same" : fmt::format("{:.2f}", row->ratio), row->error.max, row->error.p999, row->error.mean,
                        row->error.psnr ? fmt::format("{:.1f}", *row->error.psnr) : "", 100 * row->error.share_off, bound_text(*row));
    return text;
}

std::string trade_json(const std::vector<TradeRow>& rows, const TradeBench& bench) {
    const RenderJob& job = bench.job();
    const TradeRow& exact = exact_row(rows, bench.space());
    Json report = report_head("trade");
    report["scene"] = job.source.name;
    report["size"] = {job.width, job.height};
    report["samples"] = job.settings.samples;
    report["isa"] = isa_name(*job.execution.isa);
    report["pixels_drawn"] = bench.reference(std::nullopt).pixels_drawn();
    report["exact_ms"] = bench.exact_ms();
    report["noise"] = {exact.ratio_min, exact.ratio_max};
    report["warnings"] = job.warnings;
    report["rows"] = Json::array();
    for (const TradeRow& row : rows) report["rows"].push_back(row_json(row, bench.space()));
    return to_text(report);
}

std::string trade_summary(const std::vector<TradeRow>& rows, const TradeBench& bench) {
    std::string text = fmt::format("{} at {}x{}, {} samples: exact takes {:.2f} ms of processor, noise {:.2f} to {:.2f} times that\n",
                                   bench.job().source.name, bench.job().width, bench.job().height, bench.job().settings.samples,
                                   bench.exact_ms(), exact_row(rows, bench.space()).ratio_min, exact_row(rows, bench.space()).ratio_max);
    const std::vector<TradeOffer> offers = trade_offers(rows, bench.space());
    for (const std::string& line : trade_verdict(rows, bench.space())) text += line + "\n";
    if (!offers.empty()) text += " error at most    time   flags (error of 99.9 % of the pixels in 8-bit codes; time of exact = 1)\n";
    for (const TradeOffer& offer : offers) text += fmt::format("{:>14g}  {:>6.2f}   {}\n", offer.codes, offer.row->ratio, offer.row->flags);
    for (const TradeRow& row : rows)
        if (!row.kept())
            text += fmt::format("bound violated: {} is {:.4g} codes off the exact picture, its bound is {:.4g}\n", row.name, row.off_exact,
                                row.bound->codes);
    return text;
}

std::vector<TradeOffer> trade_offers(const std::vector<TradeRow>& rows, const TradeSpace& space) {
    const TradeRow& exact = exact_row(rows, space);
    std::vector<TradeOffer> offers;
    for (const double codes : kAllowances) {
        const TradeRow* best = nullptr;
        for (const TradeRow& row : rows)
            if (!row.choice.lobe && row.error.p999 <= codes && row.choice.accuracy != Accuracy::reference && surely_cheaper(row, exact) &&
                (best == nullptr || row.ratio < best->ratio))
                best = &row;
        if (best != nullptr && (offers.empty() || offers.back().row != best)) offers.push_back({codes, best});
    }
    return offers;
}

std::vector<std::string> trade_verdict(const std::vector<TradeRow>& rows, const TradeSpace& space) {
    constexpr double kFree = 0.1, kLittle = 1.0;  // codes
    const TradeRow& exact = exact_row(rows, space);
    const std::vector<TradeOffer> offers = trade_offers(rows, space);
    const auto best = [&](double codes) {
        const TradeRow* found = nullptr;
        for (const TradeOffer& offer : offers)
            if (offer.codes <= codes) found = offer.row;  // offers fall in time
        return found;
    };
    const auto told = [](const TradeRow* row) {
        return row == nullptr ? std::string("nothing") : fmt::format("{}, time {:.2f}", row->name, row->ratio);
    };
    std::vector<std::string> lines{"free (within 0.1 codes): " + told(best(kFree)), "for one code: " + told(best(kLittle))};
    // Settings that cost accuracy and save nothing, and those that the noise hides.
    std::string wasted;
    int hidden = 0, same = 0, varied = 0;
    double frames = 0;
    for (const TradeRow& row : rows) {
        if (row.choice.lobe || row.choice.accuracy == Accuracy::reference || &row == &exact) continue;
        ++varied;
        same += row.same;
        if (row.same) continue;
        const bool alone = settings_varied(row.choice, space) == 1;
        if (alone && row.error.p999 > exact.error.p999 + kFree && row.ratio > 0.97) wasted += (wasted.empty() ? "" : "; ") + row.name;
        const double gain = 1.0 - row.ratio, noise = std::max(row.ratio_max - row.ratio, 1.0 - exact.ratio_min);
        if (row.ratio < 0.97 && !surely_cheaper(row, exact)) {
            ++hidden;
            // The median of n frames is off by the noise over the root of n.
            frames = std::max(frames, row.frames * (noise / gain) * (noise / gain));
        }
    }
    lines.push_back("not worth it: " + (wasted.empty() ? std::string("nothing of these") : wasted));
    if (same > 0) lines.push_back(fmt::format("changes nothing here: {} of {} settings", same, varied));
    if (hidden > 0)
        lines.push_back(
            fmt::format("too noisy to tell: {} setting{} seemed faster, but not surely; --frames {} or a quiet "
                        "machine would show it",
                        hidden, hidden == 1 ? "" : "s", std::clamp(static_cast<int>(frames) + 1, exact.frames + 1, 1000)));
    if (offers.empty() && hidden == 0) lines.emplace_back("nothing is cheaper than exact");
    return lines;
}

const TradeRow& exact_row(const std::vector<TradeRow>& rows, const TradeSpace& space) {
    return *std::find_if(rows.begin(), rows.end(), [&](const TradeRow& row) { return row.choice == space.exact(); });
}

}  // namespace halflit::cli
