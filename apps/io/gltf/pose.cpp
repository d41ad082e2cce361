#include "apps/io/files/replace.hpp"
#include "apps/io/gltf/build/placed.hpp"
#include "apps/io/gltf/build/world.hpp"
#include "apps/io/gltf/file/transform.hpp"
#include "halflit/gltf.hpp"
#include "sh/fp_environment.hpp"
#include "shading/out_of_memory.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <new>
#include <vector>

namespace halflit {

using namespace io::detail;

namespace {

/// Whether an index, or -1 for "none", is within a list.
bool within(int index, std::size_t size) { return index >= -1 && index < static_cast<std::int64_t>(size); }

Result<void> check_nodes(std::span<const Node> nodes, const Scene& scene) {
    const auto failed = [](std::size_t node, const char* what, int index, std::size_t size) {
        return fail(ErrorCode::usage, fmt::format("pose: node {}: {} {} of {}", node, what, index, size));
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i];
        if (!within(node.parent, nodes.size())) return failed(i, "parent", node.parent, nodes.size());
        if (!within(node.camera, scene.cameras.size())) return failed(i, "camera", node.camera, scene.cameras.size());
        if (!within(node.light, scene.lights.size())) return failed(i, "light", node.light, scene.lights.size());
        if (!node.node_from_instance.empty() && node.node_from_instance.size() != node.instances.size())
            return fail(ErrorCode::usage, fmt::format("pose: node {}: {} transforms of instances, expected {}", i,
                                                      node.node_from_instance.size(), node.instances.size()));
        for (const int instance : node.instances)
            if (instance < 0 || !within(instance, scene.instances.size())) return failed(i, "instance", instance, scene.instances.size());
    }
    return {};
}

/// Transforms to the world. Nodes may come before their parents.
Result<std::vector<Affine>> place_all(std::span<const Node> nodes) {
    enum class State : std::uint8_t { untouched, open, placed };
    std::vector<Affine> world(nodes.size());
    std::vector<State> state(nodes.size(), State::untouched);
    std::vector<std::size_t> chain;  // from a node towards its root
    for (std::size_t first = 0; first < nodes.size(); ++first) {
        int at = static_cast<int>(first);
        while (at >= 0 && state[static_cast<std::size_t>(at)] == State::untouched) {
            state[static_cast<std::size_t>(at)] = State::open;
            chain.push_back(static_cast<std::size_t>(at));
            at = nodes[static_cast<std::size_t>(at)].parent;
        }
        if (at >= 0 && state[static_cast<std::size_t>(at)] == State::open)
            return fail(ErrorCode::usage, fmt::format("pose: node {}: it is its own ancestor", at));
        for (; !chain.empty(); chain.pop_back()) {
            const std::size_t i = chain.back();
            const Affine local = to_affine(nodes[i].parent_from_node);
            world[i] = nodes[i].parent < 0 ? local : world[static_cast<std::size_t>(nodes[i].parent)] * local;
            state[i] = State::placed;
        }
    }
    return world;
}

}  // namespace

NodeTransform::NodeTransform(const Mat4& m)
    : x{m.c[0].x, m.c[0].y, m.c[0].z},
      y{m.c[1].x, m.c[1].y, m.c[1].z},
      z{m.c[2].x, m.c[2].y, m.c[2].z},
      origin{m.c[3].x, m.c[3].y, m.c[3].z} {}

Result<SceneChanges> pose(std::span<const Node> nodes, Scene& scene, const Placement& placement) {
    const FpEnvironment environment_of_host;
    try {
        if (const auto ok = check_nodes(nodes, scene); !ok) return tl::unexpected(ok.error());
        const auto world = place_all(nodes);
        if (!world) return tl::unexpected(world.error());
        SceneChanges changes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Affine place_ws = drawn((*world)[i], placement);
            const std::vector<NodeTransform>& placings = nodes[i].node_from_instance;
            for (std::size_t k = 0; k < nodes[i].instances.size(); ++k) {
                const auto instance = static_cast<std::size_t>(nodes[i].instances[k]);
                const Affine placed = placings.empty() ? place_ws : place_ws * to_affine(placings[k]);
                const int mesh = scene.instances[instance].mesh;
                if (replace(scene.instances[instance].world_from_object, to_mat4(in_scaled_mesh(placed, placement.mesh_scales, mesh))))
                    changes.changed_instances.push_back(instance);
            }
            if (nodes[i].camera >= 0) scene.cameras[static_cast<std::size_t>(nodes[i].camera)].world_from_camera = rigid_part(place_ws);
            if (nodes[i].light >= 0) {
                Light& light = scene.lights[static_cast<std::size_t>(nodes[i].light)];
                Light moved = light;
                place(place_ws, moved);
                changes.lights |= replace(light.position_ws, moved.position_ws);
                changes.lights |= replace(light.direction_ws, moved.direction_ws);
            }
        }
        return changes;
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory([] { return std::string("out of memory while posing a scene"); });
    }
}

}  // namespace halflit
