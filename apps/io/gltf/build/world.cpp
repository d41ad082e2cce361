#include "apps/io/gltf/build/world.hpp"

#include "apps/io/files/double_box.hpp"
#include "apps/io/gltf/build/scaled_mesh.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace halflit::io::detail {

namespace {

/// Sizes between which products of coordinates stay far from float32's ends.
constexpr double kSmallest = 0x1p-30, kLargest = 0x1p30;
/// A scene below this size is scaled too, since distances to a light below 1e-4 count as that.
constexpr double kSmallestScene = 0x1p-10;

Vec3d apply(const Affine& m, Vec3d p) { return transform_direction(m, p) + m.c[3]; }

/// DoubleBox of a mesh's triangles.
DoubleBox box_of(const Mesh& mesh) {
    DoubleBox box;
    for (const std::uint32_t index : mesh.indices)
        if (shading::finite(mesh.positions[index])) box.include(to_double(mesh.positions[index]));
    return box;
}

double largest(const DoubleBox& box) {
    if (box.empty()) return 0.0;
    return std::max(
        {std::abs(box.min.x), std::abs(box.min.y), std::abs(box.min.z), std::abs(box.max.x), std::abs(box.max.y), std::abs(box.max.z)});
}

/// The power of two that takes x into [1, 2); 1 if x is within bounds already, or 0.
double unit_scale(double x, double smallest) {
    if (x == 0.0 || (x >= smallest && x <= kLargest)) return 1.0;
    constexpr int kMost = 1000;  // more would be infinite
    return std::ldexp(1.0, std::min(-std::ilogb(x), kMost));
}

/// Transforms of all instances, in double. Skinned meshes have none of their node's: their own is exact in float.
std::vector<Affine> instance_transforms(const NodeTree& tree, const LoadedScene& loaded) {
    std::vector<Affine> out;
    for (const Instance& instance : loaded.scene.instances) out.push_back(to_affine(instance.world_from_object));
    for (std::size_t n = 0; n < loaded.nodes.size(); ++n)
        for (std::size_t k = 0; k < loaded.nodes[n].instances.size(); ++k) {
            const std::vector<NodeTransform>& placings = loaded.nodes[n].node_from_instance;
            const Affine& world = tree.world_from_node[n];
            out[static_cast<std::size_t>(loaded.nodes[n].instances[k])] = placings.empty() ? world : world * to_affine(placings[k]);
        }
    return out;
}

/// box: of the mesh.
std::size_t leave_out_strays(Mesh& mesh, const DoubleBox& box) {
    constexpr double kTooFar = 0x1p40;
    constexpr std::size_t kShare = 3;  // one in so many vertices at most; a stray is a vertex of each triangle around it
    if (!(largest(box) > kLargest)) return 0;
    std::vector<double> away;
    for (const Vec3f& p : mesh.positions)
        if (shading::finite(p)) away.push_back(length(to_double(p)));
    const auto middle = away.begin() + static_cast<std::ptrdiff_t>(away.size() / 2);
    std::nth_element(away.begin(), middle, away.end());
    const double limit = kTooFar * *middle;
    const auto strays = static_cast<std::size_t>(std::count_if(away.begin(), away.end(), [&](double a) { return a > limit; }));
    if (away.size() <= kShare || !(limit > 0.0) || strays > away.size() / kShare) return 0;
    for (Vec3f& p : mesh.positions)
        if (shading::finite(p) && length(to_double(p)) > limit) p.x = std::numeric_limits<float>::quiet_NaN();
    return strays;
}

}  // namespace

std::size_t leave_out_strays(Mesh& mesh) { return leave_out_strays(mesh, box_of(mesh)); }

Affine drawn(const Affine& world, const Placement& placement) {
    const auto turned = [&](Vec3d column) { return turned_upright(column, placement.up) * placement.scale; };
    return {{turned(world.c[0]), turned(world.c[1]), turned(world.c[2]), placement.into(world.c[3])}};
}

Affine in_scaled_mesh(Affine m, std::span<const double> mesh_scales, int mesh) {
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= mesh_scales.size()) return m;
    for (int k = 0; k < 3; ++k) m.c[k] = m.c[k] * (1.0 / mesh_scales[static_cast<std::size_t>(mesh)]);
    return m;
}

namespace {

/// Sets origin and scale of the placement, and those of the meshes. transforms: of all instances. Warns.
void choose_origin(Document& document, LoadedScene& loaded, std::span<const Affine> transforms) {
    Scene& scene = loaded.scene;
    std::vector<DoubleBox> boxes;
    std::size_t strays = 0;
    for (Mesh& mesh : scene.meshes) {
        boxes.push_back(box_of(mesh));
        const std::size_t found = leave_out_strays(mesh, boxes.back());
        if (found > 0) boxes.back() = box_of(mesh);
        strays += found;
    }
    if (strays > 0)
        document.warn(fmt::format(
            "{} vertices lie more than 1e12 times farther from the origin than their mesh's median vertex: their triangles are not drawn",
            strays));
    DoubleBox world;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const DoubleBox& box = boxes[static_cast<std::size_t>(scene.instances[i].mesh)];
        if (box.empty()) continue;
        for (int k = 0; k < 8; ++k)
            world.include(
                apply(transforms[i], {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z}));
    }
    if (world.empty() || !std::isfinite(world.radius())) return;
    const bool far = world.is_far();
    const double scale = unit_scale(world.radius(), kSmallestScene);
    // Positions that are small or large themselves are scaled in the mesh, so that an instance's transform is neither.
    std::vector<double> in_mesh;
    for (const DoubleBox& box : boxes) in_mesh.push_back(unit_scale(largest(box), kSmallest));
    if (!far && scale == 1.0 && std::all_of(in_mesh.begin(), in_mesh.end(), [](double s) { return s == 1.0; })) return;

    Placement& placement = loaded.placement;
    // In float32, as the positions are that it is taken from, so that no transform is rounded.
    const Vec3d center = world.center();
    const auto single = [](double x) {
        return std::abs(x) < double{std::numeric_limits<float>::max()} ? double{static_cast<float>(x)} : x;
    };
    placement.origin = far ? turned_upright(Vec3d{single(center.x), single(center.y), single(center.z)}, placement.up) : Vec3d{};
    placement.scale = scale;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        if (in_mesh[m] != 1.0) scale_lengths(scene.meshes[m], in_mesh[m]);
    placement.mesh_scales = std::move(in_mesh);
    if (far)
        document.warn(fmt::format("the scene lies {:.3g} times its size away from the origin: it is drawn at the origin",
                                  length(placement.origin) / std::max(2.0 * world.radius(), 1e-300)));
    if (unit_scale(world.radius(), kSmallest) != 1.0)
        document.warn(fmt::format("the scene is {:.3g} units in size: it is drawn {:.3g} times as large", 2.0 * world.radius(), scale));
}

}  // namespace

void place_scene(Document& document, UpAxis up, NodeTree& tree, LoadedScene& loaded) {
    Scene& scene = loaded.scene;
    loaded.placement = {.up = up};
    const std::vector<Affine> transforms = instance_transforms(tree, loaded);
    if (document.options.recentre && !scene.instances.empty()) choose_origin(document, loaded, transforms);
    if (loaded.placement == Placement{}) return;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const Affine m = drawn(transforms[i], loaded.placement);
        scene.instances[i].world_from_object = to_mat4(in_scaled_mesh(m, loaded.placement.mesh_scales, scene.instances[i].mesh));
    }
    for (Affine& m : tree.world_from_node) m = drawn(m, loaded.placement);
}

}  // namespace halflit::io::detail
