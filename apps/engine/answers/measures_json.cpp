#include "apps/engine/answers/measures_json.hpp"

#include "halflit/measures.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace halflit::engine {
namespace {

constexpr std::uint64_t kMostTriangles = 1u << 25;  // some ten seconds
constexpr std::size_t kMostBodies = 100;            // in the list of bodies
constexpr int kDigits = 7;                          // as many as float32 positions have

double parsed(std::string_view text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value + 0.0;  // no -0
}

/// Null for a number that is not finite: the square or cube of a file's unit may be above the range of double.
Json rounded(double value) { return std::isfinite(value) ? Json(parsed(fmt::format("{:.{}g}", value, kDigits))) : Json(nullptr); }

/// Coordinates, rounded to that digit which is the seventh of the size.
Json point_json(Vec3d p, double size) {
    const int decimals = size > 0.0 ? std::clamp(kDigits - 1 - static_cast<int>(std::floor(std::log10(size))), 0, 60) : kDigits;
    const auto digits = [decimals](double x) { return parsed(fmt::format("{:.{}f}", x, decimals)); };
    return {digits(p.x), digits(p.y), digits(p.z)};
}

/// False for scenes of millions of instances, whose triangles take long to measure although they are few in memory.
bool is_soon_measured(const Scene& scene) {
    std::uint64_t stored = 0, drawn = 0;
    for (const Mesh& mesh : scene.meshes) stored += triangles_of(mesh);
    for (const Instance& instance : scene.instances) drawn += triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    return drawn <= std::max(kMostTriangles, 2 * stored);
}

FileBox in_file(const Placement& placement, Vec3d min, Vec3d max) {
    // Quarter turns may exchange the ends of an axis.
    const Vec3d a = placement.out(min), b = placement.out(max);
    return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}, {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

/// Of the surfaces that a file's exact nodes have.
struct ExactSum {
    Vec3d min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
    double area = 0, volume = 0;
    bool has_volume = false;
};
void add(ExactSum& sum, const ExactMeasures& one) {
    sum.min = {std::min(sum.min.x, one.min.x), std::min(sum.min.y, one.min.y), std::min(sum.min.z, one.min.z)};
    sum.max = {std::max(sum.max.x, one.max.x), std::max(sum.max.y, one.max.y), std::max(sum.max.z, one.max.z)};
    sum.area += one.area;
    sum.volume += one.volume;
    sum.has_volume = sum.has_volume || one.solids > 0;
}

/// Of these parts; nothing: the file has no exact surfaces, or they are cut.
std::optional<ExactSum> exact_sum(const RenderJob& job, const std::function<bool(const Part&)>& counts) {
    if (!job.source.file || job.source.file->exact.empty() || !job.sections.cuts.empty()) return std::nullopt;
    std::set<int> nodes;
    for (const Part& part : job.source.parts->list())
        if (counts(part)) nodes.insert(part.node);
    std::optional<ExactSum> sum;
    for (const ExactMeasures& one : job.source.file->exact)
        if (nodes.contains(one.node)) add(sum ? *sum : sum.emplace(), one);
    return sum;
}
std::optional<ExactSum> drawn_sum(const RenderJob& job) {
    const auto is_drawn = [&](int instance) { return job.scene().instances[static_cast<std::size_t>(instance)].visible; };
    return exact_sum(job, [&](const Part& part) { return std::any_of(part.instances.begin(), part.instances.end(), is_drawn); });
}

/// All measures but for the list of bodies, in the file's unit and along its axes; null if nothing has triangles.
/// exact: gives the box in place of the triangles'.
Json in_file_units(const SceneSource& source, const Measures& found, const std::optional<ExactSum>& exact = {}) {
    if (found.triangles == found.not_finite_triangles) return nullptr;
    const Placement& placement = source.placement;
    const auto [name, unit] = file_unit(source);
    const FileBox box = exact ? FileBox{exact->min, exact->max} : in_file(source.placement, found.min, found.max);
    const Vec3d &min = box.min, &max = box.max;
    const Vec3d size = max - min;
    const double largest = std::max({size.x, size.y, size.z});
    return Json{{"unit", name.empty() ? Json(nullptr) : Json(name)},
                {"min", point_json(min, largest)},
                {"max", point_json(max, largest)},
                {"size", point_json(size, largest)},
                {"area", rounded(found.area * (unit * unit))},
                {"volume", found.watertight ? rounded(found.volume * ((unit * unit) * unit)) : Json(nullptr)},
                {"center", point_json(placement.out(found.center), largest)},
                {"triangles", found.triangles},
                {"degenerate_triangles", found.degenerate_triangles},
                {"not_finite_triangles", found.not_finite_triangles},
                {"bodies", found.bodies},
                {"watertight", found.watertight},
                {"open_edges", found.open_edges},
                {"flipped_edges", found.flipped_edges},
                {"crowded_edges", found.crowded_edges}};
}

Json chosen_keys(const Json& all, std::span<const char* const> keys) {
    Json chosen;
    for (const char* const key : keys) chosen[key] = all[key];
    return chosen;
}

/// [{"number", "part", measures ..}]
Json bodies_json(const SceneSource& source, std::span<const Body> bodies) {
    constexpr const char* kKeys[] = {"min",    "max",        "center",     "triangles",     "area",
                                     "volume", "watertight", "open_edges", "flipped_edges", "crowded_edges"};
    Json list = Json::array();
    for (const Body& body : bodies) {
        Json one{{"number", list.size() + 1}, {"part", source.parts->of_instance(body.instance) + 1}};
        one.update(chosen_keys(in_file_units(source, body.measures), kKeys));
        list.push_back(std::move(one));
    }
    return list;
}

/// {"tolerance", "area", "volume"}; null: there are no exact surfaces.
Json exact_json(const SceneSource& source, const std::optional<ExactSum>& exact) {
    if (!exact) return nullptr;
    ExactSum whole;
    for (const ExactMeasures& one : source.file->exact) add(whole, one);
    constexpr double kShareOfPixel = 0.25;
    return {{"tolerance", rounded(kShareOfPixel * length(whole.max - whole.min) / source.file->detail_px)},
            {"area", rounded(exact->area)},
            {"volume", exact->has_volume ? rounded(exact->volume) : Json(nullptr)}};
}

}  // namespace

FileBox file_box(const RenderJob& job, Vec3d min, Vec3d max) {
    const std::optional<ExactSum> exact = drawn_sum(job);
    return exact ? FileBox{exact->min, exact->max} : in_file(job.source.placement, min, max);
}

Result<Json> measures_json(const RenderJob& job) {
    if (!is_soon_measured(job.scene())) return Json(nullptr);
    const auto measured = measure_bodies(job.scene(), kMostBodies);
    if (!measured) return tl::unexpected(measured.error());
    const std::optional<ExactSum> exact = drawn_sum(job);
    Json all = in_file_units(job.source, measured->all, exact);
    if (all.is_null()) return all;
    all["exact"] = exact_json(job.source, exact);
    all["body_list"] = bodies_json(job.source, measured->bodies);
    return all;
}

Result<Json> part_measures_json(const RenderJob& job, const Part& part) {
    const auto measured = measure_geometry(job.scene(), part.instances);
    if (!measured) return tl::unexpected(measured.error());
    const std::optional<ExactSum> exact = exact_sum(job, [&](const Part& one) { return &one == &part; });
    Json all = in_file_units(job.source, *measured, exact);
    if (all.is_null()) return all;
    all["exact"] = exact_json(job.source, exact);
    constexpr const char* kKeys[] = {"size", "area", "volume", "watertight", "open_edges", "exact"};
    return chosen_keys(all, kKeys);
}

bool parts_are_soon_measured(const RenderJob& job) { return is_soon_measured(job.scene()); }

}  // namespace halflit::engine
