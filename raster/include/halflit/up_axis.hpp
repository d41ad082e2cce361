// The axis of a model that points up. Scenes are drawn with y up.
#pragma once

#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/scene.hpp"

#include <cstdint>
#include <string_view>

namespace halflit {

/// The axis of a model's own coordinates that points up.
enum class UpAxis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };

/// Indexed by UpAxis.
inline constexpr std::string_view kUpAxisNames[] = {"x", "y", "z", "-x", "-y", "-z"};

/// A point or direction by the quarter turns that take `up` to +y. Exact.
[[nodiscard]] constexpr Vec3d turned_upright(Vec3d v, UpAxis up) {
    switch (up) {
        case UpAxis::x:
            return {0.0 - v.y, v.x, v.z};
        case UpAxis::y:
            return v;
        case UpAxis::z:
            return {v.x, v.z, 0.0 - v.y};
        case UpAxis::minus_x:
            return {v.y, 0.0 - v.x, v.z};
        case UpAxis::minus_y:
            return {v.x, 0.0 - v.y, 0.0 - v.z};
        case UpAxis::minus_z:
            return {v.x, 0.0 - v.z, v.y};
    }
    return v;
}

/// The way back: turned_back(turned_upright(v, up), up) is v. Exact.
[[nodiscard]] constexpr Vec3d turned_back(Vec3d v, UpAxis up) {
    switch (up) {
        case UpAxis::x:
            return {v.y, 0.0 - v.x, v.z};
        case UpAxis::y:
            return v;
        case UpAxis::z:
            return {v.x, 0.0 - v.z, v.y};
        case UpAxis::minus_x:
            return {0.0 - v.y, v.x, v.z};
        case UpAxis::minus_y:
            return {v.x, 0.0 - v.y, 0.0 - v.z};
        case UpAxis::minus_z:
            return {v.x, v.z, 0.0 - v.y};
    }
    return v;
}

/// @{
/// The same turns of a transform's columns: of what it places.
[[nodiscard]] HALFLIT_API Mat4 turned_upright(const Mat4& m, UpAxis up);
[[nodiscard]] HALFLIT_API Mat4 turned_back(const Mat4& m, UpAxis up);
/// @}
/// @{
/// The same turns of a light.
[[nodiscard]] HALFLIT_API Light turned_upright(Light light, UpAxis up);
[[nodiscard]] HALFLIT_API Light turned_back(Light light, UpAxis up);
/// @}

/// Turns a scene of a host's own, whose vertical axis is another: instances, cameras and lights, by quarter turns that take `up` to +y.
/// Files are turned while they are read (LoadOptions::up). What is added later, and cameras, go through turned_upright() one by one.
HALFLIT_API void turn_upright(Scene& scene, UpAxis up);

}  // namespace halflit
