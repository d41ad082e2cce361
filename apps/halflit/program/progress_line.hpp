// Progress of a long run: one line on standard error, which each step overwrites and the end erases.
#pragma once

#include "apps/engine/basics/stopwatch.hpp"
#include "apps/halflit/program/engine.hpp"

#include <cstddef>
#include <string>

namespace halflit::cli {

class ProgressLine {
public:
    /// Silent unless standard error is a terminal or `always` is set, in the first `delay_ms`, and if messages are quiet.
    explicit ProgressLine(bool always, double delay_ms = 0);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// "halflit: 12 of 80, 15 %, 40 s left". The time left assumes that the other steps take as long as those since construction.
    void show(std::size_t done, std::size_t all);
    /// Erases the line, for messages.
    void clear();
    /// "halflit: 15 %, 40 s left" for a share of 0.15.
    void show(double share);

private:
    /// False if the line is silent, or was written a moment ago; `last`: this is the last step.
    bool due(bool last);
    void write(std::string line, double share);
    void overwrite(std::string line);

    bool shown_;
    double delay_ms_;
    std::size_t width_ = 0;  ///< length of the line that is shown
    Stopwatch watch_;
    double last_ms_ = -1e9;
};

}  // namespace halflit::cli
