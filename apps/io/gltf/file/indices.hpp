// All indices of a file::File that its JSON text gives.
#pragma once

#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/file/target.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace halflit::io::detail {

/// In place of an index that is wrong or out of range. Other negative values: the file gives none.
inline constexpr int kBadIndex = -2;

/// visit(Target, int&) for the index of each member that a row of the schema fills. Negative: not there.
template <class Visit>
void for_each_index(file::File& file, const Visit& visit) {
    const auto attributes = [&](file::Attributes& list) {
        for (auto& [name, accessor] : list) visit(Target::accessors, accessor);
    };
    visit(Target::scenes, file.scene);
    for (file::Scene& scene : file.scenes)
        for (int& node : scene.nodes) visit(Target::nodes, node);
    for (file::Animation& animation : file.animations) {
        for (file::AnimationChannel& channel : animation.channels) visit(Target::nodes, channel.node);
        for (file::AnimationSampler& sampler : animation.samplers) {
            visit(Target::accessors, sampler.input);
            visit(Target::accessors, sampler.output);
        }
    }
    for (file::BufferView& view : file.buffer_views) visit(Target::buffers, view.buffer);
    for (file::CompressedView& view : file.compressed_views) visit(Target::buffers, view.buffer);
    for (file::Accessor& accessor : file.accessors) visit(Target::buffer_views, accessor.buffer_view);
    for (file::Sparse& sparse : file.sparse) {
        visit(Target::buffer_views, sparse.index_view);
        visit(Target::buffer_views, sparse.value_view);
    }
    for (file::Mesh& mesh : file.meshes)
        for (file::Primitive& primitive : mesh.primitives) {
            attributes(primitive.attributes);
            for (file::Attributes& target : primitive.targets) attributes(target);
            for (file::VariantMaterial& variant : primitive.variants) visit(Target::materials, variant.material);
            visit(Target::accessors, primitive.indices);
            visit(Target::materials, primitive.material);
            visit(Target::buffer_views, primitive.spz);
        }
    for (file::Draco& draco : file.draco) visit(Target::buffer_views, draco.buffer_view);
    for (file::Node& node : file.nodes) {
        visit(Target::meshes, node.mesh);
        visit(Target::skins, node.skin);
        visit(Target::cameras, node.camera);
        visit(Target::lights, node.light);
    }
    for (int& child : file.children) visit(Target::nodes, child);
    for (file::Attributes& list : file.instancings) attributes(list);
    for (file::Skin& skin : file.skins) {
        for (int& joint : skin.joints) visit(Target::nodes, joint);
        visit(Target::accessors, skin.inverse_bind_matrices);
    }
    for (file::Image& image : file.images) visit(Target::buffer_views, image.buffer_view);
    for (file::Texture& texture : file.textures) {
        visit(Target::images, texture.source);
        visit(Target::samplers, texture.sampler);
        visit(Target::images, texture.webp);
        visit(Target::images, texture.basisu);
    }
    for (file::Material& material : file.materials)
        for (file::TexturePlace& place : material.places) visit(Target::textures, place.index);
    for (file::SpecularGlossiness& glossy : file.glossy) {
        visit(Target::textures, glossy.diffuse_texture.index);
        visit(Target::textures, glossy.specular_glossiness_texture.index);
    }
}

/// list[index]. Throws LoadFailure where the list has no such element.
template <class List>
auto& element(List& list, int index, const char* name) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        refuse("", fmt::format("{}[{}] is used, but there are {}", name, index, list.size()));
    return list[static_cast<std::size_t>(index)];
}

}  // namespace halflit::io::detail
