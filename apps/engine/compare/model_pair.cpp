#include "apps/engine/compare/model_pair.hpp"

#include "apps/engine/job/view_choice.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::engine {
namespace {

/// Brings a job's scene into another one's drawn world, and unit of length if both files have one.
Result<void> move_into(const SceneSource& other, RenderJob& job) {
    const Placement own = job.source.placement, &world = other.placement;
    double units = 1.0;  // of the other file in one of its own
    if (other.file && job.source.file && other.file->unit_m > 0 && job.source.file->unit_m > 0) {
        units = job.source.file->unit_m / other.file->unit_m;
        job.source.file->unit_m = other.file->unit_m;
    }
    const double factor = units * world.scale / own.scale;
    const Vec3d shift = (own.origin * units - world.origin) * world.scale;
    if (factor == 1.0 && shift == Vec3d{}) return {};
    const auto moved = [&](Vec4f& column, Vec3d by) {
        const Vec3f v = to_float(Vec3d{column.x, column.y, column.z} * factor + by);
        column = {v.x, v.y, v.z, column.w};
    };
    for (Instance& instance : job.scene().instances)
        for (std::size_t i = 0; i < 4; ++i) moved(instance.world_from_object.c[i], i == 3 ? shift : Vec3d{});
    for (Light& light : job.scene().lights) {
        if (!kind_of(light.type).placed) continue;
        light.position_ws = to_float(to_double(light.position_ws) * factor + shift);
        io::scale_lengths(light, factor);
    }
    job.source.placement.origin = world.origin, job.source.placement.scale = world.scale;
    auto prepared = PreparedScene::make(job.scene(), job.timed_execution());
    if (!prepared) return tl::unexpected(prepared.error());
    job.prepared = std::move(*prepared);
    return {};
}

/// Positions and triangles of both models, for framing.
Scene outlines_of(const Scene& a, const Scene& b) {
    Scene both;
    for (const Scene* const scene : {&a, &b}) {
        const auto first = static_cast<int>(both.meshes.size());
        for (const Mesh& mesh : scene->meshes) {
            Mesh& outline = both.meshes.emplace_back();
            outline.positions = mesh.positions, outline.indices = mesh.indices, outline.topology = mesh.topology;
        }
        for (const Instance& instance : scene->instances)
            if (raster::counts_for_views(*scene, instance))
                both.instances.push_back({.mesh = first + instance.mesh, .world_from_object = instance.world_from_object});
    }
    return both;
}

void warn_of_units(ModelPair& pair) {
    const double a = pair.a.prepared->bounds().radius(), b = pair.b.prepared->bounds().radius();
    if (!(a > 0.0 && b > 0.0)) return;
    const double ratio = b / a;
    for (const double usual : {1000.0, 100.0, 10.0, 25.4, 39.37007874})
        for (const double factor : {usual, 1.0 / usual})
            if (ratio > 0.99 * factor && ratio < 1.01 * factor)
                pair.warnings.push_back(fmt::format("B is {:.4g} times as large as A: the files may have different units", ratio));
}

CompareOptions with_defaults(CompareOptions flags) {
    flags.view.orthographic = !flags.fov_given;
    if (!flags.has_given("shadows")) flags.settings.shadows = ShadowMode::off;  // no change of shape
    if (!flags.has_given("edges")) flags.settings.edges = EdgeChoice::feature;
    flags.size = flags.size.value_or(kCompareSize);
    if (flags.film.views.empty()) flags.film.views = usual_views();
    return flags;
}

/// Cameras of the flags' views, at one scale. outlines: of both models.
std::vector<Camera> cameras_of(const ModelPair& pair, const Scene& outlines, const CompareOptions& flags) {
    std::vector<ViewSettings> sides = given_sides(pair.a.source, flags, flags.film.views);
    for (ViewSettings& side : sides) side.any_side = false;
    const float aspect = static_cast<float>(flags.size->width) / static_cast<float>(flags.size->height);
    return frame_views(outlines, pair.bounds, aspect, sides);
}

}  // namespace

Result<ModelPair> load_pair(const CompareOptions& options) {
    CompareOptions flags = with_defaults(options);
    flags.scene = options.a;
    auto a = make_measured_job(flags);
    if (!a) return tl::unexpected(a.error());
    flags.scene = options.b;
    auto b = make_measured_job(flags);
    if (!b) return tl::unexpected(b.error());
    ModelPair pair{std::move(*a), std::move(*b), {}, {}, {}, {}};
    for (const auto& [name, job] : {std::pair<const char*, const RenderJob*>{"A", &pair.a}, {"B", &pair.b}})
        for (const std::string& warning : job->warnings) pair.warnings.push_back(fmt::format("{}: {}", name, warning));
    if (const auto moved = move_into(pair.a.source, pair.b); !moved) return tl::unexpected(moved.error());
    warn_of_units(pair);
    pair.bounds = pair.a.prepared->bounds();
    pair.bounds.include(pair.b.prepared->bounds());

    for (const GivenView& view : flags.film.views) pair.view_names.push_back(view.name);
    pair.cameras = cameras_of(pair, outlines_of(pair.a.scene(), pair.b.scene()), flags);

    // The same box, size of points and background for both.
    flags.kept_view = kept_view(pair.cameras.front(), pair.bounds, pair.a.settings, pair.a.source.placement);
    for (RenderJob* const job : {&pair.a, &pair.b})
        if (const auto changed = change_job(*job, flags, false); !changed) return tl::unexpected(changed.error());
    pair.b.settings.exposure = pair.a.settings.exposure;
    pair.b.settings.shading.emission_scale = pair.a.settings.shading.emission_scale;
    return pair;
}

std::vector<NamedCamera> other_sides(const ModelPair& pair, const CompareOptions& options) {
    CompareOptions flags = with_defaults(options);
    const Scene outlines = outlines_of(pair.a.scene(), pair.b.scene());
    std::vector<NamedCamera> out;
    const auto views = parse_views("back,left,bottom,-45,35,135,35,-135,35,45,-35,-45,-35,135,-35,-135,-35");
    for (const GivenView& view : *views) {
        flags.film.views = {view};
        out.push_back({view.name, cameras_of(pair, outlines, flags).front()});
    }
    return out;
}

}  // namespace halflit::engine
