// How far a long run is: one line on standard error that is written over again and again, and gone at the end.
#pragma once

#include "apps/halflit/stopwatch.hpp"

#include <cstddef>
#include <string>

namespace halflit::cli {

class ProgressLine {
public:
    /// Silent unless standard error is a terminal or `always` is set.
    explicit ProgressLine(bool always);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// "halflit: 12 of 80, 15 %, 40 s left". What is left is told from the steps since the first call's.
    void show(std::size_t done, std::size_t all);

private:
    void write(std::string line);

    bool shown_;
    std::size_t width_ = 0;  ///< of the line that stands there
    Stopwatch watch_;
    double last_ms_ = -1e9;
};

}  // namespace halflit::cli
