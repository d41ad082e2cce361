#include "sh/quadrature.hpp"

namespace halflit::sh {

std::vector<GaussNode> gauss_legendre(int count) {
    std::vector<GaussNode> nodes(static_cast<std::size_t>(count));
    for (int i = 0; i < (count + 1) / 2; ++i) {
        double x = sin_cos(kPi * (i + 0.75) / (count + 0.5)).cos, slope = 0.0;
        for (int step = 0; step < 8; ++step) {  // Newton: three digits at the start, doubled by each step; four steps reach the last bit
            double before = 1.0, here = x;
            for (int l = 1; l < count; ++l) {
                const double next = ((2.0 * l + 1.0) * x * here - l * before) / (l + 1.0);
                before = here;
                here = next;
            }
            slope = count * (x * here - before) / (x * x - 1.0);
            x -= here / slope;
        }
        if (2 * i + 1 == count) x = 0.0;
        const double weight = 2.0 / ((1.0 - x * x) * slope * slope);
        nodes[static_cast<std::size_t>(i)] = {-x, weight};
        nodes[static_cast<std::size_t>(count - 1 - i)] = {x, weight};
    }
    return nodes;
}

std::vector<SphereNode> sphere_quadrature(int degree) {
    const int turns = degree + 1;
    std::vector<SphereNode> nodes;
    for (const GaussNode& node : gauss_legendre(degree / 2 + 1)) {
        const double ring = __builtin_sqrt((1.0 - node.x) * (1.0 + node.x));
        for (int k = 0; k < turns; ++k) {
            const SinCos phi = sin_cos(2.0 * kPi * (k + 0.5) / turns);
            nodes.push_back({{ring * phi.cos, ring * phi.sin, node.x}, node.weight * 2.0 * kPi / turns});
        }
    }
    return nodes;
}

}  // namespace halflit::sh
