#include "apps/engine/answers/part_list.hpp"

#include "apps/engine/answers/measures_json.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostLines = 100;

Result<Json> list_parts(const RenderJob& job, bool measured, std::size_t most) {
    const Scene& scene = job.scene();
    const std::vector<Part>& parts = job.source.parts->list();
    measured = measured && parts_are_soon_measured(job);
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(parts.size(), most); ++i) {
        check_time();
        const Part& part = parts[i];
        std::uint64_t triangles = 0;
        bool drawn = false;
        for (const int index : part.instances) {
            const Instance& instance = scene.instances[static_cast<std::size_t>(index)];
            triangles += triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
            drawn = drawn || instance.visible;
        }
        Json one{{"number", i + 1}, {"name", part.name}, {"instances", part.instances.size()}, {"triangles", triangles}, {"drawn", drawn}};
        if (measured) {
            auto measures = part_measures_json(job, part);
            if (!measures) return tl::unexpected(measures.error());
            one["measures"] = std::move(*measures);
        }
        list.push_back(std::move(one));
    }
    return list;
}

std::string count_of(const Json& count, const char* what) { return fmt::format("{} {}{}", count.dump(), what, count == 1 ? "" : "s"); }

std::string line_of(const Json& part) {
    const auto name = part["name"].get<std::string>();
    std::string line = fmt::format("{}, {}, {}{}", name.empty() ? "(no name)" : name, count_of(part["instances"], "instance"),
                                   count_of(part["triangles"], "triangle"), part["drawn"] ? "" : ", not drawn");
    if (!part.contains("measures") || part["measures"].is_null()) return line;
    const Json& m = part["measures"];
    line += fmt::format(", size {} x {} x {}, area {}", m["size"][0].dump(), m["size"][1].dump(), m["size"][2].dump(), m["area"].dump());
    return line + (m["watertight"] ? ", volume " + m["volume"].dump() : ", " + count_of(m["open_edges"], "open edge"));
}

}  // namespace

Result<Json> parts_json(const RenderJob& job, bool measured) { return list_parts(job, measured, std::numeric_limits<std::size_t>::max()); }

Result<Json> parts_text(const RenderJob& job, bool measured) {
    const auto list = list_parts(job, measured, kMostLines);
    if (!list) return list;
    const std::size_t count = job.source.parts->list().size();
    Json lines{{"count", count}};
    for (const Json& part : *list) lines[part["number"].dump()] = line_of(part);
    if (count > kMostLines) lines["more"] = fmt::format("{}, which --json lists", count - kMostLines);
    return lines;
}

}  // namespace halflit::engine
