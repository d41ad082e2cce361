#include "apps/io/gltf/animation/motion.hpp"
#include "apps/io/gltf/build/choices.hpp"

#include "apps/io/files/replace.hpp"
#include "apps/io/gltf/build/materials.hpp"
#include "apps/io/gltf/build/placed.hpp"
#include "apps/io/gltf/build/scaled_mesh.hpp"
#include "apps/io/gltf/build/world.hpp"
#include "apps/io/gltf/file/node_transform.hpp"
#include "sh/fp_environment.hpp"
#include "shading/out_of_memory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>

namespace halflit {

using namespace io::detail;

namespace {

/// A name that outlives the file's text.
std::string_view lasting_type(std::string_view type) {
    for (const LightKind& kind : kLightKinds)
        if (type == kind.name) return kind.name;
    for (const std::string_view known : {"perspective", "orthographic"})
        if (type == known) return known;
    return {};
}

file::File rest_of(const file::File& file) {
    file::File rest;
    rest.nodes = file.nodes;
    rest.transforms = file.transforms;
    rest.weights = file.weights;
    rest.materials = file.materials;
    rest.glossy = file.glossy;
    rest.texture_transforms = file.texture_transforms;
    rest.lights = file.lights;
    rest.cameras = file.cameras;
    for (file::Node& node : rest.nodes) node.name = {};
    for (file::Material& material : rest.materials) {
        material.name = material.alpha_mode = {};
        material.own_lobe.reset();
    }
    for (file::Light& light : rest.lights) light.type = lasting_type(light.type);
    for (file::Camera& camera : rest.cameras) {
        camera.type = lasting_type(camera.type);
        camera.name = {};
    }
    for (const file::Mesh& mesh : file.meshes) rest.meshes.emplace_back().weights = mesh.weights;
    return rest;
}

Mat4 translation_to(Vec3d place) { return to_mat4({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, place}}); }

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_arrays(const Mesh& a, const Mesh& b) {
    return same_bytes(a.positions, b.positions) && same_bytes(a.normals, b.normals) && same_bytes(a.tangents, b.tangents) &&
           same_bytes(a.uv0, b.uv0) && same_bytes(a.uv1, b.uv1) && same_bytes(a.colors, b.colors) && same_bytes(a.indices, b.indices);
}

bool has(const std::vector<bool>& list, int index) {
    return static_cast<std::size_t>(index) < list.size() && list[static_cast<std::size_t>(index)];
}

}  // namespace

Motion::Motion(const file::File& file, const NodeTree& tree, bool recentre)
    : rest_(rest_of(file)), tree_(tree), nodes_(file.nodes.size()), recentre_(recentre) {
    tree_.world_from_node.clear();
    tree_.drawn.clear();
}

void Motion::finish(PoseSources sources, const LoadedScene& loaded, std::vector<Animation> animations, const std::vector<bool>& hides) {
    for (const AnimationInfo& info : loaded.animations) names_.push_back(info.name);
    animations_ = std::move(animations);
    sources_ = std::move(sources);
    hides_ = hides;
    placement_ = loaded.placement;
    for (std::size_t n = 0; n < loaded.nodes.size(); ++n) {
        if (loaded.nodes[n].camera >= 0) cameras_.emplace_back(static_cast<int>(n), loaded.nodes[n].camera);
        if (loaded.nodes[n].light >= 0) lights_.emplace_back(static_cast<int>(n), loaded.nodes[n].light);
    }
    if (const std::vector<double>& scales = placement_.mesh_scales; !scales.empty())
        for (DeformedMesh& mesh : sources_.deformed) mesh.scale = scales[static_cast<std::size_t>(mesh.mesh)];
    moved_materials_.resize(rest_.materials.size());
    moved_cameras_.resize(rest_.cameras.size());
    moved_lights_.resize(rest_.lights.size());
    for (const Animation& animation : animations_)
        for (const Animation::Move& move : animation.moves) {
            const auto element = static_cast<std::size_t>(move.slot.element);
            if (move.slot.part() == Part::material) moved_materials_[element] = true;
            if (move.slot.part() == Part::camera) moved_cameras_[element] = true;
            if (move.slot.part() == Part::light) moved_lights_[element] = true;
        }
}

