// Scenes that need no file.
#pragma once

#include "halflit/error.hpp"
#include "halflit/scene.hpp"

#include <optional>
#include <string_view>

namespace halflit::engine {

/// True for a name that built_in_scene takes for its own, with a number in range or not.
[[nodiscard]] bool is_built_in_name(std::string_view name);

/// "demo": demo_scene(). "sphere:N": a smooth sphere of about N triangles under two lights, its camera so close that its outline
/// touches the upper and lower edge of the picture; N in [12, 2^26]. "lights:N": raster::lights_scene() with N lights of limited range,
/// "lights:N:endless" without the limit; N in [1, 1024]. Empty for any other name; an error if N is out of range.
[[nodiscard]] Result<std::optional<Scene>> built_in_scene(std::string_view name);

}  // namespace halflit::engine
