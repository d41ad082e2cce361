// Comparison of the loader's reading of a model's JSON with tinygltf's, which shares no code with it.
#include "apps/io/files/file_access.hpp"
#include "apps/io/gltf/file/json.hpp"
#include "apps/io/gltf/file/node_transform.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "tests/io/rich_file.hpp"
#include "tests/io/tinygltf.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <filesystem>

using namespace halflit;
using namespace halflit::test;
namespace file = io::detail::file;
namespace fs = std::filesystem;

namespace {

/// Reads into tinygltf's structures. Buffers and images are removed first, because it would read them too. False if it refuses the file.
bool read_second(std::string_view text, tinygltf::Model& model) {
    nlohmann::json json = nlohmann::json::parse(text);
    json.erase("buffers");
    json.erase("images");
    const std::string rest = json.dump();
    std::string error, warning;
    tinygltf::TinyGLTF reader;
    return reader.LoadASCIIFromString(&model, &error, &warning, rest.data(), static_cast<unsigned>(rest.size()), "", tinygltf::NO_REQUIRE);
}

double number_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise) {
    const auto found = extensions.find(extension);
    return found == extensions.end() || !found->second.Has(key) ? otherwise : found->second.Get(key).GetNumberAsDouble();
}

template <class Info>
void compare_place(const file::File& file, const file::TexturePlace& a, const Info& b) {
    CHECK(a.index == b.index);
    CHECK(a.tex_coord == b.texCoord);
    constexpr const char* kTransform = "KHR_texture_transform";
    const file::TextureTransform* const transform = file.transform_of(a);
    CHECK((transform != nullptr) == (b.extensions.count(kTransform) != 0));
    if (transform != nullptr) {
        CHECK(transform->rotation == number_of(b.extensions, kTransform, "rotation", 0));
        CHECK(transform->tex_coord == static_cast<int>(number_of(b.extensions, kTransform, "texCoord", -1)));
        for (const auto& [key, values] : {std::pair("offset", &transform->offset), std::pair("scale", &transform->scale)})
            for (std::size_t i = 0; i < values->size(); ++i)
                CHECK((*values)[i] == b.extensions.at(kTransform).Get(key).Get(static_cast<int>(i)).GetNumberAsDouble());
    }
}

std::map<std::string, int> as_map(const file::Attributes& attributes) {
    std::map<std::string, int> out;
    for (const auto& [name, accessor] : attributes) out[std::string(name)] = accessor;
    return out;
}

void compare_geometry(const file::File& a, const tinygltf::Model& b) {
    REQUIRE(a.buffer_views.size() == b.bufferViews.size());
    for (std::size_t i = 0; i < a.buffer_views.size(); ++i) {
        CHECK(a.buffer_views[i].buffer == b.bufferViews[i].buffer);
        CHECK(a.buffer_views[i].byte_offset == b.bufferViews[i].byteOffset);
        CHECK(a.buffer_views[i].byte_length == b.bufferViews[i].byteLength);
        CHECK(static_cast<std::size_t>(a.buffer_views[i].byte_stride) == b.bufferViews[i].byteStride);
    }
    REQUIRE(a.accessors.size() == b.accessors.size());
    for (std::size_t i = 0; i < a.accessors.size(); ++i) {
        const file::Accessor& x = a.accessors[i];
        const tinygltf::Accessor& y = b.accessors[i];
        CHECK(x.buffer_view == y.bufferView);
        CHECK(x.byte_offset == y.byteOffset);
        CHECK(x.component_type == y.componentType);
        CHECK(x.count == y.count);
        CHECK(x.normalized == y.normalized);
        CHECK(x.components == tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(y.type)));
        REQUIRE((x.sparse >= 0) == y.sparse.isSparse);
        if (x.sparse < 0) continue;
        const file::Sparse& s = a.sparse.at(static_cast<std::size_t>(x.sparse));
        CHECK(s.count == y.sparse.count);
        CHECK(s.index_view == y.sparse.indices.bufferView);
        CHECK(s.index_offset == static_cast<int>(y.sparse.indices.byteOffset));  // size_t from version 2.9 on
        CHECK(s.index_component_type == y.sparse.indices.componentType);
        CHECK(s.value_view == y.sparse.values.bufferView);
        CHECK(s.value_offset == static_cast<int>(y.sparse.values.byteOffset));
    }
    REQUIRE(a.meshes.size() == b.meshes.size());
    for (std::size_t m = 0; m < a.meshes.size(); ++m) {
        CHECK(a.meshes[m].name == b.meshes[m].name);
        CHECK(a.meshes[m].weights == b.meshes[m].weights);
        REQUIRE(a.meshes[m].primitives.size() == b.meshes[m].primitives.size());
        for (std::size_t p = 0; p < a.meshes[m].primitives.size(); ++p) {
            const file::Primitive& x = a.meshes[m].primitives[p];
            const tinygltf::Primitive& y = b.meshes[m].primitives[p];
            CHECK(as_map(x.attributes) == y.attributes);
            CHECK(x.indices == y.indices);
            CHECK(x.material == y.material);
            CHECK(x.mode == y.mode);
            REQUIRE(x.targets.size() == y.targets.size());
            for (std::size_t t = 0; t < x.targets.size(); ++t) CHECK(as_map(x.targets[t]) == y.targets[t]);
        }
    }
}

