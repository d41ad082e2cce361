// halflit for C, and for languages that call C: glTF or arrays in, picture out.
//
// - Handles: halflit_scene, halflit_lighting and halflit_renderer are freed by the function that ends in destroy.
// - Results: A function that can fail returns a code: HALFLIT_OK, which is 0, or one of the HALFLIT_ERROR codes. halflit_last_error() has
//   the message. Results of a call come through its last pointers; they are written if the code is HALFLIT_OK. A null pointer is an error
//   (usage), unless the function says otherwise.
// - Structs: The first member is the struct's size, so that a program and a newer library agree on what both know. After
//   `halflit_settings settings; halflit_settings_init(&settings, sizeof settings);` the size and the defaults are set. Members that an
//   older program does not have keep their defaults. If a newer program sets members that this library does not know, the call fails
//   (usage). Structs without an init function are results: set their size, the call fills in the rest. Reserved members are 0.
// - Memory: Arrays and strings that are handed over are copied, or used during the call alone. Pictures are drawn into the caller's memory.
// - Numbers: Truth is an int32_t: 0 or not. Strings are UTF-8. Indices begin at 0. A matrix is 16 floats, column after column; points are
//   columns. Colours are linear light with Rec. 709 primaries, if nothing else is said.
// - Coordinates: All that is passed in and returned, cameras, lights, instances, boxes and planes, has the coordinates of the scene's file,
//   or of the caller's arrays, which are right-handed, in the file's unit. The axis that points up (HALFLIT_UP) decides
//   what views, and the light from above, call up; it turns nothing.
// - Threads: Different scenes and renderers may be used by different threads at once. Several renderers may draw one scene at once; a call
//   that would change it meanwhile fails (usage). A renderer draws one frame at a time. Destroy nothing that is in use.
#ifndef HALFLIT_HALFLIT_H
#define HALFLIT_HALFLIT_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && defined(HALFLIT_BUILDING_SHARED)
#define HALFLIT_C_API __attribute__((visibility("default")))
#else
#define HALFLIT_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ---- version and errors ------------------------------------------------------------------------------------------------

/// Version of the library, as "0.1.0".
HALFLIT_C_API const char* halflit_version(void);
/// Libraries of equal pixel epoch give equal pixels.
HALFLIT_C_API int32_t halflit_pixel_epoch(void);

enum {
    HALFLIT_OK = 0,
    HALFLIT_ERROR_USAGE = 2,      ///< an argument out of range, or two that exclude each other
    HALFLIT_ERROR_BAD_INPUT = 3,  ///< a damaged file or faulty arrays
    HALFLIT_ERROR_IO = 4,         ///< a file that cannot be read or written
    HALFLIT_ERROR_LIMIT = 5,      ///< a limit was hit, or the memory is full
    HALFLIT_ERROR_INTERNAL = 6,   ///< a fault of the library
    HALFLIT_ERROR_CANCELLED = 7   ///< halflit_execution.cancelled stopped the frame, or SIGINT the call
};

/// Message of the calling thread's last call that failed: one line, without a full stop. Empty if none failed. Valid until the thread's
/// next call that fails.
HALFLIT_C_API const char* halflit_last_error(void);
/// stops: 1: SIGINT, as Ctrl-C sends it, ends this thread's later calls with HALFLIT_ERROR_CANCELLED, after the process's own handler has
/// run; 0: it does not (default). For calls that take long: those that load, take meshes or choose a picture end within half a second. A
/// scene that was being changed is as after a lack of memory: sound, but without all or a part of the change. See
/// halflit_execution.stop_at_interrupt for frames.
HALFLIT_C_API void halflit_stop_at_interrupt(int32_t stops);

// ---- scenes and files --------------------------------------------------------------------------------------------------

/// Everything that a picture shows: meshes, instances of them, materials, textures, lights, cameras.
typedef struct halflit_scene halflit_scene;

/// The axis of a model that points up. BY_FORMAT: z for STL, 3MF, STEP, IGES and BREP, y for the others.
enum {
    HALFLIT_UP_BY_FORMAT = 0,
    HALFLIT_UP_X = 1,
    HALFLIT_UP_Y = 2,
    HALFLIT_UP_Z = 3,
    HALFLIT_UP_MINUS_X = 4,
    HALFLIT_UP_MINUS_Y = 5,
    HALFLIT_UP_MINUS_Z = 6
};

/// How a model file is read. The file is not trusted: above a limit, loading fails (limit). Defaults in parentheses.
typedef struct halflit_load_options {
    size_t size;
    const char* scene;    ///< scene of the file: its name, or else its index; null or empty: the one that the file names, or the first
    const char* variant;  ///< variant of the file's materials, by name; null or empty: the materials without a variant
    /// Animation that poses the scene: its name, or else its index in the file; null or empty: the first one, if there is any; "none": the
    /// pose of the nodes.
    const char* animation;
    double time_s;            ///< time of the pose, seconds; before an animation's first key and after its last one, these are drawn (0)
    int32_t keep_animations;  ///< keep what halflit_scene_pose() needs (0)
    int32_t up;               ///< HALFLIT_UP: of the model; coordinates stay the file's (by format)
    /// Draws a scene that is far from the origin at the origin, and a tiny or huge one in another size, so that float32 keeps its shape.
    /// Coordinates stay the file's (1).
    int32_t recentre;
    float crease_deg;  ///< files without normals but glTF: smooth across edges up to this angle, twice as much in noisy scans (30)
    int32_t strict;    ///< refuse a file of which something cannot be drawn: textures, animations, faces with bad indices (0)
    int32_t threads;   ///< threads that decode textures and make normals, the calling one included; 0: one for each core (0)
    const char* const* allow_external;  ///< folders, besides the model's own, in which referenced files may lie
    size_t allow_external_count;        ///< number of these folders
    double time_limit_s;                ///< wall clock, checked between the parts of the file; 0: no limit (0)
    uint64_t max_file_bytes;            ///< each file: the model, a buffer, a picture (2 GiB)
    uint64_t max_total_bytes;           ///< all buffers together (2 GiB)
    uint64_t max_json_tokens;           ///< names and values (50,000,000)
    uint64_t max_texture_bytes;         ///< all textures, 10.7 bytes a pixel; the largest are kept smaller until they fit (1 GiB)
    uint64_t max_texture_pixels;        ///< one texture (2^26)
    uint64_t max_geometry_bytes;        ///< all vertices, indices and instances together (16 GiB)
    uint64_t max_lights;                ///< lights of the drawn nodes (1024)
    int32_t max_json_depth;             ///< objects and arrays inside each other (64)
    int32_t max_texture_side;           ///< texels (16384)
    int32_t max_jpeg_scans;             ///< passes over the picture of a progressive JPEG (64)
    int32_t plate;                      ///< plate of a slicer's project (3MF); 0: all (1)
    /// Most work of loading, and of each frame besides its pixels, in estimated nanoseconds of one core. 0: chosen by the file's size (0)
    uint64_t max_work;
    /// STEP, IGES, BREP: pixels along the diagonal of the model's box; triangles are at most a quarter of one from the surfaces (2048)
    double detail_px;
    const char* const* importers;  ///< ".ext=PROGRAM" for each program that turns files with this extension into glTF
    size_t importers_count;        ///< number of these
} halflit_load_options;
HALFLIT_C_API int32_t halflit_load_options_init(halflit_load_options* options, size_t size);

/// Numbers of a scene's parts.
typedef struct halflit_counts {
    size_t size;
    uint64_t triangles;                                       ///< over all instances
    int32_t meshes, instances, materials, textures, cameras;  ///< one more than the largest index
    int32_t lights;                                           ///< likewise, without an environment's suns
    int32_t nodes;                                            ///< of the file
    int32_t animations;                                       ///< of the file
    int32_t warnings;                                         ///< of loading
    int32_t reserved;
} halflit_counts;

/// An animation of a scene's file.
typedef struct halflit_animation {
    size_t size;
    const char* name;   ///< may be empty; valid as long as the scene
    double end_s;       ///< time of the last key, seconds; 0 if the file does not tell
    uint64_t channels;  ///< properties that it moves
} halflit_animation;

/// Makes an empty scene.
HALFLIT_C_API int32_t halflit_scene_create(halflit_scene** scene);
/// Makes a scene of a model's file (glTF, STL, PLY, OBJ, 3MF and others), whose format is found by its content; files that it refers to are
/// read from its folder. options may be null: the defaults.
HALFLIT_C_API int32_t halflit_scene_load(const char* path, const halflit_load_options* options, halflit_scene** scene);
/// The same from `count` bytes. name is for messages. base_dir is the folder of files that it refers to; if it is null, none is read.
HALFLIT_C_API int32_t halflit_scene_load_memory(const void* bytes, size_t count, const char* name, const char* base_dir,
                                                const halflit_load_options* options, halflit_scene** scene);
/// Adds a file, posed as options say, to a scene: its meshes, materials, textures, cameras, lights and nodes come after those that are
/// there. world_from_file: 16 doubles, column after column, that place it, cameras and lights too; null: the identity. Coordinates are the
/// file's, whatever its up. A scene without content, whose up was not set, takes that of the file. first, count: the instances that were
/// added; may be null. Fails (usage) for keep_animations.
HALFLIT_C_API int32_t halflit_scene_add_file(halflit_scene* scene, const char* path, const halflit_load_options* options,
                                             const double* world_from_file, int32_t* first, int32_t* count);
/// The same from bytes: see halflit_scene_load_memory.
HALFLIT_C_API int32_t halflit_scene_add_file_memory(halflit_scene* scene, const void* bytes, size_t byte_count, const char* name,
                                                    const char* base_dir, const halflit_load_options* options,
                                                    const double* world_from_file, int32_t* first, int32_t* count);
