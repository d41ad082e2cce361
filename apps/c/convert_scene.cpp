// Conversions of a scene's parts.
#include "apps/c/convert_parts.hpp"

namespace halflit::c {
namespace {

TextureUse texture_use(const halflit_texture_use& given, const char* member, Members& members) {
    TextureUse use;
    use.texture = given.texture;
    members.read(given.uv_set, 1, member, use.uv_set);
    members.read(given.wrap_u, TextureWrap::clamp, member, use.sampler.wrap_u);
    members.read(given.wrap_v, TextureWrap::clamp, member, use.sampler.wrap_v);
    members.read(given.mag_filter, TextureFilter::linear, member, use.sampler.mag);
    members.read(given.min_filter, TextureFilter::linear, member, use.sampler.min);
    members.read(given.mip_filter, MipFilter::linear, member, use.sampler.mip);
    use.row_u = vec3(given.row_u);
    use.row_v = vec3(given.row_v);
    return use;
}

halflit_texture_use to_c(const TextureUse& from) {
    halflit_texture_use use{};
    use.texture = from.texture;
    use.uv_set = from.uv_set;
    use.wrap_u = static_cast<std::int32_t>(from.sampler.wrap_u);
    use.wrap_v = static_cast<std::int32_t>(from.sampler.wrap_v);
    use.mag_filter = static_cast<std::int32_t>(from.sampler.mag);
    use.min_filter = static_cast<std::int32_t>(from.sampler.min);
    use.mip_filter = static_cast<std::int32_t>(from.sampler.mip);
    put(from.row_u, use.row_u);
    put(from.row_v, use.row_v);
    return use;
}

}  // namespace

Mat4 mat4(const float m[16]) { return {{vec4(m), vec4(m + 4), vec4(m + 8), vec4(m + 12)}}; }

void put(const Mat4& m, float to[16]) {
    for (int column = 0; column < 4; ++column) put(m.c[column], to + 4 * column);
}

// ---- loading -----------------------------------------------------------------------------------------------------------

halflit_load_options to_c(const LoadOptions& from) {
    halflit_load_options options{};
    options.size = sizeof options;
    options.max_file_bytes = from.limits.max_file_bytes;
    options.max_total_bytes = from.limits.max_total_bytes;
    options.max_json_tokens = from.limits.max_json_tokens;
    options.max_texture_bytes = from.limits.max_texture_bytes;
    options.max_texture_pixels = from.limits.max_texture_pixels;
    options.max_geometry_bytes = from.limits.max_geometry_bytes;
    options.max_lights = from.limits.max_lights;
    options.max_json_depth = from.limits.max_json_depth;
    options.max_texture_side = from.limits.max_texture_side;
    options.max_jpeg_scans = from.limits.max_jpeg_scans;
    options.lenient = from.lenient;
    options.threads = from.threads;
    options.keep_animations = from.keep_animations;
    options.time_s = from.time_s;
    options.turn_upright = from.turn_upright;
    options.crease_deg = from.crease_deg;
    options.recentre = from.recentre;
    return options;
}

Result<LoadOptions> load_options(const halflit_load_options* given) {
    LoadOptions options;
    if (given == nullptr) return options;
    const auto read = read_struct(given, to_c(options), "halflit_load_options");
    if (!read) return tl::unexpected<Error>(read.error());
    if (read->allow_external == nullptr && read->allow_external_count > 0)
        return fail(ErrorCode::usage, "halflit_load_options: allow_external is null, but allow_external_count is not 0");
    for (std::size_t i = 0; i < read->allow_external_count; ++i) {
        if (read->allow_external[i] == nullptr) return fail(ErrorCode::usage, "halflit_load_options: a folder of allow_external is null");
        options.allow_external.emplace_back(read->allow_external[i]);
    }
    options.lenient = read->lenient != 0;
    options.threads = read->threads;
    options.keep_animations = read->keep_animations != 0;
    if (read->animation != nullptr) options.animation = read->animation;
    if (read->scene != nullptr) options.scene = read->scene;
    if (read->variant != nullptr) options.variant = read->variant;
    options.time_s = read->time_s;
    options.turn_upright = read->turn_upright != 0;
    options.crease_deg = read->crease_deg;
    options.recentre = read->recentre != 0;
    options.limits.max_file_bytes = read->max_file_bytes;
    options.limits.max_total_bytes = read->max_total_bytes;
    options.limits.max_json_tokens = read->max_json_tokens;
    options.limits.max_texture_bytes = read->max_texture_bytes;
    options.limits.max_texture_pixels = read->max_texture_pixels;
    options.limits.max_geometry_bytes = read->max_geometry_bytes;
    options.limits.max_lights = read->max_lights;
    options.limits.max_json_depth = read->max_json_depth;
    options.limits.max_texture_side = read->max_texture_side;
    options.limits.max_jpeg_scans = read->max_jpeg_scans;
    return options;
}

Result<TextureColor> texture_color(std::int32_t given) {
    if (given == HALFLIT_COLOR_SRGB_BY_ALPHA) return TextureColor{ColorSpace::srgb, MipRule::alpha};
    if (given == HALFLIT_COLOR_NORMAL) return TextureColor{ColorSpace::linear, MipRule::normal};
    ColorSpace space = ColorSpace::srgb;
    Members members("texture");
    members.read(given, ColorSpace::linear, "color", space);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return TextureColor{space, MipRule::equal};
}

// ---- parts of a scene --------------------------------------------------------------------------------------------------

halflit_material to_c(const Material& from) {
    halflit_material material{};
    material.size = sizeof material;
    material.name = from.name.c_str();
    put(from.base_color, material.base_color);
    material.metallic = from.metallic;
    material.roughness = from.roughness;
    material.dielectric_reflectance = from.dielectric_reflectance;
    put(from.emissive, material.emissive);
    material.normal_scale = from.normal_scale;
    material.occlusion_strength = from.occlusion_strength;
    material.alpha_cutoff = from.alpha_cutoff;
    material.alpha_mode = static_cast<std::int32_t>(from.alpha_mode);
    material.double_sided = from.double_sided;
    material.unlit = from.unlit;
    material.own_lobe = from.has_own_lobe;
    material.shadow_catcher = from.shadow_catcher;
    material.lobe = to_c(from.lobe);
    material.base_color_texture = to_c(from.base_color_texture);
    material.metallic_roughness_texture = to_c(from.metallic_roughness_texture);
    material.normal_texture = to_c(from.normal_texture);
    material.occlusion_texture = to_c(from.occlusion_texture);
    material.emissive_texture = to_c(from.emissive_texture);
    material.transmission = from.transmission.share;
    material.thickness = from.transmission.thickness;
    material.attenuation_distance = from.transmission.attenuation_distance;
    put(from.transmission.attenuation_color, material.attenuation_color);
    material.transmission_texture = to_c(from.transmission.texture);
    material.thickness_texture = to_c(from.transmission.thickness_texture);
    material.specular = from.specular;
    put(from.specular_color, material.specular_color);
    material.specular_texture = to_c(from.specular_texture);
    material.specular_color_texture = to_c(from.specular_color_texture);
    material.clearcoat = from.clearcoat.factor;
    material.clearcoat_roughness = from.clearcoat.roughness;
    material.clearcoat_normal_scale = from.clearcoat.normal_scale;
    material.clearcoat_texture = to_c(from.clearcoat.texture);
    material.clearcoat_roughness_texture = to_c(from.clearcoat.roughness_texture);
    material.clearcoat_normal_texture = to_c(from.clearcoat.normal_texture);
    put(from.sheen.color, material.sheen_color);
    material.sheen_roughness = from.sheen.roughness;
    material.sheen_color_texture = to_c(from.sheen.color_texture);
    material.sheen_roughness_texture = to_c(from.sheen.roughness_texture);
    return material;
}

Result<Material> material(const halflit_material* given) {
    const Material defaults;
    auto default_struct = to_c(defaults);
    default_struct.name = nullptr;
    const auto read = read_struct(given, default_struct, "halflit_material");
    if (!read) return tl::unexpected<Error>(read.error());
    Material material;
    if (read->name != nullptr) material.name = read->name;
    material.base_color = vec4(read->base_color);
    material.metallic = read->metallic;
    material.roughness = read->roughness;
    material.dielectric_reflectance = read->dielectric_reflectance;
    material.emissive = vec3(read->emissive);
    material.normal_scale = read->normal_scale;
    material.occlusion_strength = read->occlusion_strength;
    material.alpha_cutoff = read->alpha_cutoff;
    material.double_sided = read->double_sided != 0;
    material.unlit = read->unlit != 0;
    material.has_own_lobe = read->own_lobe != 0;
    material.lobe = lobe(read->lobe);
    Members members("halflit_material");
    members.read(read->alpha_mode, AlphaMode::blend, "alpha_mode", material.alpha_mode);
    material.base_color_texture = texture_use(read->base_color_texture, "a value of base_color_texture", members);
    material.metallic_roughness_texture = texture_use(read->metallic_roughness_texture, "a value of metallic_roughness_texture", members);
    material.normal_texture = texture_use(read->normal_texture, "a value of normal_texture", members);
    material.occlusion_texture = texture_use(read->occlusion_texture, "a value of occlusion_texture", members);
    material.emissive_texture = texture_use(read->emissive_texture, "a value of emissive_texture", members);
    material.transmission.share = read->transmission;
    material.transmission.thickness = read->thickness;
    material.transmission.attenuation_distance = read->attenuation_distance;
    material.transmission.attenuation_color = vec3(read->attenuation_color);
    material.transmission.texture = texture_use(read->transmission_texture, "a value of transmission_texture", members);
    material.specular = read->specular;
    material.specular_color = vec3(read->specular_color);
    material.specular_texture = texture_use(read->specular_texture, "a value of specular_texture", members);
    material.specular_color_texture = texture_use(read->specular_color_texture, "a value of specular_color_texture", members);
    material.transmission.thickness_texture = texture_use(read->thickness_texture, "a value of thickness_texture", members);
    material.clearcoat.factor = read->clearcoat;
    material.clearcoat.roughness = read->clearcoat_roughness;
    material.clearcoat.normal_scale = read->clearcoat_normal_scale;
    material.clearcoat.texture = texture_use(read->clearcoat_texture, "a value of clearcoat_texture", members);
    material.clearcoat.roughness_texture =
        texture_use(read->clearcoat_roughness_texture, "a value of clearcoat_roughness_texture", members);
    material.clearcoat.normal_texture = texture_use(read->clearcoat_normal_texture, "a value of clearcoat_normal_texture", members);
    material.sheen.color = vec3(read->sheen_color);
    material.sheen.roughness = read->sheen_roughness;
    material.sheen.color_texture = texture_use(read->sheen_color_texture, "a value of sheen_color_texture", members);
    material.sheen.roughness_texture = texture_use(read->sheen_roughness_texture, "a value of sheen_roughness_texture", members);
    material.shadow_catcher = read->shadow_catcher != 0;
    members.finite("base_color", read->base_color);
    members.finite("metallic, roughness or dielectric_reflectance", read->metallic, read->roughness, read->dielectric_reflectance);
    members.finite("emissive", read->emissive);
    members.finite("normal_scale, occlusion_strength or alpha_cutoff", read->normal_scale, read->occlusion_strength, read->alpha_cutoff);
    members.finite("transmission or thickness", read->transmission, read->thickness);
    members.finite("attenuation_distance or attenuation_color", read->attenuation_distance, read->attenuation_color);
    members.finite("specular or specular_color", read->specular, read->specular_color);
    members.finite("clearcoat or clearcoat_roughness", read->clearcoat, read->clearcoat_roughness);
    members.finite("clearcoat_normal_scale", read->clearcoat_normal_scale);
    members.finite("sheen_color or sheen_roughness", read->sheen_color, read->sheen_roughness);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    if (auto ok = check_lobe(material.lobe); !ok) return fail(ErrorCode::usage, "halflit_material: lobe: " + ok.error().message);
    return material;
}

halflit_light to_c(const Light& from) {
    halflit_light light{};
    light.size = sizeof light;
    light.type = static_cast<std::int32_t>(from.type);
    put(from.color_linear, light.color);
    put(from.position_ws, light.position);
    put(from.direction_ws, light.direction);
    light.range = from.range;
    light.source_radius = from.source_radius;
    light.shadow_radius = from.shadow_radius;
    light.inner_cone_rad = from.inner_cone_rad;
    light.outer_cone_rad = from.outer_cone_rad;
    light.cone_power = from.cone_power;
    return light;
}

Result<Light> light(const halflit_light* given) {
    const auto read = read_struct(given, to_c(Light{}), "halflit_light");
    if (!read) return tl::unexpected<Error>(read.error());
    Light light;
    Members members("halflit_light");
    members.read(read->type, LightType::spot, "type", light.type);
    members.finite("color", read->color);
    members.finite("position", read->position);
    members.finite("direction", read->direction);
    members.finite("a cone angle or cone_power", read->inner_cone_rad, read->outer_cone_rad, read->cone_power);
    members.finite("source_radius or shadow_radius", read->source_radius, read->shadow_radius);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    light.color_linear = vec3(read->color);
    light.position_ws = vec3(read->position);
    light.direction_ws = vec3(read->direction);
    light.range = read->range;
    light.source_radius = read->source_radius;
    light.shadow_radius = read->shadow_radius;
    light.inner_cone_rad = read->inner_cone_rad;
    light.outer_cone_rad = read->outer_cone_rad;
    light.cone_power = read->cone_power;
    return light;
}

halflit_environment_options default_environment_options() {
    halflit_environment_options options{};
    options.size = sizeof options;
    options.extract_suns = 1;
    options.keep_image = 1;
    return options;
}

Result<EnvironmentRequest> environment_request(const halflit_environment_options* given) {
    const halflit_environment_options defaults = default_environment_options();
    const auto read = read_struct(given != nullptr ? given : &defaults, defaults, "halflit_environment_options");
    if (!read) return tl::unexpected<Error>(read.error());
    EnvironmentRequest request;
    request.options.extract_suns = read->extract_suns != 0;
    request.options.rotate_rad = read->rotate_rad;
    request.options.keep_image = request.options.keep_light = read->keep_image != 0;
    request.calibrated = read->calibrated != 0;
    return request;
}

halflit_mesh default_mesh() {
    halflit_mesh mesh{};
    mesh.size = sizeof mesh;
    mesh.material = -1;
    return mesh;
}

}  // namespace halflit::c
