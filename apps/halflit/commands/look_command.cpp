// halflit look: labelled views of a model on one sheet, and a report of what they show.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/look/look.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/in_parts.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <memory>
#include <utility>

namespace halflit::cli {
namespace {

struct LookFiles : LookOptions {
    std::string output, json;
};

std::vector<std::string> inputs_of(const LookResult& result, const LookOptions& options) {
    std::vector<std::string> inputs = result.inputs;
    for (const std::string& file : {options.scene, options.environment, options.camera_file})
        if (!file.empty() && file != "-") inputs.push_back(file);
    return inputs;
}

/// Writes the pictures of all views into their folder.
Result<void> write_pictures(const LookFiles& options, const std::vector<ViewPicture>& pictures) {
    if (const auto made = make_folder(options.folder); !made) return made;
    std::vector<Result<std::vector<std::uint8_t>>> files(pictures.size());
    const std::size_t parts = io::detail::parts_of(pictures.size(), 1, options.execution.threads);
    io::detail::in_parts(pictures.size(), parts, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) files[i] = encode_image(pictures[i].picture, OutputFormat::png);
    });
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        if (!files[i]) return tl::unexpected(files[i].error());
        if (const auto written = io::write_file(pictures[i].path, *files[i]); !written) return written;
    }
    print_note(fmt::format("wrote {} pictures into {}", pictures.size(), options.folder));
    return {};
}

Result<int> look_and_write(const LookFiles& options) {
    const auto result = look(options);
    if (!result) return tl::unexpected(result.error());
    for (const std::string& warning : result->warnings) print_warning(warning);
    std::vector<std::string> outputs{options.output, options.json};
    for (const ViewPicture& picture : result->pictures) outputs.push_back(picture.path);
    for (const std::string& path : outputs)
        for (const std::string& input : inputs_of(*result, options))
            if (!path.empty() && path != "-" && same_file(path, input))
                return fail(ErrorCode::io, path + ": is read for the sheet and is not overwritten");
    if (!result->pictures.empty())
        if (const auto written = write_pictures(options, result->pictures); !written) return tl::unexpected(written.error());
    if (result->sheet) {
        Result<std::vector<std::uint8_t>> bytes = std::vector<std::uint8_t>(result->drawing.begin(), result->drawing.end());
        if (options.vectors == VectorFormat::none) {
            const auto format = output_format_of(options.output);
            if (!format) return tl::unexpected(format.error());
            bytes = encode_image(*result->sheet, *format);
        }
        if (!bytes) return tl::unexpected(bytes.error());
        if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
        if (options.output != "-") print_note(fmt::format("wrote {}, {}x{}", options.output, result->sheet->width, result->sheet->height));
    }
    if (!options.json.empty())
        if (const auto written = write_text(options.json, to_text(result->report)); !written) return tl::unexpected(written.error());
    for (const std::string& fault : result->faults) print_warning(fault);
    if (!result->certificate.empty()) print_note(result->certificate);
    return result->good ? 0 : 1;
}

Result<int> run_look(LookFiles options) {
    if (options.output.ends_with('/') || is_folder(options.output)) options.folder = std::exchange(options.output, {});
    if (options.output.empty() && options.folder.empty() && options.json.empty()) {
        const std::string stem = stem_of(options.scene);
        options.output = (options.scene == "-" || stem.empty() ? "halflit" : stem.substr(0, stem.find(':'))) + ".look.png";
    }
    if (options.output == "-" && options.json == "-") return fail(ErrorCode::usage, "--json -: cannot be combined with -o -");
    for (const std::string& path : {options.output, options.json}) {
        if (path.empty() || path == "-") continue;
        if (same_file(path, options.scene)) return fail(ErrorCode::io, path + ": is the scene itself and is not overwritten");
        if (const auto checked = check_writable(path); !checked) return tl::unexpected(checked.error());
    }
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    options.sheet = !options.output.empty();
    options.vectors = vector_format_of(options.output);
    return within_time(options.timeout_s, [&] { return look_and_write(options); });
}

}  // namespace

Command look_command() {
    const auto options = std::make_shared<LookFiles>();
    LookFiles& o = *options;
    auto groups = look_flags(o);
    std::vector<Flag>& sheet = groups.front().flags;
    sheet.insert(sheet.begin(), {{"-o,--output", "FILE|FOLDER/",
                                  "The sheet, a picture of all views: a .png, .jpg, .bmp, .tga or .webp file; a .svg or .pdf file with the "
                                  "edges as lines; - for PNG on standard output (default: SCENE's name.look.png). A folder: a PNG file "
                                  "of each view instead",
                                  read_text(o.output)},
                                 {"--json", "FILE|-",
                                  "Write a report as JSON: cameras, and what each view shows of each part; without -o, no sheet is drawn",
                                  read_text(o.json)}});
    return {"look",
            "Draw labelled views of a model on one sheet; report what each shows",
            {scene_argument(o, true)},
            std::move(groups),
            [options] { return run_look(*options); },
            Command::Listed::by_help,
            {"halflit look part.stl", "halflit look part.stl -o look.png --json look.json --view front,right,back",
             "halflit look part.stl -o cut.png --section x=50% --hidden-edges dashed"},
            {"--output", "--json", "--view", "--size", "--up", "--only", "--section", "--hidden-edges", "--perspective", "--certify"}};
}

}  // namespace halflit::cli
