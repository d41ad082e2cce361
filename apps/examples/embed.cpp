// The shortest useful program: a model file in, a PNG out.   halflit_embed MODEL.glb OUT.png
#include "apps/io/atomic_file.hpp"
#include "apps/io/gltf_loader.hpp"
#include "apps/io/image_writer.hpp"
#include "raster/renderer.hpp"
#include "raster/scene/framing.hpp"

#include <cstdio>

namespace {

halflit::Result<void> render_file(const char* model, const char* picture) {
    using namespace halflit;
    auto loaded = io::load_gltf(model);
    if (!loaded) return tl::unexpected(loaded.error());
    raster::Scene& scene = loaded->scene;

    raster::Image image{640, 480, std::vector<std::uint8_t>(640 * 480 * 4), {}};
    const raster::Camera camera = raster::frame_scene(scene, 640.0f / 480.0f, {});
    if (scene.lights.empty()) raster::add_default_lights(scene, camera);
    const auto report = raster::render(scene, camera, {.samples = 4}, {image.width, image.height, image.rgba8.data()});
    if (!report) return tl::unexpected(report.error());

    const auto png = io::encode_image(image, io::OutputFormat::png);
    if (!png) return tl::unexpected(png.error());
    return io::write_file(picture, *png);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s MODEL.glb OUT.png\n", argv[0]);
        return static_cast<int>(halflit::ErrorCode::usage);
    }
    const auto done = render_file(argv[1], argv[2]);
    if (done) return 0;
    std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return static_cast<int>(done.error().code);
}
