#include "raster/scene/shell.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <cmath>
#include <utility>

namespace halflit::raster {
namespace {

struct Ray {
    Vec3d along;
    double reach = 0.0;   ///< to the last surface that it meets; 0: none yet
    bool inward = false;  ///< its front is turned to the ray's origin
};

void meet(const Vec3d (&at)[3], Ray& ray) {
    const Vec3d normal = cross(at[1] - at[0], at[2] - at[0]);
    const double facing = dot(normal, ray.along), side = facing < 0.0 ? -1.0 : 1.0;
    if (facing == 0.0) return;
    for (int k = 0; k < 3; ++k)  // from the origin, the corners lie around the ray
        if (dot(cross(at[k], at[(k + 1) % 3]), ray.along) * side < 0.0) return;
    const double reach = dot(normal, at[0]) / facing;
    if (reach > ray.reach) ray.reach = reach, ray.inward = facing < 0.0;
}

}  // namespace

bool is_shell(const Scene& scene, int instance, const WideBox& box, const WideBox& rest) {
    if (rest.empty()) return false;
    bool around = box.high[1] >= rest.high[1];
    for (const int k : {0, 2}) around &= box.low[k] <= rest.low[k] && box.high[k] >= rest.high[k];
    const Instance& shell = scene.instances[static_cast<std::size_t>(instance)];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(shell.mesh)];
    if (!around || mesh.topology != Topology::triangles) return false;
    // Directions that no edge of a sphere of quads, or of a cube, lies along.
    Ray rays[] = {{{0.021, 1.0, 0.013}}, {{1.0, 0.31, 0.017}},  {{-1.0, 0.29, 0.023}}, {{0.019, 0.33, 1.0}}, {{0.011, 0.27, -1.0}},
                  {{0.71, 0.53, 0.69}},  {{-0.73, 0.57, 0.67}}, {{0.7, 0.59, -0.72}},  {{-0.69, 0.61, -0.7}}};
    const Vec3d middle = Vec3d{rest.low[0] + rest.high[0], rest.low[1] + rest.high[1], rest.low[2] + rest.high[2]} * 0.5;
    const bool mirrored = determinant3(shell.world_from_object) < 0.0;
    TimeCheck check;
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        check();
        Vec3d at[3];
        const std::size_t count = mesh.positions.size();
        if (mesh.indices[i] >= count || mesh.indices[i + 1] >= count || mesh.indices[i + 2] >= count) continue;  // not checked yet
        for (std::size_t k = 0; k < 3; ++k) at[k] = placed_in_double(shell.world_from_object, mesh.positions[mesh.indices[i + k]]) - middle;
        if (mirrored) std::swap(at[1], at[2]);
        for (Ray& ray : rays) meet(at, ray);
    }
    const Material* const material = material_of(scene, shell);
    const bool is_sky = material != nullptr && material->unlit && material->double_sided;
    for (const Ray& ray : rays)
        if (!(ray.reach > 0.0) || !(ray.inward || is_sky)) return false;
    return true;
}

}  // namespace halflit::raster
