#include "apps/engine/answers/measures_json.hpp"
#include "apps/engine/answers/part_list.hpp"
#include "apps/engine/answers/pixel_stories.hpp"
#include "apps/engine/answers/scene_description.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/compare/compare_files.hpp"
#include "apps/engine/look/look.hpp"
#include "apps/halflit/farm/picture_file.hpp"
#include "apps/halflit/mcp/tool.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace halflit::cli {
namespace {

/// Flags that only a command line has: the process's memory, its messages, and folders outside of the root.
constexpr std::string_view kNotOfTools[] = {"--max-memory", "--allow-external", "--verbose", "--quiet"};

Flag path_flag(std::string& scene) {
    return {"--path", kModelForm, "The model: a file below the server's folder; a built-in scene: demo, sphere:N", cli::read_text(scene)};
}

Flag output_flag(std::string& output) {
    return {"--output", kPictureForm, "Also write the picture: a .png, .jpg or .webp file below the server's folder",
            cli::read_text(output)};
}

Result<std::string> mime_type_of(OutputFormat format) {
    if (format == OutputFormat::png) return std::string("image/png");
    if (format == OutputFormat::jpg) return std::string("image/jpeg");
    if (format == OutputFormat::webp) return std::string("image/webp");
    return fail(ErrorCode::usage, "output: expected a .png, .jpg or .webp file");
}

/// Encodes the picture of an answer. output: a file that is written too; empty: none. inputs: files that it must not replace.
Result<ToolPicture> finish_picture(const Image& image, const std::string& output, const std::string& scene,
                                   const std::vector<std::string>& inputs) {
    const auto format = output.empty() ? Result<OutputFormat>(OutputFormat::png) : output_format_of(output);
    if (!format) return tl::unexpected(format.error());
    auto mime_type = mime_type_of(*format);
    if (!mime_type) return tl::unexpected(mime_type.error());
    auto bytes = encode_image(image, *format);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!output.empty()) {
        if (same_file(output, scene) ||
            std::any_of(inputs.begin(), inputs.end(), [&](const auto& input) { return same_file(output, input); }))
            return fail(ErrorCode::io, output + ": the scene needs it, and it is not overwritten");
        if (const auto written = io::write_file(output, *bytes); !written) return tl::unexpected(written.error());
    }
    return ToolPicture{std::move(*bytes), std::move(*mime_type)};
}

std::vector<FlagGroup> tool_flags(std::vector<Flag> own, std::vector<FlagGroup> of_command) {
    remove_flags(of_command, kNotOfTools);
    of_command.insert(of_command.begin(), {"Tool", std::move(own)});
    return of_command;
}

struct LookCall : LookOptions {
    std::string output;
    std::vector<PixelPlace> pixels;
    std::string view_of_pixel;
};

/// " (bodies 2, 5 of body_list)", those that have such edges; nothing where there is one body.
std::string bodies_with(const Json& measures, const char* edges) {
    constexpr std::size_t kMostNamed = 10;
    std::vector<std::string> numbers;
    for (const Json& body : measures["body_list"])
        if (body[edges].get<std::uint64_t>() > 0) numbers.push_back(body["number"].dump());
    if (measures["bodies"] == 1 || numbers.empty()) return "";
    const bool more = numbers.size() > kMostNamed;
    numbers.resize(std::min(numbers.size(), kMostNamed));
    return fmt::format(" ({} {}{} of body_list)", numbers.size() == 1 ? "body" : "bodies", joined(numbers, ", "), more ? " and more" : "");
}

/// What measures tell of the surface. FAULT is kept for what makes a report's `good` false.
std::vector<std::string> notes_of_measures(const Json& measures) {
    std::vector<std::string> notes;
    if (!measures.is_object()) return notes;
    const auto edges = [&](const char* key, const char* words) {
        const auto n = measures[key].get<std::uint64_t>();
        return n > 0 ? fmt::format(", {} {}{}", n, words, bodies_with(measures, key)) : std::string();
    };
    if (measures["watertight"] == false)
        notes.push_back("WARNING: not watertight" + edges("open_edges", "open edges") + edges("flipped_edges", "flipped edges") +
                        edges("crowded_edges", "edges of more than two triangles") + ": it has no volume");
    else if (measures["volume"].is_number() && measures["volume"].get<double>() < 0.0)
        notes.emplace_back("WARNING: inside out: the volume is negative, so all faces look inwards");
    else if (measures["crowded_edges"].get<std::uint64_t>() > 0)
        notes.push_back("WARNING:" + edges("crowded_edges", "edges of more than two triangles").substr(1) +
                        ": bodies touch, or faces are there twice; the volume may count twice");
    return notes;
}

