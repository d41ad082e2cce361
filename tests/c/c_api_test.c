// The C interface as a C99 program uses it. Prints each check that fails; the exit code is 1 if one did.
#include "peer.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 80, HEIGHT = 60, PIXELS = WIDTH * HEIGHT };

static int checks = 0, failures = 0;
#define CHECK(condition) \
    (++checks,           \
     (condition) ? (void)0 : (++failures, (void)printf("line %d: %s (last error: %s)\n", __LINE__, #condition, halflit_last_error())))
#define CHECK_OK(call) CHECK((call) == HALFLIT_OK)
/// The call fails by this code, with a message that contains `words`.
#define CHECK_FAILS(call, code, words) CHECK((call) == (code) && strstr(halflit_last_error(), words) != NULL)

static const float corners[8 * 3] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
static const uint32_t indices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                                     1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7};
static const char model[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"materials\":[{\"name\":\"paint\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.2,0.1,1],\"metallicFactor\":0}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0},{\"attributes\":{\"POSITION\":0},\"mode\":1}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,"
    "\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

/// The same triangle, moved by 2 along x within a second.
static const char animated_model[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\",\"min\":[0],\"max\":[1]},"
    "{\"bufferView\":2,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
    "\"animations\":[{\"name\":\"slide\",\"samplers\":[{\"input\":1,\"output\":2}],"
    "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":8},"
    "{\"buffer\":0,\"byteOffset\":44,\"byteLength\":24}],\"buffers\":[{\"byteLength\":68,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAABAAAAAAAAAAAA=\"}]}";

/// A scene with one cube, and what auto_setup chose for it.
typedef struct {
    halflit_scene* scene;
    int32_t material, mesh, instance;
    halflit_camera camera;
    halflit_settings settings;
    halflit_lighting* lighting;  // freed by free_cube
} Cube;

static void init_cube_mesh(halflit_mesh* mesh, int32_t material) {
    halflit_mesh_init(mesh, sizeof *mesh);
    mesh->positions = corners;
    mesh->vertex_count = 8;
    mesh->indices = indices;
    mesh->index_count = 36;
    mesh->material = material;
}

/// What the library chooses for a picture of WIDTH x HEIGHT. The light is the caller's to free.
static halflit_lighting* init_setup(halflit_scene* scene, halflit_camera* camera, halflit_settings* settings) {
    halflit_picture_request request;
    halflit_lighting* lighting = NULL;
    CHECK_OK(halflit_camera_init(camera, sizeof *camera));
    CHECK_OK(halflit_settings_init(settings, sizeof *settings));
    CHECK_OK(halflit_picture_request_init(&request, sizeof request));
    request.width = WIDTH, request.height = HEIGHT;
    CHECK_OK(halflit_choose_picture(scene, &request, NULL, camera, settings, &lighting));
    return lighting;
}

static Cube make_cube(void) {
    Cube cube;
    halflit_material clay;
    halflit_mesh mesh;
    CHECK_OK(halflit_scene_create(&cube.scene));
    CHECK_OK(halflit_material_init(&clay, sizeof clay));
    clay.base_color[1] = 0.4f;
    clay.base_color[2] = 0.2f;
    clay.metallic = 0;
    CHECK_OK(halflit_lobe_by_name("sloan", 0.5f, &clay.lobe));
    CHECK_OK(halflit_scene_add_material(cube.scene, &clay, &cube.material));
    init_cube_mesh(&mesh, cube.material);
    CHECK_OK(halflit_scene_add_mesh(cube.scene, &mesh, &cube.mesh));
    CHECK_OK(halflit_scene_add_instance(cube.scene, cube.mesh, NULL, &cube.instance));
    cube.lighting = init_setup(cube.scene, &cube.camera, &cube.settings);
    return cube;
}

static void free_cube(Cube* cube) {
    halflit_lighting_destroy(cube->lighting);
    halflit_scene_destroy(cube->scene);
}

static void place(float matrix[16], float x) {
    memset(matrix, 0, 16 * sizeof(float));
    matrix[0] = matrix[5] = matrix[10] = matrix[15] = 1;
    matrix[12] = x;
}

static halflit_target make_target(void* pixels) {
    halflit_target target;
    halflit_target_init(&target, sizeof target);
    target.width = WIDTH;
    target.height = HEIGHT;
    target.pixels = pixels;
    return target;
}

/// Draws by a renderer, or by a new one if it is null. Returns the hash of the picture, 0 if the call fails.
static uint64_t draw(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting, const halflit_camera* camera,
                     const halflit_settings* settings) {
    static uint8_t pixels[PIXELS * 4];
    const halflit_target target = make_target(pixels);
    halflit_renderer* own = NULL;
    int32_t code;
    if (renderer == NULL) CHECK_OK(halflit_renderer_create(NULL, &own));
    memset(pixels, 0, sizeof pixels);
    code = halflit_render(renderer != NULL ? renderer : own, scene, lighting, camera, settings, &target, NULL);
    halflit_renderer_destroy(own);
    return code == HALFLIT_OK ? halflit_pixel_hash(pixels, sizeof pixels) : 0;
}

/// Draws by the light that is chosen for this camera and the scene as it is.
static uint64_t draw_chosen(halflit_scene* scene, const halflit_camera* camera, const halflit_settings* settings) {
    halflit_picture_request request;
    halflit_camera view;
    halflit_settings others;
    halflit_lighting* lighting = NULL;
    uint64_t hash;
    CHECK_OK(halflit_picture_request_init(&request, sizeof request));
    CHECK_OK(halflit_camera_init(&view, sizeof view));
    CHECK_OK(halflit_settings_init(&others, sizeof others));
    request.camera = camera;
    CHECK_OK(halflit_choose_picture(scene, &request, NULL, &view, &others, &lighting));
    hash = draw(NULL, scene, lighting, camera, settings);
    halflit_lighting_destroy(lighting);
    return hash;
}

static uint64_t draw_cube(halflit_renderer* renderer, const Cube* cube) {
    return draw(renderer, cube->scene, cube->lighting, &cube->camera, &cube->settings);
}

// ---- null pointers, sizes and messages ---------------------------------------------------------------------------------

static void test_null_pointers(void) {
    Cube cube = make_cube();
    halflit_renderer* renderer;
    halflit_target target = make_target(NULL);
    float matrix[16];
    const char* text;
    CHECK_OK(halflit_renderer_create(NULL, &renderer));
    halflit_scene_destroy(NULL);
    halflit_renderer_destroy(NULL);
    CHECK_FAILS(halflit_scene_create(NULL), HALFLIT_ERROR_USAGE, "halflit_scene_create: scene is null");
    CHECK_FAILS(halflit_scene_load(NULL, NULL, &cube.scene), HALFLIT_ERROR_USAGE, "path is null");
    CHECK_FAILS(halflit_scene_load_memory(NULL, 3, "x", NULL, NULL, &cube.scene), HALFLIT_ERROR_USAGE, "bytes is null");
    CHECK_FAILS(halflit_settings_init(NULL, 8), HALFLIT_ERROR_USAGE, "settings is null");
    CHECK_FAILS(halflit_scene_add_mesh(NULL, NULL, NULL), HALFLIT_ERROR_USAGE, "halflit_scene_add_mesh: scene is null");
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, NULL, NULL), HALFLIT_ERROR_USAGE, "mesh is null");
    CHECK_FAILS(halflit_scene_add_texture(cube.scene, NULL, 1, 1, 0, 0, NULL), HALFLIT_ERROR_USAGE, "rgba8 is null");
    CHECK_FAILS(halflit_scene_add_material(cube.scene, NULL, NULL), HALFLIT_ERROR_USAGE, "material is null");
    CHECK_FAILS(halflit_scene_add_light(cube.scene, NULL, NULL), HALFLIT_ERROR_USAGE, "light is null");
    CHECK_FAILS(halflit_scene_set_ambient(cube.scene, NULL, NULL), HALFLIT_ERROR_USAGE, "sky is null");
    CHECK_FAILS(halflit_scene_set_vertices(cube.scene, cube.mesh, NULL, NULL, 8), HALFLIT_ERROR_USAGE, "positions is null");
    CHECK_FAILS(halflit_scene_place_instance(cube.scene, 0, NULL), HALFLIT_ERROR_USAGE, "world_from_object is null");
    CHECK_FAILS(halflit_scene_set_environment(cube.scene, NULL, 1, 1, NULL), HALFLIT_ERROR_USAGE, "rgb is null");
    CHECK_FAILS(halflit_scene_get_counts(cube.scene, NULL), HALFLIT_ERROR_USAGE, "counts is null");
    CHECK_FAILS(halflit_scene_get_bounds(cube.scene, NULL, matrix), HALFLIT_ERROR_USAGE, "halflit_scene_get_bounds: min is null");
    CHECK_FAILS(halflit_camera_look_at(NULL, NULL, NULL, NULL), HALFLIT_ERROR_USAGE, "eye is null");
    CHECK_FAILS(halflit_choose_picture(cube.scene, NULL, NULL, NULL, NULL, NULL), HALFLIT_ERROR_USAGE, "camera is null");
    CHECK_FAILS(halflit_renderer_create(NULL, NULL), HALFLIT_ERROR_USAGE, "renderer is null");
    CHECK_FAILS(halflit_render(NULL, cube.scene, NULL, &cube.camera, NULL, &target, NULL), HALFLIT_ERROR_USAGE, "renderer is null");
    CHECK_FAILS(halflit_render(renderer, NULL, NULL, &cube.camera, NULL, &target, NULL), HALFLIT_ERROR_USAGE, "scene is null");
    CHECK_FAILS(halflit_render(renderer, cube.scene, NULL, NULL, NULL, &target, NULL), HALFLIT_ERROR_USAGE, "camera is null");
    CHECK_FAILS(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, NULL, NULL, NULL), HALFLIT_ERROR_USAGE, "target is null");
    CHECK_FAILS(halflit_renderer_get_warning(renderer, 0, &text), HALFLIT_ERROR_USAGE, "the frame has 0");
    CHECK_FAILS(halflit_write_image(NULL, &target), HALFLIT_ERROR_USAGE, "path is null");
    CHECK_FAILS(halflit_write_image("x.png", &target), HALFLIT_ERROR_USAGE, "pixels is null");
    CHECK(halflit_pixel_hash(NULL, 4) == 0xef46db3751d8e999u);  // that of no bytes
    halflit_renderer_destroy(renderer);
    free_cube(&cube);
}

static void test_struct_sizes(void) {
    Cube cube = make_cube();
    uint64_t expected;
    struct {
        halflit_settings known;
        int32_t added[4];
    } newer;
    halflit_settings older;
    halflit_execution execution;
    halflit_renderer* renderer = NULL;
    halflit_counts counts;
    {  // What keeps a share of the pixels, and a picture by it.
        halflit_measured measured;
        halflit_renderer* by = NULL;
        CHECK_OK(halflit_renderer_create(NULL, &by));
        CHECK_OK(halflit_measured_init(&measured, sizeof measured));
        CHECK(measured.codes == 2 && measured.asked_percent == 99 && measured.probes == 0);
        CHECK_OK(halflit_measure(by, cube.scene, cube.lighting, &cube.camera, &cube.settings, 96, 64, &measured));
        CHECK(measured.percent >= 99 && measured.probes >= 512 && measured.samples >= 1 && measured.anisotropy >= 1);
        CHECK_OK(halflit_measure(by, cube.scene, cube.lighting, &cube.camera, &cube.settings, 96, 64, &measured));
        measured.samples = 3;
        CHECK(halflit_measure(by, cube.scene, cube.lighting, &cube.camera, &cube.settings, 96, 64, &measured) == HALFLIT_ERROR_USAGE);
        measured.probes = 0, measured.asked_percent = 100;
        CHECK(halflit_measure(by, cube.scene, cube.lighting, &cube.camera, &cube.settings, 96, 64, &measured) == HALFLIT_ERROR_USAGE);
        CHECK(halflit_measure(by, NULL, cube.lighting, &cube.camera, &cube.settings, 96, 64, &measured) == HALFLIT_ERROR_USAGE);
        halflit_renderer_destroy(by);
    }
    cube.settings.shadow_size = 0;                 // the default, which a shorter struct stands for
    cube.settings.tone_curve = HALFLIT_TONE_NONE;  // so too
    cube.settings.contact_shadow = 0;              // so too
    cube.settings.alpha = HALFLIT_ALPHA_SPACE_LINEAR, cube.settings.shadow_softness_deg = 0;
    cube.settings.edl = HALFLIT_EDL_OFF, cube.settings.edge_contrast = 0;
    older = cube.settings;
    expected = draw_cube(NULL, &cube);
    CHECK(expected != 0);

    memset(&newer, 0xff, sizeof newer);
    CHECK_OK(halflit_settings_init(&newer.known, sizeof newer));
    CHECK(newer.known.size == sizeof newer && newer.known.samples == 1 && newer.added[0] == 0 && newer.added[3] == 0);
    newer.known = cube.settings;
    newer.known.size = sizeof newer;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &newer.known) == expected);
    newer.added[2] = 1;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &newer.known) == 0);
    CHECK(strstr(halflit_last_error(), "halflit_settings: members beyond byte") != NULL);

    // A program that was built when `shading_rate` and what follows did not exist: those bytes belong to something else.
    older.size = offsetof(halflit_settings, shading_rate);
    memset(&older.shading_rate, 0x5a, sizeof older - offsetof(halflit_settings, shading_rate));
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &older) == expected);
    CHECK_OK(halflit_settings_init(&older, offsetof(halflit_settings, shading_rate)));
    CHECK(older.samples == 1 && older.shadows == 0x5a5a5a5a);

    older = cube.settings;
    older.size = 0;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &older) == 0 && strstr(halflit_last_error(), "the member size is 0") != NULL);
    older.size = (size_t)-1;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &older) == 0 &&
          strstr(halflit_last_error(), "sizeof(halflit_settings)") != NULL);
    older.size = offsetof(halflit_settings, shading_rate) - 4;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &older) == 0 && strstr(halflit_last_error(), "the member size is") != NULL);
    CHECK_OK(halflit_execution_init(&execution, sizeof execution));
    execution.size = offsetof(halflit_execution, cancelled) + sizeof execution.cancelled / 2;
    CHECK(halflit_renderer_create(&execution, &renderer) == HALFLIT_ERROR_USAGE && renderer == NULL);
    cube.camera.reserved = 1;
    CHECK(draw(NULL, cube.scene, cube.lighting, &cube.camera, &cube.settings) == 0 && strstr(halflit_last_error(), "reserved") != NULL);
    counts.size = 3;
    CHECK_FAILS(halflit_scene_get_counts(cube.scene, &counts), HALFLIT_ERROR_USAGE, "halflit_counts");
    counts.size = offsetof(halflit_counts, meshes);
    counts.meshes = 77;
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(counts.triangles == 12 && counts.meshes == 77 && counts.size == offsetof(halflit_counts, meshes));
    free_cube(&cube);
}

