#include "apps/engine/answers/run_report.hpp"

#include "apps/engine/answers/camera_json.hpp"
#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/engine/job/section_cuts.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/version.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace halflit::engine {
namespace {

/// Counts of fragments (vertices or triangles at lower shading rates): those that each stage ran for, and those that each type of light was
/// evaluated for.
Json work_json(const WorkCounts& work) {
    Json stages = Json::object(), lights = Json::object();
    for (std::size_t bit = 0; bit < work.stage_lanes.size(); ++bit) stages[std::string(kStageNames[bit])] = work.stage_lanes[bit];
    for (std::size_t type = 0; type < work.light_lanes.size(); ++type) lights[std::string(kLightKinds[type].name)] = work.light_lanes[type];
    return {{"stages", std::move(stages)},
            {"alpha_test", work.alpha_test_lanes},
            {"lights", std::move(lights)},
            {"shadow_look_ups", work.shadow_lookup_lanes}};
}

/// One line per value, nested values indented; lists of plain values on one line.
void append_lines(std::string& text, const std::string& label, const Json& value, std::size_t depth) {
    const std::string indent(2 * depth, ' ');
    const bool plain_list = value.is_array() && (value.empty() || value[0].is_primitive());
    if (plain_list) {
        std::string list;
        const auto shown = [](const Json& item) {
            if (!item.is_string()) return item.dump();
            return item.get<std::string>().empty() ? std::string("(no name)") : item.get<std::string>();
        };
        for (const Json& item : value) {
            check_time();
            list += (list.empty() ? "" : ", ") + shown(item);
        }
        text += fmt::format("{}{}: {}\n", indent, label, list.empty() ? "none" : printable(list));
    } else if (value.is_structured()) {
        text += fmt::format("{}{}:\n", indent, label);
        for (const auto& [key, item] : value.items()) {
            check_time();
            append_lines(text, key, item, depth + 1);
        }
    } else {
        text += fmt::format("{}{}: {}\n", indent, label, value.is_string() ? printable(value.get<std::string>()) : value.dump());
    }
}

}  // namespace

Json report_head(std::string_view kind) {
    return {{"schema", fmt::format("halflit.{}/1", kind)}, {"status", "ok"}, {"halflit", version()}, {"pixel_epoch", kPixelEpoch}};
}

void add_frame(Json& report, const RenderJob& job, const RenderReport& rendered, const Image& picture) {
    report["size"] = {job.width, job.height};
    report["region"] = region_json(job.settings.region);
    report["pixel_hash"] = hash_text(picture.rgba8);
    report["camera"] = camera_json(job, job.camera, {job.width, job.height});
    report["isa"] = isa_name(rendered.isa);
    report["threads"] = rendered.threads;
    report["samples"] = job.settings.samples;
    if (job.animation() != nullptr) report["pose"] = pose_json(job);
    report["exposure"] = job.settings.exposure;
    report["tone_curve"] = tone_curve_name(job.settings.tone_curve);
    report["accuracy"] = accuracy_name(job.settings.shading.accuracy);
    if (rendered.error.budget > 0.0) report["error_bound"] = error_bound_json(rendered.error);
    report["load_ms"] = job.load_ms;
    report["prepare_ms"] = job.prepare_ms;
    report["render_ms"] = rendered.total_ms;
    const auto& ms = rendered.ms;
    report["stages"] = {{"plan", ms.plan},           {"shadows", ms.shadows}, {"cull", ms.cull},
                        {"transform", ms.transform}, {"bin", ms.bin},         {"tiles", ms.tiles}};
    report["triangles_submitted"] = rendered.triangles_submitted;
    report["triangles_drawn"] = rendered.triangles_drawn;
    report["triangles_not_finite"] = rendered.triangles_not_finite;
    report["pixels_visible"] = rendered.pixels_visible;
    report["fragments_shaded"] = rendered.fragments_shaded;
    report["nan_pixels"] = rendered.nan_pixels;
    report["lanes"] = work_json(rendered.work);
    if (job.light.environment != nullptr) {
        Json uses = Json::array();
        for (const EnvironmentUse& use : rendered.environment) {
            Json one{{"light", "diffuse"}};
            one.update(environment_use_json(use, job.settings));
            uses.push_back(std::move(one));
        }
        report["environment"] = std::move(uses);
    }
    if (!job.sections.cuts.empty()) report["sections"] = sections_json(job);
    report["warnings"] = job.warnings;
    for (const std::string& warning : rendered.warnings) report["warnings"].push_back(warning);
    report["peak_memory_bytes"] = platform::peak_memory();
}

Json sections_json(const RenderJob& job) {
    Json sections = Json::array();
    for (const SectionCut& cut : job.sections.cuts)
        sections.push_back({{"plane", cut.plane},
                            {"part", cut.part},
                            {"name", cut_name(job, cut)},
                            {"area", file_area(job, cut)},
                            {"closed", cut.closed},
                            {"open_ends", cut.open_ends}});
    return sections;
}

Json error_bound_json(const ErrorBound& error) {
    const std::pair<const char*, double> parts[] = {{"rounding", error.rounding}, {"lobes", error.lobes},
                                                    {"specular", error.specular}, {"environment", error.environment},
                                                    {"cells", error.cells},       {"left_out", error.left_out}};
    const ErrorGrowth& growth = error.tone_growth;
    Json json{{"budget_codes", error.budget},
              {"bound_codes", error.codes},
              {"tone_growth", {{"absolute", growth.absolute}, {"relative", growth.relative}, {"other", growth.other}}}};
    auto largest = std::max_element(std::begin(parts), std::end(parts), [](const auto& a, const auto& b) { return a.second < b.second; });
    json["largest_part"] = largest->first;
    for (const auto& [name, codes] : parts) json["parts"][name] = codes;
    return json;
}

Json json_number(float value) {
    const std::string text = fmt::format("{}", value);
    double shortest = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), shortest);
    return error == std::errc() ? shortest : static_cast<double>(value);
}

Json region_json(const Region& region) { return {region.x, region.y, region.width, region.height}; }

Json pose_json(const RenderJob& job) {
    return {{"animation", job.source.animation}, {"name", job.animation()->name}, {"time_s", job.pose_time_s}};
}

Json environment_use_json(const EnvironmentUse& use, const Settings& settings) {
    return {{"order", use.bands},
            {"bound_linear", use.bound},
            {"bound_of_white", use.bound * static_cast<double>(settings.exposure)},
            {"tolerance_of_white", settings.shading.environment_tolerance},
            {"within", use.within}};
}

std::string to_text(const Json& json, bool one_line) {
    return io::display_safe_json(json.dump(one_line ? -1 : 2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::string to_lines(const Json& json) {
    std::string text;
    for (const auto& [key, value] : json.items()) append_lines(text, key, value, 0);
    return text;
}

std::string error_report(const std::string& scene, int code, const std::string& message, bool one_line) {
    Json report = report_head("report");
    report["status"] = "error";
    report["scene"] = scene;
    report["error"] = {{"code", code}, {"message", message}};
    return to_text(report, one_line);
}

}  // namespace halflit::engine
