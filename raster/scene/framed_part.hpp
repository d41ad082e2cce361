// The part of a scene that a view of the whole is fitted to. What cannot be seen does not count: triangles whose alpha is 0. A ground that
// is much larger than all that stands on it, a shell around all else, and a little far away from all others are left out: what the scene is
// about would be some pixels in a wide plane. The rule depends on the geometry, alpha and marks that code sets:
//
// - A little far away: what lies outside of a box whose radius is below 1/16 of the whole's. It is at most 1/50 of the surface, and no
//   nearer to the box than its radius; or it has few vertices, wherever they are joined to others. The rule is applied to the vertices of
//   each mesh, then to instances.
//   Few vertices: of a mesh, at most max(1, n / 1000) different positions of n, at least 8, or at most 3 of n, at least 24. Of instances,
//   at most max(3, n / 1000) of n, at least 24.
//   Points of a cloud are left out up to n / 50, if the box's radius is below 1/4 of the cloud's: scanners have noise.
// - A ground is left out if it is flat (its height at most a hundredth of its width), no higher than the middle of the rest, has fewer
//   triangles than the rest, and the radius of the rest is below 1/16 of that of the whole.
// - A shell is left out if the same holds of the rest, and it surrounds the rest on all sides but below, by surfaces that face inward, or
//   are unlit. Grounds and shells are left out together, the largest first.
// - Instances that are marked as backdrops are left out.
//
// All else is framed as a whole.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Vertices of a mesh that are framed.
struct FramedVertices {
    static constexpr std::size_t kBlock = 64;
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3f> points;   ///< others on its surface: around the texels that are seen of large triangles
    std::vector<Bounds> blocks;  ///< of kBlock vertices each, object space
    Bounds bounds;               ///< of all, object space
    bool far_left_out = false;   ///< some are far from the others

    /// Sets the boxes.
    void measure(const Mesh& mesh);
};

enum class LeftOutFor : std::uint8_t {
    far,       ///< a little, far away from all others
    ground,    ///< much larger than all that stands on it
    shell,     ///< around all else
    backdrop,  ///< marked as one
};
/// An instance that is left out, or a part of it.
struct LeftOut {
    int instance;
    LeftOutFor reason;
    bool partly = false;
};

struct FramedPart {
    std::vector<FramedVertices> meshes;  ///< of each mesh that is framed; empty for others
    std::vector<int> instances;          ///< instances that are framed, in order
    bool whole = true;                   ///< nothing was left out
    Bounds bounds;                       ///< world space, of the part; unset if whole
    std::vector<LeftOut> left_out;       ///< what could be seen, in the order in which it was left out
};

/// Instances whose mesh is out of range, and those that views do not look at, belong to no part.
[[nodiscard]] FramedPart framed_part(const Scene& scene);
/// World-space box of the part; scene_bounds() of a scene that is framed as a whole.
[[nodiscard]] Bounds framed_bounds(const Scene& scene);

}  // namespace halflit::raster