Result<void> Motion::check(const Scene& scene, std::span<const Node> nodes) const {
    const auto lacks = [](const char* what, std::size_t found, std::size_t expected) {
        return fail(ErrorCode::usage, fmt::format("pose_at: the scene has {} {}, expected at least the file's {}", found, what, expected));
    };
    const auto above = [](const auto& list, auto index) {
        std::size_t most = 0;
        for (const auto& item : list) most = std::max(most, static_cast<std::size_t>(index(item)) + 1);
        return most;
    };
    const auto second = [](const std::pair<int, int>& pair) { return pair.second; };
    if (scene.instances.size() < sources_.placed.size()) return lacks("instances", scene.instances.size(), sources_.placed.size());
    const std::size_t meshes = above(sources_.deformed, [](const DeformedMesh& mesh) { return mesh.mesh; });
    if (scene.meshes.size() < meshes) return lacks("meshes", scene.meshes.size(), meshes);
    if (const std::size_t most = above(cameras_, second); scene.cameras.size() < most) return lacks("cameras", scene.cameras.size(), most);
    if (const std::size_t most = above(lights_, second); scene.lights.size() < most) return lacks("lights", scene.lights.size(), most);
    if (const std::size_t most = std::max(rest_.materials.size(), above(copies_, second)); scene.materials.size() < most)
        return lacks("materials", scene.materials.size(), most);
    for (const PlacedInstance& placed : sources_.placed)
        if (const int mesh = scene.instances[static_cast<std::size_t>(placed.instance)].mesh;
            mesh < 0 || static_cast<std::size_t>(mesh) >= scene.meshes.size())
            return fail(ErrorCode::usage, fmt::format("pose_at: instance {}: mesh {} of {}", placed.instance, mesh, scene.meshes.size()));
    if (!nodes.empty() && nodes.size() != nodes_)
        return fail(ErrorCode::usage, fmt::format("pose_at: expected the file's {} nodes or none, found {}", nodes_, nodes.size()));
    return {};
}

Result<SceneChanges> Motion::pose(const std::string& animation, double time_s, Scene& scene, std::span<Node> nodes) const {
    if (!std::isfinite(time_s)) return fail(ErrorCode::usage, fmt::format("pose_at: time_s is {}, expected a finite number", time_s));
    if (const auto checked = check(scene, nodes); !checked) return tl::unexpected<Error>(checked.error());
    const int chosen = choose_animation(names_, animation);
    file::File file = rest_;
    for (const Animation& one : animations_)
        if (one.index == chosen) apply(one, time_s, file);
    NodeTree tree = tree_;
    place_nodes(file, tree);
    SceneChanges changes;
    for (std::size_t i = 0; i < rest_.materials.size(); ++i)
        if (moved_materials_[i]) changes.materials |= set_material(file, i, scene.materials[i]);
    for (const auto& [original, copy] : copies_)
        if (moved_materials_[static_cast<std::size_t>(original)])
            changes.materials |= set_material(file, static_cast<std::size_t>(original), scene.materials[static_cast<std::size_t>(copy)]);
    move_instances(file, tree, scene, changes);
    deform(file, tree, scene, changes);
    for (Affine& world : tree.world_from_node) world = drawn(world, placement_);
    for (const auto& [node, index] : cameras_) {
        Camera& camera = scene.cameras[static_cast<std::size_t>(index)];
        camera.world_from_camera = rigid_part(tree.world_from_node[static_cast<std::size_t>(node)]);
        const int source = file.nodes[static_cast<std::size_t>(node)].camera;
        if (has(moved_cameras_, source)) set_projection(file.cameras[static_cast<std::size_t>(source)], placement_.scale, camera);
    }
    set_lights(file, tree, scene, changes);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].parent_from_node = to_node_transform(local_transform(file, i));
    return changes;
}

