#include "apps/halflit/farm/picture_report.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/hash_text.hpp"

#include <nlohmann/json.hpp>

namespace halflit::cli {
namespace {

/// The output, and its place among the others of the run.
void add_place(Json& report, const PictureFile& file) {
    report["output"] = file.output;
    if (file.shard) report["shard"] = {file.shard->index, file.shard->count};
    if (file.frame) {
        const auto& [number, whole, time, opaque] = *file.frame;
        report["frame"] = number;
        report["film"] = {{"first", whole.first},
                          {"last", whole.last},
                          {"step", whole.step},
                          {"seconds_each", {time.numerator, time.denominator}},
                          {"opaque", opaque}};
    }
    if (file.place) report["place"] = {{"index", file.place->index}, {"scenes", file.place->scenes}};
    if (file.part_of) report["part_of"] = region_json(*file.part_of);
}

}  // namespace

std::string picture_report(const PictureFile& file, const RenderJob& job, const RenderReport& rendered, const Image& picture,
                           double encode_ms, bool one_line) {
    Json report = report_head("report");
    report["scene"] = job.source.name;
    add_place(report, file);
    if (file.file_hash != 0) report["file_hash"] = hash_text(file.file_hash);
    for (const AovFile& aov : file.beside.files) report["aov"][aov.name] = aov.path;
    if (const auto& range = file.beside.depth16) report["depth16"] = {range->least, range->most};
    add_frame(report, job, rendered, picture);
    if (const auto& measured = file.measured)
        report["quality"] = {{"codes", measured->asked.codes},     {"asked_percent", measured->asked.percent},
                             {"percent", measured->percent},       {"probes", measured->probes},
                             {"outside", measured->outside},       {"samples", measured->samples},
                             {"anisotropy", measured->anisotropy}, {"shadow_size", measured->shadow_size}};
    if (file.blank) report["blank"] = true;
    report["encode_ms"] = encode_ms;
    return to_text(report, one_line);
}

std::string skipped_report(const std::string& scene, const PictureFile& file) {
    Json report = report_head("report");
    report["status"] = "skipped";
    report["scene"] = scene;
    add_place(report, file);
    return to_text(report, true);
}

}  // namespace halflit::cli
