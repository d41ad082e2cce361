#include "shading/reference/tone.hpp"

#include <algorithm>

namespace halflit::shading::reference {
namespace {

/// Beyond this all curves have reached white in float64; their squares do not overflow.
constexpr double kMostLight = 1e100;

double light_of(double x) { return x > 0.0 ? std::min(x, kMostLight) : 0.0; }

/// [Rein02], equation 3, with the luminance of Rec. 709.
Vec3d reinhard(Vec3d v) {
    const double luminance = 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z;
    return v * (1 / (1 + luminance));
}

/// [Nar16].
double aces(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

/// [PBRN], in the specification's letters.
Vec3d neutral(Vec3d c_in) {
    const double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
    const double x = std::min({c_in.x, c_in.y, c_in.z});
    const double f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
    const Vec3d c{c_in.x - f, c_in.y - f, c_in.z - f};
    const double p = std::max({c.x, c.y, c.z});
    if (p <= ks) return c;
    const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
    const double g = 1 / (kd * (p - pn) + 1);
    const double white = pn * (1 - g);
    return {c.x / p * pn * g + white, c.y / p * pn * g + white, c.z / p * pn * g + white};
}

}  // namespace

Vec3d toned(ToneCurve curve, Vec3d light) {
    const Vec3d v{light_of(light.x), light_of(light.y), light_of(light.z)};
    const auto shown = [](Vec3d c) { return Vec3d{std::min(c.x, 1.0), std::min(c.y, 1.0), std::min(c.z, 1.0)}; };
    switch (curve) {
        case ToneCurve::none:
            break;
        case ToneCurve::reinhard:
            return shown(reinhard(v));
        case ToneCurve::aces:
            return shown({aces(v.x), aces(v.y), aces(v.z)});
        case ToneCurve::neutral:
            return shown(neutral(v));
    }
    return shown(v);
}

}  // namespace halflit::shading::reference