/// Planes that name points of the cube, and what is made of them.
static void test_points_of_triangles(void) {
    static float depth[PIXELS], normal[3 * PIXELS], position[3 * PIXELS], barycentric[2 * PIXELS], uv[2 * PIXELS], motion[2 * PIXELS];
    static uint32_t instance[PIXELS], triangle[PIXELS], mesh[PIXELS];
    Cube cube = make_cube();
    halflit_target target = make_target(NULL);
    halflit_renderer* by = NULL;
    halflit_camera wrong_size = cube.camera;
    int i, seen = 0, wrong = 0;
    cube.settings.samples = 1;  // the first sample is the centre, where positions are
    target.depth = depth, target.normal = normal, target.position = position;
    target.barycentric = barycentric, target.uv = uv, target.instance = instance, target.triangle = triangle;
    CHECK_OK(halflit_renderer_create(NULL, &by));
    CHECK_OK(halflit_render(by, cube.scene, NULL, &cube.camera, &cube.settings, &target, NULL));
    halflit_renderer_destroy(by);
    memcpy(mesh, instance, sizeof mesh);
    CHECK_OK(halflit_scene_mesh_numbers(cube.scene, mesh, PIXELS));
    CHECK_OK(halflit_ray_distances(&cube.camera, WIDTH, HEIGHT, NULL, depth));
    CHECK_OK(halflit_view_normals(&cube.camera, normal, PIXELS));
    CHECK_OK(
        halflit_motion(cube.scene, &cube.camera, cube.scene, &cube.camera, WIDTH, HEIGHT, instance, triangle, barycentric, PIXELS, motion));
    for (i = 0; i < PIXELS; ++i) {
        const float* eye = cube.camera.world_from_camera + 12;
        double squared = 0;
        int k;
        wrong += motion[2 * i] != 0 || motion[2 * i + 1] != 0;
        if (instance[i] == 0) {
            wrong += mesh[i] != 0 || barycentric[2 * i] != 0 || barycentric[2 * i + 1] != 0;
            continue;
        }
        ++seen;
        for (k = 0; k < 3; ++k) squared += ((double)position[3 * i + k] - eye[k]) * ((double)position[3 * i + k] - eye[k]);
        wrong += !(squared / ((double)depth[i] * depth[i]) > 0.9999 && squared / ((double)depth[i] * depth[i]) < 1.0001);
        wrong += !(normal[3 * i + 2] > -0.1f);  // towards the viewer
        wrong += mesh[i] != (uint32_t)cube.mesh + 1;
        wrong += !(barycentric[2 * i] >= 0 && barycentric[2 * i + 1] >= 0 && barycentric[2 * i] + barycentric[2 * i + 1] < 1.00001f);
    }
    CHECK(wrong == 0 && seen > 100);
    CHECK_OK(halflit_scene_material_numbers(cube.scene, instance, PIXELS));
    CHECK_FAILS(halflit_ray_distances(&cube.camera, 0, HEIGHT, NULL, depth), HALFLIT_ERROR_USAGE, "no pixels");
    CHECK_FAILS(halflit_ray_distances(&cube.camera, WIDTH, HEIGHT, NULL, NULL), HALFLIT_ERROR_USAGE, "depth is null");
    wrong_size.size = 3;
    CHECK_FAILS(halflit_view_normals(&wrong_size, normal, PIXELS), HALFLIT_ERROR_USAGE, "halflit_camera");
    CHECK_FAILS(
        halflit_motion(NULL, &cube.camera, cube.scene, &cube.camera, WIDTH, HEIGHT, instance, triangle, barycentric, PIXELS, motion),
        HALFLIT_ERROR_USAGE, "scene is null");
    free_cube(&cube);
}

static void test_faulty_arguments(void) {
    Cube cube = make_cube();
    halflit_mesh mesh;
    halflit_material material;
    halflit_light light;
    halflit_execution execution;
    halflit_renderer* renderer;
    halflit_scene* none;
    halflit_lobe lobe;
    halflit_target target = make_target(&mesh);
    const uint32_t beyond[3] = {0, 1, 8};
    uint8_t texel[4] = {0, 0, 0, 0};
    uint64_t plain;
    init_cube_mesh(&mesh, 5);
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "material 5, but the scene has 1");
    init_cube_mesh(&mesh, -1);
    mesh.indices = beyond;
    mesh.index_count = 3;
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, &mesh, NULL), HALFLIT_ERROR_BAD_INPUT, "index 8");
    mesh.index_count = 2;
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, &mesh, NULL), HALFLIT_ERROR_BAD_INPUT, "3 for each triangle");
    mesh.topology = HALFLIT_TOPOLOGY_LINES;
    mesh.index_count = 3;
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, &mesh, NULL), HALFLIT_ERROR_BAD_INPUT, "2 for each line");
    mesh.topology = 3;
    CHECK_FAILS(halflit_scene_add_mesh(cube.scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "topology is 3, expected 0 to 2");
    CHECK_FAILS(halflit_scene_set_vertices(cube.scene, cube.mesh, corners, NULL, 7), HALFLIT_ERROR_USAGE, "7 vertices, expected 8");
    CHECK_FAILS(halflit_scene_add_instance(cube.scene, 1, NULL, NULL), HALFLIT_ERROR_USAGE, "mesh 1, but the scene has 1");
    halflit_material_init(&material, sizeof material);
    material.normal_texture.texture = 0;
    CHECK_FAILS(halflit_scene_add_material(cube.scene, &material, NULL), HALFLIT_ERROR_USAGE, "texture 0, but the scene has 0");
    material.normal_texture.texture = -1;
    material.alpha_mode = 3;
    CHECK_FAILS(halflit_scene_add_material(cube.scene, &material, NULL), HALFLIT_ERROR_USAGE, "alpha_mode is 3, expected 0 to 2");
    material.alpha_mode = 0;
    material.lobe.wrap = 2;
    CHECK_FAILS(halflit_scene_set_material(cube.scene, 0, &material), HALFLIT_ERROR_USAGE, "lobe: wrap");
    CHECK_FAILS(halflit_lobe_by_name("round", 0, &lobe), HALFLIT_ERROR_USAGE, "lambert, green");
    halflit_light_init(&light, sizeof light);
    light.type = -1;
    CHECK_FAILS(halflit_scene_add_light(cube.scene, &light, NULL), HALFLIT_ERROR_USAGE, "type is -1");
    CHECK_FAILS(halflit_scene_add_texture(cube.scene, texel, 0, 1, 0, 0, NULL), HALFLIT_ERROR_USAGE, "0 x 1 pixels");
    CHECK_FAILS(halflit_scene_add_texture(cube.scene, texel, 1, 1, 3, 0, NULL), HALFLIT_ERROR_USAGE, "row_bytes is 3");
    CHECK_FAILS(halflit_scene_add_texture(cube.scene, texel, 1, 1, 0, 4, NULL), HALFLIT_ERROR_USAGE, "color is 4");
    cube.settings.tone_curve = 4;
    CHECK(draw_cube(NULL, &cube) == 0);
    CHECK(strstr(halflit_last_error(), "halflit_settings: tone_curve is 4, expected 0 to 3") != NULL);
    cube.settings.tone_curve = HALFLIT_TONE_NONE;
    plain = draw_cube(NULL, &cube);
    for (cube.settings.tone_curve = HALFLIT_TONE_REINHARD; cube.settings.tone_curve <= HALFLIT_TONE_NEUTRAL; ++cube.settings.tone_curve) {
        const uint64_t toned = draw_cube(NULL, &cube);
        CHECK(toned != 0 && toned != plain);
    }
    cube.settings.tone_curve = HALFLIT_TONE_NONE;
    halflit_execution_init(&execution, sizeof execution);
    execution.isa = "mmx";
    CHECK_FAILS(halflit_renderer_create(&execution, &renderer), HALFLIT_ERROR_USAGE, "mmx");
    execution.isa = NULL;
    execution.tile_size = 20;
    CHECK_FAILS(halflit_renderer_create(&execution, &renderer), HALFLIT_ERROR_USAGE, "tile_size is 20");
    CHECK_FAILS(halflit_scene_load("no/such.glb", NULL, &none), HAS_FILES ? HALFLIT_ERROR_IO : HALFLIT_ERROR_USAGE, "no/such.glb");
    CHECK_FAILS(halflit_scene_load_memory("{", 1, "memory.gltf", NULL, NULL, &none),
                HAS_FILES ? HALFLIT_ERROR_BAD_INPUT : HALFLIT_ERROR_USAGE, "memory.gltf");
    if (HAS_FILES) {
        target.format = 6;
        CHECK_FAILS(halflit_write_image("x.png", &target), HALFLIT_ERROR_USAGE, "format is 6");
        target.format = HALFLIT_FORMAT_RGBA_F32;
        CHECK_FAILS(halflit_write_image("x.png", &target), HALFLIT_ERROR_USAGE, "8-bit");
        CHECK_FAILS(halflit_write_image("x.gif", &target), HALFLIT_ERROR_USAGE, ".hdr");
    }
    cube.settings.samples = 3;
    CHECK(draw_cube(NULL, &cube) == 0 && strstr(halflit_last_error(), "samples") != NULL);
    free_cube(&cube);
}

// ---- pictures ----------------------------------------------------------------------------------------------------------

static void test_formats(void) {
    enum { STRIDE = WIDTH * 4 + 12 };
    static uint8_t rgba[PIXELS * 4], bgra[HEIGHT * STRIDE], premultiplied[PIXELS * 4];
    static float linear[PIXELS * 4], depth[PIXELS], normal[PIXELS * 3];
    static float shading_normal[PIXELS * 3], albedo[PIXELS * 3], position[PIXELS * 3], coverage[PIXELS];
    static uint32_t instance[PIXELS], triangle[PIXELS], lights[PIXELS];
    Cube cube = make_cube();
    halflit_renderer* renderer;
    halflit_report report;
    halflit_target target = make_target(rgba);
    int differ = 0, touched = 0, wrong = 0, x, y, c, seen = 0;
    cube.settings.background[0] = 0.5f;
    cube.settings.background[3] = 0.25f;
    CHECK_OK(halflit_renderer_create(NULL, &renderer));
    target.depth = depth;
    target.normal = normal;
    target.instance = instance;
    target.triangle = triangle;
    target.shading_normal = shading_normal;
    target.albedo = albedo;
    target.position = position;
    target.coverage = coverage;
    target.lights = lights;
    report.size = sizeof report;
    CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, &report));
    CHECK(report.triangles_submitted == 12 && report.triangles_drawn > 0 && report.pixels_visible > 0 && report.isa[0] != '\0');
    CHECK(report.total_ms >= report.prepare_ms && report.warnings == 0 && report.error_budget == 0);
    for (x = 0; x < PIXELS; ++x) {
        if (instance[x] == 0) continue;
        ++seen;
        if (instance[x] != 1 || triangle[x] < 1 || triangle[x] > 12 || !(depth[x] > 0) || isinf(depth[x])) ++wrong;
        // Without a normal map both normals are the same direction, and every share of a pixel that is seen is above 0.
        for (c = 0; c < 3; ++c)
            if (fabsf(shading_normal[3 * x + c] - normal[3 * x + c]) > 1e-6f || !(albedo[3 * x + c] >= 0.0f)) ++wrong;
        if (!(coverage[x] > 0.0f && coverage[x] <= 1.0f)) ++wrong;
        if (position[3 * x] == 0.0f && position[3 * x + 1] == 0.0f && position[3 * x + 2] == 0.0f) ++wrong;
    }
    CHECK(seen > PIXELS / 10 && wrong == 0 && instance[0] == 0 && isinf(depth[0]));

    memset(bgra, 0xab, sizeof bgra);
    target = make_target(bgra);
    target.format = HALFLIT_FORMAT_BGRA8;
    target.row_bytes = STRIDE;
    CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL));
    target = make_target(premultiplied);
    target.format = HALFLIT_FORMAT_RGBA8_PREMULTIPLIED;
    CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL));
    target = make_target(linear);
    target.format = HALFLIT_FORMAT_RGBA_F32;
    CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL));
    wrong = 0;
    for (y = 0; y < HEIGHT; ++y) {
        for (x = 0; x < WIDTH; ++x) {
            const uint8_t *from = rgba + 4 * (y * WIDTH + x), *to = bgra + y * STRIDE + 4 * x, *times = premultiplied + 4 * (y * WIDTH + x);
            if (from[0] != to[2] || from[1] != to[1] || from[2] != to[0] || from[3] != to[3]) ++differ;
            for (c = 0; c < 3; ++c)
                if (times[c] != (from[c] * from[3] + 127) / 255) ++wrong;
            if (fabsf(linear[4 * (y * WIDTH + x) + 3] * 255 - (float)from[3]) > 0.51f) ++wrong;
        }
        for (x = 4 * WIDTH; x < STRIDE; ++x)
            if (bgra[y * STRIDE + x] != 0xab) ++touched;
    }
    CHECK(differ == 0);
    CHECK(touched == 0);
    CHECK(wrong == 0);
    CHECK(rgba[3] == 64 && linear[0] == 0.5f);

    if (!HAS_FILES) return;
    // Files: the same bytes whichever format the memory has.
    target = make_target(rgba);
    CHECK_OK(halflit_write_image("c_api_test_rgba.bmp", &target));
    target = make_target(bgra);
    target.format = HALFLIT_FORMAT_BGRA8;
    target.row_bytes = STRIDE;
    CHECK_OK(halflit_write_image("c_api_test_bgra.bmp", &target));
    target = make_target(linear);
    target.format = HALFLIT_FORMAT_RGBA_F32;
    CHECK_OK(halflit_write_image("c_api_test.hdr", &target));
    {
        static char first[1 << 16], second[1 << 16];
        FILE *a = fopen("c_api_test_rgba.bmp", "rb"), *b = fopen("c_api_test_bgra.bmp", "rb");
        size_t of_first, of_second;
        CHECK(a != NULL && b != NULL);
        of_first = fread(first, 1, sizeof first, a);
        of_second = fread(second, 1, sizeof second, b);
        CHECK(of_first > PIXELS && of_first == of_second && memcmp(first, second, of_first) == 0);
        fclose(a);
        fclose(b);
    }

    // A region in memory of its own is that part of the picture.
    {
        static uint8_t part[20 * 10 * 4];
        cube.settings.region.x = 30;
        cube.settings.region.y = 25;
        cube.settings.region.width = 20;
        cube.settings.region.height = 10;
        target = make_target(part);
        target.region_alone = 1;
        CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL));
        CHECK_FAILS(halflit_write_image("x.png", &target), HALFLIT_ERROR_USAGE, "region_alone");
        for (y = 0, differ = 0; y < 10; ++y) differ += memcmp(part + y * 80, rgba + 4 * ((y + 25) * WIDTH + 30), 80) != 0;
        CHECK(differ == 0);
    }
    halflit_renderer_destroy(renderer);
    free_cube(&cube);
}

