#include "shading/moment_levels.hpp"

#include "shading/kernels/shade_kernels.hpp"
#include "shading/texture_texels.hpp"

namespace halflit {
namespace {

std::uint16_t rounded(double value) {
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(value < 65535.0 ? value + 0.5 : 65535.0));
}

}  // namespace

void MomentLevels::read_level_0(const std::uint16_t* texels, int width, Row& out) const {
    for (int k = 0; k < numbers(); ++k) out.mean[k].resize(static_cast<std::size_t>(width));
    auto& mean = out.mean;
    if (rule_ == MipRule::normal) {
        kernels_.unit_normals(texels, width, mean[0].data(), mean[1].data(), mean[2].data());
        return;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i, texels += 4) {
        const double alpha = texels[3];
        for (int c = 0; c < 3; ++c) mean[c][i] = texels[c] * alpha, mean[4 + c][i] = texels[c];
        mean[3][i] = alpha;
    }
}

void MomentLevels::write(const Row& row, int width, std::uint16_t* out) const {
    const auto& mean = row.mean;
    if (rule_ == MipRule::normal) {
        kernels_.lost_lengths(mean[0].data(), mean[1].data(), mean[2].data(), width, out + 3);
        return;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i, out += 4) {
        const double alpha = mean[3][i];
        for (int c = 0; c < 3; ++c) out[c] = rounded(alpha > 0.0 ? mean[c][i] / alpha : mean[4 + c][i]);
        out[3] = rounded(alpha);
    }
}

void MomentLevels::reduce(const std::uint16_t* const (&from)[3], const TextureLevel& large, std::size_t to, const TextureLevel& small,
                          int y, std::uint16_t* out) {
    const Box rows = box_of(y, large.height);
    const Row* above[3] = {};
    for (std::int64_t j = 0; j < rows.count; ++j) {
        Row& source = row(to - 1, static_cast<int>(rows.first + j));
        if (to == 1) read_level_0(from[j], large.width, source);
        above[j] = &source;
    }
    Row& made = row(to, y);
    for (int k = 0; k < numbers(); ++k) {
        made.mean[k].resize(static_cast<std::size_t>(small.width));
        double* const mean = made.mean[k].data();
        if (rows.count == 2 && large.width % 2 == 0) {
            kernels_.halve_means(above[0]->mean[k].data(), above[1]->mean[k].data(), small.width, mean);
            continue;
        }
        for (int x = 0; x < small.width; ++x) {
            const Box columns = box_of(x, large.width);
            const double total = static_cast<double>(rows.total * columns.total);
            double sum = 0.0;
            for (std::int64_t j = 0; j < rows.count; ++j)
                for (std::int64_t i = 0; i < columns.count; ++i)
                    sum += static_cast<double>(rows.weight[j] * columns.weight[i]) / total *
                           above[j]->mean[k][static_cast<std::size_t>(columns.first + i)];
            mean[x] = sum;
        }
    }
    write(made, small.width, out);
}

}  // namespace halflit
