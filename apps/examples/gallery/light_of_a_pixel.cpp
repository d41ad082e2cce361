// Which light falls on a pixel
// explain_pixel() draws each light alone, for pixels along a row of spheres, and tells which one is the brightest.
#include <halflit/explain.hpp>
#include <halflit/image.hpp>

#include <cstdio>

using namespace halflit;

int main() {
    const Scene demo = demo_scene();
    const auto scene = PreparedScene::make(demo);
    Renderer renderer;
    Image image = Image::make(480, 270);
    if (!scene || !renderer.render(*scene, demo.cameras[0], {.samples = 4}, image.target())) return 1;
    for (int x = 88; x < 400; x += 76) {
        const auto story = explain_pixel(renderer, *scene, demo, demo.cameras[0], {.samples = 4}, {480, 270}, x, 168);
        if (!story || story->shares.empty()) return 1;
        std::printf("pixel %d: %s, light %zu gives red %.3f\n", x, story->material.name.c_str(), story->shares[0].index,
                    story->shares[0].linear[0]);
        for (int i = -4; i <= 4; ++i)  // a cross at the pixel
            for (const int at : {168 * 480 + x + i, (168 + i) * 480 + x}) image.rgba8[4 * static_cast<std::size_t>(at) + 1] = 255;
    }
    return write_image("pixels.png", image) ? 0 : 1;
}
