#include "apps/io/gltf/file/used.hpp"

#include "sh/time_limit.hpp"

#include <algorithm>
#include <utility>

namespace halflit::io::detail {

class UseFinder {
public:
    UseFinder(const file::File& file, const AnimationUse& animations) : file_(file), animations_(animations) {
        for (std::size_t target = 0; target < kTargets; ++target)
            used_.of_[target].assign(count_of(static_cast<Target>(target), file), false);
        targets_seen_.resize(file.meshes.size());
        has_own_weights_.resize(file.meshes.size());
        skinned_.resize(file.meshes.size());
    }

    Used run(std::span<const int> drawn_nodes, std::span<const int> parents) {
        mark(Target::scenes, std::max(file_.scene, 0));
        for (const int node : drawn_nodes) {
            place(node, parents);
            follow(static_cast<std::size_t>(node));
        }
        for (const AnimationUse::Used& used : animations_.used) follow(used);
        for (std::size_t skin = 0; skin < file_.skins.size(); ++skin)
            if (used_.of_[static_cast<std::size_t>(Target::skins)][skin])
                for (const int joint : file_.skins[skin].joints) place(joint, parents);
        return std::move(used_);
    }

private:
    /// True if the element is there and was not marked before.
    bool mark(Target target, int element) {
        std::vector<bool>& list = used_.of_[static_cast<std::size_t>(target)];
        if (element < 0 || static_cast<std::size_t>(element) >= list.size() || list[static_cast<std::size_t>(element)]) return false;
        list[static_cast<std::size_t>(element)] = true;
        return true;
    }

    /// Marks a node and all above it, whose transforms place it. They need not be in the scene.
    void place(int node, std::span<const int> parents) {
        while (mark(Target::nodes, node)) node = parents[static_cast<std::size_t>(node)];
    }

    /// The samplers of the channels that move something. Those that move nothing may be anything.
    void follow(const AnimationUse::Used& used) {
        mark(Target::animations, used.animation);
        const file::Animation& animation = file_.animations[static_cast<std::size_t>(used.animation)];
        for (const AnimationUse::Channel& channel : used.channels) {
            const int sampler = animation.channels[channel.channel].sampler;
            if (sampler < 0 || static_cast<std::size_t>(sampler) >= animation.samplers.size()) continue;
            accessor(animation.samplers[static_cast<std::size_t>(sampler)].input);
            accessor(animation.samplers[static_cast<std::size_t>(sampler)].output);
        }
    }

    void follow(std::size_t number) {
        const file::Node& node = file_.nodes[number];
        mark(Target::cameras, node.camera);
        mark(Target::lights, node.light);
        if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= file_.meshes.size()) return;
        const auto index = static_cast<std::size_t>(node.mesh);
        const file::Mesh& mesh = file_.meshes[index];
        if (mark(Target::meshes, node.mesh))
            for (const file::Primitive& primitive : mesh.primitives) follow(primitive);
        if (animations_.morphs_node(number)) {
            std::size_t most = 0;
            for (const file::Primitive& primitive : mesh.primitives) most = std::max(most, primitive.targets.size());
            charge_work(mesh.primitives.size() + most);
            follow_targets(index, std::vector<double>(most, 1.0));
        } else if (node.weights.count > 0) {
            follow_targets(index, std::span(file_.weights).subspan(node.weights.first, node.weights.count));
        } else if (!has_own_weights_[index]) {
            has_own_weights_[index] = true;
            follow_targets(index, mesh.weights);
        }
        if (node.instancing >= 0)
            for (const auto& [name, value] : file_.instancings[static_cast<std::size_t>(node.instancing)])
                if (file::is_of_instances(name)) accessor(value);
        if (node.skin < 0) return;
        if (mark(Target::skins, node.skin)) accessor(file_.skins[static_cast<std::size_t>(node.skin)].inverse_bind_matrices);
        if (skinned_[index]) return;
        skinned_[index] = true;
        for (const file::Primitive& primitive : mesh.primitives)
            for (const auto& [name, value] : primitive.attributes)
                if (file::is_of_skin(name)) accessor(value, !is_in_draco(primitive, name));
    }

