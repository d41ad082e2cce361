#include "bench/kernel_rows.hpp"
#include "halflit/image.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "tests/support/random.hpp"

#include <memory>

namespace halflit::bench {
namespace {

constexpr int kWidth = 960, kHeight = 540;
constexpr double kPixels = double{kWidth} * kHeight;

KernelRow encode_row() {
    constexpr int kCount = 4096;
    return {"sRGB codes", "pixel", kCount, [](Isa isa) -> std::function<void()> {
                struct Colours {
                    alignas(64) float channel[4][kCount];
                    alignas(64) std::uint32_t codes[kCount];
                };
                const auto data = std::make_shared<Colours>();
                test::Random random(6);
                for (auto& channel : data->channel)
                    for (float& value : channel) value = random.real32(0, 1);
                return [data, &kernels = shading::shade_kernels(isa)] {
                    const auto& c = data->channel;
                    kernels.encode_srgb8(c[0], c[1], c[2], c[3], 1.0f, data->codes, kCount);
                };
            }};
}

/// An unlit square that fills the picture: all of a frame but shading.
struct Frame {
    Scene scene;
    Camera camera;
    Renderer renderer;
    std::unique_ptr<PreparedScene> prepared;
    Image image{kWidth, kHeight, std::vector<std::uint8_t>(std::size_t{4} * kWidth * kHeight), {}};

    Frame() {
        scene.materials.emplace_back();
        scene.materials[0].unlit = true;
        scene.meshes.push_back(make_box({9, 9, 1}));
        scene.meshes[0].material = 0;
        scene.instances.push_back({0, {}});
        camera.world_from_camera = translation({0, 0, 4});
        prepared = std::make_unique<PreparedScene>(std::move(*PreparedScene::make(scene)));
    }
};

KernelRow frame_row(const char* name, int samples) {
    return {name, "pixel", kPixels, [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Frame>();
                return [data, isa, samples] {
                    Settings settings;
                    settings.samples = samples;
                    Execution execution{.threads = 1};
                    execution.isa = isa;
                    (void)data->renderer.render(*data->prepared, data->camera, settings, {kWidth, kHeight, data->image.rgba8.data()},
                                                execution);
                };
            }};
}

KernelRow png_row() {
    KernelRow row{"PNG of the demo scene", "pixel", kPixels, [](Isa) -> std::function<void()> {
                      const auto image =
                          std::make_shared<Image>(Image{kWidth, kHeight, std::vector<std::uint8_t>(std::size_t{4} * kWidth * kHeight), {}});
                      const Scene scene = demo_scene();
                      (void)render(scene, scene.cameras[0], {}, {kWidth, kHeight, image->rgba8.data()});
                      return [image] { (void)encode_image(*image, OutputFormat::png); };
                  }};
    row.every_set = false;
    return row;
}

}  // namespace

std::vector<KernelRow> output_rows() {
    return {encode_row(), frame_row("frame of an unlit square, 1 sample", 1), frame_row("the same, 4 samples: with their mean", 4),
            png_row()};
}

}  // namespace halflit::bench