static void test_same_as_cpp(void) {
    Cube cube = make_cube();
    halflit_scene* demo;
    halflit_camera camera;
    halflit_settings settings;
    float matrix[16];
    CHECK(draw_cube(NULL, &cube) == cube_by_cpp(corners, 8, indices, 36, 0, WIDTH, HEIGHT));
    place(matrix, 0.5f);
    CHECK_OK(halflit_scene_place_instance(cube.scene, cube.instance, matrix));
    CHECK(draw_cube(NULL, &cube) == cube_by_cpp(corners, 8, indices, 36, 0.5f, WIDTH, HEIGHT));
    CHECK_OK(halflit_scene_create_demo(&demo));
    halflit_lighting_destroy(init_setup(demo, &camera, &settings));
    CHECK(draw_chosen(demo, &camera, &settings) == scene_by_cpp(NULL, WIDTH, HEIGHT));
    halflit_scene_destroy(demo);
    free_cube(&cube);
}

// ---- scenes that change ------------------------------------------------------------------------------------------------

static void test_changes(void) {
    // Each change is drawn by a renderer that drew the scene before, and by a new scene made in that state.
    Cube cube = make_cube(), fresh;
    halflit_renderer* renderer;
    halflit_report report;
    float matrix[16], moved[8 * 3], min[3], max[3];
    halflit_instance found;
    const uint8_t texels[2 * 12] = {255, 255, 255, 255, 0, 0, 0, 255, 9, 9, 9, 9, 0, 0, 0, 255, 255, 255, 255, 255, 9, 9, 9, 9};
    halflit_material material;
    halflit_light light;
    halflit_mesh mesh;
    int32_t texture, i;
    uint64_t before, after;
    static uint8_t pixels[PIXELS * 4];
    halflit_target target = make_target(pixels);
    CHECK_OK(halflit_renderer_create(NULL, &renderer));
    before = draw_cube(renderer, &cube);
    CHECK(before != 0 && draw_cube(renderer, &cube) == before);
    report.size = sizeof report;

    place(matrix, 0.5f);
    for (i = 0; i < 3; ++i) CHECK_OK(halflit_scene_place_instance(cube.scene, cube.instance, matrix));
    fresh = make_cube();
    CHECK_OK(halflit_scene_place_instance(fresh.scene, fresh.instance, matrix));
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));
    found.size = sizeof found;
    CHECK_OK(halflit_scene_get_instance(cube.scene, 0, &found));
    CHECK(found.mesh == cube.mesh && found.material == -1 && found.visible == 1 && found.node == -1 && found.color[3] == 1);
    CHECK(memcmp(found.world_from_object, matrix, sizeof matrix) == 0);
    CHECK_OK(halflit_scene_get_bounds(cube.scene, min, max));
    CHECK(min[0] == -0.5f && max[0] == 1.5f && min[1] == -1 && max[2] == 1);

    for (i = 0; i < 8 * 3; ++i) moved[i] = corners[i] * (i % 3 == 1 ? 0.5f : 1.0f);
    CHECK_OK(halflit_scene_set_vertices(cube.scene, cube.mesh, moved, NULL, 8));
    init_cube_mesh(&mesh, fresh.material);
    mesh.positions = moved;
    CHECK_OK(halflit_scene_set_mesh(fresh.scene, fresh.mesh, &mesh));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));

    // With normals of its own the mesh is no longer flat.
    CHECK_OK(halflit_scene_set_vertices(cube.scene, cube.mesh, moved, corners, 8));
    mesh.normals = corners;
    CHECK_OK(halflit_scene_set_mesh(fresh.scene, fresh.mesh, &mesh));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));

    material.size = sizeof material;
    CHECK_OK(halflit_scene_get_material(cube.scene, cube.material, &material));
    CHECK(material.dielectric_reflectance == 0.04f);
    material.dielectric_reflectance = 0.5f;
    CHECK_OK(halflit_scene_set_material(cube.scene, cube.material, &material));
    CHECK_OK(halflit_scene_get_material(cube.scene, cube.material, &material));
    CHECK(material.dielectric_reflectance == 0.5f);
    CHECK(material.base_color[1] == 0.4f && material.lobe.power == 1.5f && material.name[0] == '\0');
    CHECK_OK(halflit_scene_add_texture(cube.scene, texels, 2, 2, 12, HALFLIT_COLOR_SRGB, &texture));
    material.base_color_texture.texture = texture;
    material.base_color[2] = 1.0f;
    CHECK_OK(halflit_scene_set_material(cube.scene, cube.material, &material));
    CHECK_OK(halflit_scene_add_texture(fresh.scene, texels, 2, 2, 12, HALFLIT_COLOR_SRGB, &texture));
    CHECK_OK(halflit_scene_set_material(fresh.scene, fresh.material, &material));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));

    CHECK_OK(halflit_light_init(&light, sizeof light));
    light.type = HALFLIT_LIGHT_POINT;
    light.position[1] = 3;
    light.color[0] = 4;
    CHECK_OK(halflit_scene_add_light(cube.scene, &light, NULL));
    CHECK_OK(halflit_scene_add_light(fresh.scene, &light, NULL));
    halflit_lighting_destroy(cube.lighting);
    halflit_lighting_destroy(fresh.lighting);
    cube.lighting = fresh.lighting = NULL;  // from now on by the scene's own light
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));

    place(matrix, -2);
    CHECK_OK(halflit_scene_add_instance(cube.scene, cube.mesh, matrix, &i));
    CHECK_OK(halflit_scene_add_instance(fresh.scene, fresh.mesh, matrix, NULL));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(i == 1 && after != before && after == draw_cube(NULL, &fresh));

    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    CHECK_OK(halflit_scene_clear_lights(fresh.scene));
    CHECK_OK(halflit_scene_add_default_lights(cube.scene, &cube.camera));
    CHECK_OK(halflit_scene_add_default_lights(fresh.scene, &fresh.camera));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));
    CHECK_OK(halflit_scene_add_studio(cube.scene, &cube.camera));  // there is light
    CHECK(draw_cube(renderer, &cube) == after);

    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    CHECK_OK(halflit_scene_clear_lights(fresh.scene));
    CHECK_OK(halflit_scene_add_studio(cube.scene, &cube.camera));
    CHECK_OK(halflit_scene_add_studio(fresh.scene, &fresh.camera));
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));
    CHECK_FAILS(halflit_scene_add_studio(fresh.scene, NULL), HALFLIT_ERROR_USAGE, "camera is null");
    CHECK_OK(halflit_scene_add_ground(cube.scene, &i));
    CHECK_OK(halflit_scene_add_ground(fresh.scene, NULL));
    CHECK(i == 2);
    before = after;
    after = draw_cube(renderer, &cube);
    CHECK(after != before && after == draw_cube(NULL, &fresh));

    // Nothing changed: nothing is prepared, which takes far less than a millisecond.
    CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, &report));
    CHECK(report.prepare_ms < 1000 && report.threads >= 1 && halflit_pixel_hash(pixels, sizeof pixels) == after);
    halflit_renderer_destroy(renderer);
    free_cube(&fresh);
    free_cube(&cube);
}

static const float kSquare[4 * 3] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};

/// A square of the material, without normals and tangents. Texture 0 is of tilted normals.
static halflit_scene* make_square(const halflit_material* material) {
    static const float uv[4 * 2] = {0, 1, 1, 1, 0, 0, 1, 0};
    static const uint32_t two[6] = {0, 1, 2, 2, 1, 3};
    static const uint8_t tilted[4] = {200, 128, 200, 255};
    halflit_scene* scene;
    halflit_mesh mesh;
    CHECK_OK(halflit_scene_create(&scene));
    CHECK_OK(halflit_scene_add_texture(scene, tilted, 1, 1, 0, HALFLIT_COLOR_LINEAR, NULL));
    CHECK_OK(halflit_scene_add_material(scene, material, NULL));
    halflit_mesh_init(&mesh, sizeof mesh);
    mesh.positions = kSquare;
    mesh.uv0 = uv;
    mesh.vertex_count = 4;
    mesh.indices = two;
    mesh.index_count = 6;
    mesh.material = 0;
    CHECK_OK(halflit_scene_add_mesh(scene, &mesh, NULL));
    CHECK_OK(halflit_scene_add_instance(scene, 0, NULL, NULL));
    return scene;
}

static void test_tangents_and_normals_follow_the_material(void) {
    // A material that becomes a normal map's after the mesh was added gives the same pixels as one that was from the start.
    uint64_t hashes[2] = {0, 1};
    int32_t late;
    for (late = 0; late < 2; ++late) {
        halflit_scene* scene;
        halflit_material material;
        halflit_camera camera;
        halflit_settings settings;
        halflit_material_init(&material, sizeof material);
        material.metallic = 0;
        material.unlit = late;
        material.normal_texture.texture = late ? -1 : 0;
        scene = make_square(&material);
        halflit_lighting_destroy(init_setup(scene, &camera, &settings));
        CHECK(draw_chosen(scene, &camera, &settings) != 0);
        material.unlit = 0;
        material.normal_texture.texture = 0;
        CHECK_OK(halflit_scene_set_material(scene, 0, &material));
        CHECK_OK(halflit_scene_set_vertices(scene, 0, kSquare, NULL, 4));
        hashes[late] = draw_chosen(scene, &camera, &settings);
        halflit_scene_destroy(scene);
    }
    CHECK(hashes[0] != 0 && hashes[0] == hashes[1]);
}

static void test_coats_have_normals_of_their_own(void) {
    // A coat's normal texture counts on a mesh without tangents.
    uint64_t hashes[2] = {0, 0};
    int32_t with;
    for (with = 0; with < 2; ++with) {
        halflit_scene* scene;
        halflit_material material;
        halflit_camera camera;
        halflit_settings settings;
        halflit_material_init(&material, sizeof material);
        material.metallic = 0;
        material.clearcoat = 1;
        material.clearcoat_roughness = 0.3f;
        material.clearcoat_normal_texture.texture = with - 1;
        scene = make_square(&material);
        halflit_lighting_destroy(init_setup(scene, &camera, &settings));
        hashes[with] = draw_chosen(scene, &camera, &settings);
        halflit_scene_destroy(scene);
    }
    CHECK(hashes[0] != 0 && hashes[0] != hashes[1]);
}

static void test_changed_meshes_suit_the_materials_of_their_instances(void) {
    // A square with a material of its own has the same pixels before and after its mesh is given again.
    uint64_t before;
    halflit_scene* scene;
    halflit_material material;
    halflit_camera camera;
    halflit_settings settings;
    halflit_instance instance;
    int32_t mapped;
    halflit_material_init(&material, sizeof material);
    material.unlit = 1;
    scene = make_square(&material);
    material.metallic = 0;
    material.unlit = 0;
    material.normal_texture.texture = 0;
    CHECK_OK(halflit_scene_add_material(scene, &material, &mapped));
    instance.size = sizeof instance;
    CHECK_OK(halflit_scene_get_instance(scene, 0, &instance));
    instance.material = mapped;
    CHECK_OK(halflit_scene_set_instance(scene, 0, &instance));
    halflit_lighting_destroy(init_setup(scene, &camera, &settings));
    before = draw_chosen(scene, &camera, &settings);
    CHECK_OK(halflit_scene_set_vertices(scene, 0, kSquare, NULL, 4));
    CHECK(draw_chosen(scene, &camera, &settings) == before);
    halflit_scene_destroy(scene);
}

static void test_environments(void) {
    Cube cube = make_cube();
    static float grey[16 * 8 * 3];
    halflit_environment_options options;
    halflit_counts counts;
    uint64_t by_grey, by_sky;
    int i;
    for (i = 0; i < 16 * 8 * 3; ++i) grey[i] = 0.5f;
    CHECK_OK(halflit_environment_options_init(&options, sizeof options));
    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    CHECK_OK(halflit_scene_set_environment(cube.scene, grey, 16, 8, NULL));
    by_grey = draw_cube(NULL, &cube);
    CHECK_OK(halflit_scene_set_sky(cube.scene, &options));
    cube.settings.background_environment = 1;
    by_sky = draw_cube(NULL, &cube);
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(by_grey != 0 && by_sky != 0 && by_sky != by_grey && counts.lights == 0);
    // The sky's suns go with it.
    cube.settings.background_environment = 0;
    CHECK_OK(halflit_scene_set_environment(cube.scene, grey, 16, 8, &options));
    CHECK(draw_cube(NULL, &cube) == by_grey);
    CHECK_FAILS(halflit_scene_set_environment(cube.scene, grey, 0, 8, NULL), HALFLIT_ERROR_USAGE, "0 x 8 pixels, expected 1 x 1 to");
    CHECK_FAILS(halflit_scene_set_environment(cube.scene, grey, 2147483647, 8, NULL), HALFLIT_ERROR_USAGE, "2147483647 x 8 pixels");
    CHECK_FAILS(halflit_scene_set_environment(cube.scene, grey, 16384, 2147483647, NULL), HALFLIT_ERROR_USAGE, "x 2147483647 pixels");
    grey[5] = -1;
    CHECK(halflit_scene_set_environment(cube.scene, grey, 16, 8, NULL) == HALFLIT_ERROR_BAD_INPUT);
    CHECK_FAILS(halflit_scene_load_environment(cube.scene, "no/such.hdr", NULL), HAS_FILES ? HALFLIT_ERROR_IO : HALFLIT_ERROR_USAGE,
                "no/such.hdr");
    CHECK(draw_cube(NULL, &cube) == by_grey);
    free_cube(&cube);
}

static void test_points_and_lines(void) {
    Cube cube = make_cube();
    const uint32_t edges[] = {0, 1, 1, 2, 2, 3, 3, 0};
    uint64_t triangles, lines, wide, points;
    halflit_counts counts;
    halflit_mesh mesh;
    triangles = draw_cube(NULL, &cube);
    init_cube_mesh(&mesh, 0);
    mesh.normals = NULL;
    mesh.indices = edges;
    mesh.index_count = 8;
    mesh.topology = HALFLIT_TOPOLOGY_LINES;
    CHECK_OK(halflit_scene_set_mesh(cube.scene, cube.mesh, &mesh));
    lines = draw_cube(NULL, &cube);
    cube.settings.line_width = 9;
    wide = draw_cube(NULL, &cube);
    mesh.indices = NULL;
    mesh.index_count = 0;
    mesh.topology = HALFLIT_TOPOLOGY_POINTS;
    CHECK_OK(halflit_scene_set_mesh(cube.scene, cube.mesh, &mesh));
    points = draw_cube(NULL, &cube);
    CHECK(lines != 0 && wide != 0 && points != 0);
    CHECK(lines != triangles && wide != lines && points != wide && points != triangles);
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(counts.triangles == 0);
    cube.settings.point_size = 0;
    CHECK(draw_cube(NULL, &cube) != 0);  // the size that closes a cloud
    cube.settings.point_size = -1;
    CHECK(draw_cube(NULL, &cube) == 0);
    CHECK(strstr(halflit_last_error(), "point_size") != NULL);
    free_cube(&cube);
}

