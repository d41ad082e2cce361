#include "halflit/scene.hpp"

#include "halflit/shapes.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/used_vertices.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"

#include <span>

namespace halflit {

Bounds scene_bounds(const Scene& scene) {
    const FpEnvironment environment_of_host;
    Bounds bounds;
    std::vector<std::vector<bool>> used(scene.meshes.size());
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        check();
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        std::vector<bool>& mask = used[static_cast<std::size_t>(instance.mesh)];
        if (mask.empty()) mask = raster::used_vertices(mesh);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            check();
            if (mask[i]) bounds.add(transform_point(instance.world_from_object, mesh.positions[i]));
        }
    }
    return bounds;
}

namespace {

/// In camera space it comes from the left, above and behind the viewer: light from the side shows the form, and little of what the viewer
/// sees is unlit.
Light key_light(const Camera& camera, Vec3f color_linear) {
    const Vec3f travels_vs{0.48f, -0.70f, -0.53f};
    Light key;
    key.type = LightType::directional;
    key.direction_ws = normalize_or(transform_vector(camera.world_from_camera, travels_vs), {0, -1, 0});
    key.color_linear = color_linear;
    return key;
}

}  // namespace

void add_studio(Lighting& light, const Camera& camera, double turn_rad, float level) {
    const FpEnvironment environment_of_host;
    // By the light of both, grey faces that look up, left and right differ by 28 codes and more, and codes are about those of base colours.
    light.lights.push_back(key_light(camera, Vec3f{1.15f, 1.12f, 1.07f} * level));
    light.ambient = {};
    light.environment = studio_environment(camera, turn_rad, level);
}

void add_default_lights(Lighting& light, const Camera& camera) {
    const FpEnvironment environment_of_host;
    // A white Lambert surface that faces the key light reaches 0.82 of the display's white, and about 1 with the ambient light.
    light.lights.push_back(key_light(camera, {0.84f, 0.82f, 0.78f}));
    light.ambient.sky_linear = {0.23f, 0.25f, 0.28f};
    light.ambient.ground_linear = {0.13f, 0.12f, 0.105f};
}

void add_ground(Scene& scene, const Bounds& bounds) {
    const FpEnvironment environment_of_host;
    constexpr float kReach = 10.0f, kBelow = 1e-4f;  // of the bounds' radius
    Material material;
    material.name = "ground";
    material.metallic = 0.0f;
    material.shadow_catcher = true;
    material.has_own_lobe = true;
    const float radius = bounds.empty ? 0.0f : bounds.radius();
    Mesh mesh = make_plane(radius > 0.0f ? kReach * radius : 1.0f, 1);
    mesh.material = static_cast<int>(scene.materials.size());
    Instance instance;
    instance.mesh = static_cast<int>(scene.meshes.size());
    if (!bounds.empty) {
        const Vec3f middle = bounds.center();
        instance.world_from_object.c[3] = {middle.x, bounds.min.y - kBelow * radius, middle.z, 1.0f};
    }
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
}

std::vector<Light> Lighting::all_lights() const {
    std::vector<Light> all = lights;
    if (environment == nullptr || !suns) return all;
    const std::span<const Light> added = environment_suns(*environment);
    all.insert(all.end(), added.begin(), added.end());
    for (std::size_t i = lights.size(); i < all.size(); ++i)
        if (!(all[i].shadow_radius > 0.0f)) all[i].shadow_radius = sun_shadow_radius_rad;
    return all;
}

}  // namespace halflit
