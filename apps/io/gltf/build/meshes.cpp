#include "apps/io/gltf/build/meshes.hpp"

#include "apps/io/gltf/build/instancing.hpp"
#include "apps/io/gltf/build/skin.hpp"
#include "halflit/mesh.hpp"
#include "sh/time_limit.hpp"
#include "shading/material_properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace halflit::io::detail {

namespace {

class MeshPlacer {
public:
    MeshPlacer(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, LoadedScene& loaded, PoseSources* kept)
        : document_(document),
          accessors_(accessors),
          tree_(tree),
          kept_(kept),
          scene_(loaded.scene),
          nodes_(loaded.nodes),
          node_of_instance_(loaded.node_of_instance),
          reader_(document, accessors),
          mesh_checked_(document.file.meshes.size(), false) {}

    void run() {
        for (const int node : tree_.drawn)
            if (document_.file.nodes[static_cast<std::size_t>(node)].mesh >= 0) place(static_cast<std::size_t>(node));
    }

private:
    /// A mesh of the scene, made of a primitive.
    struct Made {
        int mesh;                       // index into the scene's meshes
        std::optional<Vec3d> at_world;  // skinned: where it is placed, without the node's transform
    };
    /// Mesh, skin, morph weights, the node if its own animation deforms or hides the mesh, otherwise -1, and whether a skinned mesh is
    /// mirrored.
    using Key = std::tuple<int, int, std::vector<double>, int, bool>;

    void place(std::size_t index) {
        const file::Node& node = document_.file.nodes[index];
        const bool own = document_.animations.morphs_node(index) || document_.animations.hides_node(index);
        if (is_hidden(index) && !document_.animations.hides_node(index)) return;
        const std::span<const double> all = weights_of(document_.file, index);
        check_time();
        charge_work(8 * all.size());
        document_.geometry.take(all.size() * sizeof(double));
        std::vector<double> weights(all.begin(), all.end());
        while (!weights.empty() && weights.back() == 0.0) weights.pop_back();
        check_weights(index);
        const auto [entry, is_new] = made_.try_emplace(
            Key{node.mesh, node.skin, std::move(weights), own ? static_cast<int>(index) : -1, node.skin >= 0 && is_mirrored(index)});
        if (is_new) entry->second = make(index, std::get<2>(entry->first));

        const std::vector<Made>& primitives = entry->second;
        const Affine& world = tree_.world_from_node[index];
        const bool needs_world = std::any_of(primitives.begin(), primitives.end(), [](const Made& made) { return !made.at_world; });
        if (needs_world && !is_finite(world)) {
            document_.warn(fmt::format("nodes[{}]: its transform is not finite, not drawn", index));
            if (kept_ == nullptr) return;  // it may be finite at another time
        }
        if (node.instancing < 0) {
            place(index, primitives, std::nullopt);
            return;
        }
        InstancePlaces places;
        try {
            places = read_instance_places(document_, reader_, index);
        } catch (const LoadFailure& failure) {
            document_.go_on_without(failure, "drawn once");
            places.count = 1;
        }
        for (std::size_t i = 0; i < places.count; ++i) {
            if (i % 4096 == 0) check_time();
            const Affine in_node = places.at(i);
            if (!is_finite(world * in_node)) {
                document_.warn(fmt::format("nodes[{}]: the transform of an instance is not finite, not drawn", index));
                if (kept_ == nullptr) continue;
            }
            place(index, primitives, in_node);
        }
    }

    void place(std::size_t index, const std::vector<Made>& primitives, const std::optional<Affine>& in_node) {
        // Memory of an instance until it is drawn; a few bytes may ask for many.
        constexpr std::uint64_t kBytesInNode = 1024;
        document_.geometry.take(primitives.size() * (in_node ? kBytesInNode : sizeof(Instance) + sizeof(int)));
        const Affine& world = tree_.world_from_node[index];
        for (const auto& [mesh_of_scene, at_world] : primitives) {
            if (!at_world) {
                nodes_[index].instances.push_back(static_cast<int>(scene_.instances.size()));
                if (in_node) nodes_[index].node_from_instance.push_back(to_node_transform(*in_node));
            }
            Affine placed = in_node ? world * *in_node : world;
            if (at_world) placed = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, *at_world}};
            if (kept_ != nullptr) {
                document_.geometry.take(sizeof(PlacedInstance));
                kept_->placed.push_back({.instance = static_cast<int>(scene_.instances.size()),
                                         .node = static_cast<int>(index),
                                         .at_world = at_world,
                                         .in_node = in_node});
            }
            scene_.instances.push_back({mesh_of_scene, to_mat4(placed)});
            node_of_instance_.push_back(static_cast<int>(index));
            document_.info.triangles_drawn += triangles_of(scene_.meshes[static_cast<std::size_t>(mesh_of_scene)]);
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

