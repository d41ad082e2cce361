// 3D Gaussians while they are read.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Axes of a cloud, as SPZ numbers them: bits of the number less 1 are set where x points right, a second axis up, and a third one ahead.
/// These are y and z; where the bit 8 is set, z and y, and the third axis points back.
inline constexpr std::uint32_t kRightUpBack = 4, kRightDownFront = 6, kMostAxes = 16;

struct SplatCloud {
    std::vector<Vec3f> positions;
    Splats splats;
    std::uint32_t axes = kRightUpBack;
    std::size_t mended = 0;  ///< splats that add() has changed

    /// Makes room, within the limits of `geometry`; may throw LoadFailure.
    void reserve(Document& document, std::uint64_t count, int degree);
    /// Adds one, whose coefficients follow by add_color(). rotation: x, y, z, w. A rotation without a length becomes none, and scales lose
    /// their signs.
    void add(const std::array<double, 3>& position, const std::array<double, 4>& rotation, const std::array<double, 3>& scale,
             double opacity);
    /// Adds a coefficient of one channel to the last one.
    void add_color(double coefficient) { splats.harmonics.push_back(static_cast<float>(coefficient)); }
    /// Sets how they are drawn by the name that files give the way they were trained. Others leave it as it is.
    void set_reference(std::string_view trained_as, Document& document);
};

/// Coefficients of one channel beyond the first, up to a degree; and the highest degree that so many are enough for.
[[nodiscard]] constexpr std::size_t rest_of_degree(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 1) - 1); }
[[nodiscard]] int degree_of(std::size_t rest);
/// The first spherical harmonic: 1 / (2 sqrt(pi)).
inline constexpr double kFirstHarmonic = 0.28209479177387814;
/// First coefficient of a colour of the display, 0 to 1.
[[nodiscard]] double harmonic_of(double color);
/// Opacity, and scale, as training programs store them. Not a number: it stays none.
[[nodiscard]] double opacity_of_logit(double logit);
[[nodiscard]] double scale_of_log(double log_scale);
/// A value that is stored as a code from 0 to `most`.
[[nodiscard]] inline double between(double low, double high, std::uint32_t code, std::uint32_t most) {
    return low + (high - low) * (code / static_cast<double>(most));
}
/// x, y, z and w of a rotation of which the largest component is not stored: the number `largest` of x, y, z, w, or of w, x, y, z.
[[nodiscard]] std::array<double, 4> rotation_of(const std::array<double, 3>& others, std::size_t largest, bool w_first);

/// make_splat_mesh(), with a warning of Gaussians that are left out.
[[nodiscard]] Mesh splat_mesh(SplatCloud&& cloud, Document& document);

}  // namespace halflit::io::detail
