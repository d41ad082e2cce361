#include "apps/lab/sphere_light.hpp"

#include "sh/lobe_error.hpp"
#include "sh/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr int kNodes = 24;                      ///< Gauss nodes in each interval between kinks
constexpr int kSections = 40;                   ///< steps of a golden-section search: an interval of 1 shrinks to 4e-9
constexpr double kMostPower = 3;                ///< of a fitted lobe; the fits stay below 2
constexpr double kGolden = 0.6180339887498949;  // (sqrt 5 - 1) / 2

/// The least point of f on [low, high], f having one minimum there.
template <class Fn>
double least(double low, double high, Fn&& f) {
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double at_a = f(a), at_b = f(b);
    for (int i = 0; i < kSections; ++i) {
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - kGolden * (high - low), at_a = f(a);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + kGolden * (high - low), at_b = f(b);
        }
    }
    // A boundary may be the least point; the search only comes near it.
    const double middle = 0.5 * (low + high), at_middle = f(middle);
    if (f(low) <= at_middle) return low;
    return f(high) < at_middle ? high : middle;
}

}  // namespace

// What a surface receives from a source of radiance 1 is the area of the source's projection: first onto the unit sphere, then onto the
// surface's plane. The projection's rim has two parts. The first is the sphere's outline r(phi) = cos s d + sin s (cos phi u + sin phi v),
// with d towards its centre, u in the plane of d and the normal, and |phi| <= phi_0 where r is above the horizon. The second is an arc of
// the horizon, between the azimuths -alpha and alpha. The area is the integral of (N . r x dr) / 2 along both:
//     sin^2 s cos t phi_0 - cos s sin s sin t sin phi_0 + alpha,  t the angle between normal and d.
// A sphere that is whole above the horizon gives pi sin^2 s cos t, Lambert's cosine.
double sphere_light(double x, double radius_rad) {
    const double sin_s = std::sin(radius_rad), cos_s = std::cos(radius_rad);
    if (x >= sin_s) return x;
    if (x <= -sin_s) return 0.0;
    const double sin_t = std::sqrt(1 - x * x);
    const double cos_phi = std::clamp(-cos_s * x / (sin_s * sin_t), -1.0, 1.0), sin_phi = std::sqrt(1 - cos_phi * cos_phi);
    const double alpha = std::atan2(sin_s * sin_phi * sin_t, cos_s);
    return (x * std::acos(cos_phi) - cos_s / sin_s * sin_t * sin_phi + alpha / (sin_s * sin_s)) / kPi;
}

LobeFit lobe_against_sphere(const sh::WrapLobe& lobe, double radius_rad) {
    static const std::vector<sh::GaussNode> rule = sh::gauss_legendre(kNodes);
    // Kinks of either curve.
    std::array<double, 5> ends{-1, -std::sin(radius_rad), -lobe.wrap, std::sin(radius_rad), 1};
    std::sort(ends.begin(), ends.end());
    LobeFit fit{lobe};
    const auto difference_at = [&](double x) {
        const double difference = sh::lobe_value(lobe, x) - sphere_light(x, radius_rad);
        fit.worst = std::max(fit.worst, std::fabs(difference));
        return difference;
    };
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double half = 0.5 * (ends[i + 1] - ends[i]), middle = 0.5 * (ends[i + 1] + ends[i]);
        static_cast<void>(difference_at(ends[i]));  // the largest difference is often at a kink
        for (const sh::GaussNode& node : rule) {
            const double difference = difference_at(middle + half * node.x);
            fit.rms += 0.5 * half * node.weight * difference * difference;  // the mean over x is the mean over the sphere of normals
        }
    }
    fit.rms = std::sqrt(fit.rms);
    return fit;
}

LobeFit fit_sphere_light(LobeFamily family, double radius_rad) {
    const auto fit_of = [&](double w, double n) { return lobe_against_sphere({w, n, 1.0}, radius_rad); };
    const auto power_for = [&](double w) {
        if (family == LobeFamily::green) return 1.0;
        if (family == LobeFamily::sloan) return 1.0 + w;
        return least(1.0, kMostPower, [&](double n) { return fit_of(w, n).rms; });
    };
    const double w = least(0.0, 1.0, [&](double wrap) { return fit_of(wrap, power_for(wrap)).rms; });
    return fit_of(w, power_for(w));
}

}  // namespace halflit::cli
