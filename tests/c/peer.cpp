#include "peer.h"

#include <halflit/auto_setup.hpp>
#include <halflit/gltf.hpp>
#include <halflit/renderer.hpp>

#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

using namespace halflit;

namespace {

std::uint64_t draw(Scene& scene, int width, int height, float moves) {
    const AutoSetup setup = auto_setup(scene, width, height);
    if (moves != 0.0f) scene.instances[0].world_from_object = translation({moves, 0, 0});
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height) * 4);
    return render(scene, setup.light, setup.camera, setup.settings, {width, height, pixels.data()}) ? pixel_hash(pixels) : 0;
}

}  // namespace

uint64_t cube_by_cpp(const float* positions, size_t vertex_count, const uint32_t* indices, size_t index_count, float moves, int32_t width,
                     int32_t height) {
    Scene scene;
    Material clay;
    clay.base_color = {1.0f, 0.4f, 0.2f, 1.0f};
    clay.metallic = 0;
    clay.lobe = Lobe::sloan(0.5f);
    scene.materials.push_back(clay);
    Mesh mesh;
    mesh.positions.resize(vertex_count);
    std::memcpy(static_cast<void*>(mesh.positions.data()), positions, vertex_count * sizeof(Vec3f));
    mesh.indices.assign(indices, indices + index_count);
    mesh.material = 0;
    generate_flat_normals(mesh);
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, {}});
    return draw(scene, width, height, moves);
}

uint64_t scene_by_cpp(const char* path, int32_t width, int32_t height) {
    if (path == nullptr) {
        Scene scene = demo_scene();
        return draw(scene, width, height, 0);
    }
    auto loaded = load_gltf(path);
    return loaded ? draw(loaded->scene, width, height, 0) : 0;
}

int32_t draw_by_two_threads(const halflit_scene* scene, const halflit_lighting* lighting, const halflit_camera* camera,
                            const halflit_settings* settings, int32_t width, int32_t height, int32_t frames, uint64_t expected) {
    std::atomic<int32_t> right{0};
    const auto work = [&] {
        halflit_renderer* renderer = nullptr;
        if (halflit_renderer_create(nullptr, &renderer) != HALFLIT_OK) return;
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height) * 4);
        halflit_target target;
        halflit_target_init(&target, sizeof target);
        target.width = width;
        target.height = height;
        target.pixels = pixels.data();
        for (int32_t frame = 0; frame < frames; ++frame)
            if (halflit_render(renderer, scene, lighting, camera, settings, &target, nullptr) == HALFLIT_OK &&
                pixel_hash(pixels) == expected)
                ++right;
        halflit_renderer_destroy(renderer);
    };
    { const std::jthread first(work), second(work); }
    return right;
}
