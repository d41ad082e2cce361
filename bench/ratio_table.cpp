#include "bench/ratio_table.hpp"

#include "bench/failed_run.hpp"
#include "shading/fragment_block.hpp"

#include <algorithm>
#include <cstdio>

namespace halflit::bench {
namespace {

std::string key(std::size_t row, std::size_t variant, const std::string& column) {
    return std::to_string(row) + "/" + std::to_string(variant) + "/" + column;
}

std::string number(const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// Time with three digits.
std::string nanoseconds(double value) { return number(value < 1.0 ? "%.3f" : value < 10.0 ? "%.2f" : "%.1f", value); }

std::string operations_text(const Operations& operations) {
    if (operations.flops == 0) return "";
    const auto times = [](int count, const char* name) {
        return count == 0 ? std::string() : " + " + (count > 1 ? std::to_string(count) + " " : std::string()) + name;
    };
    return std::to_string(operations.flops) + times(operations.divisions, "div") + times(operations.roots, "sqrt");
}

/// One text for each variant, with slashes between them.
template <class Text>
std::string joined(std::size_t variants, const Text& text) {
    std::string all;
    for (std::size_t variant = 0; variant < variants; ++variant) all += (variant > 0 ? " / " : "") + text(variant);
    return all;
}

}  // namespace

void RatioTable::ReportRuns(const std::vector<Run>& runs) {
    for (const Run& run : runs) {
        const auto found = cells_.find(run.run_name.function_name);
        if (run.run_type != Run::RT_Iteration || failed(run) || found == cells_.end()) continue;
        const Cell& cell = found->second;
        const auto row = static_cast<std::size_t>(cell.row), variant = static_cast<std::size_t>(cell.variant);
        const double ns = run.cpu_accumulated_time * 1e9 / static_cast<double>(run.iterations);
        const double each = ns / (shading::kBlockSize * std::max(rows_[row].lights[variant], 1));
        const auto [at, added] = shortest_.try_emplace(key(row, variant, cell.column), each);
        if (!added) at->second = std::min(at->second, each);
    }
}

double RatioTable::time(std::size_t row, std::size_t variant, const std::string& column) const {
    const auto found = shortest_.find(key(row, variant, column));
    return found == shortest_.end() ? 0.0 : found->second;
}

double RatioTable::quotient(std::size_t row, std::size_t variant, const std::string& above, const std::string& below) const {
    const double divisor = time(row, variant, below);
    return divisor > 0.0 ? time(row, variant, above) / divisor : 0.0;
}

std::string RatioTable::times(std::size_t row, const std::string& column) const {
    return joined(rows_[row].lights.size(), [&](std::size_t variant) { return nanoseconds(time(row, variant, column)); });
}

std::string RatioTable::gains(std::size_t row, const std::string& column) const {
    return joined(rows_[row].lights.size(), [&](std::size_t variant) { return number("%.1f", quotient(row, variant, "scalar", column)); });
}

std::string RatioTable::prices(std::size_t row) const {
    return joined(rows_[row].lights.size(),
                  [&](std::size_t variant) { return number("%.0f", 100.0 * (quotient(row, variant, "avx2", kFused) - 1.0)); });
}

double RatioTable::flops_per_ns(const std::string& column) const {
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (const double ns = time(row, 0, column); rows_[row].work == Work::peak && ns > 0.0) return rows_[row].operations.flops / ns;
    return 0.0;
}

std::string RatioTable::share(std::size_t row) const {
    const double peak = flops_per_ns("avx2"), ns = time(row, rows_[row].lights.size() - 1, "avx2");
    if (rows_[row].operations.flops == 0 || peak == 0.0 || ns == 0.0) return "";
    return number("%.0f", 100.0 * rows_[row].operations.flops / ns / peak);
}

void RatioTable::print_line(std::size_t row) const {
    std::string line = "| " + rows_[row].name + " | " + operations_text(rows_[row].operations);
    for (const char* column : {"scalar", "sse2", "sse4.1", "avx2", "avx512"}) line += " | " + times(row, column);
    line += " | " + gains(row, "avx2") + " | " + gains(row, "avx512") + " | " + prices(row) + " | " + share(row) + " |";
    std::puts(line.c_str());
}

void RatioTable::print_misses() const {
    for (std::size_t row = 0; row < rows_.size(); ++row)
        for (std::size_t variant = 0; variant < rows_[row].lights.size(); ++variant) {
            const int lights = rows_[row].lights[variant];
            const double gain = quotient(row, variant, "scalar", "avx2"), fused = quotient(row, variant, "avx2", kFused);
            if (lights >= 4 && gain > 0.0 && gain < rows_[row].least_gain)
                std::printf("gain below %.0f: %s, %d lights: %.1f\n", rows_[row].least_gain, rows_[row].name.c_str(), lights, gain);
            if (lights != 1 && rows_[row].largest_price > 0.0 && fused > 1.0 + rows_[row].largest_price)
                std::printf("price above %.0f %%: %s, %d lights: %.0f %%\n", 100.0 * rows_[row].largest_price, rows_[row].name.c_str(),
                            lights, 100.0 * (fused - 1.0));
        }
}

void RatioTable::Finalize() {
    std::puts("Nanoseconds per fragment and light (1 / 4 / 16 lights), or per fragment. gain: time of scalar / time of the set. price of");
    std::puts("exactness: time of AVX2 / time with fused multiply-add - 1, in percent. share: part of AVX2's peak of multiplications and");
    std::puts("additions, in percent.\n");
    std::puts("| | operations | scalar | SSE2 | SSE4.1 | AVX2 | AVX-512 | gain AVX2 | gain AVX-512 | price | share |");
    std::puts("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (std::any_of(cells_.begin(), cells_.end(),
                        [&](const auto& cell) { return shortest_.count(key(row, 0, cell.second.column)) > 0; }))
            print_line(row);
    std::printf("\npeak, GFLOP/s: AVX2 %.0f, fused %.0f\n", flops_per_ns("avx2"), flops_per_ns(kFused));
    print_misses();
}

}  // namespace halflit::bench
