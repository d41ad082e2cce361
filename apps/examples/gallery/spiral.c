// Instances from C
// Two hundred boxes on a spiral, placed by one call; size, view, light and exposure are chosen by the library.
#include <halflit/halflit.h>
#include <math.h>

static const float corners[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
static const uint32_t faces[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                                 1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7};
static float places[200][16];
static uint8_t pixels[360][480][4];

int main(void) {
    halflit_scene* scene;
    halflit_renderer* renderer;
    halflit_lighting* lighting;
    halflit_camera camera = {.size = sizeof camera};
    halflit_settings settings = {.size = sizeof settings};
    halflit_material paint;
    halflit_mesh box;
    halflit_picture_request request;
    halflit_target target;
    halflit_material_init(&paint, sizeof paint), halflit_mesh_init(&box, sizeof box);
    halflit_picture_request_init(&request, sizeof request), halflit_target_init(&target, sizeof target);
    for (int i = 0; i < 200; ++i) {
        const double c = cos(0.2 * i), s = sin(0.2 * i), radius = 9 - 0.03 * i;
        const double columns[16] = {c, 0, s, 0, 0, 0.35, 0, 0, -0.5 * s, 0, 0.5 * c, 0, radius * c, 0.05 * i, radius * s, 1};
        for (int k = 0; k < 16; ++k) places[i][k] = (float)columns[k];
    }
    paint.metallic = 0, paint.base_color[1] = 0.45f, paint.base_color[2] = 0.15f;
    box.positions = corners, box.vertex_count = 8, box.indices = faces, box.index_count = 36;
    request.width = target.width = 480, request.height = target.height = 360, request.elevation_deg = 40, target.pixels = pixels;
    int32_t code = halflit_scene_create(&scene) || halflit_renderer_create(NULL, &renderer) ||
                   halflit_scene_add_material(scene, &paint, &box.material) || halflit_scene_add_mesh(scene, &box, NULL) ||
                   halflit_scene_add_instances(scene, 0, 200, places[0], NULL) ||
                   halflit_choose_picture(scene, &request, NULL, &camera, &settings, &lighting) ||
                   halflit_render(renderer, scene, lighting, &camera, &settings, &target, NULL);
    return code ? 1 : halflit_write_image("spiral.png", &target);
}