/// Makes the built-in demo scene, which has lights and a camera.
HALFLIT_C_API int32_t halflit_scene_create_demo(halflit_scene** scene);
/// Sets the axis that points up in a scene of arrays: named views, angles, the ground, the light from above and environments go by it. up:
/// HALFLIT_UP; by default y. For a scene without instances, lights and cameras.
HALFLIT_C_API int32_t halflit_scene_set_up(halflit_scene* scene, int32_t up);
/// Takes the bytes of a file, which are there during the call alone.
typedef void (*halflit_write)(void* user, const void* bytes, size_t count);
/// Hands over the scene as bytes, for a copy or for another process: all that it has, in its present state, but what
/// halflit_scene_pose() needs. write is called once. Fails (usage) for an environment whose image was not kept, and for a studio.
HALFLIT_C_API int32_t halflit_scene_save(const halflit_scene* scene, halflit_write write, void* user);
/// Replaces all that a scene has by that of another one, from its bytes. What halflit_scene_pose() needs stays: load the same file before,
/// to pose it later. Fails (bad input) for bytes of another version of the library, or that are damaged.
HALFLIT_C_API int32_t halflit_scene_restore(halflit_scene* scene, const void* bytes, size_t count);
/// Frees a scene. Null is allowed.
HALFLIT_C_API void halflit_scene_destroy(halflit_scene* scene);

/// Counts the scene's parts. Set counts->size before.
HALFLIT_C_API int32_t halflit_scene_get_counts(const halflit_scene* scene, halflit_counts* counts);
/// A warning of loading: one line, valid as long as the scene.
HALFLIT_C_API int32_t halflit_scene_get_warning(const halflit_scene* scene, int32_t index, const char** text);
/// An animation of the file. Set animation->size before.
HALFLIT_C_API int32_t halflit_scene_get_animation(const halflit_scene* scene, int32_t index, halflit_animation* animation);
/// Poses a scene, loaded with keep_animations, by another animation or at another time: the next frame is the one of a scene that is loaded
/// so. animation: as in halflit_load_options. Meshes, instances, cameras, lights and factors of materials that the file's animations move
/// are set; all else stays as the caller has set it.
HALFLIT_C_API int32_t halflit_scene_pose(halflit_scene* scene, const char* animation, double time_s);
/// The scene's HALFLIT_UP, and how float32 is spared: a point p is drawn at (p' - origin) * scale, where p' is p turned so that `up`
/// becomes y. No other function shows it: they take and give the file's coordinates. Each pointer may be null.
HALFLIT_C_API int32_t halflit_scene_get_placement(const halflit_scene* scene, double origin[3], double* scale, int32_t* up);
/// Parts of a scene that have a name.
enum { HALFLIT_PART_NODE = 0, HALFLIT_PART_INSTANCE = 1, HALFLIT_PART_MESH = 2, HALFLIT_PART_MATERIAL = 3, HALFLIT_PART_CAMERA = 4 };

/// Name of a part; an instance without one has its node's. May be empty; valid until the scene is changed or destroyed.
HALFLIT_C_API int32_t halflit_scene_get_name(const halflit_scene* scene, int32_t part, int32_t index, const char** name);
/// Names an instance, a mesh or a material.
HALFLIT_C_API int32_t halflit_scene_set_name(halflit_scene* scene, int32_t part, int32_t index, const char* name);

/// A node of the file's tree, and what it places.
typedef struct halflit_node {
    size_t size;
    const char* name;          ///< may be empty; valid as long as the scene
    const int32_t* instances;  ///< one for each primitive of its mesh, skinned ones too; valid as long as the scene
    int32_t instance_count;    ///< their number
    int32_t parent;            ///< node; -1: none
    int32_t camera, light;     ///< -1: none
} halflit_node;
/// A node of the file. Set node->size before.
HALFLIT_C_API int32_t halflit_scene_get_node(const halflit_scene* scene, int32_t index, halflit_node* node);
/// World-space box of everything drawn; min is infinity and max -infinity if there is nothing. Takes time in proportion to the vertices.
HALFLIT_C_API int32_t halflit_scene_get_bounds(const halflit_scene* scene, float min[3], float max[3]);
/// The same in double, for scenes that are far from the origin.
HALFLIT_C_API int32_t halflit_scene_get_box(const halflit_scene* scene, double min[3], double max[3]);

// ---- textures and materials --------------------------------------------------------------------------------------------

/// Encodings of a texture's red, green and blue. HALFLIT_COLOR_SRGB_BY_ALPHA: sRGB, and in the smaller levels a colour counts as its alpha,
/// for materials that mask or blend. HALFLIT_COLOR_NORMAL: linear, a normal map, whose smaller levels make the surface rougher.
enum { HALFLIT_COLOR_SRGB = 0, HALFLIT_COLOR_LINEAR = 1, HALFLIT_COLOR_SRGB_BY_ALPHA = 2, HALFLIT_COLOR_NORMAL = 3 };

/// Adds a texture: four bytes a pixel (RGBA), row 0 on top, rows row_bytes apart (0: without gaps). color is that of red, green and blue;
/// alpha is linear. Sides up to 16384. index may be null.
HALFLIT_C_API int32_t halflit_scene_add_texture(halflit_scene* scene, const uint8_t* rgba8, int32_t width, int32_t height, size_t row_bytes,
                                                int32_t color, int32_t* index);
/// Replaces a texture; the size may differ.
HALFLIT_C_API int32_t halflit_scene_set_texture(halflit_scene* scene, int32_t index, const uint8_t* rgba8, int32_t width, int32_t height,
                                                size_t row_bytes, int32_t color);
/// Removes a texture that no material uses; halflit_scene_add_texture may use its index again.
HALFLIT_C_API int32_t halflit_scene_remove_texture(halflit_scene* scene, int32_t index);

/// Meaning of alpha: none; drawn where it reaches alpha_cutoff; drawn over what is behind, by depth at each sample.
enum { HALFLIT_ALPHA_OPAQUE = 0, HALFLIT_ALPHA_MASK = 1, HALFLIT_ALPHA_BLEND = 2 };
/// Texture outside the coordinates 0 to 1: repeated, repeated with every other copy mirrored, or its edge continued.
enum { HALFLIT_WRAP_REPEAT = 0, HALFLIT_WRAP_MIRROR = 1, HALFLIT_WRAP_CLAMP = 2 };
/// Texels of a level that a look-up reads: the nearest, or the four around it.
enum { HALFLIT_FILTER_NEAREST = 0, HALFLIT_FILTER_LINEAR = 1 };
/// Levels that a look-up reads: the largest alone, the one nearest in size, or the two nearest.
enum { HALFLIT_MIP_NONE = 0, HALFLIT_MIP_NEAREST = 1, HALFLIT_MIP_LINEAR = 2 };

/// A material's use of a texture.
typedef struct halflit_texture_use {
    int32_t texture;                 ///< index; -1: none
    int32_t uv_set;                  ///< 0 or 1
    int32_t wrap_u, wrap_v;          ///< HALFLIT_WRAP
    int32_t mag_filter, min_filter;  ///< HALFLIT_FILTER
    int32_t mip_filter;              ///< HALFLIT_MIP
    float row_u[3], row_v[3];        ///< u' = row_u[0] u + row_u[1] v + row_u[2], likewise v'
} halflit_texture_use;

/// Diffuse light as a function of x, the cosine between normal and light: max(0, (x + wrap) / (1 + wrap))^power.
typedef struct halflit_lobe {
    float wrap;         ///< 0 (Lambert) to 1
    float power;        ///< 0 to 10000
    int32_t normalize;  ///< scale such that a surface receives as much light as by Lambert
} halflit_lobe;

/// A lobe of the literature: lambert, green, half-lambert, valve, sloan or mcauley. wrap is for those that take one.
HALFLIT_C_API int32_t halflit_lobe_by_name(const char* name, float wrap, halflit_lobe* lobe);

