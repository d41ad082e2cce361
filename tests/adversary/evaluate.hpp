// Judges a trial's picture by a promise: a bound on its error, or a share of its pixels.
#pragma once

#include "halflit/renderer.hpp"
#include "tests/adversary/trial.hpp"

#include <cstdint>
#include <string>

namespace halflit::adversary {

/// Kinds of promises.
enum class Promise : std::uint8_t {
    bound,  ///< the error of a budget that is proven is within the bound that its report names
    share   ///< as many pixels are within the codes of a budget that is measured as Renderer::measure claims
};

/// Part of the bound that is largest.
enum class Term : std::uint8_t { rounding, lobes, specular, environment, cells, left_out };
inline constexpr int kTerms = 6;
inline constexpr const char* kTermNames[kTerms] = {"rounding", "lobes", "specular", "environment", "cells", "left out"};

struct Verdict {
    Promise promise = Promise::bound;
    double ratio = 0;      ///< measured / bound.codes, or the share outside / the one claimed; 0 if nothing was drawn or claimed
    double claimed = 100;  ///< Promise::share: percent of the pixels within `measured` codes that is claimed
    double held = 100;     ///< and the true one
    double measured = 0;   ///< codes, of the worst channel of the worst pixel; Promise::share: of the budget
    ErrorBound bound;
    int x = 0, y = 0, channel = 0;     ///< of the worst pixel
    double drawn = 0, true_value = 0;  ///< true: of the exact picture
    std::string refused;               ///< the message if halflit refused the scene
    [[nodiscard]] Term term() const;
    [[nodiscard]] bool broken() const { return ratio > 1.0; }
    /// True if the picture had something to keep: a bound above 0, or a share.
    [[nodiscard]] bool promised() const { return promise == Promise::share ? claimed < 100.0 : bound.codes > 0.0; }
};

/// Draws trials, one after the other. Keeps renderers, for what they remember of environments.
class Judge {
public:
    explicit Judge(Promise promise = Promise::bound) : promise_(promise) {}
    [[nodiscard]] Verdict judge(const Trial& trial);
    [[nodiscard]] Verdict judge(const Genome& genome, AvoidSet avoid) { return judge(make_trial(genome, avoid)); }

private:
    [[nodiscard]] Verdict judge_bound(const Trial& trial);
    [[nodiscard]] Verdict judge_share(const Trial& trial, const ShareBudget& budget);

    Promise promise_;
    Renderer budgeted_, exact_;
};

}  // namespace halflit::adversary
