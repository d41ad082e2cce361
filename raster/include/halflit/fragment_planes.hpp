// Planes that follow from those of a Target: distances from the eye, normals of the view, numbers of meshes and materials, motion. The
// arrays have no gaps between rows. Each number is computed in float64 and rounded once: the same bits on every machine.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <span>

namespace halflit {

/// Turns depths along the view axis into distances from the camera's eye, along the ray through the pixel's centre. With several samples a
/// pixel, the depth is that of the first one, which lies beside the centre. Infinity stays. The depths of an orthographic camera stay: its
/// rays begin in the plane of its eye. size: of the whole picture. region: the part that `depth` holds; a width of 0: all. Fails (usage)
/// for a region outside of the picture and for another number of depths.
[[nodiscard]] HALFLIT_API Result<void> make_ray_distances(const Camera& camera, PictureSize size, const Region& region,
                                                          std::span<float> depth);

/// Turns normals of the world (three floats each) into the camera's space: x to the right, y up, z towards the viewer. 0 stays. Fails
/// (usage) unless there are whole normals.
[[nodiscard]] HALFLIT_API Result<void> make_view_normals(const Camera& camera, std::span<float> normal);

/// Least and largest depth of a picture.
struct DepthRange {
    double least = 0.0;  ///< along the view axis, world units
    double most = 0.0;   ///< likewise
};
/// Depths as 1 to 65535 between the least and the largest of them, and 0 for infinity. Requires: as many codes as depths.
HALFLIT_API DepthRange make_depth_codes(std::span<const float> depth, std::span<std::uint16_t> codes);

/// Turns numbers of Target::instance into indices of Scene::meshes, plus 1. 0, and numbers that the scene does not have, become 0.
HALFLIT_API void make_mesh_numbers(const Scene& scene, std::span<std::uint32_t> instance);
/// The same of Scene::materials: Instance::material, or else Mesh::material. 0 for the default material too.
HALFLIT_API void make_material_numbers(const Scene& scene, std::span<std::uint32_t> instance);

/// A scene as a camera sees it. Refers to both.
struct ScenePose {
    const Scene& scene;    ///< where its instances and vertices are
    const Camera& camera;  ///< the view
};

/// Planes that name the points of a picture: Target::instance, triangle, barycentric.
struct SeenPoints {
    std::span<const std::uint32_t> instance;  ///< one for each pixel
    std::span<const std::uint32_t> triangle;  ///< one for each pixel
    std::span<const float> barycentric;       ///< two for each pixel
};

/// Writes how far each point that is seen moves in the picture, pixels, from the pose that was drawn to another one: x to the right, y
/// down, two floats. The point is at the pixel plus its motion in the other picture, whether something hides it there or not. 0 where
/// nothing is, where the other scene lacks the triangle, and for points that are not before both cameras. size: of both whole pictures.
/// Fails (usage) for spans of different lengths.
[[nodiscard]] HALFLIT_API Result<void> make_motion(const ScenePose& drawn, const ScenePose& other, PictureSize size,
                                                   const SeenPoints& points, std::span<float> motion);

}  // namespace halflit
