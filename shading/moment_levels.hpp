// Smaller levels of textures for MipRule::alpha and MipRule::normal: colours weighted by their alpha, and the length that the mean of a
// normal map's normals loses. Means are kept in double from level to level, and rounded once.
#pragma once

#include "halflit/texture.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit {

class MomentLevels {
public:
    MomentLevels(MipRule rule, std::size_t levels) : rule_(rule), rows_(levels) {}

    /// Computes row y of level `to` from the rows of the level above it: all of `out` by MipRule::alpha, its alpha alone by
    /// MipRule::normal. from: the rows that the row's box covers, read if they are level 0's. Rows of a level must come in order.
    void reduce(const std::uint16_t* const (&from)[3], const TextureLevel& large, std::size_t to, const TextureLevel& small, int y,
                std::uint16_t* out);

private:
    /// Means over a texel. By alpha: of colour times alpha, of alpha, and of colour, which counts where alpha is 0 all over. Of normals:
    /// the first, of unit length in level 0.
    struct Texel {
        double first[3], second, color[3];
    };
    static constexpr int kRows = 4;  ///< a row reads up to three of the level above

    struct Rows {
        std::vector<Texel> row[kRows];
    };
    [[nodiscard]] std::vector<Texel>& row(std::size_t level, int y) { return rows_[level].row[y % kRows]; }
    [[nodiscard]] Texel level_0(const std::uint16_t* texel) const;
    void write(const Texel& mean, std::uint16_t* out) const;

    MipRule rule_;
    std::vector<Rows> rows_;  ///< of each level, the last ones; none of level 0
};

}  // namespace halflit
