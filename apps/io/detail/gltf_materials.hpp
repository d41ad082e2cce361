// Materials: glTF's parameters, the extensions that change them, and this project's own extras.halflit.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_images.hpp"
#include "halflit/material.hpp"
#include "halflit/scene.hpp"

#include <vector>

namespace halflit::io::detail {

/// All materials of the file, in its order, so that indices stay. Textures of materials that no drawn primitive uses
/// (`used` false) are not read. Throws LoadFailure.
std::vector<Material> make_materials(Document& document, ImageStore& images, const std::vector<bool>& used);

/// Takes thicknesses, which the file gives in the space of meshes, to world space, by the scale of each material's first instance.
void scale_thickness(Scene& scene);

}  // namespace halflit::io::detail