void compare_nodes(const file::File& a, const tinygltf::Model& b) {
    REQUIRE(a.nodes.size() == b.nodes.size());
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        const file::Node& x = a.nodes[i];
        const tinygltf::Node& y = b.nodes[i];
        CHECK(x.name == y.name);
        CHECK(x.mesh == y.mesh);
        CHECK(x.skin == y.skin);
        CHECK(x.camera == y.camera);
        CHECK(x.light == static_cast<int>(number_of(y.extensions, "KHR_lights_punctual", "light", -1)));
        REQUIRE(x.children.count == y.children.size());
        for (std::size_t c = 0; c < y.children.size(); ++c) CHECK(a.children[x.children.first + c] == y.children[c]);
        REQUIRE(x.weights.count == y.weights.size());
        for (std::size_t w = 0; w < y.weights.size(); ++w) CHECK(a.weights[x.weights.first + w] == y.weights[w]);
        CHECK((x.transform >= 0) == !(y.matrix.empty() && y.translation.empty() && y.rotation.empty() && y.scale.empty()));
        if (x.transform < 0) continue;
        const io::detail::Affine m = io::detail::node_transform(a.transforms[static_cast<std::size_t>(x.transform)]);
        if (!y.matrix.empty()) {
            for (std::size_t c = 0; c < 4; ++c) CHECK(m.c[c] == Vec3d{y.matrix[4 * c], y.matrix[4 * c + 1], y.matrix[4 * c + 2]});
        } else if (!y.translation.empty()) {
            CHECK(m.c[3] == Vec3d{y.translation[0], y.translation[1], y.translation[2]});
        }
    }
    REQUIRE(a.scenes.size() == b.scenes.size());
    for (std::size_t i = 0; i < a.scenes.size(); ++i) CHECK(a.scenes[i].nodes == b.scenes[i].nodes);
    CHECK(a.scene == b.defaultScene);
    REQUIRE(a.skins.size() == b.skins.size());
    for (std::size_t i = 0; i < a.skins.size(); ++i) {
        CHECK(a.skins[i].joints == b.skins[i].joints);
        CHECK(a.skins[i].inverse_bind_matrices == b.skins[i].inverseBindMatrices);
    }
}