/// Two Gaussians as a training program writes them: logits, logarithms, w first, and y points down.
static const char trained[] =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float f_dc_0\n"
    "property float f_dc_1\nproperty float f_dc_2\nproperty float opacity\nproperty float scale_0\nproperty float scale_1\n"
    "property float scale_2\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header\n"
    "0 0 0 1.5 -1 0 0 0 0 0 1 0 0 0\n3 -2 0.5 -1 1.5 0.25 80 0 0 0 2 0 0.5 1\n";

static void test_splats(void) {
    float positions[2 * 3] = {0, 0, 0, 3, -2, 0.5f};
    const float rotations[2 * 4] = {0, 0, 0, 1, 0, 0.5f, 1, 2}, scales[2 * 3] = {1, 1, 1, 1, 1, 1};
    const float opacities[2] = {0.5f, 1}, harmonics[2 * 3] = {1.5f, -1, 0, -1, 1.5f, 0.25f};
    const float upright[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    halflit_scene* scene = NULL;
    halflit_splats splats;
    halflit_mesh mesh;
    halflit_camera camera;
    halflit_settings settings;
    halflit_lighting* lighting;
    int32_t index = -1;
    uint64_t both, one;
    CHECK_OK(halflit_scene_create(&scene));
    CHECK_OK(halflit_splats_init(&splats, sizeof splats));
    splats.rotations = rotations, splats.scales = scales, splats.opacities = opacities, splats.harmonics = harmonics;
    CHECK_OK(halflit_mesh_init(&mesh, sizeof mesh));
    mesh.positions = positions, mesh.vertex_count = 2, mesh.topology = HALFLIT_TOPOLOGY_POINTS, mesh.splats = &splats;
    CHECK_OK(halflit_scene_add_mesh(scene, &mesh, &index));
    CHECK_OK(halflit_scene_add_instance(scene, index, upright, NULL));
    lighting = init_setup(scene, &camera, &settings);
    both = draw(NULL, scene, lighting, &camera, &settings);
    if (HAS_FILES) {
        halflit_scene* file = NULL;
        halflit_camera of_file;
        CHECK_OK(halflit_scene_load_memory(trained, sizeof trained - 1, "two.ply", NULL, NULL, &file));
        halflit_lighting_destroy(init_setup(file, &of_file, &settings));
        CHECK(memcmp(of_file.world_from_camera, camera.world_from_camera, sizeof camera.world_from_camera) == 0);
        CHECK(both != 0 && draw(NULL, file, lighting, &of_file, &settings) == both);
        halflit_scene_destroy(file);
    }
    CHECK_FAILS(halflit_scene_set_vertices(scene, index, positions, NULL, 2), HALFLIT_ERROR_USAGE, "mesh 0: has Gaussians");
    positions[3] = (float)NAN;  // that one is left out
    CHECK_OK(halflit_scene_set_mesh(scene, index, &mesh));
    one = draw(NULL, scene, lighting, &camera, &settings);
    mesh.vertex_count = 1;
    CHECK_OK(halflit_scene_set_mesh(scene, index, &mesh));
    CHECK(one != both && draw(NULL, scene, lighting, &camera, &settings) == one);
    mesh.normals = positions;
    CHECK_FAILS(halflit_scene_add_mesh(scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "halflit_mesh: splats: expected points");
    mesh.normals = NULL, mesh.topology = HALFLIT_TOPOLOGY_TRIANGLES, mesh.vertex_count = 0;
    CHECK_FAILS(halflit_scene_add_mesh(scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "halflit_mesh: splats: expected points");
    mesh.topology = HALFLIT_TOPOLOGY_POINTS, mesh.vertex_count = 2, splats.scales = NULL;
    CHECK_FAILS(halflit_scene_add_mesh(scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "halflit_splats: scales is null");
    splats.scales = scales, splats.degree = 5;
    CHECK_FAILS(halflit_scene_add_mesh(scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "degree is 5, expected 0 to 4");
    splats.degree = 0, splats.reference = 4;
    CHECK_FAILS(halflit_scene_add_mesh(scene, &mesh, NULL), HALFLIT_ERROR_USAGE, "reference is 4, expected 0 to 3");
    halflit_lighting_destroy(lighting);
    halflit_scene_destroy(scene);
}

static void test_scenes_and_variants(void) {
    halflit_scene* scene;
    halflit_load_options options;
    CHECK_OK(halflit_load_options_init(&options, sizeof options));
    CHECK(options.scene == NULL && options.variant == NULL);
    options.scene = "7";
    CHECK_FAILS(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &options, &scene), HALFLIT_ERROR_USAGE, "scene: ");
    options.scene = "0";
    options.variant = "red";
    CHECK_FAILS(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &options, &scene), HALFLIT_ERROR_USAGE,
                "variant: the file has none");
    options.variant = NULL;
    CHECK_OK(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &options, &scene));
    halflit_scene_destroy(scene);
}

static void test_animations(void) {
    halflit_scene *posed, *loaded;
    halflit_load_options options;
    halflit_counts counts;
    halflit_animation animation;
    halflit_camera camera, unused;
    halflit_settings settings, also_unused;
    halflit_instance placed;
    uint64_t before, after;
    CHECK_OK(halflit_load_options_init(&options, sizeof options));
    CHECK(options.animation == NULL && options.time_s == 0.0 && options.keep_animations == 0);
    CHECK_OK(halflit_scene_load_memory(animated_model, sizeof animated_model - 1, "slide", NULL, &options, &loaded));
    CHECK_FAILS(halflit_scene_pose(loaded, NULL, 0.5), HALFLIT_ERROR_USAGE, "keep_animations");
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_get_counts(loaded, &counts));
    CHECK(counts.animations == 1);
    animation.size = sizeof animation;
    CHECK_OK(halflit_scene_get_animation(loaded, 0, &animation));
    CHECK(strcmp(animation.name, "slide") == 0 && animation.end_s == 1.0 && animation.channels == 1);
    CHECK_FAILS(halflit_scene_get_animation(loaded, 1, &animation), HALFLIT_ERROR_USAGE, "animation 1, but the scene has 1");
    halflit_lighting_destroy(init_setup(loaded, &camera, &settings));
    before = draw_chosen(loaded, &camera, &settings);
    halflit_scene_destroy(loaded);

    options.keep_animations = 1;
    CHECK_OK(halflit_scene_load_memory(animated_model, sizeof animated_model - 1, "slide", NULL, &options, &posed));
    CHECK(before == draw_chosen(posed, &camera, &settings));
    CHECK_OK(halflit_scene_pose(posed, "slide", 0.25));
    placed.size = sizeof placed;
    CHECK_OK(halflit_scene_get_instance(posed, 0, &placed));
    CHECK(placed.world_from_object[12] == 0.5f && placed.node == 0);
    after = draw_chosen(posed, &camera, &settings);
    CHECK(after != before);
    options.animation = "0";
    options.time_s = 0.25;
    CHECK_OK(halflit_scene_load_memory(animated_model, sizeof animated_model - 1, "slide", NULL, &options, &loaded));
    halflit_lighting_destroy(init_setup(loaded, &unused, &also_unused));
    CHECK(after == draw_chosen(loaded, &camera, &settings));
    CHECK_OK(halflit_scene_pose(posed, "none", 0));
    CHECK(before == draw_chosen(posed, &camera, &settings));
    CHECK_FAILS(halflit_scene_pose(posed, "walk", 0), HALFLIT_ERROR_USAGE, "walk");
    {
        // Animations move what lies at the file's places: others are used for what the caller adds.
        int32_t added;
        CHECK_OK(halflit_scene_get_instance(posed, 0, &placed));
        CHECK_OK(halflit_scene_remove_instance(posed, 0));
        CHECK_OK(halflit_scene_add_instance(posed, placed.mesh, NULL, &added));
        counts.size = sizeof counts;
        CHECK_OK(halflit_scene_get_counts(posed, &counts));
        CHECK(added == counts.instances - 1 && added > 0);
        CHECK_OK(halflit_scene_pose(posed, "slide", 0.25));
        CHECK_OK(halflit_scene_get_instance(posed, added, &placed));
        CHECK(placed.world_from_object[12] == 0.0f);
    }
    CHECK_FAILS(halflit_scene_pose(NULL, NULL, 0), HALFLIT_ERROR_USAGE, "scene is null");
    halflit_scene_destroy(loaded);
    options.animation = "walk";
    CHECK(halflit_scene_load_memory(animated_model, sizeof animated_model - 1, "slide", NULL, &options, &loaded) == HALFLIT_ERROR_USAGE);
    halflit_scene_destroy(posed);
}

static void test_loading(void) {
    const char* path = "c_api_test.gltf";
    halflit_scene *from_file, *from_memory;
    halflit_load_options options;
    halflit_counts counts;
    halflit_material material;
    halflit_camera camera;
    halflit_settings settings;
    const char* text = NULL;
    uint64_t hash;
    FILE* file = fopen(path, "wb");
    CHECK(file != NULL);
    fwrite(model, 1, sizeof model - 1, file);
    fclose(file);
    CHECK_OK(halflit_scene_load(path, NULL, &from_file));
    CHECK_OK(halflit_load_options_init(&options, sizeof options));
    CHECK(options.threads == 0 && options.up == HALFLIT_UP_BY_FORMAT && options.recentre == 1 && options.crease_deg == 30);
    options.threads = -1;
    CHECK_FAILS(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &options, &from_memory), HALFLIT_ERROR_USAGE,
                "threads is -1, expected 0 to 4096");
    options.threads = 1;
    {
        const struct {
            double time_limit_s;
            float crease_deg;
            int32_t plate, threads;
            const char* says;
        } wrong[] = {{NAN, 30, 1, 1, "time_limit_s is not 0 or more"},  {-1, 30, 1, 1, "time_limit_s is not 0 or more"},
                     {0, NAN, 1, 1, "crease_deg is not from 0 to 180"}, {0, 181, 1, 1, "crease_deg is not from 0 to 180"},
                     {0, 30, -2, 1, "plate is -2, expected 0 or more"}, {0, 30, 1, 1000000000, "expected 0 to 4096"}};
        size_t i;
        for (i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
            halflit_load_options bad = options;
            bad.time_limit_s = wrong[i].time_limit_s, bad.crease_deg = wrong[i].crease_deg;
            bad.plate = wrong[i].plate, bad.threads = wrong[i].threads;
            CHECK_FAILS(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &bad, &from_memory), HALFLIT_ERROR_USAGE,
                        wrong[i].says);
        }
    }
    CHECK_OK(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, &options, &from_memory));
    halflit_lighting_destroy(init_setup(from_file, &camera, &settings));
    hash = draw_chosen(from_file, &camera, &settings);
    CHECK(hash != 0 && hash == scene_by_cpp(path, WIDTH, HEIGHT));
    halflit_lighting_destroy(init_setup(from_memory, &camera, &settings));
    CHECK(hash == draw_chosen(from_memory, &camera, &settings));
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_get_counts(from_file, &counts));
    CHECK(counts.triangles == 1 && counts.meshes == 2 && counts.instances == 2 && counts.materials == 2 && counts.cameras == 0);
    CHECK(counts.warnings == 1);
    CHECK_OK(halflit_scene_get_warning(from_file, 0, &text));
    CHECK(text != NULL && strlen(text) > 5);
    CHECK_FAILS(halflit_scene_get_warning(from_file, 1, &text), HALFLIT_ERROR_USAGE, "warning 1, but the scene has 1");
    CHECK_FAILS(halflit_scene_get_camera(from_file, 0, &camera), HALFLIT_ERROR_USAGE, "camera 0, but the scene has 0");
    material.size = sizeof material;
    CHECK_OK(halflit_scene_get_material(from_file, 0, &material));
    CHECK(strcmp(material.name, "paint") == 0 && material.base_color[0] == 0.9f && material.base_color_texture.texture == -1);
    material.base_color[0] = 0.1f;
    CHECK_OK(halflit_scene_set_material(from_file, 0, &material));
    CHECK_OK(halflit_scene_get_material(from_file, 0, &material));
    CHECK(strcmp(material.name, "paint") == 0 && material.base_color[0] == 0.1f);
    CHECK(hash != draw_chosen(from_file, &camera, &settings));

    // A buffer in another file is read from base_dir alone.
    {
        static char outside[sizeof model + 64];
        const char *uri = strstr(model, "data:"), *rest = strstr(uri, "\"}");
        const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        halflit_scene* scene = NULL;
        int length = sprintf(outside, "%.*sc_api_test.bin%s", (int)(uri - model), model, rest);
        file = fopen("c_api_test.bin", "wb");
        CHECK(file != NULL && fwrite(triangle, 1, sizeof triangle, file) == sizeof triangle);
        fclose(file);
        CHECK(halflit_scene_load_memory(outside, (size_t)length, "model", NULL, NULL, &scene) != HALFLIT_OK && scene == NULL);
        CHECK_OK(halflit_scene_load_memory(outside, (size_t)length, "model", ".", NULL, &scene));
        halflit_lighting_destroy(init_setup(scene, &camera, &settings));
        CHECK(hash == draw_chosen(scene, &camera, &settings));
        halflit_scene_destroy(scene);
    }
    options.max_file_bytes = 10;
    CHECK_FAILS(halflit_scene_load(path, &options, &from_file), HALFLIT_ERROR_LIMIT, path);
    halflit_scene_destroy(from_file);
    halflit_scene_destroy(from_memory);
}

static void test_cameras(void) {
    Cube cube = make_cube();
    halflit_scene* demo;
    halflit_camera camera;
    const float eye[3] = {0, 0, 5}, origin[3] = {0, 0, 0};
    halflit_camera_init(&camera, sizeof camera);
    camera.fov_y_rad = 0.5f;
    CHECK_OK(halflit_camera_look_at(eye, origin, NULL, &camera));
    CHECK(camera.world_from_camera[14] == 5 && camera.world_from_camera[0] == 1 && camera.fov_y_rad == 0.5f);
    CHECK(draw(NULL, cube.scene, NULL, &camera, NULL) != 0);
    CHECK_OK(halflit_camera_frame(cube.scene, 4.0f / 3.0f, 35, 20, 1, &camera));
    CHECK(memcmp(camera.world_from_camera, cube.camera.world_from_camera, sizeof camera.world_from_camera) == 0);
    CHECK_FAILS(halflit_camera_frame(cube.scene, 0, 35, 20, 1, &camera), HALFLIT_ERROR_USAGE, "aspect");
    CHECK_OK(halflit_scene_create_demo(&demo));
    CHECK_OK(halflit_scene_get_camera(demo, 0, &camera));
    CHECK(camera.name != NULL && draw(NULL, demo, NULL, &camera, NULL) != 0);
    halflit_scene_destroy(demo);
    free_cube(&cube);
}

