#include "apps/io/detail/gltf_meshes.hpp"

#include "apps/io/detail/gltf_skin.hpp"
#include "halflit/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <tuple>

namespace halflit::io::detail {

namespace {

class MeshPlacer {
public:
    MeshPlacer(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, LoadedScene& loaded)
        : document_(document),
          accessors_(accessors),
          tree_(tree),
          scene_(loaded.scene),
          nodes_(loaded.nodes),
          reader_(document, accessors),
          mesh_checked_(document.file.meshes.size(), false) {}

    void run() {
        for (const int node : tree_.drawn)
            if (document_.file.nodes[static_cast<std::size_t>(node)].mesh >= 0) place(static_cast<std::size_t>(node));
        if (const std::size_t count = document_.info.point_and_line_primitives; count > 0)
            document_.warn(count == 1 ? fmt::format("{}.mode: points and lines are not drawn", reader_.first_left_out())
                                      : fmt::format("{}.mode: points and lines are not drawn, here and in {} more primitives",
                                                    reader_.first_left_out(), count - 1));
    }

private:
    /// A mesh of the scene, made of a primitive.
    struct Made {
        int mesh;                       // index into the scene's meshes
        std::optional<Vec3d> at_world;  // skinned: where it is placed, without the node's transform
    };
    using Key = std::tuple<int, int, std::vector<double>>;  // mesh, skin, morph weights

    void place(std::size_t index) {
        const file::Node& node = document_.file.nodes[index];
        const file::Mesh& mesh = document_.file.meshes[static_cast<std::size_t>(node.mesh)];
        const auto own = std::span(document_.file.weights).subspan(node.weights.first, node.weights.count);
        std::vector<double> weights = own.empty() ? mesh.weights : std::vector(own.begin(), own.end());
        while (!weights.empty() && weights.back() == 0.0) weights.pop_back();
        check_weights(index);
        const auto [entry, is_new] = made_.try_emplace(Key{node.mesh, node.skin, std::move(weights)});
        if (is_new) entry->second = make(static_cast<std::size_t>(node.mesh), node.skin, std::get<2>(entry->first));

        const std::vector<Made>& primitives = entry->second;
        const Affine& world = tree_.world_from_node[index];
        const bool needs_world = std::any_of(primitives.begin(), primitives.end(), [](const Made& made) { return !made.at_world; });
        if (needs_world && !is_finite(world)) {
            document_.warn(fmt::format("nodes[{}]: its transform is not finite, not drawn", index));
            return;
        }
        document_.geometry.take(primitives.size() * (sizeof(Instance) + sizeof(int)));
        for (const auto& [mesh_of_scene, at_world] : primitives) {
            if (!at_world) nodes_[index].instances.push_back(static_cast<int>(scene_.instances.size()));
            Affine placed = world;
            if (at_world) placed = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, *at_world}};
            scene_.instances.push_back({mesh_of_scene, to_mat4(placed)});
            document_.info.triangles_drawn += scene_.meshes[static_cast<std::size_t>(mesh_of_scene)].indices.size() / 3;
        }
    }

    /// Each primitive of a mesh has the same number of morph targets, and each list of weights that number of entries.
    void check_weights(std::size_t index) {
        const file::Node& node = document_.file.nodes[index];
        const auto mesh_index = static_cast<std::size_t>(node.mesh);
        const file::Mesh& mesh = document_.file.meshes[mesh_index];
        if (mesh.primitives.empty() || document_.warnings_are_full()) return;
        const std::size_t targets = mesh.primitives.front().targets.size();
        const auto check = [&](const std::string& where, std::size_t weights) {
            if (weights > 0 && weights != targets)
                document_.warn(fmt::format("{}.weights: expected {} entries, one for each morph target, found {}; {}", where, targets,
                                           weights, weights < targets ? "the others count as 0" : "the last ones are ignored"));
        };
        if (node.weights.count > 0) check(fmt::format("nodes[{}]", index), node.weights.count);
        if (mesh_checked_[mesh_index]) return;
        mesh_checked_[mesh_index] = true;
        check(fmt::format("meshes[{}]", mesh_index), mesh.weights.size());
        for (std::size_t p = 1; p < mesh.primitives.size(); ++p)
            if (mesh.primitives[p].targets.size() != targets)
                document_.warn(
                    fmt::format("meshes[{}].primitives[{}].targets: expected {} morph targets as in the first primitive, found {}",
                                mesh_index, p, targets, mesh.primitives[p].targets.size()));
    }

