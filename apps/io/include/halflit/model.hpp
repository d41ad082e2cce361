// Loader of models of any format that halflit reads (ModelFormat), which it finds by the file's content. The file is not trusted: every
// length, index and reference is checked before it is used, other files are read only below the model's folder, and limits bound memory and
// time.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/prepared_scene.hpp"
#include "halflit/scene.hpp"
#include "halflit/up_axis.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit {

/// Formats of models. Scenes of all of them have y up; see LoadOptions::up.
enum class ModelFormat : std::uint8_t {
    gltf,      ///< glTF 2.0 as text
    glb,       ///< glTF 2.0 as GLB
    stl,       ///< ASCII or binary; z up; no unit: as it is
    ply,       ///< ASCII or binary; y up; no unit
    obj,       ///< with the materials of .mtl files; y up; no unit
    three_mf,  ///< z up; in metres, by the file's unit. Needs expat
    off        ///< text; y up; no unit
};

/// "glTF", "GLB", "STL" and so on.
[[nodiscard]] HALFLIT_API std::string_view model_format_name(ModelFormat format);

/// The format of a file by its content, as load_model finds it; nothing if it is none of these.
[[nodiscard]] HALFLIT_API std::optional<ModelFormat> find_model_format(std::span<const std::byte> bytes);

/// True if the library was built with expat. Without it, 3MF files are refused by name.
[[nodiscard]] HALFLIT_API bool has_three_mf();

/// Above a limit, loading ends with ErrorCode::limit.
struct LoadLimits {
    std::size_t max_file_bytes = std::size_t{2} << 30;   ///< each file: the model, a buffer, a picture
    std::size_t max_total_bytes = std::size_t{2} << 30;  ///< all buffers together
    int max_json_depth = 64;                             ///< objects and arrays inside each other
    std::size_t max_json_tokens = 50'000'000;            ///< names and values
    /// All textures, as the renderer keeps them (10.7 bytes a pixel), broken ones too. Above it, the largest are kept at a half of their
    /// sides, or less, with a warning, unless strict. Small files get less: 96 MiB, 256 bytes for each of their own and 2,000 more for each
    /// beyond the first million. Pictures that together have more pixels than this are refused.
    std::size_t max_texture_bytes = std::size_t{1} << 30;
    int max_texture_side = 16384;                            ///< texels; at most kMaxTextureSide
    std::size_t max_texture_pixels = std::size_t{64} << 20;  ///< one texture
    int max_jpeg_scans = 64;                                 ///< passes over the picture of a progressive JPEG, which bound its time
    /// All vertices, indices and instances together. A small file gets less: 32 MiB plus 96 bytes for each byte of the file. No real model
    /// needs more, and a crafted one cannot become many times larger than its file. Compressed data (meshopt, Draco) count twice. The JSON
    /// objects have the same limit.
    std::uint64_t max_geometry_bytes = std::uint64_t{16} << 30;
    /// Work that loading takes beside reading, and that each frame of the scene takes beside its pixels' (Scene::frame_work), in
    /// nanoseconds of one core by estimate. 0: by size, 1.7e9 and 1,000 for each byte of the file and of those
    /// that it names, so that no small file takes long.
    std::uint64_t max_work = 0;
    std::size_t max_lights = 1024;  ///< lights of the drawn nodes
    double time_limit_s = 0.0;      ///< wall clock, checked between the parts of the file; 0: no limit
    friend bool operator==(const LoadLimits&, const LoadLimits&) = default;
};

/// A program that turns files of another format into glTF. docs/formats.md says how it is called.
struct Importer {
    std::string extension;  ///< of the files, with its point
    std::string program;    ///< its path; it is run with as few rights as the system can take from it
    /// From ".ext=PROGRAM", with the program's path made absolute. Errors: usage, for another form, and a path that is no program.
    [[nodiscard]] HALFLIT_API static Result<Importer> from(const std::string& text);
    friend bool operator==(const Importer&, const Importer&) = default;
};