static void test_views(void) {
    static const char* const names[] = {"front", "right", "top"};
    Cube cube = make_cube();
    halflit_view views[3], one;
    halflit_camera cameras[3], camera, last = {0};
    halflit_picture_request request;
    const double target[3] = {1, 2, 3};
    int32_t size[2];
    int i;
    for (i = 0; i < 3; ++i) {
        CHECK_OK(halflit_view_init(&views[i], sizeof views[i]));
        CHECK(views[i].azimuth_deg == 35 && views[i].elevation_deg == 20 && views[i].zoom == 1 && views[i].margin_x == 0.13);
        CHECK_OK(halflit_view_by_name(cube.scene, names[i], &views[i]));
        views[i].orthographic = 1;
        CHECK_OK(halflit_camera_init(&cameras[i], sizeof cameras[i]));
    }
    CHECK(views[1].azimuth_deg == 90 && views[1].elevation_deg == 0 && views[2].elevation_deg == 90);
    CHECK_OK(halflit_camera_views(cube.scene, 1, views, 3, cameras));
    for (i = 0; i < 3; ++i) CHECK(cameras[i].orthographic == 1 && cameras[i].half_height == cameras[0].half_height);
    CHECK(cameras[0].world_from_camera[10] == 1 && cameras[1].world_from_camera[8] == 1 && cameras[2].world_from_camera[9] == 1);
    // One view alone, and the same by a request.
    CHECK_OK(halflit_camera_init(&camera, sizeof camera));
    one = views[0];
    one.any_side = 1, one.margin_x = one.margin_y = 0.5;
    CHECK_OK(halflit_camera_view(cube.scene, 1, &one, &camera));
    CHECK(camera.half_height > 2 * cameras[0].half_height);  // the ball around the cube, with a wider margin
    CHECK_OK(halflit_picture_request_init(&request, sizeof request));
    CHECK_OK(halflit_camera_init(&last, sizeof last));
    request.width = request.height = 64;
    request.frame = request.orthographic = request.any_side = 1;
    request.azimuth_deg = request.elevation_deg = 0;
    request.margin_x = request.margin_y = 0.5;
    CHECK_OK(halflit_choose_picture(cube.scene, &request, size, &last, &cube.settings, NULL));
    CHECK(memcmp(last.world_from_camera, camera.world_from_camera, sizeof camera.world_from_camera) == 0 &&
          last.half_height == camera.half_height);
    request.margin_x = 0.95;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &request, size, &last, &cube.settings, NULL), HALFLIT_ERROR_USAGE, "margin_x");
    // The eye of an orbit is on the axis through the target.
    CHECK_OK(halflit_camera_orbit(target, 90, 0, 4, HALFLIT_UP_Y, &camera));
    CHECK(fabs(camera.world_from_camera[12] - 5) < 1e-5 && fabs(camera.world_from_camera[13] - 2) < 1e-5 &&
          fabs(camera.world_from_camera[14] - 3) < 1e-5);
    CHECK_OK(halflit_camera_orbit(target, 0, 90, 4, HALFLIT_UP_Z, &camera));
    CHECK(fabs(camera.world_from_camera[14] - 7) < 1e-5 && fabs(camera.world_from_camera[10] - 1) < 1e-6);
    // Faulty arguments.
    CHECK_FAILS(halflit_view_by_name(cube.scene, "side", &one), HALFLIT_ERROR_USAGE, "expected one of front, back");
    CHECK_FAILS(halflit_camera_views(cube.scene, 1, views, 0, cameras), HALFLIT_ERROR_USAGE, "count is 0");
    CHECK_FAILS(halflit_camera_views(cube.scene, NAN, views, 1, cameras), HALFLIT_ERROR_USAGE, "aspect");
    views[1].elevation_deg = 91;
    CHECK_FAILS(halflit_camera_views(cube.scene, 1, views, 3, cameras), HALFLIT_ERROR_USAGE, "elevation_deg");
    views[1].size -= 8;
    CHECK_FAILS(halflit_camera_views(cube.scene, 1, views, 3, cameras), HALFLIT_ERROR_USAGE, "differ");
    one.margin_y = NAN;
    CHECK_FAILS(halflit_camera_view(cube.scene, 1, &one, &camera), HALFLIT_ERROR_USAGE, "margin");
    CHECK_FAILS(halflit_camera_orbit(target, 0, 0, 0, HALFLIT_UP_Y, &camera), HALFLIT_ERROR_USAGE, "distance");
    CHECK_FAILS(halflit_camera_orbit(target, NAN, 0, 1, HALFLIT_UP_Y, &camera), HALFLIT_ERROR_USAGE, "azimuth_deg");
    CHECK_FAILS(halflit_camera_orbit(target, 0, 0, 1, HALFLIT_UP_BY_FORMAT, &camera), HALFLIT_ERROR_USAGE, "up is 0");
    cube.settings.edge_color[1] = 2;
    CHECK(draw_cube(NULL, &cube) == 0);
    CHECK(strstr(halflit_last_error(), "edge_color is not from 0 to 1") != NULL);
    free_cube(&cube);
}

// ---- execution ---------------------------------------------------------------------------------------------------------

typedef struct {
    const Cube* cube;
    halflit_renderer* renderer;
    int stop, loops, refused;
    long pixels;
    double share;
} Watch;

static int32_t watch_cancelled(void* user) { return ((Watch*)user)->stop; }
static void watch_tile(void* user, int32_t x, int32_t y, int32_t width, int32_t height) {
    Watch* watch = (Watch*)user;
    float matrix[16];
    (void)x, (void)y;
    watch->pixels += (long)width * height;
    place(matrix, 9);
    // Neither the scene nor the renderer of a frame can be changed from within it.
    watch->refused += halflit_scene_place_instance(watch->cube->scene, 0, matrix) == HALFLIT_ERROR_USAGE;
    watch->refused += halflit_renderer_set_execution(watch->renderer, NULL) == HALFLIT_ERROR_USAGE;
}
static void watch_progress(void* user, double share) { ((Watch*)user)->share = share; }
static void watch_loop(void* user, int32_t count, void (*body)(void* task, int32_t i), void* task) {
    ++((Watch*)user)->loops;
    while (count > 0) body(task, --count);
}
static void lazy_loop(void* user, int32_t count, void (*body)(void* task, int32_t i), void* task) {
    (void)user;
    body(task, count);  // the only call, of a part that does not exist
}

static volatile sig_atomic_t interrupts = 0;

static void count_interrupt(int number) {
    (void)number;
    ++interrupts;
}

static void raise_interrupt(void* user, double share) {
    (void)user, (void)share;
    if (interrupts == 0) raise(SIGINT);
}

static void raise_always(void* user, double share) {
    (void)user, (void)share;
    raise(SIGINT);
}

/// SIGINT stops a frame that asks for it. The process's own handler runs, and is back after the frame.
static void test_interrupt(void) {
    Cube cube = make_cube();
    const uint64_t expected = draw_cube(NULL, &cube);
    halflit_execution execution;
    halflit_renderer* renderer;
    CHECK_OK(halflit_execution_init(&execution, sizeof execution));
    CHECK(execution.stop_at_interrupt == 0);
    execution.progress = raise_interrupt;
    execution.tile_size = 16;
    execution.threads = 1;
    signal(SIGINT, count_interrupt);
    CHECK_OK(halflit_renderer_create(&execution, &renderer));
    CHECK(draw_cube(renderer, &cube) == expected && interrupts == 1);
    interrupts = 0;
    signal(SIGINT, count_interrupt);
    execution.stop_at_interrupt = 1;
    CHECK_OK(halflit_renderer_set_execution(renderer, &execution));
    {
        static uint8_t pixels[PIXELS * 4];
        const halflit_target target = make_target(pixels);
        CHECK_FAILS(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL),
                    HALFLIT_ERROR_CANCELLED, "stopped");
    }
    CHECK(interrupts == 1);
    CHECK(signal(SIGINT, SIG_DFL) == count_interrupt);
    CHECK(draw_cube(renderer, &cube) == expected);  // no signal comes, as one has been counted
    interrupts = 0;
    signal(SIGINT, SIG_IGN);
    execution.progress = raise_always;
    CHECK_OK(halflit_renderer_set_execution(renderer, &execution));
    CHECK(draw_cube(renderer, &cube) == expected);  // a process that ignores the signal goes on doing so
    CHECK(signal(SIGINT, SIG_DFL) == SIG_IGN);
    halflit_renderer_destroy(renderer);
    free_cube(&cube);
}

/// A frame that is drawn while another one is.
typedef struct {
    halflit_renderer* renderer;
    Cube cube;
    int is_stopped;  ///< it is to be
    int32_t code;    ///< of halflit_render(); -1: not drawn yet
} Inner;

static void other_handler(int number) {
    (void)number;
    interrupts += 100;
}

static void draw_inner(void* user, double share) {
    Inner* inner = (Inner*)user;
    static uint8_t pixels[PIXELS * 4];
    const halflit_target target = make_target(pixels);
    (void)share;
    if (inner->code != -1) return;
    if (inner->is_stopped)
        signal(SIGINT, other_handler);  // in the place of the library's
    else
        raise(SIGINT);
    inner->code =
        halflit_render(inner->renderer, inner->cube.scene, inner->cube.lighting, &inner->cube.camera, &inner->cube.settings, &target, NULL);
}

/// A signal stops the frames that are drawn when it comes, and no later one. A handler that is set meanwhile is called, and stays.
static void test_interrupt_of_overlapping_frames(void) {
    Cube cube = make_cube();
    Inner inner;
    halflit_execution execution;
    halflit_renderer* renderer;
    int i;
    inner.cube = make_cube();
    for (i = 0; i < 2; ++i) {
        static uint8_t pixels[PIXELS * 4];
        const halflit_target target = make_target(pixels);
        int32_t code;
        inner.is_stopped = i;
        inner.code = -1;
        interrupts = 0;
        CHECK_OK(halflit_execution_init(&execution, sizeof execution));
        execution.stop_at_interrupt = 1;
        execution.tile_size = 16;
        execution.threads = 1;
        if (inner.is_stopped) execution.progress = raise_always;
        CHECK_OK(halflit_renderer_create(&execution, &inner.renderer));
        execution.progress = draw_inner;
        execution.user = &inner;
        CHECK_OK(halflit_renderer_create(&execution, &renderer));
        signal(SIGINT, count_interrupt);
        code = halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL);
        CHECK(code == HALFLIT_ERROR_CANCELLED);
        CHECK(inner.code == (inner.is_stopped ? HALFLIT_ERROR_CANCELLED : 0));
        CHECK(inner.is_stopped ? interrupts >= 100 && interrupts % 100 == 0 : interrupts == 1);
        CHECK(signal(SIGINT, SIG_DFL) == (inner.is_stopped ? other_handler : count_interrupt));
        halflit_renderer_destroy(renderer);
        halflit_renderer_destroy(inner.renderer);
    }
    free_cube(&inner.cube);
    free_cube(&cube);
}

static void test_execution(void) {
    Cube cube = make_cube();
    const uint64_t expected = draw_cube(NULL, &cube);
    Watch watch = {NULL, NULL, 0, 0, 0, 0, 0};
    halflit_execution execution;
    CHECK_OK(halflit_execution_init(&execution, sizeof execution));
    CHECK(execution.threads == 0 && execution.tile_size == 64 && execution.isa == NULL);
    execution.user = &watch;
    execution.cancelled = watch_cancelled;
    execution.on_tile = watch_tile;
    execution.progress = watch_progress;
    execution.parallel_for = watch_loop;
    execution.tile_size = 16;
    execution.isa = "scalar";
    CHECK_OK(halflit_renderer_create(&execution, &watch.renderer));
    watch.cube = &cube;
    CHECK(draw_cube(watch.renderer, &cube) == expected);
    CHECK(watch.pixels == PIXELS && watch.share == 1.0 && watch.loops > 0 && watch.refused == 2 * 5 * 4);
    watch.stop = 1;
    CHECK(draw_cube(watch.renderer, &cube) == 0);
    {
        static uint8_t pixels[PIXELS * 4];
        const halflit_target target = make_target(pixels);
        CHECK_FAILS(halflit_render(watch.renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, NULL),
                    HALFLIT_ERROR_CANCELLED, "stopped");
    }
    watch.stop = 0;
    CHECK(draw_cube(watch.renderer, &cube) == expected);
    execution.parallel_for = lazy_loop;
    CHECK_OK(halflit_renderer_set_execution(watch.renderer, &execution));
    CHECK(draw_cube(watch.renderer, &cube) == 0);
    CHECK_OK(halflit_renderer_set_execution(watch.renderer, NULL));
    CHECK(draw_cube(watch.renderer, &cube) == expected);
    halflit_renderer_destroy(watch.renderer);

    // Two renderers draw one scene, which the first of them prepares.
    {
        Cube other = make_cube();
        CHECK(draw_by_two_threads(other.scene, other.lighting, &other.camera, &other.settings, WIDTH, HEIGHT, 10, expected) == 20);
        free_cube(&other);
    }
    // An error budget: the report has its bound.
    {
        static uint8_t pixels[PIXELS * 4];
        const halflit_target target = make_target(pixels);
        halflit_renderer* renderer;
        halflit_report report;
        report.size = sizeof report;
        cube.settings.max_error_codes = 0.5;
        cube.settings.tone_curve = HALFLIT_TONE_NONE;  // a curve's slope multiplies errors
        CHECK_OK(halflit_renderer_create(NULL, &renderer));
        CHECK_OK(halflit_render(renderer, cube.scene, cube.lighting, &cube.camera, &cube.settings, &target, &report));
        CHECK(report.error_budget == 0.5 && report.error_within == 1 && report.error_codes > 0 && report.error_codes <= 0.5);
        halflit_renderer_destroy(renderer);
    }
    free_cube(&cube);
}

/// Hash of what halflit_choose_picture() chooses for the scene.
static uint64_t draw_setup(halflit_scene* scene, const halflit_picture_request* options) {
    halflit_picture_request request;
    halflit_camera camera;
    halflit_settings settings;
    halflit_lighting* lighting = NULL;
    uint64_t hash;
    CHECK_OK(halflit_camera_init(&camera, sizeof camera));
    CHECK_OK(halflit_settings_init(&settings, sizeof settings));
    CHECK_OK(halflit_picture_request_init(&request, sizeof request));
    if (options != NULL) request = *options;
    request.width = WIDTH, request.height = HEIGHT;
    CHECK_OK(halflit_choose_picture(scene, &request, NULL, &camera, &settings, &lighting));
    hash = draw(NULL, scene, lighting, &camera, &settings);
    halflit_lighting_destroy(lighting);
    return hash;
}

