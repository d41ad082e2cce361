// Cost of the inner functions of a frame besides light: geometry, rasterization, interpolation, textures, output. Every row on every
// instruction set that this processor has, in short slices in random order, so that other load on the machine affects all rows alike.
#include "bench/failed_run.hpp"
#include "bench/kernel_rows.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

namespace halflit::bench {
namespace {

/// Keeps the shortest of each benchmark's repetitions, because other programs can only make one longer, and prints a table.
class KernelTable : public benchmark::BenchmarkReporter {
public:
    KernelTable(const std::vector<KernelRow>& rows, const std::vector<Isa>& isas) : rows_(rows), isas_(isas) {}

    static std::string key(const KernelRow& row, Isa isa) { return row.name + "/" + std::string(isa_name(isa)); }

    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || failed(run)) continue;
            const double ns = run.cpu_accumulated_time * 1e9 / static_cast<double>(run.iterations);
            const auto [at, added] = shortest_.try_emplace(run.run_name.function_name, ns);
            if (!added) at->second = std::min(at->second, ns);
        }
    }
    void Finalize() override {
        std::string head = "| nanoseconds | a", line = "|---|---";
        for (const Isa isa : isas_) head += " | " + std::string(isa_name(isa)), line += "|---:";
        std::printf("%s |\n%s|\n", head.c_str(), line.c_str());
        for (const KernelRow& row : rows_) print(row);
    }

private:
    void print(const KernelRow& row) const {
        std::string text;
        bool measured = false;
        for (const Isa isa : isas_) {
            const auto found = shortest_.find(key(row, isa));
            char number[32] = "";
            if (found != shortest_.end()) std::snprintf(number, sizeof number, "%.3g", found->second / row.units);
            measured = measured || found != shortest_.end();
            text += std::string(" | ") + number;
        }
        if (measured) std::printf("| %s | %s%s |\n", row.name.c_str(), row.unit.c_str(), text.c_str());
    }

    const std::vector<KernelRow>& rows_;
    const std::vector<Isa>& isas_;
    std::map<std::string, double> shortest_;
};

std::vector<KernelRow> all_rows() {
    std::vector<KernelRow> rows;
    for (auto* make : {geometry_rows, rasterize_rows, texture_rows, output_rows})
        for (KernelRow& row : make()) rows.push_back(std::move(row));
    return rows;
}

/// Names are "row/set", for --benchmark_filter. The data is made when the row is first run.
void register_all(const std::vector<KernelRow>& rows, const std::vector<Isa>& isas) {
    for (const KernelRow& row : rows)
        for (const Isa isa : isas) {
            if (!row.every_set && isa != isas.back()) continue;
            const auto work = std::make_shared<std::function<void()>>();
            benchmark::RegisterBenchmark(KernelTable::key(row, isa).c_str(), [&row, isa, work](benchmark::State& state) {
                if (!*work) *work = row.prepare(isa);
                for (auto _ : state) {
                    (*work)();
                    benchmark::ClobberMemory();
                }
            });
        }
}

}  // namespace
}  // namespace halflit::bench

int main(int argc, char** argv) {
    using namespace halflit;
    using namespace halflit::bench;
    // Defaults come first: the command line overrides them.
    std::vector<char*> arguments = {argv[0]};
    std::string defaults[] = {"--benchmark_repetitions=15", "--benchmark_min_time=0.001", "--benchmark_enable_random_interleaving=true"};
    for (std::string& flag : defaults) arguments.push_back(flag.data());
    for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    std::vector<Isa> isas;
    for (const Isa isa : built_isas())
        if (isa_available(isa)) isas.push_back(isa);
    const std::vector<KernelRow> rows = all_rows();
    register_all(rows, isas);
    KernelTable table(rows, isas);
    benchmark::RunSpecifiedBenchmarks(&table);
    benchmark::Shutdown();
    return 0;
}
