// Renderer::measure: which of the cheaper settings of quality.hpp keep a budget.
#include "raster/check_execution.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/detail/stopwatch.hpp"
#include "raster/quality.hpp"
#include "raster/renderer_impl.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>

namespace halflit {

using namespace raster;

namespace {

/// The finer of two results, setting by setting.
MeasuredShare more_careful(const MeasuredShare& a, const MeasuredShare& b) {
    MeasuredShare both = a;
    both.percent = std::min(a.percent, b.percent);
    both.probes = a.probes + b.probes, both.outside = a.outside + b.outside;
    both.samples = std::max(a.samples, b.samples);
    both.anisotropy = std::max(a.anisotropy, b.anisotropy);
    // 0 is the size in full quality.
    both.shadow_size = a.shadow_size == 0 || b.shadow_size == 0 ? 0 : std::max(a.shadow_size, b.shadow_size);
    return both;
}

}  // namespace

/// Measures what settings keep a share, by probes of one view.
class Renderer::Measuring {
public:
    Measuring(const PreparedData& scene, const Lighting& light, const Camera& camera, const ShareBudget& budget, int width, int height,
              Execution execution, Isa isa)
        : scene_(scene),
          light_(light),
          camera_(camera),
          budget_(budget),
          execution_(std::move(execution)),
          isa_(isa),
          width_(width),
          height_(height),
          probes_(choose_probes(width, height, camera)),
          mask_(width, height) {
        execution_.on_tile = {}, execution_.progress = {};
        execution_.memory_limit = (execution_.memory_limit + 1) / 2;  // two frames are kept
        for (const std::uint32_t at : probes_)
            mask_.add(static_cast<int>(at % static_cast<std::uint32_t>(width)), static_cast<int>(at / static_cast<std::uint32_t>(width)));
    }

    /// known: of other views; it is tried first. Null: there are none.
    Result<MeasuredShare> measure(Settings best, const MeasuredShare* known) {
        best.region = {};
        const Settings settings = known != nullptr ? with_share(best, *known) : best;
        if (known != nullptr && settings == best) return *known;
        if (auto ok = draw(full_, best, wanted_); !ok) return tl::unexpected<Error>(ok.error());
        if (full_.plan.looks_through) return result(best, 100.0, 0);  // what is behind glass is drawn as a whole: no probe is cheap
        if (known != nullptr) {
            const auto kept = keeps(settings);
            if (!kept) return tl::unexpected<Error>(kept.error());
            if (*kept) return result(settings, percent_, count_);
        }
        const std::vector<CheaperPart> parts = cheaper_parts(best, facts());
        if (parts.empty()) return result(best, 100.0, 0);
        std::vector<std::vector<bool>> outside;
        // A wide budget is often kept by all parts together, which spares drawing the probes with each of them.
        std::optional<Settings> cheapest;
        if (budget_.codes >= kWideBudget) {
            cheapest = combinations(best, parts, std::vector<std::vector<bool>>(parts.size())).front().settings;
            const auto kept = keeps(*cheapest);
            if (!kept) return tl::unexpected<Error>(kept.error());
            if (*kept) return result(*cheapest, percent_, count_);
        }
        for (const CheaperPart& part : parts) {
            if (auto ok = compare(with_part(best, part)); !ok) return tl::unexpected<Error>(ok.error());
            outside.push_back(outside_);
        }
        int tried = 0;
        for (const Combination& one : combinations(best, parts, outside)) {
            if (one.settings == cheapest || shown(one.outside) < budget_.percent) continue;
            if (tried++ == kMostTried) break;
            const auto kept = keeps(one.settings);
            if (!kept) return tl::unexpected<Error>(kept.error());
            if (*kept) return result(one.settings, percent_, count_);
        }
        return result(best, 100.0, 0);
    }

private:
    static constexpr int kMostTried = 3;
    /// Any of 11 combinations, and what is known, may become the claim: together they are wrong with a probability of 5 %.
    static constexpr double kDoubt = 0.05 / 12;