/// The parameters of glTF's metallic-roughness materials, and a lobe; defaults in parentheses. Numbers are multiplied by the textures
/// with their names, metallic and roughness by channels of metallic_roughness_texture. The encoding that a texture is made with is named
/// there; c is a texel's colour.
typedef struct halflit_material {
    size_t size;
    const char* name;        ///< may be null. From halflit_scene_get_material: valid until the scene is changed or destroyed
    int32_t alpha_mode;      ///< HALFLIT_ALPHA
    int32_t double_sided;    ///< draw back faces too
    int32_t unlit;           ///< base colour alone, without light
    int32_t own_lobe;        ///< halflit_settings.override_lobe does not replace this material's lobe
    int32_t shadow_catcher;  ///< invisible but for the shadows on it, which are black with the hidden share as alpha
    halflit_lobe lobe;       ///< of diffuse light
    // Made by apps/c/tables.py of shading/material_properties.def.
    /// linear, in [0, 1]; the fourth number is alpha (1, 1, 1, 1)
    float base_color[4];
    /// in [0, 1] (1)
    float metallic;
    /// in [0, 1] (1)
    float roughness;
    /// F0 of dielectrics: reflectance at normal incidence where not metallic, in [0, 1] (0.04)
    float dielectric_reflectance;
    /// light of its own, linear, from 0 (0, 0, 0)
    float emissive[3];
    /// factor on x and y of the normal texture (1)
    float normal_scale;
    /// in [0, 1]; 0 ignores the occlusion texture; ambient light alone is occluded (1)
    float occlusion_strength;
    /// from 0; where the alpha mode is mask: drawn where alpha is at least this (0.5)
    float alpha_cutoff;
    /// weight of the specular reflection of dielectrics, in [0, 1] (1)
    float specular;
    /// factor on F0 of dielectrics, linear, from 0; F0 is at most 1 (1, 1, 1)
    float specular_color[3];
    /// share of light from behind that passes through, in [0, 1]; the rest is diffuse (0)
    float transmission;
    /// path length of that light inside, world units, from 0 (0)
    float thickness;
    /// path length after which white light has attenuation_color, world units; 0: no absorption (0)
    float attenuation_distance;
    /// linear, in [0, 1] (1, 1, 1)
    float attenuation_color[3];
    /// share of the surface that is coated, in [0, 1] (0)
    float clearcoat;
    /// in [0, 1] (0)
    float clearcoat_roughness;
    /// factor on x and y of the coat's normal texture (1)
    float clearcoat_normal_scale;
    /// of fibres above the surface, linear, in [0, 1]; black: none (0, 0, 0)
    float sheen_color[3];
    /// in [0, 1]; rougher fibres glow less at grazing views and more elsewhere (0)
    float sheen_roughness;
    /// share of the surface that the film covers, in [0, 1] (0)
    float iridescence;
    /// index of refraction of the film, from 1 (1.3)
    float iridescence_ior;
    /// of the film where its texture is 0, nanometres, from 0 (100)
    float iridescence_thickness_min_nm;
    /// of the film where its texture is 1, or without a texture (400)
    float iridescence_thickness_max_nm;
    /// in [0, 1]: alpha along the direction is roughness^2 + (1 - roughness^2) strength^2 (0)
    float anisotropy_strength;
    /// of the direction from the tangent, counter-clockwise, radians (0)
    float anisotropy_rotation_rad;
    /// sRGB, alpha linear
    halflit_texture_use base_color_texture;
    /// linear: green is roughness, blue metallic
    halflit_texture_use metallic_roughness_texture;
    /// linear, in tangent space: (2c - 1) * (normal_scale, normal_scale, 1)
    halflit_texture_use normal_texture;
    /// linear: red
    halflit_texture_use occlusion_texture;
    /// sRGB
    halflit_texture_use emissive_texture;
    /// linear: alpha
    halflit_texture_use specular_texture;
    /// sRGB
    halflit_texture_use specular_color_texture;
    /// linear: red
    halflit_texture_use transmission_texture;
    /// linear: green
    halflit_texture_use thickness_texture;
    /// linear: red
    halflit_texture_use clearcoat_texture;
    /// linear: green
    halflit_texture_use clearcoat_roughness_texture;
    /// linear, in tangent space; without it the coat has the mesh's normals, not the base's normal map
    halflit_texture_use clearcoat_normal_texture;
    /// sRGB
    halflit_texture_use sheen_color_texture;
    /// linear: alpha
    halflit_texture_use sheen_roughness_texture;
    /// linear: red
    halflit_texture_use iridescence_texture;
    /// linear: green, from the least thickness to the greatest
    halflit_texture_use iridescence_thickness_texture;
    /// linear: red and green (2c - 1) turn the direction in tangent space, blue is the strength
    halflit_texture_use anisotropy_texture;
    /// spread of the indices of refraction of red and blue, from 0: 20 / Abbe's number (0)
    float dispersion;
    /// share of scattered light that leaves on the far side, in [0, 1] (0)
    float diffuse_transmission;
    /// of that light, in place of the base colour, linear, in [0, 1] (1, 1, 1)
    float diffuse_transmission_color[3];
    /// linear: alpha
    halflit_texture_use diffuse_transmission_texture;
    /// sRGB
    halflit_texture_use diffuse_transmission_color_texture;
    /// 0
    int32_t reserved[2];
} halflit_material;
HALFLIT_C_API int32_t halflit_material_init(halflit_material* material, size_t size);

/// Adds a material, whose textures must be in the scene. index may be null.
HALFLIT_C_API int32_t halflit_scene_add_material(halflit_scene* scene, const halflit_material* material, int32_t* index);
/// Reads a material. Set material->size before.
HALFLIT_C_API int32_t halflit_scene_get_material(const halflit_scene* scene, int32_t index, halflit_material* material);
/// Replaces a material, in all meshes and instances that have it.
HALFLIT_C_API int32_t halflit_scene_set_material(halflit_scene* scene, int32_t index, const halflit_material* material);

// ---- meshes ------------------------------------------------------------------------------------------------------------

/// Primitives of a mesh. Lines and points are quads that face the screen; they receive shadows and cast none.
enum { HALFLIT_TOPOLOGY_TRIANGLES = 0, HALFLIT_TOPOLOGY_LINES = 1, HALFLIT_TOPOLOGY_POINTS = 2 };

/// How a Gaussian becomes pixels (docs/formats.md): as trained by Kerbl and others, the same antialiased, KHR_gaussian_splatting,
/// Mip-Splatting.
enum { HALFLIT_SPLATS_INRIA = 0, HALFLIT_SPLATS_INRIA_AA = 1, HALFLIT_SPLATS_KHR = 2, HALFLIT_SPLATS_MIP = 3 };

/// 3D Gaussians around the positions of a mesh: each array has its vertex_count elements. They need no light and cast no shadow; those
/// with a number that is not finite are left out. Views are fitted to those of an opacity above 0.1, without the outermost hundredth on
/// each side. Defaults in parentheses.
typedef struct halflit_splats {
    size_t size;
    const float* rotations;  ///< 4 floats each: quaternions x, y, z, w, of any length; 0 0 0 0: none
    const float* scales;     ///< 3 floats each: standard deviations along the three axes, object units, from 0
    const float* opacities;  ///< 0 to 1
    const float* harmonics;  ///< (degree + 1)^2 times 3 floats each: coefficients of red, green and blue; colour = 0.5 + sum, not below 0
    int32_t degree;          ///< of the spherical harmonics, 0 to 4 (0)
    int32_t reference;       ///< HALFLIT_SPLATS (inria)
    int32_t linear_light;    ///< colours are linear light; 0: sRGB codes / 255 (0)
    int32_t reserved;
} halflit_splats;
HALFLIT_C_API int32_t halflit_splats_init(halflit_splats* splats, size_t size);

/// Triangles, lines or points. Counter-clockwise triangles are front faces. Lines and points without normals should have an unlit material.
/// Arrays but positions may be null; all have vertex_count elements.
typedef struct halflit_mesh {
    size_t size;
    const char* name;         ///< may be null
    const float* positions;   ///< 3 floats each
    const float* normals;     ///< 3 floats each, of any length above 0; null: each triangle is flat, or see `smooth`
    const float* tangents;    ///< 4 floats each: direction, and +1 or -1; null: made where the material has a normal texture
    const float* uv0;         ///< 2 floats each; v points down: v = 0 is the first row of a texture
    const float* uv1;         ///< 2 floats each
    const float* colors;      ///< 4 floats each: linear, with alpha
    const uint32_t* indices;  ///< 3 for each triangle, 2 for each line, 1 for each point; null: 0 1 2 3 and so on
    size_t vertex_count;      ///< elements of each array
    size_t index_count;       ///< elements of indices; 0 without
    int32_t material;         ///< index; -1: the default material, white, rough and metallic as glTF has it (-1)
    int32_t topology;         ///< HALFLIT_TOPOLOGY (triangles)
    int32_t smooth;           ///< without normals: those of the smooth surface through the positions, by the areas of the triangles (0)
    int32_t reserved;
    const halflit_splats* splats;  ///< Gaussians around the positions, for points without other arrays; may be null
} halflit_mesh;
HALFLIT_C_API int32_t halflit_mesh_init(halflit_mesh* mesh, size_t size);

/// Adds a mesh, whose material must be in the scene. It is not drawn without an instance. index may be null.
HALFLIT_C_API int32_t halflit_scene_add_mesh(halflit_scene* scene, const halflit_mesh* mesh, int32_t* index);
/// Replaces a mesh, in all its instances; counts and material may differ.
HALFLIT_C_API int32_t halflit_scene_set_mesh(halflit_scene* scene, int32_t index, const halflit_mesh* mesh);
/// Moves a mesh's vertices: 3 floats for each. vertex_count is that with which the mesh was added. normals may be null: the mesh keeps
/// those that it was given; without any it is flat or smooth again. For meshes that the caller added; one of a file, or of Gaussians,
/// is refused (2, usage).
HALFLIT_C_API int32_t halflit_scene_set_vertices(halflit_scene* scene, int32_t index, const float* positions, const float* normals,
                                                 size_t vertex_count);
/// Removes a mesh that no instance places; halflit_scene_add_mesh may use its index again.
HALFLIT_C_API int32_t halflit_scene_remove_mesh(halflit_scene* scene, int32_t index);

// ---- instances ---------------------------------------------------------------------------------------------------------

/// A mesh placed in the world. Defaults in parentheses.
typedef struct halflit_instance {
    size_t size;
    int32_t mesh;                 ///< index
    int32_t material;             ///< index, in place of the mesh's; -1: the mesh's (-1)
    int32_t visible;              ///< 0: it is not drawn, casts no shadow, and views do not look at it (1)
    int32_t node;                 ///< of the file; -1: none. Is not set
    float color[4];               ///< linear, times the material's base colour; alpha counts where that masks or blends (1, 1, 1, 1)
    float world_from_object[16];  ///< (the identity)
    double place_rest[3];         ///< added to the place in world_from_object, where float32 is too coarse (0, 0, 0)
} halflit_instance;
HALFLIT_C_API int32_t halflit_instance_init(halflit_instance* instance, size_t size);

/// Places a mesh in the world. world_from_object may be null: the identity. index may be null. As all functions that take such a matrix, it
/// fails (usage) for one that is not finite, or whose last row is not 0 0 0 1.
HALFLIT_C_API int32_t halflit_scene_add_instance(halflit_scene* scene, int32_t mesh, const float world_from_object[16], int32_t* index);
/// Places a mesh `count` times, by 16 floats each. The indices follow each other; first may be null.
HALFLIT_C_API int32_t halflit_scene_add_instances(halflit_scene* scene, int32_t mesh, int32_t count, const float* world_from_object,
                                                  int32_t* first);
/// The same by doubles, for scenes that are far from the origin.
HALFLIT_C_API int32_t halflit_scene_add_instances_double(halflit_scene* scene, int32_t mesh, int32_t count, const double* world_from_object,
                                                         int32_t* first);
