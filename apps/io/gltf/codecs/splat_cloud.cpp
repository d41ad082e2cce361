#include "apps/io/gltf/codecs/splat_cloud.hpp"

#include "apps/io/files/load_failure.hpp"
#include "sh/power.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halflit::io::detail {

int degree_of(std::size_t rest) {
    int degree = 0;
    while (degree < 4 && rest >= rest_of_degree(degree + 1)) ++degree;
    return degree;
}

double harmonic_of(double color) { return (color - 0.5) / kFirstHarmonic; }

double opacity_of_logit(double logit) { return logit == logit ? 1.0 / (1.0 + exp_of(-std::clamp(logit, -80.0, 80.0))) : logit; }

double scale_of_log(double log_scale) { return log_scale == log_scale ? exp_of(std::clamp(log_scale, -80.0, 80.0)) : log_scale; }

std::array<double, 4> rotation_of(const std::array<double, 3>& others, std::size_t largest, bool w_first) {
    std::array<double, 4> q{};
    double left = 1.0;
    for (std::size_t k = 0, next = 0; k < 4; ++k) {
        if (k == largest) continue;
        q[k] = others[next++];
        left -= q[k] * q[k];
    }
    q[largest] = std::sqrt(std::max(0.0, left));
    if (w_first) std::rotate(q.begin(), q.begin() + 1, q.end());
    return q;
}

void SplatCloud::set_reference(std::string_view trained_as, Document& document) {
    if (trained_as == "mip") splats.reference = SplatReference::mip;
    if (trained_as == "antialiased") splats.reference = SplatReference::inria_aa;
    if (trained_as == "2dgs") document.warn("holds 2D Gaussians, which are drawn as thin 3D ones");
}

void SplatCloud::reserve(Document& document, std::uint64_t count, int degree) {
    const auto coefficients = harmonics_per_splat(degree);
    document.geometry.take(count * (sizeof(Vec3f) * 2 + sizeof(Vec4f) + sizeof(float) * (1 + coefficients)));
    splats.degree = degree;
    positions.reserve(count);
    splats.rotations.reserve(count);
    splats.scales.reserve(count);
    splats.opacities.reserve(count);
    splats.harmonics.reserve(count * coefficients);
}

void SplatCloud::add(const std::array<double, 3>& position, const std::array<double, 4>& rotation, const std::array<double, 3>& scale,
                     double opacity) {
    const auto f = [](double value) { return static_cast<float>(value); };
    const double square = rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2] + rotation[3] * rotation[3];
    mended += !(square > 1e-30 && square < 1e30) || scale[0] < 0.0 || scale[1] < 0.0 || scale[2] < 0.0 ? 1 : 0;
    positions.push_back({f(position[0]), f(position[1]), f(position[2])});
    splats.rotations.push_back({f(rotation[0]), f(rotation[1]), f(rotation[2]), f(rotation[3])});
    splats.scales.push_back({std::fabs(f(scale[0])), std::fabs(f(scale[1])), std::fabs(f(scale[2]))});
    splats.opacities.push_back(f(opacity));
}

Mesh splat_mesh(SplatCloud&& cloud, Document& document) {
    if (cloud.mended > 0)
        document.warn(
            fmt::format("{} Gaussians have a rotation that is none, or a scale below 0: drawn without turn or sign", cloud.mended));
    const std::size_t all = cloud.positions.size();
    Mesh mesh = make_splat_mesh(std::move(cloud.positions), std::move(cloud.splats));
    const std::size_t kept = mesh.splats->opacities.size();
    if (kept < all) document.warn(fmt::format("{} Gaussians with numbers that are not finite are left out", all - kept));
    return mesh;
}

}  // namespace halflit::io::detail
