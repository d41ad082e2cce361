#include "shading/budget/reflection_bounds.hpp"

#include "sh/trig.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace halflit::shading {
namespace {

struct Level {
    const std::array<float, 4>* rgba;
    int n;

    Level(const std::vector<std::array<float, 4>>& values, int rows) : rgba(values.data()), n(rows) {}
    Level(const ReflectionMap& map, int level) : rgba(map.rgba.data() + map.first[level]), n(map.rows[level]) {}
    [[nodiscard]] const float* at(int column, int row) const {
        return rgba[static_cast<std::ptrdiff_t>(row) * (2 * n + 1) + column].data();
    }
};

/// The least and the largest values of the rows and columns about each point of a level, in its layout.
struct Surroundings {
    std::vector<std::array<float, 4>> least, most;

    explicit Surroundings(const Level& level) {
        const int columns = 2 * level.n;
        for (int j = 0; j <= level.n; ++j)
            for (int i = 0; i <= columns; ++i) {
                std::array<float, 4> low{}, high{};
                for (int c = 0; c < 3; ++c) {
                    low[c] = high[c] = level.at(i, j)[c];
                    for (int y = std::max(0, j - 1); y <= std::min(level.n, j + 1); ++y)
                        for (int x = i - 1; x <= i + 1; ++x) {
                            const float value = level.at((x + columns) % columns, y)[c];
                            low[c] = std::min(low[c], value), high[c] = std::max(high[c], value);
                        }
                }
                least.push_back(low), most.push_back(high);
            }
    }
};

void widen(ReflectionSteps::Step& step, float a, float b, double per) {
    const double low = std::min(a, b), high = std::max(a, b);
    if (!(high > low)) return;
    step.absolute = std::max(step.absolute, (high - low) * per);
    step.relative = std::max(step.relative, low > 0.0 ? (high - low) / low * per : std::numeric_limits<double>::infinity());
}

}  // namespace

ReflectionSteps reflection_steps(const ReflectionMap& map) {
    ReflectionSteps out;
    for (int k = 0; k < kReflectionLevels; ++k) {
        const Level level(map, k);
        const double per_radian = level.n / kPi;
        // Along a circle of latitude the function's slope lies between those of the rows about it, over the sine of its polar angle.
        // Towards a pole it falls as fast as the sine does, because the pole's row has one value.
        ReflectionSteps::Step down, right;
        for (int j = 0; j <= level.n; ++j) {
            const double sine = sin_cos(kPi * std::clamp(j, 1, level.n - 1) / level.n).sin;
            const double next = sin_cos(kPi * std::clamp(j < level.n / 2 ? j - 1 : j + 1, 1, level.n - 1) / level.n).sin;
            for (int i = 0; i < 2 * level.n; ++i)
                for (int c = 0; c < 3; ++c) {
                    out.most = std::max(out.most, static_cast<double>(level.at(i, j)[c]));
                    widen(right, level.at(i, j)[c], level.at(i + 1, j)[c], per_radian / std::min(sine, next));
                    if (j < level.n) widen(down, level.at(i, j)[c], level.at(i, j + 1)[c], per_radian);
                }
        }
        out.angle[k] = {down.absolute + right.absolute, down.relative + right.relative};
        if (k + 1 == kReflectionLevels) break;
        // A point between four values of one level lies between four of the next one, which are no more than a column and a row away.
        const Level next(map, k + 1);
        const Surroundings about(next);
        const Level least(about.least, next.n), most(about.most, next.n);
        const int ratio = level.n / next.n;
        for (int j = 0; j <= level.n; ++j)
            for (int i = 0; i < 2 * level.n; ++i)
                for (int c = 0; c < 3; ++c) {
                    widen(out.level[k], level.at(i, j)[c], least.at(i / ratio, j / ratio)[c], 1.0);
                    widen(out.level[k], level.at(i, j)[c], most.at(i / ratio, j / ratio)[c], 1.0);
                }
    }
    return out;
}

}  // namespace halflit::shading