/// Reads an instance. Set instance->size before.
HALFLIT_C_API int32_t halflit_scene_get_instance(const halflit_scene* scene, int32_t index, halflit_instance* instance);
/// Replaces an instance. The next frame recomputes what depends on it alone.
HALFLIT_C_API int32_t halflit_scene_set_instance(halflit_scene* scene, int32_t index, const halflit_instance* instance);
/// Moves an instance. The next frame recomputes what depends on it alone; adding a mesh, an instance or a material prepares all anew.
HALFLIT_C_API int32_t halflit_scene_place_instance(halflit_scene* scene, int32_t index, const float world_from_object[16]);
/// Moves `count` instances by 16 floats each. indices may be null: 0, 1, 2 and so on. After an error none has moved.
HALFLIT_C_API int32_t halflit_scene_place_instances(halflit_scene* scene, const int32_t* indices, int32_t count,
                                                    const float* world_from_object);
/// The same by doubles, for scenes that are far from the origin.
HALFLIT_C_API int32_t halflit_scene_place_instances_double(halflit_scene* scene, const int32_t* indices, int32_t count,
                                                           const double* world_from_object);
/// Removes an instance; halflit_scene_add_instance may use its index again.
HALFLIT_C_API int32_t halflit_scene_remove_instance(halflit_scene* scene, int32_t index);
/// Adds a ground that is invisible but for the shadows on it: a horizontal square below the lowest point of all that is drawn. Views are
/// framed as without it. instance: its index, may be null.
HALFLIT_C_API int32_t halflit_scene_add_ground(halflit_scene* scene, int32_t* instance);

// ---- cameras -----------------------------------------------------------------------------------------------------------

/// A camera is at the origin of its own space and looks along -z, with +x to the right and +y up.
typedef struct halflit_camera {
    size_t size;
    const char* name;             ///< from halflit_scene_get_camera, valid as long as the scene; otherwise not read
    float world_from_camera[16];  ///< rigid: rotation and translation
    // Made by apps/c/tables.py of raster/camera_members.def.
    /// parallel rays; otherwise perspective (0)
    int32_t orthographic;
    /// perspective: full vertical angle, in (0, pi) (pi / 4)
    float fov_y_rad;
    /// perspective: width / height that the view is made for; 0: that of the picture (0)
    float aspect;
    /// orthographic: half the height of the view, world units (1)
    float half_height;
    /// orthographic: half its width; 0: from the picture's aspect (0)
    float half_width;
    /// distance along -z, world units, from which on things are drawn; perspective: 0: chosen by the scene (0)
    float near_z;
    /// distance up to which they are drawn; one that is not above near_z: no limit (0)
    float far_z;
    /// left, right, bottom, top: tangents of the angles from the axis, or (orthographic) distances from it, in place of fov_y_rad,
    /// aspect, half_height and half_width, whatever the picture's aspect; all 0: none (0, 0, 0, 0)
    float sides[4];
    /// 0
    int32_t reserved;
    /// added to the place in world_from_camera, where float32 is too coarse (0, 0, 0)
    double place_rest[3];
} halflit_camera;
HALFLIT_C_API int32_t halflit_camera_init(halflit_camera* camera, size_t size);

/// Places the camera at `eye`, looking at `target`, with `up` upwards in the picture. up may be null: +y. The lens stays.
HALFLIT_C_API int32_t halflit_camera_look_at(const float eye[3], const float target[3], const float up[3], halflit_camera* camera);
/// A camera of computer vision, which looks along +z with y down, in place of `camera`'s matrix and lens. k: fx, 0, cx, 0, fy, cy, 0, 0, 1
/// in pixels of a picture of width x height. A point X of the world is at rotation X + translation; rotation is row by row. first_pixel:
/// the coordinate of the middle of the first pixel: 0 for OpenCV, 0.5 for COLMAP. Fails (usage) for a matrix that is no lens or no
/// rotation.
HALFLIT_C_API int32_t halflit_camera_from_intrinsics(const double k[9], int32_t width, int32_t height, const double rotation[9],
                                                     const double translation[3], double first_pixel, halflit_camera* camera);
/// A view of the whole scene. aspect: width / height of the picture. azimuth_deg: around the vertical, 0 from the front, which is +z with y
/// up and -y with z up, positive from the right.
/// elevation_deg: above the horizon, -90 to 90. zoom: 2 makes things twice as large. 35, 20 and 1 give the usual three-quarter view.
HALFLIT_C_API int32_t halflit_camera_frame(const halflit_scene* scene, float aspect, float azimuth_deg, float elevation_deg, float zoom,
                                           halflit_camera* camera);

/// A side that the whole scene is seen from. Defaults in parentheses.
typedef struct halflit_view {
    size_t size;
    double margin_x, margin_y;  ///< shares of half the picture's width and height that stay free at each side, 0 to 0.9 (0.13)
    float azimuth_deg;          ///< around the vertical: 0 from the front (+z with y up, -y with z up), positive from the right (35)
    float elevation_deg;        ///< above the horizon, -90 to 90 (20)
    float zoom;                 ///< 2 makes things twice as large (1)
    float fov_y_deg;            ///< perspective: full vertical angle before the zoom (35)
    int32_t orthographic;       ///< parallel rays (0)
    int32_t any_side;           ///< one distance and one scale for all sides, with the middle of the scene's box in the middle; else as
                                ///< near as the side allows (0)
} halflit_view;
HALFLIT_C_API int32_t halflit_view_init(halflit_view* view, size_t size);
/// Sets the angles of a view by its name: front, back, left, right, top, bottom or iso, of the model's own front. The rest stays.
HALFLIT_C_API int32_t halflit_view_by_name(const halflit_scene* scene, const char* name, halflit_view* view);
/// A view of the whole scene. aspect: width / height of the picture.
HALFLIT_C_API int32_t halflit_camera_view(const halflit_scene* scene, float aspect, const halflit_view* view, halflit_camera* camera);
/// `count` views that can be compared: all have the middle of the scene's box in the middle of the picture, and one distance and scale, the
/// least that shows the scene whole in each. views, cameras: arrays of `count` structs whose sizes are set, those of an array to the same
/// size. count: 1 to 65536.
HALFLIT_C_API int32_t halflit_camera_views(const halflit_scene* scene, float aspect, const halflit_view* views, int32_t count,
                                           halflit_camera* cameras);
/// Places the camera at a distance from `target`, which it looks at, by angles as those of halflit_view. up: HALFLIT_UP, the world's
/// vertical axis. From straight above or below, the picture's up is that of nearby elevations. The lens stays.
HALFLIT_C_API int32_t halflit_camera_orbit(const double target[3], double azimuth_deg, double elevation_deg, double distance, int32_t up,
                                           halflit_camera* camera);
/// A camera of the scene.
HALFLIT_C_API int32_t halflit_scene_get_camera(const halflit_scene* scene, int32_t index, halflit_camera* camera);

// ---- lights and environments -------------------------------------------------------------------------------------------

/// Shapes of a source's light: parallel, from infinitely far; in all directions from a point; a point's light inside a cone.
enum { HALFLIT_LIGHT_DIRECTIONAL = 0, HALFLIT_LIGHT_POINT = 1, HALFLIT_LIGHT_SPOT = 2 };

/// A light. A directional light of colour 1 makes a white surface that faces it exactly white; other lights do so at distance 1. Defaults:
/// white, directional, straight down.
typedef struct halflit_light {
    size_t size;
    int32_t type;  ///< HALFLIT_LIGHT
    // Made by apps/c/tables.py of shading/light_members.def.
    /// directional: irradiance / pi; point, spot: the same at distance 1 (1, 1, 1)
    float color[3];
    /// point, spot: world space (0, 0, 0)
    float position[3];
    /// directional, spot: the way the light travels, of any length above 0 (0, -1, 0)
    float direction[3];
    /// point, spot: no light beyond this distance, world units; 0: no limit (0)
    float range;
    /// point, spot: smaller distances count as this, world units; 0: 1e-4 (0)
    float source_radius;
    /// spot: full light up to this angle from the axis (0)
    float inner_cone_rad;
    /// spot: no light from this angle on (pi / 4)
    float outer_cone_rad;
    /// spot: factor cos(angle from the axis)^cone_power, 0 to 1e5 (0)
    float cone_power;
    /// Size of the source, which makes its shadows soft and changes nothing else. Directional: the angle from its middle to its
    /// rim, radians, up to 0.7 (the sun's is 0.00465). Point, spot: radius of a ball, world units. 0: a point, with sharp shadows.
    /// (0)
    float shadow_radius;
    /// added to position, where float32 is too coarse (0, 0, 0)
    double position_rest[3];
} halflit_light;
HALFLIT_C_API int32_t halflit_light_init(halflit_light* light, size_t size);

/// Adds a light. index may be null.
HALFLIT_C_API int32_t halflit_scene_add_light(halflit_scene* scene, const halflit_light* light, int32_t* index);
/// Reads a light. Set light->size before.
HALFLIT_C_API int32_t halflit_scene_get_light(const halflit_scene* scene, int32_t index, halflit_light* light);
/// Replaces a light.
HALFLIT_C_API int32_t halflit_scene_set_light(halflit_scene* scene, int32_t index, const halflit_light* light);
/// Removes a light; halflit_scene_add_light may use its index again.
HALFLIT_C_API int32_t halflit_scene_remove_light(halflit_scene* scene, int32_t index);
/// Sets the light from all around: sky from above, ground from below. An environment replaces it.
HALFLIT_C_API int32_t halflit_scene_set_ambient(halflit_scene* scene, const float sky[3], const float ground[3]);
/// If the scene has no light of any kind, adds a key light over the viewer's left shoulder, and ambient light.
HALFLIT_C_API int32_t halflit_scene_add_default_lights(halflit_scene* scene, const halflit_camera* camera);
/// If the scene has no light of any kind, puts it into the built-in studio: an environment of soft boxes, turned with the camera about the
/// vertical, and a key light over the viewer's left shoulder. halflit_choose_picture does so without changing the scene.
HALFLIT_C_API int32_t halflit_scene_add_studio(halflit_scene* scene, const halflit_camera* camera);
/// Removes the lights, the ambient light and the environment.
HALFLIT_C_API int32_t halflit_scene_clear_lights(halflit_scene* scene);

