// Choices that a caller makes by name: the scene of a file, and the variant of its materials.
#pragma once

#include "apps/io/detail/gltf_document.hpp"

namespace halflit::io::detail {

/// Sets File::scene by LoadOptions::scene, and the names in SceneInfo. Throws LoadFailure (usage) for one that the file does not have.
void choose_scene(Document& document);

/// Gives each primitive the material of LoadOptions::variant. Throws LoadFailure (usage) for one that the file does not have.
void choose_variant(Document& document);

/// Refuses a choice for a file of another format, which has one scene without a name and no variants.
void refuse_choices(const LoadOptions& options);

}  // namespace halflit::io::detail
