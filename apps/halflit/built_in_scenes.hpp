// Scenes that need no file.
#pragma once

#include "raster/scene.hpp"
#include "shading/result.hpp"

#include <optional>
#include <string_view>

namespace halflit::cli {

/// "demo": raster::demo_scene(). "sphere:N": a smooth sphere of about N triangles under two lights, its camera so close that its outline
/// touches the upper and lower edge of the picture. Nothing for any other name; an error when N is not a count in [12, 2^26].
[[nodiscard]] Result<std::optional<raster::Scene>> built_in_scene(std::string_view name);

}  // namespace halflit::cli
