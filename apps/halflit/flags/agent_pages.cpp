#include "apps/halflit/flags/agent_pages.hpp"

#include "apps/halflit/flags/help_text.hpp"
#include "apps/halflit/flags/manual.hpp"

#include <algorithm>
#include <string_view>

namespace halflit::cli {
namespace {

constexpr std::string_view kSkillHead =
    R"(---
name: halflit
description: Look at 3D models (glTF, STL, PLY, OBJ, OFF, 3MF) from the command line or over MCP. Use it after making or changing )"
    R"(a model, to see it from labelled sides, to find blank, cropped or hidden things, to measure, cut and explain, and to compare )"
    R"(versions.
---

# halflit for agents

Look at a model after each change of it, before you say that it is right. A picture alone can mislead: it may be blank, cropped, or hide the
part that is wrong. So every look gives a report with the picture. Read its faults first.

This page is the output of `halflit flags --skill`; a test compares the two, and runs the command lines.

## Look
    halflit look part.stl --json look.json -o look.png

The sheet has the views front, right, top and iso at one scale, with dimensions, axes and a scale bar. The exit code is 0 if every view is
good, 1 if one has a fault, and 2 or more if nothing could be drawn. Then an error is one line on standard error.

Keys of the report:

| key | says |
|---|---|
| `good` | false: at least one view has a fault |
| `views[].faults` | why the view must not be relied on; empty is good |
| `views[].parts[]` | each part that the view shows: `pixels`, `box` as x, y, width and height in the view's own picture, )"
    R"(`pixels_alone` without the others, and `hidden_by`, the part that hides most of it |
| `parts[].seen_in` | names of the views that show the part |
| `never_seen` | numbers of parts that no view shows; numbers begin at 1 |
| `measures` | box, area, volume, `watertight`, `open_edges` of the whole model, in the file's unit; `bodies` counts them, )"
    R"(`body_list` has box, centre and edges of each |
| `removed_by_section` | numbers of parts that `--section` removes wholly; no view can show them |
| `sections` | with `--section`: area of each cut, and whether its outline is closed |
| `certificate` | with `--certify`: which triangles were seen |

| fault | means | try |
|---|---|---|
| `blank` | no pixel shows the model | another view; `halflit info` tells whether the file has triangles |
| `cropped` | the model reaches beyond the picture | drop `--zoom` and a placed camera |
| `cut` | the model reaches before or behind the camera's planes | move the camera away |
| `inside` | the camera is inside the model's box | move the camera away |
| `tiny` | what is seen spans less than a sixth of the picture's width and height | `--fit 20`, or look for a part far away |

## Recipes
)";

struct Recipe {
    const char *title, *text, *lines;
};

/// The lines are run by a test, with small models of these names.
constexpr Recipe kRecipes[] = {
    {"Check a part that was generated",
     "Look, and read `good`, `measures.size` and `measures.watertight`. A part to be printed must be watertight, of positive volume (a "
     "negative one is inside out), without `crowded_edges` (faces that are there twice). `bodies` counts closed surfaces: a cavity is one "
     "too. `body_list` tells where each lies: one that floats is beside the others. Then certify: views are added until each triangle was "
     "seen, or is known to be hidden.",
     "halflit look part.stl --json look.json -o look.png\n"
     "halflit look part.stl --json certificate.json --certify 4"},
    {"Find hidden parts",
     "Read `never_seen`, and `hidden_by` of each part. A section shows what is inside; dashed lines show hidden edges.",
     "halflit look assembly.gltf --json look.json -o look.png --hidden-edges dashed\n"
     "halflit look assembly.gltf --json cut.json -o cut.png --section x=50%"},
    {"Measure a cross-section",
     "`sections` has the area of each cut, in the file's unit. Axes are those of the file. `z=50%` keeps what is below the middle, "
     "`--section=-z=50%` what is above.",
     "halflit look part.stl --json cut.json -o cut.png --section z=50%"},
    {"Compare two versions",
     "The page and the report say what changed: pixels by what changed in them, parts, measures, and the distance of the surfaces. The "
     "exit "
     "code is 1 if they differ. Read `unseen` too: a change that moves no surface, such as a face that is turned, changes no pixel, but "
     "the "
     "numbers of edges.",
     "halflit compare old.stl new.stl -o changes --json compare.json --markdown comment.md"},
    {"Look from where it matters", "A side by its name, or by azimuth and elevation in degrees: 0,0 is the front, 90,0 the right side.",
     "halflit look part.stl -o sides.png --view back,bottom,left --json sides.json\n"
     "halflit part.stl close.png --view 30,40 --zoom 2"},
    {"Ask about a pixel", "Why it has its colour: the triangle, its part and material, each light, and what lies before and behind it.",
     "halflit explain part.stl --pixel 640,360"},
};

constexpr std::string_view kSkillTail = R"(
Most models of CAD have z up; STL and 3MF are read so. `--up z` says it for others. Pictures have the same bits on every machine, so a
changed pixel is a change of the model or of the flags.

## The server
    halflit mcp --root . --max-memory 4096

speaks the Model Context Protocol on standard input and output. An argument has the name of the flag: `"hidden-edges": "dashed"`. Paths are
relative to the root. Text of an answer begins with the faults; then comes the report, then the picture. The report is one line of JSON, by
docs/answers. It has at most 60 kB: `left_out` counts what long lists lack; with `--json FILE` the command writes them whole.
The server keeps the )"
                                        R"(last models, so
