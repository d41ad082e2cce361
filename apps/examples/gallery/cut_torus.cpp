// A section made by code
// A plane cuts a torus in half; cut_scene() closes it with hatched caps and tells their areas.
#include <halflit/auto_setup.hpp>
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>
#include <halflit/section.hpp>
#include <halflit/shapes.hpp>

#include <cstdio>

using namespace halflit;

int main() {
    Scene scene;
    scene.meshes = {make_torus(1, 0.4f, 128, 64)};
    scene.materials = {{.base_color = {0.2f, 0.45f, 0.7f, 1}, .metallic = 0, .roughness = 0.4f}};
    scene.meshes[0].material = 0;
    scene.instances = {{.mesh = 0}};
    const CutPlane plane{{1, 0, 1}, 0};
    const auto report = cut_scene(scene, {&plane, 1}, {.hatch_spacing = 0.12});
    if (!report) return 1;
    std::printf("area of the caps: %.4f, of two circles: %.4f\n", report->area(), 2 * 3.14159265 * 0.4 * 0.4);
    PictureRequest request;
    request.size = {480, 360}, request.view = {.azimuth_deg = 60, .elevation_deg = 30};
    const auto chosen = choose_picture(scene, request);
    Image image = Image::make(480, 360);
    return chosen && render(scene, chosen->light, chosen->camera, chosen->settings, image.target()) && write_image("cut.png", image) ? 0
                                                                                                                                     : 1;
}
