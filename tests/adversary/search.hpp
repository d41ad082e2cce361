// The search for scenes that break the promise: random restarts, each followed by hill climbing on measured error / promised bound.
#pragma once

#include "tests/adversary/evaluate.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace halflit::adversary {

struct SearchOptions {
    Promise promise = Promise::bound;
    std::uint64_t seed = 1;
    AvoidSet avoid = 0;
    double seconds = std::numeric_limits<double>::infinity();  ///< wall clock
    std::uint64_t scenes = std::numeric_limits<std::uint64_t>::max();
    int climb_steps = 100;       ///< mutations without a better one that end a climb
    int fresh_per_climb = 12;    ///< random scenes of which the best begins a climb
    bool stop_at_first = false;  ///< end with the first broken promise
};

struct Found {
    Genome genome{};
    Verdict verdict;
    std::uint64_t scene = 0;  ///< number of scenes tried up to this one
};

struct SearchResult {
    std::uint64_t scenes = 0, refused = 0;
    std::uint64_t drawn = 0;                    ///< with a bound above 0 and a surface in view, or a share
    std::uint64_t fresh = 0, fresh_broken = 0;  ///< of the random scenes that were drawn: all, and with a broken promise
    double seconds = 0;
    Found worst;                  ///< largest ratio of all
    Found worst_of_term[kTerms];  ///< by the largest part of the bound
    std::vector<Found> broken;    ///< the top of each climb that broke the promise
};

/// Searches until scenes or seconds end. `on_broken` is told at once of each top of a climb above 1.
[[nodiscard]] SearchResult search(const SearchOptions& options, const std::function<void(const Found&)>& on_broken = {});

/// One climb from a scene, of `steps` mutations at most, past a broken promise too.
[[nodiscard]] Found climbed(Judge& judge, const Genome& genome, AvoidSet avoid, std::uint64_t seed, int steps);

/// Sets as many genes to 0 as leave the ratio above `keep`, with at most `tries` judgements.
[[nodiscard]] Genome shrunk(Judge& judge, const Genome& genome, AvoidSet avoid, double keep, int tries = 400);

}  // namespace halflit::adversary
