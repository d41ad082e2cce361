#include "apps/engine/answers/scene_description.hpp"

#include "apps/engine/answers/measures_json.hpp"
#include "apps/engine/answers/part_list.hpp"
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "raster/frame_plan.hpp"
#include "raster/geometry/mesh_topology.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace halflit::engine {
namespace {

Json vector_json(Vec3f v) { return {json_number(v.x), json_number(v.y), json_number(v.z)}; }

/// In the file's coordinates. Quarter turns may exchange the ends of an axis.
Json bounds_json(const Bounds& drawn, const Placement& placement) {
    if (drawn.empty) return nullptr;
    Bounds bounds;
    for (const Vec3f corner : {drawn.min, drawn.max}) bounds.add(to_float(placement.out(to_double(corner))));
    return {{"min", vector_json(bounds.min)}, {"max", vector_json(bounds.max)}};
}

Json names_json(const std::vector<std::string>& names) {
    Json list = Json::array();
    for (const std::string& name : names) {
        check_time();
        list.push_back(name);
    }
    return list;
}

Json file_json(const SceneInfo& file) {
    return {{"format", file.format},
            {"version", file.version},
            {"generator", file.generator},
            {"scenes", file.scenes},
            {"scene_names", names_json(file.scene_names)},
            {"scene", file.scene < 0 ? Json() : Json(file.scene)},
            {"variants", names_json(file.variants)},
            {"nodes", file.nodes},
            {"meshes", file.meshes},
            {"primitives", file.primitives},
            {"materials", file.materials},
            {"textures", file.textures},
            {"images", file.images},
            {"cameras", file.cameras},
            {"lights", file.lights},
            {"animations", file.animations},
            {"skins", file.skins},
            {"morph_targets", file.morph_targets},
            {"detail_px", file.detail_px},
            {"point_and_line_primitives", file.point_and_line_primitives},
            {"extensions_used", names_json(file.extensions_used)},
            {"extensions_required", names_json(file.extensions_required)}};
}

/// Name of the way in which all splats of the scene are drawn; null: there are none, or several ways.
Json splat_reference_json(const Scene& scene) {
    std::optional<SplatReference> found;
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.splats == nullptr) continue;
        if (found && *found != mesh.splats->reference) return nullptr;
        found = mesh.splats->reference;
    }
    return found ? Json(splat_reference_name(*found)) : Json();
}

Json counts_json(const Scene& scene, const Lighting& light) {
    std::uint64_t vertices = 0, stored = 0, drawn = 0, closed = 0, lines = 0, points = 0, splats = 0;
    for (const Mesh& mesh : scene.meshes) {
        closed += raster::is_closed(mesh) ? 1 : 0;
        vertices += mesh.positions.size();
        stored += triangles_of(mesh);
    }
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        drawn += triangles_of(mesh);
        if (mesh.topology == Topology::lines) lines += mesh.indices.size() / 2;
        if (is_cloud(mesh)) points += mesh.indices.size();
        if (mesh.splats != nullptr) splats += mesh.splats->opacities.size();
    }
    return {{"meshes", scene.meshes.size()},
            {"closed_meshes", closed},
            {"instances", scene.instances.size()},
            {"materials", scene.materials.size()},
            {"textures", scene.textures.size()},
            {"cameras", scene.cameras.size()},
            {"lights", light.all_lights().size()},
            {"vertices", vertices},
            {"triangles_stored", stored},
            {"triangles_drawn", drawn},
            {"lines_drawn", lines},
            {"points_drawn", points},
            {"splats_drawn", splats},
            {"splat_reference", splat_reference_json(scene)}};
}

/// Coordinates and lengths are the file's; so is the colour of a light at distance 1.
Json lights_json(const Lighting& drawn, const Placement& placement) {
    Json lights = Json::array();
    for (Light light : drawn.all_lights()) {
        io::scale_lengths(light, 1.0 / placement.scale);
        Json one{{"type", kind_of(light.type).name}, {"color", vector_json(light.color_linear)}};
        if (kind_of(light.type).placed) one["position"] = vector_json(to_float(placement.out(to_double(light.position_ws))));
        if (kind_of(light.type).aimed) one["direction"] = vector_json(to_float(turned_back(to_double(light.direction_ws), placement.up)));
        if (light.range > 0) one["range"] = json_number(light.range);
        lights.push_back(std::move(one));
    }
    return lights;
}

