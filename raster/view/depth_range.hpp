// Depths of a picture: its camera's planes by what the scene holds, and what the near plane cuts off.
#pragma once

#include "halflit/camera.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/view.hpp"

#include <string>
#include <vector>

namespace halflit::raster {

/// Least and largest distance of a box along a view axis. back: unit vector against the view.
struct DepthSpan {
    double nearest, farthest;
    DepthSpan(Vec3d eye, Vec3d back, const Bounds& box);
};

/// completed(), with an orthographic camera's planes drawn in to the scene if they lie far outside of it: depths by parallel rays are
/// float32 shares of the way between the planes, so that planes far apart would leave none for the scene. The picture is cut as before.
/// drawn_camera() of the result is the same.
[[nodiscard]] Camera drawn_camera(const Camera& camera, const PreparedData& scene);

/// Adds a warning that names what the near plane cuts off, or hides as a whole, in the picture: surfaces between the eye and the plane, and
/// of an orthographic camera, which sees what is behind its eye where nothing is cut, those that cross the plane.
/// camera: of drawn_camera(). view: its picture.
void add_cut_warning(const PreparedData& scene, const Camera& camera, const View& view, std::vector<std::string>& warnings);

}  // namespace halflit::raster
