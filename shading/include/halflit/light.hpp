// Light sources. Positions and directions are in world space. Colours are linear and premultiplied by 1/pi: a directional light of colour 1
// makes a white Lambert surface that faces it exactly 1 (a unit directional light is a radiance of pi times a delta function).
#pragma once

#include "halflit/math.hpp"

#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>

namespace halflit {

/// Shape of a source's light.
enum class LightType : std::uint8_t {
    directional,  ///< parallel, from infinitely far
    point,        ///< in all directions from a point; falls off with the squared distance
    spot          ///< a point light inside a cone
};

/// The members of a Light that count for its type: the one list of the kinds of lights.
struct LightKind {
    std::string_view name;  ///< in files, flags and reports
    bool placed = false;    ///< position_ws, range and source_radius; its light falls off with the squared distance
    bool aimed = false;     ///< direction_ws
    bool cone = false;      ///< inner_cone_rad, outer_cone_rad and cone_power
};

/// Indexed by LightType.
inline constexpr LightKind kLightKinds[] = {
    {.name = "directional", .aimed = true},
    {.name = "point", .placed = true},
    {.name = "spot", .placed = true, .aimed = true, .cone = true},
};

/// The kind of a type.
[[nodiscard]] constexpr const LightKind& kind_of(LightType type) { return kLightKinds[static_cast<int>(type)]; }
/// The type by its name; nothing for another name.
[[nodiscard]] constexpr std::optional<LightType> light_type_of(std::string_view name) {
    for (int i = 0; i < static_cast<int>(std::size(kLightKinds)); ++i)
        if (kLightKinds[i].name == name) return static_cast<LightType>(i);
    return {};
}

/// Largest shadow_radius of a directional light; larger ones count as this.
inline constexpr float kMaxLightAngle = 0.7f;

/// A source of light. Members that its type does not name are ignored. cone_power is [CMSC]'s.
struct Light {
    LightType type = LightType::directional;  ///< decides which members count
    Vec3f color_linear{1, 1, 1};              ///< directional: irradiance / pi; point, spot: the same at distance 1
    Vec3f position_ws{0, 0, 0};               ///< point, spot: world space
    Vec3f direction_ws{0, -1, 0};             ///< directional, spot: the way the light travels, of any length above 0
    float range = 0.0f;                       ///< point, spot: no light beyond this distance, world units; 0: no limit
    float source_radius = 0.0f;               ///< point, spot: smaller distances count as this, world units; 0: 1e-4
    float inner_cone_rad = 0.0f;              ///< spot: full light up to this angle from the axis
    float outer_cone_rad = 0.785398163f;      ///< spot: no light from this angle on
    float cone_power = 0.0f;                  ///< spot: factor cos(angle from the axis)^cone_power, 0 to 1e5
    /// Size of the source, which makes its shadows soft and changes nothing else. Directional: the angle from its middle to its rim,
    /// radians, up to 0.7 (the sun's is 0.00465). Point, spot: radius of a ball, world units. 0: a point, with sharp shadows.
    float shadow_radius = 0.0f;
    friend bool operator==(const Light&, const Light&) = default;
};

/// Ambient light from all around, blended between ground and sky: L(n) = ground + (sky - ground) (1 + n.y) / 2.
struct Ambient {
    Vec3f sky_linear{0, 0, 0};     ///< L(0, 1, 0)
    Vec3f ground_linear{0, 0, 0};  ///< L(0, -1, 0)
    friend bool operator==(const Ambient&, const Ambient&) = default;
};

}  // namespace halflit
