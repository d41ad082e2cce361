// The part of a shadow map's view that the picture needs: where something that casts a shadow lies between the light and what is seen.
#pragma once

#include "halflit/mesh.hpp"
#include "raster/view/projection.hpp"
#include "raster/view/shadow_fit.hpp"
#include "raster/view/shadow_polygon.hpp"
#include "raster/view/view.hpp"

#include <optional>
#include <vector>

namespace halflit::raster {

/// Surface of the convex body that holds all that a picture may show: polygons, some of which may be empty. The body is the common part of
/// the camera's view and the scene's bounds, both a little enlarged.
struct SeenVolume {
    std::vector<Polygon> sides;
    double pixel = 0;  ///< height or width of a pixel, whichever is less, world units; with perspective at depth 1
    // Used by pictures with perspective:
    bool perspective = false;
    HalfSpace axis;             ///< its value at a point is the depth, the distance along the camera's axis
    Range depth;                ///< depths in view; the near plane's is the least
    HalfSpace view[6];          ///< the camera's view
    Vec3d near_corner[4] = {};  ///< corners of the view at the least depth
};

/// The part of it up to a depth.
[[nodiscard]] SeenVolume up_to(const SeenVolume& seen, double depth);

/// The volume that the whole window of `picture` sees, whatever its region. Nothing if the camera's matrix has no inverse.
[[nodiscard]] std::optional<SeenVolume> seen_volume(const View& picture, const DepthMap& depth, const Bounds& scene);

/// True if a camera with a square field of view may see some of it; see can_see() of boxes. half: tangent of half the field of view.
[[nodiscard]] bool can_see(const ViewAxes& axes, Vec3d eye, double half, const SeenVolume& seen);

/// Depth of its nearest point in a light's view; 0 if the view does not see all of it.
[[nodiscard]] double nearest_if_all_seen(const FittedView& view, const SeenVolume& seen);

enum class MapUse { whole, cut, none };  ///< none: nothing that is seen can lie in a shadow

/// Cuts a view to what the picture needs of it, if texels become at most half as wide. size: texels on a side of the map. Windows come
/// from a ladder that depends on the view and the size alone: widths are the view's over 2, 3, 4, 6, 8 .., and corners are multiples of an
/// eighth of the map. So texels of one width are the same texels for every camera, and a camera that moves a little gets the same map.
[[nodiscard]] MapUse cut_view(FittedView& view, bool orthographic, int size, const SeenVolume& seen, const Bounds& scene);

/// Rung of the narrowest window on the ladder that shows what a directional view has to show: 0 is the whole view, and two rungs halve the
/// width. Nothing: nothing that is seen can lie in a shadow.
[[nodiscard]] std::optional<int> ladder_rung(const FittedView& view, int size, const SeenVolume& seen);

/// Width of that window, and of its texels.
[[nodiscard]] double ladder_width(const FittedView& view, int rung);
[[nodiscard]] double ladder_texel(const FittedView& view, int rung, int size);

}  // namespace halflit::raster