/// Decisions about an environment that are made once, when it is set.
typedef struct halflit_environment_options {
    size_t size;
    double rotate_rad;     ///< about the vertical, counter-clockwise seen from above
    int32_t extract_suns;  ///< make directional lights of suns where that is more exact; default 1
    int32_t keep_image;    ///< for halflit_settings.background_environment and HALFLIT_ACCURACY_REFERENCE; default 1
    int32_t calibrated;    ///< for halflit_scene_set_environment: made for exposure 1; default 0: the unit is not known
    int32_t reserved;
} halflit_environment_options;
HALFLIT_C_API int32_t halflit_environment_options_init(halflit_environment_options* options, size_t size);

/// Lights the scene by an image of the light from all directions, in the place of ambient light and of an earlier environment: three floats
/// a pixel (linear red, green, blue), finite and not negative. Row 0 is straight up, the middle column is along -z with y up (+y with z
/// up), the column at three quarters of the width along +x. options may be null: the defaults. Takes about 0.2 s for 1024 x 512 pixels.
HALFLIT_C_API int32_t halflit_scene_set_environment(halflit_scene* scene, const float* rgb, int32_t width, int32_t height,
                                                    const halflit_environment_options* options);
/// The same from a file (.hdr, .pfm or .exr).
HALFLIT_C_API int32_t halflit_scene_load_environment(halflit_scene* scene, const char* path, const halflit_environment_options* options);
/// The same by a built-in clear day.
HALFLIT_C_API int32_t halflit_scene_set_sky(halflit_scene* scene, const halflit_environment_options* options);

// ---- settings of a picture ---------------------------------------------------------------------------------------------

/// Arithmetic of shading: float64 and slow; float32.
enum { HALFLIT_ACCURACY_REFERENCE = 0, HALFLIT_ACCURACY_EXACT = 1 };
/// How often light is evaluated: once a triangle, a vertex or a pixel.
enum { HALFLIT_RATE_FLAT = 0, HALFLIT_RATE_GOURAUD = 1, HALFLIT_RATE_PIXEL = 2 };
/// Upper limits of the texture filters: the sampler's own; one mip level; one texel of it.
enum { HALFLIT_DETAIL_FULL = 0, HALFLIT_DETAIL_BILINEAR = 1, HALFLIT_DETAIL_NEAREST = 2 };
/// Shapes of highlights: none; by the mirrored light; by the half vector.
enum { HALFLIT_SPECULAR_NONE = 0, HALFLIT_SPECULAR_PHONG = 1, HALFLIT_SPECULAR_BLINN = 2, HALFLIT_SPECULAR_GGX = 3 };
/// Effects of a shadow on light past the terminator: none; a step; a soft end.
enum { HALFLIT_SHADOWS_OFF = 0, HALFLIT_SHADOWS_HARD = 1, HALFLIT_SHADOWS_SOFT_SPLIT = 2 };

/// Tone curves: light above 1 is cut off; light over 1 + its luminance; film-like contrast; Khronos PBR Neutral.
enum { HALFLIT_TONE_NONE = 0, HALFLIT_TONE_REINHARD = 1, HALFLIT_TONE_ACES = 2, HALFLIT_TONE_NEUTRAL = 3 };
/// Edges that are drawn as lines. FEATURE: where a surface ends, where it bends by more than edge_angle_deg, and outlines. SILHOUETTE:
/// where a surface ends, and outlines. ALL: of every triangle.
enum { HALFLIT_EDGES_NONE = 0, HALFLIT_EDGES_FEATURE = 1, HALFLIT_EDGES_SILHOUETTE = 2, HALFLIT_EDGES_ALL = 3 };
enum { HALFLIT_ALPHA_SPACE_LINEAR = 0, HALFLIT_ALPHA_SPACE_DISPLAY = 1 };
enum { HALFLIT_HIDDEN_EDGES_NONE = 0, HALFLIT_HIDDEN_EDGES_DASHED = 1 };
/// Surfaces that eye-dome lighting shades: none; points of meshes without normals; all.
enum { HALFLIT_EDL_OFF = 0, HALFLIT_EDL_AUTO = 1, HALFLIT_EDL_ON = 2 };

/// A part of a picture, in pixels; width 0: all of it.
typedef struct halflit_region {
    int32_t x, y;           ///< its upper left corner, from that of the picture
    int32_t width, height;  ///< it must lie inside the picture
} halflit_region;

/// Everything besides scene, camera and size that decides a pixel. Defaults in parentheses.
typedef struct halflit_settings {
    size_t size;
    // Made by apps/c/tables.py of raster/settings_table.def: eight bytes each.
    /// largest difference from the exact picture in 8-bit codes: the cheapest way that is proven to keep it, for light once a
    /// pixel, full texture filters and exact arithmetic alone; 0: none (0)
    double max_error_codes;
    /// of bands that are left out, relative to white, in linear light; half an 8-bit code (1/510)
    double environment_tolerance;
    /// bytes; the largest shadow maps are halved until all fit (256 MiB)
    uint64_t shadow_memory_limit;
    halflit_region region;           ///< the part to draw; pixels outside are not touched (all)
    float background[4];             ///< alpha 0 is transparent, not premultiplied (0, 0, 0, 0)
    int32_t background_environment;  ///< show the environment behind the scene (0)
    int32_t override_lobe;           ///< `lobe` replaces the lobe of materials without own_lobe (0)
    halflit_lobe lobe;               ///< (Lambert)
    // Made by apps/c/tables.py of raster/settings_table.def: four bytes each.
    /// per pixel: 1, 4, 8 or 16 (1)
    int32_t samples;
    /// factor on all light, above 0 (1)
    float exposure;
    /// HALFLIT_TONE: from light to codes, for each sample, after exposure; pictures of floats and the background colour do without
    /// (none)
    int32_t tone_curve;
    /// Size of points, pixels, 1/16 to 256; rounded to 1/256. From 3 on they are round, below that square. 0: the sizes that close
    /// the surface that they lie on, by their distances in the picture: 2 at least, a 25th of the picture's shorter side at most.
    /// (2)
    float point_size;
    /// width of lines, likewise (1.5)
    float line_width;
    /// HALFLIT_ACCURACY: arithmetic; exact if there is an error budget (exact)
    int32_t accuracy;
    /// HALFLIT_DETAIL: upper limit of the texture filters (full)
    int32_t texture_detail;
    /// largest ratio of a footprint's length to its width that is filtered along its length, 1 to 16; 1: footprints count as
    /// squares; for textures that are linear within and between levels (1)
    int32_t anisotropy;
    /// HALFLIT_SPECULAR: model of highlights; none: albedo is the base colour itself (blinn)
    int32_t specular;
    /// sharper highlights are brighter, for the same light in all; off: a peak of 1 for every exponent; ggx always is (1)
    int32_t normalize_specular;
    /// factor on x and y of all normal maps, a coat's too; 0: surfaces have the normals of their meshes (1)
    float normal_scale;
    /// HALFLIT_RATE: how often light is evaluated (pixel)
    int32_t shading_rate;
    /// of spherical harmonics, 1 to 10; 0: the fewest whose error is within environment_tolerance (0)
    int32_t environment_bands;
    /// HALFLIT_SHADOWS: effect of shadows on wrapped light; off: no shadow maps are drawn (soft-split)
    int32_t shadows;
    /// Texels on a side of a shadow map, a multiple of 64 from 64 to 4096; a cube's faces have half. 0: three for two pixels of
    /// what is seen, from 256 to twice the picture's longer side, at most 2048. (0)
    int32_t shadow_size;
    /// points of a light that has a shadow_radius, each with maps of half that side: 4 to 64 (16)
    int32_t soft_shadow_maps;
    /// soft-split: distance to the blocker from which on wrapped light is 0, world units; 0: from object size and wrap (0)
    float shadow_fade;
    /// Number of directions in which ambient light and the environment cast shadows, by shadow maps of 256 texels: 16 to 1024. 1
    /// (auto): by a grid of at most 28 points on a side, which costs little; 2/5 of the light that is lost comes back from other
    /// surfaces. 0, or without shadows: they cast none. (0)
    int32_t sky_shadows;
    /// look-ups on the smooth surface given by the vertex normals, for coarse meshes (0)
    int32_t shadow_terminator_offset;
    /// factor on the light that all surfaces emit (not on colours of unlit materials) (1)
    float emission_scale;
    /// HALFLIT_EDGES: Lines along the edges of all that is drawn but shadow catchers, over the finished picture. Surfaces of
    /// triangles hide them, glass does not. A line that touches a surface is in front of it. Vertices at one position count as one,
    /// because files split vertices. (none)
    int32_t edges;
    /// HALFLIT_HIDDEN_EDGES: edges behind surfaces (none)
    int32_t hidden_edges;
    /// between the normals of two triangles, from which on their edge is a line: 0 to 180 (30)
    float edge_angle_deg;
    /// of the lines, pixels, 1/4 to 64; below 1 they are paler instead (1.5)
    float edge_width;
    /// of the lines, linear light, 0 to 1; no light, exposure or tone curve changes it (0, 0, 0)
    float edge_color[3];
    /// transparent surfaces on each pixel, in the mean over all pixels of the picture (as of 2^18 if it has fewer), 1 to 2^20; more
    /// end the call with a limit's error: a small file can ask for millions. 0: no limit (128)
    int32_t max_layers;
    /// Opacity of the soft shadow below a model that stands, over the background, where all light from above is hidden: 0 to 1.
    /// There is none in a scene with a shadow catcher, without shadows, by parallel rays, and seen from below. 0: none. (0)
    float contact_shadow;
    /// HALFLIT_ALPHA_SPACE: of codes on transparent backgrounds; floats have the share of light (linear)
    int32_t alpha;
    /// Angle from the middle of a directional light without a shadow_radius to its edge, as the penumbras of its shadows show it,
    /// by a wider filter in one map: cheap, and an approximation. Penumbras are at most 24 texels wide. Degrees, 0 to 10; 0: all
    /// edges are sharp. (0)
    float shadow_softness_deg;
    /// HALFLIT_EDL: Shading by the depths of the picture: a surface is darker where its neighbours are nearer to the viewer.
    /// Transparent surfaces count as not there. (off)
    int32_t edl;
    /// of that shading, 0 to 16 (1)
    float edl_strength;
    /// black lines on surfaces of dark materials are light grey instead (0)
    int32_t edge_contrast;
    /// 0
    int32_t reserved[1];
} halflit_settings;
HALFLIT_C_API int32_t halflit_settings_init(halflit_settings* settings, size_t size);
/// Sets the member of that name to a value as the program takes it: a number, a word such as "auto" or "aces", "on" or "off". The message
/// of a wrong value is the program's.
HALFLIT_C_API int32_t halflit_settings_read(halflit_settings* settings, const char* name, const char* value);

