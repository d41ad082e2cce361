// Draws a frame with many settings, and measures time and error of each.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "apps/engine/trade/trade_error.hpp"
#include "apps/halflit/program/engine.hpp"
#include "apps/lab/trade_grid.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct TradeRow {
    TradeChoice choice;
    std::string name, flags;
    double ms = 0;     ///< the processor's time, median of the frames
    double ratio = 1;  ///< median, over pairs of frames drawn in turn, of this row's processor time divided by that of exact
    double ratio_min = 1, ratio_max = 1;  ///< where that median lies with a confidence of 95 % (sign test; from 6 pairs on)
    double wall_ratio = 1;                ///< the same for the clock's time
    bool same = false;                    ///< a picture that is exact's in every bit, though the settings are not
    int frames = 0;
    TradeError error;
    std::optional<ErrorBound> bound;      ///< the proven bound, if the row has an error budget
    double off_exact = 0;                 ///< with a bound: largest difference from the picture without the budget, which it bounds
    std::vector<std::string> lobe_paths;  ///< methods for lobes t^n, with the tier of their polynomials if any
    std::string specular_tier;            ///< tier of the polynomials for highlights cos^s, or "curve"; empty without highlights
    std::vector<int> orders;              ///< numbers of bands in use for the environment
    bool front = false;                   ///< true on the Pareto front: no other row of its lobe beats it in both time and error
    int number = 0;                       ///< place on the front by time, from 1; 0: not on the front

    /// The measured difference is within the bound; true for a row without one.
    [[nodiscard]] bool kept() const { return !bound || off_exact <= bound->codes; }
};

/// Marks each lobe's Pareto front in (ratio, error.p999): a row is left out if another one of its lobe is no larger in both and smaller in
/// one, or if it changes nothing. Numbers the marked rows of all lobes by time.
void mark_front(std::vector<TradeRow>& rows);

/// Draws and times a job's frame with each choice, and keeps the references.
class TradeBench {
public:
    /// The job must have been made for reference accuracy, so that its environment keeps the image that the reference integrates.
    TradeBench(RenderJob job, TradeSpace space, int frames);

    /// Called with the number of steps done so far, and of all steps.
    using Progress = std::function<void(std::size_t steps_done, std::size_t steps)>;

    /// Measures the references, one for each lobe, then the choices in order, and marks the front.
    Result<std::vector<TradeRow>> measure(const std::vector<TradeChoice>& choices, const Progress& progress);

    [[nodiscard]] const TradeReference& reference(std::optional<std::size_t> lobe) const { return references_[lobe ? *lobe + 1 : 0]; }

    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] const TradeSpace& space() const { return space_; }
    /// Median of exact's processor time over all of its frames.
    [[nodiscard]] double exact_ms() const { return exact_ms_; }

private:
    /// Curve over the light of pictures. Where there are 3D Gaussians alone, they are codes already.
    [[nodiscard]] ToneCurve tone_curve() const { return drawn_.triangles_submitted > 0 ? job_.settings.tone_curve : ToneCurve::none; }
    Result<void> choose(const TradeChoice& choice);
    /// Draws the job's region, with linear floats.
    Result<Image> draw(const TradeChoice& choice);
    Result<TradeRow> measure_reference(std::optional<std::size_t> lobe);
    Result<TradeRow> measure_choice(const TradeChoice& choice);
    struct Times {
        double cpu_ms, wall_ms;
    };
    Result<Times> time_of(Renderer& renderer, const TradeChoice& choice);
    Result<void> describe(TradeRow& row);

    RenderJob job_;
    TradeSpace space_;
    int frames_;
    Settings settings_;
    std::vector<Material> own_materials_;
    std::optional<std::size_t> lobe_;  ///< lobe that the materials have now
    Image timed_;                      ///< target of the timed frames: 8-bit codes alone
    Renderer exact_renderer_, renderer_;
    std::optional<Image> exact_;  ///< exact's picture with the scene's own lobe
    std::vector<double> exact_cpu_times_, exact_wall_times_;
    double exact_ms_ = 0;
    std::vector<TradeReference> references_;  ///< one for the scene's own lobe, then one for each of the others
    RenderReport drawn_;                      ///< report of the last draw()
};

}  // namespace halflit::cli
