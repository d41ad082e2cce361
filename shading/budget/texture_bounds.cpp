#include "shading/budget/texture_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::shading {
namespace {

constexpr double kUnit = 1.0 / 65535.0;
/// kHalfUlp: half a unit in the last place of values in [1/2, 1). kRounding: relative error of one rounding, for any value.
constexpr double kHalfUlp = 0x1p-25, kRounding = 0x1p-24;

bool power_of_two(std::int32_t size) { return (size & (size - 1)) == 0; }

/// Error of a coordinate in texels of the largest level. Wrapping rounds once, to a value below 1 (not at all if the coordinate is not
/// negative). The product with the size is exact for powers of two, and the subtraction of a half from half a texel on. A transform rounds
/// products and sums before that.
double coordinate_error(std::int32_t size, bool transform, const float (&row)[3], double largest_uv) {
    double error = kHalfUlp + (power_of_two(size) ? 0.0 : kRounding);
    if (transform)
        error += 3.0 * kRounding * ((std::fabs(double{row[0]}) + std::fabs(double{row[1]})) * largest_uv + std::fabs(double{row[2]}));
    return error * size;
}

/// The most that rounding may be off by: each level rounds the mean of rounded texels once. MipRule::alpha keeps means in double.
double most_storage_error(const TexturePlan& texture) {
    const double levels = texture.level_count;
    return 0.5 + (texture.source->rule() == MipRule::alpha ? 0.51 : 0.51 * levels);
}

TextureRange range_of(const TexturePlan& texture, const TexelFacts& facts) {
    constexpr std::uint16_t kMost = 65535;
    if (facts.measured == TexelFacts::Measured::nothing) return {{}, {kMost, kMost, kMost, kMost}, {kMost, kMost, kMost, kMost}};
    return texture.source->range();
}

}  // namespace

double filter_error(const TexturePlan& texture, int c, const TexelFacts& facts) {
    const TextureRange texels = range_of(texture, facts);
    const double largest_uv = facts.largest_uv;
    const double step = texels.step[c] * kUnit, range = (texels.most[c] - texels.least[c]) * kUnit;
    // A filtered value changes by at most one step from a texel to the next, in each direction.
    const double shift = coordinate_error(texture.width[0], texture.transform, texture.row_u, largest_uv) +
                         coordinate_error(texture.height[0], texture.transform, texture.row_v, largest_uv);
    // Error of the level: log2 of the footprint by the polynomial of degree 5, and its roundings. It counts times the difference of two
    // levels at a point. That difference is made of texels of the larger level that are at most 9 steps apart: one and three and a half on
    // each axis.
    const double level =
        texture.mip == MipFilter::linear && texture.level_count > 1 ? (texture.transform ? 1e-5 : 4e-6) * std::min(range, 9.0 * step) : 0.0;
    // Anisotropic filters: ratio, level and direction of the footprint are off by 1e-5 of themselves (the shorter axis is a difference of
    // products, up to 16 times the longer one times an ulp). Probes lie up to 8 widths away, at most 16 texels of the larger level, and
    // their places round once more.
    double ellipse = 0.0;
    if (texture.anisotropy > 1) {
        const double places = kRounding * (largest_uv + 1.0) * (texture.width[0] + texture.height[0]);
        ellipse = 3e-5 * std::min(range, 9.0 * step) + 2e-5 * range + std::min((places + 2.0 * 16.0 * 1e-5) * step, range);
    }
    return std::min(shift * step, range) + level + ellipse + 10.0 * kRounding +
           (facts.measured == TexelFacts::Measured::all ? static_cast<double>(texture.source->storage_error())
                                                        : most_storage_error(texture)) *
               kUnit;
}

double least_value(const TexturePlan& texture, int c, const TexelFacts& facts) { return range_of(texture, facts).least[c] * kUnit; }

}  // namespace halflit::shading
