// The soft shadow below a model that stands: a map of how much of the sky the model hides from the ground that it stands on, laid over the
// picture's background. The ground is the level plane through the model's lowest point, and the eye lies above it, so what is drawn of the
// model always lies before its shadow.
//
// Each layer of covers is shifted along a direction down to the ground: what it covers there is hidden from the sky in that direction.
// Directions are spread so that each brings the same part of an even sky's light to the ground.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/target.hpp"
#include "raster/view/cover_grid.hpp"
#include "shading/reflection_map.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace halflit::raster {

/// Map of the ground below a scene, seen from above: 64 rows along x, one for each z.
struct ContactMap {
    std::vector<float> hidden;  ///< share of the sky at each cell's middle, 0 to 1, and 0 at the map's border; empty: nothing stands
    int low[2] = {64, 64}, high[2] = {-1, -1};  ///< cells along x and z from the first to the last whose share may be above 0
    double ground = 0;                          ///< its height, world space
    double first_x = 0, first_z = 0;            ///< middle of the first cell, world space
    double per_length = 0;                      ///< cells in a world unit
};

struct KeptContactMap {
    std::optional<SceneRevision> revision;  ///< of the covers that it was made of; none: nothing is made yet
    std::shared_ptr<const ContactMap> map;
};

/// Makes the map unless it is that of these covers already. A scene stands if its middle lies above its foot. Beside the foot the shadow
/// fades, and below a narrow one it is paler.
void make_contact_map(const CoverGrid& covers, const RasterKernels& kernels, const shading::ForEachRow& for_each, KeptContactMap& kept);

/// A contact shadow in a picture.
class ContactShadow {
public:
    ContactShadow() = default;
    /// opacity: of the shadow where all of the sky is hidden. Without effect by parallel rays, as drawings have none, and if
    /// the eye is not above the ground.
    ContactShadow(std::shared_ptr<const ContactMap> map, const Camera& camera, int width, int height, float opacity);

    /// False: there is none in all of the rectangle.
    [[nodiscard]] bool touches(const Region& rect) const;
    /// Opacities at the centres of `count` pixels from (x_px, y_px) on, at most kMaxTileSize, from 0 to 1; 0 at the picture's border. Each
    /// depends only on the pixel's position in the whole picture.
    void row(const RasterKernels& kernels, int x_px, int y_px, int count, float* opacity) const;

private:
    std::shared_ptr<const ContactMap> map_;  ///< null: no shadow
    Vec3d cell_of_x_, cell_of_z_, weight_;   ///< their products with (x, y, 1), pixels: homogeneous coordinates
    int width_ = 1, height_ = 1;
    double fade_px_ = 1;  ///< from the picture's border
    double opacity_ = 0;
    Region around_{};  ///< pixels outside have none
};

}  // namespace halflit::raster