// ---- what a picture shows ----------------------------------------------------------------------------------------------

/// Light of a picture: the scene's, and what it lacks. It is chosen for the scene as it is: lights that are set or posed later are drawn as
/// they are then; after lights were added or removed, choose anew.
typedef struct halflit_lighting halflit_lighting;

/// When the built-in studio lights a picture. FOR_DARK: if the scene has neither ambient light nor an environment. ALWAYS: in place of
/// both. NEVER. UNDER_LIGHTS: as FOR_DARK, and a share of the studio where the scene has lights of a known unit.
enum { HALFLIT_STUDIO_FOR_DARK = 0, HALFLIT_STUDIO_ALWAYS = 1, HALFLIT_STUDIO_NEVER = 2, HALFLIT_STUDIO_UNDER_LIGHTS = 3 };

/// Decisions of the caller of halflit_choose_picture(); the rest is chosen. Defaults in parentheses.
typedef struct halflit_picture_request {
    size_t size;
    const halflit_camera* camera;     ///< the view; null: see scene_camera (null)
    const char* scene_camera;         ///< the view: a camera of the scene, by its name, or else its index; null: the first, if it shows the
                                      ///< scene well, or else a view of the whole scene (null)
    double studio_turn_rad;           ///< turns the studio about the vertical, counter-clockwise seen from above (0)
    int32_t width, height;            ///< pixels; 0, 0: 1280 x 720, reduced to the shape of the camera (0, 0)
    int32_t frame;                    ///< without a camera: a view of the whole scene, whatever cameras the scene has (0)
    float azimuth_deg;                ///< of a view of the whole scene, as elevation_deg and zoom: see halflit_camera_frame (35)
    float elevation_deg;              ///< above the horizon, -90 to 90 (20)
    float zoom;                       ///< 2 makes things twice as large (1)
    float fov_y_deg;                  ///< of a view of the whole scene: full vertical angle before the zoom (35)
    int32_t orthographic;             ///< of a view of the whole scene: parallel rays (0)
    int32_t own_ambient;              ///< ambient_color is the light from all around (0)
    float ambient_color[3];           ///< the same from above and below
    float exposure;                   ///< factor on all light; 0: chosen (0)
    int32_t add_lights;               ///< a scene without any light gets some (1)
    int32_t studio;                   ///< HALFLIT_STUDIO (for dark)
    int32_t any_side;                 ///< of a view of the whole scene, as the margins: see halflit_view (0)
    double margin_x, margin_y;        ///< shares of half the picture that stay free, 0 to 0.9 (0.13)
    double exposure_compensation_ev;  ///< stops brighter than the exposure, given or chosen, -64 to 64 (0)
} halflit_picture_request;
HALFLIT_C_API int32_t halflit_picture_request_init(halflit_picture_request* request, size_t size);

/// Chooses what a good picture requires, as the program does: its size, the scene's camera or a view of the whole scene, light, exposure, a
/// grey background, and settings: samples, tone curve, anisotropy, shadows of ambient light, contact shadow, size of points. Nothing in the
/// scene changes. request may be null: the defaults. size: width and height, may be null. lighting may be null; free it by
/// halflit_lighting_destroy.
HALFLIT_C_API int32_t halflit_choose_picture(const halflit_scene* scene, const halflit_picture_request* request, int32_t size[2],
                                             halflit_camera* camera, halflit_settings* settings, halflit_lighting** lighting);
/// Frees light. Null is allowed.
HALFLIT_C_API void halflit_lighting_destroy(halflit_lighting* lighting);

// ---- drawing -----------------------------------------------------------------------------------------------------------

/// How frames are computed. Nothing here changes a pixel. The functions may be null. They are called with `user`, from any thread of a
/// frame, by several at once. They must return, and must not draw or destroy the scene.
typedef struct halflit_execution {
    size_t size;
    const char* isa;                   ///< instruction set: scalar, sse2, sse4.1, avx2, avx512, neon64 or wasm128; null: the best one
    void* user;                        ///< handed to the functions below
    int32_t (*cancelled)(void* user);  ///< asked before each part of the work; not 0: stop
    /// Told after each tile which pixels are final.
    void (*on_tile)(void* user, int32_t x, int32_t y, int32_t width, int32_t height);
    void (*progress)(void* user, double share);  ///< called with the share that is done, in (0, 1], one call at a time
    /// The host's own threads: calls body(task, i) for every i from 0 to count - 1, in any order, on any threads; returns when all are
    /// done.
    void (*parallel_for)(void* user, int32_t count, void (*body)(void* task, int32_t i), void* task);
    int32_t threads;      ///< 0: one for each core; not used with parallel_for
    int32_t tile_size;    ///< 16, 32 or 64 pixels
    double time_limit_s;  ///< wall clock for a frame, seconds; 0: no limit. Beyond it the frame fails with HALFLIT_ERROR_LIMIT
    size_t memory_limit;  ///< working memory for a frame, bytes; 0: no limit. Beyond it the frame fails with HALFLIT_ERROR_LIMIT
    /// SIGINT, as Ctrl-C sends it, stops the frame with HALFLIT_ERROR_CANCELLED, after the process's own handler has run (0). During the
    /// frame the library's handler is in place and calls that one. A process without a handler goes on, and
    /// one that ignores the signal does not stop the frame.
    int32_t stop_at_interrupt;
    int32_t reserved;
} halflit_execution;
HALFLIT_C_API int32_t halflit_execution_init(halflit_execution* execution, size_t size);

/// Draws frames. Keeps memory and results from frame to frame: a frame of the same scene computes what changed.
typedef struct halflit_renderer halflit_renderer;

/// execution may be null: the defaults.
HALFLIT_C_API int32_t halflit_renderer_create(const halflit_execution* execution, halflit_renderer** renderer);
/// Replaces the way in which the next frames are computed. execution may be null: the defaults.
HALFLIT_C_API int32_t halflit_renderer_set_execution(halflit_renderer* renderer, const halflit_execution* execution);
/// Frees a renderer. Null is allowed.
HALFLIT_C_API void halflit_renderer_destroy(halflit_renderer* renderer);

/// Formats of a pixel. RGBA8 and BGRA8: four bytes in this order, sRGB codes, linear alpha. RGBA_F32: four floats, linear light after
/// exposure, without a tone curve. Premultiplied: colours are multiplied by alpha.
enum {
    HALFLIT_FORMAT_RGBA8 = 0,
    HALFLIT_FORMAT_BGRA8 = 1,
    HALFLIT_FORMAT_RGBA8_PREMULTIPLIED = 2,
    HALFLIT_FORMAT_BGRA8_PREMULTIPLIED = 3,
    HALFLIT_FORMAT_RGBA_F32 = 4,
    HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED = 5
};

/// The caller's memory for a picture. Row 0 is the top row; row y begins y * row_bytes after the pointer. row_bytes 0: rows without gaps.
/// Bytes between rows are not touched. A null plane is not drawn; planes show what each pixel's first sample sees. All but 8-bit pixels are
/// aligned to 4 bytes, rows too. The first sample lies beside the pixel's middle where a pixel has several.
typedef struct halflit_target {
    size_t size;
    int32_t width, height;    ///< pixels, of the whole picture: what the camera sees
    int32_t format;           ///< HALFLIT_FORMAT, of `pixels`
    int32_t region_alone;     ///< the memory holds halflit_settings.region alone, not the whole picture
    void* pixels;             ///< null: no colours are drawn
    size_t row_bytes;         ///< stride of `pixels`
    float* depth;             ///< distance along the view axis, world units; infinity where nothing is
    size_t depth_row_bytes;   ///< stride
    float* normal;            ///< 3 floats a pixel: unit normal of the vertices, world space; turned on double-sided backs; 0: nothing
    size_t normal_row_bytes;  ///< stride
    float* shading_normal;    ///< 3 floats a pixel: unit normal with the normal map, world space; 0 where nothing is, as in all that follow
    size_t shading_normal_row_bytes;  ///< stride
    float* albedo;                    ///< 3 floats a pixel: base colour, linear
    size_t albedo_row_bytes;          ///< stride
    float* position;                  ///< 3 floats a pixel, world space
    size_t position_row_bytes;        ///< stride
    uint32_t* instance;               ///< index of the instance plus 1
    size_t instance_row_bytes;        ///< stride
    uint32_t* triangle;               ///< number of the triangle in its mesh plus 1
    size_t triangle_row_bytes;        ///< stride
    uint32_t* lights;                 ///< lights whose range and cone the surface is in; 0 on unlit materials
    size_t lights_row_bytes;          ///< stride
    float* coverage;                  ///< share of the samples that an opaque or masked surface covers
    size_t coverage_row_bytes;        ///< stride
    float* barycentric;            ///< 2 floats a pixel: weights of the triangle's second and third corner; that of the first is 1 - both
    size_t barycentric_row_bytes;  ///< stride
    float* uv;                     ///< 2 floats a pixel: texture coordinates, set 0, before a texture's own transform
    size_t uv_row_bytes;           ///< stride
} halflit_target;
HALFLIT_C_API int32_t halflit_target_init(halflit_target* target, size_t size);

