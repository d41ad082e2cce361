// Contents of a glTF file, as the loader needs them: one struct for each kind of object, with names and defaults of the glTF 2.0 schema.
// An index of -1 means "not there". Filled by read_gltf_json, which checks every type, range and index. An index that is out of range
// becomes -1 if it is not refused.
#pragma once

#include "apps/io/files/lobe_name.hpp"
#include "apps/io/gltf/file/transform.hpp"
#include "shading/material_properties.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail::file {

enum class Mode : int { points = 0, lines = 1, line_loop = 2, line_strip = 3, triangles = 4, triangle_strip = 5, triangle_fan = 6 };

struct Buffer {
    std::optional<std::string_view> uri;
    std::uint64_t byte_length = 0;
};

struct BufferView {
    int buffer = -1;
    int byte_stride = 0;  ///< 0: packed
    std::uint64_t byte_offset = 0, byte_length = 0;
    int compressed = -1;   ///< into File::compressed_views; -1: the view's own bytes are read
    int decoded = -1;      ///< into Document::decoded, once it is there
    bool damaged = false;  ///< its compressed data cannot be decoded
};

enum class CompressionMode : std::uint8_t { attributes, triangles, indices };
enum class CompressionFilter : std::uint8_t { none, octahedral, quaternion, exponential, color };

/// EXT_meshopt_compression or KHR_meshopt_compression of a bufferView.
struct CompressedView {
    int buffer = -1, byte_stride = 0;  ///< byte_stride: of the decoded elements
    std::uint64_t byte_offset = 0, byte_length = 0;
    std::uint64_t count = 0;  ///< decoded elements
    CompressionMode mode = CompressionMode::attributes;
    CompressionFilter filter = CompressionFilter::none;
};

struct Sparse {
    int count = 0;
    int index_view = -1, index_offset = 0, index_component_type = 0;
    int value_view = -1, value_offset = 0;
};

struct Accessor {
    int buffer_view = -1;
    int component_type = 0;
    int components = 1;  ///< components of an element: 1, 2, 3, 4, 9 or 16
    int sparse = -1;     ///< into File::sparse
    std::uint64_t byte_offset = 0, count = 0;
    bool normalized = false;
    int stands_for = -1;        ///< the accessor of the file in whose place this one was decoded; -1: itself
    std::optional<double> max;  ///< the first number of `max`: of key times, the last one
};

/// Accessors by attribute name. There are few, so a list is as fast as a map, and smaller.
using Attributes = std::vector<std::pair<std::string_view, int>>;
[[nodiscard]] int find(const Attributes& attributes, std::string_view name);  ///< -1: not there
[[nodiscard]] bool is_drawn(std::string_view attribute);                      ///< no set beyond those that the renderer has, no "_AGE"
[[nodiscard]] bool is_of_skin(std::string_view attribute);                    ///< JOINTS_0, WEIGHTS_0, ...
[[nodiscard]] bool is_of_vertices(std::string_view attribute);                ///< one of both
[[nodiscard]] bool is_of_instances(std::string_view attribute);               ///< TRANSLATION, ROTATION or SCALE

/// What the names of attributes of KHR_gaussian_splatting begin with.
inline constexpr std::string_view kSplatAttributes = "KHR_gaussian_splatting:";

/// KHR_materials_variants: the material of a primitive in some variants.
struct VariantMaterial {
    int material = -1;
    std::vector<int> variants;  ///< into File::variants
};

struct Primitive {
    Attributes attributes;
    std::vector<Attributes> targets;
    std::vector<VariantMaterial> variants;
    int indices = -1, material = -1;
    int mode = static_cast<int>(Mode::triangles);
    int draco = -1;  ///< into File::draco; -1: none
    int spz = -1;    ///< bufferView of an SPZ file, in place of the attributes; -1: none
    /// KHR_gaussian_splatting: its colours are linear light.
    bool linear_splats = false;
};

/// KHR_draco_mesh_compression of a primitive.
struct Draco {
    int buffer_view = -1;
    Attributes attributes;  ///< unique ids within the stream, by attribute name
};

struct Mesh {
    std::string_view name;
    std::vector<Primitive> primitives;
    std::vector<double> weights;
};

/// `count` entries of a shared array from `first` on.
struct Run {
    std::uint32_t first = 0, count = 0;
};

/// A matrix, or translation, rotation (a quaternion x, y, z, w) and scale.
struct Transform {
    double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    std::optional<Affine> matrix;
};

struct Node {
    std::string_view name;
    int mesh = -1, skin = -1, camera = -1, light = -1;
    int transform = -1;   ///< into File::transforms; -1: none
    int instancing = -1;  ///< into File::instancings; -1: none
    Run children;         ///< entries of File::children
    Run weights;          ///< entries of File::weights
    double visible = 1;   ///< KHR_node_visibility; 0: hidden, with all below. A number, as animations write it
};

struct Skin {
    std::vector<int> joints;
    int inverse_bind_matrices = -1;
};

struct Projection {
    double yfov = 0, aspect_ratio = 0;  ///< perspective; aspect_ratio 0: the picture's
    double xmag = 0, ymag = 0;          ///< orthographic
    double znear = 0, zfar = 0;         ///< perspective, zfar 0: infinite
};

struct Camera {
    std::string_view type, name;
    std::optional<Projection> perspective, orthographic;
};

