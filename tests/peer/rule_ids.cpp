#include "rule_ids.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::peer {

namespace {

struct Corner {
    std::int64_t x, y;  // 1/256 pixel, (0, 0) is the centre of the first pixel
};

std::int64_t snapped(float ndc, int size, Viewport viewport) {
    const float half = 0.5f * static_cast<float>(size);
    const float window = viewport == Viewport::fused ? std::fma(ndc, half, half) : ndc * half + half;
    return static_cast<std::int64_t>(std::nearbyint((window - 0.5f) * 256.0f));  // to nearest even: the default rounding mode
}

Corner corner_of(Vec4f clip, int width, int height, Viewport viewport) {
    const float inv_w = 1.0f / clip.w;
    return {snapped(clip.x * inv_w, width, viewport), snapped(-(clip.y * inv_w), height, viewport)};
}

/// Twice the area of (a, b, p): positive for p to the right of a -> b as seen with y down, where a clockwise triangle has its inside.
std::int64_t edge(Corner a, Corner b, Corner p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

/// Top-left rule for a clockwise triangle with y down: a top edge runs to the right and is level, a left edge runs up.
bool is_top_left(Corner a, Corner b) { return (a.y == b.y && b.x > a.x) || b.y < a.y; }

}  // namespace

std::vector<std::uint32_t> rule_ids(int width, int height, std::span<const Vec4f> clip_positions, Viewport viewport) {
    std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (std::size_t t = 0; 3 * t + 2 < clip_positions.size(); ++t) {
        Corner c[3];
        for (std::size_t i = 0; i < 3; ++i) c[i] = corner_of(clip_positions[3 * t + i], width, height, viewport);
        const std::int64_t area = edge(c[0], c[1], c[2]);
        if (area == 0) continue;
        if (area < 0) std::swap(c[1], c[2]);

        const auto first = [](std::int64_t low) { return std::max<std::int64_t>(0, (low >> 8)); };
        const auto last = [](std::int64_t high, int size) { return std::min<std::int64_t>(size - 1, (high >> 8) + 1); };
        const std::int64_t x0 = first(std::min({c[0].x, c[1].x, c[2].x})), x1 = last(std::max({c[0].x, c[1].x, c[2].x}), width);
        const std::int64_t y0 = first(std::min({c[0].y, c[1].y, c[2].y})), y1 = last(std::max({c[0].y, c[1].y, c[2].y}), height);
        std::int64_t bias[3];
        for (int i = 0; i < 3; ++i) bias[i] = is_top_left(c[i], c[(i + 1) % 3]) ? 0 : -1;
        for (std::int64_t y = y0; y <= y1; ++y)
            for (std::int64_t x = x0; x <= x1; ++x) {
                const Corner p{x * 256, y * 256};
                bool inside = true;
                for (int i = 0; i < 3; ++i) inside &= edge(c[i], c[(i + 1) % 3], p) + bias[i] >= 0;
                if (inside) ids[static_cast<std::size_t>(y * width + x)] = static_cast<std::uint32_t>(t + 1);
            }
    }
    return ids;
}

bool reaches_beyond(std::span<const Vec4f, 3> corners, float limit_x, float limit_y) {
    return std::any_of(corners.begin(), corners.end(),
                       [&](const Vec4f& c) { return std::abs(c.x) > limit_x * c.w || std::abs(c.y) > limit_y * c.w; });
}

}  // namespace halflit::peer
