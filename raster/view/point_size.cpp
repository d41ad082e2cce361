// The size of points at which they close the surface that they lie on.
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace halflit {

float closing_point_size(const Scene& scene, const Camera& camera, int width, int height) {
    const FpEnvironment environment_of_host;
    const float least = Settings{}.point_size;             // pixels
    constexpr double kOverlap = 1.6;                       // of the mean distance between points: those at random cover nine tenths then
    constexpr double kLayers = 2.0;                        // a body has a side that is seen and one that is not
    constexpr int kCells = 64;                             // on the longer side of the picture
    constexpr float kMostOfSide = 0.025f, kMost = 256.0f;  // of the shorter side; pixels
    const int longer = std::max(width, height), shorter = std::min(width, height);
    const Mat4 clip = raster::clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    const double cell_px = static_cast<double>(longer) / kCells;
    std::array<bool, std::size_t{kCells} * kCells> is_met{};
    std::size_t met = 0, points = 0;
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.topology != Topology::points) continue;
        const Mat4 clip_from_object = clip * instance.world_from_object;
        for (const std::uint32_t index : mesh.indices) {
            check();
            if (index >= mesh.positions.size()) continue;
            const Vec3f p = mesh.positions[index];
            const auto row = [&](float Vec4f::*of) {
                const auto& c = clip_from_object.c;
                return ((double{c[0].*of} * double{p.x} + double{c[1].*of} * double{p.y}) + double{c[2].*of} * double{p.z}) +
                       double{c[3].*of};
            };
            const double w = row(&Vec4f::w), x = (row(&Vec4f::x) / w + 1.0) * 0.5 * width, y = (1.0 - row(&Vec4f::y) / w) * 0.5 * height;
            if (!(w > 0.0 && x >= 0.0 && x < width && y >= 0.0 && y < height)) continue;
            ++points;
            const auto cell = static_cast<std::size_t>(y / cell_px) * kCells + static_cast<std::size_t>(x / cell_px);
            if (cell < is_met.size() && !is_met[cell]) is_met[cell] = true, ++met;
        }
    }
    if (points == 0) return least;
    const double distance = std::sqrt(kLayers * static_cast<double>(met) * cell_px * cell_px / static_cast<double>(points));
    return std::clamp(static_cast<float>(kOverlap * distance), least, std::clamp(kMostOfSide * static_cast<float>(shorter), least, kMost));
}

}  // namespace halflit