that a second call on the same file is faster, and loads a file anew when it has changed. It writes nothing but what `output` names.

| tool | |
|---|---|
)";

struct Document {
    const char *path, *help;
};

constexpr Document kDocuments[] = {
    {"README.md", "What halflit is, how to build it, and how to use it"},
    {"docs/SKILL.md", "How an agent uses the program: when to look, how to read reports, recipes"},
    {"docs/flags.md", "All commands and flags"},
    {"docs/commands.md", "The commands, and their exit codes"},
    {"docs/install.md", "The files of a release, and how each is installed"},
    {"docs/pictures.md", "What the program chooses for a picture; light, poses, planes beside the picture"},
    {"docs/views.md", "Views, drawings, sections, labelled sheets, and two versions compared"},
    {"docs/films.md", "Moving pictures, and many models in one run"},
    {"docs/window.md", "The window, and the page for browsers"},
    {"docs/agents.md", "The server of the Model Context Protocol"},
    {"docs/recipes.md", "Thumbnails in a service, tests in CI, data sets, slicers, games, workers"},
    {"docs/migration.md", "From pyrender and from f3d"},
    {"docs/mujoco.md", "Pictures of MuJoCo's classic renderer, in Python, without a GPU"},
    {"docs/formats.md", "Formats and extensions that are read, and what is not drawn"},
    {"docs/troubleshooting.md", "Messages of the program, each with its cause and cure"},
    {"docs/price_of_speed.md", "Settings that are faster, and what each costs in error"},
    {"docs/speed.md", "Speed against another renderer; processors, systems, compilers, libraries"},
    {"docs/same_pixels.md", "How every machine draws the same pixels"},
    {"docs/course.md", "The theory in seven lessons: lobes, spherical harmonics, terminators, bounds"},
    {"docs/report.md", "Reports as JSON: what each key means"},
    {"docs/golden.md", "Expected pictures in continuous integration"},
    {"docs/farm.md", "Films, many files and large pictures on many machines"},
    {"SECURITY.md", "What is promised of files from strangers, and how to limit time and memory"},
};
constexpr Document kLibrary[] = {
    {"docs/library.md", "Embedding: CMake, pkg-config, headers, programs to copy from, Python"},
    {"docs/reference.md", "The public names in C++ and C"},
    {"apps/io/README.md", "Reading models and pictures; formats"},
    {"apps/python/README.md", "The Python package"},
    {"apps/examples/README.md", "Short programs to copy from"},
};
constexpr Document kInside[] = {
    {"CONTRIBUTING.md", "Rules, tests and recipes for changes"},
    {"docs/source_tree.md", "Which folder holds what"},
    {"apps/README.md", "The programs: files, flags, formats"},
    {"raster/README.md", "Which fragments are visible, and the steps of a frame"},
    {"shading/README.md", "The colour of a fragment: materials, lights, lobes, bounds on errors"},
    {"sh/README.md", "The mathematics, and the literature"},
};

std::string section_of(const char* title, std::span<const Document> documents) {
    std::string text = std::string("\n## ") + title + "\n";
    for (const Document& document : documents)
        text += std::string("- [") + document.path + "](" + document.path + "): " + document.help + "\n";
    return text;
}

std::string indented(std::string_view lines) {
    std::string text = "    ";
    for (const char c : lines) text += c == '\n' ? std::string("\n    ") : std::string(1, c);
    return text + "\n";
}

/// Titles of groups that an agent needs of look; all flags are in docs/flags.md.
constexpr std::string_view kLookGroups[] = {"Sheet", "Section", "Lines"};

}  // namespace

std::string skill_page(std::span<const Command> commands, std::span<const NamedHelp> tools) {
    std::string text(kSkillHead);
    for (const Recipe& recipe : kRecipes)
        text += std::string("### ") + recipe.title + "\n" + recipe.text + "\n\n" + indented(recipe.lines) + "\n";
    text += "## Flags of look\n| flag | |\n|---|---|\n";
    for (const Command& command : commands)
        for (const FlagGroup& group : command.groups)
            if (command.name == "look" && std::find(std::begin(kLookGroups), std::end(kLookGroups), group.title) != std::end(kLookGroups))
                for (const Flag& flag : group.flags) text += markdown_row(flag_label(flag), flag.help);
    text += "\nAll flags of pictures count too ([flags.md](flags.md)).\n";
    text += kSkillTail;
    for (const NamedHelp& tool : tools) text += markdown_row(tool.name, tool.help);
    text += "\n## Commands\n| command | |\n|---|---|\n";
    for (const Command& command : commands)
        if (!command.is_hidden()) text += markdown_row("halflit " + command.name, command.help);
    return text + "\n" + kExitCodesHelp + "\n";
}

std::string llms_page(std::span<const Command> commands) {
    std::string text = std::string("# halflit\n\n> ") + kProgramHelp +
                       " A library for C++, C and Python, a command line, and a server of the Model Context Protocol. The same pixels on "
                       "every machine.\n\nThis page is the output of `halflit flags --llms`; a test compares the two.\n";
    text += section_of("Use", kDocuments) + section_of("Libraries", kLibrary) + "\n## Commands\n";
    for (const Command& command : commands)
        if (!command.is_hidden())
            text += "- [halflit " + command.name + "](docs/flags.md#halflit-" + command.name + "): " + command.help + "\n";
    return text + section_of("Inside", kInside);
}

}  // namespace halflit::cli
