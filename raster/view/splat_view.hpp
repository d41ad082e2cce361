// How a camera sees splats (halflit/splats.hpp).
#pragma once

#include "halflit/camera.hpp"
#include "halflit/math.hpp"
#include "halflit/mesh.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "raster/kernels/raster_kernels.hpp"

namespace halflit::raster {

/// A camera as splats are projected by: x to the right, y down, z ahead.
class SplatEye {
public:
    /// clip_from_world: of the picture of width x height pixels; scene: its bounds.
    SplatEye(const Camera& camera, const Mat4& clip_from_world, int width, int height, const Bounds& scene);
    /// Of splats that are placed by a matrix, in a part of the picture; without SplatView::least_log2.
    [[nodiscard]] SplatView view_of(const Mat4& world_from_object, SplatReference reference, const Region& part) const;

private:
    Vec3d place_, axes_[3];
    double focal_[2], middle_[2];            ///< pixels (orthographic: per unit of the world)
    double least_slope_[2], most_slope_[2];  ///< at which the projection is held
    double nearest_;
    bool orthographic_;
};

/// Calls visit(index, instance, mesh) for the instances that are drawn as splats.
template <class Visit>
void each_splats(const Scene& scene, const Visit& visit) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.splats != nullptr && instance.visible) visit(i, instance, mesh);
    }
}

/// Splats are projected at most so many at once.
inline constexpr std::size_t kSplatsAtOnce = 4096;
/// Those of a mesh from `first` on; number: that of the first one.
[[nodiscard]] SplatBatch splat_batch(const Mesh& mesh, std::size_t first, std::uint32_t number);

}  // namespace halflit::raster
