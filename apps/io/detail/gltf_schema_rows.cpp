#include "apps/io/detail/gltf_schema_rows.hpp"

#include "apps/io/detail/gltf_filler.hpp"
#include "apps/io/detail/gltf_node_transform.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {

namespace {

using enum Rule;
using file::File;
using F = GltfFiller&;
using V = const JsonValue&;

[[noreturn]] void fault(V value, std::string what) { throw JsonFault{ErrorCode::bad_input, value.offset, std::move(what)}; }

void assign(F, int& out, V value) { out = static_cast<int>(value.number); }
void assign(F, std::uint64_t& out, V value) { out = static_cast<std::uint64_t>(value.number); }
void assign(F, double& out, V value) { out = value.number; }
void assign(F, bool& out, V value) { out = value.truth; }
void assign(F f, std::string_view& out, V value) { out = f.keep(value); }
void assign(F f, std::optional<std::string_view>& out, V value) { out = f.keep(value); }
template <class T>
void assign(F f, std::vector<T>& out, V value) {
    assign(f, f.append(out), value);
}

/// Appends an element to a list of the file.
template <auto List>
void add(F f, V) {
    f.append(f.file.*List);
}

/// Stores a value in a member of the list's last element; a member that is a list itself has it appended.
template <auto List, auto Member>
void put(F f, V value) {
    assign(f, (f.file.*List).back().*Member, value);
}

template <auto Member>
void put_file(F f, V value) {
    assign(f, f.file.*Member, value);
}

template <auto Member>
void put_sparse(F f, V value) {
    assign(f, f.file.sparse.back().*Member, value);
}

template <auto Member>
void put_primitive(F f, V value) {
    assign(f, f.file.meshes.back().primitives.back().*Member, value);
}

/// Appends a number to the transform of the node that is being read.
template <auto Member>
void put_transform(F f, V value) {
    (f.*Member).push_back(value.number);
}

/// Appends an entry to an array of the file and to the node's run of it.
template <auto Array, auto Member>
void put_run(F f, V value) {
    assign(f, f.append(f.file.*Array), value);
    file::Run& run = f.file.nodes.back().*Member;
    if (run.count++ == 0) run.first = static_cast<std::uint32_t>((f.file.*Array).size() - 1);
}

template <auto Which, auto Member>
void put_projection(F f, V value) {
    assign(f, (*(f.file.cameras.back().*Which)).*Member, value);
}

template <auto Which>
void begin_projection(F f, V) {
    (f.file.cameras.back().*Which).emplace();
}

template <auto Member>
void begin_place(F f, V) {
    f.place = &(f.file.materials.back().*Member);
}

template <auto Member>
void put_place(F f, V value) {
    assign(f, f.place->*Member, value);
}

template <auto Member>
void put_texture_transform(F f, V value) {
    assign(f, (*f.place->transform).*Member, value);
}

template <auto Member>
void put_own_lobe(F f, V value) {
    (*f.file.materials.back().own_lobe).parameters.*Member = static_cast<float>(value.number);
}

void put_generator(F f, V value) {
    if (value.type == JsonType::string) f.file.generator = f.keep(value);
}

void put_byte_stride(F f, V value) {
    const int stride = static_cast<int>(value.number);
    if (stride < 4 || stride > 252 || stride % 4 != 0)
        fault(value, fmt::format("expected a multiple of 4 from 4 to 252, found {}", stride));
    f.file.buffer_views.back().byte_stride = stride;
}

void put_accessor_type(F f, V value) {
    static constexpr std::pair<std::string_view, int> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                  {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, components] : kTypes)
        if (value.text == name) {
            f.file.accessors.back().components = components;
            return;
        }
    fault(value, fmt::format("expected SCALAR, VEC2 to VEC4 or MAT2 to MAT4, found \"{}\"", printable(value.text, 40)));
}

void begin_sparse(F f, V) {
    f.append(f.file.sparse);
    f.file.accessors.back().sparse = static_cast<int>(f.file.sparse.size() - 1);
}

void add_primitive(F f, V) {
    ++f.file.primitives;
    f.append(f.file.meshes.back().primitives);
}

void put_attribute(F f, V value) { f.append(f.file.meshes.back().primitives.back().attributes, {f.key, static_cast<int>(value.number)}); }

void add_morph_target(F f, V) {
    ++f.file.morph_targets;
    f.append(f.file.meshes.back().primitives.back().targets);
}

void put_morph_attribute(F f, V value) {
    f.append(f.file.meshes.back().primitives.back().targets.back(), {f.key, static_cast<int>(value.number)});
}

void begin_node(F f, V) {
    f.append(f.file.nodes);
    for (auto* list : {&f.matrix, &f.translation, &f.rotation, &f.scale}) list->clear();
}

