// Places around a target, as <model-viewer>'s attribute camera-orbit gives them.
#pragma once

#include "halflit/error.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace halflit::engine {

struct CameraOrbit {
    std::string text{};             ///< as given
    double theta_deg = 0;           ///< about the vertical, from +z towards +x
    double phi_deg = 75;            ///< from straight above, 0 to 180
    double distance = 0;            ///< from the target, in the file's unit, if there is no share
    std::optional<double> share{};  ///< of the distance that shows the scene from all sides
};

/// "THETA PHI RADIUS": angles in deg, rad or without a unit (degrees), the radius in m or without a unit (the file's unit), cm or mm
/// (hundredths and thousandths of it), or %. auto: 0deg, 75deg and 100%.
[[nodiscard]] Result<CameraOrbit> parse_camera_orbit(std::string_view text);

}  // namespace halflit::engine
