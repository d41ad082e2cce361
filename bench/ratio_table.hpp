// Table of times and ratios, made from repeated and interleaved measurements.
#pragma once

#include "bench/shading_rows.hpp"

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace halflit::bench {

/// Place of a benchmark in the table.
struct Cell {
    int row = 0, variant = 0;
    std::string column;  ///< an instruction set's name, or kFused
};
inline constexpr const char* kFused = "avx2+fma";

/// Keeps the shortest of each benchmark's repetitions, because other programs can only make one longer. Ratios are those of the minima.
class RatioTable : public benchmark::BenchmarkReporter {
public:
    RatioTable(const std::vector<Row>& rows, std::map<std::string, Cell> cells) : rows_(rows), cells_(std::move(cells)) {}

    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    /// Nanoseconds per fragment (and light); 0 if not measured.
    double time(std::size_t row, std::size_t variant, const std::string& column) const;
    double quotient(std::size_t row, std::size_t variant, const std::string& above, const std::string& below) const;
    std::string times(std::size_t row, const std::string& column) const;
    std::string gains(std::size_t row, const std::string& column) const;
    std::string prices(std::size_t row) const;
    std::string share(std::size_t row) const;
    double flops_per_ns(const std::string& column) const;  ///< rate of the peak row
    void print_line(std::size_t row) const;
    void print_misses() const;

    const std::vector<Row>& rows_;
    std::map<std::string, Cell> cells_;
    std::map<std::string, double> shortest_;  ///< by row, variant and column
};

}  // namespace halflit::bench
