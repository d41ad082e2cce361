#include "apps/engine/job/picture_judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace halflit::engine {

bool is_blank(const Image& image, const RenderReport& rendered) {
    if (rendered.fragments_shaded == 0 && rendered.pixels_visible == 0) return true;
    std::array<int, 4> least{255, 255, 255, 255}, most{};
    for (std::size_t i = 0; i < image.rgba8.size(); ++i) {
        least[i % 4] = std::min(least[i % 4], int{image.rgba8[i]});
        most[i % 4] = std::max(most[i % 4], int{image.rgba8[i]});
    }
    for (std::size_t c = 0; c < 4; ++c)
        if (most[c] - least[c] > 2) return false;
    return true;
}

}  // namespace halflit::engine
