// Measures of a scene's surfaces: box, area, volume, centre of mass, bodies, and whether they are watertight. Lines, points and shadow
// catchers do not count.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halflit {

/// Lengths, areas and volumes are in units of the world, their squares and cubes. Vertices whose positions are equal count as one, as files
/// split them where normals or texture coordinates differ. Edges and bodies are those of triangles with three different corners.
struct Measures {
    Vec3d min{}, max{};  ///< corners of the smallest box along the axes; 0 if there is no triangle
    double area = 0.0;   ///< of all triangles, each one side
    /// Sum of the tetrahedra from the box's centre to each triangle (divergence theorem). It is the volume if the surface is watertight:
    /// positive if the triangles are counter-clockwise seen from outside, negative if the surface is turned inside out. Cavities whose
    /// triangles face into them are taken off, and what two bodies overlap counts twice. Without meaning if not watertight.
    double volume = 0.0;
    /// Centre of mass: of the volume if the surface is watertight, else of the area. Also of the area where the volume is below 1e-12 of
    /// the area times half the box's diagonal, as it is for a sheet with two sides; 0 if there is no area.
    Vec3d center{};
    std::uint64_t triangles = 0;             ///< all that count, also the two below
    std::uint64_t degenerate_triangles = 0;  ///< two corners at one position, or no area
    std::uint64_t not_finite_triangles = 0;  ///< a corner is not finite in float32: left out of all other members
    /// Triangles that share an edge belong to one body; those that share only a corner do not. Two boxes that touch along an edge or a face
    /// are one body, and a shell's outside and inside are two.
    std::uint64_t bodies = 0;
    std::uint64_t open_edges = 0;     ///< edges of one triangle
    std::uint64_t flipped_edges = 0;  ///< edges of two triangles that face opposite ways: they run along it in the same direction
    std::uint64_t crowded_edges = 0;  ///< edges of more than two triangles, as where two bodies touch
    /// Triangles run along every edge as often in one direction as in the other, and none is left out. So a crowded edge may have two
    /// triangles each way. False if there are no triangles.
    bool watertight = false;

    /// Lengths of the box's edges.
    [[nodiscard]] Vec3d size() const { return max - min; }
};

/// One body of a scene: where it is tells which of several floats, and its crowded edges whether it is made of some that touch.
struct Body {
    std::size_t instance = 0;  ///< index into Scene::instances of its first triangle
    Measures measures;         ///< of its triangles, without those that have two corners at one position
};

/// Measures of a scene with its first bodies.
struct MeasuredBodies {
    Measures all;              ///< of the scene
    std::vector<Body> bodies;  ///< Measures::bodies of them, or as many as were asked for
};

/// Measures of instances together, visible or not, as one surface: vertices of different instances are one too, if their world positions,
/// computed in double, are equal. So the meshes of one part, one for each material, make one closed surface. instances: indices into
/// Scene::instances; one that is there twice counts twice. Linear time: about 0.3 s for a million triangles.
/// Fails (usage) for an index out of range, (bad_input) for a faulty scene, (limit) for 2^32 corners of triangles or more, and where memory
/// ends.
[[nodiscard]] HALFLIT_API Result<Measures> measure_geometry(const Scene& scene, std::span<const int> instances);

/// Measures of all visible instances. Those that follow each other with equal transforms are one surface, as above. The others are measured
/// one by one, and the measures added: objects that touch stay bodies of their own. The volume of each is about the centre of its own box.
/// The scene is watertight if each surface is. Fails as above.
[[nodiscard]] HALFLIT_API Result<Measures> measure_geometry(const Scene& scene);

/// The same with the first bodies, in the order of their first triangles. Areas of all bodies add up to the area, and so do volumes, but
/// for rounding. most: bodies that are listed.
[[nodiscard]] HALFLIT_API Result<MeasuredBodies> measure_bodies(const Scene& scene, std::size_t most);

}  // namespace halflit
