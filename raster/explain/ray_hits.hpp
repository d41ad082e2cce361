// Rays against the scene's triangles, in double, and what a triangle is at a point of it. For explanations: it is not fast enough to draw.
#pragma once

#include "halflit/explain.hpp"
#include "raster/scene/prepared_data.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace halflit::raster {

struct Ray {
    Vec3d origin, direction;                                           ///< world space; direction: unit length
    double least = 0, most = std::numeric_limits<double>::infinity();  ///< hits lie at distances strictly between them
};

/// @{
/// Rays of a camera, between its near and far plane: through the middle of a pixel, and to a point. They start at the camera, or at the
/// plane through it if it is orthographic.
[[nodiscard]] Ray ray_of_pixel(const Camera& camera, PictureSize size, int x, int y);
[[nodiscard]] Ray ray_to(const Camera& camera, PictureSize size, Vec3d point);
/// @}

enum class RaySees : std::uint8_t {
    drawn,   ///< sides that a camera at the ray's start would see
    layers,  ///< the same of layers alone
    casters  ///< what casts a shadow: sides that a camera at the ray's far end would see, without layers
};

/// A triangle that a ray leaves out: the one that it starts from.
struct TriangleOfInstance {
    std::size_t instance, triangle;
};

/// The nearest `count` hits, in order of distance. Triangles are those that are drawn: their vertices are placed in float32. A ray through
/// an edge that two triangles share has one hit. Where a mask cuts a hole, nothing is hit. Boxes of instances, clusters and triangles are
/// tested first; a call takes time in proportion to the number of instances and of triangles in boxes along the ray.
[[nodiscard]] std::vector<SurfaceOnRay> hits_along(const PreparedData& scene, const Ray& ray, RaySees sees, std::size_t count,
                                                   std::optional<TriangleOfInstance> without = {});

/// A set of texture coordinates at a point of a triangle. Requires: the mesh has the set.
[[nodiscard]] Vec2<double> uv_at(const Mesh& mesh, int set, std::size_t triangle, const std::array<double, 3>& barycentrics);

/// A material's texture there; nothing if it has none in the slot, or the mesh no coordinates for it.
[[nodiscard]] std::optional<TextureAt> texture_at(const Scene& scene, const Mesh& mesh, const Material& material, TextureSlot slot,
                                                  std::size_t triangle, const std::array<double, 3>& barycentrics);

}  // namespace halflit::raster
