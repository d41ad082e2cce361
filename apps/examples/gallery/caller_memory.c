// The caller's memory
// Four views of a model are drawn into the quarters of one BGRA picture; all targets have the whole picture's stride.
#include <halflit/halflit.h>

enum { WIDTH = 480, HEIGHT = 360 };
static uint8_t pixels[HEIGHT][WIDTH][4];

int main(int argc, char** argv) {
    halflit_scene* scene;
    halflit_renderer* renderer;
    if (argc < 2 || halflit_scene_load(argv[1], NULL, &scene) || halflit_renderer_create(NULL, &renderer)) return 1;
    halflit_picture_request request;
    halflit_target target;
    halflit_picture_request_init(&request, sizeof request), halflit_target_init(&target, sizeof target);
    target.width = request.width = WIDTH / 2, target.height = request.height = HEIGHT / 2;
    target.row_bytes = sizeof pixels[0], target.format = HALFLIT_FORMAT_BGRA8;
    for (int i = 0; i < 4; ++i) {
        halflit_camera camera = {.size = sizeof camera};
        halflit_settings settings = {.size = sizeof settings};
        halflit_lighting* lighting;
        request.azimuth_deg = (float)(90 * i), target.pixels = pixels[i / 2 * HEIGHT / 2][i % 2 * WIDTH / 2];
        if (halflit_choose_picture(scene, &request, NULL, &camera, &settings, &lighting)) return 1;
        if (halflit_render(renderer, scene, lighting, &camera, &settings, &target, NULL)) return 1;
        halflit_lighting_destroy(lighting);
    }
    target.pixels = pixels, target.width = WIDTH, target.height = HEIGHT;
    return halflit_write_image("quarters.png", &target);
}