/// Times and counts of a frame. Times are milliseconds of wall clock.
typedef struct halflit_report {
    size_t size;
    double total_ms;                       ///< the whole call
    double prepare_ms;                     ///< preparing the scene, or what changed in it
    double plan_ms;                        ///< near 0 if the last frame's plan is used again
    double shadows_ms;                     ///< shadow maps
    double cull_ms, transform_ms, bin_ms;  ///< geometry: leaving out, vertices, lists of triangles for each tile
    double tiles_ms;                       ///< visibility and shading
    double error_budget;                   ///< codes; 0: no budget, and the error is not known
    double error_codes;                    ///< bound on the error with a budget, in 8-bit codes
    uint64_t triangles_submitted;          ///< triangles of the scene, over all instances
    uint64_t triangles_drawn;              ///< set up for tiles, without copies; pieces of clipped triangles count singly
    uint64_t triangles_not_finite;         ///< left out for a vertex that is NaN or infinite
    uint64_t pixels_visible;               ///< pixels of which an opaque or masked surface covers a sample
    uint64_t fragments_shaded;             ///< pairs of a pixel and a triangle whose colour was computed
    uint64_t nan_pixels;                   ///< fragments with a NaN in their colour, written as 0
    char isa[16];                          ///< instruction set
    int32_t error_within;                  ///< 1: error_codes is at most error_budget, always
    int32_t threads;                       ///< threads that worked on the frame
    int32_t warnings;                      ///< see halflit_renderer_get_warning
    int32_t reserved;
} halflit_report;

/// Draws a frame into `target`. lighting may be null: the scene's own light. settings may be null: the defaults. report may be null.
HALFLIT_C_API int32_t halflit_render(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting,
                                     const halflit_camera* camera, const halflit_settings* settings, const halflit_target* target,
                                     halflit_report* report);
/// A warning of the renderer's last frame: one line, valid until its next frame.
HALFLIT_C_API int32_t halflit_renderer_get_warning(const halflit_renderer* renderer, int32_t index, const char** text);

/// Turns the plane `depth`, without gaps between rows, into distances from the camera's eye, along the ray through each pixel's centre.
/// width, height: of the whole picture. region: the part that `depth` holds; null, or a width of 0: all. Infinity stays, and so do the
/// depths of an orthographic camera.
HALFLIT_C_API int32_t halflit_ray_distances(const halflit_camera* camera, int32_t width, int32_t height, const halflit_region* region,
                                            float* depth);
/// Writes `count` depths as codes from 1 to 65535 between the least and the largest of them, which go into range, and 0 for infinity.
HALFLIT_C_API int32_t halflit_depth_codes(const float* depth, size_t count, uint16_t* codes, double range[2]);
/// Turns `count` normals of the world, 3 floats each, into the camera's space: x to the right, y up, z towards the viewer.
HALFLIT_C_API int32_t halflit_view_normals(const halflit_camera* camera, float* normal, size_t count);
/// Turns `count` numbers of the plane `instance` into indices of meshes plus 1. 0, and what the scene does not have, becomes 0.
HALFLIT_C_API int32_t halflit_scene_mesh_numbers(const halflit_scene* scene, uint32_t* instance, size_t count);
/// The same of materials: the instance's own, or else its mesh's; 0 for the default material.
HALFLIT_C_API int32_t halflit_scene_material_numbers(const halflit_scene* scene, uint32_t* instance, size_t count);
/// Writes how far each point that is seen moves in the picture, 2 floats a pixel: x to the right, y down, from the scene and camera that
/// were drawn to the others. 0 where nothing is, and for points that are not before both cameras. instance, triangle, barycentric: planes
/// of `count` pixels. width, height: of both whole pictures. other: the same scene, or one of the same meshes in another pose.
HALFLIT_C_API int32_t halflit_motion(const halflit_scene* scene, const halflit_camera* camera, const halflit_scene* other,
                                     const halflit_camera* other_camera, int32_t width, int32_t height, const uint32_t* instance,
                                     const uint32_t* triangle, const float* barycentric, size_t count, float* motion);

/// A budget that is measured: a share of the pixels is within some 8-bit codes of the picture in full quality; and the cheapest settings
/// that keep it. 2 codes for 99 % are called fast, 8 codes for 95 % draft.
typedef struct halflit_measured {
    size_t size;
    double codes, asked_percent;               ///< the budget: 0 to 255, and above 0 and below 100
    double percent;                            ///< share that the probes show, with a confidence of 95 %; 100: the settings are those given
    int32_t probes, outside;                   ///< pixels that were compared, and those of them outside; 0 probes: nothing is known yet
    int32_t samples, anisotropy, shadow_size;  ///< members of halflit_settings
    int32_t reserved;
} halflit_measured;
/// Sets codes and asked_percent to 2 and 99, the rest to 0.
HALFLIT_C_API int32_t halflit_measured_init(halflit_measured* measured, size_t size);
/// Finds the cheapest settings that keep the budget in `measured` for a picture of width x height, by probes: pixels that a hash chooses
/// are drawn in the given settings and in cheaper ones. That takes about as long as a frame, so it is for sequences: call it for some of
/// the views with one halflit_measured, which becomes as careful as the most demanding of them, and draw with its samples, anisotropy and
/// shadow_size. Other views are not checked.
/// Fails (usage) for settings with an error budget, or an accuracy other than exact.
HALFLIT_C_API int32_t halflit_measure(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting,
                                      const halflit_camera* camera, const halflit_settings* settings, int32_t width, int32_t height,
                                      halflit_measured* measured);

// ---- pictures ----------------------------------------------------------------------------------------------------------

/// 64-bit hash of bytes, XXH64 with seed 0: the identity of a picture whose rows have no gaps. Null counts as no bytes.
HALFLIT_C_API uint64_t halflit_pixel_hash(const void* bytes, size_t count);
/// Writes the target's pixels, width x height of them, into a file: .png, .bmp, .tga, .jpg or .webp from 8-bit formats, .hdr, .pfm or .exr
/// from floats. The file is either old or new, never half written. "-" is PNG on standard output. Fails (usage) for a target with
/// region_alone.
HALFLIT_C_API int32_t halflit_write_image(const char* path, const halflit_target* target);
/// Encodes the target's pixels as halflit_write_image does. format: "png", "jpg" and so on. write is called once, with the whole file.
HALFLIT_C_API int32_t halflit_encode_image(const char* format, const halflit_target* target, halflit_write write, void* user);

/// Reads a colour as the program does: "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", a name of CSS 2 or "transparent". color: linear light, and
/// linear alpha.
HALFLIT_C_API int32_t halflit_read_color(const char* text, float color[4]);

// ---- calls: what the program's commands tell -------------------------------------------------------------------------

/// The answer of a call: a report, lines for people, and a picture where the call draws one.
typedef struct halflit_answer halflit_answer;

/// Makes the call of that name:
/// - look: labelled views on one sheet, and what each view shows of each part. section: the same with planes that cut
/// - certify: which triangles no view shows
/// - render: one picture
/// - measure: box, area, volume and bodies of the model and of its parts. info: the file, and what drawing it requires
/// - explain: what made pixels of the picture of render. explain-view: of a view of look
/// - compare: two versions of a model, the paths a and b
/// arguments: a JSON object, or null:
/// {"path": "model.glb", "view": ["front", "iso"], "size": [640, 480], "no_scene_lights": true, "pixel": [[320, 240], [10, 20]]}.
/// `path` names a model, or "demo", "sphere:N", "lights:N"; "-" reads the process's standard input; compare has `a` and `b` in its place.
/// The other names are the flags of render, for look, section, certify and explain-view those of look, and for compare its own, with - or
/// _ between words. A value is the flag's text, a number, a list of numbers, true for a switch, or a list for a flag that may be repeated.
/// Flags of files that are written are not taken. Files are read wherever they lie.
/// scene: null, or the scene that is drawn in place of a file; then there is no `path`, and what loading decides (`up`, `variant`,
/// `strict`) has no effect. It is copied, so others may use it meanwhile. compare takes none.
/// Calls of several threads do not wait for each other. A library that was built without files (HALFLIT_BUILD_IO) refuses all calls.
HALFLIT_C_API int32_t halflit_call(const char* name, const char* arguments, const halflit_scene* scene, halflit_answer** answer);
/// Fails as the call would before it loads a scene: for unknown names, wrong values, and what excludes each other. `path` may be left
/// out. No file is read.
HALFLIT_C_API int32_t halflit_call_check(const char* name, const char* arguments);
/// The report: a JSON object in one line of UTF-8, whose keys docs/answers has (those of measure and info in info.txt). It is valid as long
/// as the answer, as all that follows.
HALFLIT_C_API const char* halflit_answer_report(const halflit_answer* answer);
/// Lines for people, each with a newline at its end: faults first.
HALFLIT_C_API const char* halflit_answer_notes(const halflit_answer* answer);
/// 0: a negative result, for which the program ends with 1: a view with a fault, versions that differ, a blank picture. A call that fails
/// has no answer.
HALFLIT_C_API int32_t halflit_answer_is_good(const halflit_answer* answer);
/// The picture: rows of 8-bit RGBA from the top, without gaps; null where the call draws none. width and height may be null.
HALFLIT_C_API const void* halflit_answer_picture(const halflit_answer* answer, int32_t* width, int32_t* height);
/// Frees an answer; null is none.
HALFLIT_C_API void halflit_answer_destroy(halflit_answer* answer);

// ---- MuJoCo: a simulator's pictures from its own arrays -----------------------------------------------------------------

/// Draws what the classic renderer of MuJoCo draws, from a model's arrays and the arrays of scenes; labels, wireframes, stereo and the
/// frame around a picture are left out. It keeps shapes and textures. Members below that have the name of a member of mjModel, mjvScene,
/// mjvGeom, mjvLight or mjvGLCamera mean what that one means. One of these draws one call at a time.
typedef struct halflit_mujoco halflit_mujoco;

