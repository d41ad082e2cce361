#include "apps/io/gltf/build/placed.hpp"

#include "sh/trig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace halflit::io::detail {

namespace {

Vec3d unit_or(Vec3d v, Vec3d otherwise) {
    const double len = length(v);
    return len > 1e-200 && len < 1e200 ? v * (1.0 / len) : otherwise;
}

}  // namespace

bool set_projection(const file::Camera& source, double scale, Camera& camera) {
    const auto in = [](double value, double low, double high) { return value > low && value < high; };
    if (!(source.type == "orthographic" ? source.orthographic : source.perspective)) return false;
    if (source.type == "orthographic") {
        const file::Projection& o = *source.orthographic;
        const double width = scale * (o.xmag < 0 ? -o.xmag : o.xmag), height = scale * (o.ymag < 0 ? -o.ymag : o.ymag);
        const double near_z = scale * o.znear, far_z = scale * o.zfar;
        if (!in(width, 0, 1e30) || !in(height, 0, 1e30) || !(near_z >= 0 && near_z < 1e30) || !in(far_z, near_z, 1e30)) return false;
        camera.orthographic = true;
        camera.half_width = static_cast<float>(width);
        camera.half_height = static_cast<float>(height);
        camera.near_z = static_cast<float>(near_z);
        camera.far_z = static_cast<float>(far_z);
        return true;
    }
    const file::Projection& p = *source.perspective;
    const double near_z = scale * p.znear, far_z = scale * p.zfar;
    if (!in(p.yfov, 0, 3.1415926) || !in(near_z, 0, 1e30)) return false;
    if (far_z != 0 && !in(far_z, near_z, 1e38)) return false;
    if (p.aspect_ratio != 0 && !in(p.aspect_ratio, 0, 1e6)) return false;
    camera.fov_y_rad = static_cast<float>(p.yfov);
    camera.aspect = static_cast<float>(p.aspect_ratio);
    camera.near_z = static_cast<float>(near_z);
    camera.far_z = static_cast<float>(far_z);
    return true;
}

std::optional<Light> light_of(const file::Light& source, double scale) {
    const auto type = light_type_of(source.type);
    if (!type) return std::nullopt;
    Light light;
    light.type = *type;
    const LightKind& kind = kind_of(*type);
    const double intensity = kind.placed ? source.intensity * (scale * scale) : source.intensity;
    const auto channel = [&](std::size_t c) {
        const double color = source.color.size() == 3 ? source.color[c] : 1.0;
        return static_cast<float>(std::clamp(color, 0.0, 1e15) * std::clamp(intensity, 0.0, 1e15) / kPi);
    };
    light.color_linear = {channel(0), channel(1), channel(2)};
    light.shadow_radius = kind.placed ? static_cast<float>(std::clamp(source.size * scale, 0.0, 1e18))
                                      : static_cast<float>(std::clamp(source.size, 0.0, 40.0) * (kPi / 180));
    if (kind.placed) light.range = static_cast<float>(std::clamp(source.range * scale, 0.0, 1e18));
    if (kind.cone) {
        light.outer_cone_rad = static_cast<float>(std::clamp(source.outer_cone_angle, 0.0, kPi / 2));
        light.inner_cone_rad = std::min(static_cast<float>(std::clamp(source.inner_cone_angle, 0.0, kPi / 2)), light.outer_cone_rad);
    }
    return light;
}

bool is_valid(const file::Camera& source) {
    Camera camera;
    return set_projection(source, 1.0, camera);
}

Mat4 rigid_part(const Affine& world) {
    const Vec3d z = unit_or(world.c[2], {0, 0, 1});
    const Vec3d side = z.y > 0.9 || z.y < -0.9 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};  // replaces a y that lies along z or is zero
    const Vec3d y_in_plane = world.c[1] - z * dot(z, world.c[1]);
    const bool usable = length(y_in_plane) > 1e-9 * length(world.c[1]);
    const Vec3d y = unit_or(usable ? y_in_plane : side - z * dot(z, side), {0, 1, 0});
    return to_mat4({{cross(y, z), y, z, world.c[3]}});
}

void place(const Affine& world, Light& light) {
    light.position_ws = to_float(world.c[3]);
    light.direction_ws = to_float(unit_or(world.c[2] * -1.0, {0, 0, -1}));
}

void place_cameras(Document& document, const NodeTree& tree, LoadedScene& loaded) {
    for (const int n : tree.drawn) {
        const file::Node& node = document.file.nodes[static_cast<std::size_t>(n)];
        if (node.camera < 0) continue;
        const file::Camera& source = document.file.cameras[static_cast<std::size_t>(node.camera)];
        Camera camera;
        const Affine& world = tree.world_from_node[static_cast<std::size_t>(n)];
        if (!is_finite(world) || !set_projection(source, loaded.placement.scale, camera)) {
            // A value of the projection that is out of range has been warned of.
            const std::string of_values = fmt::format("cameras[{}].", node.camera);
            if (std::none_of(document.warnings.begin(), document.warnings.end(),
                             [&](const std::string& w) { return w.starts_with(of_values); }))
                document.warn(fmt::format("cameras[{}]: its projection or its node's transform is not valid, left out", node.camera));
            continue;
        }
        camera.name = source.name.empty() ? node.name : source.name;
        camera.world_from_camera = rigid_part(world);
        document.geometry.take(sizeof(Camera) + camera.name.size());
        loaded.nodes[static_cast<std::size_t>(n)].camera = static_cast<int>(loaded.scene.cameras.size());
        loaded.scene.cameras.push_back(std::move(camera));
    }
}

void place_lights(Document& document, const NodeTree& tree, LoadedScene& loaded) {
    std::vector<Light>& lights = loaded.scene.lights;
    for (const int n : tree.drawn) {
        const file::Node& node = document.file.nodes[static_cast<std::size_t>(n)];
        if (node.light < 0) continue;
        const file::Light& source = document.file.lights[static_cast<std::size_t>(node.light)];
        std::optional<Light> light = light_of(source, loaded.placement.scale);
        const Affine& world = tree.world_from_node[static_cast<std::size_t>(n)];
        if (!light || !is_finite(world)) {
            if (light) document.warn(fmt::format("nodes[{}]: its transform is not finite, its light is left out", n));
            continue;  // a type that is unknown has been warned of
        }
        place(world, *light);
        const bool hidden = !tree.hidden.empty() && tree.hidden[static_cast<std::size_t>(n)];
        if (hidden && !document.animations.hides_node(static_cast<std::size_t>(n))) continue;
        if (hidden) light->color_linear = {};
        if (lights.size() >= document.options.limits.max_lights)
            refuse("nodes", fmt::format("more than {} lights, which is max_lights", document.options.limits.max_lights), ErrorCode::limit);
        loaded.nodes[static_cast<std::size_t>(n)].light = static_cast<int>(lights.size());
        lights.push_back(*light);
    }
}

}  // namespace halflit::io::detail
