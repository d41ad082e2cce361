#include "apps/lab/trade_bench.hpp"

#include "apps/engine/basics/median.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "raster/frame_plan.hpp"
#include "raster/scene/prepared_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace halflit::cli {
namespace {

template <class T>
void add_once(std::vector<T>& list, T value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(std::move(value));
}

/// Compares rows of one lobe only, because another lobe gives another picture.
bool dominates(const TradeRow& a, const TradeRow& b) {
    return a.choice.lobe == b.choice.lobe && a.ratio <= b.ratio && a.error.p999 <= b.error.p999 &&
           (a.ratio < b.ratio || a.error.p999 < b.error.p999);
}

/// The interval that holds the median of what the values are drawn from with a confidence of 95 %: of the k-th smallest and the k-th
/// largest value, k as large as it may be. Each value is below the median with a probability of a half (sign test). Of five values or
/// fewer it is their range, with less confidence.
std::pair<double, double> median_interval(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    std::size_t k = 0;
    double outside = std::pow(0.5, static_cast<double>(n) - 1.0), term = outside;  // on both sides
    while (k + 1 < (n + 1) / 2) {
        term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
        if ((outside += term) > 0.05) break;
        ++k;
    }
    return {values[k], values[n - 1 - k]};
}

bool is_same(const Image& a, const Image& b) { return a.rgba8 == b.rgba8 && a.rgba_linear == b.rgba_linear; }

}  // namespace

void mark_front(std::vector<TradeRow>& rows) {
    std::vector<TradeRow*> front;
    for (TradeRow& row : rows) {
        row.front = !row.same &&
                    std::none_of(rows.begin(), rows.end(), [&](const TradeRow& other) { return !other.same && dominates(other, row); });
        row.number = 0;
        if (row.front) front.push_back(&row);
    }
    std::stable_sort(front.begin(), front.end(), [](const TradeRow* a, const TradeRow* b) { return a->ratio < b->ratio; });
    for (std::size_t i = 0; i < front.size(); ++i) front[i]->number = static_cast<int>(i) + 1;
}

TradeBench::TradeBench(RenderJob job, TradeSpace space, int frames)
    : job_(std::move(job)),
      space_(std::move(space)),
      frames_(frames),
      settings_(job_.settings),
      own_materials_(job_.scene().materials),
      timed_(make_image(job_, false)) {}

Result<void> TradeBench::choose(const TradeChoice& choice) {
    apply_choice(settings_, choice);
    if (choice.lobe == lobe_) return {};
    lobe_ = choice.lobe;
    job_.scene().materials = own_materials_;
    settings_.shading.lobe = lobe_ ? space_.lobes[*lobe_].lobe : job_.settings.shading.lobe;
    if (lobe_) drop_own_lobes(job_.scene());
    return job_.prepared->update({.materials = true});
}

Result<Image> TradeBench::draw(const TradeChoice& choice) {
    if (const auto chosen = choose(choice); !chosen) return tl::unexpected(chosen.error());
    Image image = make_image(job_, true);
    auto drawn = renderer_.render(*job_.prepared, job_.light, job_.camera, settings_, target_of(job_, image), job_.timed_execution());
    if (!drawn) return tl::unexpected(drawn.error());
    drawn_ = std::move(*drawn);
    return image;
}

Result<TradeBench::Times> TradeBench::time_of(Renderer& renderer, const TradeChoice& choice) {
    if (const auto chosen = choose(choice); !chosen) return tl::unexpected(chosen.error());
    renderer.forget_frames();  // draws complete frames, as when the scene moves
    const Stopwatch watch;
    const CpuStopwatch cpu_watch;
    const auto rendered =
        renderer.render(*job_.prepared, job_.light, job_.camera, settings_, target_of(job_, timed_), job_.timed_execution());
    const Times times{cpu_watch.ms(), watch.ms()};
    if (!rendered) return tl::unexpected(rendered.error());
    return times;
}

Result<void> TradeBench::describe(TradeRow& row) {
    row.name = trade_name(row.choice, space_);
    row.flags = trade_flags(row.choice, space_);
    if (row.choice.max_error_codes > 0) row.bound = drawn_.error;
    for (const EnvironmentUse& use : drawn_.environment) add_once(row.orders, use.bands);
    std::sort(row.orders.begin(), row.orders.end());
    if (row.choice.accuracy == Accuracy::reference) return {};
    const auto frame = raster::plan_frame(job_.prepared->data(), job_.light, job_.camera, settings_, job_.width, job_.height);
    if (!frame) return tl::unexpected(frame.error());
    const std::vector<bool>& drawn = job_.prepared->data().drawn_materials();
    shading::PowTier tier = shading::PowTier::exact;
    int powers = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const shading::MaterialPlan& material = frame->shading.materials[i];
        if (!drawn[i]) continue;
        if ((material.stages & (kStageLights | kStageEnvironment)) != 0) {
            std::string path(lobe_path_name(material.lobe.path));
            if (material.lobe.path == shading::LobePath::general) path += fmt::format(" ({})", tier_name(material.lobe.tier));
            add_once(row.lobe_paths, std::move(path));
        }
        if ((material.stages & kStageSpecular) == 0) continue;
        // With a budget, materials may differ. The most exact tier is named, and "curve" only if all materials have curves.
        if (material.specular_curve.squarings >= 0) {
            if (row.specular_tier.empty()) row.specular_tier = specular_power_name(material);
            continue;
        }
        tier = powers++ == 0 ? material.specular_tier : std::min(tier, material.specular_tier);
        row.specular_tier = tier_name(tier);
    }
    return {};
}

