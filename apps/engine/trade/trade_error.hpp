// Error of a picture against its reference, in 8-bit sRGB codes before they are rounded to whole codes. Rounding would turn an error of
// less than one code into 0 or 1.
#pragma once

#include "halflit/shading.hpp"
#include "halflit/target.hpp"

#include <array>

#include <optional>
#include <vector>

namespace halflit::engine {

/// Statistics over the pixels that geometry covers. A pixel's error is the largest of its red, green and blue errors.
struct TradeError {
    double max = 0, mean = 0;
    double p999 = 0;             ///< 99.9 % of the pixels have at most this error
    std::optional<double> psnr;  ///< dB, over all channels; empty: no value differs
    double share_off = 0;        ///< fraction of the pixels with an error of one code or more
};

/// The codes of a reference picture, kept for many comparisons.
class TradeReference {
public:
    /// `coverage` has alpha 0 where nothing was drawn, and the size of `picture`. Both need linear floats. The curve is applied in float64
    /// to each pixel of the pictures that are compared.
    TradeReference(const Image& picture, const Image& coverage, ToneCurve curve = ToneCurve::none);

    [[nodiscard]] TradeError error_of(const Image& picture) const;
    /// Each channel's error times `gain`, rounded, as a grey or coloured picture; black where nothing was drawn.
    [[nodiscard]] Image difference(const Image& picture, double gain) const;
    [[nodiscard]] std::size_t pixels_drawn() const { return pixels_.size(); }

private:
    /// Codes of red, green and blue of a pixel, before they are rounded.
    [[nodiscard]] std::array<double, 3> codes_of(const float* linear) const;

    ToneCurve curve_;
    std::vector<std::size_t> pixels_;  ///< those that geometry covers
    std::vector<double> codes_;        ///< three for each of them
    std::vector<float> linear_;        ///< three for each of them
};

}  // namespace halflit::engine
