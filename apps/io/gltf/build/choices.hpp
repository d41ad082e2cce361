// Choices that a caller makes for a file: its scene and the variant of its materials, by name, and what is wrong for any file.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <string>
#include <vector>

namespace halflit::io::detail {

/// Sets File::scene by LoadOptions::scene, and the names in SceneInfo. Throws LoadFailure (usage) for one that the file does not have.
void choose_scene(Document& document);

/// Gives each primitive the material of LoadOptions::variant. Throws LoadFailure (usage) for one that the file does not have.
void choose_variant(Document& document);

/// @{
/// Throws LoadFailure (usage) for a value that no file may be read with.
void check_threads(const LoadOptions& options);
void check_pose_time(const LoadOptions& options);
/// @}

/// Position of a name or, if there is none, of an index; -1: neither.
[[nodiscard]] int name_or_index(const std::vector<std::string>& names, const std::string& wanted);

/// Index of the animation that LoadOptions::animation and pose_at mean: a name, an index, empty for the first, or "none". -1: none.
/// Throws LoadFailure (usage).
[[nodiscard]] int choose_animation(const std::vector<std::string>& names, const std::string& wanted);

/// Refuses a choice for a file of another format, which has one scene without a name, no variants and no animations.
void refuse_choices(const LoadOptions& options);

}  // namespace halflit::io::detail