    /// True if the attribute's data are decoded, so that those of its accessor are not read.
    [[nodiscard]] bool is_in_draco(const file::Primitive& primitive, std::string_view attribute) const {
        return primitive.draco >= 0 && file::find(file_.draco[static_cast<std::size_t>(primitive.draco)].attributes, attribute) >= 0;
    }

    void follow(const file::Primitive& primitive) {
        view(primitive.spz);
        for (const auto& [name, value] : primitive.attributes)
            if (primitive.spz < 0 && (file::is_drawn(name) || name.starts_with(file::kSplatAttributes)))
                accessor(value, !is_in_draco(primitive, name));
        accessor(primitive.indices, primitive.draco < 0);
        if (primitive.draco >= 0) view(file_.draco[static_cast<std::size_t>(primitive.draco)].buffer_view);
        if (!mark(Target::materials, primitive.material)) return;
        const file::Material& m = file_.materials[static_cast<std::size_t>(primitive.material)];
        for (const file::TexturePlace& place : m.places) texture(place.index);
        if (m.glossy < 0) return;
        const file::SpecularGlossiness& glossy = file_.glossy[static_cast<std::size_t>(m.glossy)];
        texture(glossy.diffuse_texture.index);
        texture(glossy.specular_glossiness_texture.index);
    }

    /// Morph targets with a weight other than 0.
    void follow_targets(std::size_t mesh, std::span<const double> weights) {
        check_time();
        std::vector<bool>& seen = targets_seen_[mesh];
        if (seen.size() < weights.size()) seen.resize(weights.size(), false);
        for (std::size_t t = 0; t < weights.size(); ++t) {
            if (weights[t] == 0.0 || seen[t]) continue;
            seen[t] = true;
            for (const file::Primitive& primitive : file_.meshes[mesh].primitives)
                if (t < primitive.targets.size())
                    for (const auto& [name, value] : primitive.targets[t])
                        if (file::is_drawn(name)) accessor(value);
        }
    }

    /// with_data: what the accessor's bufferViews hold is read too.
    void accessor(int index, bool with_data = true) {
        mark(Target::accessors, index);
        if (!with_data || index < 0 || static_cast<std::size_t>(index) >= file_.accessors.size()) return;
        const file::Accessor& entry = file_.accessors[static_cast<std::size_t>(index)];
        view(entry.buffer_view);
        if (entry.sparse < 0) return;
        view(file_.sparse[static_cast<std::size_t>(entry.sparse)].index_view);
        view(file_.sparse[static_cast<std::size_t>(entry.sparse)].value_view);
    }

    void view(int index) {
        if (!mark(Target::buffer_views, index)) return;
        const file::BufferView& entry = file_.buffer_views[static_cast<std::size_t>(index)];
        mark(Target::buffers,
             entry.compressed < 0 ? entry.buffer : file_.compressed_views[static_cast<std::size_t>(entry.compressed)].buffer);
    }

    void texture(int index) {
        if (!mark(Target::textures, index)) return;
        const file::Texture& entry = file_.textures[static_cast<std::size_t>(index)];
        mark(Target::samplers, entry.sampler);
        if (mark(Target::images, entry.source)) view(file_.images[static_cast<std::size_t>(entry.source)].buffer_view);
    }

    const file::File& file_;
    const AnimationUse& animations_;
    Used used_;
    // By mesh: targets that have been followed, whether its own weights have been, and whether its joints have been.
    std::vector<std::vector<bool>> targets_seen_;
    std::vector<bool> has_own_weights_, skinned_;
};

Used find_used(const file::File& file, const AnimationUse& animations, std::span<const int> drawn_nodes, std::span<const int> parents) {
    return UseFinder(file, animations).run(drawn_nodes, parents);
}

}  // namespace halflit::io::detail
