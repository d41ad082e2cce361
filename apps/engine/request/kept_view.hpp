// A framed view that is kept: later versions of a model are drawn by the camera that was chosen for an earlier one, so a part that is added
// changes its own pixels alone.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/error.hpp"
#include "halflit/model.hpp"
#include "halflit/settings.hpp"

#include <string>
#include <string_view>

namespace halflit::engine {

/// Lengths are in the file's unit, and coordinates are the file's.
struct KeptView {
    Vec3d eye, right, up, back;  ///< the camera's position and axes
    bool orthographic = false;
    double fov_y_rad = 0, half_height = 0;  ///< of a perspective camera the first, of another one the second
    double near_z = 0, far_z = 0;
    Vec3d low, high;        ///< corners of the scene's box: exposure and soft light are chosen by it
    bool empty = false;     ///< the scene had no box
    double point_size = 0;  ///< pixels
    Vec3d background;       ///< linear; where no other is given
    friend bool operator==(const KeptView&, const KeptView&) = default;
};

/// The view that keeps this camera, which a framing has made, and what was chosen of the settings. bounds: of the scene.
[[nodiscard]] KeptView kept_view(const Camera& camera, const Bounds& bounds, const Settings& settings, const Placement& placement);

/// The camera in the world that is drawn. Its near and far planes move where the scene's box, `bounds`, reaches beyond them.
[[nodiscard]] Camera camera_of(const KeptView& view, const Placement& placement, const Bounds& bounds);

/// The box that was kept, in the world that is drawn.
[[nodiscard]] Bounds bounds_of(const KeptView& view, const Placement& placement);

/// "eye=1,2,3 right=1,0,0 .. background=0,0,0": each number by the least digits that give it back.
[[nodiscard]] std::string kept_view_text(const KeptView& view);
/// Reads it back. Fails (bad_input) for a key that is unknown, missing or there twice, and for a number that is not finite.
[[nodiscard]] Result<KeptView> parse_kept_view(std::string_view text);

}  // namespace halflit::engine
