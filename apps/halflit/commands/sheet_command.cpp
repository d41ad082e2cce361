// halflit sheet: draws many scenes into one picture, with names and reference pictures.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/engine/pictures/sheet_page.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/model_files.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <new>

namespace halflit::cli {
namespace {

constexpr PictureSize kSheetSize{256, 256};
constexpr int kMostColumns = 1000;

struct SheetOptions : RenderOptions {
    std::vector<std::string> scenes;
    std::string output = "sheet.png";
    std::string references;  ///< a folder, "beside", or empty
    int columns = 0;         ///< 0: chosen
};

/// The folder of a path, with "/" at its end, or empty.
std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }  // npos + 1 is 0

/// The reference picture of a scene: FOLDER/<stem>.png, or a picture beside the model or in the folder above. Empty: there is none.
std::string find_reference(const std::string& scene, const std::string& references) {
    constexpr const char* kEndings[] = {".png", ".jpg", ".jpeg"};
    const std::string stem = stem_of(scene), folder = folder_of(scene);
    std::vector<std::string> names;
    if (references != "beside") names.push_back(path_in(references, stem));
    for (const std::string& from : {folder, folder + "../"})
        for (const std::string name : {"screenshot/screenshot", "screenshot", "reference", "reference/", "screenshot/"})
            names.push_back(from + name + (name.ends_with('/') ? stem : ""));
    if (!is_file(scene) && names.size() > 1) names.resize(references != "beside" ? 1 : 0);  // a built-in scene has no folder
    for (const std::string& name : names)
        for (const char* const ending : kEndings)
            if (is_file(name + ending)) return name + ending;
    return {};
}

/// Names that tell the scenes apart: file names without extension. Files of one name have their paths, without the folders that they share.
std::vector<std::string> names_of(const std::vector<std::string>& scenes) {
    std::vector<std::string> stems, names;
    for (const std::string& scene : scenes) stems.push_back(is_file(scene) ? stem_of(scene) : scene);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        names.push_back(stems[i]);
        if (std::count(stems.begin(), stems.end(), stems[i]) == 1) continue;
        std::string shared = folder_of(scenes[i]);
        for (std::size_t k = 0; k < scenes.size(); ++k)
            while (stems[k] == stems[i] && !scenes[k].starts_with(shared)) shared = folder_of(shared.substr(0, shared.size() - 1));
        names.back() = scenes[i].substr(shared.size());
    }
    return names;
}

/// A message without the path of the scene that it is about.
std::string without_path(const std::string& message, const std::string& scene) {
    return message.starts_with(scene + ": ") ? message.substr(scene.size() + 2) : message;
}

/// Refuses to overwrite a scene, a file that one refers to, a reference or the environment.
Result<void> spare_inputs(const SheetOptions& options, const std::vector<std::string>& references) {
    if (options.output == "-") return {};
    std::vector<std::string> inputs = references;
    inputs.push_back(options.environment);
    for (const std::string& scene : options.scenes) {
        if (!is_file(scene)) continue;
        inputs.push_back(scene);
        auto files = io::files_named_by(scene, options.timed_load());
        if (!files) return tl::unexpected(files.error());
        std::move(files->begin(), files->end(), std::back_inserter(inputs));
    }
    for (const std::string& input : inputs)
        if (!input.empty() && is_file(input) && same_file(input, options.output))
            return fail(ErrorCode::io, options.output + ": is read for the sheet and is not overwritten");
    return {};
}

/// A picture, and its background.
struct Cell {
    Image image;
    Vec4f background_linear;
};

/// print_warnings: to standard error.
Result<Cell> draw(const SheetOptions& options, const std::string& name, bool print_warnings) {
    try {
        auto job = make_render_job(options);
        if (!job) return tl::unexpected(job.error());
        Image image = make_image(*job, false);
        const auto rendered =
            Renderer().render(*job->prepared, job->light, job->camera, job->settings, target_of(*job, image), job->timed_execution());
        if (!rendered) return fail(rendered.error().code, job->source.name + ": " + rendered.error().message);
        for (const auto& warnings : {job->warnings, rendered->warnings})
            for (const std::string& warning : warnings)
                if (print_warnings) print_warning(name + ": " + warning);
        return Cell{std::move(image), job->settings.background_linear};
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, name + ": out of memory");
    }
}

/// The background of most of the pictures; of two that as many have, the one that comes first.
std::optional<Vec4f> common_background(const std::vector<std::optional<Vec4f>>& backgrounds) {
    const auto uses = [&](const std::optional<Vec4f>& one) { return one ? std::count(backgrounds.begin(), backgrounds.end(), one) : 0; };
    const auto most = std::max_element(backgrounds.begin(), backgrounds.end(), [&](auto& a, auto& b) { return uses(a) < uses(b); });
    return most == backgrounds.end() ? std::nullopt : *most;
}