/// KHR_lights_punctual
struct Light {
    std::string_view type;
    std::vector<double> color;
    double intensity = 1, range = 0;  ///< range 0: infinite
    bool has_spot = false;
    double inner_cone_angle = 0, outer_cone_angle = 0.7853981634;
    double size = 0;  ///< extras.halflit, this project's own: radius, or of a directional light the angle from middle to rim in degrees
};

struct Image {
    std::optional<std::string_view> uri;
    std::string_view mime_type;
    int buffer_view = -1;
    std::string_view place;  ///< for messages; empty: its JSON path. Of other formats
};

struct Sampler {
    int mag_filter = -1, min_filter = -1;
    int wrap_s = 10497, wrap_t = 10497;
};

struct Texture {
    int source = -1, sampler = -1;
    int webp = -1, basisu = -1;  ///< images of EXT_texture_webp and KHR_texture_basisu
};

/// KHR_texture_transform
struct TextureTransform {
    std::vector<double> offset, scale;
    double rotation = 0;
    int tex_coord = -1;  ///< -1: the texture's own
};

struct TexturePlace {
    int index = -1, tex_coord = 0;
    int transform = -1;  ///< into File::texture_transforms; -1: none
};

/// extras.halflit, this project's own: the lobe of a material.
struct OwnLobe {
    std::string_view name;
    LobeParameters parameters;
};

/// KHR_materials_pbrSpecularGlossiness, which replaces the metallic-roughness parameters.
struct SpecularGlossiness {
    std::vector<double> diffuse_factor, specular_factor;  ///< 4 and 3, or empty
    double glossiness_factor = 1;
    TexturePlace diffuse_texture, specular_glossiness_texture;
};

/// Numbers of a material, by shading::kFirstFloats; those without a place in glTF are not used.
using MaterialNumbers = std::array<double, shading::kMaterialFloats>;
[[nodiscard]] const MaterialNumbers& default_numbers();

/// "extensions.KHR_materials_sheen.sheenColorTexture", for messages.
[[nodiscard]] std::string place_of(TextureSlot slot);

struct Material {
    std::string_view name;
    std::string_view alpha_mode = "OPAQUE";
    MaterialNumbers numbers = default_numbers();
    BySlot<TexturePlace> places;
    std::vector<double> emissive_factor;  ///< 3, or empty
    double emissive_strength = 1;         ///< KHR_materials_emissive_strength
    double ior = 1.5;                     ///< KHR_materials_ior; 0: everything is mirrored
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit
    std::optional<OwnLobe> own_lobe;
    int glossy = -1;  ///< into File::glossy; -1: not of specular and glossiness

    /// True if KHR_materials_pbrSpecularGlossiness replaces what is at a place below the material.
    [[nodiscard]] bool replaces(std::string_view gltf) const { return glossy >= 0 && gltf.starts_with("pbrMetallicRoughness/"); }
};

struct Scene {
    std::string_view name;
    std::vector<int> nodes;
};

enum class Interpolation : std::uint8_t { linear, step, cubic };

struct AnimationSampler {
    int input = -1, output = -1;  ///< accessors: key times, and values
    Interpolation interpolation = Interpolation::linear;
};

struct AnimationChannel {
    int sampler = -1, node = -1;  ///< sampler: of the same animation
    std::string_view path;
    std::string_view pointer;  ///< KHR_animation_pointer
};

struct Animation {
    std::string_view name;
    std::vector<AnimationChannel> channels;
    std::vector<AnimationSampler> samplers;
};

struct File {
    std::string_view version, min_version, generator;
    std::vector<double> measures;                   ///< of an importer: ExactMeasures one after the other, member by member
    std::vector<std::string_view> import_warnings;  ///< likewise, one line each
    bool has_dictionaries = false;                  ///< lists are objects, as in glTF 1.0
    std::vector<std::string_view> extensions_used, extensions_required;
    std::vector<Buffer> buffers;
    std::vector<BufferView> buffer_views;
    std::vector<CompressedView> compressed_views;
    std::vector<Accessor> accessors;
    std::vector<Sparse> sparse;
    std::vector<Mesh> meshes;
    std::vector<Draco> draco;
    std::vector<Node> nodes;
    std::vector<Transform> transforms;
    std::vector<Attributes> instancings;  ///< EXT_mesh_gpu_instancing
    std::vector<int> children;
    std::vector<double> weights;
    std::vector<Skin> skins;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<Image> images;
    std::vector<Sampler> samplers;
    std::vector<Texture> textures;
    std::vector<TextureTransform> texture_transforms;
    std::vector<Material> materials;
    std::vector<SpecularGlossiness> glossy;
    std::vector<Scene> scenes;
    std::vector<Animation> animations;
    std::vector<std::string_view> variants;  ///< names of KHR_materials_variants
    int scene = -1;
    std::size_t primitives = 0, morph_targets = 0;
    std::deque<std::string> texts;  ///< strings that had escapes, decoded; all others point into the JSON text

    [[nodiscard]] bool uses(std::string_view extension) const;
    /// Null: the place has none.
    [[nodiscard]] const TextureTransform* transform_of(const TexturePlace& place) const {
        return place.transform < 0 ? nullptr : &texture_transforms[static_cast<std::size_t>(place.transform)];
    }
};

}  // namespace halflit::io::detail::file
