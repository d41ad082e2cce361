// Parsers of flag values: text to numbers, sizes, colours, lights. They do not depend on the locale and accept no trailing text. Errors are
// usage errors that say what was expected.
#pragma once

#include "halflit/error.hpp"
#include "halflit/light.hpp"
#include "halflit/renderer.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace halflit::engine {

[[nodiscard]] Result<std::int64_t> parse_int(std::string_view text, std::int64_t min, std::int64_t max);

/// A finite number in [min, max].
[[nodiscard]] Result<float> parse_float(std::string_view text, float min, float max);

/// "0.5%" or "0.005": a share from 0 to 1.
[[nodiscard]] Result<double> parse_share(std::string_view text);

/// "99.9" or "99.9%": a number above 0 and below 100.
[[nodiscard]] Result<double> parse_percent(std::string_view text);

/// Mebibytes from 32, as bytes.
[[nodiscard]] Result<std::size_t> parse_memory(std::string_view text);

/// Seconds within a year or so of 0.
[[nodiscard]] Result<double> parse_time(std::string_view text);

/// "X,Y,Z": three numbers within the range of float. In double, as a scene may be moved before it is drawn.
[[nodiscard]] Result<Vec3d> parse_point(std::string_view text);

/// A plane that cuts the scene, as --section gives it.
struct GivenSection {
    std::string text{};     ///< as given
    Vec3d normal{};         ///< towards what is removed, along the axes of the file
    double offset = 0.0;    ///< keeps dot(normal, p) <= offset; of a share the share, from 0 to 1
    bool is_share = false;  ///< the normal is an axis or its opposite, and the plane lies at this share of the scene's size along the axis
};

/// "AXIS=POSITION" keeps what is below the position on that axis, "-AXIS=POSITION" what is above it; AXIS is x, y or z, POSITION a number
/// or a share of the size of the scene, "50%". "A,B,C,D" keeps A x + B y + C z <= D.
[[nodiscard]] Result<GivenSection> parse_section(std::string_view text);

/// "1280x720" or "1280,720", or "256" for a square. Sides from 1 to 2^31 - 1; make_render_job checks the number of pixels.
[[nodiscard]] Result<PictureSize> parse_size(std::string_view text);

/// A pixel of the picture, from its upper left corner.
struct PixelPlace {
    int x = 0, y = 0;
};

/// "X,Y" from 0.
[[nodiscard]] Result<PixelPlace> parse_pixel(std::string_view text);

/// "X,Y,W,H" with X and Y from 0, W and H from 1.
[[nodiscard]] Result<Region> parse_region(std::string_view text);

/// "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", a name of CSS 2 in any case, or "transparent", to linear light with linear alpha.
[[nodiscard]] Result<Vec4f> parse_color(std::string_view text);
/// The same without alpha.
[[nodiscard]] Result<Vec3f> parse_rgb(std::string_view text);

/// A light, and the position that was given for it, which the light holds rounded to float.
struct GivenLight {
    Light light;
    Vec3d position{};
};

/// "TYPE:key=value:key=value..." where TYPE is directional, point or spot; ';' separates as well as ':'.
///     dir=X,Y,Z      directional, spot: the way the light travels (default 0,-1,0)
///     pos=X,Y,Z      point, spot: where it is (default 0,0,0)
///     color=COLOR    as parse_color (default white)
///     intensity=N    factor; 1 makes a white surface that faces the light white: anywhere (directional), at distance 1 (point, spot)
///     range=N        point, spot: nothing beyond (default: no limit)
///     radius=N       point, spot: radius of the source; attenuation treats smaller distances as N
///     size=N         soft shadows: radius of the source, world units; directional: angle from its middle to its rim, degrees (default 0)
///     cone=OUT or cone=IN,OUT   spot: half angles in degrees, full light within IN (default 0), none from OUT (default 45)
///     power=N        spot: factor cos(angle to the axis)^N, 0 to 1e5 (default 0)
[[nodiscard]] Result<GivenLight> parse_light(std::string_view text);

}  // namespace halflit::engine