Result<TradeRow> TradeBench::measure_reference(std::optional<std::size_t> lobe) {
    TradeRow row;
    row.choice = space_.reference(lobe);
    const Stopwatch watch;
    const CpuStopwatch cpu_watch;
    auto picture = draw(row.choice);
    if (!picture) return tl::unexpected(picture.error());
    row.ms = cpu_watch.ms();
    row.wall_ratio = watch.ms();  // a time in ms; divided by exact's when that is known
    row.frames = 1;
    if (const auto described = describe(row); !described) return tl::unexpected(described.error());

    settings_.background_environment = false;
    settings_.background_linear = {0, 0, 0, 0};
    settings_.contact_shadow = 0.0f;
    const auto coverage = draw(space_.exact());
    settings_.background_environment = job_.settings.background_environment;
    settings_.background_linear = job_.settings.background_linear;
    settings_.contact_shadow = job_.settings.contact_shadow;
    if (!coverage) return tl::unexpected(coverage.error());
    references_.emplace_back(*picture, *coverage, tone_curve());
    return row;
}

Result<TradeRow> TradeBench::measure_choice(const TradeChoice& choice) {
    TradeRow row;
    row.choice = choice;
    const auto picture = draw(choice);  // not timed: allocates the renderer's memory
    if (!picture) return tl::unexpected(picture.error());
    row.error = reference(choice.lobe).error_of(*picture);
    const TradeChoice exact = space_.exact();
    row.same = choice != exact && !choice.lobe && is_same(*picture, *exact_);
    if (const auto described = describe(row); !described) return tl::unexpected(described.error());
    if (row.bound) {
        TradeChoice without = choice;
        without.max_error_codes = 0.0;
        const auto full = draw(without);
        if (!full) return tl::unexpected(full.error());
        row.off_exact = TradeReference(*full, *full, tone_curve()).error_of(*picture).max;
    }

    std::vector<double> times, ratios, wall_ratios;
    for (int i = 0; i < frames_; ++i) {
        // The two are drawn in turn, every second time in the other order, so that other load on the machine affects both alike.
        Result<Times> of_exact = Times{}, of_choice = Times{};
        if (i % 2 == 0) of_exact = time_of(exact_renderer_, exact);
        of_choice = time_of(renderer_, choice);
        if (i % 2 == 1) of_exact = time_of(exact_renderer_, exact);
        if (!of_exact) return tl::unexpected(of_exact.error());
        if (!of_choice) return tl::unexpected(of_choice.error());
        times.push_back(of_choice->cpu_ms);
        ratios.push_back(of_choice->cpu_ms / of_exact->cpu_ms);
        wall_ratios.push_back(of_choice->wall_ms / of_exact->wall_ms);
        exact_cpu_times_.push_back(of_exact->cpu_ms);
        exact_wall_times_.push_back(of_exact->wall_ms);
    }
    row.ms = median(times);
    row.frames = frames_;
    row.ratio = choice == exact ? 1.0 : median(ratios);  // exact's range stays: it is the noise
    row.wall_ratio = choice == exact ? 1.0 : median(wall_ratios);
    std::tie(row.ratio_min, row.ratio_max) = median_interval(ratios);
    return row;
}

Result<std::vector<TradeRow>> TradeBench::measure(const std::vector<TradeChoice>& choices, const Progress& progress) {
    const std::size_t references = space_.lobes.size() + 1, steps = references + choices.size();
    std::vector<TradeRow> rows;
    const auto add = [&](Result<TradeRow> row) -> Result<void> {
        if (!row) return tl::unexpected(row.error());
        rows.push_back(std::move(*row));
        progress(rows.size(), steps);
        return {};
    };
    progress(0, steps);
    for (std::size_t i = 0; i < references; ++i)
        if (const auto added = add(measure_reference(i == 0 ? std::nullopt : std::optional(i - 1))); !added)
            return tl::unexpected(added.error());
    auto exact = draw(space_.exact());
    if (!exact) return tl::unexpected(exact.error());
    exact_ = std::move(*exact);
    // The first frames are not measured: they allocate memory, and caches are cold.
    for (Renderer* const renderer : {&exact_renderer_, &renderer_, &exact_renderer_, &renderer_})
        if (const auto warm = time_of(*renderer, space_.exact()); !warm) return tl::unexpected(warm.error());
    for (const TradeChoice& choice : choices)
        if (const auto added = add(measure_choice(choice)); !added) return tl::unexpected(added.error());
    exact_ms_ = median(exact_cpu_times_);
    for (std::size_t i = 0; i < references; ++i) rows[i].ratio = rows[i].ratio_min = rows[i].ratio_max = rows[i].ms / exact_ms_;
    for (std::size_t i = 0; i < references; ++i) rows[i].wall_ratio /= median(exact_wall_times_);
    mark_front(rows);
    return rows;
}

}  // namespace halflit::cli
