// A tone curve of one's own
// The frame is drawn as linear light in floats; the host turns it into codes: here stripes of equal light, as on a weather map.
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>

#include <algorithm>
#include <cmath>

using namespace halflit;

int main() {
    const Scene scene = demo_scene();
    Image light{480, 360, {}, std::vector<float>(4 * 480 * 360)}, image = Image::make(480, 360);
    if (!render(scene, scene.cameras[0], {.samples = 4, .exposure = 2}, light.target())) return 1;
    for (std::size_t i = 0; i < image.rgba8.size(); i += 4) {
        const float* rgb = &light.rgba_linear[i];
        const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        const float stop = std::clamp(5.5f + std::floor(2 * std::log2(std::max(luminance, 1e-6f))) / 2, 0.0f, 7.0f) / 7;  // half stops
        const float color[3] = {std::min(1.0f, 2 * stop), 1 - std::abs(2 * stop - 1), std::min(1.0f, 2 - 2 * stop)};
        for (std::size_t k = 0; k < 3; ++k) image.rgba8[i + k] = static_cast<std::uint8_t>(255 * color[k]);
        image.rgba8[i + 3] = 255;
    }
    return write_image("stops.png", image) ? 0 : 1;
}