std::vector<std::string> notes_of(const LookResult& result) {
    std::vector<std::string> notes;
    for (const std::string& fault : result.faults) notes.push_back("FAULT: " + fault);
    if (notes.empty()) notes.emplace_back("No faults of the views: every view shows the whole model, and every part is seen.");
    for (const std::string& note : notes_of_measures(result.report["measures"])) notes.push_back(note);
    for (const Json& warning : result.report["warnings"]) notes.push_back("WARNING: " + warning.get<std::string>());
    if (!result.certificate.empty()) notes.push_back(result.certificate);
    return notes;
}

std::string section_note(const LookCall& call, const Json& cut) {
    const auto plane = cut["plane"].get<std::size_t>();
    const auto name = cut["name"].get<std::string>();
    return fmt::format("section {}: area {:.7g}{}{}", plane < call.sections.size() ? call.sections[plane].text : std::to_string(plane),
                       cut["area"].get<double>(), name.empty() ? "" : " of " + name,
                       cut["closed"] == true ? "" : "; WARNING: its outline is open, so the area is not reliable");
}

Result<ToolAnswer> run_look_tool(const LookCall& call) {
    auto result = look(call);
    if (!result) return tl::unexpected(result.error());
    auto picture = finish_picture(*result->sheet, call.output, call.scene, result->inputs);
    if (!picture) return tl::unexpected(picture.error());
    ToolAnswer answer{notes_of(*result), std::move(result->report), std::move(*picture)};
    if (const auto sections = answer.report.find("sections"); sections != answer.report.end())
        for (const Json& cut : *sections) answer.notes.push_back(section_note(call, cut));
    return answer;
}

ToolCall look_call() {
    const auto o = std::make_shared<LookCall>();
    return {tool_flags({path_flag(o->scene), output_flag(o->output)}, look_flags(*o)), {o.get()}, [o] { return run_look_tool(*o); }};
}

Result<ToolAnswer> run_explain_tool(LookCall call) {
    call.may_want_reference = true;  // for the error
    auto job = look_job(call);
    if (!job) return tl::unexpected(job.error());
    std::vector<std::string> names;
    for (const GivenView& view : call.film.views.empty() ? usual_views() : call.film.views) names.push_back(view.name);
    std::size_t index = 0;
    if (!call.view_of_pixel.empty()) {
        const auto found = std::find(names.begin(), names.end(), call.view_of_pixel);
        if (found == names.end() || job->film.views.empty())
            return fail(ErrorCode::usage, "of: expected one of " + joined(names, ", ") + ", found '" + call.view_of_pixel + "'");
        index = static_cast<std::size_t>(found - names.begin());
    }
    if (!job->film.views.empty()) job->camera = job->film.views[index];
    (void)relight(*job, job->camera);
    auto stories = tell_pixels(*job, call.pixels);
    if (!stories) return tl::unexpected(stories.error());
    return ToolAnswer{{std::move(stories->text)}, std::move(stories->report)};
}

ToolCall explain_call() {
    const auto o = std::make_shared<LookCall>();
    const Flag of{"--of", "VIEW", "The view that has the pixels, one of `view` (default: the first)", cli::read_text(o->view_of_pixel)};
    return {tool_flags({path_flag(o->scene), pixel_flag(o->pixels), of}, look_flags(*o)), {o.get()}, [o] { return run_explain_tool(*o); }};
}

Result<ToolAnswer> run_render_tool(PictureOptions options) {
    if (options.film.several_views()) return fail(ErrorCode::usage, "view: expected one view; look draws several");
    const auto format = options.output.empty() ? Result<OutputFormat>(OutputFormat::png) : output_format_of(options.output);
    if (!format) return tl::unexpected(format.error());
    auto mime_type = mime_type_of(*format);
    if (!mime_type) return tl::unexpected(mime_type.error());
    const bool writes = !options.output.empty();
    if (!writes) options.output = "-";
    options.blank_check = true;
    auto drawn = draw_picture(options, true);
    if (!drawn) return tl::unexpected(drawn.error());
    if (writes)
        if (const auto written = write_picture(*drawn); !written) return tl::unexpected(written.error());
    ToolAnswer answer{{}, Json::parse(drawn->report), {std::move(drawn->bytes), std::move(*mime_type)}};
    answer.notes.emplace_back(drawn->blank ? "FAULT: blank: nothing is seen in the picture" : "No faults: the picture shows the model.");
    return answer;
}

ToolCall render_call() {
    const auto o = std::make_shared<PictureOptions>();
    return {tool_flags({path_flag(o->scene), output_flag(o->output)}, render_flags(*o, kRenderSize)), {o.get()}, [o] {
                return run_render_tool(*o);
            }};
}

struct CompareCall : CompareOptions {
    std::string output;
};

