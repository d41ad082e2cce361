// How clearly the edge of the first light of several can be seen on a ball, in numbers that compare with thresholds of vision.
//
// The ball has radius 1, its outline 10 degrees of the visual field. The first light comes from the right, so that along the middle row
// p = N.L: its light ends at p = -w. The other lights are spread evenly over the viewer's side. All are equally strong and sum to 1 - e,
// with an environment of constant radiance e.
#pragma once

#include "sh/vec3d.hpp"
#include "sh/zonal.hpp"

#include <vector>

namespace halflit::cli {

struct LightRig {
    int lights = 1;          ///< at least 1
    double environment = 0;  ///< e, in [0, 1)
};

inline constexpr double kBallRadiusDeg = 5;                         ///< radius of the ball, degrees of the visual field
inline constexpr double kEdgeStepDeg = 0.25;                        ///< half a period at 2 cycles a degree, where the eye is most sensitive
inline constexpr double kEdgeStep = kEdgeStepDeg / kBallRadiusDeg;  ///< the same in radii
inline constexpr double kFlare = 0.01;                              ///< light of the room on the screen, of white: IEC 61966-2-1
inline constexpr double kVisibleContrast = 0.01;                    ///< Weber's fraction of a visible step

/// Directions to the lights; the first is (1, 0, 0).
[[nodiscard]] std::vector<Vec3d> rig_directions(int lights);

/// Light reflected at p of the middle row, in [-1, 1], of all lights and the environment.
[[nodiscard]] double rig_light(const sh::WrapLobe& lobe, const LightRig& rig, double p);

/// The part of rig_light that is the first light's.
[[nodiscard]] double first_light(const sh::WrapLobe& lobe, const LightRig& rig, double p);

/// Points of the middle row within one step of the edge p = -w, with both neighbours on the ball.
[[nodiscard]] std::vector<double> edge_window(const sh::WrapLobe& lobe);

/// Contrast of the first light's edge: by how much its light departs from the mean of that one step to either side, relative to all light
/// and the flare; the largest in the window.
[[nodiscard]] double edge_contrast(const sh::WrapLobe& lobe, const LightRig& rig);

/// Largest second difference of the sRGB codes (0 to 255, not rounded) over one step to either side, in the window.
[[nodiscard]] double edge_codes(const sh::WrapLobe& lobe, const LightRig& rig);

/// Slope of the sRGB code, per unit of linear light in [0, 1].
[[nodiscard]] double code_slope(double linear);

/// Jump of the slope of the code where the first light ends on a Lambert surface, codes per degree of the visual field.
[[nodiscard]] double lambert_slope_jump(const LightRig& rig);

}  // namespace halflit::cli