void Motion::move_instances(const file::File& file, const NodeTree& tree, Scene& scene, SceneChanges& changes) const {
    std::vector<Mat4> in_file;  // as the file's world has them
    in_file.reserve(sources_.placed.size());
    for (const PlacedInstance& placed : sources_.placed) {
        Affine world = tree.world_from_node[static_cast<std::size_t>(placed.node)];
        if (placed.in_node) world = world * *placed.in_node;
        in_file.push_back(placed.at_world ? translation_to(*placed.at_world) : to_mat4(world));
        const Affine m = drawn(placed.at_world ? Affine{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, *placed.at_world}} : world, placement_);
        const auto index = static_cast<std::size_t>(placed.instance);
        Instance& instance = scene.instances[index];
        if (replace(instance.world_from_object, to_mat4(in_scaled_mesh(m, placement_.mesh_scales, instance.mesh))))
            changes.changed_instances.push_back(index);
    }
    changes.materials |= set_thickness(file, scene, in_file);
}

void Motion::deform(const file::File& file, const NodeTree& tree, Scene& scene, SceneChanges& changes) const {
    std::map<int, std::vector<Affine>> joints;  // by skin
    for (const DeformedMesh& deformed : sources_.deformed) {
        const auto node = static_cast<std::size_t>(deformed.node);
        Mesh& mesh = scene.meshes[static_cast<std::size_t>(deformed.mesh)];
        Mesh posed;
        if (!tree.hidden.empty() && tree.hidden[node]) {
            posed = without_triangles(deformed.source.mesh);
        } else {
            if (deformed.skin >= 0)
                if (const auto [entry, is_new] = joints.try_emplace(deformed.skin); is_new)
                    entry->second = joint_matrices(sources_.skins.at(deformed.skin), tree.world_from_node);
            posed =
                pose_mesh(deformed.source.mesh, deformed.source, weights_of(file, node),
                          deformed.skin >= 0 ? std::span<const Affine>(joints[deformed.skin]) : std::span<const Affine>(), deformed.place)
                    .mesh;
            if (recentre_) leave_out_strays(posed);
            if (deformed.scale != 1.0) io::scale_lengths(posed, deformed.scale);
        }
        if (same_arrays(mesh, posed)) continue;
        posed.name = std::move(mesh.name);
        posed.material = mesh.material;
        mesh = std::move(posed);
        changes.deformed_meshes.push_back(static_cast<std::size_t>(deformed.mesh));
    }
}

void Motion::set_lights(const file::File& file, const NodeTree& tree, Scene& scene, SceneChanges& changes) const {
    for (const auto& [node, index] : lights_) {
        Light& light = scene.lights[static_cast<std::size_t>(index)];
        Light moved = light;
        place(tree.world_from_node[static_cast<std::size_t>(node)], moved);
        const int source = file.nodes[static_cast<std::size_t>(node)].light;
        if (has(moved_lights_, source) || has(hides_, node)) {
            const std::optional<Light> values = light_of(file.lights[static_cast<std::size_t>(source)], placement_.scale);
            if (values) {
                moved.color_linear = values->color_linear;
                moved.range = values->range;
                moved.inner_cone_rad = values->inner_cone_rad;
                moved.outer_cone_rad = values->outer_cone_rad;
            }
            if (!tree.hidden.empty() && tree.hidden[static_cast<std::size_t>(node)]) moved.color_linear = {};
        }
        changes.lights |= replace(light.position_ws, moved.position_ws);
        changes.lights |= replace(light.direction_ws, moved.direction_ws);
        changes.lights |= replace(light.color_linear, moved.color_linear);
        changes.lights |= replace(light.range, moved.range);
        changes.lights |= replace(light.inner_cone_rad, moved.inner_cone_rad);
        changes.lights |= replace(light.outer_cone_rad, moved.outer_cone_rad);
    }
}

Result<SceneChanges> pose_at(const Motion& motion, const std::string& animation, double time_s, Scene& scene, std::span<Node> nodes) {
    const FpEnvironment environment_of_host;
    try {
        return motion.pose(animation, time_s, scene, nodes);
    } catch (const LoadFailure& failure) {
        return fail(failure.error.code, "pose_at: " + failure.error.message);
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory([] { return std::string("out of memory while posing a scene"); });
    }
}

}  // namespace halflit
