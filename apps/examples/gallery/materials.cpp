// Metals and roughness
// Spheres from smooth to rough, of plastic and of two metals, in the built-in studio.
#include <halflit/auto_setup.hpp>
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

using namespace halflit;

int main() {
    Scene scene;
    scene.meshes.push_back(make_sphere(1, 96, 48));
    for (const Vec4f color : {Vec4f{0.1f, 0.35f, 0.75f, 1}, Vec4f{1, 0.77f, 0.34f, 1}, Vec4f{0.95f, 0.64f, 0.54f, 1}})
        for (int step = 0; step < 5; ++step) {
            const auto number = static_cast<int>(scene.materials.size()), row = number / 5;
            scene.materials.push_back({.base_color = color, .metallic = row ? 1.0f : 0.0f, .roughness = static_cast<float>(step) / 4});
            const Vec3f place{2.2f * static_cast<float>(step), -2.2f * static_cast<float>(row), 0};
            scene.instances.push_back({.mesh = 0, .world_from_object = translation(place), .material = number});
        }
    PictureRequest request;
    request.size = {480, 300}, request.view = {.azimuth_deg = 0, .elevation_deg = 0, .orthographic = true};
    const auto chosen = choose_picture(scene, request);
    Image image = Image::make(480, 300);
    return chosen && render(scene, chosen->light, chosen->camera, chosen->settings, image.target()) && write_image("materials.png", image)
               ? 0
               : 1;
}
