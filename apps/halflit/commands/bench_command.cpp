// halflit bench: the time of a frame, from a scene in memory to 8-bit codes in memory.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/median.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace halflit::cli {
namespace {

constexpr PictureSize kBenchSize{1920, 1080};

struct BenchOptions : RenderOptions {
    int frames = 10;
    bool keep = false, encode = false, json = false;
};

struct Measured {
    std::vector<double> ms;
    RenderReport fastest;  ///< gives the reported times of stages
};

/// Draws all frames with one Renderer, so that its memory is allocated from the second frame on. Each frame is drawn completely, as if the
/// scene had moved. With `keep`, frames after the first reuse what did not change; for a scene at rest that is everything but the tiles.
Result<Measured> measure(const RenderJob& job, int frames, bool keep, Image& image) {
    Measured measured;
    Renderer renderer;
    for (int i = 0; i < frames; ++i) {
        if (!keep) renderer.forget_frames();
        const Stopwatch watch;
        const auto rendered =
            renderer.render(*job.prepared, job.light, job.camera, job.settings, target_of(job, image), job.timed_execution());
        const double ms = watch.ms();
        if (!rendered) return tl::unexpected(rendered.error());
        if (measured.ms.empty() || ms < *std::min_element(measured.ms.begin(), measured.ms.end())) measured.fastest = *rendered;
        measured.ms.push_back(ms);
    }
    return measured;
}

std::string table(const Json& report) {
    std::string text = fmt::format("{} frames of {}x{}, {}, {} threads\n", report["frames"].get<int>(), report["size"][0].get<int>(),
                                   report["size"][1].get<int>(), report["isa"].get<std::string>(), report["threads"].get<int>());
    text += fmt::format("  min     {:10.3f} ms, of which\n", report["min_ms"].get<double>());
    for (const auto& [stage, ms] : report["stages"].items()) text += fmt::format("    {:<10}{:6.3f} ms\n", stage, ms.get<double>());
    const double frames_a_second = 1e3 / std::max(report["median_ms"].get<double>(), 1e-6);
    const auto millions_a_second = [&](double count) { return count * frames_a_second / 1e6; };
    text += fmt::format("  median  {:10.3f} ms: {:.1f} frames, {:.1f} million pixels, {:.1f} million triangles a second\n",
                        report["median_ms"].get<double>(), frames_a_second,
                        millions_a_second(report["size"][0].get<double>() * report["size"][1].get<double>()),
                        millions_a_second(report["triangles_submitted"].get<double>()));
    text +=
        fmt::format("  load    {:10.3f} ms\n  prepare {:10.3f} ms\n", report["load_ms"].get<double>(), report["prepare_ms"].get<double>());
    if (report.contains("encode_ms")) text += fmt::format("  encode  {:10.3f} ms (PNG)\n", report["encode_ms"].get<double>());
    return text;
}

Result<double> encoding_ms(const Image& image) {
    const Stopwatch watch;
    const auto bytes = encode_image(image, OutputFormat::png);
    if (!bytes) return tl::unexpected(bytes.error());
    return watch.ms();
}

Result<int> run_bench(const BenchOptions& options) {
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    const auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    Image image = make_image(*job, false);
    const auto measured = measure(*job, options.frames, options.keep, image);
    if (!measured) return tl::unexpected(measured.error());
    for (const std::string& warning : job->warnings) print_warning(warning);

    Json report = report_head("bench");
    report["scene"] = options.scene;
    report["frames"] = options.frames;
    report["min_ms"] = *std::min_element(measured->ms.begin(), measured->ms.end());
    report["median_ms"] = median(measured->ms);
    add_frame(report, *job, measured->fastest, image);
    if (options.encode) {
        const auto encode_ms = encoding_ms(image);
        if (!encode_ms) return tl::unexpected(encode_ms.error());
        report["encode_ms"] = *encode_ms;
    }
    const std::string text = options.json ? to_text(report) : table(report);
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command bench_command() {
    const auto options = std::make_shared<BenchOptions>();
    auto groups = render_flags(*options, kBenchSize);
    groups.push_back({"Measurement",
                      {{"--frames", "N", "Number of frames (default 10)", read_int(options->frames, 1, 1000000)},
                       {"--keep", "", "Reuse what the frame before computed; as for a scene at rest", set_to(options->keep)},
                       {"--encode", "", "Also time the encoding of the picture as PNG", set_to(options->encode)},
                       {"--json", "", "Print one JSON object", set_to(options->json)}}});
    return {"bench",
            "Time the drawing of a scene, from the scene in memory to 8-bit codes in memory",
            {scene_argument(*options, true)},
            std::move(groups),
            [options] { return run_bench(*options); },
            Command::Listed::by_help_all,
            {"halflit bench model.glb", "halflit bench model.glb --frames 50 --size 640x360 --threads 1",
             "halflit bench demo --samples 1 --json"},
            {"--frames", "--keep", "--encode", "--json", "--size", "--view", "--samples", "--max-error", "--threads", "--isa"}};
}

}  // namespace halflit::cli
