// Views of a model with what they show: the picture, and for each pixel the triangle, its instance, its distance and its normal.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::engine {

/// One view, drawn. Planes hold the whole picture, row by row, as halflit::Target has them.
struct ViewShot {
    std::string name;  ///< "front", or "30,20"
    Camera camera;
    Image picture;                        ///< rgba8
    std::vector<std::uint32_t> instance;  ///< index into Scene::instances plus 1; 0: nothing
    std::vector<std::uint32_t> triangle;  ///< number in its mesh plus 1
    std::vector<float> depth;             ///< along the view axis, units of the drawn world; infinity: nothing
    std::vector<float> normal;            ///< three a pixel, world space; 0: nothing
    std::vector<DrawnEdge> edges;         ///< that the picture shows
    bool detail = false;                  ///< it shows a part of the model on purpose
    [[nodiscard]] int width() const { return picture.width; }
    [[nodiscard]] int height() const { return picture.height; }
};

/// Planes of a shot that are wanted besides instance and triangle.
struct ShotPlanes {
    bool picture = true;  ///< colours; without them nothing is shaded
    bool depth = false, normal = false;
};

/// Draws a view. The studio turns with the camera. The job's size and settings count; its region must be the whole picture.
[[nodiscard]] Result<ViewShot> draw_shot(RenderJob& job, Renderer& renderer, std::string name, const Camera& camera,
                                         const ShotPlanes& wanted);

/// Draws again which triangle each pixel's centre shows, by these threads and into memory that the shot may have from an earlier picture.
/// Its picture and other planes are left.
[[nodiscard]] Result<void> draw_numbers(const RenderJob& job, Renderer& renderer, const Camera& camera, int threads, ViewShot& shot);

/// Units of the drawn world that a pixel is wide, at a distance along the view axis.
[[nodiscard]] double pixel_size(const Camera& camera, int width, int height, double distance);

/// The point of the picture, in pixels, y down, (0, 0) its upper left corner, at which a point of the drawn world is seen, and its distance
/// along the view axis.
[[nodiscard]] Vec3d window_point(const Camera& camera, int width, int height, Vec3d p);

}  // namespace halflit::engine