/// How a file is read. By default what is damaged is drawn as far as it goes, with warnings; limits always hold.
struct LoadOptions {
    bool strict = false;  ///< refuse a file of which something cannot be drawn: textures, animations, faces with bad indices
    /// Folders, besides the model's own, in which referenced files may lie: a name is looked up below them, and may lead into them by "..".
    /// One that cannot be opened is an error (usage).
    std::vector<std::string> allow_external;
    LoadLimits limits;  ///< on memory and time
    /// Threads that decode textures and make normals, this one included; 0: one for each processor. The result is the same. While it
    /// decodes, a thread holds up to 64 MB, or a whole picture if it is WebP, progressive JPEG or interlaced PNG, beside the texture.
    int threads = 0;
    /// Moves a scene to the origin if it lies farther from it than 1024 times its radius, and scales it by a power of two if its radius is
    /// below 2^-10 or above 2^30, so that float32 keeps its shape and the least distance of a point light (Light::source_radius) is small
    /// beside it. Other formats than glTF are read in double for that. LoadedScene::placement says what was done, with a warning. False:
    /// the file's own numbers, rounded to float32.
    bool recentre = true;
    /// Scene of the file: its name, or else its index in the file; empty: the file's default scene, or else its first. One that the file
    /// does not have is an error (usage).
    std::string scene;
    /// Variant of the file's materials (KHR_materials_variants), by name; empty: the materials without a variant. One that the file does
    /// not have is an error (usage).
    std::string variant;
    /// Animation that poses the scene: its name, or else its index in the file; empty: the first one, if the file has any; "none": the pose
    /// of the nodes, without animation. A name or an index that the file does not have is an error (usage).
    std::string animation;
    /// Time of the pose in seconds. Each channel holds its first value before its first key, and its last one after its last key, so a time
    /// beyond the animation's end draws its end.
    double time_s = 0.0;
    /// Reads all animations and keeps what they need (LoadedScene::motion), so that pose_at() can pose the scene at other times. A fault of
    /// any of them refuses the file then.
    bool keep_animations = false;
    /// Axis of the model that points up: the scene is turned so that it becomes y. None: as its format has it by custom, which is z for
    /// STL, 3MF, STEP, IGES and BREP and y for the others.
    std::optional<UpAxis> up{};
    /// Other formats than glTF: where the file has no normals, the surface is smooth across edges whose triangles' normals differ by at
    /// most this, degrees in [0, 180]. In a scan the limit at a vertex is three times the median of its edges' angles, at most twice
    /// this. A scan has 10,000 triangles and more, few edges that are flat, and a median angle below 20 degrees.
    float crease_deg = 30.0f;
    /// Plate of a slicer's project (3MF), from 1; 0: all of them. A file without plates is drawn whole.
    int plate = 1;
    /// STEP, IGES, BREP and what importers read: the picture's pixels along the diagonal of the model's box, in [1, 1e6]. Triangles are at
    /// most a quarter of such a pixel from the surfaces.
    double detail_px = 2048.0;
    bool exact_measures = false;  ///< STEP, IGES, BREP: measures their surfaces too (SceneInfo::exact), which takes longer
    /// Keeps what importers make in the user's cache, halflit/import in XDG_CACHE_HOME or ~/.cache, at most 256 MiB.
    bool import_cache = false;
    /// Asked before the formats that are known, by the file's name; the first one with its extension counts. Then those of the user's file
    /// halflit/importers in XDG_CONFIG_HOME or ~/.config: a line ".ext=PROGRAM" for each.
    std::vector<Importer> importers{};
    friend bool operator==(const LoadOptions&, const LoadOptions&) = default;
};

/// An animation of a file.
struct AnimationInfo {
    std::string name;          ///< may be empty, and several may have the same
    double end_s = 0.0;        ///< time of the last key, seconds; 0 if the file does not tell
    std::size_t channels = 0;  ///< properties that it moves, drawn or not
};

/// Animations of a file, with their key frames and all that they move. Made by the loader (LoadOptions::keep_animations); it never changes,
/// so any number of threads may use it.
class Motion;

/// Measures of a node's surfaces, not of the triangles that are drawn. Millimetres, along the file's axes.
struct ExactMeasures {
    int node = -1;        ///< index into LoadedScene::nodes
    Vec3d min{}, max{};   ///< corners of its smallest box along the axes
    double area = 0.0;    ///< of all faces
    double volume = 0.0;  ///< of all solids
    int solids = 0;       ///< number of these
};

/// Contents of the file, drawn or not.
struct SceneInfo {
    std::string format;              ///< model_format_name(), or "G-code" for its picture
    std::string version, generator;  ///< asset.version and asset.generator
    /// @{
    /// Number in the file.
    std::size_t meshes = 0, primitives = 0, nodes = 0, materials = 0, textures = 0, images = 0, animations = 0, skins = 0, cameras = 0,
                lights = 0;
    std::size_t scenes = 0, morph_targets = 0;
    /// @}
    double unit_m = 0.0;                        ///< length of the file's unit in metres; 0: the format has none
    double detail_px = 0.0;                     ///< LoadOptions::detail_px of an importer's triangles; 0: they are the file's own
    std::vector<ExactMeasures> exact{};         ///< with LoadOptions::exact_measures, of nodes of formats that have exact surfaces
    std::size_t point_and_line_primitives = 0;  ///< primitives of the drawn nodes that are points or lines
    std::uint64_t triangles_stored = 0;         ///< triangles of the meshes that are drawn, each once
    std::uint64_t triangles_drawn = 0;          ///< triangles over all instances
    std::uint64_t vertices = 0;                 ///< vertices after splitting for flat normals and tangents
    std::vector<std::string> scene_names;       ///< of all scenes in the file, by their numbers in it; may be empty
    int scene = -1;                             ///< the scene that is drawn; -1: the file has none, all nodes are drawn
    std::vector<std::string> variants;          ///< names of KHR_materials_variants
    std::vector<std::string> files;             ///< paths of the files that the model names, whether or not they exist or are drawn
    /// Names in the file's order, each once.
    std::vector<std::string> extensions_used;
    /// Those without which the file must not be drawn.
    std::vector<std::string> extensions_required;
};