/// Where the members of mjvGeom, mjvLight and mjvGLCamera are in memory, in bytes from the start of the struct, so that the arrays of any
/// version of MuJoCo are read as they are. -1: that version has no such member. Defaults: MuJoCo 2.2.2 on 64-bit systems.
typedef struct halflit_mujoco_layout {
    size_t size;
    int32_t geom_size;  ///< bytes of a mjvGeom
    int32_t geom_type, geom_dataid, geom_objtype, geom_objid, geom_texid, geom_texuniform, geom_matid, geom_texcoord, geom_segid;  ///< int
    int32_t geom_texrepeat, geom_scale, geom_pos, geom_mat, geom_rgba;                         ///< float; geom_scale is mjvGeom.size
    int32_t geom_emission, geom_specular, geom_shininess, geom_reflectance, geom_modelrbound;  ///< float
    int32_t light_size;                                                                        ///< bytes of a mjvLight
    int32_t light_pos, light_dir, light_attenuation, light_cutoff, light_exponent;             ///< float
    int32_t light_ambient, light_diffuse, light_specular;                                      ///< float
    int32_t light_headlight, light_directional, light_castshadow;                              ///< mjtByte
    int32_t light_type;   ///< int, mjtLightType, in place of light_directional: 0 spot, 1 directional; others give no light
    int32_t camera_size;  ///< bytes of a mjvGLCamera
    int32_t camera_pos, camera_forward, camera_up, camera_center, camera_width;  ///< float; center and width are frustum_center and so on
    int32_t camera_bottom, camera_top, camera_near, camera_far;                  ///< float
    int32_t camera_orthographic;                                                 ///< int
    /// Numbers of mjtGeom that differ among versions; -1: there is none.
    int32_t type_skin, type_flex, type_linebox, type_triangle;  ///< of skins, flexes, boxes of lines and triangles
} halflit_mujoco_layout;
HALFLIT_C_API int32_t halflit_mujoco_layout_init(halflit_mujoco_layout* layout, size_t size);

/// A model's arrays, which are copied. n followed by a name: number of these, as in mjModel. An array whose number is 0 may be null.
typedef struct halflit_mujoco_model {
    size_t size;
    const halflit_mujoco_layout* layout;                                 ///< null: the defaults
    double extent;                                                       ///< stat.extent
    float znear, zfar, shadowclip, shadowscale, fogstart, fogend, haze;  ///< vis.map
    float fog_rgba[4], haze_rgba[4];                                     ///< vis.rgba.fog, vis.rgba.haze
    float linewidth;                                                     ///< vis.global
    int32_t shadowsize, numslices, numstacks, numquads;                  ///< vis.quality
    int32_t ngeom, nmat, nmesh, nmeshvert;                               ///< as in mjModel
    int32_t nmeshnormal, nmeshtexcoord;                                  ///< as in mjModel; of MuJoCo 2.2 nmeshvert and nmeshtexvert
    int32_t nmeshface, nmeshgraph, nhfield, nhfielddata, ntex;           ///< as in mjModel
    int32_t nskin, nskinvert, nskintexvert, nskinface, nflex;            ///< as in mjModel
    uint64_t ntexdata;                                                   ///< as in mjModel
    const int32_t* geom_type;                                            ///< as in mjModel
    const int32_t* geom_matid;                                           ///< as in mjModel
    const double* geom_size;                                             ///< as in mjModel
    const int32_t* mat_texid;       ///< of each material, the texture of its colour; needed where layout.geom_texid is -1, as the next one
    const uint8_t* mat_texuniform;  ///< as in mjModel
    const float* mat_texrepeat;     ///< as in mjModel
    const int32_t* mesh_vertadr;    ///< as in mjModel
    const int32_t* mesh_vertnum;    ///< as in mjModel
    const int32_t* mesh_normaladr;  ///< null: mesh_vertadr, and normals are addressed by mesh_face, as in MuJoCo 2.2
    const int32_t* mesh_texcoordadr;   ///< -1: none
    const int32_t* mesh_faceadr;       ///< as in mjModel
    const int32_t* mesh_facenum;       ///< as in mjModel
    const int32_t* mesh_graphadr;      ///< -1: none
    const float* mesh_vert;            ///< as in mjModel
    const float* mesh_normal;          ///< as in mjModel
    const float* mesh_texcoord;        ///< as in mjModel
    const int32_t* mesh_face;          ///< as in mjModel
    const int32_t* mesh_facenormal;    ///< null: mesh_face
    const int32_t* mesh_facetexcoord;  ///< null: mesh_face
    const int32_t* mesh_graph;         ///< as in mjModel
    const double* hfield_size;         ///< as in mjModel
    const int32_t* hfield_nrow;        ///< as in mjModel
    const int32_t* hfield_ncol;        ///< as in mjModel
    const int32_t* hfield_adr;         ///< as in mjModel
    const float* hfield_data;          ///< as in mjModel
    const int32_t* tex_type;           ///< as in mjModel
    const int32_t* tex_width;          ///< as in mjModel
    const int32_t* tex_height;         ///< as in mjModel
    const int32_t* tex_nchannel;       ///< null: 3 each
    const int32_t* tex_colorspace;     ///< mjtColorSpace, 2: sRGB; null: none says
    const int64_t* tex_adr;            ///< as in mjModel
    const uint8_t* tex_data;           ///< tex_rgb before 3.2
    const int32_t* skin_vertadr;       ///< as in mjModel
    const int32_t* skin_vertnum;       ///< as in mjModel
    const int32_t* skin_texcoordadr;   ///< -1: none
    const int32_t* skin_faceadr;       ///< as in mjModel
    const int32_t* skin_facenum;       ///< as in mjModel
    const float* skin_texcoord;        ///< as in mjModel
    const int32_t* skin_face;          ///< as in mjModel
    const int32_t* flex_facenum;       ///< mjvScene.flexfacenum: room for so many triangles of each
} halflit_mujoco_model;
HALFLIT_C_API int32_t halflit_mujoco_model_init(halflit_mujoco_model* model, size_t size);

/// A scene, as mjv_updateScene() has left it. Nothing is copied, and nothing is written into it: a headlight's place and direction, and
/// which geoms mirror, are found without.
typedef struct halflit_mujoco_scene {
    size_t size;
    const void* geoms;        ///< mjvGeom
    const void* lights;       ///< mjvLight
    const void* camera;       ///< two mjvGLCamera, between which the picture is seen
    const uint8_t* flags;     ///< ten: shadow, wireframe (not drawn), reflection, additive, skybox, fog, haze, segment, idcolor, cull_face
    const float* skinvert;    ///< 3 nskinvert; null: skins are not drawn
    const float* skinnormal;  ///< as in mjvScene
    const int32_t* flexfaceused;           ///< triangles of each flex, which has no texture; null: flexes are not drawn
    const float* flexface;                 ///< nine numbers a triangle
    const float* flexnormal;               ///< as in mjvScene
    int32_t ngeom, nlight;                 ///< as in mjvScene
    int32_t enabletransform;               ///< as in mjvScene
    float translate[3], rotate[4], scale;  ///< as in mjvScene
    int32_t reserved;
} halflit_mujoco_scene;
HALFLIT_C_API int32_t halflit_mujoco_scene_init(halflit_mujoco_scene* scene, size_t size);

/// Depth as OpenGL's: 0 at the near plane, 1 at the far plane. Or the distance along the view in the model's unit, the far plane's where
/// nothing is.
enum { HALFLIT_MUJOCO_DEPTH_WINDOW = 0, HALFLIT_MUJOCO_DEPTH_DISTANCE = 1 };
/// Pass of MuJoCo from which depth is. SEGMENT: transparent geoms have depth, the sky has none. COLOR: the reverse.
enum { HALFLIT_MUJOCO_PASS_SEGMENT = 0, HALFLIT_MUJOCO_PASS_COLOR = 1 };

/// A picture of a scene, in the caller's memory, rows without gaps. A null pointer is not drawn.
typedef struct halflit_mujoco_picture {
    size_t size;
    const halflit_mujoco_scene* scene;  ///< what is drawn
    const void* camera;                 ///< two mjvGLCamera in place of the scene's; null: the scene's
    const uint8_t* flags;               ///< ten flags in place of the scene's; null: the scene's
    uint8_t* rgb;                       ///< three codes a pixel; with the flag `segment` the colours of segids
    float* depth;                       ///< one number a pixel
    int32_t* segid;                     ///< of what is nearest, transparent or not; -1: nothing
    int32_t* object;                    ///< objid and objtype of it; -1, -1: nothing
    int32_t width, height;              ///< pixels
    int32_t samples;                    ///< 1 or 4 a pixel, of rgb without `segment`
    int32_t bottom_up;                  ///< the first row is the bottom one, as mjr_readPixels() gives it
    int32_t depth_unit;                 ///< HALFLIT_MUJOCO_DEPTH
    int32_t depth_pass;                 ///< HALFLIT_MUJOCO_PASS
} halflit_mujoco_picture;
HALFLIT_C_API int32_t halflit_mujoco_picture_init(halflit_mujoco_picture* picture, size_t size);

/// Makes the shapes and textures of a model. look: the release whose pictures are made, from "2.2" on, below 4. Shadows differ from 3.3 on;
/// textures that are marked as sRGB are decoded from 3.3.3 on. execution may be null: the defaults; its on_tile and progress are not
/// called. Fails (usage) for another look, (bad input) for arrays that contradict each other, (limit) for more than 2^26 corners of
/// triangles, 2^22 triangles of flexes or 2^27 texels, or a texture's side above 16384.
HALFLIT_C_API int32_t halflit_mujoco_create(const halflit_mujoco_model* model, const char* look, const halflit_execution* execution,
                                            halflit_mujoco** mujoco);
/// Draws pictures, on all cores: of one scene seen by several cameras, or of many scenes. pictures: an array of structs of the first one's
/// size. The same pictures come out whatever else is in the array.
HALFLIT_C_API int32_t halflit_mujoco_render(halflit_mujoco* mujoco, const halflit_mujoco_picture* pictures, int32_t count);
/// Frees it. Null is allowed.
HALFLIT_C_API void halflit_mujoco_destroy(halflit_mujoco* mujoco);

#ifdef __cplusplus
}
#endif

#endif
