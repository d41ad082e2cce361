// Materials: glTF's parameters, the extensions that change them, and this project's own extras.halflit.
#pragma once

#include "apps/io/gltf/build/images.hpp"
#include "apps/io/gltf/file/document.hpp"
#include "halflit/material.hpp"
#include "halflit/scene.hpp"

#include <span>
#include <vector>

namespace halflit::io::detail {

/// All materials of the file, in its order, so that indices stay. Textures of materials that no drawn primitive uses
/// (`used` false) are not read. Throws LoadFailure.
std::vector<Material> make_materials(Document& document, ImageStore& images, const std::vector<bool>& used);

/// Sets a material's factors and the places of its textures as the file gives them. Thickness stays. Returns true if any changes.
bool set_material(const file::File& file, std::size_t index, Material& material);

/// Sets thicknesses, which the file gives in the space of meshes, in world space, by the scale of each material's first instance.
/// world_from_object: of the scene's first instances. Returns true if any changes.
bool set_thickness(const file::File& file, Scene& scene, std::span<const Mat4> world_from_object);

/// Where alpha would make all of the scene invisible, as some writers do that take 0 for opaque, its materials become opaque, with a
/// warning.
void make_visible(Document& document, Scene& scene);

}  // namespace halflit::io::detail
