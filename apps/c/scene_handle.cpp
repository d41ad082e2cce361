#include "apps/c/scene_handle.hpp"

#include "shading/material_properties.hpp"

#include <algorithm>

namespace halflit::c {

void Changes::clear() {
    structure_ = false;
    for (const std::size_t i : changes_.changed_instances) moved_[i] = false;
    for (const std::size_t i : changes_.deformed_meshes) deformed_[i] = false;
    changes_.changed_instances.clear();
    changes_.deformed_meshes.clear();
    changes_.materials = false;
}

void Changes::note(std::size_t index, std::vector<std::size_t>& list, std::vector<bool>& listed) {
    if (structure_) return;
    if (listed.size() <= index) listed.resize(index + 1);
    if (listed[index]) return;
    list.push_back(index);
    listed[index] = true;
}

}  // namespace halflit::c

using namespace halflit;

namespace {

/// The mesh with the normals and tangents that its material requires, if it lacks some.
std::optional<Mesh> completed(const Scene& scene, const Mesh& mesh, int material_index) {
    const Material no_material;
    const Material& material = material_index >= 0 ? scene.materials[static_cast<std::size_t>(material_index)] : no_material;
    const std::optional<int> uv_set = shading::tangent_uv_set(material);
    const bool has_uv = uv_set && !(*uv_set == 0 ? mesh.uv0 : mesh.uv1).empty();
    if (mesh.topology != Topology::triangles) return {};
    const bool needs_normals = mesh.normals.empty() && !material.unlit;
    // Flat normals remove the tangents, which belong to other normals.
    const bool needs_tangents = (mesh.tangents.empty() || needs_normals) && !material.unlit && has_uv;
    if (!needs_normals && !needs_tangents) return {};
    Mesh full = mesh;
    if (needs_normals) generate_flat_normals(full);
    if (needs_tangents) generate_tangents(full, *uv_set);
    return full;
}

}  // namespace

void halflit_scene::put_mesh(std::size_t index, Mesh given) {
    std::optional<Mesh> full = completed(scene, given, given.material);
    if (full) {
        given_meshes.insert_or_assign(index, std::move(given));
        given = std::move(*full);
    } else {
        given_meshes.erase(index);
    }
    if (index == scene.meshes.size()) scene.meshes.emplace_back();
    scene.meshes[index] = std::move(given);
    for (const Instance& instance : scene.instances)
        if (instance.mesh == static_cast<int>(index)) complete_mesh_of(instance);
}

void halflit_scene::put_given_mesh(std::size_t index, Mesh given, bool smooth) {
    scene.frame_work = 0;  // there is more than the file's
    if (given.normals.empty())
        added_without_normals.insert_or_assign(index, smooth);
    else
        added_without_normals.erase(index);
    if (given.normals.empty() && smooth) generate_smooth_normals(given);
    put_mesh(index, std::move(given));
}

void halflit_scene::list_instances_of_nodes() {
    for (Node& node : nodes) node.instances.clear();
    for (std::size_t i = 0; i < node_of_instance.size(); ++i)
        if (node_of_instance[i] >= 0) nodes[static_cast<std::size_t>(node_of_instance[i])].instances.push_back(static_cast<int>(i));
}

void halflit_scene::put_instance(std::size_t index, const Instance& given) {
    scene.frame_work = 0;  // there is more than the file's
    if (index == scene.instances.size()) {
        changes.structure();
        scene.instances.emplace_back();
    }
    changes.instance(index);
    scene.instances[index] = given;
}

void halflit_scene::complete(std::size_t index, int material) {
    Mesh& mesh = scene.meshes[index];
    std::optional<Mesh> full = completed(scene, mesh, material);
    if (!full) return;
    changes.mesh(index);
    given_meshes.try_emplace(index, std::move(mesh));
    mesh = std::move(*full);
}

void halflit_scene::complete_mesh_of(const Instance& instance) {
    if (instance.material >= 0) complete(static_cast<std::size_t>(instance.mesh), instance.material);
}

void halflit_scene::complete_meshes_of(std::size_t material) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        if (scene.meshes[i].material == static_cast<int>(material)) complete(i, scene.meshes[i].material);
    for (const Instance& instance : scene.instances)
        if (instance.material == static_cast<int>(material)) complete_mesh_of(instance);
}

Result<void> halflit_scene::prepare(const Execution& execution) const {
    const std::lock_guard lock(preparing);
    Result<void> done;
    if (!prepared || changes.of_structure()) {
        prepared.reset();
        auto made = PreparedScene::make(scene, execution);
        if (!made) return tl::unexpected<Error>(made.error());
        prepared.emplace(std::move(*made));
    } else if (changes.any()) {
        done = prepared->update(changes.list(), execution);
        if (!done) prepared.reset();  // the next frame prepares all anew
    }
    changes.clear();
    return done;
}
