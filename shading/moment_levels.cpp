#include "shading/moment_levels.hpp"

#include "sh/vec3d.hpp"
#include "shading/texture_texels.hpp"

#include <cmath>

namespace halflit {

MomentLevels::Texel MomentLevels::level_0(const std::uint16_t* texel) const {
    const double r = texel[0], g = texel[1], b = texel[2], a = texel[3];
    if (rule_ == MipRule::alpha) return {{r * a, g * a, b * a}, a, {r, g, b}};
    const double x = r * (2.0 / 65535.0) - 1.0, y = g * (2.0 / 65535.0) - 1.0, z = b * (2.0 / 65535.0) - 1.0;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0.0)) return {{0.0, 0.0, 1.0}, 1.0, {}};
    return {{x / length, y / length, z / length}, 1.0, {}};
}

void MomentLevels::write(const Texel& mean, std::uint16_t* out) const {
    const auto rounded = [](double value) { return static_cast<std::uint16_t>(value < 65535.0 ? value + 0.5 : 65535.0); };
    if (rule_ == MipRule::normal) {
        // [Tok05]: 1 / s grows by (1 - l) / l, l being the mean's length, and alpha^2 is 2 / s.
        const Vec3d n{mean.first[0], mean.first[1], mean.first[2]};
        const double l = std::sqrt(dot(n, n));
        out[3] = rounded(l < 1.0 ? l > 0.0 ? 65535.0 * std::sqrt(2.0 * (1.0 - l) / l) : 65535.0 : 0.0);
        return;
    }
    for (int c = 0; c < 3; ++c) out[c] = rounded(mean.second > 0.0 ? mean.first[c] / mean.second : mean.color[c]);
    out[3] = rounded(mean.second);
}

void MomentLevels::reduce(const std::uint16_t* const (&from)[3], const TextureLevel& large, std::size_t to, const TextureLevel& small,
                          int y, std::uint16_t* out) {
    const Box rows = box_of(y, large.height);
    const auto texel_at = [&](std::int64_t i, std::int64_t j) -> Texel {
        if (to > 1) return row(to - 1, static_cast<int>(rows.first + j))[static_cast<std::size_t>(i)];
        return level_0(from[j] + 4 * i);
    };
    std::vector<Texel>& made = row(to, y);
    made.resize(static_cast<std::size_t>(small.width));
    for (int x = 0; x < small.width; ++x, out += 4) {
        const Box columns = box_of(x, large.width);
        const double total = static_cast<double>(rows.total * columns.total);
        Texel mean{};
        for (std::int64_t j = 0; j < rows.count; ++j)
            for (std::int64_t i = 0; i < columns.count; ++i) {
                const double share = static_cast<double>(rows.weight[j] * columns.weight[i]) / total;
                const Texel texel = texel_at(columns.first + i, j);
                for (int c = 0; c < 3; ++c) {
                    mean.first[c] += share * texel.first[c];
                    mean.color[c] += share * texel.color[c];
                }
                mean.second += share * texel.second;
            }
        made[static_cast<std::size_t>(x)] = mean;
        write(mean, out);
    }
}

}  // namespace halflit
