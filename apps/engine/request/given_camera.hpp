// Cameras in the coordinates and along the axes of a model's file, as other programs have them.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/model.hpp"
#include "halflit/target.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

/// A camera in a model's own coordinates. The place is in double, as models may lie far from the origin.
struct GivenCamera {
    std::string name{};
    Vec3d right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};  ///< of the picture, unit vectors; the camera looks against `back`
    Vec3d eye{0, 0, 0};
    /// Lens; lengths are in the file's unit. The name and the place of this camera do not count.
    Camera lens{};
    std::optional<PictureSize> size{};  ///< of the picture that it is made for
    bool horizontal_fov = false;        ///< lens.fov_y_rad is the horizontal angle; pixels are square
};

/// Cameras of a file.
struct CameraFile {
    std::string path;
    std::vector<GivenCamera> cameras;   ///< one or more
    std::vector<std::string> warnings;  ///< one line each
};

/// Where a point of the file is drawn, as far as floats reach.
[[nodiscard]] Vec3d drawn_at(Vec3d point, const Placement& placement);

/// The camera in the scene, which draws the model at `placement`. bounds: of the scene, for completed().
[[nodiscard]] Camera placed(const GivenCamera& given, const Placement& placement, const Bounds& bounds);

/// The way back: a camera of the scene in the coordinates of the model's file, without a size.
[[nodiscard]] GivenCamera in_file(const Camera& camera, const Placement& placement);

/// A camera's place in the file by R and t of computer vision: x to the right, y down, z ahead; R row by row. The lens gets the sides of
/// `intrinsics`, and the camera their size. Fails as Camera::from_intrinsics does.
[[nodiscard]] Result<GivenCamera> camera_of(const Intrinsics& intrinsics, const std::array<double, 9>& rotation,
                                            const std::array<double, 3>& translation);

/// The camera with the place of a matrix, row by row, whose columns are right, up, back and the eye (OpenGL, glTF, Blender). Fails (usage)
/// for a matrix that is not rigid.
[[nodiscard]] Result<void> put_at(GivenCamera& camera, const std::array<double, 16>& world_from_camera);

/// Index of a camera by its name, or else its index; an empty text is the first one. Fails (usage) for one that the file does not have.
[[nodiscard]] Result<std::size_t> find_camera(const CameraFile& file, const std::string& wanted);

}  // namespace halflit::engine
