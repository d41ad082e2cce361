// Cost and gain of an error budget. Random scenes are drawn with accuracy exact and with a budget in turn, on one thread. The shortest tile
// stage of each counts, and the difference in planning time. Scenes in which the budget looks slower are measured again, ten times as
// often. Scenes in which the budget needs more bands of the environment than exact takes by its own tolerance are listed apart: there the
// budget buys accuracy, not speed.
//
//     halflit_budget_bench [SCENES [WIDTH [CODES [SEED]]]]      60 scenes, 320 pixels wide, 0.5 codes, seeds from 1 on
#include "halflit/renderer.hpp"
#include "tests/raster/random_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace halflit;
using namespace halflit::raster;

namespace {

/// Times in milliseconds, the shortest of several frames.
struct Times {
    double tiles = 1e30, plan = 1e30;
    int bands = 0;  ///< sum over the environment's series
};

class Subject {
public:
    Subject(std::uint32_t seed, int width, double codes) : trial_(test::random_trial(seed)), width_(width), height_(width * 3 / 4) {
        // Shadow maps take most of the frame and are the same for both.
        trial_.settings.shadows = ShadowMode::off;
        rgba8_.resize(static_cast<std::size_t>(4 * width_ * height_));
        budget_ = trial_.settings;
        budget_.shading.max_error_codes = codes;
    }
    /// Returns false if the scene cannot be drawn.
    bool measure(int frames) {
        for (int i = 0; i < frames; ++i)
            if (!draw(trial_.settings, exact) || !draw(budget_, budget)) return false;
        return true;
    }
    [[nodiscard]] double ratio() const { return budget.tiles / exact.tiles; }
    [[nodiscard]] double planning() const { return budget.plan - exact.plan; }

    Times exact, budget;

private:
    bool draw(const Settings& settings, Times& times) {
        const auto report =
            renderer_.render(trial_.scene, trial_.camera, settings, {width_, height_, rgba8_.data(), nullptr}, {.threads = 1});
        if (!report) return false;
        times.tiles = std::min(times.tiles, report->ms.tiles);
        times.plan = std::min(times.plan, report->ms.plan);
        times.bands = 0;
        for (const EnvironmentUse& use : report->environment) times.bands += use.bands;
        return true;
    }

    test::Trial trial_;
    int width_, height_;
    Settings budget_;
    Renderer renderer_;
    std::vector<std::uint8_t> rgba8_;
};

}  // namespace

int main(int argc, char** argv) {
    const int scenes = argc > 1 ? std::atoi(argv[1]) : 60, width = argc > 2 ? std::atoi(argv[2]) : 320;
    const double codes = argc > 3 ? std::atof(argv[3]) : 0.5;
    const int first_seed = argc > 4 ? std::atoi(argv[4]) : 1;
    if (scenes < 1 || width < 16 || !(codes > 0)) {
        std::fprintf(stderr, "usage: halflit_budget_bench [SCENES [WIDTH [CODES [SEED]]]]\n");
        return 2;
    }
    constexpr int kFrames = 7;
    double worst = 0, best = 1e30, log_sum = 0, planning_sum = 0, planning_worst = 0, saved_sum = 0;
    int worst_seed = 0, dearer = 0;
    for (int seed = first_seed; seed < first_seed + scenes; ++seed) {
        Subject subject(static_cast<std::uint32_t>(seed), width, codes);
        if (!subject.measure(kFrames) || (subject.ratio() > 1.02 && !subject.measure(10 * kFrames))) {
            std::fprintf(stderr, "scene %d cannot be drawn\n", seed);
            return 1;
        }
        const double saved = subject.exact.tiles - subject.budget.tiles;
        log_sum += std::log(subject.ratio());
        if (subject.ratio() > worst) worst = subject.ratio(), worst_seed = seed;
        best = std::min(best, subject.ratio());
        planning_sum += subject.planning();
        planning_worst = std::max(planning_worst, subject.planning());
        saved_sum += saved;
        dearer += subject.planning() > saved ? 1 : 0;
    }
    std::printf("%d scenes, %d x %d, error budget %g codes\n", scenes, width, width * 3 / 4, codes);
    std::printf("time of the tiles, budget / exact: worst %.3f (seed %d), mean %.3f, best %.3f\n", worst, worst_seed,
                std::exp(log_sum / scenes), best);
    std::printf("per frame: tiles %.3f ms shorter, planning %.3f ms longer (worst %.3f); in %d scenes planning costs more than it saves\n",
                saved_sum / scenes, planning_sum / scenes, planning_worst, dearer);
    return 0;
}
