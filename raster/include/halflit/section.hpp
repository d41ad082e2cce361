// Sections: a scene cut by planes, with caps where a plane goes through material, hatched as in engineering drawings.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/scene.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace halflit {

/// Keeps the points p of the world with dot(normal, p) <= offset.
struct CutPlane {
    Vec3d normal{1, 0, 0};  ///< towards what is removed; finite, any length > 0
    double offset = 0.0;    ///< in units of normal's length; finite
    friend bool operator==(const CutPlane&, const CutPlane&) = default;
};

/// Look of the caps.
struct SectionSettings {
    bool hatch = true;           ///< lines at 45 degrees; neighbouring parts differ in direction or distance
    double hatch_spacing = 0.0;  ///< distance between lines, world units, from 0; 0: a fortieth of the scene's diagonal
};

/// The section of a plane through a part.
struct SectionCut {
    std::size_t plane = 0;      ///< index into the planes
    int part = 0;               ///< as in part_of_instance; without it, the index of the instance
    int instance = -1;          ///< index into Scene::instances: the part's first one that the plane goes through
    int cap = -1;               ///< index into Scene::instances of the cap; -1: none
    double area = 0.0;          ///< of the cap, square world units; what other planes remove of it does not count
    bool closed = true;         ///< the whole section is bounded; otherwise the part's surface has a border, and no cap there
    std::size_t open_ends = 0;  ///< places where the border meets the plane
    bool too_complex = false;   ///< the section crosses itself too often to be filled: no cap
};

/// Result of cut_scene(): the sections by plane, then by part.
struct SectionReport {
    std::vector<SectionCut> cuts;        ///< of parts that a plane goes through, also where another plane removes the section
    std::size_t instances_removed = 0;   ///< instances that are invisible now
    std::size_t instances_cut = 0;       ///< instances that have a new mesh now
    [[nodiscard]] double area() const {  ///< of all caps, square world units
        double sum = 0.0;
        for (const SectionCut& cut : cuts) sum += cut.area;
        return sum;
    }
};

/// Cuts a scene. Several planes keep what all of them keep. Instances keep their indices. Those that lose all get visible = false. Those
/// that lose some get a mesh of their own, with all attributes interpolated. Caps are new instances at the end, with meshes, materials and
/// textures of their own. A vertex that is on a plane, within the rounding of float, counts as kept; a face on the plane stays if its
/// material is on the kept side, and goes otherwise. Invisible instances and shadow catchers are left alone. Lines and points are cut too.
///
/// part_of_instance: for each instance its part, from 0; instances of one part are capped together, as the primitives of a glTF node are
/// closed only together. Empty: each instance is a part. In a part, the inside is where the winding number of its surfaces is not 0: a
/// surface turned inwards is a void, bodies that overlap are one. Surfaces may cross and touch each other. A connected section with an open
/// border is not filled. Parts do not see each other, so caps of parts that overlap do too.
///
/// Takes time in proportion to the vertices, and n log n for n cut triangles. Fails, with the scene unchanged: usage for planes, settings
/// and parts out of range, bad_input for a mesh whose indices are, limit where memory or a caller's time limit ends.
[[nodiscard]] HALFLIT_API Result<SectionReport> cut_scene(Scene& scene, std::span<const CutPlane> planes,
                                                          const SectionSettings& settings = {}, std::span<const int> part_of_instance = {});

}  // namespace halflit