void end_node(F f, V) {
    if (f.matrix.empty() && f.translation.empty() && f.rotation.empty() && f.scale.empty()) return;
    f.append(f.file.transforms, node_transform(f.matrix, f.translation, f.rotation, f.scale));
    f.file.nodes.back().transform = static_cast<int>(f.file.transforms.size() - 1);
}

void end_camera(F f, V value) {
    const file::Camera& camera = f.file.cameras.back();
    if (camera.type != "perspective" && camera.type != "orthographic")
        fault(value, fmt::format("type: expected perspective or orthographic, found \"{}\"", printable(camera.type, 40)));
    if (!(camera.type == "perspective" ? camera.perspective : camera.orthographic))
        fault(value, fmt::format("expected the key \"{}\", which is not there", camera.type));
}

void end_light(F f, V value) {
    const file::Light& light = f.file.lights.back();
    if (light.type == "spot" && !light.has_spot) fault(value, "expected the key \"spot\", which is not there");
}

constexpr SchemaRow kRows[] = {
    {"asset!", object},
    {"asset/version!", string, put_file<&File::version>},
    {"asset/minVersion", string, put_file<&File::min_version>},
    {"asset/generator", any, put_generator},
    {"extensionsUsed/#", string, put_file<&File::extensions_used>},
    {"extensionsRequired/#", string, put_file<&File::extensions_required>},
    {"scene", index, put_file<&File::scene>, Target::scenes},
    {"scenes/#", object, add<&File::scenes>},
    {"scenes/#/nodes/#", index, put<&File::scenes, &file::Scene::nodes>, Target::nodes},
    {"animations/#", object, [](F f, V) { ++f.file.animations; }},

    {"buffers/#", object, add<&File::buffers>},
    {"buffers/#/uri", string, put<&File::buffers, &file::Buffer::uri>},
    {"buffers/#/byteLength!", size, put<&File::buffers, &file::Buffer::byte_length>},

    {"bufferViews/#", object, add<&File::buffer_views>},
    {"bufferViews/#/buffer!", index, put<&File::buffer_views, &file::BufferView::buffer>, Target::buffers},
    {"bufferViews/#/byteOffset", size, put<&File::buffer_views, &file::BufferView::byte_offset>},
    {"bufferViews/#/byteLength!", size, put<&File::buffer_views, &file::BufferView::byte_length>},
    {"bufferViews/#/byteStride", code, put_byte_stride},

    {"accessors/#", object, add<&File::accessors>},
    {"accessors/#/bufferView", index, put<&File::accessors, &file::Accessor::buffer_view>, Target::buffer_views},
    {"accessors/#/byteOffset", size, put<&File::accessors, &file::Accessor::byte_offset>},
    {"accessors/#/componentType!", code, put<&File::accessors, &file::Accessor::component_type>},
    {"accessors/#/normalized", boolean, put<&File::accessors, &file::Accessor::normalized>},
    {"accessors/#/count!", size, put<&File::accessors, &file::Accessor::count>},
    {"accessors/#/type!", string, put_accessor_type},
    {"accessors/#/sparse", object, begin_sparse},
    {"accessors/#/sparse/count!", code, put_sparse<&file::Sparse::count>},
    {"accessors/#/sparse/indices!", object},
    {"accessors/#/sparse/indices/bufferView!", index, put_sparse<&file::Sparse::index_view>, Target::buffer_views},
    {"accessors/#/sparse/indices/byteOffset", code, put_sparse<&file::Sparse::index_offset>},
    {"accessors/#/sparse/indices/componentType!", code, put_sparse<&file::Sparse::index_component_type>},
    {"accessors/#/sparse/values!", object},
    {"accessors/#/sparse/values/bufferView!", index, put_sparse<&file::Sparse::value_view>, Target::buffer_views},
    {"accessors/#/sparse/values/byteOffset", code, put_sparse<&file::Sparse::value_offset>},

    {"meshes/#", object, add<&File::meshes>},
    {"meshes/#/name", string, put<&File::meshes, &file::Mesh::name>},
    {"meshes/#/weights/#", number, put<&File::meshes, &file::Mesh::weights>},
    {"meshes/#/primitives!", array},
    {"meshes/#/primitives/#", object, add_primitive},
    {"meshes/#/primitives/#/attributes!", object},
    {"meshes/#/primitives/#/attributes/*", index, put_attribute, Target::accessors},
    {"meshes/#/primitives/#/indices", index, put_primitive<&file::Primitive::indices>, Target::accessors},
    {"meshes/#/primitives/#/material", index, put_primitive<&file::Primitive::material>, Target::materials},
    {"meshes/#/primitives/#/mode", code, put_primitive<&file::Primitive::mode>},
    {"meshes/#/primitives/#/targets/#", object, add_morph_target},
    {"meshes/#/primitives/#/targets/#/*", index, put_morph_attribute, Target::accessors},

    {"nodes/#", object, begin_node, Target::none, end_node},
    {"nodes/#/name", string, put<&File::nodes, &file::Node::name>},
    {"nodes/#/mesh", index, put<&File::nodes, &file::Node::mesh>, Target::meshes},
    {"nodes/#/skin", index, put<&File::nodes, &file::Node::skin>, Target::skins},
    {"nodes/#/camera", index, put<&File::nodes, &file::Node::camera>, Target::cameras},
    {"nodes/#/children/#", index, put_run<&File::children, &file::Node::children>, Target::nodes},
    {"nodes/#/matrix", array, nullptr, Target::none, nullptr, 16},
    {"nodes/#/matrix/#", number, put_transform<&GltfFiller::matrix>},
    {"nodes/#/translation", array, nullptr, Target::none, nullptr, 3},
    {"nodes/#/translation/#", number, put_transform<&GltfFiller::translation>},
    {"nodes/#/rotation", array, nullptr, Target::none, nullptr, 4},
    {"nodes/#/rotation/#", number, put_transform<&GltfFiller::rotation>},
    {"nodes/#/scale", array, nullptr, Target::none, nullptr, 3},
    {"nodes/#/scale/#", number, put_transform<&GltfFiller::scale>},
    {"nodes/#/weights/#", number, put_run<&File::weights, &file::Node::weights>},
    {"nodes/#/extensions/KHR_lights_punctual/light!", index, put<&File::nodes, &file::Node::light>, Target::lights},

    {"skins/#", object, add<&File::skins>},
    {"skins/#/joints!", array},
    {"skins/#/joints/#", index, put<&File::skins, &file::Skin::joints>, Target::nodes},
    {"skins/#/inverseBindMatrices", index, put<&File::skins, &file::Skin::inverse_bind_matrices>, Target::accessors},
    {"skins/#/skeleton", index, nullptr, Target::nodes},

    {"cameras/#", object, add<&File::cameras>, Target::none, end_camera},
    {"cameras/#/name", string, put<&File::cameras, &file::Camera::name>},
    {"cameras/#/type!", string, put<&File::cameras, &file::Camera::type>},
    {"cameras/#/perspective", object, begin_projection<&file::Camera::perspective>},
    {"cameras/#/perspective/yfov!", number, put_projection<&file::Camera::perspective, &file::Projection::yfov>},
    {"cameras/#/perspective/znear!", number, put_projection<&file::Camera::perspective, &file::Projection::znear>},
    {"cameras/#/perspective/zfar", number, put_projection<&file::Camera::perspective, &file::Projection::zfar>},
    {"cameras/#/perspective/aspectRatio", number, put_projection<&file::Camera::perspective, &file::Projection::aspect_ratio>},
    {"cameras/#/orthographic", object, begin_projection<&file::Camera::orthographic>},
    {"cameras/#/orthographic/xmag!", number, put_projection<&file::Camera::orthographic, &file::Projection::xmag>},
    {"cameras/#/orthographic/ymag!", number, put_projection<&file::Camera::orthographic, &file::Projection::ymag>},
    {"cameras/#/orthographic/znear!", number, put_projection<&file::Camera::orthographic, &file::Projection::znear>},
    {"cameras/#/orthographic/zfar!", number, put_projection<&file::Camera::orthographic, &file::Projection::zfar>},

    {"extensions/KHR_lights_punctual/lights!", array},
    {"extensions/KHR_lights_punctual/lights/#", object, add<&File::lights>, Target::none, end_light},
    {"extensions/KHR_lights_punctual/lights/#/type!", string, put<&File::lights, &file::Light::type>},
    {"extensions/KHR_lights_punctual/lights/#/name", string},
    {"extensions/KHR_lights_punctual/lights/#/color/#", number, put<&File::lights, &file::Light::color>},
    {"extensions/KHR_lights_punctual/lights/#/intensity", number, put<&File::lights, &file::Light::intensity>},
    {"extensions/KHR_lights_punctual/lights/#/range", number, put<&File::lights, &file::Light::range>},
    {"extensions/KHR_lights_punctual/lights/#/spot", object, [](F f, V) { f.file.lights.back().has_spot = true; }},
    {"extensions/KHR_lights_punctual/lights/#/spot/innerConeAngle", number, put<&File::lights, &file::Light::inner_cone_angle>},
    {"extensions/KHR_lights_punctual/lights/#/spot/outerConeAngle", number, put<&File::lights, &file::Light::outer_cone_angle>},

    {"images/#", object, add<&File::images>},
    {"images/#/uri", string, put<&File::images, &file::Image::uri>},
    {"images/#/bufferView", index, put<&File::images, &file::Image::buffer_view>, Target::buffer_views},
    {"textures/#", object, add<&File::textures>},
    {"textures/#/source", index, put<&File::textures, &file::Texture::source>, Target::images},
    {"textures/#/sampler", index, put<&File::textures, &file::Texture::sampler>, Target::samplers},
    {"samplers/#", object, add<&File::samplers>},
    {"samplers/#/magFilter", code, put<&File::samplers, &file::Sampler::mag_filter>},
    {"samplers/#/minFilter", code, put<&File::samplers, &file::Sampler::min_filter>},
    {"samplers/#/wrapS", code, put<&File::samplers, &file::Sampler::wrap_s>},
    {"samplers/#/wrapT", code, put<&File::samplers, &file::Sampler::wrap_t>},

    {"materials/#", object, add<&File::materials>},
    {"materials/#/name", string, put<&File::materials, &file::Material::name>},
    {"materials/#/emissiveFactor", array, nullptr, Target::none, nullptr, 3},
    {"materials/#/emissiveFactor/#", number, put<&File::materials, &file::Material::emissive_factor>},
    {"materials/#/alphaMode", string, put<&File::materials, &file::Material::alpha_mode>},
    {"materials/#/alphaCutoff", number, put<&File::materials, &file::Material::alpha_cutoff>},
    {"materials/#/doubleSided", boolean, put<&File::materials, &file::Material::double_sided>},
    {"materials/#/pbrMetallicRoughness/baseColorFactor", array, nullptr, Target::none, nullptr, 4},
    {"materials/#/pbrMetallicRoughness/baseColorFactor/#", number, put<&File::materials, &file::Material::base_color_factor>},
    {"materials/#/pbrMetallicRoughness/metallicFactor", number, put<&File::materials, &file::Material::metallic_factor>},
    {"materials/#/pbrMetallicRoughness/roughnessFactor", number, put<&File::materials, &file::Material::roughness_factor>},
    {"materials/#/extensions/KHR_materials_unlit", any, [](F f, V) { f.file.materials.back().unlit = true; }},
    {"materials/#/extensions/KHR_materials_emissive_strength/emissiveStrength", number,
     put<&File::materials, &file::Material::emissive_strength>},
    {"materials/#/extras", open},
    {.path = "materials/#/extras/halflit",
     .rule = object,
     .put = [](F f, V) { f.file.materials.back().own_lobe.emplace(); },
     .closed = true},
    {"materials/#/extras/halflit/lobe", string, [](F f, V v) { f.file.materials.back().own_lobe->name = f.keep(v); }},
    {"materials/#/extras/halflit/wrap", number, put_own_lobe<&LobeParameters::wrap>},
    {"materials/#/extras/halflit/power", number, put_own_lobe<&LobeParameters::power>},
    {"materials/#/extras/halflit/normalize", boolean, [](F f, V v) { f.file.materials.back().own_lobe->parameters.normalize = v.truth; }},
};

