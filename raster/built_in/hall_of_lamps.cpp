#include "raster/built_in/hall_of_lamps.hpp"

#include "halflit/shapes.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace halflit::raster {
namespace {

constexpr int kSquares = 32, kMiddleSquare = kSquares / 2;  ///< squares on a side of the floor
constexpr float kSquare = 2.0f, kLampHeight = 0.8f, kRange = 3.0f;
constexpr int kPillars = 13, kMiddlePillar = kPillars / 2;  ///< pillars on a side
constexpr Vec3f kPillarHalf{0.2f, 0.6f, 0.2f};

/// Middle of the square in this column and row, at this height.
Vec3f square(int column, int row, float height) {
    return {kSquare * (static_cast<float>(column - kMiddleSquare) + 0.5f), height,
            kSquare * (static_cast<float>(row - kMiddleSquare) + 0.5f)};
}

/// Squares from the middle outwards, ring by ring.
std::vector<std::array<int, 2>> squares_outwards() {
    std::vector<std::array<int, 2>> squares;
    for (int row = 0; row < kSquares; ++row)
        for (int column = 0; column < kSquares; ++column) squares.push_back({column, row});
    const auto ring = [](std::array<int, 2> at) {
        return std::max(std::abs(2 * at[0] + 1 - kSquares), std::abs(2 * at[1] + 1 - kSquares));
    };
    std::stable_sort(squares.begin(), squares.end(), [&](const auto& a, const auto& b) { return ring(a) < ring(b); });
    return squares;
}

void add(Scene& scene, Mesh mesh, const char* name, Vec4f color, const std::vector<Vec3f>& places) {
    Material material;
    material.name = name;
    material.base_color = color;
    material.metallic = 0.0f;
    material.roughness = 0.6f;
    material.lobe = Lobe::sloan(0.3f);
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
    for (const Vec3f place : places) scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, translation(place)});
}

/// Camera above and in front, which looks 45 degrees down at the middle of the floor.
Camera camera_over_the_middle() {
    constexpr float kHalfRoot = 0.707106781f, kAbove = 8.5f;  // 1 / sqrt(2)
    Camera camera;
    camera.name = "middle";
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, kHalfRoot, -kHalfRoot, 0}, {0, kHalfRoot, kHalfRoot, 0}, {0, kAbove, kAbove, 1}}};
    camera.fov_y_rad = 0.55f;
    camera.near_z = 0.5f;
    return camera;
}

}  // namespace

Scene lights_scene(int lights, bool ranged) {
    Scene scene;
    add(scene, make_plane(0.5f * kSquare * kSquares, kSquares), "floor", {0.8f, 0.78f, 0.75f, 1}, {{0, 0, 0}});
    std::vector<Vec3f> pillars;
    for (int row = 0; row < kPillars; ++row)
        for (int column = 0; column < kPillars; ++column) {
            // Pillars are at every second corner of the squares, so that none stands below a light.
            const float x = 2 * kSquare * static_cast<float>(column - kMiddlePillar),
                        z = 2 * kSquare * static_cast<float>(row - kMiddlePillar);
            pillars.push_back({x, kPillarHalf.y, z});
        }
    add(scene, make_box(kPillarHalf), "pillar", {0.7f, 0.5f, 0.4f, 1}, pillars);
    const std::vector<std::array<int, 2>> squares = squares_outwards();
    constexpr Vec3f kColors[] = {{0.40f, 0.32f, 0.22f}, {0.22f, 0.34f, 0.42f}, {0.36f, 0.24f, 0.36f}};
    for (int i = 0; i < std::clamp(lights, 1, kMostHallLights); ++i) {
        const std::array<int, 2> at = squares[static_cast<std::size_t>(i)];
        Light lamp;
        lamp.type = LightType::point;
        lamp.position_ws = square(at[0], at[1], kLampHeight);
        lamp.color_linear = kColors[(at[0] + 2 * at[1]) % 3];
        lamp.range = ranged ? kRange : 0.0f;
        lamp.source_radius = 0.05f;
        scene.lights.push_back(lamp);
    }
    scene.cameras.push_back(camera_over_the_middle());
    return scene;
}

}  // namespace halflit::raster
