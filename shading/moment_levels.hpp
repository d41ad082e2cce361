// Smaller levels of textures for MipRule::alpha and MipRule::normal: colours weighted by their alpha, and the length that the mean of a
// normal map's normals loses. Means are kept in double from level to level, and rounded once.
#pragma once

#include "halflit/texture.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit {
namespace shading {
struct ShadeKernels;
}

class MomentLevels {
public:
    MomentLevels(MipRule rule, std::size_t levels, const shading::ShadeKernels& kernels) : rule_(rule), kernels_(kernels), rows_(levels) {}

    /// Computes row y of level `to` from the rows of the level above it: all of `out` by MipRule::alpha, its alpha alone by
    /// MipRule::normal. from: the rows that the row's box covers, read if they are level 0's. Rows of a level must come in order.
    void reduce(const std::uint16_t* const (&from)[3], const TextureLevel& large, std::size_t to, const TextureLevel& small, int y,
                std::uint16_t* out);

private:
    /// Means over the texels of a row, a list for each number. By alpha: of colour times alpha, of alpha, and of colour, which counts where
    /// alpha is 0 all over. Of normals: their three components, of unit length in level 0.
    struct Row {
        std::vector<double> mean[7];
    };
    static constexpr int kRows = 4;  ///< a row reads up to three of the level above

    struct Rows {
        Row row[kRows];
    };
    [[nodiscard]] int numbers() const { return rule_ == MipRule::normal ? 3 : 7; }
    [[nodiscard]] Row& row(std::size_t level, int y) { return rows_[level].row[y % kRows]; }
    void read_level_0(const std::uint16_t* texels, int width, Row& out) const;
    void write(const Row& row, int width, std::uint16_t* out) const;

    MipRule rule_;
    const shading::ShadeKernels& kernels_;
    std::vector<Rows> rows_;  ///< of each level, the last ones; of level 0, those that are read at a time
};

}  // namespace halflit
