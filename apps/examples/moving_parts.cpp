// Sixty frames with moving parts
// A scene is prepared once and told what moves.   halflit_moving_parts FOLDER
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

#include <cstdio>
#include <string>

using namespace halflit;

namespace {
constexpr int kFrames = 60, kMoons = 7;

Mat4 place_of_moon(int moon, int frame) {
    const float angle = 6.2831853f * (static_cast<float>(moon) / kMoons + static_cast<float>(frame) / kFrames);
    return rotation(Vec3f{0.2f, 1, 0}, angle) * translation({2, 0, 0}) * rotation(Vec3f{1, 1, 0}, 3 * angle);
}

Result<void> draw_all(const std::string& folder) {
    Scene scene;
    scene.meshes = {make_sphere(1.1f, 96, 48), make_box({0.3f, 0.3f, 0.3f})};
    scene.materials.resize(2);
    scene.materials[0].base_color = {0.8f, 0.35f, 0.2f, 1};
    scene.materials[1].base_color = {0.3f, 0.5f, 0.8f, 1};
    for (std::size_t i = 0; i < 2; ++i) {
        scene.materials[i].metallic = 0;
        scene.meshes[i].material = static_cast<int>(i);
    }
    scene.instances.push_back({0, {}});
    for (int moon = 0; moon < kMoons; ++moon) scene.instances.push_back({1, place_of_moon(moon, 0)});
    Camera camera;
    camera.world_from_camera = look_at({0, 2.5f, 6}, {0, 0, 0});
    add_default_lights(scene, camera);

    auto prepared = PreparedScene::make(scene);
    if (!prepared) return tl::unexpected(prepared.error());
    Renderer renderer;  // keeps its memory, and all that did not change, from frame to frame
    Image image = Image::make(320, 240);
    for (int frame = 0; frame < kFrames; ++frame) {
        SceneChanges changes;
        for (std::size_t i = 1; i < scene.instances.size(); ++i) {
            scene.instances[i].world_from_object = place_of_moon(static_cast<int>(i) - 1, frame);
            changes.changed_instances.push_back(i);
        }
        if (const auto updated = prepared->update(changes); !updated) return updated;
        const auto report = renderer.render(*prepared, camera, {.samples = 4}, image.target());
        if (!report) return tl::unexpected(report.error());
        const std::string name = (frame < 10 ? "frame-0" : "frame-") + std::to_string(frame) + ".png";
        if (const auto written = write_image(folder + "/" + name, image); !written) return written;
    }
    return {};
}
}  // namespace

int main(int argc, char** argv) {
    const auto done = draw_all(argc > 1 ? argv[1] : ".");
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done ? 0 : 1;
}
