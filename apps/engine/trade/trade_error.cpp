#include "apps/engine/trade/trade_error.hpp"

#include "sh/config.hpp"
#include "shading/reference/reference.hpp"
#include "shading/reference/tone.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::engine {

TradeReference::TradeReference(const Image& picture, const Image& coverage, ToneCurve curve) : curve_(curve) {
    HALFLIT_ASSERT(picture.rgba_linear.size() == coverage.rgba_linear.size());
    for (std::size_t i = 0; i * 4 < picture.rgba_linear.size(); ++i) {
        if (!(coverage.rgba_linear[i * 4 + 3] > 0.0f)) continue;
        pixels_.push_back(i);
        const float* const linear = &picture.rgba_linear[i * 4];
        linear_.insert(linear_.end(), linear, linear + 3);
        const auto codes = codes_of(linear);
        codes_.insert(codes_.end(), codes.begin(), codes.end());
    }
}

std::array<double, 3> TradeReference::codes_of(const float* linear) const {
    using shading::reference::srgb_code;
    const auto light = [&](int c) { return static_cast<double>(linear[c]); };
    const Vec3d shown = shading::reference::toned(curve_, {light(0), light(1), light(2)});
    return {srgb_code(shown.x), srgb_code(shown.y), srgb_code(shown.z)};
}

TradeError TradeReference::error_of(const Image& picture) const {
    TradeError error;
    if (pixels_.empty()) return error;
    std::vector<double> worst(pixels_.size(), 0.0);
    double sum_squares = 0;
    for (std::size_t k = 0; k < pixels_.size(); ++k) {
        const float* const linear = &picture.rgba_linear[pixels_[k] * 4];
        if (std::equal(linear, linear + 3, &linear_[3 * k])) continue;  // true for most pixels; the curves are slow
        const auto codes = codes_of(linear);
        for (std::size_t c = 0; c < 3; ++c) {
            const double difference = std::abs(codes[c] - codes_[3 * k + c]);
            worst[k] = std::max(worst[k], difference);
            sum_squares += difference * difference;
        }
    }
    const auto count = static_cast<double>(worst.size());
    for (const double one : worst) {
        error.max = std::max(error.max, one);
        error.mean += one / count;
        error.share_off += one >= 1.0 ? 1 / count : 0.0;
    }
    // The smallest value that 99.9 % of the pixels do not exceed.
    const auto rank = worst.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.999 * count)) - 1;
    std::nth_element(worst.begin(), rank, worst.end());
    error.p999 = *rank;
    if (sum_squares > 0) error.psnr = 10 * std::log10(255.0 * 255.0 * 3 * count / sum_squares);
    return error;
}

Image TradeReference::difference(const Image& picture, double gain) const {
    Image image{picture.width, picture.height, std::vector<std::uint8_t>(picture.rgba8.size(), 0), {}};
    for (std::size_t i = 3; i < image.rgba8.size(); i += 4) image.rgba8[i] = 255;
    for (std::size_t k = 0; k < pixels_.size(); ++k) {
        const auto codes = codes_of(&picture.rgba_linear[pixels_[k] * 4]);
        for (std::size_t c = 0; c < 3; ++c) {
            const double difference = std::abs(codes[c] - codes_[3 * k + c]);
            image.rgba8[pixels_[k] * 4 + c] = static_cast<std::uint8_t>(std::min(255.0, difference * gain + 0.5));
        }
    }
    return image;
}

}  // namespace halflit::engine