Json environment_json(const shading::ShadingPlan& frame, int index, const Settings& settings) {
    const shading::EnvironmentPlan& plan = frame.environments[static_cast<std::size_t>(index)];
    return environment_use_json({plan.bands, plan.bound, plan.within}, settings);
}

/// Approximations that the error budget allows.
Json savings_json(const shading::ShadingPlan& frame, const shading::MaterialPlan& plan) {
    const bool power = plan.lobe.path == shading::LobePath::general, curve = plan.lobe.path == shading::LobePath::curve;
    Json savings{{"lobe_power", power ? tier_name(plan.lobe.tier) : curve ? "curve" : "not needed"}};
    if ((plan.stages & kStageSpecular) != 0) {
        savings["specular_power"] = specular_power_name(plan);
        savings["specular_left_out_below"] = json_number(plan.specular_threshold);
    }
    std::size_t limited = 0;
    for (const shading::LightPlan& light : frame.lights) limited += light.cutoff_squared > 0.0f ? 1 : 0;
    savings["lights_with_a_cutoff_radius"] = limited;
    return savings;
}

Json material_json(const Material& source, const shading::ShadingPlan& frame, const shading::MaterialPlan& plan, const Settings& settings) {
    const ShadingSettings& options = settings.shading;
    Json needed = Json::array(), not_needed = Json::array();
    for (std::size_t bit = 0; bit < std::size(kStageNames); ++bit)
        ((plan.stages >> bit & 1u) != 0 ? needed : not_needed).push_back(kStageNames[bit]);
    Json material{{"name", source.name}, {"alpha", alpha_mode_name(plan.alpha_mode)}, {"double_sided", plan.double_sided}};
    if (plan.stages & (kStageLights | kStageEnvironment)) {
        const Lobe& lobe = shading::lobe_of(source, options);
        material["lobe"] = {{"wrap", json_number(lobe.wrap)},
                            {"power", json_number(lobe.power)},
                            {"normalize", lobe.normalize},
                            {"computed_as", lobe_path_name(plan.lobe.path)}};
    }
    if (plan.environment >= 0) material["environment"] = environment_json(frame, plan.environment, settings);
    if (plan.reflection_lobes > 0) material["reflection_lobes"] = plan.reflection_lobes;
    if (frame.error.budget > 0.0) material["savings"] = savings_json(frame, plan);
    material["requires"] = std::move(needed);
    material["does_without"] = std::move(not_needed);
    return material;
}

/// Number of lights of each type that are computed. Black lights and lights that are not finite are left out.
Json planned_lights_json(const shading::ShadingPlan& plan) {
    std::size_t count[std::size(kLightKinds)] = {};
    for (const shading::LightPlan& light : plan.lights) ++count[static_cast<std::size_t>(light.type)];
    Json lights = Json::object();
    for (std::size_t type = 0; type < std::size(kLightKinds); ++type) lights[std::string(kLightKinds[type].name)] = count[type];
    return lights;
}

/// The frame's shadow maps: one per light that casts shadows, or its cascades, with the number of faces that see the scene.
Json shadows_json(const raster::FramePlan& frame, const Settings& settings) {
    constexpr std::string_view kKinds[] = {"orthographic", "perspective", "cube"};
    Json maps = Json::array();
    std::size_t view = 0;
    std::size_t sky_maps = 0;
    for (const shading::LightPlan& light : frame.shading.sky) sky_maps += light.shadow_map >= 0 ? 1 : 0;
    const auto maps_of_lights = std::span(frame.shading.shadow_maps).first(frame.shading.shadow_maps.size() - sky_maps);
    for (const shading::ShadowMapPlan& map : maps_of_lights) {
        const std::size_t faces = map.kind == shading::ShadowMapPlan::Kind::cube ? 6 : 1;
        std::size_t drawn = 0;
        for (std::size_t i = 0; i < faces; ++i) drawn += frame.shadow_views[view++].sees_casters ? 1 : 0;
        maps.push_back({{"kind", kKinds[static_cast<std::size_t>(map.kind)]}, {"texels", map.size}, {"faces_drawn", drawn}});
    }
    return {{"mode", shadow_mode_name(settings.shadows)}, {"maps", std::move(maps)}, {"sky_maps", sky_maps}};
}

