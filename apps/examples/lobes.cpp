// Every named lobe
// Each lobe on a sphere, under one light from the right.   halflit_lobes OUT.png
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

#include <cstdio>
#include <string>

using namespace halflit;

int main(int argc, char** argv) {
    Scene scene;
    float x = 0;
    for (const NamedLobe& named : kNamedLobes) {
        const float wrap = named.takes_wrap ? kUsualWrap : named.wrap;
        Material clay;
        clay.name = std::string(named.name);
        clay.base_color = {0.85f, 0.8f, 0.75f, 1};
        clay.metallic = 0;
        clay.lobe = {wrap, named.power + named.power_per_wrap * wrap, named.normalize};
        const int index = static_cast<int>(scene.materials.size());
        Mesh sphere = make_sphere(1, 96, 48);
        sphere.material = index;
        scene.materials.push_back(clay);
        scene.meshes.push_back(std::move(sphere));
        scene.instances.push_back({index, translation({x, 0, 0})});
        x += 2.25f;
        std::printf("%-13s wrap %.2f, power %.2f, scale %.3f\n", clay.name.c_str(), static_cast<double>(clay.lobe.wrap),
                    static_cast<double>(clay.lobe.power), static_cast<double>(clay.lobe.scale()));
    }
    Light light;
    light.direction_ws = {-1, 0, 0};
    scene.lights.push_back(light);

    const float middle = (x - 2.25f) / 2;
    Camera camera;
    camera.orthographic = true;
    camera.half_height = 1.2f;
    camera.far_z = 20;
    camera.world_from_camera = look_at({middle, 0, 10}, {middle, 0, 0});

    Settings settings{.samples = 8, .background_linear = {0.03f, 0.035f, 0.04f, 1}};
    settings.shading.specular = SpecularModel::none;  // the diffuse lobes alone
    settings.shadows = ShadowMode::off;
    Image image = Image::make(760, 132);
    const auto report = render(scene, camera, settings, image.target());
    const auto done = report ? write_image(argc > 1 ? argv[1] : "lobes.png", image) : tl::unexpected(report.error());
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done ? 0 : static_cast<int>(done.error().code);
}
