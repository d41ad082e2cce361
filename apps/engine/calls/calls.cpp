#include "apps/engine/answers/measures_json.hpp"
#include "apps/engine/answers/part_list.hpp"
#include "apps/engine/answers/pixel_stories.hpp"
#include "apps/engine/answers/scene_description.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/calls/call.hpp"
#include "apps/engine/compare/compare_files.hpp"
#include "apps/engine/job/picture_judgement.hpp"
#include "apps/engine/look/look.hpp"
#include "apps/engine/request/request_check.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace halflit::engine {
namespace {

/// Flags that only a command line has: the process's memory, its messages, and folders outside of the root.
constexpr std::string_view kOfProcesses[] = {"--max-memory", "--allow-external", "--verbose", "--quiet"};

Flag path_flag(std::string& scene) {
    return {"--path", kModelForm, "The model: a file below the server's folder; a built-in scene: demo, sphere:N",
            engine::read_text(scene)};
}

std::vector<FlagGroup> call_flags(std::vector<Flag> own, std::vector<FlagGroup> of_command) {
    remove_flags(of_command, kOfProcesses);
    of_command.insert(of_command.begin(), {"Call", std::move(own)});
    return of_command;
}

constexpr int kCertifiedPixels = 1;  // a triangle counts as seen by one pixel

struct LookCall : LookOptions {
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

/// Warnings about the surface that follow from measures. FAULT is kept for what makes a report's `good` false.
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

Result<Answer> run_look(const LookCall& call) {
    auto result = look(call);
    if (!result) return tl::unexpected(result.error());
    Answer answer{notes_of(*result), std::move(result->report), std::move(result->sheet), std::move(result->inputs), result->good};
    answer.inputs.push_back(call.scene);
    if (const auto sections = answer.report.find("sections"); sections != answer.report.end())
        for (const Json& cut : *sections) answer.notes.push_back(section_note(call, cut));
    return answer;
}

Call look_call() {
    const auto o = std::make_shared<LookCall>();
    return {call_flags({path_flag(o->scene)}, look_flags(*o)), {o.get()}, [o] { return run_look(*o); }};
}

Call certify_call() {
    const auto o = std::make_shared<LookCall>();
    o->certify = kCertifiedPixels;
    o->sheet = false;
    return {call_flags({path_flag(o->scene)}, look_flags(*o)), {o.get()}, [o] { return run_look(*o); }};
}

struct ExplainCall : RenderOptions {
    std::vector<PixelPlace> pixels;
};

Result<Answer> run_explain(const ExplainCall& call) {
    auto stories = explain(call, call.pixels);
    if (!stories) return tl::unexpected(stories.error());
    return Answer{{std::move(stories->text)}, std::move(stories->report)};
}

Call explain_call() {
    const auto o = std::make_shared<ExplainCall>();
    auto groups = call_flags({path_flag(o->scene), pixel_flag(o->pixels)}, render_flags(*o, kRenderSize));
    constexpr std::string_view kLeftOut[] = {"--region"};
    remove_flags(groups, kLeftOut);
    return {std::move(groups), {o.get()}, [o] { return run_explain(*o); }};
}

Result<Answer> run_explain_view(LookCall call) {
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
    return Answer{{std::move(stories->text)}, std::move(stories->report)};
}

Call explain_view_call() {
    const auto o = std::make_shared<LookCall>();
    const Flag of{"--of", "VIEW", "The view that has the pixels, one of `view` (default: the first)", engine::read_text(o->view_of_pixel)};
    return {call_flags({path_flag(o->scene), pixel_flag(o->pixels), of}, look_flags(*o)), {o.get()}, [o] { return run_explain_view(*o); }};
}

Result<Answer> run_render(const RenderOptions& options) {
    if (options.film.several_views()) return fail(ErrorCode::usage, "view: expected one view; look draws several");
    auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    Image image = make_image(*job, false);
    const auto rendered =
        Renderer().render(*job->prepared, job->light, job->camera, job->settings, target_of(*job, image), job->timed_execution());
    if (!rendered) return fail(rendered.error().code, job->source.name + ": " + rendered.error().message);
    const bool blank = is_blank(image, *rendered);
    Answer answer;
    answer.report = report_head("report");
    answer.report["scene"] = job->source.name;
    answer.report["output"] = "-";  // the answer has the picture
    add_frame(answer.report, *job, *rendered, image);
    if (blank) answer.report["blank"] = true;
    answer.report["encode_ms"] = 0.0;  // nothing is encoded
    answer.notes.emplace_back(blank ? "FAULT: blank: nothing is seen in the picture" : "No faults: the picture shows the model.");
    answer.picture = std::move(image);
    if (job->source.file) answer.inputs = job->source.file->files;
    answer.inputs.push_back(options.scene);
    answer.good = !blank;
    return answer;
}

Call render_call() {
    const auto o = std::make_shared<RenderOptions>();
    return {call_flags({path_flag(o->scene)}, render_flags(*o, kRenderSize)),
            {o.get()},
            [o] { return run_render(*o); },
            [o] { return check_request(*o); }};
}

Result<Answer> run_compare(const CompareOptions& call) {
    const auto comparison = compare_files(call);
    if (!comparison) return tl::unexpected(comparison.error());
    auto sheet = comparison_sheet(*comparison);
    if (!sheet) return tl::unexpected(sheet.error());
    return Answer{
        {comparison_text(*comparison)}, comparison_json(*comparison), std::move(*sheet), {call.a, call.b}, !comparison->differs()};
}

Call compare_call() {
    const auto o = std::make_shared<CompareOptions>();
    return {call_flags({{"--a", kModelForm, "The first version: a file below the server's folder", engine::read_text(o->a)},
                        {"--b", kModelForm, "The second version", engine::read_text(o->b)}},
                       compare_flags(*o)),
            {o.get()},
            [o] { return run_compare(*o); }};
}

Result<Answer> run_info(const RenderOptions& options, bool measure_parts) {
    const auto job = make_measured_job(options);
    if (!job) return tl::unexpected(job.error());
    const auto text = describe_scene(*job, true, measure_parts);
    if (!text) return tl::unexpected(text.error());
    return Answer{{}, Json::parse(*text)};
}

struct InfoCall : RenderOptions {
    bool measure_parts = false;
};

Call info_call() {
    const auto o = std::make_shared<InfoCall>();
    return {call_flags({path_flag(o->scene), parts_flag(o->measure_parts)}, render_flags(*o, kRenderSize)), {o.get()}, [o] {
                return run_info(*o, o->measure_parts);
            }};
}

Result<Answer> run_measure(const RenderOptions& options) {
    const auto job = make_measured_job(options);
    if (!job) return tl::unexpected(job.error());
    auto measures = measures_json(*job);
    if (!measures) return tl::unexpected(measures.error());
    auto parts = parts_json(*job, true);
    if (!parts) return tl::unexpected(parts.error());
    Answer answer;
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

template <Result<Answer> (*Run)(const RenderOptions&)>
Call scene_call() {
    const auto o = std::make_shared<RenderOptions>();
    return {call_flags({path_flag(o->scene)}, render_flags(*o, kRenderSize)), {o.get()}, [o] { return Run(*o); }};
}

}  // namespace

std::span<const CallRow> all_calls() {
    static const CallRow kCalls[] = {
        {"look",
         "Look at a 3D model: labelled views on one sheet with dimensions, and a report of what each view shows of each part. Begin here "
         "after making or changing a model. Lines that begin with FAULT come first: a view with a fault (blank, cropped, cut, inside, "
         "tiny) must not be relied on. Takes all flags of `halflit look` by their names",
         {"path", "view", "section", "edges", "hidden-edges", "size", "perspective", "projection", "certify", "up", "output"},
         {"path"},
         true,
         "look",
         look_call},
        {"render",
         "Draw one picture of a 3D model from a view or a placed camera, shaded and lit. Takes all flags of `halflit render` that decide "
         "the "
         "picture by their names",
         {"path", "view", "azimuth", "elevation", "zoom", "fov", "camera", "camera-position", "camera-target", "size", "samples",
          "background", "light", "env", "ground", "edges", "section", "up", "output"},
         {"path"},
         true,
         "render",
         render_call},
        {"measure",
         "Measure a 3D model and each of its parts: box, area, volume, centre, bodies, and whether the surface is watertight",
         {"path", "section", "up"},
         {"path"},
         false,
         "measure",
         scene_call<run_measure>},
        {"section",
         "Cut a 3D model by planes: the areas of the cuts, and a sheet of views of what is left",
         {"path", "section", "section-hatch", "view", "edges", "size", "perspective", "up", "output"},
         {"path", "section"},
         true,
         "section",
         look_call},
        {"compare",
         "Compare two versions of a 3D model: pictures of both by one camera with what changed, parts, measures, and the distance of the "
         "surfaces with its bound",
         {"a", "b", "view", "max", "size", "up", "output"},
         {"a", "b"},
         true,
         "compare",
         compare_call},
        {"explain-view",
         "Tell what made a pixel of a view of `look`: part, triangle, material, lights, and what lies before and behind it. The views are "
         "those of look with the same arguments; boxes in its report are in the same pixels",
         {"path", "pixel", "of", "view", "section", "size", "perspective", "up"},
         {"path", "pixel"},
         false,
         "explain",
         explain_view_call},
        {"explain",
         "Tell what made pixels of the picture that `halflit render` draws with the same arguments",
         {"path", "pixel"},
         {"path", "pixel"},
         false,
         "",
         explain_call},
        {"certify",
         "Draw views of a 3D model until each triangle that can be seen is seen, and list those that no view shows",
         {"path", "certify", "view", "section", "up"},
         {"path"},
         false,
         "",
         certify_call},
        {"info",
         "Describe a 3D model's file: format, counts, names, measures, materials and what drawing it requires",
         {"path", "scene", "animation", "variant", "up"},
         {"path"},
         false,
         "info",
         info_call},
    };
    return kCalls;
}

}  // namespace halflit::engine
