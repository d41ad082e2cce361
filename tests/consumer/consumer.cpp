// A host that embeds halflit: geometry by code, its own BGRA memory with padded rows, a part that moves.
#include <halflit/renderer.hpp>
#include <halflit/version.hpp>

#include <cstdio>
#include <vector>

int main() {
    using namespace halflit;
    Scene scene;
    Mesh triangle;
    triangle.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    triangle.normals.assign(3, {0, 0, 1});
    triangle.indices = {0, 1, 2};
    scene.meshes.push_back(triangle);
    scene.instances.push_back({0, Mat4::identity()});
    Camera camera;
    camera.world_from_camera = look_at({0, 0, 4}, {0, 0, 0});
    add_default_lights(scene, camera);

    constexpr int kWidth = 100, kHeight = 80;
    constexpr std::size_t kRowBytes = 4 * kWidth + 16;
    std::vector<std::uint8_t> first(kRowBytes * kHeight), second(first.size());
    Target target{kWidth, kHeight, first.data()};
    target.format = PixelFormat::bgra8;
    target.row_bytes = kRowBytes;

    auto prepared = PreparedScene::make(scene);
    Renderer renderer;
    if (!prepared || !renderer.render(*prepared, camera, {.samples = 4}, target)) return 1;
    scene.instances[0].world_from_object = rotation(Vec3f{0, 0, 1}, 1.0f);
    if (!prepared->update({.changed_instances = {0}})) return 2;
    target.pixels = second.data();
    const auto report = renderer.render(*prepared, camera, {.samples = 4}, target);
    if (!report) return 3;
    std::printf("halflit %s: %d pixels seen, the second picture %s\n", version(), static_cast<int>(report->pixels_visible),
                first == second ? "is the first" : "differs");
    return first == second ? 4 : 0;
}
