#include "apps/io/gltf/file/schema_rows.hpp"

#include "apps/io/gltf/file/schema_actions.hpp"
#include "shading/material_properties.hpp"

#include <deque>
#include <string>
#include <utility>

namespace halflit::io::detail {

namespace {

using enum Rule;
using namespace actions;

// glTF 2.0, sampler: codes of OpenGL.
constexpr int kMagFilters[] = {9728, 9729, -1}, kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987, -1},
              kWraps[] = {33071, 33648, 10497, -1};

constexpr SchemaRow restricted(SchemaRow row, Range range) {
    row.ranged = true;
    row.range = range;
    return row;
}
/// The nearest value of [low, high] is drawn.
constexpr SchemaRow within(double low, double high, SchemaRow row) { return restricted(row, {.low = low, .high = high}); }
constexpr SchemaRow at_least(double low, SchemaRow row, const char* instead = nullptr) {
    return restricted(row, {.low = low, .instead = instead});
}
constexpr SchemaRow above(double low, const char* instead, SchemaRow row) {
    return restricted(row, {.low = low, .low_open = true, .instead = instead});
}
constexpr SchemaRow one_of(const int* codes, const char* instead, SchemaRow row) {
    return restricted(row, {.codes = codes, .instead = instead});
}
constexpr SchemaRow mild(SchemaRow row) {
    row.mild = true;
    return row;
}

/// Members of these names are read; what others have may be anything.
template <Reads Names>
constexpr SchemaRow reading(SchemaRow row) {
    row.reads = Names;
    return row;
}

constexpr double kHalfPi = 1.5707963267948966;
constexpr const char* kNoCamera = "the camera is left out";
constexpr const char* kEmpty = "it is empty";
constexpr const char* kTrilinear = "drawn as 9987 (linear, within and between levels)";
constexpr Range kFieldOfView{.low = 0, .high = 2 * kHalfPi, .low_open = true, .high_open = true, .instead = kNoCamera};
constexpr Range kCone{.low = 0, .high = kHalfPi, .low_open = true};

constexpr SchemaRow kRows[] = {
    {"asset!", object},
    {"asset/version!", any, put_version},
    {"asset/minVersion", string, put_file<&File::min_version>},
    {"asset/generator", any, put_generator},
    {"asset/extras", open},
    {.path = "asset/extras/halflit", .rule = object, .closed = true},
    {"asset/extras/halflit/measures", array},
    {"asset/extras/halflit/measures/#", number, put_file<&File::measures>},
    {"asset/extras/halflit/warnings/#", string, put_file<&File::import_warnings>},
    {"extensionsUsed/#", string, put_file<&File::extensions_used>},
    {"extensionsRequired/#", string, put_file<&File::extensions_required>},
    {"scene", index, put_file<&File::scene>, Target::scenes},
    {"scenes/#", object, add<&File::scenes>, Target::scenes},
    mild({"scenes/#/name", string, put<&File::scenes, &file::Scene::name>}),
    {"scenes/#/nodes/#", index, put<&File::scenes, &file::Scene::nodes>, Target::nodes},

    {"animations/#", object, add<&File::animations>, Target::animations, end_animation},
    mild({"animations/#/name", string, put<&File::animations, &file::Animation::name>}),
    {"animations/#/channels!", array},
    {"animations/#/channels/#", object, add_channel},
    {"animations/#/channels/#/sampler!", code, put_channel<&file::AnimationChannel::sampler>},
    {"animations/#/channels/#/target!", object},
    {"animations/#/channels/#/target/node", index, put_channel<&file::AnimationChannel::node>, Target::nodes},
    {"animations/#/channels/#/target/path!", string, put_path},
    {"animations/#/channels/#/target/extensions/KHR_animation_pointer/pointer!", string, put_channel<&file::AnimationChannel::pointer>},
    {"animations/#/samplers!", array},
    {"animations/#/samplers/#", object, add_animation_sampler},
    {"animations/#/samplers/#/input!", index, put_animation_sampler<&file::AnimationSampler::input>, Target::accessors},
    {"animations/#/samplers/#/output!", index, put_animation_sampler<&file::AnimationSampler::output>, Target::accessors},
    {"animations/#/samplers/#/interpolation", string, put_interpolation},

    {"buffers/#", object, add<&File::buffers>, Target::buffers},
    {"buffers/#/uri", string, put<&File::buffers, &file::Buffer::uri>},
    at_least(1, {"buffers/#/byteLength!", size, put<&File::buffers, &file::Buffer::byte_length>}, kEmpty),

    {"bufferViews/#", object, add<&File::buffer_views>, Target::buffer_views},
    {"bufferViews/#/buffer!", index, put<&File::buffer_views, &file::BufferView::buffer>, Target::buffers},
    {"bufferViews/#/byteOffset", size, put<&File::buffer_views, &file::BufferView::byte_offset>},
    at_least(1, {"bufferViews/#/byteLength!", size, put<&File::buffer_views, &file::BufferView::byte_length>}, kEmpty),
    {"bufferViews/#/byteStride", code, put_byte_stride},
    {"bufferViews/#/extensions/EXT_meshopt_compression", object, begin_compressed},
    {"bufferViews/#/extensions/EXT_meshopt_compression/buffer!", index, put_compressed<&file::CompressedView::buffer>, Target::buffers},
    {"bufferViews/#/extensions/EXT_meshopt_compression/byteOffset", size, put_compressed<&file::CompressedView::byte_offset>},
    {"bufferViews/#/extensions/EXT_meshopt_compression/byteLength!", size, put_compressed<&file::CompressedView::byte_length>},
    {"bufferViews/#/extensions/EXT_meshopt_compression/byteStride!", code, put_compressed<&file::CompressedView::byte_stride>},
    {"bufferViews/#/extensions/EXT_meshopt_compression/count!", size, put_compressed<&file::CompressedView::count>},
    {"bufferViews/#/extensions/EXT_meshopt_compression/mode!", string, put_compression_mode},
    {"bufferViews/#/extensions/EXT_meshopt_compression/filter", string, put_compression_filter},
    {"bufferViews/#/extensions/KHR_meshopt_compression", object, begin_compressed},
    {"bufferViews/#/extensions/KHR_meshopt_compression/buffer!", index, put_compressed<&file::CompressedView::buffer>, Target::buffers},
    {"bufferViews/#/extensions/KHR_meshopt_compression/byteOffset", size, put_compressed<&file::CompressedView::byte_offset>},
    {"bufferViews/#/extensions/KHR_meshopt_compression/byteLength!", size, put_compressed<&file::CompressedView::byte_length>},
    {"bufferViews/#/extensions/KHR_meshopt_compression/byteStride!", code, put_compressed<&file::CompressedView::byte_stride>},
    {"bufferViews/#/extensions/KHR_meshopt_compression/count!", size, put_compressed<&file::CompressedView::count>},
    {"bufferViews/#/extensions/KHR_meshopt_compression/mode!", string, put_compression_mode},
    {"bufferViews/#/extensions/KHR_meshopt_compression/filter", string, put_compression_filter},

    {"accessors/#", object, add<&File::accessors>, Target::accessors},
    {"accessors/#/bufferView", index, put<&File::accessors, &file::Accessor::buffer_view>, Target::buffer_views},
    {"accessors/#/byteOffset", size, put<&File::accessors, &file::Accessor::byte_offset>},
    {"accessors/#/componentType!", code, put<&File::accessors, &file::Accessor::component_type>},
    {"accessors/#/normalized", boolean, put<&File::accessors, &file::Accessor::normalized>},
    at_least(1, {"accessors/#/count!", size, put<&File::accessors, &file::Accessor::count>}, kEmpty),
    {"accessors/#/type!", string, put_accessor_type},
    mild({"accessors/#/max/#", number, put_first_max}),
    {"accessors/#/sparse", object, begin_sparse},
    at_least(1, {"accessors/#/sparse/count!", code, put_sparse<&file::Sparse::count>}, "ignored"),
    {"accessors/#/sparse/indices!", object},
    {"accessors/#/sparse/indices/bufferView!", index, put_sparse<&file::Sparse::index_view>, Target::buffer_views},
    {"accessors/#/sparse/indices/byteOffset", code, put_sparse<&file::Sparse::index_offset>},
    {"accessors/#/sparse/indices/componentType!", code, put_sparse<&file::Sparse::index_component_type>},
    {"accessors/#/sparse/values!", object},
    {"accessors/#/sparse/values/bufferView!", index, put_sparse<&file::Sparse::value_view>, Target::buffer_views},
    {"accessors/#/sparse/values/byteOffset", code, put_sparse<&file::Sparse::value_offset>},

    {"meshes/#", object, add<&File::meshes>, Target::meshes},
    mild({"meshes/#/name", string, put<&File::meshes, &file::Mesh::name>}),
    {"meshes/#/weights/#", number, put<&File::meshes, &file::Mesh::weights>},
    {"meshes/#/primitives!", array},
    {"meshes/#/primitives/#", object, add_primitive},
    {"meshes/#/primitives/#/attributes!", object},
    reading<file::is_of_vertices>({"meshes/#/primitives/#/attributes/*", index, put_attribute, Target::accessors}),
    {"meshes/#/primitives/#/indices", index, put_primitive<&file::Primitive::indices>, Target::accessors},
    {"meshes/#/primitives/#/material", index, put_primitive<&file::Primitive::material>, Target::materials},
    {"meshes/#/primitives/#/mode", code, put_primitive<&file::Primitive::mode>},
    {"meshes/#/primitives/#/extensions/KHR_materials_variants/mappings!", array},
    {"meshes/#/primitives/#/extensions/KHR_materials_variants/mappings/#", object, add_variant_material},
    {"meshes/#/primitives/#/extensions/KHR_materials_variants/mappings/#/material!", index,
     put_variant_material<&file::VariantMaterial::material>, Target::materials},
    {"meshes/#/primitives/#/extensions/KHR_materials_variants/mappings/#/variants!", array},
    {"meshes/#/primitives/#/extensions/KHR_materials_variants/mappings/#/variants/#", code,
     put_variant_material<&file::VariantMaterial::variants>},
    {"meshes/#/primitives/#/extensions/KHR_gaussian_splatting/colorSpace", string, put_splat_colors},
    {"meshes/#/primitives/#/extensions/KHR_gaussian_splatting/extensions/KHR_gaussian_splatting_compression_spz/bufferView!", index,
     put_primitive<&file::Primitive::spz>, Target::buffer_views},
    {"meshes/#/primitives/#/extensions/KHR_gaussian_splatting/extensions/KHR_gaussian_splatting_compression_spz_2/bufferView!", index,
     put_primitive<&file::Primitive::spz>, Target::buffer_views},
    {"meshes/#/primitives/#/extensions/KHR_draco_mesh_compression", object, begin_draco},
    {"meshes/#/primitives/#/extensions/KHR_draco_mesh_compression/bufferView!", index, put_draco_view, Target::buffer_views},
    {"meshes/#/primitives/#/extensions/KHR_draco_mesh_compression/attributes!", object},
    {"meshes/#/primitives/#/extensions/KHR_draco_mesh_compression/attributes/*", code, put_draco_attribute},
    {"meshes/#/primitives/#/targets/#", object, add_morph_target},
    reading<file::is_drawn>({"meshes/#/primitives/#/targets/#/*", index, put_morph_attribute, Target::accessors}),

    {"nodes/#", object, begin_node, Target::nodes, end_node},
    mild({"nodes/#/name", string, put<&File::nodes, &file::Node::name>}),
    {"nodes/#/mesh", index, put<&File::nodes, &file::Node::mesh>, Target::meshes},
    {"nodes/#/skin", index, put<&File::nodes, &file::Node::skin>, Target::skins},
    {"nodes/#/camera", index, put<&File::nodes, &file::Node::camera>, Target::cameras},
    {"nodes/#/children/#", index, put_run<&File::children, &file::Node::children>, Target::nodes},
    {"nodes/#/matrix", array, [](F f, V value) { f.matrix_offset = value.offset; }, Target::none, nullptr, 16},
    {"nodes/#/matrix/#", number, put_transform<&GltfFiller::matrix>},
    {"nodes/#/translation", array, nullptr, Target::none, nullptr, 3},
    {"nodes/#/translation/#", number, put_transform<&GltfFiller::translation>},
    {"nodes/#/rotation", array, [](F f, V value) { f.rotation_offset = value.offset; }, Target::none, nullptr, 4},
    {"nodes/#/rotation/#", number, put_transform<&GltfFiller::rotation>},
    {"nodes/#/scale", array, nullptr, Target::none, nullptr, 3},
    {"nodes/#/scale/#", number, put_transform<&GltfFiller::scale>},
    {"nodes/#/weights/#", number, put_run<&File::weights, &file::Node::weights>},
    {"nodes/#/extensions/KHR_lights_punctual/light!", index, put<&File::nodes, &file::Node::light>, Target::lights},
    {"nodes/#/extensions/EXT_mesh_gpu_instancing", object,
     [](F f, V) {
         f.append(f.file.instancings);
         f.file.nodes.back().instancing = static_cast<int>(f.file.instancings.size() - 1);
     }},
    {"nodes/#/extensions/EXT_mesh_gpu_instancing/attributes!", object},
    reading<file::is_of_instances>({"nodes/#/extensions/EXT_mesh_gpu_instancing/attributes/*", index,
     [](F f, V v) { f.append(f.file.instancings.back(), {f.key, static_cast<int>(v.number)}); }, Target::accessors}),
    {"nodes/#/extensions/KHR_node_visibility/visible", boolean, [](F f, V v) { f.file.nodes.back().visible = v.truth ? 1 : 0; }},

    {"skins/#", object, add<&File::skins>, Target::skins},
    {"skins/#/joints!", array},
    {"skins/#/joints/#", index, put<&File::skins, &file::Skin::joints>, Target::nodes},
    {"skins/#/inverseBindMatrices", index, put<&File::skins, &file::Skin::inverse_bind_matrices>, Target::accessors},
    mild({"skins/#/skeleton", index, nullptr, Target::nodes}),

    {"cameras/#", object, add<&File::cameras>, Target::cameras, end_camera},
    mild({"cameras/#/name", string, put<&File::cameras, &file::Camera::name>}),
    {"cameras/#/type!", string, put_camera_type},
    {"cameras/#/perspective", object, begin_projection<&file::Camera::perspective>},
    restricted({"cameras/#/perspective/yfov!", number, put_perspective<&file::Projection::yfov>}, kFieldOfView),
    above(0, kNoCamera, {"cameras/#/perspective/znear!", number, put_perspective<&file::Projection::znear>}),
    above(0, "drawn without a far plane", {"cameras/#/perspective/zfar", number, put_zfar<&file::Camera::perspective>}),
    above(0, "drawn with the picture's", {"cameras/#/perspective/aspectRatio", number, put_perspective<&file::Projection::aspect_ratio>}),
    {"cameras/#/orthographic", object, begin_projection<&file::Camera::orthographic>},
    {"cameras/#/orthographic/xmag!", number, put_magnification<&file::Projection::xmag>},
    {"cameras/#/orthographic/ymag!", number, put_magnification<&file::Projection::ymag>},
    at_least(0, {"cameras/#/orthographic/znear!", number, put_orthographic<&file::Projection::znear>}, kNoCamera),
    above(0, kNoCamera, {"cameras/#/orthographic/zfar!", number, put_zfar<&file::Camera::orthographic>}),

    {"extensions/KHR_lights_punctual/lights!", array},
    {"extensions/KHR_lights_punctual/lights/#", object, add<&File::lights>, Target::lights, end_light},
    {"extensions/KHR_lights_punctual/lights/#/type!", string, put_light_type},
    mild({"extensions/KHR_lights_punctual/lights/#/name", string}),
    {"extensions/KHR_lights_punctual/lights/#/color", array, nullptr, Target::none, nullptr, 3},
    within(0, 1, {"extensions/KHR_lights_punctual/lights/#/color/#", number, put_light<&file::Light::color>}),
    at_least(0, {"extensions/KHR_lights_punctual/lights/#/intensity", number, put_light<&file::Light::intensity>}),
    above(0, "drawn without a range", {"extensions/KHR_lights_punctual/lights/#/range", number, put_light<&file::Light::range>}),
    {"extensions/KHR_lights_punctual/lights/#/spot", object,
     [](F f, V value) {
         f.file.lights.back().has_spot = true;
         f.spot_offset = value.offset;
     }},
    within(0, kHalfPi, {"extensions/KHR_lights_punctual/lights/#/spot/innerConeAngle", number, put_light<&file::Light::inner_cone_angle>}),
    restricted({"extensions/KHR_lights_punctual/lights/#/spot/outerConeAngle", number, put_light<&file::Light::outer_cone_angle>}, kCone),

    {"extensions/KHR_lights_punctual/lights/#/extras", open},
    {.path = "extensions/KHR_lights_punctual/lights/#/extras/halflit", .rule = object, .closed = true},
    at_least(0, {"extensions/KHR_lights_punctual/lights/#/extras/halflit/size", number, put_light<&file::Light::size>}),

    {"extensions/KHR_materials_variants/variants!", array},
    {"extensions/KHR_materials_variants/variants/#", object, [](F f, V) { f.append(f.file.variants); }},
    {"extensions/KHR_materials_variants/variants/#/name!", string, [](F f, V v) { f.file.variants.back() = f.keep(v); }},

    {"images/#", object, add<&File::images>, Target::images},
    {"images/#/uri", string, put<&File::images, &file::Image::uri>},
    {"images/#/bufferView", index, put<&File::images, &file::Image::buffer_view>, Target::buffer_views},
    {"images/#/mimeType", string, put<&File::images, &file::Image::mime_type>},
    {"textures/#", object, add<&File::textures>, Target::textures},
    {"textures/#/source", index, put<&File::textures, &file::Texture::source>, Target::images},
    {"textures/#/sampler", index, put<&File::textures, &file::Texture::sampler>, Target::samplers},
    {"textures/#/extensions/EXT_texture_webp/source", index, put<&File::textures, &file::Texture::webp>, Target::images},
    {"textures/#/extensions/KHR_texture_basisu/source", index, put<&File::textures, &file::Texture::basisu>, Target::images},
    {"samplers/#", object, add<&File::samplers>, Target::samplers},
    one_of(kMagFilters, "drawn as 9729 (linear)", {"samplers/#/magFilter", code, put_sampler<&file::Sampler::mag_filter>}),
    one_of(kMinFilters, kTrilinear, {"samplers/#/minFilter", code, put_sampler<&file::Sampler::min_filter>}),
    one_of(kWraps, "drawn as 10497 (repeat)", {"samplers/#/wrapS", code, put_sampler<&file::Sampler::wrap_s>}),
    one_of(kWraps, "drawn as 10497 (repeat)", {"samplers/#/wrapT", code, put_sampler<&file::Sampler::wrap_t>}),

    {"materials/#", object, add<&File::materials>, Target::materials},
    mild({"materials/#/name", string, put<&File::materials, &file::Material::name>}),
    {"materials/#/emissiveFactor", array, nullptr, Target::none, nullptr, 3},
    within(0, 1, {"materials/#/emissiveFactor/#", number, put<&File::materials, &file::Material::emissive_factor>}),
    {"materials/#/alphaMode", string, put_alpha_mode},
    {"materials/#/doubleSided", boolean, put<&File::materials, &file::Material::double_sided>},
    {"materials/#/extensions/KHR_materials_unlit", object, [](F f, V) { f.file.materials.back().unlit = true; }},
    at_least(0, {"materials/#/extensions/KHR_materials_emissive_strength/emissiveStrength", number,
     put<&File::materials, &file::Material::emissive_strength>}),
    at_least(0, {"materials/#/extensions/KHR_materials_ior/ior", number, put<&File::materials, &file::Material::ior>}),
    {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness", object, [](F f, V) { glossy(f); }},
    {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", array, nullptr, Target::none, nullptr, 4},
    within(0, 1, {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor/#", number,
     put_glossy<&file::SpecularGlossiness::diffuse_factor>}),
    {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", array, nullptr, Target::none, nullptr, 3},
    within(0, 1, {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor/#", number,
     put_glossy<&file::SpecularGlossiness::specular_factor>}),
    within(0, 1, {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", number,
     put_glossy<&file::SpecularGlossiness::glossiness_factor>}),
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

/// Ranges in which glTF is stricter than the table of materials.
constexpr std::pair<std::string_view, Range> kStricter[] = {
    {"extensions/KHR_materials_volume/attenuationDistance", {.low = 0, .low_open = true, .instead = "drawn as if nothing were absorbed"}}};
static_assert(shading::kMaterialNumbers[shading::number_row("attenuation_distance")].gltf == kStricter[0].first);

Range range_of(const shading::MaterialNumber& row) {
    for (const auto& [gltf, range] : kStricter)
        if (row.gltf == gltf) return range;
    Range range;
    if (row.low > -shading::kMostScale) range.low = static_cast<double>(row.low);
    if (row.high < shading::kMostScale) range.high = static_cast<double>(row.high);
    return range;
}

/// Adds the rows of a number of material_properties.def: one number, or an array of them.
template <std::size_t Row>
void add_number(std::vector<SchemaRow>& rows, std::deque<std::string>& paths) {
    const shading::MaterialNumber& of = shading::kMaterialNumbers[Row];
    if (of.gltf.empty()) return;
    std::string path = "materials/#/" + std::string(of.gltf);
    if (of.count > 1) {
        rows.push_back({paths.emplace_back(path), array, nullptr, Target::none, nullptr, static_cast<std::size_t>(of.count)});
        path += "/#";
    }
    rows.push_back(restricted({paths.emplace_back(path), number, put_material_number<Row>}, range_of(of)));
}

template <std::size_t... Rows, std::size_t... Slots>
std::pair<std::vector<SchemaRow>, std::vector<SchemaRow>> make_rows(std::index_sequence<Rows...>, std::index_sequence<Slots...>) {
    static std::deque<std::string> paths;  // the rows point into them
    std::vector<SchemaRow> rows(std::begin(kRows), std::end(kRows));
    (add_number<Rows>(rows, paths), ...);
    std::vector<SchemaRow> places{{"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture", object,
                                   begin_glossy_place<&file::SpecularGlossiness::diffuse_texture>},
                                  {"materials/#/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture", object,
                                   begin_glossy_place<&file::SpecularGlossiness::specular_glossiness_texture>}};
    (places.push_back(
         {paths.emplace_back("materials/#/" + std::string(shading::kTextureSlotInfos[Slots].gltf)), object, begin_place<Slots>}),
     ...);
    return {std::move(rows), std::move(places)};
}

const auto& all_rows() {
    static const auto rows =
        make_rows(std::make_index_sequence<shading::kMaterialNumberCount>{}, std::make_index_sequence<kTextureSlots>{});
    return rows;
}

constexpr SchemaRow kTextureRows[] = {
    {"index!", index, put_place<&file::TexturePlace::index>, Target::textures},
    {"texCoord", code, put_place<&file::TexturePlace::tex_coord>},
    {"extensions/KHR_texture_transform", object, begin_texture_transform},
    {"extensions/KHR_texture_transform/offset", array, nullptr, Target::none, nullptr, 2},
    {"extensions/KHR_texture_transform/offset/#", number, put_texture_transform<&file::TextureTransform::offset>},
    {"extensions/KHR_texture_transform/rotation", number, put_texture_transform<&file::TextureTransform::rotation>},
    {"extensions/KHR_texture_transform/scale", array, nullptr, Target::none, nullptr, 2},
    {"extensions/KHR_texture_transform/scale/#", number, put_texture_transform<&file::TextureTransform::scale>},
    {"extensions/KHR_texture_transform/texCoord", code, put_texture_transform<&file::TextureTransform::tex_coord>},
};

}  // namespace

std::span<const SchemaRow> schema_rows() { return all_rows().first; }
std::span<const SchemaRow> texture_place_rows() { return all_rows().second; }
std::span<const SchemaRow> texture_rows() { return kTextureRows; }

}  // namespace halflit::io::detail
