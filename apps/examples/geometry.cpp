// Geometry made by code
// A terrain of hills, lit by a low sun.   halflit_geometry OUT.png
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>

#include <cmath>
#include <cstdio>

using namespace halflit;

namespace {

constexpr int kSide = 160;  // vertices

float height(float x, float z) { return 0.35f * std::sin(2.1f * x) * std::cos(1.7f * z) + 0.1f * std::sin(5.3f * x + 4.1f * z); }

Mesh terrain() {
    Mesh mesh;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            const float x = 6.0f * static_cast<float>(i) / (kSide - 1) - 3, z = 6.0f * static_cast<float>(j) / (kSide - 1) - 3, e = 1e-2f;
            mesh.positions.push_back({x, height(x, z), z});
            mesh.normals.push_back({height(x - e, z) - height(x + e, z), 2 * e, height(x, z - e) - height(x, z + e)});
            if (i == 0 || j == 0) continue;
            const auto d = static_cast<std::uint32_t>(j * kSide + i), c = d - 1, b = d - kSide, a = b - 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});  // counter-clockwise, seen from above
        }
    mesh.material = 0;
    return mesh;
}

}  // namespace

int main(int argc, char** argv) {
    Scene scene;
    scene.meshes.push_back(terrain());
    scene.instances.push_back({0, Mat4::identity()});
    scene.materials.resize(1);
    scene.materials[0].base_color = {0.35f, 0.42f, 0.2f, 1};
    scene.materials[0].metallic = 0;
    scene.materials[0].double_sided = true;       // a surface without an underside: its back stops light too
    scene.materials[0].lobe = Lobe::sloan(0.4f);  // soft where the hills turn away from the sun
    scene.lights.resize(1);
    scene.lights[0].direction_ws = normalize_or({-1, -0.35f, -0.6f}, {0, -1, 0});  // the way the light travels
    scene.lights[0].color_linear = {1.5f, 1.2f, 0.8f};
    scene.ambient = {{0.10f, 0.16f, 0.28f}, {0.05f, 0.05f, 0.03f}};

    Camera camera;
    camera.world_from_camera = look_at({1.5f, 2.4f, 4.6f}, {0, -0.2f, 0});
    Image image = Image::make(480, 300);
    const Settings settings{.samples = 8, .background_linear = {0.35f, 0.5f, 0.75f, 1}};
    const auto report = render(scene, camera, settings, image.target());
    const auto done = report ? write_image(argc > 1 ? argv[1] : "geometry.png", image) : tl::unexpected(report.error());
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done ? 0 : static_cast<int>(done.error().code);
}