Result<ToolAnswer> run_compare_tool(const CompareCall& call) {
    const auto comparison = compare_files(call);
    if (!comparison) return tl::unexpected(comparison.error());
    const auto sheet = comparison_sheet(*comparison);
    if (!sheet) return tl::unexpected(sheet.error());
    auto picture = finish_picture(*sheet, call.output, call.a, {call.b});
    if (!picture) return tl::unexpected(picture.error());
    return ToolAnswer{{comparison_text(*comparison)}, comparison_json(*comparison), std::move(*picture)};
}

ToolCall compare_call() {
    const auto o = std::make_shared<CompareCall>();
    return {tool_flags({{"--a", kModelForm, "The first version: a file below the server's folder", cli::read_text(o->a)},
                        {"--b", kModelForm, "The second version", cli::read_text(o->b)},
                        output_flag(o->output)},
                       compare_flags(*o)),
            {o.get()},
            [o] { return run_compare_tool(*o); }};
}

Result<ToolAnswer> run_info_tool(const RenderOptions& options) {
    const auto job = make_render_job(options, kRenderSize);
    if (!job) return tl::unexpected(job.error());
    const auto text = describe_scene(*job, true, false);
    if (!text) return tl::unexpected(text.error());
    return ToolAnswer{{}, Json::parse(*text)};
}

Result<ToolAnswer> run_measure_tool(const RenderOptions& options) {
    const auto job = make_render_job(options, kRenderSize);
    if (!job) return tl::unexpected(job.error());
    auto measures = measures_json(*job);
    if (!measures) return tl::unexpected(measures.error());
    auto parts = parts_json(*job, true);
    if (!parts) return tl::unexpected(parts.error());
    ToolAnswer answer;
    if (measures->is_null())
        answer.notes.emplace_back("WARNING: nothing was measured: there are no triangles, or more than 2^25 by drawing meshes again");
    for (const std::string& note : notes_of_measures(*measures)) answer.notes.push_back(note);
    for (const std::string& warning : job->warnings) answer.notes.push_back("WARNING: " + warning);
    answer.report = report_head("measure");
    answer.report["scene"] = job->source.name;
    answer.report["measures"] = std::move(*measures);
    answer.report["parts"] = std::move(*parts);
    return answer;
}

template <Result<ToolAnswer> (*Run)(const RenderOptions&)>
ToolCall scene_call() {
    const auto o = std::make_shared<RenderOptions>();
    return {tool_flags({path_flag(o->scene)}, render_flags(*o, kRenderSize)), {o.get()}, [o] { return Run(*o); }};
}

}  // namespace

std::span<const Tool> all_tools() {
    static const Tool kTools[] = {
        {"look",
         "Look at a 3D model: labelled views on one sheet with dimensions, and a report of what each view shows of each part. Begin here "
         "after making or changing a model. Lines that begin with FAULT come first: a view with a fault (blank, cropped, cut, inside, "
         "tiny) must not be relied on. Takes all flags of `halflit look` by their names",
         true,
         {"path", "view", "section", "edges", "hidden-edges", "size", "perspective", "projection", "certify", "up", "output"},
         {"path"},
         look_call},
        {"render",
         "Draw one picture of a 3D model from a view or a placed camera, shaded and lit. Takes all flags of `halflit render` that decide "
         "the "
         "picture by their names",
         true,
         {"path", "view", "azimuth", "elevation", "zoom", "fov", "camera", "camera-position", "camera-target", "size", "samples",
          "background", "light", "env", "ground", "edges", "section", "up", "output"},
         {"path"},
         render_call},
        {"measure",
         "Measure a 3D model and each of its parts: box, area, volume, centre, bodies, and whether the surface is watertight",
         false,
         {"path", "section", "up"},
         {"path"},
         scene_call<run_measure_tool>},
        {"section",
         "Cut a 3D model by planes: the areas of the cuts, and a sheet of views of what is left",
         true,
         {"path", "section", "section-hatch", "view", "edges", "size", "perspective", "up", "output"},
         {"path", "section"},
         look_call},
        {"compare",
         "Compare two versions of a 3D model: pictures of both by one camera with what changed, parts, measures, and the distance of the "
         "surfaces with its bound",
         true,
         {"a", "b", "view", "max", "size", "up", "output"},
         {"a", "b"},
         compare_call},
        {"explain",
         "Tell what made a pixel of a view of `look`: part, triangle, material, lights, and what lies before and behind it. The views are "
         "those of look with the same arguments; boxes in its report are in the same pixels",
         false,
         {"path", "pixel", "of", "view", "section", "size", "perspective", "up"},
         {"path", "pixel"},
         explain_call},
        {"info",
         "Describe a 3D model's file: format, counts, names, measures, materials and what drawing it requires",
         false,
         {"path", "scene", "animation", "variant", "up"},
         {"path"},
         scene_call<run_info_tool>},
    };
    return kTools;
}

}  // namespace halflit::cli
