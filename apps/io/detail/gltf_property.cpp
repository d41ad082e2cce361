#include "apps/io/detail/gltf_property.hpp"

#include <charconv>
#include <iterator>
#include <vector>

namespace halflit::io::detail {

namespace {

using file::File;
using I = std::size_t;

/// The numbers of a list that may be empty, which means that all have their default.
double* numbers(std::vector<double>& list, std::size_t count, double otherwise) {
    list.resize(count, otherwise);
    return list.data();
}

file::Transform* transform_of(File& f, I node) {
    const int transform = f.nodes[node].transform;
    return transform < 0 ? nullptr : &f.transforms[static_cast<std::size_t>(transform)];
}

file::MaterialExtensions* extensions_of(File& f, I material) {
    const int at = f.materials[material].extended;
    return at < 0 ? nullptr : &f.extended[static_cast<std::size_t>(at)];
}

template <auto Member>
double* of_transform(File& f, I node) {
    file::Transform* const transform = transform_of(f, node);
    return transform == nullptr || transform->matrix ? nullptr : transform->*Member;
}
template <auto Member>
double* of_light(File& f, I light) {
    return &(f.lights[light].*Member);
}
template <auto Which, auto Member>
double* of_camera(File& f, I camera) {
    std::optional<file::Projection>& projection = f.cameras[camera].*Which;
    return projection ? &((*projection).*Member) : nullptr;
}
template <auto Member>
double* of_perspective(File& f, I camera) {
    return of_camera<&file::Camera::perspective, Member>(f, camera);
}
template <auto Member>
double* of_orthographic(File& f, I camera) {
    return of_camera<&file::Camera::orthographic, Member>(f, camera);
}
/// Metal and roughness, which KHR_materials_pbrSpecularGlossiness replaces.
template <auto Member>
double* of_metal(File& f, I material) {
    const file::MaterialExtensions* const more = extensions_of(f, material);
    return more != nullptr && more->specular_glossiness ? nullptr : &(f.materials[material].*Member);
}
template <auto Member>
double* of_material(File& f, I material) {
    return &(f.materials[material].*Member);
}
template <auto Member>
double* of_extension(File& f, I material) {
    file::MaterialExtensions* const more = extensions_of(f, material);
    return more == nullptr ? nullptr : &(more->*Member);
}
template <auto Member>
double* color_of_extension(File& f, I material) {
    file::MaterialExtensions* const more = extensions_of(f, material);
    return more == nullptr ? nullptr : numbers(more->*Member, 3, 1.0);
}

using file::Projection;
constexpr std::string_view kNodes = "/nodes", kMeshes = "/meshes", kLights = "/extensions/KHR_lights_punctual/lights",
                           kCameras = "/cameras", kMaterials = "/materials";

constexpr Property kProperties[] = {
    {kNodes, "/translation", Part::transform, 3, of_transform<&file::Transform::translation>},
    {kNodes, "/rotation", Part::transform, 4, of_transform<&file::Transform::rotation>},
    {kNodes, "/scale", Part::transform, 3, of_transform<&file::Transform::scale>},
    {kNodes, "/weights", Part::weights, 0,
     [](File& f, I i) { return f.nodes[i].weights.count == 0 ? nullptr : &f.weights[f.nodes[i].weights.first]; }},
    {kNodes, "/extensions/KHR_node_visibility/visible", Part::visibility, 1, [](File& f, I i) { return &f.nodes[i].visible; }},
    {kMeshes, "/weights", Part::weights, 0,
     [](File& f, I i) { return f.meshes[i].weights.empty() ? nullptr : f.meshes[i].weights.data(); }},
    {kLights, "/color", Part::light, 3, [](File& f, I i) { return numbers(f.lights[i].color, 3, 1.0); }},
    {kLights, "/intensity", Part::light, 1, of_light<&file::Light::intensity>},
    {kLights, "/range", Part::light, 1, of_light<&file::Light::range>},
    {kLights, "/spot/innerConeAngle", Part::light, 1, of_light<&file::Light::inner_cone_angle>},
    {kLights, "/spot/outerConeAngle", Part::light, 1, of_light<&file::Light::outer_cone_angle>},
    {kCameras, "/perspective/yfov", Part::camera, 1, of_perspective<&Projection::yfov>},
    {kCameras, "/perspective/aspectRatio", Part::camera, 1, of_perspective<&Projection::aspect_ratio>},
    {kCameras, "/perspective/znear", Part::camera, 1, of_perspective<&Projection::znear>},
    {kCameras, "/perspective/zfar", Part::camera, 1, of_perspective<&Projection::zfar>},
    {kCameras, "/orthographic/xmag", Part::camera, 1, of_orthographic<&Projection::xmag>},
    {kCameras, "/orthographic/ymag", Part::camera, 1, of_orthographic<&Projection::ymag>},
    {kCameras, "/orthographic/znear", Part::camera, 1, of_orthographic<&Projection::znear>},
    {kCameras, "/orthographic/zfar", Part::camera, 1, of_orthographic<&Projection::zfar>},
    {kMaterials, "/pbrMetallicRoughness/baseColorFactor", Part::material, 4,
     [](File& f, I i) {
         auto* const list = &f.materials[i].base_color_factor;
         const file::MaterialExtensions* const more = extensions_of(f, i);
         return more != nullptr && more->specular_glossiness ? nullptr : numbers(*list, 4, 1.0);
     }},
    {kMaterials, "/pbrMetallicRoughness/metallicFactor", Part::material, 1, of_metal<&file::Material::metallic_factor>},
    {kMaterials, "/pbrMetallicRoughness/roughnessFactor", Part::material, 1, of_metal<&file::Material::roughness_factor>},
    {kMaterials, "/alphaCutoff", Part::material, 1, of_material<&file::Material::alpha_cutoff>},
    {kMaterials, "/emissiveFactor", Part::material, 3, [](File& f, I i) { return numbers(f.materials[i].emissive_factor, 3, 0.0); }},
    {kMaterials, "/extensions/KHR_materials_emissive_strength/emissiveStrength", Part::material, 1,
     of_material<&file::Material::emissive_strength>},
    {kMaterials, "/extensions/KHR_materials_ior/ior", Part::material, 1, of_metal<&file::Material::ior>},
    {kMaterials, "/normalTexture/scale", Part::material, 1, [](File& f, I i) { return &f.materials[i].normal_texture.scale; }},
    {kMaterials, "/occlusionTexture/strength", Part::material, 1, [](File& f, I i) { return &f.materials[i].occlusion_texture.strength; }},
    {kMaterials, "/extensions/KHR_materials_transmission/transmissionFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::transmission_factor>},
    {kMaterials, "/extensions/KHR_materials_volume/thicknessFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::thickness_factor>},
    {kMaterials, "/extensions/KHR_materials_volume/attenuationDistance", Part::material, 1,
     of_extension<&file::MaterialExtensions::attenuation_distance>},
    {kMaterials, "/extensions/KHR_materials_volume/attenuationColor", Part::material, 3,
     color_of_extension<&file::MaterialExtensions::attenuation_color>},
    {kMaterials, "/extensions/KHR_materials_specular/specularFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::specular_factor>},
    {kMaterials, "/extensions/KHR_materials_specular/specularColorFactor", Part::material, 3,
     color_of_extension<&file::MaterialExtensions::specular_color_factor>},
    {kMaterials, "/extensions/KHR_materials_clearcoat/clearcoatFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::clearcoat_factor>},
    {kMaterials, "/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::clearcoat_roughness_factor>},
    {kMaterials, "/extensions/KHR_materials_sheen/sheenColorFactor", Part::material, 3,
     color_of_extension<&file::MaterialExtensions::sheen_color_factor>},
    {kMaterials, "/extensions/KHR_materials_sheen/sheenRoughnessFactor", Part::material, 1,
     of_extension<&file::MaterialExtensions::sheen_roughness_factor>},
};

/// A place where a material names a texture.
struct Place {
    std::string_view path;
    file::TexturePlace* (*at)(File& file, I material);
};
template <auto Member>
file::TexturePlace* place(File& f, I material) {
    return &(f.materials[material].*Member);
}
template <auto Member>
file::TexturePlace* extended_place(File& f, I material) {
    file::MaterialExtensions* const more = extensions_of(f, material);
    return more == nullptr ? nullptr : &(more->*Member);
}
constexpr Place kPlaces[] = {
    {"/pbrMetallicRoughness/baseColorTexture", place<&file::Material::base_color_texture>},
    {"/pbrMetallicRoughness/metallicRoughnessTexture", place<&file::Material::metallic_roughness_texture>},
    {"/normalTexture", place<&file::Material::normal_texture>},
    {"/occlusionTexture", place<&file::Material::occlusion_texture>},
    {"/emissiveTexture", place<&file::Material::emissive_texture>},
    {"/extensions/KHR_materials_transmission/transmissionTexture", extended_place<&file::MaterialExtensions::transmission_texture>},
    {"/extensions/KHR_materials_volume/thicknessTexture", extended_place<&file::MaterialExtensions::thickness_texture>},
    {"/extensions/KHR_materials_specular/specularTexture", extended_place<&file::MaterialExtensions::specular_texture>},
    {"/extensions/KHR_materials_specular/specularColorTexture", extended_place<&file::MaterialExtensions::specular_color_texture>},
};

/// Of KHR_texture_transform, below a place.
constexpr Property kTransforms[] = {
    {kMaterials, "/extensions/KHR_texture_transform/offset", Part::material, 2, nullptr},
    {kMaterials, "/extensions/KHR_texture_transform/rotation", Part::material, 1, nullptr},
    {kMaterials, "/extensions/KHR_texture_transform/scale", Part::material, 2, nullptr},
};

double* of_texture_transform(file::TexturePlace& place, const Property& property) {
    if (!place.transform) place.transform.emplace();
    if (&property == &kTransforms[0]) return numbers(place.transform->offset, 2, 0.0);
    if (&property == &kTransforms[1]) return &place.transform->rotation;
    return numbers(place.transform->scale, 2, 1.0);
}

std::size_t size_of_list(const File& file, std::string_view list) {
    if (list == kNodes) return file.nodes.size();
    if (list == kMeshes) return file.meshes.size();
    if (list == kLights) return file.lights.size();
    return list == kCameras ? file.cameras.size() : file.materials.size();
}

/// Takes "/3" from the front of a pointer.
std::optional<int> take_index(const File& file, std::string_view list, std::string_view& rest) {
    if (rest.size() < 2 || rest[0] != '/') return std::nullopt;
    int index = -1;
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
    if (error != std::errc{} || index < 0 || static_cast<std::size_t>(index) >= size_of_list(file, list)) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    return index;
}

std::optional<Slot> find_texture_slot(int material, std::string_view path) {
    for (std::size_t p = 0; p < std::size(kPlaces); ++p) {
        if (!path.starts_with(kPlaces[p].path)) continue;
        for (const Property& property : kTransforms)
            if (path.substr(kPlaces[p].path.size()) == property.path) return Slot{&property, material, static_cast<int>(p), property.count};
    }
    return std::nullopt;
}

}  // namespace

bool Slot::is_rotation() const { return property->part == Part::transform && property->count == 4; }

std::optional<Slot> find_slot(const File& file, std::string_view pointer) {
    for (const std::string_view list : {kNodes, kMeshes, kLights, kCameras, kMaterials}) {
        std::string_view rest = pointer;
        if (!rest.starts_with(list)) continue;
        rest.remove_prefix(list.size());
        const std::optional<int> element = take_index(file, list, rest);
        if (!element) continue;
        for (const Property& property : kProperties)
            if (property.list == list && property.path == rest) return Slot{&property, *element, -1, property.count};
        if (list == kMaterials) return find_texture_slot(*element, rest);
    }
    return std::nullopt;
}

std::optional<Slot> node_slot(const File& file, int node, std::string_view path) {
    if (node < 0 || static_cast<std::size_t>(node) >= file.nodes.size()) return std::nullopt;
    for (const Property& property : kProperties)
        if (property.list == kNodes && property.path.substr(1) == path) return Slot{&property, node, -1, property.count};
    return std::nullopt;
}

double* locate(File& file, const Slot& slot) {
    const auto element = static_cast<std::size_t>(slot.element);
    if (slot.place < 0) return slot.property->at(file, element);
    file::TexturePlace* const place = kPlaces[slot.place].at(file, element);
    return place == nullptr || place->index < 0 ? nullptr : of_texture_transform(*place, *slot.property);
}

}  // namespace halflit::io::detail
