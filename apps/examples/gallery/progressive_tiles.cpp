// A picture that becomes sharper
// A preview of an eighth of the size comes first; then tiles of the full picture replace it. Here the last half is still missing.
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>

#include <cstring>

using namespace halflit;

int main() {
    const Scene demo = demo_scene();
    const auto scene = PreparedScene::make(demo);
    Renderer renderer;
    Image preview = Image::make(60, 45), image = Image::make(480, 360);
    if (!scene || !renderer.render(*scene, demo.cameras[0], {}, preview.target())) return 1;
    for (std::size_t i = 0; i < 480 * 360; ++i) std::memcpy(&image.rgba8[4 * i], &preview.rgba8[4 * (i / 480 / 8 * 60 + i % 480 / 8)], 4);
    for (int tile = 0; tile < 15; ++tile) {  // of 30; a window would be repainted after each, and end the loop when the view moves
        Settings settings{.samples = 4};
        settings.region = {tile % 6 * 80, tile / 6 * 72, 80, 72};  // pixels outside of it are not touched
        if (!renderer.render(*scene, demo.cameras[0], settings, image.target())) return 1;
    }
    return write_image("half_done.png", image) ? 0 : 1;
}