    [[nodiscard]] bool is_hidden(std::size_t node) const { return !tree_.hidden.empty() && tree_.hidden[node]; }

    /// Reads the mesh of a node, and poses it.
    std::vector<Made> make(std::size_t node_index, const std::vector<double>& weights) {
        const file::Node& node = document_.file.nodes[node_index];
        const auto mesh = static_cast<std::size_t>(node.mesh);
        const bool morphs = document_.animations.morphs_node(node_index), hides = document_.animations.hides_node(node_index);
        std::vector<Made> made;
        const auto& primitives = document_.file.meshes[mesh].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            check_time();
            // All targets are read if any may be used at another time.
            std::optional<ReadMesh> read;
            try {
                read = reader_.read(mesh, p, morphs ? std::vector<double>(primitives[p].targets.size(), 1.0) : weights);
            } catch (const LoadFailure& failure) {
                document_.go_on_without(failure, "the primitive is left out");
            }
            if (!read) continue;
            const bool skinned = node.skin >= 0 && has_skin(node.skin, primitives[p], *read);
            if (skinned) turn_if_mirrored(node_index, read->source.mesh);
            complete(*read);
            const std::vector<Affine> joints = skinned ? joints_of(node.skin) : std::vector<Affine>();
            const bool kept = kept_ != nullptr && (skinned || morphs || hides);
            if (kept) document_.geometry.take(bytes_of(read->source.mesh));
            MeshSource& source = read->source;
            Posed posed = pose_mesh(kept ? source.mesh : std::move(source.mesh), source, weights, joints,
                                    document_.options.recentre ? std::nullopt : std::optional(Vec3d{}));
            if (is_hidden(node_index)) posed.mesh = without_triangles(posed.mesh);
            document_.info.vertices += posed.mesh.positions.size();
            document_.info.triangles_stored += triangles_of(posed.mesh);
            const int index = static_cast<int>(scene_.meshes.size());
            made.push_back({index, skinned ? std::optional(posed.place) : std::nullopt});
            scene_.meshes.push_back(std::move(posed.mesh));
            if (kept)
                kept_->deformed.push_back({.mesh = index,
                                           .node = static_cast<int>(node_index),
                                           .skin = skinned ? node.skin : -1,
                                           .source = std::move(source),
                                           .place = posed.place});
        }
        return made;
    }

    [[nodiscard]] bool is_mirrored(std::size_t node) const {
        const Affine& world = tree_.world_from_node[node];
        return dot(cross(world.c[0], world.c[1]), world.c[2]) < 0.0;
    }

    /// A skinned mesh is placed without its node's transform, whose sign yet says which sides of its triangles are front sides (glTF 2.0,
    /// 3.7.4).
    void turn_if_mirrored(std::size_t node, Mesh& mesh) const {
        if (mesh.topology != Topology::triangles || !is_mirrored(node)) return;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    }

    /// Reads the skin of a mesh. False: it is drawn as a plain mesh.
    bool has_skin(int skin, const file::Primitive& primitive, ReadMesh& read) {
        if (read.source.mesh.splats != nullptr) {
            document_.warn(fmt::format("{}: a skin does not move 3D Gaussians; drawn as they stand", read.where));
            return false;
        }
        try {
            if (read_influences(document_, accessors_, reader_, skin, primitive, read)) {
                joints_of(skin);
                return true;
            }
            document_.warn(fmt::format("{}: has a skin, but no JOINTS_0 and WEIGHTS_0; drawn as a plain mesh", read.where));
        } catch (const LoadFailure& failure) {
            document_.go_on_without(failure, "drawn as a plain mesh");
        }
        read.source.sets = 0;
        read.source.influences.clear();
        return false;
    }

