// The picture behind glass that blurs or bends light, as the kernels read it: without such glass, with smaller copies. Other
// renderers call it the transmission buffer.
#pragma once

#include <cstddef>
#include <cstdint>

namespace halflit::shading {

inline constexpr int kBehindLevels = 17;    ///< a picture of 2^16 pixels on a side has as many
inline constexpr float kBehindFade = 4.0f;  ///< thin glass whose blur is the inverse shows nothing of the background's colour

/// Levels of four floats a texel: light times coverage, and coverage by surfaces. Each level has a border of copies of its outer texels,
/// one wide, so that the three by three texels about any texel are there.
struct BehindPlan {
    const float* rgba = nullptr;  ///< null: what lies behind is seen as through clear, flat glass
    std::int32_t levels = 0;
    float width = 0, height = 0;                                                    ///< of the picture, pixels
    float last_level = 0;                                                           ///< levels - 1, which a blur of 1 reads
    float columns[kBehindLevels]{}, rows[kBehindLevels]{}, scale[kBehindLevels]{};  ///< texels; texels a pixel
    std::int32_t first[kBehindLevels]{}, below[kBehindLevels]{};                    ///< first texel, of the border; row stride in texels
    /// Position in pixels of a point p, from the picture's upper left: (x . (p, 1)) / (w . (p, 1)).
    float x[4]{}, y[4]{}, w[4]{};

    BehindPlan() = default;
    /// Makes the plan of a picture of this size: levels down to one texel, but no texels.
    BehindPlan(int width_px, int height_px) : width(static_cast<float>(width_px)), height(static_cast<float>(height_px)) {
        std::int32_t next = 0;
        for (int w_k = width_px, h_k = height_px; levels < kBehindLevels; w_k = (w_k + 1) / 2, h_k = (h_k + 1) / 2) {
            const int k = levels++;
            columns[k] = static_cast<float>(w_k), rows[k] = static_cast<float>(h_k);
            scale[k] = k == 0 ? 1.0f : 0.5f * scale[k - 1];
            first[k] = next, below[k] = w_k + 2;
            next += (w_k + 2) * (h_k + 2);
            if (w_k == 1 && h_k == 1) break;
        }
        last_level = static_cast<float>(levels - 1);
    }
    /// Texels of all levels.
    [[nodiscard]] std::size_t texels() const {
        const int last = levels - 1;
        return static_cast<std::size_t>(first[last]) + static_cast<std::size_t>(below[last]) * (static_cast<std::size_t>(rows[last]) + 2);
    }
};

}  // namespace halflit::shading
