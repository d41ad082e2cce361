// Light of a sphere: what a Lambert surface reflects of it in closed form, and the lobes of one directional light that come nearest to it.
#pragma once

#include "sh/zonal.hpp"

#include <cstdint>

namespace halflit::cli {

/// Light that a Lambert surface reflects of a sphere of uniform radiance. x: cosine between the normal and the direction to the sphere's
/// centre. radius_rad: angular radius of the sphere as seen from the surface, above 0, up to pi/2. 1 where the normal faces the sphere, so
/// that it compares with a lobe. The part of the sphere below the horizon gives no light.
[[nodiscard]] double sphere_light(double x, double radius_rad);

/// Families of lobes that are fitted to a sphere's light.
enum class LobeFamily : std::uint8_t {
    green,  ///< n = 1
    sloan,  ///< n = 1 + w
    any     ///< w and n are free
};

struct LobeFit {
    sh::WrapLobe lobe;
    double rms = 0;    ///< root of the mean square over all directions of the normal; a full peak is 1
    double worst = 0;  ///< largest difference
};

/// Difference of a lobe from the sphere's light.
[[nodiscard]] LobeFit lobe_against_sphere(const sh::WrapLobe& lobe, double radius_rad);

/// The lobe of the family, w in [0, 1], with the least rms. Every direction of the normal weighs the same: on a ball, every patch of its
/// surface.
[[nodiscard]] LobeFit fit_sphere_light(LobeFamily family, double radius_rad);

}  // namespace halflit::cli
