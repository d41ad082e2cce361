// The hash of a picture from C
// The demo scene is drawn by one thread and by all; the program fails if the hashes of the pixels differ.
#include <halflit/halflit.h>
#include <inttypes.h>
#include <stdio.h>

static uint8_t pixels[360][480][4];

int main(void) {
    uint64_t hashes[2];
    halflit_scene* scene;
    halflit_camera camera = {.size = sizeof camera};
    halflit_settings settings = {.size = sizeof settings};
    halflit_target target;
    halflit_target_init(&target, sizeof target);
    target.width = 480, target.height = 360, target.pixels = pixels;
    if (halflit_scene_create_demo(&scene) || halflit_choose_picture(scene, NULL, NULL, &camera, &settings, NULL)) return 1;
    for (int i = 0; i < 2; ++i) {
        halflit_renderer* renderer;
        halflit_execution execution;
        halflit_execution_init(&execution, sizeof execution);
        execution.threads = i ? 0 : 1, execution.tile_size = i ? 64 : 16;
        if (halflit_renderer_create(&execution, &renderer)) return 1;
        if (halflit_render(renderer, scene, NULL, &camera, &settings, &target, NULL)) return 1;
        hashes[i] = halflit_pixel_hash(pixels, sizeof pixels);
        halflit_renderer_destroy(renderer);
    }
    printf("%016" PRIx64 "\n", hashes[0]);
    return hashes[0] == hashes[1] ? halflit_write_image("hash.png", &target) : 1;
}
