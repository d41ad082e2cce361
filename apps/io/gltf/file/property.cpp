#include "apps/io/gltf/file/property.hpp"

#include "shading/material_properties.hpp"

#include <array>
#include <charconv>
#include <iterator>
#include <utility>
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
/// Numbers of material_properties.def. KHR_materials_pbrSpecularGlossiness replaces metal and roughness.
template <std::size_t Row>
double* of_material(File& f, I material) {
    file::Material& m = f.materials[material];
    return m.replaces(shading::kMaterialNumbers[Row].gltf) ? nullptr : &m.numbers[shading::kFirstFloats[Row]];
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
    {kMaterials, "/emissiveFactor", Part::material, 3, [](File& f, I i) { return numbers(f.materials[i].emissive_factor, 3, 0.0); }},
    {kMaterials, "/extensions/KHR_materials_emissive_strength/emissiveStrength", Part::material, 1,
     [](File& f, I i) { return &f.materials[i].emissive_strength; }},
    {kMaterials, "/extensions/KHR_materials_ior/ior", Part::material, 1,
     [](File& f, I i) { return f.materials[i].glossy >= 0 ? nullptr : &f.materials[i].ior; }},
};

/// Properties of materials by their table; those without a place have a path that no pointer ends with.
template <std::size_t... Rows>
constexpr auto make_material_properties(std::index_sequence<Rows...>) {
    return std::array{Property{kMaterials, shading::kMaterialNumbers[Rows].gltf, Part::material,
                               static_cast<std::size_t>(shading::kMaterialNumbers[Rows].count), of_material<Rows>}...};
}
constexpr auto kMaterialProperties = make_material_properties(std::make_index_sequence<shading::kMaterialNumberCount>{});

/// Properties of KHR_texture_transform, below a place.
constexpr Property kTransforms[] = {
    {kMaterials, "/extensions/KHR_texture_transform/offset", Part::material, 2, nullptr},
    {kMaterials, "/extensions/KHR_texture_transform/rotation", Part::material, 1, nullptr},
    {kMaterials, "/extensions/KHR_texture_transform/scale", Part::material, 2, nullptr},
};

double* of_texture_transform(File& file, file::TexturePlace& place, const Property& property) {
    if (place.transform < 0) {
        place.transform = static_cast<int>(file.texture_transforms.size());
        file.texture_transforms.emplace_back();
    }
    file::TextureTransform& transform = file.texture_transforms[static_cast<std::size_t>(place.transform)];
    if (&property == &kTransforms[0]) return numbers(transform.offset, 2, 0.0);
    if (&property == &kTransforms[1]) return &transform.rotation;
    return numbers(transform.scale, 2, 1.0);
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

/// `path`: below a material, without the first '/'.
std::optional<Slot> find_material_slot(int material, std::string_view path) {
    for (const Property& property : kMaterialProperties)
        if (!property.path.empty() && property.path == path) return Slot{&property, material, -1, property.count};
    for (const TextureSlot slot : shading::kAllTextureSlots) {
        const std::string_view place = shading::info_of(slot).gltf;
        if (!path.starts_with(place)) continue;
        for (const Property& property : kTransforms)
            if (path.substr(place.size()) == property.path) return Slot{&property, material, static_cast<int>(slot), property.count};
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
        if (list == kMaterials && rest.starts_with('/')) return find_material_slot(*element, rest.substr(1));
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
    file::TexturePlace& place = file.materials[element].places[static_cast<TextureSlot>(slot.place)];
    return place.index < 0 ? nullptr : of_texture_transform(file, place, *slot.property);
}

}  // namespace halflit::io::detail