void compare_materials(const file::File& a, const tinygltf::Model& b) {
    REQUIRE(a.materials.size() == b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        const file::Material& x = a.materials[i];
        const tinygltf::Material& y = b.materials[i];
        CHECK(x.name == y.name);
        CHECK(x.alpha_mode == y.alphaMode);
        const auto numbers = [&](std::string_view name) {
            const std::size_t row = shading::number_row(name);
            return std::vector<double>(&x.numbers[shading::kFirstFloats[row]],
                                       &x.numbers[shading::kFirstFloats[row]] + shading::kMaterialNumbers[row].count);
        };
        CHECK(numbers("alpha_cutoff")[0] == y.alphaCutoff);
        CHECK(x.double_sided == y.doubleSided);
        CHECK(numbers("base_color") == y.pbrMetallicRoughness.baseColorFactor);
        CHECK((x.emissive_factor.empty() ? std::vector<double>{0, 0, 0} : x.emissive_factor) == y.emissiveFactor);
        CHECK(numbers("metallic")[0] == y.pbrMetallicRoughness.metallicFactor);
        CHECK(numbers("roughness")[0] == y.pbrMetallicRoughness.roughnessFactor);
        CHECK(x.emissive_strength == number_of(y.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1));
        CHECK(x.unlit == (y.extensions.count("KHR_materials_unlit") != 0));
        compare_place(a, x.places[TextureSlot::base_color], y.pbrMetallicRoughness.baseColorTexture);
        compare_place(a, x.places[TextureSlot::metallic_roughness], y.pbrMetallicRoughness.metallicRoughnessTexture);
        compare_place(a, x.places[TextureSlot::normal], y.normalTexture);
        compare_place(a, x.places[TextureSlot::occlusion], y.occlusionTexture);
        compare_place(a, x.places[TextureSlot::emissive], y.emissiveTexture);
        if (y.normalTexture.index >= 0) CHECK(numbers("normal_scale")[0] == y.normalTexture.scale);
        if (y.occlusionTexture.index >= 0) CHECK(numbers("occlusion_strength")[0] == y.occlusionTexture.strength);
    }
    REQUIRE(a.textures.size() == b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        CHECK(a.textures[i].source == b.textures[i].source);
        CHECK(a.textures[i].sampler == b.textures[i].sampler);
    }
    REQUIRE(a.samplers.size() == b.samplers.size());
    for (std::size_t i = 0; i < a.samplers.size(); ++i) {
        CHECK(a.samplers[i].mag_filter == b.samplers[i].magFilter);
        CHECK(a.samplers[i].min_filter == b.samplers[i].minFilter);
        CHECK(a.samplers[i].wrap_s == b.samplers[i].wrapS);
        CHECK(a.samplers[i].wrap_t == b.samplers[i].wrapT);
    }
}

void compare_cameras_and_lights(const file::File& a, const tinygltf::Model& b) {
    REQUIRE(a.cameras.size() == b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        CHECK(a.cameras[i].name == b.cameras[i].name);
        CHECK(a.cameras[i].type == b.cameras[i].type);
        const tinygltf::PerspectiveCamera& p = b.cameras[i].perspective;
        const tinygltf::OrthographicCamera& o = b.cameras[i].orthographic;
        if (a.cameras[i].perspective) {
            const file::Projection& x = *a.cameras[i].perspective;
            CHECK(std::vector{x.yfov, x.aspect_ratio, x.znear, x.zfar} == std::vector{p.yfov, p.aspectRatio, p.znear, p.zfar});
        }
        if (a.cameras[i].orthographic) {
            const file::Projection& x = *a.cameras[i].orthographic;
            CHECK(std::vector{x.xmag, x.ymag, x.znear, x.zfar} == std::vector{o.xmag, o.ymag, o.znear, o.zfar});
        }
    }
    REQUIRE(a.lights.size() == b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        const file::Light& x = a.lights[i];
        const tinygltf::Light& y = b.lights[i];
        CHECK(x.type == y.type);
        CHECK(x.color == y.color);
        CHECK(x.intensity == y.intensity);
        CHECK(x.range == y.range);
        if (y.type == "spot") CHECK(x.inner_cone_angle == y.spot.innerConeAngle);
        if (y.type == "spot") CHECK(x.outer_cone_angle == y.spot.outerConeAngle);
    }
}

/// Compares the two readers. False if tinygltf refuses the file.
bool compare_readers(const Bytes& bytes) {
    std::span<const std::byte> json = bytes;
    if (io::detail::is_glb(bytes)) json = io::detail::split_glb(bytes)->json;
    const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
    tinygltf::Model second;
    if (!read_second(text, second)) return false;
    io::detail::Notes notes;
    const file::File first = io::detail::read_gltf_json(text, {}, {"objects", std::uint64_t{1} << 32}, notes, true);
    CHECK(first.version == second.asset.version);
    CHECK(first.generator == second.asset.generator);
    CHECK(std::vector<std::string>(first.extensions_used.begin(), first.extensions_used.end()) == second.extensionsUsed);
    compare_geometry(first, second);
    compare_nodes(first, second);
    compare_materials(first, second);
    compare_cameras_and_lights(first, second);
    return true;
}

}  // namespace

TEST_CASE("second reader: a file with many features reads as tinygltf reads it", "[io]") { CHECK(compare_readers(rich_file())); }

TEST_CASE("second reader: the sample models read as tinygltf reads them", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    int compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(*assets / "models")) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
        if (!load_gltf(entry.path().string(), strictly())) continue;  // refused for what it requires
        INFO(entry.path().string());
        const auto bytes = io::read_file(entry.path().string());
        REQUIRE(bytes);
        compared += compare_readers(*bytes) ? 1 : 0;
    }
    CHECK(compared >= 110);
}
