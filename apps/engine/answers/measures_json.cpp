#include "apps/engine/answers/measures_json.hpp"

#include "halflit/measures.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
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

/// Largest distance of triangles from the surfaces that they were made of, in the file's unit; nothing: they are the file's own.
std::optional<double> tolerance_of(const SceneSource& source) {
    if (!source.file || !source.file->exact) return std::nullopt;
    constexpr double kShareOfPixel = 0.25;
    return kShareOfPixel * length(source.file->exact->max - source.file->exact->min) / source.file->detail_px;
}

/// All measures but for the list of bodies, in the file's unit and along its axes; null if nothing has triangles.
Json in_file_units(const SceneSource& source, const Measures& found) {
    if (found.triangles == found.not_finite_triangles) return nullptr;
    const Placement& placement = source.placement;
    const auto [name, unit] = file_unit(source);
    const auto [min, max] = file_box(source, found.min, found.max);
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

/// {"tolerance", "area", "volume"} of the file's surfaces; null: it has triangles.
Json exact_json(const SceneSource& source) {
    const std::optional<double> tolerance = tolerance_of(source);
    if (!tolerance) return nullptr;
    const ExactMeasures& exact = *source.file->exact;
    return {{"tolerance", rounded(*tolerance)}, {"area", rounded(exact.area)}, {"volume", rounded(exact.volume)}};
}

}  // namespace

FileBox file_box(const SceneSource& source, Vec3d min, Vec3d max) {
    // Quarter turns may exchange the ends of an axis.
    const Vec3d a = source.placement.out(min), b = source.placement.out(max);
    FileBox box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}, {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    const std::optional<double> tolerance = tolerance_of(source);
    if (!tolerance) return box;
    const ExactMeasures& exact = *source.file->exact;
    for (double Vec3d::*const axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        if (absolute(box.min.*axis - exact.min.*axis) <= *tolerance) box.min.*axis = exact.min.*axis;
        if (absolute(box.max.*axis - exact.max.*axis) <= *tolerance) box.max.*axis = exact.max.*axis;
    }
    return box;
}

Result<Json> measures_json(const RenderJob& job) {
    if (!is_soon_measured(job.scene())) return Json(nullptr);
    const auto measured = measure_bodies(job.scene(), kMostBodies);
    if (!measured) return tl::unexpected(measured.error());
    Json all = in_file_units(job.source, measured->all);
    if (all.is_null()) return all;
    all["exact"] = exact_json(job.source);
    all["body_list"] = bodies_json(job.source, measured->bodies);
    return all;
}

Result<Json> part_measures_json(const RenderJob& job, const Part& part) {
    const auto measured = measure_geometry(job.scene(), part.instances);
    if (!measured) return tl::unexpected(measured.error());
    const Json all = in_file_units(job.source, *measured);
    if (all.is_null()) return all;
    constexpr const char* kKeys[] = {"size", "area", "volume", "watertight", "open_edges"};
    return chosen_keys(all, kKeys);
}

bool parts_are_soon_measured(const RenderJob& job) { return is_soon_measured(job.scene()); }

}  // namespace halflit::engine
