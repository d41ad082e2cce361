#include "raster/passes/behind.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::raster {
namespace {

int width_of(const View& view) { return static_cast<int>(2.0f * view.viewport.half_width); }
int height_of(const View& view) { return static_cast<int>(2.0f * view.viewport.half_height); }

/// Copies the outer texels of a row into its border.
void border_row(float* row, int columns) {
    std::memcpy(row, row + 4, 4 * sizeof(float));
    std::memcpy(row + 4 * static_cast<std::ptrdiff_t>(columns + 1), row + 4 * static_cast<std::ptrdiff_t>(columns), 4 * sizeof(float));
}

/// Largest light: its sums and differences stay finite.
constexpr float kMostLight = 1e18f;

/// The light of a pixel as glass reads it; NaN counts as 0.
float held(float light) { return light > 0.0f ? std::min(light, kMostLight) : 0.0f; }

}  // namespace

Target Behind::target(const View& view, StopSignal& stop) {
    Target target;
    target.width = width_of(view), target.height = height_of(view);
    target.linear = drawn_.reserve(4 * static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height), stop);
    target.premultiplied = true;
    return target;
}

shading::BehindPlan Behind::make(const View& view, float exposure, Executor& executor) {
    const int width = width_of(view), height = height_of(view);
    shading::BehindPlan plan(width, height);
    const auto columns = [&](int level) { return static_cast<int>(plan.columns[level]); };
    const auto rows = [&](int level) { return static_cast<int>(plan.rows[level]); };
    float* const levels = levels_.reserve(4 * plan.texels(), executor.stop());
    const auto row_of = [&](int level, int y) {
        return levels + 4 * (static_cast<std::ptrdiff_t>(plan.first[level]) + static_cast<std::ptrdiff_t>(y + 1) * plan.below[level]);
    };
    const auto border = [&](int level) {
        const std::size_t bytes = 4 * sizeof(float) * static_cast<std::size_t>(plan.below[level]);
        std::memcpy(row_of(level, -1), row_of(level, 0), bytes);
        std::memcpy(row_of(level, rows(level)), row_of(level, rows(level) - 1), bytes);
    };
    const float per_exposure = exposure > 0.0f ? 1.0f / exposure : 0.0f;
    const float* const drawn = drawn_.data();
    executor.run(height, [&](int y) {
        const float* from = drawn + 4 * static_cast<std::ptrdiff_t>(y) * width;
        float* const row = row_of(0, y);
        for (int x = 0; x < width; ++x, from += 4) {
            float* const to = row + 4 * static_cast<std::ptrdiff_t>(x + 1);
            for (int c = 0; c < 3; ++c) to[c] = held(from[c] * per_exposure);
            to[3] = held(from[3]);
        }
        border_row(row, width);
    });
    border(0);
    // Each texel of the next level is the mean of four by four with the weights 1 3 3 1, a step of a quadratic B-spline.
    for (int k = 1; k < plan.levels; ++k) {
        executor.run(rows(k), [&](int y) {
            constexpr float kOuter = 0.125f, kInner = 0.375f;
            const int last = rows(k - 1) - 1;
            const float* const from[4] = {row_of(k - 1, std::max(2 * y - 1, 0)), row_of(k - 1, std::min(2 * y, last)),
                                          row_of(k - 1, std::min(2 * y + 1, last)), row_of(k - 1, std::min(2 * y + 2, last))};
            float* const row = row_of(k, y);
            for (int x = 0; x < columns(k); ++x) {
                float* const to = row + 4 * static_cast<std::ptrdiff_t>(x + 1);
                for (int c = 0; c < 4; ++c) {
                    float across[4];
                    for (int i = 0; i < 4; ++i) {
                        const auto texel = [&](int at) { return from[i][4 * std::min(at, columns(k - 1) + 1) + c]; };
                        across[i] = (texel(2 * x) + texel(2 * x + 3)) * kOuter + (texel(2 * x + 1) + texel(2 * x + 2)) * kInner;
                    }
                    to[c] = (across[0] + across[3]) * kOuter + (across[1] + across[2]) * kInner;
                }
            }
            border_row(row, columns(k));
        });
        border(k);
    }
    plan.rgba = levels;
    const Vec4f* const c = view.clip_from_world.c;
    const float half_width = view.viewport.half_width, half_height = view.viewport.half_height;
    for (int i = 0; i < 4; ++i) {
        plan.w[i] = c[i].w;
        plan.x[i] = (c[i].w + c[i].x) * half_width;
        plan.y[i] = (c[i].w - c[i].y) * half_height;
    }
    return plan;
}

}  // namespace halflit::raster
