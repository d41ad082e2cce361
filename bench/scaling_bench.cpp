// Time and memory of whole frames over one property at a time: triangles, pixels, lights, layers, size of textures, threads.
//
//     halflit_scaling_bench [AXIS...]      all axes, in three minutes
//
// Each row has a process of its own. A frame is drawn as if everything had moved; the shortest counts. Memory is the most that preparing
// the scene and drawing it takes, picture included, beside the scene itself.
#include "bench/peer/child.hpp"
#include "bench/peer/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

using namespace halflit;
using namespace halflit::peer;

namespace {

struct Size {
    int width, height;
};
constexpr Size kUsual = {1920, 1080};

/// What a row draws.
struct Row {
    std::function<BenchScene(float)> make;  ///< from the picture's width / height
    Size size = kUsual;
    int threads = 1;
    double count = 1;   ///< of what the axis counts
    double pieces = 1;  ///< that a frame's time is divided by
};

struct Cost {
    double ms = 0, mb = 0;
    int frames = 0;
};

Cost measure(const Row& row) {
    constexpr int kMostFrames = 15, kFewestFrames = 3;
    constexpr double kEnough = 1500;  // ms
    const BenchScene bench = row.make(static_cast<float>(row.size.width) / static_cast<float>(row.size.height));
    reset_peak_memory();
    const double before_mb = resident_mb();
    Cost cost;
    const auto prepared = PreparedScene::make(bench.scene, {.threads = row.threads});
    if (!prepared) return cost;
    std::vector<std::uint8_t> rgba8(std::size_t{4} * static_cast<std::size_t>(row.size.width) * static_cast<std::size_t>(row.size.height));
    Renderer renderer;
    const double start = now_ms(Clock::wall);
    double at = start;
    while (cost.frames < kMostFrames && (cost.frames < kFewestFrames || at - start < kEnough)) {
        renderer.forget_frames();
        const auto report = renderer.render(*prepared, bench.camera, bench_settings(1), {row.size.width, row.size.height, rgba8.data()},
                                            {.threads = row.threads});
        if (!report) return {};
        const double now = now_ms(Clock::wall);
        cost.ms = cost.frames++ == 0 ? now - at : std::min(cost.ms, now - at);
        at = now;
    }
    cost.mb = peak_mb() - before_mb;
    return cost;
}

struct Axis {
    std::string_view name, head, piece;  ///< piece: what a nanosecond figure is for
    std::vector<Row> rows;
};

int processors() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

double pixels_of(Size size) { return static_cast<double>(size.width) * size.height; }

/// A row whose pieces are `layers` layers, or lights, of all pixels.
Row squares(const Squares& what, double count, double layers, Size size = kUsual) {
    return {[what](float aspect) { return make_squares_scene(what, aspect); }, size, processors(), count, layers * pixels_of(size)};
}

std::vector<Axis> axes() {
    std::vector<Axis> all;
    Axis triangles{"triangles", "a sphere, 2 lights", "triangle", {}};
    for (double n = 1e3; n < 2e7; n *= std::sqrt(10.0))
        triangles.rows.push_back(
            {[n](float) { return make_sphere_scene(std::llround(n)); }, kUsual, processors(), std::round(n), std::round(n)});
    all.push_back(triangles);
    Axis pixels{"pixels", "a textured square, 8 lights", "pixel", {}};
    for (const Size size : {Size{426, 240}, {854, 480}, {1280, 720}, {1920, 1080}, {3840, 2160}, {7680, 4320}})
        pixels.rows.push_back(squares({}, pixels_of(size), 1, size));
    all.push_back(pixels);
    Axis lamps{"lamps", "a textured square", "pixel and light", {}};
    for (int n = 1; n <= 1024; n *= 4) lamps.rows.push_back(squares({.lamps = n}, n, n));
    all.push_back(lamps);
    Axis layers{"layers", "textured squares, the farthest first, 8 lights", "pixel and layer", {}};
    for (int n = 1; n <= 64; n *= 2) layers.rows.push_back(squares({.layers = n}, n, n));
    all.push_back(layers);
    Axis textures{
        "texels", "a square, 8 lights, two textures of this many texels on a side, repeated so that texels are equally large", "pixel", {}};
    for (int n = 16; n <= 8192; n *= 2) textures.rows.push_back(squares({.texture_side = n}, n, 1));
    all.push_back(textures);
    Axis threads{"threads", "a textured square, 8 lights", "pixel, time times threads", {}};
    for (int n = 1; n <= processors(); n *= 2) {
        threads.rows.push_back(squares({}, n, 1.0 / n));
        threads.rows.back().threads = n;
    }
    all.push_back(threads);
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<Axis> all = axes();
    for (int i = 1; i < argc; ++i) {
        if (std::any_of(all.begin(), all.end(), [&](const Axis& axis) { return axis.name == argv[i]; })) continue;
        std::fprintf(stderr, "scaling bench: unknown axis %s, expected some of", argv[i]);
        for (const Axis& axis : all) std::fprintf(stderr, " %s", std::string(axis.name).c_str());
        std::fprintf(stderr, "\n");
        return 2;
    }
    for (const Axis& axis : all) {
        const auto asked = [&](const char* name) { return axis.name == name; };
        if (argc > 1 && std::none_of(argv + 1, argv + argc, asked)) continue;
        std::printf("\n| %s: %s | ms | ns per %s | MB |\n|---:|---:|---:|---:|\n", std::string(axis.name).c_str(),
                    std::string(axis.head).c_str(), std::string(axis.piece).c_str());
        for (const Row& row : axis.rows) {
            const auto cost = in_child([&] { return measure(row); });
            if (!cost || cost->frames == 0) return std::fprintf(stderr, "scaling bench: a frame failed\n"), 1;
            std::printf("| %.0f | %.3g | %.3g | %.3g |\n", row.count, cost->ms, 1e6 * cost->ms / row.pieces, cost->mb);
            std::fflush(stdout);
        }
    }
    return 0;
}
