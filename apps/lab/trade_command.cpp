// halflit trade: measures time and error of one scene with many settings, and shows the errors.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/progress_line.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/process.hpp"
#include "apps/lab/trade_report.hpp"

#include <algorithm>
#include <memory>

namespace halflit::cli {
namespace {

constexpr PictureSize kTradeSize{640, 360};

struct TradeOptions : RenderOptions {
    std::string folder = "trade";
    std::vector<TradeLobe> lobes;
    int frames = 6;
    bool quick = false, all = false, progress = false;
};

TradeSpace space_of(const RenderJob& job, const TradeOptions& options) {
    const Scene& scene = job.scene();
    TradeSpace space{.shadows = options.settings.shadows, .shadow_size = job.settings.shadow_size, .lobes = options.lobes};
    space.samples = job.settings.samples, space.anisotropy = job.settings.shading.anisotropy;
    space.environment = job.light.environment != nullptr;
    space.textures = !scene.textures.empty();
    space.lights = !job.light.all_lights().empty();
    return space;
}

Result<void> write_all(const std::vector<TradeRow>& rows, const TradeBench& bench, const std::string& folder) {
    const std::pair<const char*, std::string> files[] = {{"trade.json", trade_json(rows, bench)}, {"trade.md", trade_table(rows, bench)}};
    for (const auto& [name, text] : files) {
        const std::string path = path_in(folder, name);
        if (const auto written = write_text(path, text); !written) return tl::unexpected(written.error());
        print_note("wrote " + path);
    }
    return {};
}

Result<int> run_trade(TradeOptions options) {
    if (options.quick && options.all) return fail(ErrorCode::usage, "--all: cannot be combined with --quick");
    options.settings.shading.accuracy = Accuracy::reference;  // keeps the environment's image
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    if (const auto folder = make_folder(options.folder); !folder) return tl::unexpected(folder.error());
    for (const std::string& warning : job->warnings) print_warning(warning);
    const TradeSpace space = space_of(*job, options);
    const TradeExtent extent = options.quick ? TradeExtent::quick : options.all ? TradeExtent::all : TradeExtent::usual;

    TradeBench bench(std::move(*job), space, options.frames);
    const auto rows = [&] {
        ProgressLine line(options.progress);
        return bench.measure(trade_choices(space, extent), [&](std::size_t done, std::size_t all) { line.show(done, all); });
    }();
    if (!rows) return tl::unexpected(rows.error());
    if (const auto written = write_all(*rows, bench, options.folder); !written) return tl::unexpected(written.error());
    if (const auto told = write_text("-", trade_summary(*rows, bench)); !told) return tl::unexpected(told.error());
    // A bound that does not hold is a negative result.
    return std::all_of(rows->begin(), rows->end(), [](const TradeRow& row) { return row.kept(); }) ? 0 : 1;
}

Result<void> read_lobes(std::vector<TradeLobe>& lobes, const std::string& text) {
    for (const std::string& name : words_of(text + ",", ',')) {
        const auto lobe = parse_trade_lobe(name);
        if (!lobe) return tl::unexpected(lobe.error());
        lobes.push_back(*lobe);
    }
    return {};
}

}  // namespace

Command trade_command() {
    const auto options = std::make_shared<TradeOptions>();
    TradeOptions& o = *options;
    auto groups = render_flags(o, kTradeSize);
    constexpr std::string_view kVaried[] = {"--accuracy", "--max-error", "--texture-filter", "--shading", "--sh-order"};
    remove_flags(groups, kVaried);
    groups.push_back(
        {"Comparison",
         {{"-o,--output", "DIR", "Folder for trade.json and trade.md, a table; created if missing (default trade)",
           [&o](const std::string& text) { return assign(o.folder, parse_folder(text)); }},
          {"--frames", "N", "Frames for each setting; drawn in turn with frames of exact (default 6)", read_int(o.frames, 1, 1000)},
          {"--lobes", "NAME,...", "Also measure these lobes, on every material: NAME, NAME:WRAP or NAME:WRAP:POWER",
           [&o](const std::string& text) { return read_lobes(o.lobes, text); }},
          {"--quick", "", "Vary one setting at a time", set_to(o.quick)},
          {"--all", "", "Measure all combinations, those of shadows too", set_to(o.all)},
          {"--progress", "", "Show progress even if standard error is not a terminal", set_to(o.progress)}}});
    return {"trade",
            "Measure time and error of a scene drawn with many settings",
            {scene_argument(o, true)},
            std::move(groups),
            [options] { return run_trade(*options); },
            Command::Listed::by_help_all,
            {"halflit trade model.glb --quick", "halflit trade model.glb --lobes valve,sloan:0.3 -o lobes",
             "halflit trade demo --size 320x180 --frames 9"},
            {"--output", "--frames", "--lobes", "--quick", "--all", "--size", "--view", "--threads"}};
}

}  // namespace halflit::cli
