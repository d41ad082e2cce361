// The error of a trial's budgeted picture, against the bound that its report promises.
#pragma once

#include "halflit/renderer.hpp"
#include "tests/adversary/trial.hpp"

#include <cstdint>
#include <string>

namespace halflit::adversary {

/// What a picture was compared with.
enum class Truth : std::uint8_t {
    reference,  ///< Accuracy::reference
    whole_sky   ///< the same without the environment, plus the environment's own image, suns included, summed pixel by pixel
};

/// Part of the bound that is largest.
enum class Term : std::uint8_t { rounding, lobes, specular, environment, cells, left_out };
inline constexpr int kTerms = 6;
inline constexpr const char* kTermNames[kTerms] = {"rounding", "lobes", "specular", "environment", "cells", "left out"};

struct Verdict {
    double ratio = 0;     ///< measured / bound.codes; 0 if nothing was drawn
    double measured = 0;  ///< codes, of the worst channel of the worst pixel
    ErrorBound bound;
    Truth truth = Truth::reference;
    int x = 0, y = 0, channel = 0;  ///< of the worst pixel
    double drawn = 0, true_value = 0;
    std::string refused;  ///< the message if halflit refused the scene
    [[nodiscard]] Term term() const;
    [[nodiscard]] bool broken() const { return ratio > 1.0; }
};

/// Draws trials, one after the other. Keeps renderers, for what they remember of environments.
class Judge {
public:
    [[nodiscard]] Verdict judge(const Trial& trial);
    [[nodiscard]] Verdict judge(const Genome& genome, AvoidSet avoid) { return judge(make_trial(genome, avoid)); }

private:
    Renderer budgeted_, reference_, rest_;
};

}  // namespace halflit::adversary
