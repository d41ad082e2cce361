#include "apps/engine/look/look_json.hpp"

#include "apps/engine/answers/camera_json.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/engine/job/section_cuts.hpp"
#include "apps/engine/pictures/marks.hpp"
#include "raster/scene/instance_material.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>

namespace halflit::engine {
namespace {

Json box_json(const PixelBox& box) { return box.empty() ? Json() : Json{box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0}; }

/// Triangles and name of a part.
Json part_json(const RenderJob& job, std::size_t number, std::span<const ViewShot> shots, std::span<const ViewContent> contents) {
    const Part& part = job.source.parts->list()[number];
    std::size_t triangles = 0;
    bool visible = false, transparent = true;
    for (const int i : part.instances) {
        const Instance& instance = job.scene().instances[static_cast<std::size_t>(i)];
        triangles += triangles_of(job.scene().meshes[static_cast<std::size_t>(instance.mesh)]);
        visible |= instance.visible;
        const Material* const material = raster::material_of(job.scene(), instance);
        transparent &= material != nullptr && material->is_layer();
    }
    Json seen_in = Json::array();
    std::int64_t pixels = 0;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const PartInView& seen = contents[i].parts[number];
        if (seen.pixels > 0) seen_in.push_back(shots[i].name);
        pixels += seen.pixels;
    }
    Json one{{"number", number + 1}, {"name", part.name}, {"instances", part.instances.size()}, {"triangles", triangles}};
    one["shown"] = visible;
    one["transparent"] = transparent;
    one["pixels"] = pixels;
    one["seen_in"] = std::move(seen_in);
    return one;
}

Json seen_json(const PartInView& seen) {
    Json one{{"part", seen.part + 1}, {"pixels", seen.pixels}, {"box", box_json(seen.box)}};
    one["pixels_alone"] = seen.alone ? Json(*seen.alone) : Json();
    one["hidden_by"] = seen.hidden_by < 0 ? Json() : Json{{"part", seen.hidden_by + 1}, {"pixels", seen.hidden_pixels}};
    return one;
}

/// Names of the statuses, in their order.
constexpr const char* kStatusNames[] = {"seen", "seen_less", "hidden", "unknown", "no_area", "not_drawn"};

/// Numbers of triangles of a status, by part, instance and ranges [first, last] from 1 on; at most so many ranges.
Json triangles_json(const RenderJob& job, const Certificate& certificate, TriangleStatus status) {
    constexpr std::size_t kMostRanges = 10000;
    Json list = Json::array();
    std::size_t ranges = 0;
    for (std::size_t instance = 0; instance < certificate.first.size(); ++instance) {
        const std::size_t begin = certificate.first[instance];
        const std::size_t end = instance + 1 < certificate.first.size() ? certificate.first[instance + 1] : certificate.triangles.size();
        Json found = Json::array();
        for (std::size_t i = begin; i < end && ranges < kMostRanges; ++i) {
            if (certificate.triangles[i].status != status) continue;
            const std::size_t first = i;
            while (i + 1 < end && certificate.triangles[i + 1].status == status) ++i;
            found.push_back({first - begin + 1, i - begin + 1});
            ++ranges;
        }
        if (found.empty()) continue;
        list.push_back(
            {{"part", job.source.parts->of_instance(instance) + 1}, {"instance", instance + 1}, {"triangles", std::move(found)}});
    }
    return list;
}

Json statuses_json(const Certificate& certificate, std::span<const int> instances) {
    Json counts;
    for (std::size_t status = 0; status < std::size(kStatusNames); ++status)
        counts[kStatusNames[status]] = certificate.count(static_cast<TriangleStatus>(status), instances);
    return counts;
}

}  // namespace

Json certificate_json(const RenderJob& job, const Certificate& certificate) {
    Json json{{"pixels", certificate.least}, {"directions", certificate.looked.size()}, {"views_added", certificate.added}};
    Json looked = Json::array();
    for (const LookedFrom& from : certificate.looked) looked.push_back(from.name);
    json["looked_from"] = std::move(looked);
    json["complete"] = certificate.complete();
    json["triangles"] = statuses_json(certificate, {});
    Json parts = Json::array();
    for (std::size_t i = 0; i < job.source.parts->list().size(); ++i) {
        Json part{{"part", i + 1}};
        part.update(statuses_json(certificate, job.source.parts->list()[i].instances));
        parts.push_back(std::move(part));
    }
    json["parts"] = std::move(parts);
    for (const TriangleStatus status : {TriangleStatus::less, TriangleStatus::hidden, TriangleStatus::unknown})
        json[std::string(kStatusNames[static_cast<std::size_t>(status)]) + "_triangles"] = triangles_json(job, certificate, status);
    return json;
}

