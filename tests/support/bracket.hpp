// An angle bracket of about 100 x 60 x 50 mm with holes, a rib and a chamfer, z up, and what can be wrong with it.
#pragma once

#include "tests/support/solids.hpp"

#include <cstddef>
#include <vector>

namespace halflit::test {

struct BracketPlan {
    int holes = 3;  ///< in a row along x
    double hole_radius = 4, thickness = 6, wall = 7;
    std::vector<double> shift{};  ///< of each hole along x; empty: none
    double chamfer = 2;           ///< of the front upper edge; 0: a sharp edge
    bool rib = true;
    double rib_at = 50;
    double step = 0;  ///< height of a patch on the upper side of the plate; 0: none
    double step_at = 10, step_length = 20;
    bool body_inside = false;  ///< a cube within the wall
    double body_at = 50;
};

/// Triangles [first, last) of a feature.
struct FeatureRange {
    std::size_t first = 0, last = 0;
};

struct Bracket {
    Mesh mesh;
    FeatureRange holes, chamfer, rib, step, body;  ///< chamfer: of its face, or of the two strips of faces that meet at the sharp edge
};

[[nodiscard]] Bracket make_bracket(const BracketPlan& plan);
[[nodiscard]] BracketPlan random_bracket(Random& random);

}  // namespace halflit::test
