#include "tests/adversary/evaluate.hpp"

#include "raster/quality.hpp"
#include "shading/reference/reference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halflit::adversary {
namespace {

struct Drawn {
    std::vector<float> linear, normal;
    std::vector<std::uint32_t> instance, triangle;
    RenderReport report;
};

Result<Drawn> draw(Renderer& renderer, const Trial& trial, double codes) {
    const std::size_t pixels = static_cast<std::size_t>(trial.width) * static_cast<std::size_t>(trial.height);
    Drawn out{std::vector<float>(4 * pixels),
              std::vector<float>(3 * pixels),
              std::vector<std::uint32_t>(pixels),
              std::vector<std::uint32_t>(pixels),
              {}};
    Settings settings = trial.settings;
    settings.shading.max_error_codes = codes;
    Target target{trial.width, trial.height, nullptr, out.linear.data()};
    target.normal = out.normal.data();
    target.instance = out.instance.data();
    target.triangle = out.triangle.data();
    Execution execution;
    execution.threads = 1;
    auto report = renderer.render(trial.scene, trial.camera, settings, target, execution);
    if (!report) return tl::unexpected<Error>(report.error());
    out.report = *std::move(report);
    return out;
}

/// The bound holds for a pixel that one surface fills (ErrorBound). With one sample each pixel is. With more, those are taken whose
/// neighbours show the same triangle: a triangle that holds their first samples holds all samples between them.
bool filled(const Trial& trial, const Drawn& picture, int x, int y) {
    const auto at = [&](int i, int j) {
        const auto k = static_cast<std::size_t>(j * trial.width + i);
        return std::pair(picture.instance[k], picture.triangle[k]);
    };
    if (at(x, y).first == 0) return false;
    if (trial.settings.samples == 1) return true;
    if (x == 0 || y == 0 || x + 1 == trial.width || y + 1 == trial.height) return false;
    for (int j = y - 1; j <= y + 1; ++j)
        for (int i = x - 1; i <= x + 1; ++i)
            if (at(i, j) != at(x, y)) return false;
    return true;
}

/// Raises the verdict to the worst pixel of the picture against the exact one, RGBA as in a Target.
void compare(const Trial& trial, const Drawn& picture, const std::vector<float>& exact, Verdict& verdict) {
    const double bound = std::max(picture.report.error.codes, 1e-9);
    for (int y = 0; y < trial.height; ++y)
        for (int x = 0; x < trial.width; ++x) {
            if (!filled(trial, picture, x, y)) continue;
            for (int c = 0; c < 3; ++c) {
                const auto i = static_cast<std::size_t>(4 * (y * trial.width + x) + c);
                if (picture.linear[i] == exact[i]) continue;
                const double drawn = picture.linear[i], wanted = exact[i];
                const double off = std::abs(shading::reference::srgb_code(drawn) - shading::reference::srgb_code(wanted));
                if (!(off > verdict.measured)) continue;
                verdict.measured = off;
                verdict.ratio = off / bound;
                verdict.x = x, verdict.y = y, verdict.channel = c;
                verdict.drawn = drawn, verdict.true_value = wanted;
            }
        }
}

}  // namespace

Term Verdict::term() const {
    const double parts[kTerms] = {bound.rounding, bound.lobes, bound.specular, bound.environment, bound.cells, bound.left_out};
    return static_cast<Term>(std::max_element(parts, parts + kTerms) - parts);
}

Verdict Judge::judge(const Trial& trial) {
    if (promise_ == Promise::bound) return judge_bound(trial);
    Verdict draft = judge_share(trial, kDraftQuality), fast = judge_share(trial, kFastQuality);
    return fast.ratio > draft.ratio ? fast : draft;
}

Verdict Judge::judge_share(const Trial& trial, const ShareBudget& budget) {
    constexpr int kWidth = 128, kHeight = 96;
    Verdict verdict;
    verdict.promise = Promise::share;
    verdict.measured = budget.codes;
    Settings full = trial.settings;
    full.shading.accuracy = Accuracy::exact;
    full.shading.max_error_codes = 0;
    full.shading.anisotropy = 4;
    full.samples = std::max(full.samples, 4);
    full.shadow_size = 0;
    const Execution execution{.threads = 1};
    const auto fail = [&](const Error& error) {
        verdict.refused = error.message;
        return verdict;
    };
    const auto prepared = PreparedScene::make(trial.scene);
    if (!prepared) return fail(prepared.error());
    const auto measured = Renderer::measure(*prepared, trial.scene, trial.camera, full, budget, kWidth, kHeight, nullptr, execution);
    if (!measured) return fail(measured.error());
    const Settings cheaper = with_share(full, *measured);
    if (cheaper == full) return verdict;
    std::vector<std::uint32_t> wanted(kWidth * kHeight), drawn(kWidth * kHeight);
    const auto draw_codes = [&](Renderer& renderer, const Settings& settings, std::vector<std::uint32_t>& codes) {
        const Target target{.width = kWidth, .height = kHeight, .pixels = reinterpret_cast<std::uint8_t*>(codes.data())};
        return renderer.render(trial.scene, trial.camera, settings, target, execution);
    };
    if (const auto report = draw_codes(budgeted_, full, wanted); !report) return fail(report.error());
    if (const auto report = draw_codes(exact_, cheaper, drawn); !report) return fail(report.error());
    int outside = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) outside += raster::differs(wanted[i], drawn[i], budget.codes) ? 1 : 0;
    verdict.claimed = measured->percent;
    verdict.held = 100.0 * (1.0 - static_cast<double>(outside) / static_cast<double>(wanted.size()));
    verdict.ratio = (100.0 - verdict.held) / (100.0 - verdict.claimed);
    return verdict;
}

Verdict Judge::judge_bound(const Trial& trial) {
    Verdict verdict;
    const auto picture = draw(budgeted_, trial, trial.settings.shading.max_error_codes);
    if (!picture) {
        verdict.refused = picture.error().message;
        return verdict;
    }
    verdict.bound = picture->report.error;
    if (picture->report.pixels_visible == 0) return verdict;
    const auto exact = draw(exact_, trial, 0);
    if (exact)
        compare(trial, *picture, exact->linear, verdict);
    else
        verdict.refused = exact.error().message;
    return verdict;
}

}  // namespace halflit::adversary