Json look_json(const RenderJob& job, const Json& measures, std::span<const ViewShot> shots, std::span<const ViewContent> contents) {
    Json report = report_head("look");
    report["scene"] = job.source.name;
    report["size"] = {job.width, job.height};
    report["measures"] = measures;
    Json views = Json::array(), parts = Json::array(), never_seen = Json::array();
    bool good = true;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const ViewShot& shot = shots[i];
        const ViewContent& content = contents[i];
        Json view{{"name", shot.name}, {"camera", camera_json(job, shot.camera, {shot.width(), shot.height()})}};
        view["pixel_size"] = shot.camera.orthographic
                                 ? Json(pixel_size(shot.camera, shot.width(), shot.height(), 1.0) / job.source.placement.scale)
                                 : Json();
        view["share_of_picture"] = static_cast<double>(content.pixels) / (static_cast<double>(job.width) * job.height);
        view["box"] = box_json(content.box);
        view["detail"] = shot.detail;
        view["edge_on"] = content.edge_on;
        view["faults"] = content.faults.names();
        good &= !content.faults.any();
        Json seen = Json::array();
        for (const PartInView& part : content.parts)
            if (part.pixels > 0 || part.alone.value_or(0) > 0) seen.push_back(seen_json(part));
        view["parts"] = std::move(seen);
        views.push_back(std::move(view));
    }
    for (std::size_t number = 0; number < job.source.parts->list().size(); ++number) {
        Json part = part_json(job, number, shots, contents);
        if (part["shown"] == true && part["transparent"] == false && part["pixels"] == 0) never_seen.push_back(number + 1);
        parts.push_back(std::move(part));
    }
    report["good"] = good;
    report["views"] = std::move(views);
    report["parts"] = std::move(parts);
    report["never_seen"] = std::move(never_seen);
    Json& removed = report["removed_by_section"] = Json::array();
    for (const int part : job.removed) removed.push_back(part + 1);
    report["warnings"] = job.warnings;
    return report;
}

std::string look_footer(const RenderJob& job, const Json& measures) {
    std::string text = job.source.name.substr(job.source.name.rfind('/') + 1);
    if (!measures.is_object()) return text;
    const auto& size = measures["size"];
    const double largest = std::max({size[0].get<double>(), size[1].get<double>(), size[2].get<double>()});
    const double of_file = file_unit(job.source).per_drawn_unit;
    const ShownUnit unit = shown_unit(job.source, largest / of_file);
    const double factor = unit.per_drawn_unit / of_file;
    const auto triangles = measures["triangles"].get<std::uint64_t>();
    text += fmt::format(": {} x {} x {}{}{}, {} {}", number_text(size[0].get<double>() * factor),
                        number_text(size[1].get<double>() * factor), number_text(size[2].get<double>() * factor),
                        unit.name.empty() ? "" : " ", unit.name, triangles, triangles == 1 ? "triangle" : "triangles");
    const auto count = [&](const char* key, const char* one, const char* many) {
        const auto n = measures[key].get<std::uint64_t>();
        if (n > 0) text += fmt::format(", {} {}", n, n == 1 ? one : many);
    };
    count("bodies", "body", "bodies");
    if (!job.sections.cuts.empty()) {  // what is left may be open inside, where one cap fills several bodies
        double area = 0.0;
        for (const SectionCut& cut : job.sections.cuts) area += file_area(job, cut) * factor * factor;
        return text +
               fmt::format(", cut: {}{}{}", number_text(area), unit.name.empty() ? "" : " ", unit.name.empty() ? "" : unit.name + "2");
    }
    if (measures["watertight"] == true) return text + ", watertight";
    count("open_edges", "open edge", "open edges");
    count("flipped_edges", "flipped edge", "flipped edges");
    count("crowded_edges", "crowded edge", "crowded edges");
    return text;
}

}  // namespace halflit::engine