    [[nodiscard]] double shown(int outside) const { return share_shown(static_cast<int>(probes_.size()), outside, kDoubt); }
    [[nodiscard]] MeasuredShare result(const Settings& settings, double percent, int outside) const {
        return {budget_,
                percent,
                static_cast<int>(probes_.size()),
                outside,
                settings.samples,
                settings.shading.anisotropy,
                settings.shadow_size};
    }
    [[nodiscard]] QualityFacts facts() const {
        QualityFacts facts;
        for (const shading::MaterialPlan& material : full_.plan.shading.materials)
            facts.textures |= (material.stages & kStageGradients) != 0;
        // A size that is set counts for all maps, so they must be of one size, and none of a light that has half of it.
        std::set<int> sides;
        for (const shading::ShadowMapPlan& map : full_.plan.shading.shadow_maps)
            sides.insert(map.kind == shading::ShadowMapPlan::Kind::cube ? 2 * map.size : map.size);
        const bool soft = std::any_of(full_.plan.shading.lights.begin(), full_.plan.shading.lights.end(),
                                      [](const shading::LightPlan& light) { return light.shadow_points > 1; });
        if (sides.size() == 1 && !soft && full_.plan.shading.sky.empty()) facts.shadow_size = *sides.begin();
        return facts;
    }
    /// Codes of the probes.
    Result<void> draw(Impl& by, const Settings& settings, std::vector<std::uint32_t>& codes) {
        std::uint32_t* const picture = picture_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        const Target target{.width = width_, .height = height_, .pixels = reinterpret_cast<std::uint8_t*>(picture)};
        spent_s_ += watch_.lap() / 1000.0;
        auto report = by.render(scene_, light_, camera_, settings, target, with_time_left(execution_, spent_s_), isa_, {}, &mask_);
        if (!report) return tl::unexpected<Error>(report.error());
        codes.clear();
        for (const std::uint32_t at : probes_) codes.push_back(picture[at]);
        return {};
    }
    /// Sets the probes that the settings take outside.
    Result<void> compare(const Settings& settings) {
        std::vector<std::uint32_t> codes;
        if (auto ok = draw(cheaper_, settings, codes); !ok) return ok;
        outside_.resize(codes.size());
        for (std::size_t i = 0; i < codes.size(); ++i) outside_[i] = differs(codes[i], wanted_[i], budget_.codes);
        return {};
    }
    Result<bool> keeps(const Settings& settings) {
        if (auto ok = compare(settings); !ok) return tl::unexpected<Error>(ok.error());
        count_ = static_cast<int>(std::count(outside_.begin(), outside_.end(), true));
        percent_ = shown(count_);
        return percent_ >= budget_.percent;
    }

    Impl full_, cheaper_;
    Stopwatch watch_;
    double spent_s_ = 0;
    const PreparedData& scene_;
    const Lighting& light_;
    const Camera& camera_;
    const ShareBudget& budget_;
    Execution execution_;
    Isa isa_;
    int width_, height_;
    std::vector<std::uint32_t> probes_;
    PixelMask mask_;
    RawBuffer<std::uint32_t> picture_;
    std::vector<std::uint32_t> wanted_;
    std::vector<bool> outside_;
    double percent_ = 0;
    int count_ = 0;
};

Result<MeasuredShare> Renderer::measure(const PreparedScene& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                        const ShareBudget& budget, int width, int height, const MeasuredShare* known,
                                        const Execution& execution) {
    return guarded("measuring", execution, [&]() -> Result<MeasuredShare> {
        const auto isa = check_execution(execution);
        if (!isa) return tl::unexpected<Error>(isa.error());
        if (auto ok = check_settings(settings, width, height); !ok) return tl::unexpected<Error>(ok.error());
        if (!(budget.codes >= 0.0 && budget.codes <= 255.0))
            return fail(ErrorCode::usage, "codes: " + std::to_string(budget.codes) + ", expected a number from 0 to 255");
        if (!(budget.percent > 0.0 && budget.percent < 100.0))
            return fail(ErrorCode::usage, "percent: " + std::to_string(budget.percent) + ", expected a number above 0 and below 100");
        if (settings.shading.accuracy != Accuracy::exact || settings.shading.max_error_codes > 0.0)
            return fail(ErrorCode::usage, "measure: expected accuracy exact, and no error budget that is proven");
        if (known != nullptr) {
            if (known->asked.codes != budget.codes || known->asked.percent != budget.percent)
                return fail(ErrorCode::usage, "measure: what is known is of another budget");
            constexpr int kMostProbes = 1'000'000'000;
            if (known->probes < 1 || known->probes > kMostProbes || known->outside < 0 || known->outside > known->probes ||
                !(known->percent >= 0.0 && known->percent <= 100.0))
                return fail(ErrorCode::usage, "measure: what is known has impossible numbers");
            if (auto ok = check_settings(with_share(settings, *known), width, height); !ok) return tl::unexpected<Error>(ok.error());
        }
        auto found = Measuring(scene.data(), light, camera, budget, width, height, execution, *isa).measure(settings, known);
        if (found && known != nullptr) *found = more_careful(*known, *found);
        if (found && with_share(settings, *found) == settings) found->percent = 100.0;
        return found;
    });
}

Settings with_share(Settings settings, const MeasuredShare& measured) {
    settings.samples = measured.samples;
    settings.shading.anisotropy = measured.anisotropy;
    settings.shadow_size = measured.shadow_size;
    return settings;
}

}  // namespace halflit