static void test_setup(void) {
    // The same light, view and settings, however often they are chosen, and whatever was chosen in between.
    Cube cube = make_cube();
    halflit_picture_request options;
    halflit_light lamp;
    halflit_counts counts;
    const float sky[3] = {0.5f, 0.5f, 0.5f};
    int32_t size[2] = {0, 0};
    uint64_t first, other, lit;
    memset(&counts, 0, sizeof counts);
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    first = draw_setup(cube.scene, NULL);
    CHECK(first == draw_cube(NULL, &cube));
    CHECK_OK(halflit_picture_request_init(&options, sizeof options));
    CHECK(draw_setup(cube.scene, &options) == first);
    options.azimuth_deg = 80;
    other = draw_setup(cube.scene, &options);
    CHECK(other != first && draw_setup(cube.scene, &options) == other);
    CHECK(draw_setup(cube.scene, NULL) == first);
    options.azimuth_deg = 35;
    options.exposure = 0.5f;
    CHECK(draw_setup(cube.scene, &options) != first);
    other = draw_setup(cube.scene, &options);
    options.exposure = 0;
    options.exposure_compensation_ev = -1;  // the chosen one is 1
    CHECK(draw_setup(cube.scene, &options) == other);
    options.exposure = 0.25f, options.exposure_compensation_ev = 1;
    CHECK(draw_setup(cube.scene, &options) == other);
    options.exposure = 0, options.exposure_compensation_ev = 0;
    options.studio = HALFLIT_STUDIO_NEVER;
    CHECK(draw_setup(cube.scene, &options) != first);
    options.studio = HALFLIT_STUDIO_FOR_DARK;
    options.camera = &cube.camera;
    CHECK(draw_setup(cube.scene, &options) == first);

    // A light of the caller takes the place of what was chosen, and stays.
    CHECK_OK(halflit_light_init(&lamp, sizeof lamp));
    CHECK_OK(halflit_scene_add_light(cube.scene, &lamp, NULL));
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(counts.lights == 1);
    lit = draw_setup(cube.scene, NULL);
    CHECK(lit != first);
    options.studio = HALFLIT_STUDIO_UNDER_LIGHTS;
    other = draw_setup(cube.scene, &options);
    CHECK(other != lit && other != first && draw_setup(cube.scene, NULL) == lit);
    options.studio = HALFLIT_STUDIO_ALWAYS;
    CHECK(draw_setup(cube.scene, &options) != lit);
    CHECK_OK(halflit_scene_set_ambient(cube.scene, sky, sky));
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(counts.lights == 1);
    other = draw_setup(cube.scene, NULL);
    CHECK_OK(halflit_scene_set_ambient(cube.scene, (const float[3]){0, 0, 0}, (const float[3]){0, 0, 0}));
    options.studio = HALFLIT_STUDIO_FOR_DARK;
    options.own_ambient = 1;
    memcpy(options.ambient_color, sky, sizeof sky);
    CHECK(other != lit && draw_setup(cube.scene, &options) == other);
    CHECK_OK(halflit_scene_set_sky(cube.scene, NULL));
    CHECK(draw_setup(cube.scene, NULL) != other);
    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    CHECK(draw_setup(cube.scene, NULL) == first);

    options.studio = 4;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE, "studio is 4");
    options.studio = 0;
    options.exposure = -1;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE, "exposure");
    options.exposure = 0;
    options.exposure_compensation_ev = 65;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE,
                "exposure_compensation_ev");
    options.exposure_compensation_ev = 0;
    options.width = 8;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE, "no pixels");
    options.width = 0;
    options.camera = NULL;
    options.scene_camera = "3";
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE,
                "camera: the scene has no camera, found '3'");
    options.scene_camera = NULL;
    CHECK_OK(halflit_choose_picture(cube.scene, &options, size, &cube.camera, &cube.settings, NULL));
    CHECK(size[0] == 1280 && size[1] == 720);
    CHECK_FAILS(halflit_picture_request_init(NULL, 8), HALFLIT_ERROR_USAGE, "request is null");
    free_cube(&cube);
}

static void test_lights_of_the_caller(void) {
    // What halflit_choose_picture() adds is not in the scene.
    Cube cube = make_cube();
    halflit_light lamp;
    halflit_counts counts;
    uint64_t lit;
    memset(&counts, 0, sizeof counts);
    counts.size = sizeof counts;
    CHECK_OK(halflit_scene_clear_lights(cube.scene));
    lit = draw_setup(cube.scene, NULL);
    CHECK_OK(halflit_scene_get_counts(cube.scene, &counts));
    CHECK(counts.lights == 0);
    CHECK_OK(halflit_light_init(&lamp, sizeof lamp));
    CHECK_FAILS(halflit_scene_get_light(cube.scene, 0, &lamp), HALFLIT_ERROR_USAGE, "light 0");
    CHECK_FAILS(halflit_scene_set_light(cube.scene, 0, &lamp), HALFLIT_ERROR_USAGE, "light 0");
    CHECK(draw_cube(NULL, &cube) == lit);
    lamp.color[1] = 0.25f;
    CHECK_OK(halflit_scene_add_light(cube.scene, &lamp, NULL));
    lit = draw_setup(cube.scene, NULL);
    CHECK_OK(halflit_scene_get_light(cube.scene, 0, &lamp));
    CHECK(lamp.color[1] == 0.25f);
    CHECK_OK(halflit_scene_set_light(cube.scene, 0, &lamp));
    CHECK(draw_setup(cube.scene, NULL) == lit);
    free_cube(&cube);
}

static void test_numbers_that_are_none(void) {
    Cube cube = make_cube();
    halflit_picture_request options;
    halflit_light lamp;
    halflit_material clay;
    const float bad[3] = {0, NAN, 0}, black[3] = {0, 0, 0};
    CHECK_OK(halflit_light_init(&lamp, sizeof lamp));
    lamp.color[2] = INFINITY;
    CHECK_FAILS(halflit_scene_add_light(cube.scene, &lamp, NULL), HALFLIT_ERROR_USAGE, "halflit_light: color is not finite");
    CHECK_FAILS(halflit_scene_set_ambient(cube.scene, black, bad), HALFLIT_ERROR_USAGE, "ground is not finite");
    CHECK_OK(halflit_material_init(&clay, sizeof clay));
    clay.roughness = NAN;
    CHECK_FAILS(halflit_scene_set_material(cube.scene, 0, &clay), HALFLIT_ERROR_USAGE, "roughness");
    CHECK_OK(halflit_picture_request_init(&options, sizeof options));
    options.fov_y_deg = 500;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE,
                "fov_y_deg is not above 0 and below 180");
    options.fov_y_deg = 35;
    options.zoom = NAN;
    CHECK_FAILS(halflit_choose_picture(cube.scene, &options, NULL, &cube.camera, &cube.settings, NULL), HALFLIT_ERROR_USAGE, "zoom");
    CHECK_FAILS(halflit_camera_frame(cube.scene, 1, NAN, 20, 1, &cube.camera), HALFLIT_ERROR_USAGE, "azimuth_deg");
    CHECK_FAILS(halflit_camera_frame(cube.scene, 1, 35, 91, 1, &cube.camera), HALFLIT_ERROR_USAGE, "elevation_deg is not from -90 to 90");
    CHECK_FAILS(halflit_camera_frame(cube.scene, 1, 35, NAN, 1, &cube.camera), HALFLIT_ERROR_USAGE, "elevation_deg");
    cube.settings.background[0] = NAN;
    CHECK(draw_cube(NULL, &cube) == 0);
    CHECK(strstr(halflit_last_error(), "background is not finite") != NULL);
    free_cube(&cube);
}

static void test_parts_of_a_file(void) {
    // Nodes, their instances and names.
    halflit_scene* scene;
    halflit_counts counts;
    halflit_node node;
    halflit_instance instance;
    const char* name;
    CHECK_OK(halflit_scene_load_memory(model, sizeof model - 1, "model", NULL, NULL, &scene));
    counts.size = sizeof counts, node.size = sizeof node, instance.size = sizeof instance;
    CHECK_OK(halflit_scene_get_counts(scene, &counts));
    CHECK_OK(halflit_scene_get_node(scene, 0, &node));
    CHECK(counts.nodes >= 1 && node.parent == -1 && node.instance_count == 2 && node.camera == -1 && node.light == -1);
    CHECK_OK(halflit_scene_get_instance(scene, node.instances[1], &instance));
    CHECK(instance.node == 0 && instance.visible == 1);
    CHECK_OK(halflit_scene_get_name(scene, HALFLIT_PART_INSTANCE, 1, &name));
    CHECK(strcmp(name, node.name) == 0);
    CHECK_OK(halflit_scene_set_name(scene, HALFLIT_PART_INSTANCE, 1, "left wheel"));
    CHECK_OK(halflit_scene_get_name(scene, HALFLIT_PART_INSTANCE, 1, &name));
    CHECK(strcmp(name, "left wheel") == 0);
    CHECK_OK(halflit_scene_get_name(scene, HALFLIT_PART_MATERIAL, 0, &name));
    CHECK(strcmp(name, "paint") == 0);
    CHECK_FAILS(halflit_scene_get_name(scene, HALFLIT_PART_MESH, 7, &name), HALFLIT_ERROR_USAGE, "mesh 7, but the scene has 2");
    CHECK_FAILS(halflit_scene_set_name(scene, HALFLIT_PART_NODE, 0, "x"), HALFLIT_ERROR_USAGE,
                "expected an instance, a mesh or a material");
    CHECK_FAILS(halflit_scene_get_name(scene, 9, 0, &name), HALFLIT_ERROR_USAGE, "part: 9");
    CHECK_FAILS(halflit_scene_get_node(scene, 5, &node), HALFLIT_ERROR_USAGE, "node 5, but the scene has 1");
    halflit_scene_destroy(scene);
}

static void test_looks_of_instances(void) {
    // A colour is that of a material with the colour; what is hidden is not there.
    Cube cube = make_cube(), other = make_cube();
    halflit_instance instance;
    halflit_material material;
    const uint64_t before = draw_cube(NULL, &cube);
    instance.size = sizeof instance;
    CHECK_OK(halflit_scene_get_instance(cube.scene, 0, &instance));
    instance.color[0] = 0.5f, instance.color[2] = 0.25f;
    CHECK_OK(halflit_scene_set_instance(cube.scene, 0, &instance));
    material.size = sizeof material;
    CHECK_OK(halflit_scene_get_material(other.scene, 0, &material));
    material.base_color[0] *= 0.5f, material.base_color[2] *= 0.25f;
    CHECK_OK(halflit_scene_set_material(other.scene, 0, &material));
    CHECK(draw_cube(NULL, &cube) == draw_cube(NULL, &other) && draw_cube(NULL, &cube) != before);
    instance.visible = 0;
    CHECK_OK(halflit_scene_set_instance(cube.scene, 0, &instance));
    CHECK_OK(halflit_scene_remove_instance(other.scene, 0));
    CHECK(draw_cube(NULL, &cube) == draw_cube(NULL, &other));
    instance.visible = 1, instance.color[0] = instance.color[2] = 1;
    CHECK_OK(halflit_scene_set_instance(cube.scene, 0, &instance));
    CHECK(draw_cube(NULL, &cube) == before);
    instance.material = 4;
    CHECK_FAILS(halflit_scene_set_instance(cube.scene, 0, &instance), HALFLIT_ERROR_USAGE, "material 4, but the scene has 1");
    instance.material = 0, instance.color[1] = NAN;
    CHECK_FAILS(halflit_scene_set_instance(cube.scene, 0, &instance), HALFLIT_ERROR_USAGE, "color is not finite");
    free_cube(&cube);
    free_cube(&other);
}

static void test_up(void) {
    // A scene in a world with z up has the picture, and in its own world the parts, of the same scene with y up.
    static uint8_t pixels[2][PIXELS * 4];
    static float normals[2][PIXELS * 3], positions[2][PIXELS * 3];
    const float sides[8 * 3] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, -1, -1, 3, 1, -1, 3, -1, 1, 3, 1, 1, 3};
    const float eye[2][3] = {{4, 5, 6}, {4, -6, 5}}, target_at[2][3] = {{0, 1, 0}, {0, 0, 1}}, ups[2][3] = {{0, 1, 0}, {0, 0, 1}};
    int32_t z;
    for (z = 0; z < 2; ++z) {
        halflit_scene* scene;
        halflit_mesh mesh;
        halflit_camera camera, chosen;
        halflit_settings settings;
        halflit_picture_request request;
        halflit_lighting* lighting;
        halflit_renderer* renderer;
        halflit_target target = make_target(pixels[z]);
        halflit_instance instance;
        halflit_light lamp, found;
        float matrix[16], min[3], max[3];
        int32_t i;
        CHECK_OK(halflit_scene_create(&scene));
        if (z) CHECK_OK(halflit_scene_set_up(scene, HALFLIT_UP_Z));
        init_cube_mesh(&mesh, -1);
        mesh.positions = sides;
        CHECK_OK(halflit_scene_add_mesh(scene, &mesh, NULL));
        memset(matrix, 0, sizeof matrix);
        matrix[0] = matrix[15] = 1;
        if (z) matrix[5] = matrix[10] = 1, matrix[12] = 0.5f, matrix[13] = -0.25f;
        if (!z) matrix[6] = -1, matrix[9] = 1, matrix[12] = 0.5f, matrix[14] = 0.25f;  // y and z of the mesh become -z and y
        CHECK_OK(halflit_scene_add_instance(scene, 0, matrix, NULL));
        CHECK_OK(halflit_light_init(&lamp, sizeof lamp));
        lamp.direction[0] = 1, lamp.direction[1] = z ? 0.5f : -2, lamp.direction[2] = z ? -2 : -0.5f;
        CHECK_OK(halflit_scene_add_light(scene, &lamp, NULL));
        CHECK_OK(halflit_camera_init(&camera, sizeof camera));
        CHECK_OK(halflit_camera_init(&chosen, sizeof chosen));
        CHECK_OK(halflit_settings_init(&settings, sizeof settings));
        CHECK_OK(halflit_camera_look_at(eye[z], target_at[z], ups[z], &camera));
        CHECK_OK(halflit_picture_request_init(&request, sizeof request));
        request.camera = &camera;
        CHECK_OK(halflit_choose_picture(scene, &request, NULL, &chosen, &settings, &lighting));
        for (i = 0; i < 16; ++i) CHECK(chosen.world_from_camera[i] == camera.world_from_camera[i]);
        target.normal = normals[z], target.position = positions[z];
        CHECK_OK(halflit_renderer_create(NULL, &renderer));
        CHECK_OK(halflit_render(renderer, scene, lighting, &camera, &settings, &target, NULL));
        instance.size = sizeof instance, found.size = sizeof found;
        CHECK_OK(halflit_scene_get_instance(scene, 0, &instance));
        CHECK(memcmp(instance.world_from_object, matrix, sizeof matrix) == 0);
        CHECK_OK(halflit_scene_get_light(scene, 0, &found));
        CHECK(found.direction[1] == lamp.direction[1] && found.direction[2] == lamp.direction[2]);
        CHECK_OK(halflit_scene_get_bounds(scene, min, max));
        CHECK(max[z ? 2 : 1] == 3 && min[0] == -0.5f && max[z ? 1 : 2] == (z ? 0.75f : 1.25f));
        CHECK_FAILS(halflit_scene_set_up(scene, HALFLIT_UP_Y), HALFLIT_ERROR_USAGE, "without instances");
        halflit_renderer_destroy(renderer);
        halflit_lighting_destroy(lighting);
        halflit_scene_destroy(scene);
    }
    CHECK(halflit_pixel_hash(pixels[0], sizeof pixels[0]) == halflit_pixel_hash(pixels[1], sizeof pixels[1]));
    {
        int32_t wrong = 0, i;
        for (i = 0; i < PIXELS; ++i) {
            const float *n = normals[0] + 3 * i, *m = normals[1] + 3 * i, *p = positions[0] + 3 * i, *q = positions[1] + 3 * i;
            wrong += n[0] != m[0] || n[1] != m[2] || n[2] != -m[1] || p[0] != q[0] || p[1] != q[2] || p[2] != -q[1];
        }
        CHECK(wrong == 0);
    }
}

