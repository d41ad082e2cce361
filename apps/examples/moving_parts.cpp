// Sixty frames with moving parts: a scene is prepared once and told what moves.   halflit_moving_parts OUT-%02d.png
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

#include <cstdio>

using namespace halflit;

namespace {

constexpr int kFrames = 60, kMoons = 7;
constexpr float kTurn = 6.2831853f;

Mat4 place_of_moon(int moon, int frame) {
    const float angle = kTurn * (static_cast<float>(moon) / kMoons + static_cast<float>(frame) / kFrames);
    return rotation(Vec3f{0.2f, 1, 0}, angle) * translation({2, 0, 0}) * rotation(Vec3f{1, 1, 0}, 3 * angle);
}

Result<void> draw_all(const char* pattern) {
    Scene scene;
    scene.meshes = {make_sphere(1.1f, 96, 48), make_box({0.3f, 0.3f, 0.3f})};
    scene.instances.push_back({0, {}});
    for (int moon = 0; moon < kMoons; ++moon) scene.instances.push_back({1, place_of_moon(moon, 0)});
    for (const Vec4f& color : {Vec4f{0.8f, 0.35f, 0.2f, 1}, Vec4f{0.3f, 0.5f, 0.8f, 1}}) {
        scene.materials.push_back({.name = "paint", .base_color = color, .metallic = 0, .roughness = 0.5f, .lobe = Lobe::valve()});
        scene.meshes[scene.materials.size() - 1].material = static_cast<int>(scene.materials.size()) - 1;
    }
    const Camera camera{.name = "front", .world_from_camera = look_at({0, 2.5f, 6}, {0, 0, 0})};
    add_default_lights(scene, camera);

    auto prepared = PreparedScene::make(scene);
    if (!prepared) return tl::unexpected(prepared.error());
    Renderer renderer;  // keeps its memory, and all that did not change, from frame to frame
    Image image{320, 240, std::vector<std::uint8_t>(320 * 240 * 4), {}};
    for (int frame = 0; frame < kFrames; ++frame) {
        SceneChanges changes;
        for (int moon = 0; moon < kMoons; ++moon) {
            const auto instance = static_cast<std::size_t>(1 + moon);
            scene.instances[instance].world_from_object = place_of_moon(moon, frame);
            changes.moved_instances.push_back(instance);
        }
        if (const auto updated = prepared->update(changes); !updated) return updated;
        const auto report = renderer.render(*prepared, camera, {.samples = 4}, {image.width, image.height, image.rgba8.data()});
        if (!report) return tl::unexpected(report.error());
        char name[512];
        std::snprintf(name, sizeof name, pattern, frame);
        if (const auto written = write_image(name, image); !written) return written;
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    const auto done = draw_all(argc > 1 ? argv[1] : "moving-%02d.png");
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done ? 0 : static_cast<int>(done.error().code);
}
