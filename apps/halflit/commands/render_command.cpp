// halflit render: draws a scene into a picture.
#include "apps/engine/answers/run_report.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/farm/render_film.hpp"
#include "apps/halflit/farm/render_line.hpp"
#include "apps/halflit/farm/render_many.hpp"
#include "apps/halflit/program/interrupt.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/platform/process.hpp"

#include <memory>
#include <string>

namespace halflit::cli {
namespace {

Result<int> render_scene(PictureOptions options) {
    const std::string& scene = options.scene;
    io::begin_file_set();
    if (options.output.empty()) options.output = default_output(scene, options.format);
    const bool may_report = check_paths(options).has_value();
    if (may_report && !options.report.empty())
        set_last_words([path = options.report, scene](int signal) {
            (void)write_text(path, error_report(scene, 128 + signal, "interrupted by signal " + std::to_string(signal)));
        });
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    Result<PictureFile> done = draw_picture(options);
    if (done)
        if (const auto written = write_picture(*done); !written) done = tl::unexpected(written.error());
    const std::string report = done ? done->report : error_report(scene, static_cast<int>(done.error().code), done.error().message);
    // A path that is an input's or the picture's was refused.
    if (may_report && !options.report.empty()) {
        const Result<void> written = write_text(options.report, report);
        if (!written && done) return tl::unexpected(written.error());
    }
    if (!done) return tl::unexpected(done.error());
    return done->blank ? 1 : 0;
}

Result<int> run_render(RenderLine line) {
    const auto kind = settle(line);
    if (!kind) return tl::unexpected(kind.error());
    if (*kind != RenderKind::film && line.film.quality)
        print_note("quality: full, as measuring takes longer than it saves in one picture of a scene");
    if (*kind == RenderKind::many) return render_many({line, line.words, line.skip_existing});
    line.scene = line.words.empty() ? "" : line.words[0];
    return *kind == RenderKind::film ? render_film(line, line.skip_existing) : render_scene(line);
}

}  // namespace

Command render_command() {
    const auto line = std::make_shared<RenderLine>();
    Command command = render_table(*line);
    command.run = [line] { return run_render(*line); };
    return command;
}

}  // namespace halflit::cli
