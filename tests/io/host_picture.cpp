// HALFLIT_HOST: the function's name.
#include <halflit/auto_setup.hpp>
#include <halflit/image.hpp>
#include <halflit/model.hpp>
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::test {

std::uint64_t HALFLIT_HOST(const std::string& path) {
    constexpr int kSide = 96;
    auto loaded = load_model(path);
    if (!loaded) return 0;
    Scene& scene = loaded->scene;
    // Parts of the host's own, placed by the library's functions.
    Mesh shape = make_torus(0.7f, 0.3f, 24, 12);
    const Bounds bounds = scene_bounds(scene);
    scene.meshes.push_back(shape);
    Instance part;
    part.mesh = static_cast<int>(scene.meshes.size()) - 1;
    const float size = 0.25f * bounds.radius();
    part.world_from_object = translation(bounds.center()) * rotation(Vec3f{0.3f, 1.0f, 0.2f}, 0.7f) * scaling({size, size, size});
    scene.instances.push_back(part);
    const AutoSetup setup = auto_setup(scene, kSide, kSide);
    std::vector<std::uint8_t> pixels(std::size_t{4} * kSide * kSide);
    Target target;
    target.width = target.height = kSide;
    target.pixels = pixels.data();
    const auto report = render(scene, setup.light, setup.camera, setup.settings, target);
    return report ? pixel_hash(pixels) : 0;
}

}  // namespace halflit::test