Result<int> run_sheet(const SheetOptions& options) {
    const auto format = output_format_of(options.output);
    if (!format) return tl::unexpected(format.error());
    if (is_linear(*format)) return fail(ErrorCode::usage, options.output + ": expected a picture of 8-bit codes (.png .jpg .bmp .tga)");
    if (options.settings.region.width > 0) return fail(ErrorCode::usage, "--region: expected whole pictures in a sheet");
    if (!options.references.empty() && options.references != "beside" && !is_folder(options.references))
        return fail(ErrorCode::io, options.references + ": expected a folder (--references)");

    std::vector<std::string> references;
    for (const std::string& scene : options.scenes)
        references.push_back(options.references.empty() ? "" : find_reference(scene, options.references));
    const bool any_reference = std::any_of(references.begin(), references.end(), [](const auto& path) { return !path.empty(); });
    const PictureSize size = options.picture_size();
    const std::vector<std::string> names = names_of(options.scenes);
    SheetLayout cells{.picture = size, .references = any_reference};
    for (const std::string& name : names)
        cells.lines = std::max(cells.lines, static_cast<int>(name_lines(name, cells.cell_width()).size()));
    const auto layout = sheet_layout(cells, options.scenes.size(), options.columns);
    if (!layout) return tl::unexpected(layout.error());
    if (const auto spared = spare_inputs(options, references); !spared) return tl::unexpected(spared.error());
    if (const auto checked = check_writable(options.output); !checked) return tl::unexpected(checked.error());
    if (options.max_memory_bytes == 0) platform::prepare_heap();

    SheetPage page(*layout);
    int code = 0;
    const auto failed = [&](const Error& error) {
        print_error(error.message);
        if (code == 0) code = static_cast<int>(error.code);
    };
    std::vector<std::optional<Vec4f>> backgrounds(options.scenes.size());
    const auto add = [&](std::size_t i, std::optional<Vec4f> background) {
        SheetOptions one = options;
        one.scene = options.scenes[i];
        if (background) one.background_linear = background;
        if (const auto cell = draw(one, names[i], !background)) {
            page.add_picture(i, cell->image, false);
            backgrounds[i] = cell->background_linear;
        } else {
            failed(cell.error());
            page.add_error(i, without_path(cell.error().message, one.scene));
        }
    };
    for (std::size_t i = 0; i < options.scenes.size(); ++i) {
        page.add_lines(i, name_lines(names[i], layout->cell_width()), Align::middle);
        add(i, std::nullopt);
        if (references[i].empty()) continue;
        const auto reference = io::read_picture(references[i]);
        if (reference)
            page.add_picture(i, scaled_to_fit(*reference, size), true);
        else
            failed(reference.error());
    }
    const std::optional<Vec4f> common = common_background(backgrounds);
    for (std::size_t i = 0; i < backgrounds.size(); ++i)
        if (backgrounds[i] && backgrounds[i] != common) add(i, common);
    const auto bytes = encode_image(page.image(), *format);
    if (!bytes) return tl::unexpected(bytes.error());
    if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
    if (options.output != "-") print_note(fmt::format("wrote {}, {}x{}", options.output, page.image().width, page.image().height));
    return code;
}

}  // namespace

Command sheet_command() {
    const auto options = std::make_shared<SheetOptions>();
    SheetOptions& o = *options;
    auto groups = render_flags(o, kSheetSize);
    groups.insert(
        groups.begin(),
        {"Sheet",
         {{"-o,--output", "FILE", fmt::format("A .png, .jpg, .bmp or .tga file; - for PNG on standard output (default {})", o.output),
           read_text(o.output)},
          {"--columns", "N", "Cells in a row (default: for a page half as wide again as high)", read_int(o.columns, 1, kMostColumns)},
          {"--references", "DIR|beside",
           "Show reference pictures: DIR/NAME.png (or .jpg) beside the picture of NAME.glb. Where there is none, and with beside, it is a "
           "picture next to the model or one folder above: screenshot/screenshot.png, screenshot.png, reference.png, reference/NAME.png",
           read_text(o.references)}}});
    Positional scenes = scene_argument(o, true);
    scenes.usage = "SCENE...";
    scenes.read = append_to(o.scenes);
    scenes.repeated = true;
    return {"sheet",
            "Draw many scenes into one picture, with their names",
            {std::move(scenes)},
            std::move(groups),
            [options]() -> Result<int> {
                auto named = with_models_named(options->scenes);
                if (!named) return tl::unexpected(named.error());
                options->scenes = *std::move(named);
                return run_sheet(*options);
            },
            Command::Listed::by_help_all,
            {"halflit sheet part.stl old.stl new.stl", "halflit sheet '*.stl' --columns 2 --size 200 -o parts.png",
             "halflit sheet model.glb demo --view front"},
            {"--output", "--columns", "--references", "--size", "--view", "--up", "--background", "--edges"}};
}

}  // namespace halflit::cli