/// Transform of a node: the images of x, y and z, and that of the origin. In double, as chains of nodes are rounded to float once, at the
/// end.
struct NodeTransform {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};  ///< in the parent's space; by default the identity

    NodeTransform() = default;
    /// Not explicit: poses are made by translation(), rotation() and scaling(). The matrix's last row counts as 0 0 0 1.
    HALFLIT_API NodeTransform(const Mat4& m);
    friend bool operator==(const NodeTransform&, const NodeTransform&) = default;
};

/// Where a model lies in the scene. What a host adds, a camera or a light of its own, goes through into(), and what it reads of the scene
/// through out(). Points are in the model's own coordinates: those of its root nodes, in the file's unit.
struct Placement {
    Vec3d origin{0, 0, 0};              ///< that is drawn at the origin, with `up` turned to +y
    double scale = 1.0;                 ///< a power of two
    std::vector<double> mesh_scales{};  ///< by which positions in each mesh were multiplied; empty: by 1
    UpAxis up = UpAxis::y;              ///< axis of the model that is drawn as +y

    /// Where a point of the model is drawn.
    [[nodiscard]] Vec3d into(Vec3d p) const { return (turned_upright(p, up) - origin) * scale; }
    /// The point of the model that is drawn there.
    [[nodiscard]] Vec3d out(Vec3d p) const { return turned_back(p * (1.0 / scale) + origin, up); }
    friend bool operator==(const Placement&, const Placement&) = default;
};

/// A node of the file, and what it places in the scene: nothing if the scene that was loaded does not draw it.
struct Node {
    std::string name;                ///< may be empty
    int parent = -1;                 ///< index into LoadedScene::nodes; -1: none
    NodeTransform parent_from_node;  ///< for pose()
    std::vector<int> instances;      ///< indices into Scene::instances, one for each primitive of its mesh; skinned ones are left out
    /// EXT_mesh_gpu_instancing: the transform of each of `instances` to the node; empty: all are the identity.
    std::vector<NodeTransform> node_from_instance;
    int camera = -1, light = -1;  ///< indices into Scene::cameras and Scene::lights; -1: none
};

/// A file's scene, its nodes, and the loader's warnings and counts.
struct LoadedScene {
    Scene scene;                            ///< the scene that LoadOptions::scene chooses
    std::vector<Node> nodes;                ///< all nodes of the file, by their numbers in it, in the pose that was loaded
    std::vector<int> node_of_instance;      ///< for each of Scene::instances its node: also for skinned ones, which follow their joints
    std::vector<AnimationInfo> animations;  ///< all animations of the file, by their numbers in it
    int animation = -1;                     ///< the animation that poses the scene; -1: none
    std::shared_ptr<const Motion> motion;   ///< for pose_at(); null without LoadOptions::keep_animations
    /// Parts that the picture lacks, and values that the file must not have, by their JSON path: one line each, no file prefix, at most a
    /// hundred and one that counts the others.
    std::vector<std::string> warnings;
    Placement placement;  ///< where the model lies; see LoadOptions::recentre and up
    SceneInfo info;       ///< counts for the user
};

/// Loads the model at `path`; files that it refers to are read from its folder. Error messages begin with `path`. Thread-safe.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_model(const std::string& path, const LoadOptions& options = {});

/// Loads a model from memory, e.g. from standard input. `name` is for messages; an empty `base_dir` means that no other file is read.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_model_bytes(std::span<const std::byte> bytes, const std::string& name,
                                                               const std::string& base_dir, const LoadOptions& options = {});

/// Places instances, cameras and lights as the nodes' transforms, in the model's own coordinates, say: change parent_from_node of some,
/// then call this. placement: LoadedScene::placement. Nodes as loaded give the same bits as loading. Returns what moved, for
/// PreparedScene::update. Skinned meshes stay as loaded: their vertices were moved then. Instances, cameras and lights that a host appends
/// to the scene stay where they are. Fails (usage), with the scene unchanged, where a parent is out of range or its own ancestor, or the
/// scene lacks what a node places.
[[nodiscard]] HALFLIT_API Result<SceneChanges> pose(std::span<const Node> nodes, Scene& scene, const Placement& placement);

/// Poses a scene by one of its file's animations, as LoadOptions::animation and time_s would: the scene then draws the same pixels as one
/// that is loaded so (if it was not moved by LoadOptions::recentre, whose choice stays). Each call begins at the pose of the nodes, so the
/// order of calls does not matter. Moves instances, skinned and morphed meshes, cameras and lights, and sets the animated factors of
/// materials, lights and cameras; all else in the scene stays as a host has set it. Returns what changed, for PreparedScene::update.
/// nodes: LoadedScene::nodes, which get the pose too; may be empty.
/// Fails (usage) for an animation that the file does not have, a time that is not finite, and where the scene lacks what the file placed;
/// the scene is unchanged then.
[[nodiscard]] HALFLIT_API Result<SceneChanges> pose_at(const Motion& motion, const std::string& animation, double time_s, Scene& scene,
                                                       std::span<Node> nodes = {});

}  // namespace halflit
