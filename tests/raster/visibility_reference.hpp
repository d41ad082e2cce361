// Reference visibility: each pixel is tested against every triangle in float64, without clipping. Of triangles in one plane the material
// wins that the scene uses last. The comparison with the renderer allows only for the differences that fixed point makes.
#pragma once

#include "raster/view/projection.hpp"
#include "reference.hpp"
#include "tests/raster/debug_view.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

namespace halflit::raster::test {

/// Corners are snapped to 1/256 pixel: each moves by at most sqrt(2)/512, and by the rounding of window coordinates up to 16384 pixels
/// before that (3 half ulps, 0.003). A pixel centre nearer than this to an edge may fall on either side of it.
inline constexpr double kEdgeTolerancePx = 1.0 / 128;

/// A triangle of the reference. Its clip coordinates are those that the renderer computes in float, so that the comparison is about
/// clipping and rasterization, not about the last digits of a matrix product.
struct ReferenceTriangle {
    reference::HomogeneousTriangle shape;
    bool drawn;             ///< not culled
    double depth_rounding;  ///< allowed error of depth by float arithmetic
    Vec3d corner[3];        ///< world space
    int material;
    std::size_t rank;  ///< order in which the scene uses its materials for the first time
};

/// True for triangles of different materials in one plane, but for a millionth of the largest coordinate.
inline bool are_coplanar(const ReferenceTriangle& a, const ReferenceTriangle& b) {
    if (a.material == b.material) return false;
    const Vec3d normal = cross(a.corner[1] - a.corner[0], a.corner[2] - a.corner[0]);
    double largest = 0.0;
    for (const Vec3d& p : a.corner) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return std::all_of(std::begin(b.corner), std::end(b.corner),
                       [&](const Vec3d& p) { return std::abs(dot(normal, p - a.corner[0])) <= 1e-6 * largest * length(normal); });
}

inline std::vector<ReferenceTriangle> reference_triangles(const Scene& scene, const Camera& camera, int width, int height) {
    const Mat4 clip_from_world_matrix = clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    std::vector<ReferenceTriangle> out;
    std::map<int, std::size_t> ranks;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const std::size_t rank = ranks.try_emplace(mesh.material, ranks.size()).first->second;
        const bool double_sided = mesh.material >= 0 && scene.materials[static_cast<std::size_t>(mesh.material)].double_sided;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            double clip[3][4];
            Vec3d corner[3];
            for (std::size_t k = 0; k < 3; ++k) {
                // The scenes of these tests are in world space.
                const Vec3f p = mesh.positions[mesh.indices[i + k]];
                corner[k] = {p.x, p.y, p.z};
                const Vec4f c = clip_from_world_matrix * Vec4f{p.x, p.y, p.z, 1.0f};
                clip[k][0] = c.x, clip[k][1] = c.y, clip[k][2] = c.z, clip[k][3] = c.w;
            }
            const reference::HomogeneousTriangle shape(clip, width, height);
            // The renderer's depth is a float plane over the window. Its terms are as large as the slope times the distance to the corner
            // where it starts, which is at most the width of the guard band. The result is clamped to the corners' depths.
            const double reach = (std::abs(shape.depth_dx()) + std::abs(shape.depth_dy())) * 2 * 16384;
            out.push_back({shape,
                           !shape.degenerate() && (double_sided || shape.front_facing()),
                           8 * 0x1p-24 * std::min(1.0, reach) + 1e-7,
                           {corner[0], corner[1], corner[2]},
                           mesh.material,
                           rank});
        }
    }
    return out;
}

struct Comparison {
    int pixels = 0;     ///< compared
    int covered = 0;    ///< compared pixels that show a triangle
    int undecided = 0;  ///< not compared: an edge within kEdgeTolerancePx, or two triangles at one depth that are not in one plane
    int coplanar = 0;   ///< compared pixels that show one of several in one plane
    int wrong = 0;      ///< another triangle than the reference's
    int wrong_depth = 0;
    double undecided_share() const { return static_cast<double>(undecided) / (pixels + undecided); }
};

inline Comparison compare_visibility(const VisibilityView& view, const Region& region, const std::vector<ReferenceTriangle>& triangles) {
    Comparison result;
    for (int y = region.y; y < region.y + region.height; ++y) {
        for (int x = region.x; x < region.x + region.width; ++x) {
            struct Hit {
                std::size_t triangle;
                double depth, allowed;
            };
            std::vector<Hit> hits;
            double doubtful_depth = -1.0;
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                const ReferenceTriangle& r = triangles[t];
                if (!r.drawn) continue;
                const auto p = r.shape.at(x + 0.5, y + 0.5);
                const double inside = std::min({p.edge_px[0], p.edge_px[1], p.edge_px[2], p.near_px, p.far_px});
                if (!(inside > -kEdgeTolerancePx)) continue;
                // The plane of the snapped triangle is slightly different.
                const double z_allowed =
                    r.depth_rounding + (std::abs(r.shape.depth_dx()) + std::abs(r.shape.depth_dy())) * 2 * kEdgeTolerancePx;
                if (inside < kEdgeTolerancePx)
                    doubtful_depth = std::max(doubtful_depth, p.depth + z_allowed);
                else
                    hits.push_back({t, p.depth, z_allowed});
            }
            const auto first = std::max_element(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.depth < b.depth; });
            const bool any = first != hits.end() && first->depth > 0.0;
            const double depth = any ? first->depth : 0.0, allowed = any ? first->allowed : 0.0;
            std::size_t best = any ? first->triangle : 0;
            double second = -1.0;
            bool in_plane = false;
            for (const Hit& hit : hits) {
                if (any && hit.triangle == first->triangle) continue;
                if (!any || !are_coplanar(triangles[first->triangle], triangles[hit.triangle])) {
                    second = std::max(second, hit.depth + hit.allowed);
                    continue;
                }
                in_plane = true;
                if (triangles[hit.triangle].rank > triangles[best].rank) best = hit.triangle;
            }
            const auto nearest = static_cast<std::uint32_t>(any ? best + 1 : 0);
            // Of triangles of one material in a plane, rounding decides.
            for (const Hit& hit : hits)
                if (any && hit.triangle != best && triangles[hit.triangle].material == triangles[best].material)
                    second = std::max(second, hit.depth + hit.allowed);
            if (doubtful_depth >= depth - allowed || (nearest != 0 && second >= depth - allowed)) {
                ++result.undecided;
                continue;
            }
            ++result.pixels;
            result.covered += nearest != 0;
            result.coplanar += in_plane ? 1 : 0;
            const auto at = static_cast<std::size_t>(y * view.width + x);
            if (view.triangle[at] != nearest)
                ++result.wrong;
            else
                result.wrong_depth += !(std::abs(static_cast<double>(view.depth[at]) - depth) <= allowed);
        }
    }
    return result;
}

}  // namespace halflit::raster::test
