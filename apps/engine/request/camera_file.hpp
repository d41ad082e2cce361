// Files of cameras: halflit's own JSON (answers/camera_json.hpp writes it) and reports, transforms.json of NeRF and instant-ngp, COLMAP's
// text model, and the cameras of a glTF file.
#pragma once

#include "apps/engine/request/given_camera.hpp"
#include "apps/engine/request/render_options.hpp"
#include "halflit/error.hpp"
#include "halflit/model.hpp"

#include <string>
#include <string_view>

namespace halflit::engine {

/// Reads --camera-file, if there is one and it is not read yet, and puts the names of all its cameras' pictures into the views for
/// --camera all. Its format is found by its content; of a folder, it is the images.txt. The file is not trusted: sizes, depth and counts
/// are limited, and numbers checked. Warns of lenses with distortion, which is left out.
[[nodiscard]] Result<void> settle_cameras(RenderOptions& options);

namespace detail {

inline constexpr std::size_t kMostCameras = 100'000;

/// Warning of a lens whose distortion is left out.
inline constexpr const char* kDistorted = "the lens of a camera has distortion, which is left out";

/// Refuses a picture's size of a camera that no picture can have.
[[nodiscard]] Result<PictureSize> checked_size(double width, double height);

/// Cameras of JSON: halflit's own, those of its reports (of render for several pictures, one a line), or with `frames` those of NeRF.
/// Errors have no file prefix.
[[nodiscard]] Result<void> read_json_cameras(std::string_view text, CameraFile& into);

/// Cameras of COLMAP's images.txt and cameras.txt.
[[nodiscard]] Result<void> read_colmap_cameras(std::string_view images, std::string_view cameras, CameraFile& into);

}  // namespace detail
}  // namespace halflit::engine
