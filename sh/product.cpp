#include "sh/product.hpp"

#include "sh/quadrature.hpp"

namespace halflit::sh {

RadianceSh product(const RadianceSh& a, const RadianceSh& b, int bands) {
    RadianceSh out;
    if (a.bands == 0 || b.bands == 0) return out;
    const int full = a.bands + b.bands - 1;
    out.bands = bands < full ? bands : full;
    if (out.bands > kMaxBands) out.bands = kMaxBands;
    for (const SphereNode& node : sphere_quadrature(full - 1 + out.bands - 1)) {
        double y[kMaxCoefficients];
        evaluate_basis<kMaxBands>(node.direction, y);
        Vec3d va{}, vb{};
        for (int i = 0; i < coefficient_count(a.bands); ++i) va = va + a.c[static_cast<std::size_t>(i)] * y[i];
        for (int i = 0; i < coefficient_count(b.bands); ++i) vb = vb + b.c[static_cast<std::size_t>(i)] * y[i];
        const Vec3d value = (va * vb) * node.weight;
        for (int i = 0; i < coefficient_count(out.bands); ++i)
            out.c[static_cast<std::size_t>(i)] = out.c[static_cast<std::size_t>(i)] + value * y[i];
    }
    return out;
}

}  // namespace halflit::sh