Json materials_json(const RenderJob& job, const shading::ShadingPlan& plan) {
    const raster::PreparedData& scene = job.prepared->data();
    const std::vector<bool>& used = scene.drawn_materials();
    Json materials = Json::array();
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            materials.push_back(material_json(scene.material(i), plan, plan.materials[i], job.settings));
            if (i == scene.scene().materials.size()) materials.back()["name"] = "(none)";
        }
    return materials;
}

/// The decisions of the frame's plan.
Result<Json> plan_json(const RenderJob& job) {
    const auto frame = raster::plan_frame(job.prepared->data(), job.light, job.camera, job.settings, job.width, job.height);
    if (!frame) return tl::unexpected(frame.error());
    const shading::ShadingPlan& plan = frame->shading;
    Json json;
    if (plan.error.budget > 0.0) json["error_bound"] = error_bound_json(plan.error);
    json["lights_computed"] = planned_lights_json(plan);
    json["shadows"] = shadows_json(*frame, job.settings);
    json["materials"] = materials_json(job, plan);
    return json;
}

}  // namespace

Flag parts_flag(bool& measure_parts) { return {"--parts", "", "Measure each part: size, area, volume", set_to(measure_parts)}; }

Result<std::string> describe_scene(const RenderJob& job, bool json, bool measure_parts) {
    const Scene& scene = job.scene();
    Json description = json ? report_head("info") : Json::object();
    description["scene"] = job.source.name;
    if (job.source.file) description["file"] = file_json(*job.source.file);
    description["drawn"] = counts_json(scene, job.light);
    description["bounds"] = bounds_json(job.prepared->bounds(), job.source.placement);
    auto measures = measures_json(job);
    if (!measures) return tl::unexpected(measures.error());
    if (!json && measures->is_object()) measures->erase("body_list");  // a dozen lines for each body
    description["measures"] = std::move(*measures);
    auto parts = json ? parts_json(job, measure_parts) : parts_text(job, measure_parts);
    if (!parts) return tl::unexpected(parts.error());
    description["parts"] = std::move(*parts);
    Json cameras = Json::array();
    for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
    description["cameras"] = std::move(cameras);
    Json animations = Json::array();
    for (const AnimationInfo& animation : job.source.animations) {
        check_time();
        animations.push_back({{"name", animation.name}, {"end_s", animation.end_s}, {"channels", animation.channels}});
    }
    description["animations"] = std::move(animations);
    if (job.animation() != nullptr) description["pose"] = pose_json(job);
    description["size"] = {job.width, job.height};
    description["exposure"] = json_number(job.settings.exposure);
    description["tone_curve"] = tone_curve_name(job.settings.tone_curve);
    description["lights"] = lights_json(job.light, job.source.placement);
    const Ambient& ambient = job.light.ambient;
    description["ambient"] = {{"sky", vector_json(ambient.sky_linear)}, {"ground", vector_json(ambient.ground_linear)}};
    const auto plan = plan_json(job);
    if (!plan) return tl::unexpected(plan.error());
    description.update(*plan);
    description["warnings"] = job.warnings;
    return json ? to_text(description) : to_lines(description);
}

Result<std::string> describe_plan(const RenderJob& job) {
    const auto plan = plan_json(job);
    if (!plan) return tl::unexpected(plan.error());
    return to_lines(*plan);
}

}  // namespace halflit::engine
