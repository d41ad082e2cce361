// Conversions of a scene's parts.
#include "apps/c/convert_parts.hpp"
#include "shading/material_properties.hpp"

#include <string_view>
#include <type_traits>

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

/// Calls copy(given, option) for each member that both structs have.
template <class Given, class Options, class Copy>
void for_each_option(Given& given, Options& options, const Copy& copy) {
    copy(given.max_file_bytes, options.limits.max_file_bytes);
    copy(given.max_total_bytes, options.limits.max_total_bytes);
    copy(given.max_json_tokens, options.limits.max_json_tokens);
    copy(given.max_texture_bytes, options.limits.max_texture_bytes);
    copy(given.max_texture_pixels, options.limits.max_texture_pixels);
    copy(given.max_geometry_bytes, options.limits.max_geometry_bytes);
    copy(given.max_lights, options.limits.max_lights);
    copy(given.max_json_depth, options.limits.max_json_depth);
    copy(given.max_texture_side, options.limits.max_texture_side);
    copy(given.max_jpeg_scans, options.limits.max_jpeg_scans);
    copy(given.max_work, options.limits.max_work);
    copy(given.time_limit_s, options.limits.time_limit_s);
    copy(given.strict, options.strict);
    copy(given.threads, options.threads);
    copy(given.keep_animations, options.keep_animations);
    copy(given.time_s, options.time_s);
    copy(given.crease_deg, options.crease_deg);
    copy(given.recentre, options.recentre);
    copy(given.plate, options.plate);
    copy(given.detail_px, options.detail_px);
}