    std::vector<Affine> joints_of(int index) {
        auto entry = skins_.find(index);
        if (entry == skins_.end()) {
            entry = skins_.emplace(index, read_skin(document_, accessors_, index)).first;  // one that cannot be read fails again
            if (kept_ != nullptr) kept_->skins.emplace(index, entry->second);
        }
        document_.geometry.take(entry->second.joints.size() * sizeof(Affine));
        return joint_matrices(entry->second, tree_.world_from_node);
    }

    /// Notes what the mesh lacks: flat normals if there are none, and tangents if the material needs them.
    void complete(ReadMesh& read) {
        MeshSource& source = read.source;
        const Mesh& mesh = source.mesh;
        const std::uint64_t corners = mesh.indices.size();
        if (mesh.topology != Topology::triangles) {
            if (mesh.material >= 0) check_texture_coordinates(read);
            // Points and lines without normals are not lit (glTF 2.0, 3.7.2.1).
            if (mesh.normals.empty()) source.mesh.material = unlit_copy(mesh.material);
            return;
        }
        source.flat_normals = mesh.normals.empty();
        if (source.flat_normals)
            document_.geometry.take(corners *
                                    (24 + (mesh.uv0.empty() ? 0 : 8) + (mesh.uv1.empty() ? 0 : 8) + (mesh.colors.empty() ? 0 : 16)));
        if (mesh.material < 0) return;
        check_texture_coordinates(read);
        if (!mesh.tangents.empty()) return;
        const Material& material = scene_.materials[static_cast<std::size_t>(mesh.material)];
        const std::optional<int> uv_set = shading::tangent_uv_set(material);
        if (!uv_set) return;
        if ((*uv_set == 1 ? mesh.uv1 : mesh.uv0).empty()) {
            if (material.is_anisotropic() && !material.textures[TextureSlot::anisotropy].used() && !document_.warnings_are_full())
                document_.warn(
                    fmt::format("materials[{}].extensions.KHR_materials_anisotropy: {} has no tangents and no TEXCOORD_{}, drawn "
                                "without it",
                                mesh.material, read.where, *uv_set));
            return;
        }
        document_.geometry.take(corners * 16);
        source.tangents_of = *uv_set;
    }

    /// Index of a material without light.
    int unlit_copy(int material) {
        if (material >= 0 && scene_.materials[static_cast<std::size_t>(material)].unlit) return material;
        std::vector<int>& copies = document_.unlit_copies;
        const auto [known, is_new] = unlit_copies_.try_emplace(material, static_cast<int>(scene_.materials.size() + copies.size()));
        if (is_new) copies.push_back(material);
        return known->second;
    }

    /// Warns of textures of the material for which the mesh has no coordinates.
    void check_texture_coordinates(const ReadMesh& read) {
        const Material& material = scene_.materials[static_cast<std::size_t>(read.source.mesh.material)];
        for (const TextureSlot slot : shading::kAllTextureSlots) {
            const TextureUse& use = material.textures[slot];
            if (!use.used() || !(use.uv_set == 1 ? read.source.mesh.uv1 : read.source.mesh.uv0).empty() || document_.warnings_are_full())
                continue;
            document_.warn(fmt::format(
                "materials[{}].{}: {} has no TEXCOORD_{}, {}", read.source.mesh.material, file::place_of(slot), read.where, use.uv_set,
                shading::needs_tangents(slot) && read.source.mesh.tangents.empty() ? "drawn without it"
                                                                                   : "drawn with the colour at (0, 0)"));
        }
    }

    Document& document_;
    const std::vector<Accessor>& accessors_;
    const NodeTree& tree_;
    PoseSources* kept_;
    Scene& scene_;
    std::vector<Node>& nodes_;
    std::vector<int>& node_of_instance_;
    PrimitiveReader reader_;
    std::map<Key, std::vector<Made>> made_;
    std::map<int, Skin> skins_;
    std::map<int, int> unlit_copies_;
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
            if (primitive.material >= 0) used[static_cast<std::size_t>(primitive.material)] = true;
    }
    return used;
}

void place_meshes(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, LoadedScene& loaded,
                  PoseSources* kept) {
    MeshPlacer(document, accessors, tree, loaded, kept).run();
}

}  // namespace halflit::io::detail
