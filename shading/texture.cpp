// The least values of a texture, which error budgets need.
#include "sh/config.hpp"
#include "sh/fp_environment.hpp"
#include "shading/texture_texels.hpp"

#include <algorithm>

namespace halflit {
namespace {

/// Of the largest level: the texels of the others are means of its texels. Several texels at a time: lane i holds channel i % 4.
std::array<std::uint16_t, 4> least_of(std::span<const std::uint16_t> texels) {
    constexpr std::size_t kLanes = 32;
    std::array<std::uint16_t, kLanes> least;
    least.fill(65535);
    std::size_t i = 0;
    for (; i + kLanes <= texels.size(); i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) least[lane] = std::min(least[lane], texels[i + lane]);
    for (; i < texels.size(); ++i) least[i % kLanes] = std::min(least[i % kLanes], texels[i]);
    for (std::size_t lane = 4; lane < kLanes; ++lane) least[lane % 4] = std::min(least[lane % 4], least[lane]);
    return {least[0], least[1], least[2], least[3]};
}

}  // namespace

const std::array<std::uint16_t, 4>& Texture::least() const {
    const FpEnvironment environment_of_host;
    HALFLIT_ASSERT(texels_ != nullptr);
    std::call_once(texels_->least_measured, [&] {
        const auto texels = std::size_t{4} * static_cast<std::size_t>(levels_[0].width) * static_cast<std::size_t>(levels_[0].height);
        texels_->least = least_of(data_.subspan(std::size_t{4} * static_cast<std::size_t>(levels_[0].offset), texels));
    });
    return texels_->least;
}

}  // namespace halflit
