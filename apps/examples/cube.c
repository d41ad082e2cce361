// The C interface
// A cube from arrays is drawn into the program's own memory, moved, and drawn again.   halflit_cube OUT.png
#include <halflit/halflit.h>

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 240, ROW_BYTES = 2048 };  // rows as wide as the host's picture, which is larger
static uint8_t pixels[HEIGHT * ROW_BYTES];

static const float corners[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}};
static const uint32_t indices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                                     1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7};

static void check(int32_t code) {
    if (code == HALFLIT_OK) return;
    fprintf(stderr, "%s\n", halflit_last_error());
    exit(code);
}

int main(int argc, char** argv) {
    halflit_scene* scene;
    check(halflit_scene_create(&scene));
    halflit_material clay;
    halflit_material_init(&clay, sizeof clay);
    clay.base_color[1] = 0.4f, clay.base_color[2] = 0.2f, clay.metallic = 0;
    check(halflit_lobe_by_name("sloan", 0.5f, &clay.lobe));
    halflit_mesh mesh;
    halflit_mesh_init(&mesh, sizeof mesh);
    mesh.positions = corners[0], mesh.vertex_count = 8;
    mesh.indices = indices, mesh.index_count = 36;
    check(halflit_scene_add_material(scene, &clay, &mesh.material));
    int32_t cube, left;
    check(halflit_scene_add_mesh(scene, &mesh, &cube));
    check(halflit_scene_add_instance(scene, cube, NULL, NULL));
    float place[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, 0, 0, 1};
    check(halflit_scene_add_instance(scene, cube, place, &left));

    halflit_camera camera;
    halflit_settings settings;
    halflit_target target;
    halflit_camera_init(&camera, sizeof camera);
    halflit_settings_init(&settings, sizeof settings);
    halflit_target_init(&target, sizeof target);
    halflit_picture_request request;
    halflit_picture_request_init(&request, sizeof request);
    request.width = WIDTH, request.height = HEIGHT;
    halflit_lighting* lighting;
    check(halflit_choose_picture(scene, &request, NULL, &camera, &settings, &lighting));
    target.pixels = pixels, target.row_bytes = ROW_BYTES, target.format = HALFLIT_FORMAT_BGRA8;
    target.width = WIDTH, target.height = HEIGHT;

    halflit_renderer* renderer;
    check(halflit_renderer_create(NULL, &renderer));
    check(halflit_render(renderer, scene, lighting, &camera, &settings, &target, NULL));
    place[12] = -2.5f, place[13] = 0.5f;
    check(halflit_scene_place_instance(scene, left, place));
    check(halflit_render(renderer, scene, lighting, &camera, &settings, &target, NULL));
    check(halflit_write_image(argc > 1 ? argv[1] : "cube.png", &target));
    halflit_renderer_destroy(renderer);
    halflit_lighting_destroy(lighting);
    halflit_scene_destroy(scene);
    return 0;
}
