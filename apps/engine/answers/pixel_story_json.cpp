#include "apps/engine/answers/pixel_story_json.hpp"

#include "apps/engine/answers/pixel_story_text.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "shading/material_properties.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <utility>

namespace halflit::engine {
namespace {

void move_out(SurfaceOnRay& hit, const Placement& placement) {
    hit.position = placement.out(hit.position);
    hit.distance /= placement.scale;
}

Json place_json(Vec3d v) { return {v.x, v.y, v.z}; }

Json hit_json(const SurfaceOnRay& hit, const NameOfInstance& name) {
    return {{"triangle", hit.triangle},
            {"mesh", hit.mesh},
            {"mesh_name", hit.mesh_name},
            {"instance", hit.instance},
            {"node", name ? name(hit.instance) : ""},
            {"material", hit.material_name},
            {"position", place_json(hit.position)},
            {"distance", hit.distance},
            {"barycentrics", hit.barycentrics},
            {"back", hit.back},
            {"layer", hit.layer},
            {"alpha", hit.alpha}};
}

Json hits_json(const std::vector<SurfaceOnRay>& hits, const NameOfInstance& name) {
    Json list = Json::array();
    for (const SurfaceOnRay& hit : hits) list.push_back(hit_json(hit, name));
    return list;
}

/// All numbers of the material, by the names of Material's members.
Json factors_json(const Material& material) {
    Json factors = Json::object();
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        float values[4] = {};
        number.get(material, values);
        Json list = Json::array();
        for (int i = 0; i < number.count; ++i) list.push_back(json_number(values[i]));
        factors[std::string(number.name)] = number.count == 1 ? list[0] : list;
    }
    return factors;
}

Json surface_json(const PixelStory& story, const NameOfInstance& name) {
    Json corners = Json::array(), uv = Json::array(), textures = Json::array();
    for (const Vec3d& corner : story.corners) corners.push_back(place_json(corner));
    for (const Vec2<double>& at : story.uv) uv.push_back({at.x, at.y});
    for (const TextureAt& at : story.textures)
        textures.push_back({{"slot", shading::info_of(at.slot).name},
                            {"texture", at.texture},
                            {"uv_set", at.uv_set},
                            {"uv", {at.u, at.v}},
                            {"value", at.full_size}});
    return {
        {"triangle", story.triangle},
        {"mesh", story.mesh},
        {"instance", story.instance},
        {"material", story.material.name},
        {"topology", topology_name(story.topology)},
        {"mesh_name", story.mesh_name},
        {"node", name ? name(story.instance) : ""},
        {"material_index", story.material_index < 0 ? Json() : Json(story.material_index)},
        {"lobe", {{"wrap", json_number(story.lobe.wrap)}, {"power", json_number(story.lobe.power)}, {"normalize", story.lobe.normalize}}},
        {"factors", factors_json(story.material)},
        {"alpha_mode", alpha_mode_name(story.material.alpha_mode)},
        {"double_sided", story.material.double_sided},
        {"unlit", story.material.unlit},
        {"textures", std::move(textures)},
        {"back", story.back},
        {"depth", story.depth},
        {"position", place_json(story.position)},
        {"position_error", story.position_error},
        {"normal", place_json(story.normal)},
        {"albedo", story.albedo},
        {"corners", std::move(corners)},
        {"barycentrics", story.barycentrics},
        {"uv", std::move(uv)}};
}

Json share_json(const LightShare& share, const NameOfInstance& name) {
    return {{"light", share.index},       {"type", kind_of(share.type).name},
            {"distance", share.distance}, {"cosine", share.cosine},
            {"lobe", share.lobe},         {"unhidden", share.unhidden ? Json(*share.unhidden) : Json()},
            {"linear", share.linear},     {"hidden_by", share.hidden_by ? hit_json(*share.hidden_by, name) : Json()}};
}

}  // namespace

PixelStory in_file(PixelStory story, const Placement& placement) {
    for (std::vector<SurfaceOnRay>* hits : {&story.layers, &story.behind})
        for (SurfaceOnRay& hit : *hits) move_out(hit, placement);
    for (SplatShare& splat : story.splats) splat.depth /= placement.scale;
    for (LightShare& share : story.shares) {
        share.distance /= placement.scale;
        if (share.hidden_by) move_out(*share.hidden_by, placement);
    }
    if (story.shows != PixelShows::surface) return story;
    story.position = placement.out(story.position);
    story.normal = turned_back(story.normal, placement.up);
    for (Vec3d& corner : story.corners) corner = placement.out(corner);
    story.position_error /= placement.scale, story.depth /= placement.scale;
    return story;
}

Json story_json(const PixelStory& story, const NameOfInstance& name) {
    Json lights = Json::array();
    for (const LightShare& share : story.shares) lights.push_back(share_json(share, name));
    Json pixel{{"at", {story.x, story.y}}, {"codes", story.codes}};
    pixel["shows"] = shows_name(story.shows);
    pixel["background_kind"] = background_name(story.background_kind);
    pixel["contact_shadow"] = story.contact_shadow;
    pixel["surface"] = story.shows == PixelShows::surface ? surface_json(story, name) : Json();
    Json splats = Json::array();
    for (const SplatShare& splat : story.splats)
        splats.push_back({{"splat", splat.splat},
                          {"mesh", splat.mesh},
                          {"instance", splat.instance},
                          {"node", name ? name(splat.instance) : ""},
                          {"depth", splat.depth},
                          {"alpha", splat.alpha},
                          {"weight", splat.weight},
                          {"color", splat.color}});
    pixel["splats"] = std::move(splats);
    pixel["splats_left_out"] = story.splats_left_out;
    pixel["splats_passed"] = story.splats_passed;
    pixel["layers"] = hits_json(story.layers, name);
    pixel["behind"] = hits_json(story.behind, name);
    pixel["lights"] = std::move(lights);
    pixel["lights_left_out"] = story.lights_left_out;
    pixel["around"] = story.around;
    pixel["emitted"] = story.emitted;
    pixel["background"] = story.background;
    pixel["linear"] = story.linear;
    pixel["alpha"] = story.alpha;
    pixel["coverage"] = story.coverage;
    pixel["error_codes"] = story.no_reference.empty() ? Json(story.error_codes) : Json();
    pixel["bound_codes"] = story.bound_codes > 0.0 ? Json(story.bound_codes) : Json();
    return pixel;
}

}  // namespace halflit::engine