static void test_removal(void) {
    Cube cube = make_cube();
    const uint8_t white[4] = {255, 255, 255, 255};
    const uint64_t before = draw_cube(NULL, &cube);
    halflit_renderer* renderer;
    halflit_instance instance;
    halflit_light lamp;
    halflit_mesh mesh;
    int32_t index;
    instance.size = sizeof instance;
    CHECK_OK(halflit_renderer_create(NULL, &renderer));
    CHECK(draw_cube(renderer, &cube) == before);
    CHECK_FAILS(halflit_scene_remove_mesh(cube.scene, cube.mesh), HALFLIT_ERROR_USAGE, "mesh 0: instance 0 places it");
    CHECK_OK(halflit_scene_remove_instance(cube.scene, cube.instance));
    CHECK(draw_cube(renderer, &cube) != before);
    CHECK_FAILS(halflit_scene_remove_instance(cube.scene, cube.instance), HALFLIT_ERROR_USAGE, "instance 0 was removed");
    CHECK_FAILS(halflit_scene_get_instance(cube.scene, cube.instance, &instance), HALFLIT_ERROR_USAGE, "instance 0 was removed");
    CHECK_OK(halflit_scene_remove_mesh(cube.scene, cube.mesh));
    CHECK_FAILS(halflit_scene_add_instance(cube.scene, cube.mesh, NULL, NULL), HALFLIT_ERROR_USAGE, "mesh 0 was removed");
    (void)draw_cube(renderer, &cube);
    init_cube_mesh(&mesh, cube.material);
    CHECK_OK(halflit_scene_add_mesh(cube.scene, &mesh, &index));
    CHECK(index == cube.mesh);
    CHECK_OK(halflit_scene_add_instance(cube.scene, cube.mesh, NULL, &index));
    CHECK(index == cube.instance && draw_cube(renderer, &cube) == before);

    CHECK_OK(halflit_scene_add_texture(cube.scene, white, 1, 1, 0, HALFLIT_COLOR_SRGB, &index));
    CHECK_OK(halflit_scene_remove_texture(cube.scene, index));
    CHECK_FAILS(halflit_scene_set_texture(cube.scene, index, white, 1, 1, 0, HALFLIT_COLOR_SRGB), HALFLIT_ERROR_USAGE, "was removed");
    CHECK(draw_cube(renderer, &cube) == before);
    CHECK_OK(halflit_light_init(&lamp, sizeof lamp));
    CHECK_OK(halflit_scene_add_light(cube.scene, &lamp, &index));
    CHECK_OK(halflit_scene_remove_light(cube.scene, index));
    CHECK_FAILS(halflit_scene_place_instances(cube.scene, NULL, -1, (const float*)&lamp), HALFLIT_ERROR_USAGE, "count: -1");
    CHECK_FAILS(halflit_scene_get_light(cube.scene, index, &lamp), HALFLIT_ERROR_USAGE, "light 0 was removed");
    CHECK(draw_setup(cube.scene, NULL) == before);
    CHECK_OK(halflit_scene_add_light(cube.scene, &lamp, &index));
    CHECK(index == 0);
    halflit_renderer_destroy(renderer);
    free_cube(&cube);
}

static void test_many_instances(void) {
    Cube cube = make_cube(), other = make_cube();
    float places[3 * 16];
    const int32_t indices_of[2] = {2, 1};
    int32_t first, i;
    for (i = 0; i < 3; ++i) place(places + 16 * i, 0.25f * (float)i);
    CHECK_OK(halflit_scene_add_instances(cube.scene, cube.mesh, 3, places, &first));
    CHECK(first == 1);
    for (i = 0; i < 3; ++i) CHECK_OK(halflit_scene_add_instance(other.scene, other.mesh, places + 16 * i, NULL));
    CHECK(draw_cube(NULL, &cube) == draw_cube(NULL, &other));
    CHECK_OK(halflit_scene_place_instances(cube.scene, indices_of, 2, places));
    for (i = 0; i < 2; ++i) CHECK_OK(halflit_scene_place_instance(other.scene, indices_of[i], places + 16 * i));
    CHECK(draw_cube(NULL, &cube) == draw_cube(NULL, &other));
    CHECK_FAILS(halflit_scene_place_instances(cube.scene, NULL, 5, places), HALFLIT_ERROR_USAGE, "instance 4, but the scene has 4");
    CHECK_FAILS(halflit_scene_add_instances(cube.scene, cube.mesh, -1, places, NULL), HALFLIT_ERROR_USAGE, "count: -1");
    free_cube(&cube);
    free_cube(&other);
}

typedef struct {
    char first[8];
    size_t count;
    int calls;
} Written;

typedef struct {
    void* bytes;
    size_t count;
} Kept;

static void take_bytes(void* user, const void* bytes, size_t count) {
    Written* const written = user;
    memcpy(written->first, bytes, sizeof written->first);
    written->count = count;
    ++written->calls;
}

static void test_encoding(void) {
    static uint8_t pixels[PIXELS * 4];
    halflit_target target = make_target(pixels);
    Written written = {{0}, 0, 0};
    if (!HAS_FILES) return;
    CHECK_OK(halflit_encode_image("png", &target, take_bytes, &written));
    CHECK(written.calls == 1 && written.count > 50 && memcmp(written.first, "\x89PNG", 4) == 0);
    CHECK_OK(halflit_encode_image("jpg", &target, take_bytes, &written));
    CHECK(written.calls == 2 && memcmp(written.first, "\xff\xd8", 2) == 0);
    CHECK_FAILS(halflit_encode_image("exr", &target, take_bytes, &written), HALFLIT_ERROR_USAGE, "exr");
    CHECK_FAILS(halflit_encode_image("gif", &target, take_bytes, &written), HALFLIT_ERROR_USAGE, "unknown file extension");
    CHECK_FAILS(halflit_encode_image("png", &target, NULL, NULL), HALFLIT_ERROR_USAGE, "write is null");
}

static void test_smooth_normals(void) {
    // A smooth cube is lit as one whose normals point out of its corners, also after it was deformed.
    Cube cube = make_cube(), given = make_cube();
    float normals[8 * 3], moved[8 * 3];
    halflit_mesh mesh;
    int i;
    uint64_t flat = draw_cube(NULL, &cube), smooth;
    init_cube_mesh(&mesh, cube.material);
    mesh.smooth = 1;
    CHECK_OK(halflit_scene_set_mesh(cube.scene, cube.mesh, &mesh));
    smooth = draw_cube(NULL, &cube);
    CHECK(smooth != flat);
    for (i = 0; i < 24; ++i) moved[i] = 2 * corners[i];
    CHECK_OK(halflit_scene_set_vertices(cube.scene, cube.mesh, moved, NULL, 8));
    CHECK(draw_cube(NULL, &cube) != smooth);
    CHECK_OK(halflit_scene_set_vertices(cube.scene, cube.mesh, corners, NULL, 8));
    CHECK(draw_cube(NULL, &cube) == smooth);
    for (i = 0; i < 24; ++i) normals[i] = corners[i];
    mesh.normals = normals, mesh.smooth = 0;
    CHECK_OK(halflit_scene_set_mesh(given.scene, given.mesh, &mesh));
    CHECK(draw_cube(NULL, &given) != flat);
    free_cube(&cube);
    free_cube(&given);
}

static void test_recentre(void) {
    // A triangle at x = 2^20, drawn there and at the origin.
    static char far_model[sizeof model + 64];
    const char* const node = strstr(model, "{\"mesh\":0}");
    halflit_load_options options;
    halflit_scene* scene;
    double origin[3], scale;
    int32_t up;
    float min[3], max[3];
    double low[3], high[3], place_at[16];
    halflit_instance instance, again;
    again.size = sizeof again;
    sprintf(far_model, "%.*s{\"mesh\":0,\"translation\":[1048576,0,0]}%s", (int)(node - model), model, node + strlen("{\"mesh\":0}"));
    CHECK_OK(halflit_load_options_init(&options, sizeof options));
    options.recentre = 0;
    CHECK_OK(halflit_scene_load_memory(far_model, strlen(far_model), "far", NULL, &options, &scene));
    CHECK_OK(halflit_scene_get_placement(scene, origin, &scale, NULL));
    CHECK_OK(halflit_scene_get_bounds(scene, min, max));
    CHECK(origin[0] == 0 && scale == 1 && min[0] == 1048576);
    halflit_scene_destroy(scene);
    options.recentre = 1;
    CHECK_OK(halflit_scene_load_memory(far_model, strlen(far_model), "far", NULL, &options, &scene));
    CHECK_OK(halflit_scene_get_placement(scene, origin, &scale, &up));
    CHECK_OK(halflit_scene_get_placement(scene, NULL, NULL, NULL));
    CHECK(up == HALFLIT_UP_Y);
    CHECK(origin[0] > 1048575 && origin[0] < 1048578 && scale == 1);
    // Coordinates are the file's all the same: to a 2^-20th, which float32 does not have there. It has 2^-22 near 2, where the scene is
    // drawn.
    CHECK_OK(halflit_scene_get_bounds(scene, min, max));
    CHECK(min[0] == 1048576);
    CHECK_OK(halflit_scene_get_box(scene, low, high));
    CHECK(low[0] == 1048576);
    memset(place_at, 0, sizeof place_at);
    place_at[0] = place_at[5] = place_at[10] = place_at[15] = 1, place_at[12] = 1048576 - 1.0 / 1048576;
    CHECK_OK(halflit_scene_place_instances_double(scene, NULL, 1, place_at));
    CHECK_OK(halflit_scene_get_box(scene, low, high));
    CHECK(fabs(low[0] - place_at[12]) < 2.5e-7);  // the model's other instance stays
    instance.size = sizeof instance;
    CHECK_OK(halflit_scene_get_instance(scene, 0, &instance));
    CHECK(fabs((double)instance.world_from_object[12] + instance.place_rest[0] - place_at[12]) < 1e-7);
    CHECK_OK(halflit_scene_set_instance(scene, 0, &instance));
    CHECK_OK(halflit_scene_get_instance(scene, 0, &again));
    CHECK(memcmp(&instance, &again, sizeof again) == 0);
    CHECK_FAILS(halflit_scene_get_placement(NULL, origin, &scale, &up), HALFLIT_ERROR_USAGE, "scene is null");
    halflit_scene_destroy(scene);
}

static void test_files_with_z_up(void) {
    // A tetrahedron of sides 1, 2 and 3 as STL, whose z points up by custom.
    static const char solid[] =
        "solid t\n"
        "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 2 0 vertex 1 0 0 endloop endfacet\n"
        "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 3 endloop endfacet\n"
        "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 3 vertex 0 2 0 endloop endfacet\n"
        "facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 2 0 vertex 0 0 3 endloop endfacet\n"
        "endsolid t\n";
    static float positions[PIXELS * 3], normals[PIXELS * 3];
    static uint32_t instances[PIXELS];
    const float eye[3] = {4, 5, 6}, target_at[3] = {0.3f, 0.5f, 1}, above[3] = {0, 0, 1};
    halflit_scene *scene, *other;
    halflit_camera camera, found;
    halflit_renderer* renderer;
    halflit_settings settings;
    halflit_target target = make_target(NULL);
    halflit_view view;
    float min[3], max[3];
    int32_t up, i, first, count, seen = 0, wrong = 0;
    if (!HAS_FILES) return;
    CHECK_OK(halflit_scene_load_memory(solid, strlen(solid), "t.stl", NULL, NULL, &scene));
    CHECK_OK(halflit_scene_get_placement(scene, NULL, NULL, &up));
    CHECK_OK(halflit_scene_get_bounds(scene, min, max));
    CHECK(up == HALFLIT_UP_Z && min[0] == 0 && min[1] == 0 && min[2] == 0 && max[0] == 1 && max[1] == 2 && max[2] == 3);
    CHECK_OK(halflit_camera_init(&camera, sizeof camera));
    CHECK_OK(halflit_camera_look_at(eye, target_at, above, &camera));
    CHECK_OK(halflit_settings_init(&settings, sizeof settings));
    CHECK_OK(halflit_renderer_create(NULL, &renderer));
    target.position = positions, target.normal = normals, target.instance = instances;
    CHECK_OK(halflit_render(renderer, scene, NULL, &camera, &settings, &target, NULL));
    for (i = 0; i < PIXELS; ++i) {
        const float *p = positions + 3 * i, *n = normals + 3 * i;
        if (instances[i] == 0) continue;
        ++seen;
        // From there the face x + y / 2 + z / 3 = 1 alone is seen.
        wrong += fabs(p[0] + p[1] / 2.0 + p[2] / 3.0 - 1) > 1e-5 || fabs(n[0] - 6 / 7.0) > 1e-5 || fabs(n[1] - 3 / 7.0) > 1e-5;
    }
    CHECK(seen > 50 && wrong == 0);
    // From the top it looks along -z.
    CHECK_OK(halflit_view_init(&view, sizeof view));
    CHECK_OK(halflit_view_by_name(scene, "top", &view));
    CHECK_OK(halflit_camera_init(&found, sizeof found));
    CHECK_OK(halflit_camera_view(scene, 1, &view, &found));
    CHECK(fabs(found.world_from_camera[10] - 1) < 1e-6 && found.world_from_camera[14] > 3);
    // Added to a scene with y up, it keeps its coordinates; an empty scene takes its up.
    CHECK_OK(halflit_scene_create(&other));
    CHECK_OK(halflit_scene_set_up(other, HALFLIT_UP_Y));
    CHECK_OK(halflit_scene_add_file_memory(other, solid, strlen(solid), "t.stl", NULL, NULL, NULL, &first, &count));
    CHECK_OK(halflit_scene_get_bounds(other, min, max));
    CHECK_OK(halflit_scene_get_placement(other, NULL, NULL, &up));
    CHECK(first == 0 && count == 1 && up == HALFLIT_UP_Y && max[0] == 1 && max[1] == 2 && max[2] == 3);
    halflit_scene_destroy(other);
    CHECK_OK(halflit_scene_create(&other));
    CHECK_OK(halflit_scene_add_file_memory(other, solid, strlen(solid), "t.stl", NULL, NULL, NULL, NULL, NULL));
    CHECK_OK(halflit_scene_get_placement(other, NULL, NULL, &up));
    CHECK(up == HALFLIT_UP_Z);
    halflit_scene_destroy(other);
    halflit_renderer_destroy(renderer);
    halflit_scene_destroy(scene);
}

