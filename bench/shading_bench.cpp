// Cost of shading per fragment and light: every path of the lobe and every kind of light, on every instruction set that this processor has.
// Measured in short slices in random order, so that other load on the machine affects all rows alike.
#include "bench/ratio_table.hpp"
#include "shading/kernels/isa_select.hpp"

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace halflit::bench {

HALFLIT_DECLARE_TABLES(BareKernels, bare_kernels)
#ifdef HALFLIT_FUSED
extern const BareKernels bare_kernels_avx2_fma;
#endif

}  // namespace halflit::bench

#ifdef HALFLIT_FUSED
namespace halflit::shading {
extern const ShadeKernels shade_kernels_avx2_fma;
}
#endif

namespace halflit::bench {
namespace {

struct Column {
    std::string name;
    const BareKernels* bare;
    const shading::ShadeKernels* shade;
};

const BareKernels& bare_kernels(Isa isa){HALFLIT_RETURN_TABLE_OF(isa, bare_kernels)}

std::vector<Column> columns() {
    std::vector<Column> all;
    for (const Isa isa : built_isas())
        if (isa_available(isa)) all.push_back({std::string(isa_name(isa)), &bare_kernels(isa), &shading::shade_kernels(isa)});
#ifdef HALFLIT_FUSED
    if (isa_available(Isa::avx2) && __builtin_cpu_supports("fma"))
        all.push_back({kFused, &bare_kernels_avx2_fma, &shading::shade_kernels_avx2_fma});
#endif
    return all;
}

/// Benchmark loop. A template, so that each kind of work has a loop of its own with nothing but the call in it.
template <class Call>
void repeat(benchmark::State& state, const shading::FragmentBlock& block, const Call& call) {
    for (auto _ : state) {
        call();
        benchmark::DoNotOptimize(&block);
        benchmark::ClobberMemory();
    }
}

void run(benchmark::State& state, const Column& column, const Row& row, const shading::ShadingPlan& frame) {
    shading::FragmentBlock block = filled_block();
    const int count = shading::kBlockSize;
    const shading::MaterialPlan none{};
    const shading::MaterialPlan& material = frame.materials.empty() ? none : frame.materials[0];
    alignas(64) std::uint32_t rgba8[shading::kBlockSize];
    const auto encode = [&] { column.shade->encode_srgb8(block.red, block.green, block.blue, block.alpha, 1.0f, rgba8, count); };
    const auto shade = [&] { column.shade->shade(frame, material, shading::all_lights(frame), block, count); };
    switch (row.work) {
        case Work::sum:
            return row.specular ? repeat(state, block, [&] { column.bare->sum_with_specular(frame, material, block); })
                                : repeat(state, block, [&] { column.bare->sum(frame, material, block); });
        case Work::environment:
            return repeat(state, block, [&] { column.bare->environment(frame, material, block); });
        case Work::peak:
            return repeat(state, block, [&] { column.bare->peak(frame, material, block); });
        case Work::shade:
            return repeat(state, block, shade);
        case Work::encode:
            return repeat(state, block, encode);
        case Work::pixel:
            return repeat(state, block, [&] {
                shade();
                encode();
            });
    }
}

/// Names are "row/lights/column", for --benchmark_filter.
std::map<std::string, Cell> register_all(const std::vector<Row>& rows, const std::vector<Column>& all_columns) {
    std::map<std::string, Cell> cells;
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t v = 0; v < rows[r].lights.size(); ++v)
            for (const Column& column : all_columns) {
                const std::string name = rows[r].name + "/" + std::to_string(rows[r].lights[v]) + "/" + column.name;
                cells[name] = {static_cast<int>(r), static_cast<int>(v), column.name};
                benchmark::RegisterBenchmark(name.c_str(), [&row = rows[r], &frame = rows[r].frames[v], &column](benchmark::State& state) {
                    run(state, column, row, frame);
                });
            }
    return cells;
}

}  // namespace
}  // namespace halflit::bench

int main(int argc, char** argv) {
    using namespace halflit::bench;
    // Defaults come first: the command line overrides them.
    std::vector<char*> arguments;
    arguments.push_back(argv[0]);
    std::string defaults[] = {"--benchmark_repetitions=15", "--benchmark_min_time=0.001", "--benchmark_enable_random_interleaving=true"};
    for (std::string& flag : defaults) arguments.push_back(flag.data());
    for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    const std::vector<Row> rows = shading_rows();
    const std::vector<Column> all_columns = columns();
    RatioTable table(rows, register_all(rows, all_columns));
    benchmark::RunSpecifiedBenchmarks(&table);
    benchmark::Shutdown();
    return 0;
}
