#include "sh/rotate.hpp"

#include "sh/quadrature.hpp"

namespace halflit::sh {

RadianceSh rotated(const RadianceSh& sh, const Rotation& r) {
    RadianceSh out{sh.bands, {}};
    if (sh.bands == 0) return out;
    const Rotation back = inverse(r);
    for (const SphereNode& node : sphere_quadrature(2 * (sh.bands - 1))) {
        double from[kMaxCoefficients], to[kMaxCoefficients];
        evaluate_basis<kMaxBands>(back * node.direction, from);
        evaluate_basis<kMaxBands>(node.direction, to);
        for (int l = 0; l < sh.bands; ++l) {  // band by band, so that rounding cannot leak from a strong band into a weak one
            Vec3d value{};
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) value = value + sh.c[static_cast<std::size_t>(i)] * from[i];
            value = value * node.weight;
            for (int i = l * l; i < (l + 1) * (l + 1); ++i)
                out.c[static_cast<std::size_t>(i)] = out.c[static_cast<std::size_t>(i)] + value * to[i];
        }
    }
    return out;
}

}  // namespace halflit::sh
