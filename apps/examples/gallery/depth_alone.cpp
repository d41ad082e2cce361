// Depth alone
// Without memory for colours nothing is shaded and no shadow map is drawn: the depth plane takes a part of a picture's time.
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>

#include <algorithm>
#include <cstdint>

using namespace halflit;

int main() {
    const Scene scene = demo_scene();
    std::vector<float> depth(480 * 360);
    Target target{.width = 480, .height = 360};
    target.depth = depth.data();
    if (!render(scene, scene.cameras[0], {}, target)) return 1;
    Image image = Image::make(480, 360);
    for (std::size_t i = 0; i < depth.size(); ++i) {  // near is bright; a line every half unit
        const float shade = std::clamp(1.5f - depth[i] / 14, 0.0f, 1.0f) * (static_cast<int>(depth[i] * 20) % 10 == 0 ? 0.6f : 1.0f);
        image.rgba8[4 * i] = image.rgba8[4 * i + 1] = image.rgba8[4 * i + 2] = static_cast<std::uint8_t>(255 * shade);
        image.rgba8[4 * i + 3] = 255;
    }
    return write_image("depth.png", image) ? 0 : 1;
}
