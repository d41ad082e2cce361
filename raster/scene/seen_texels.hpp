// The texels of a base colour whose alpha is not 0: a triangle that shows none of them is not seen.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// A texture in at most 64 x 64 cells, each seen if any of its texels is.
class SeenTexels {
public:
    /// All is seen without a texture.
    SeenTexels(const Scene& scene, const TextureUse& use);

    [[nodiscard]] bool all() const { return sums_.empty(); }
    [[nodiscard]] const TextureUse& use() const { return use_; }
    enum class Share : std::uint8_t { none, some, all };
    /// Share of the cells in the box around a triangle whose corners have these coordinates, before the use's transform.
    [[nodiscard]] Share share(const Vec2f (&uv)[3]) const;

private:
    struct Runs {
        int first[2], count[2];
    };
    [[nodiscard]] static Runs runs(double low, double high, int cells, int texels, TextureWrap wrap);
    [[nodiscard]] int seen(int x, int y, int width, int height) const;

    TextureUse use_;
    int width_ = 0, height_ = 0;       ///< cells
    int texels_[2] = {0, 0};           ///< width and height of the texture
    std::vector<std::uint16_t> sums_;  ///< seen cells above and left of each corner of cells; empty: all are seen
};

}  // namespace halflit::raster