constexpr SchemaRow kTexturePlaces[] = {
    {"materials/#/pbrMetallicRoughness/baseColorTexture", object, begin_place<&file::Material::base_color_texture>},
    {"materials/#/pbrMetallicRoughness/metallicRoughnessTexture", object, begin_place<&file::Material::metallic_roughness_texture>},
    {"materials/#/normalTexture", object, begin_place<&file::Material::normal_texture>},
    {"materials/#/occlusionTexture", object, begin_place<&file::Material::occlusion_texture>},
    {"materials/#/emissiveTexture", object, begin_place<&file::Material::emissive_texture>},
};

constexpr SchemaRow kTextureRows[] = {
    {"index!", index, put_place<&file::TexturePlace::index>, Target::textures},
    {"texCoord", code, put_place<&file::TexturePlace::tex_coord>},
    {"scale", number, put_place<&file::TexturePlace::scale>},
    {"strength", number, put_place<&file::TexturePlace::strength>},
    {"extensions/KHR_texture_transform", object, [](F f, V) { f.place->transform.emplace(); }},
    {"extensions/KHR_texture_transform/offset/#", number, put_texture_transform<&file::TextureTransform::offset>},
    {"extensions/KHR_texture_transform/rotation", number, put_texture_transform<&file::TextureTransform::rotation>},
    {"extensions/KHR_texture_transform/scale/#", number, put_texture_transform<&file::TextureTransform::scale>},
    {"extensions/KHR_texture_transform/texCoord", code, put_texture_transform<&file::TextureTransform::tex_coord>},
};

}  // namespace

std::span<const SchemaRow> schema_rows() { return kRows; }
std::span<const SchemaRow> texture_place_rows() { return kTexturePlaces; }
std::span<const SchemaRow> texture_rows() { return kTextureRows; }

}  // namespace halflit::io::detail