static void keep_bytes(void* user, const void* bytes, size_t count) {
    Kept* const kept = user;
    kept->bytes = malloc(count);
    kept->count = count;
    memcpy(kept->bytes, bytes, count);
}

static void test_saved_scenes(void) {
    Cube cube = make_cube();
    const uint64_t before = draw_cube(NULL, &cube);
    Kept kept = {NULL, 0}, again = {NULL, 0};
    size_t cut;
    halflit_scene* scene;
    Cube same = cube;
    CHECK_OK(halflit_scene_save(cube.scene, keep_bytes, &kept));
    CHECK_OK(halflit_scene_create(&scene));
    CHECK_OK(halflit_scene_restore(scene, kept.bytes, kept.count));
    same.scene = scene;
    CHECK(draw_cube(NULL, &same) == before);
    CHECK_OK(halflit_scene_save(scene, keep_bytes, &again));  // equal scenes have equal bytes
    CHECK(again.count == kept.count && memcmp(again.bytes, kept.bytes, kept.count) == 0);
    free(again.bytes);
    for (cut = 0; cut < kept.count; cut += 1 + cut / 3)
        CHECK_FAILS(halflit_scene_restore(scene, kept.bytes, cut), HALFLIT_ERROR_BAD_INPUT, "expected the bytes of a scene");
    ((unsigned char*)kept.bytes)[kept.count / 2] ^= 4;
    CHECK_FAILS(halflit_scene_restore(scene, kept.bytes, kept.count), HALFLIT_ERROR_BAD_INPUT, "expected the bytes of a scene");
    CHECK_FAILS(halflit_scene_restore(scene, NULL, 5), HALFLIT_ERROR_USAGE, "bytes is null");
    CHECK_FAILS(halflit_scene_save(scene, NULL, NULL), HALFLIT_ERROR_USAGE, "write is null");
    CHECK(draw_cube(NULL, &same) == before);
    free(kept.bytes);
    halflit_scene_destroy(scene);
    free_cube(&cube);
}

/// Bytes that were changed, with the hash that suits them, are refused, or make a scene that can be drawn.
static void test_forged_scenes(void) {
    Cube cube = make_cube();
    Cube forged = cube;
    Kept kept = {NULL, 0};
    size_t at, size;
    int refused = 0, drawn = 0;
    CHECK_OK(halflit_scene_save(cube.scene, keep_bytes, &kept));
    size = kept.count - sizeof(uint64_t);
    CHECK_OK(halflit_scene_create(&forged.scene));
    for (at = 0; at < size; at += 1 + size / 400) {
        unsigned char* const byte = (unsigned char*)kept.bytes + at;
        const unsigned char before = *byte;
        uint64_t hash;
        *byte ^= 0x83;
        hash = halflit_pixel_hash(kept.bytes, size);
        memcpy((unsigned char*)kept.bytes + size, &hash, sizeof hash);
        if (halflit_scene_restore(forged.scene, kept.bytes, kept.count) == HALFLIT_OK) {
            drawn += draw_cube(NULL, &forged) != 0;
        } else {
            CHECK(strstr(halflit_last_error(), "expected the bytes of a scene") != NULL);
            ++refused;
        }
        *byte = before;
    }
    CHECK(refused > 20 && drawn > 20);
    free(kept.bytes);
    halflit_scene_destroy(forged.scene);
    free_cube(&cube);
}

static void test_calls(void) {
    halflit_scene* scene = NULL;
    halflit_answer* answer = NULL;
    int32_t width = 0, height = 0;
    CHECK_OK(halflit_scene_create_demo(&scene));
    CHECK_OK(halflit_call("look", "{\"size\": [64, 48], \"view\": [\"front\", \"iso\"]}", scene, &answer));
    CHECK(strstr(halflit_answer_report(answer), "\"schema\":\"halflit.look/1\"") != NULL);
    CHECK(halflit_answer_notes(answer)[0] != '\0');
    CHECK(halflit_answer_picture(answer, &width, &height) != NULL && width > 64 && height > 48);
    halflit_answer_destroy(answer);
    // The picture of a call is that of the frame.
    CHECK_OK(halflit_call("render", "{\"path\": \"demo\", \"size\": \"64x48\", \"hidden_edges\": \"dashed\"}", NULL, &answer));
    CHECK(halflit_answer_picture(answer, &width, NULL) != NULL && width == 64 && halflit_answer_is_good(answer) == 1);
    halflit_answer_destroy(answer);
    CHECK_OK(halflit_call("measure", NULL, scene, &answer));
    CHECK(halflit_answer_picture(answer, &width, &height) == NULL && width == 0 && height == 0);
    halflit_answer_destroy(answer);
    CHECK_FAILS(halflit_call("loook", NULL, scene, &answer), HALFLIT_ERROR_USAGE, "did you mean look");
    CHECK_FAILS(halflit_call("look", "[]", scene, &answer), HALFLIT_ERROR_USAGE, "JSON object");
    CHECK_FAILS(halflit_call("look", "{", scene, &answer), HALFLIT_ERROR_USAGE, "JSON object");
    CHECK_FAILS(halflit_call("look", "{\"path\": \"demo\"}", scene, &answer), HALFLIT_ERROR_USAGE, "either a scene or the path");
    CHECK_FAILS(halflit_call("look", "{}", NULL, &answer), HALFLIT_ERROR_USAGE, "'path'");
    CHECK_FAILS(halflit_call(NULL, "{}", scene, &answer), HALFLIT_ERROR_USAGE, "name is null");
    CHECK_OK(halflit_call_check("render", "{\"azimuth\": 20}"));
    CHECK_OK(halflit_call_check("render", "{\"path\": \"there_is_none.stl\", \"azimuth\": 20}"));
    CHECK_OK(halflit_call_check("compare", "{\"a\": \"x.stl\", \"b\": \"y.stl\", \"max\": 2}"));
    CHECK_FAILS(halflit_call_check("compare", "{\"a\": \"x.stl\"}"), HALFLIT_ERROR_USAGE, "'b'");
    CHECK_FAILS(halflit_call("compare", "{\"a\": \"x.stl\", \"b\": \"y.stl\"}", scene, &answer), HALFLIT_ERROR_USAGE,
                "either a scene or the path");
    CHECK_FAILS(halflit_call("measure", "{\"path\": \"a--b --c.stl\"}", NULL, &answer), HALFLIT_ERROR_IO, "a--b --c.stl");
    CHECK_FAILS(halflit_call_check("render", "{\"azimuth\": 20, \"camera\": 0}"), HALFLIT_ERROR_USAGE, "cannot be combined");
    halflit_answer_destroy(NULL);
    halflit_scene_destroy(scene);
}

static void test_values_as_text(void) {
    halflit_settings settings;
    float color[4];
    uint16_t codes[3];
    double range[2];
    const float depth[3] = {2.0f, INFINITY, 4.0f};
    CHECK_OK(halflit_settings_init(&settings, sizeof settings));
    CHECK_OK(halflit_settings_read(&settings, "tone_curve", "aces"));
    CHECK(settings.tone_curve == HALFLIT_TONE_ACES);
    CHECK_OK(halflit_settings_read(&settings, "shadow_size", "auto"));
    CHECK_FAILS(halflit_settings_read(&settings, "edge_width", "99"), HALFLIT_ERROR_USAGE, "edge_width: expected a number from 0.25 to 64");
    CHECK_FAILS(halflit_settings_read(&settings, "edge_widht", "1"), HALFLIT_ERROR_USAGE, "unknown setting");
    CHECK_OK(halflit_read_color("Red", color));
    CHECK(color[0] == 1.0f && color[1] == 0.0f && color[3] == 1.0f);
    CHECK_FAILS(halflit_read_color("rot", color), HALFLIT_ERROR_USAGE, "expected a colour");
    CHECK_OK(halflit_depth_codes(depth, 3, codes, range));
    CHECK(codes[0] == 1 && codes[1] == 0 && codes[2] == 65535 && range[0] == 2.0 && range[1] == 4.0);
}

/// A box of the size 1 around the origin, seen from a distance of 4 along y, in memory as MuJoCo 2.2.2 has it.
static void test_mujoco(void) {
    unsigned char geom[248] = {0}, cameras[2 * 56] = {0};
    const int32_t type = 6, none = -1, segid = 41, objtype = 5, objid = 7;
    const float ones[3] = {1, 1, 1}, gray[4] = {0.5f, 0.5f, 0.5f, 1}, upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const float camera[14] = {0, -4, 0, 0, 1, 0, 0, 0, 1, 0, -0.04f, 0.04f, 0.1f, 50};
    float depth[2][WIDTH * HEIGHT];
    int32_t ids[WIDTH * HEIGHT], objects[2 * WIDTH * HEIGHT], i;
    uint8_t rgb[3 * WIDTH * HEIGHT];
    const int32_t middle = WIDTH * (HEIGHT / 2) + WIDTH / 2;
    halflit_mujoco_layout layout;
    halflit_mujoco_model model;
    halflit_mujoco_scene scene;
    halflit_mujoco_picture pictures[2];
    halflit_mujoco* mujoco = NULL;

    memcpy(geom, &type, 4), memcpy(geom + 4, &none, 4), memcpy(geom + 8, &objtype, 4), memcpy(geom + 12, &objid, 4);
    memcpy(geom + 20, &none, 4), memcpy(geom + 32, &segid, 4);
    memcpy(geom + 44, ones, 12), memcpy(geom + 68, upright, 36), memcpy(geom + 104, gray, 16);
    memcpy(cameras, camera, 56), memcpy(cameras + 56, camera, 56);
    CHECK_OK(halflit_mujoco_layout_init(&layout, sizeof layout));
    CHECK(layout.geom_size == 248 && layout.light_size == 84 && layout.camera_size == 56 && layout.geom_matid == -1);
    CHECK_OK(halflit_mujoco_model_init(&model, sizeof model));
    CHECK_OK(halflit_mujoco_scene_init(&scene, sizeof scene));
    scene.geoms = geom, scene.ngeom = 1, scene.camera = cameras;
    for (i = 0; i < 2; ++i) {
        CHECK_OK(halflit_mujoco_picture_init(&pictures[i], sizeof pictures[i]));
        pictures[i].scene = &scene, pictures[i].width = WIDTH, pictures[i].height = HEIGHT;
        pictures[i].depth = depth[i], pictures[i].depth_unit = i;
    }
    pictures[1].rgb = rgb, pictures[1].segid = ids, pictures[1].object = objects;

    CHECK_FAILS(halflit_mujoco_create(&model, "4.3", NULL, &mujoco), HALFLIT_ERROR_USAGE, "look: '4.3', expected");
    CHECK_FAILS(halflit_mujoco_create(NULL, "2.2.2", NULL, &mujoco), HALFLIT_ERROR_USAGE, "model is null");
    model.nmesh = 1;
    CHECK_FAILS(halflit_mujoco_create(&model, "2.2.2", NULL, &mujoco), HALFLIT_ERROR_BAD_INPUT, "mesh_vertadr is null");
    model.nmesh = 0, layout.geom_pos = 240, model.layout = &layout;
    CHECK_FAILS(halflit_mujoco_create(&model, "2.2.2", NULL, &mujoco), HALFLIT_ERROR_USAGE, "geom_pos is 240");
    model.layout = NULL;
    CHECK_OK(halflit_mujoco_create(&model, "2.2.2", NULL, &mujoco));
    CHECK_OK(halflit_mujoco_render(mujoco, pictures, 2));
    CHECK(fabsf(depth[1][middle] - 3) < 1e-4f && depth[1][0] == 50);
    CHECK(fabsf(depth[0][middle] - (float)(50 / 49.9 - 5 / 49.9 / 3)) < 1e-5f && depth[0][0] == 1);
    CHECK(ids[middle] == segid && ids[0] == -1 && objects[2 * middle] == objid && objects[2 * middle + 1] == objtype);
    CHECK(rgb[3 * middle] == 38 && rgb[0] == 0);  // without a light, 0.3 of the color
    CHECK_OK(halflit_mujoco_render(mujoco, pictures, 0));
    pictures[1].samples = 2;
    CHECK_FAILS(halflit_mujoco_render(mujoco, pictures, 2), HALFLIT_ERROR_USAGE, "samples is 2");
    pictures[1].samples = 1, pictures[1].scene = NULL;
    CHECK_FAILS(halflit_mujoco_render(mujoco, pictures, 2), HALFLIT_ERROR_USAGE, "scene is null");
    pictures[1].scene = &scene, pictures[0].depth_unit = 2;
    CHECK_FAILS(halflit_mujoco_render(mujoco, pictures, 2), HALFLIT_ERROR_USAGE, "depth_unit is 2");
    CHECK_FAILS(halflit_mujoco_render(mujoco, NULL, 1), HALFLIT_ERROR_USAGE, "pictures is null");
    CHECK_FAILS(halflit_mujoco_render(NULL, pictures, 1), HALFLIT_ERROR_USAGE, "mujoco is null");
    halflit_mujoco_destroy(mujoco);
    halflit_mujoco_destroy(NULL);
}

int main(void) {
    CHECK(halflit_last_error()[0] == '\0');
    CHECK(strchr(halflit_version(), '.') != NULL && halflit_pixel_epoch() >= 1);
    test_null_pointers();
    test_struct_sizes();
    test_points_of_triangles();
    test_faulty_arguments();
    test_formats();
    test_same_as_cpp();
    test_changes();
    test_tangents_and_normals_follow_the_material();
    test_coats_have_normals_of_their_own();
    test_changed_meshes_suit_the_materials_of_their_instances();
    test_environments();
    test_points_and_lines();
    test_splats();
    if (HAS_FILES) {
        test_loading();
        test_scenes_and_variants();
        test_animations();
        test_recentre();
        test_parts_of_a_file();
        test_files_with_z_up();
        test_calls();
        test_values_as_text();
        test_mujoco();
    }
    test_saved_scenes();
    test_forged_scenes();
    test_cameras();
    test_views();
    test_looks_of_instances();
    test_removal();
    test_up();
    test_many_instances();
    test_encoding();
    test_smooth_normals();
    test_setup();
    test_lights_of_the_caller();
    test_numbers_that_are_none();
    test_execution();
    test_interrupt();
    test_interrupt_of_overlapping_frames();
    printf("%d checks, %d failed\n", checks, failures);
    return failures == 0 && checks > 100 ? 0 : 1;
}
