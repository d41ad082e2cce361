// Gauss quadrature on an interval and on the sphere, exact for polynomials. Rotation uses it.
// Nodes are computed with + - * / and sqrt alone.
#pragma once

#include "sh/basis.hpp"

#include <vector>

namespace halflit::sh {

struct GaussNode {
    double x = 0.0;       ///< in (-1, 1)
    double weight = 0.0;  ///< all weights sum to 2
};

/// Gauss-Legendre rule with `count` nodes in ascending order: exact for polynomials of degree 2 count - 1. count in [1, 256].
[[nodiscard]] std::vector<GaussNode> gauss_legendre(int count);

struct SphereNode {
    Vec3d direction;
    double weight = 0.0;  ///< all weights sum to 4 pi
};

/// Rule on the sphere, exact for polynomials in x, y, z up to this degree, and so for products of harmonics whose bands add up to it.
/// degree in [0, 510].
[[nodiscard]] std::vector<SphereNode> sphere_quadrature(int degree);

}  // namespace halflit::sh
