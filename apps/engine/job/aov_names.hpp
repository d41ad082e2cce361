// Texts beside the files of --aov: names of what is numbered, and the scale of depths.
#pragma once

#include "apps/engine/job/aov.hpp"
#include "apps/engine/job/scene_source.hpp"

#include <cstdint>
#include <string>

namespace halflit::engine {

/// Number of the file's node that places an instance, plus 1, by the instance's number; 0: none.
[[nodiscard]] std::uint32_t part_number(const SceneSource& source, std::uint32_t instance);

/// JSON: of each instance its part, mesh and material, and the names of parts, meshes and materials. All numbers are those of the files,
/// index plus 1; 0: none.
[[nodiscard]] std::string names_text(const SceneSource& source);

/// JSON: the depths of the codes 1 and 65535.
[[nodiscard]] std::string depth16_text(const DepthRange& range);

}  // namespace halflit::engine
