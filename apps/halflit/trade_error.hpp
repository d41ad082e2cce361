// How far a picture is from its reference, in 8-bit sRGB codes before they are rounded to whole ones: rounding would hide what is below
// half a code, and show as a whole one what is not.
#pragma once

#include "raster/framebuffer.hpp"

#include <optional>
#include <span>
#include <vector>

namespace halflit::cli {

/// Over the pixels that something was drawn to. A pixel's error is that of its worst channel of red, green and blue.
struct TradeError {
    double max = 0, mean = 0;
    double p999 = 0;             ///< 99.9 % of the pixels are off by no more
    std::optional<double> psnr;  ///< dB, over all channels; none: not a bit differs
    double share_off = 0;        ///< of the pixels that are off by one code or more
};

/// The codes of a reference picture, kept for many comparisons.
class TradeReference {
public:
    /// `coverage` has alpha 0 where nothing was drawn, and the picture's size. Both need linear floats.
    TradeReference(const raster::Image& picture, const raster::Image& coverage);

    [[nodiscard]] TradeError error_of(const raster::Image& picture) const;
    /// Each channel's error times `gain`, rounded, as a grey or coloured picture; black where nothing was drawn.
    [[nodiscard]] raster::Image difference(const raster::Image& picture, double gain) const;
    [[nodiscard]] std::size_t pixels_drawn() const { return pixels_.size(); }

private:
    std::vector<std::size_t> pixels_;  ///< those drawn to
    std::vector<double> codes_;        ///< three for each of them
    std::vector<float> linear_;        ///< three for each of them
};

}  // namespace halflit::cli