halflit_load_options to_c(const LoadOptions& from) {
    halflit_load_options options{};
    options.size = sizeof options;
    for_each_option(options, from, [](auto& given, const auto& option) { given = option; });
    options.up = from.up ? static_cast<std::int32_t>(*from.up) + 1 : HALFLIT_UP_BY_FORMAT;
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
    if (read->importers == nullptr && read->importers_count > 0)
        return fail(ErrorCode::usage, "halflit_load_options: importers is null, but importers_count is not 0");
    for (std::size_t i = 0; i < read->importers_count; ++i) {
        const auto importer = Importer::from(read->importers[i] == nullptr ? "" : read->importers[i]);
        if (!importer) return fail(ErrorCode::usage, "halflit_load_options: importers: " + importer.error().message);
        options.importers.push_back(*importer);
    }
    if (read->animation != nullptr) options.animation = read->animation;
    if (read->scene != nullptr) options.scene = read->scene;
    if (read->variant != nullptr) options.variant = read->variant;
    if (read->up < HALFLIT_UP_BY_FORMAT || read->up > HALFLIT_UP_MINUS_Z)
        return fail(ErrorCode::usage, "halflit_load_options: up is no HALFLIT_UP");
    if (read->up != HALFLIT_UP_BY_FORMAT) options.up = static_cast<UpAxis>(read->up - 1);
    Members members("halflit_load_options");
    if (!(read->time_limit_s >= 0.0)) members.wrong("time_limit_s", "is not 0 or more");
    if (!(read->crease_deg >= 0.0f && read->crease_deg <= 180.0f)) members.wrong("crease_deg", "is not from 0 to 180");
    if (!(read->detail_px >= 1.0 && read->detail_px <= 1e6)) members.wrong("detail_px", "is not from 1 to 1e6");
    if (read->plate < 0) members.wrong("plate", "is " + std::to_string(read->plate) + ", expected 0 or more");
    if (read->threads < 0 || read->threads > kMostThreads)
        members.wrong("threads", "is " + std::to_string(read->threads) + ", expected 0 to " + std::to_string(kMostThreads));
    members.finite("time_s", read->time_s);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    for_each_option(*read, options, [](const auto& value, auto& option) { option = static_cast<std::decay_t<decltype(option)>>(value); });
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

/// The first float of a member that is one number or a few.
template <class Numbers>
auto* first(Numbers& numbers) {
    if constexpr (std::is_array_v<Numbers>)
        return &numbers[0];
    else
        return &numbers;
}

halflit_material to_c(const Material& from) {
    halflit_material material{};
    material.size = sizeof material;
    material.name = from.name.c_str();
    material.alpha_mode = static_cast<std::int32_t>(from.alpha_mode);
    material.double_sided = from.double_sided;
    material.unlit = from.unlit;
    material.own_lobe = from.has_own_lobe;
    material.shadow_catcher = from.shadow_catcher;
    material.lobe = to_c(from.lobe);
#define HALFLIT_NUMBER(member, ...) shading::get_numbers(from.member, first(material.member));
#define HALFLIT_TEXTURE(slot, ...) material.slot##_texture = to_c(from.textures[TextureSlot::slot]);
#include "shading/material_properties.def"
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
    material.double_sided = read->double_sided != 0;
    material.unlit = read->unlit != 0;
    material.has_own_lobe = read->own_lobe != 0;
    material.lobe = lobe(read->lobe);
    material.shadow_catcher = read->shadow_catcher != 0;
    Members members("halflit_material");
    members.read(read->alpha_mode, AlphaMode::blend, "alpha_mode", material.alpha_mode);
#define HALFLIT_NUMBER(member, ...)        \
    members.finite(#member, read->member); \
    shading::set_numbers(material.member, first(read->member));
#define HALFLIT_TEXTURE(slot, ...) \
    material.textures[TextureSlot::slot] = texture_use(read->slot##_texture, "a value of " #slot "_texture", members);
#include "shading/material_properties.def"
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    if (auto ok = check_lobe(material.lobe); !ok) return fail(ErrorCode::usage, "halflit_material: lobe: " + ok.error().message);
    return material;
}

halflit_light to_c(const CallersLight& given) {
    halflit_light light{};
    light.size = sizeof light;
    light.type = static_cast<std::int32_t>(given.light.type);
#define HALFLIT_LIGHT(member, name, ...) shading::get_numbers(given.light.member, first(light.name));
#include "shading/light_members.def"
    put(given.rest, light.position_rest);
    return light;
}

Result<CallersLight> light(const halflit_light* given) {
    const auto read = read_struct(given, to_c(CallersLight{}), "halflit_light");
    if (!read) return tl::unexpected<Error>(read.error());
    Light light;
    Members members("halflit_light");
    members.read(read->type, LightType::spot, "type", light.type);
#define HALFLIT_LIGHT(member, name, having, quantity, low, high)                            \
    if constexpr (std::string_view(#high) != "kEndless") members.finite(#name, read->name); \
    shading::set_numbers(light.member, first(read->name));
#include "shading/light_members.def"
    members.finite("position", read->position_rest);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return CallersLight{light, vec3(read->position_rest)};
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

halflit_instance to_c(const CallersInstance& given) {
    const Instance& from = given.instance;
    halflit_instance instance{};
    instance.size = sizeof instance;
    instance.mesh = from.mesh;
    instance.material = from.material;
    instance.visible = from.visible;
    instance.node = -1;
    put(from.color, instance.color);
    put(from.world_from_object, instance.world_from_object);
    put(given.rest, instance.place_rest);
    return instance;
}

Result<CallersInstance> instance(const halflit_instance* given) {
    const auto read = read_struct(given, to_c(CallersInstance{}), "halflit_instance");
    if (!read) return tl::unexpected<Error>(read.error());
    Members members("halflit_instance");
    members.finite("color", read->color);
    members.finite("place_rest", read->place_rest);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return CallersInstance{{read->mesh, mat4(read->world_from_object), read->material, vec4(read->color), read->visible != 0},
                           vec3(read->place_rest)};
}

halflit_mesh default_mesh() {
    halflit_mesh mesh{};
    mesh.size = sizeof mesh;
    mesh.material = -1;
    return mesh;
}

halflit_splats default_splats() {
    halflit_splats splats{};
    splats.size = sizeof splats;
    return splats;
}

}  // namespace halflit::c