    std::vector<Made> make(std::size_t mesh, int skin, const std::vector<double>& weights) {
        std::vector<Made> made;
        const auto& primitives = document_.file.meshes[mesh].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            document_.check_time();
            std::optional<ReadMesh> read = reader_.read(mesh, p, weights);
            if (!read) continue;
            std::optional<Vec3d> at_world;
            if (skin >= 0) {
                at_world = apply_skin(document_, accessors_, reader_, tree_, skin, primitives[p], *read);
                if (!at_world)
                    document_.warn(fmt::format("{}: has a skin, but no JOINTS_0 and WEIGHTS_0; drawn as a plain mesh", read->where));
            }
            complete(*read);
            document_.info.vertices += read->mesh.positions.size();
            document_.info.triangles_stored += read->mesh.indices.size() / 3;
            made.push_back({static_cast<int>(scene_.meshes.size()), at_world});
            scene_.meshes.push_back(std::move(read->mesh));
        }
        return made;
    }

    /// Adds flat normals if there are none, and tangents if the material needs them.
    void complete(ReadMesh& read) {
        Mesh& mesh = read.mesh;
        const std::uint64_t corners = mesh.indices.size();
        if (mesh.normals.empty()) {
            document_.geometry.take(corners *
                                    (24 + (mesh.uv0.empty() ? 0 : 8) + (mesh.uv1.empty() ? 0 : 8) + (mesh.colors.empty() ? 0 : 16)));
            generate_flat_normals(mesh);
        }
        if (mesh.material < 0) return;
        check_texture_coordinates(read);
        if (!mesh.tangents.empty()) return;
        const Material& material = scene_.materials[static_cast<std::size_t>(mesh.material)];
        const TextureUse& normal_map = material.normal_texture.used() ? material.normal_texture : material.clearcoat.normal_texture;
        if (!normal_map.used()) return;
        if ((normal_map.uv_set == 1 ? mesh.uv1 : mesh.uv0).empty()) return;
        document_.geometry.take(corners * 16);
        generate_tangents(mesh, normal_map.uv_set);
    }

    /// Warns of textures of the material for which the mesh has no coordinates.
    void check_texture_coordinates(const ReadMesh& read) {
        const Material& material = scene_.materials[static_cast<std::size_t>(read.mesh.material)];
        const std::pair<const TextureUse*, const char*> places[] = {
            {&material.base_color_texture, "pbrMetallicRoughness.baseColorTexture"},
            {&material.metallic_roughness_texture, "pbrMetallicRoughness.metallicRoughnessTexture"},
            {&material.normal_texture, "normalTexture"},
            {&material.occlusion_texture, "occlusionTexture"},
            {&material.emissive_texture, "emissiveTexture"},
            {&material.specular_texture, "extensions.KHR_materials_specular.specularTexture"},
            {&material.specular_color_texture, "extensions.KHR_materials_specular.specularColorTexture"},
            {&material.clearcoat.texture, "extensions.KHR_materials_clearcoat.clearcoatTexture"},
            {&material.clearcoat.roughness_texture, "extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture"},
            {&material.clearcoat.normal_texture, "extensions.KHR_materials_clearcoat.clearcoatNormalTexture"},
            {&material.sheen.color_texture, "extensions.KHR_materials_sheen.sheenColorTexture"},
            {&material.sheen.roughness_texture, "extensions.KHR_materials_sheen.sheenRoughnessTexture"},
            {&material.transmission.texture, "extensions.KHR_materials_transmission.transmissionTexture"},
            {&material.transmission.thickness_texture, "extensions.KHR_materials_volume.thicknessTexture"}};
        for (const auto& [use, key] : places)
            if (use->used() && (use->uv_set == 1 ? read.mesh.uv1 : read.mesh.uv0).empty() && !document_.warnings_are_full())
                document_.warn(
                    fmt::format("materials[{}].{}: {} has no TEXCOORD_{}, {}", read.mesh.material, key, read.where, use->uv_set,
                                (use == &material.normal_texture || use == &material.clearcoat.normal_texture) && read.mesh.tangents.empty()
                                    ? "drawn without it"
                                    : "drawn with the colour at (0, 0)"));
    }

    Document& document_;
    const std::vector<Accessor>& accessors_;
    const NodeTree& tree_;
    Scene& scene_;
    std::vector<Node>& nodes_;
    PrimitiveReader reader_;
    std::map<Key, std::vector<Made>> made_;
    std::vector<bool> mesh_checked_;
};

}  // namespace

std::vector<bool> find_used_materials(const Document& document, const NodeTree& tree) {
    std::vector<bool> used(document.file.materials.size(), false), seen(document.file.meshes.size(), false);
    for (const int node : tree.drawn) {
        const int mesh = document.file.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0 || seen[static_cast<std::size_t>(mesh)]) continue;
        seen[static_cast<std::size_t>(mesh)] = true;
        for (const file::Primitive& primitive : document.file.meshes[static_cast<std::size_t>(mesh)].primitives)
            if (primitive.material >= 0 && file::draws_triangles(primitive)) used[static_cast<std::size_t>(primitive.material)] = true;
    }
    return used;
}

void place_meshes(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, LoadedScene& loaded) {
    MeshPlacer(document, accessors, tree, loaded).run();
}

}  // namespace halflit::io::detail
