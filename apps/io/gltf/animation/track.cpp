#include "apps/io/gltf/animation/track.hpp"

#include "sh/arc.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::io::detail {

namespace {

/// Length 1; a quaternion that has no direction stays.
void normalize(double q[4]) {
    const double length2 = ((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3];
    if (!(length2 > 1e-200 && length2 < 1e200)) return;
    const double scale = 1.0 / std::sqrt(length2);
    for (int i = 0; i < 4; ++i) q[i] *= scale;
}

double length_of(const double q[4]) { return std::sqrt(((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3]); }

/// glTF 2.0, appendix C.5, for one number: v0, v1 values, b0 the tangent away from the first, a1 towards the second, both per second.
double cubic(double v0, double b0, double a1, double v1, double t, double step_s) {
    const double t2 = t * t, t3 = t2 * t;
    return (((2 * t3 - 3 * t2 + 1) * v0 + step_s * (t3 - 2 * t2 + t) * b0) + (-2 * t3 + 3 * t2) * v1) + step_s * (t3 - t2) * a1;
}

}  // namespace

void slerp(const double a[4], const double b[4], double t, double out[4]) {
    double from[4], to[4], minus[4], plus[4];
    std::copy(a, a + 4, from);
    std::copy(b, b + 4, to);
    normalize(from);
    normalize(to);
    const double cosine = ((from[0] * to[0] + from[1] * to[1]) + from[2] * to[2]) + from[3] * to[3];
    for (int i = 0; i < 4; ++i) {
        if (cosine < 0) to[i] = -to[i];
        minus[i] = to[i] - from[i];
        plus[i] = to[i] + from[i];
    }
    // At most pi / 2, as both are on the same side. Exact for small angles too, where the cosine is not.
    const double angle = 2.0 * angle_of(length_of(minus), length_of(plus));
    const double sine = sin_cos(angle).sin;
    const double first = sine > 0 ? sin_cos((1 - t) * angle).sin / sine : 1 - t, second = sine > 0 ? sin_cos(t * angle).sin / sine : t;
    for (int i = 0; i < 4; ++i) out[i] = from[i] * first + to[i] * second;
    normalize(out);
}

bool sample(const Track& track, double time_s, double* out) {
    const bool is_cubic = track.interpolation == file::Interpolation::cubic;
    const std::size_t n = track.count, stride = is_cubic ? 3 * n : n, middle = is_cubic ? n : 0;
    const auto above = std::upper_bound(track.times.begin(), track.times.end(), time_s,
                                        [](double time, float key) { return time < static_cast<double>(key); });
    const std::size_t after = static_cast<std::size_t>(above - track.times.begin());
    const std::size_t key = after == 0 ? 0 : after - 1;
    const float* const here = track.values.data() + key * stride + middle;
    const bool at_key = after == 0 || after == track.times.size() || time_s == static_cast<double>(track.times[key]);
    if (at_key || track.interpolation == file::Interpolation::step) {
        for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<double>(here[i]);
    } else {
        const double begin = static_cast<double>(track.times[key]), step_s = static_cast<double>(track.times[after]) - begin;
        const double t = (time_s - begin) / step_s;
        const float* const next = here + stride;
        if (is_cubic) {
            for (std::size_t i = 0; i < n; ++i)
                out[i] = cubic(static_cast<double>(here[i]), static_cast<double>(here[i + n]), static_cast<double>((next - n)[i]),
                               static_cast<double>(next[i]), t, step_s);
            if (track.rotation) normalize(out);
        } else if (track.rotation) {
            const double a[4] = {here[0], here[1], here[2], here[3]}, b[4] = {next[0], next[1], next[2], next[3]};
            slerp(a, b, t, out);
        } else {
            for (std::size_t i = 0; i < n; ++i) {
                const double a = static_cast<double>(here[i]), b = static_cast<double>(next[i]);
                out[i] = a + (b - a) * t;
            }
        }
    }
    return std::all_of(out, out + n, [](double x) { return x > -3e38 && x < 3e38; });
}

}  // namespace halflit::io::detail
