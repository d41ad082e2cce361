// halflit figures: remakes figures of the literature.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/flags/message_flags.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/lab/figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace halflit::cli {
namespace {

struct FiguresOptions {
    std::vector<std::string> names;  ///< empty: all
    std::string folder = "figures";
    FigureFormat format = FigureFormat::svg;
    bool list = false;
};

Result<void> write_list() {
    std::string text;
    for (const FigureEntry& entry : all_figures()) text += fmt::format("{:<15} {}; {}\n", entry.name, entry.title, entry.source);
    return write_text("-", text);
}

Result<const FigureEntry*> entry_named(const std::string& name) {
    std::vector<std::string> known;
    for (const FigureEntry& entry : all_figures()) {
        if (name == entry.name) return &entry;
        known.emplace_back(entry.name);
    }
    return fail(ErrorCode::usage,
                fmt::format("NAME: expected one of {}; found '{}'{}", joined(known, ", "), printable(name), did_you_mean(name, known)));
}

/// Every name is checked before anything is made; a name that is given twice counts once.
Result<std::vector<const FigureEntry*>> chosen_entries(const std::vector<std::string>& names) {
    std::vector<const FigureEntry*> entries;
    for (const std::string& name : names) {
        const auto entry = entry_named(name);
        if (!entry) return tl::unexpected(entry.error());
        if (std::find(entries.begin(), entries.end(), *entry) == entries.end()) entries.push_back(*entry);
    }
    if (names.empty())
        for (const FigureEntry& entry : all_figures()) entries.push_back(&entry);
    return entries;
}

Result<MadeFigure> make_and_write(const FigureEntry& entry, const FiguresOptions& options) {
    const auto figure = entry.make();
    if (!figure) return tl::unexpected(figure.error());
    const auto files = figure_files(entry, *figure, options.format);
    if (!files) return tl::unexpected(files.error());
    MadeFigure made{&entry, figure->caption, {}};
    for (const FigureFile& file : *files) {
        const std::string path = path_in(options.folder, file.name);
        if (const auto written = io::write_file(path, file.bytes); !written) return tl::unexpected(written.error());
        print_note("wrote " + path);
        made.files.push_back(file.name);
    }
    return made;
}

Result<int> run_figures(const FiguresOptions& options) {
    if (options.list) {
        if (const auto written = write_list(); !written) return tl::unexpected(written.error());
        return 0;
    }
    const auto entries = chosen_entries(options.names);
    if (!entries) return tl::unexpected(entries.error());
    if (const auto folder = make_folder(options.folder); !folder) return tl::unexpected(folder.error());
    std::vector<MadeFigure> made;
    for (const FigureEntry* entry : *entries) {
        auto figure = make_and_write(*entry, options);
        if (!figure) return tl::unexpected(figure.error());
        made.push_back(std::move(*figure));
    }
    if (options.names.empty()) {
        const std::string path = path_in(options.folder, "index.html");
        if (const auto written = write_text(path, figure_index(made)); !written) return tl::unexpected(written.error());
        print_note("wrote " + path);
    }
    return 0;
}

}  // namespace

Command figures_command() {
    const auto options = std::make_shared<FiguresOptions>();
    FiguresOptions& o = *options;
    const auto read_format = [&o](const std::string& text) -> Result<void> {
        if (text != "svg" && text != "png") return fail(ErrorCode::usage, "expected svg or png, found '" + printable(text) + "'");
        o.format = text == "svg" ? FigureFormat::svg : FigureFormat::png;
        return {};
    };
    return {"figures",
            "Remake the figures of the literature, with captions that say what was computed",
            {{.name = "NAME",
              .help = "Figures to make (see --list); without a name, all of them and an index.html",
              .read = append_to(o.names),
              .repeated = true}},
            {{"Flags",
              {{"-o,--output", "DIR", "Folder for the files; created if missing (default figures)",
                [&o](const std::string& text) { return assign(o.folder, parse_folder(text)); }},
               {"--format", "svg|png",
                "svg: a page of pictures and plots with labels and caption (default); png: one sheet of pictures without text, plots as "
                "SVG",
                read_format},
               {"--list", "", "List all figures and their sources", set_to(o.list)}}},
             {"Messages", message_flags()}},
            [options] { return run_figures(*options); }};
}

}  // namespace halflit::cli
