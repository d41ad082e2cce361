// Draws a frame in many ways, and says of each what it took and what it is off by.
#pragma once

#include "apps/halflit/render_job.hpp"
#include "apps/halflit/trade_error.hpp"
#include "apps/halflit/trade_grid.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct TradeRow {
    TradeChoice choice;
    std::string name, flags;
    double ms = 0;     ///< median of the frames
    double ratio = 1;  ///< median, over pairs of frames drawn in turn, of this one's time to that of exact
    double ratio_min = 1, ratio_max = 1;
    double cpu_ratio = 1;  ///< the same of the processors' time
    int frames = 0;
    TradeError error;
    std::optional<shading::ErrorBound> bound;  ///< with a budget: what was promised
    std::vector<std::string> lobe_paths;       ///< how t^n is computed, with the polynomials' tier where there are any
    std::string specular_tier;                 ///< of the polynomials for cos^s, or "curve"; empty without highlights
    std::vector<int> orders;                   ///< of the environment, in use
    bool front = false;                        ///< nothing else is both faster and nearer to the reference
    int number = 0;                            ///< on the front, by time from 1; otherwise 0

    [[nodiscard]] bool kept() const { return !bound || error.max <= bound->codes; }
};

/// Marks the rows that no other row of their lobe dominates in (ratio, error.p999): no larger in both and smaller in one. Numbers them.
void mark_front(std::vector<TradeRow>& rows);

/// What was drawn, and what it looks like.
class TradeBench {
public:
    /// The job must have been made for reference accuracy, so that its environment kept its light.
    TradeBench(RenderJob job, TradeSpace space, int frames);

    /// `steps_done` counts up to `steps` of about equal length.
    using Progress = std::function<void(std::size_t steps_done, std::size_t steps)>;

    /// The references first, one for each lobe, then the choices in order; the front is marked.
    Result<std::vector<TradeRow>> measure(const std::vector<TradeChoice>& choices, const Progress& progress);

    /// With linear floats; the job's region.
    Result<raster::Image> draw(const TradeChoice& choice);
    [[nodiscard]] const TradeReference& reference(std::optional<std::size_t> lobe) const { return references_[lobe ? *lobe + 1 : 0]; }
    [[nodiscard]] const raster::Image& reference_picture(std::optional<std::size_t> lobe) const { return pictures_[lobe ? *lobe + 1 : 0]; }

    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] const TradeSpace& space() const { return space_; }
    /// Of exact alone, over all of its frames.
    [[nodiscard]] double exact_ms() const { return exact_ms_; }

private:
    Result<void> choose(const TradeChoice& choice);
    Result<TradeRow> measure_reference(std::optional<std::size_t> lobe);
    Result<TradeRow> measure_choice(const TradeChoice& choice);
    struct Times {
        double ms, cpu_ms;
    };
    Result<Times> time_of(raster::Renderer& renderer, const TradeChoice& choice);
    Result<void> describe(TradeRow& row);

    RenderJob job_;
    TradeSpace space_;
    int frames_;
    raster::Settings settings_;
    std::vector<shading::Material> own_materials_;
    std::optional<std::size_t> lobe_;  ///< that the materials have now
    raster::Image timed_;              ///< codes alone, as most programs want them
    raster::Renderer exact_renderer_, renderer_;
    std::vector<double> exact_times_, exact_cpu_times_;
    double exact_ms_ = 0;
    std::vector<TradeReference> references_;  ///< of the scene's own lobe, and of the others
    std::vector<raster::Image> pictures_;
    raster::RenderReport drawn_;  ///< by draw()
};

}  // namespace halflit::cli
