#include "tests/adversary/report.hpp"

#include "tests/adversary/glb_writer.hpp"

#include <cstdio>

namespace halflit::adversary {

std::string text_of(const Verdict& v) {
    char text[500];
    if (v.promise == Promise::share) {
        std::snprintf(text, sizeof text, "ratio %.4g: %.4g %% of the pixels within %.4g codes, %.4g %% claimed", v.ratio, v.held,
                      v.measured, v.claimed);
        return text;
    }
    std::snprintf(text, sizeof text,
                  "ratio %.4g: %.4g codes off the exact picture at pixel %d,%d channel %d (drawn %.6g, true %.6g); bound %.4g = rounding "
                  "%.3g + lobes %.3g + "
                  "specular %.3g + environment %.3g + cells %.3g + left out %.3g; budget %.3g",
                  v.ratio, v.measured, v.x, v.y, v.channel, v.drawn, v.true_value, v.bound.codes, v.bound.rounding, v.bound.lobes,
                  v.bound.specular, v.bound.environment, v.bound.cells, v.bound.left_out, v.bound.budget);
    return text;
}

std::string text_of(const SearchResult& r) {
    char text[300];
    std::snprintf(text, sizeof text,
                  "%llu scenes in %.1f s (%.0f a second), %llu with a promise, %llu refused; %zu "
                  "climbs ended above 1, worst ratio %.4g",
                  static_cast<unsigned long long>(r.scenes), r.seconds, static_cast<double>(r.scenes) / r.seconds,
                  static_cast<unsigned long long>(r.drawn), static_cast<unsigned long long>(r.refused), r.broken.size(),
                  r.worst.verdict.ratio);
    std::string out = text;
    if (r.worst.verdict.promise == Promise::share)
        return out + "\n  random scenes: " + std::to_string(r.fresh) + " claims, " + std::to_string(r.fresh_broken) +
               " of them wrong\n  worst: " + text_of(r.worst.verdict);
    for (int t = 0; t < kTerms; ++t) {
        const Found& found = r.worst_of_term[t];
        out += std::string("\n  worst where ") + kTermNames[t] + " fills the bound (scene " + std::to_string(found.scene) +
               "): " + text_of(found.verdict);
    }
    return out;
}

std::string written(const Trial& trial, const std::string& folder, const std::string& name) {
    const auto flags = write_trial(trial, folder + "/" + name);
    if (!flags) return "  not written: " + flags.error().message;
    char budget[40];
    std::snprintf(budget, sizeof budget, "%.9g", trial.settings.shading.max_error_codes);
    return "  halflit trade " + *flags + "\n  halflit render " + flags->substr(0, flags->find(" # ")) + " --max-error " + budget +
           " --report -";
}

}  // namespace halflit::adversary
