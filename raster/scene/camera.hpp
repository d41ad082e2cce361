// Cameras. A camera sits at the origin of its own space, looks along -z, with +x to the right and +y up (glTF).
#pragma once

#include "sh/mat4.hpp"

#include <string>

namespace halflit::raster {

struct Camera {
    std::string name;
    Mat4 world_from_camera;  ///< rigid: rotation and translation
    bool orthographic = false;
    float fov_y_rad = 0.785398163f;  ///< perspective: full vertical angle, in (0, pi)
    float aspect = 0.0f;             ///< perspective: width / height that the view is made for; 0: that of the picture
    float half_height = 1.0f;        ///< orthographic: half the height of the view; half_width likewise, 0: from the picture's aspect
    float half_width = 0.0f;
    float near_z = 0.1f;  ///< > 0 for perspective
    float far_z = 0.0f;   ///< > near_z; 0: no far limit (perspective only)
    friend bool operator==(const Camera&, const Camera&) = default;
};

}  // namespace halflit::raster
