#include "raster/scene/seen_texels.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {

SeenTexels::SeenTexels(const Scene& scene, const TextureUse& use) : use_(use) {
    constexpr int kMostCells = 64;
    if (!use.used() || static_cast<std::size_t>(use.texture) >= scene.textures.size()) return;
    const Texture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    const auto levels = texture.levels();
    const auto level =
        std::find_if(levels.begin(), levels.end(), [](const TextureLevel& one) { return std::max(one.width, one.height) <= kMostCells; });
    if (level == levels.end()) return;
    width_ = level->width, height_ = level->height;
    texels_[0] = texture.width(), texels_[1] = texture.height();
    const auto row = static_cast<std::size_t>(width_) + 1;
    sums_.assign(row * (static_cast<std::size_t>(height_) + 1), 0);
    // The alpha of a small level is the mean of the texels that it stands for: 0 where all of them are 0.
    const std::uint16_t* texel = texture.data().data() + 4 * static_cast<std::size_t>(level->offset);
    for (std::size_t at = row; at < sums_.size(); ++at) {
        if (at % row == 0) continue;
        sums_[at] = static_cast<std::uint16_t>(sums_[at - 1] + sums_[at - row] - sums_[at - row - 1] + (texel[3] > 0 ? 1 : 0));
        texel += 4;
    }
    if (sums_.back() == width_ * height_) sums_.clear();
}

SeenTexels::Runs SeenTexels::runs(double low, double high, int cells, int texels, TextureWrap wrap) {
    const Runs whole{{0, 0}, {cells, 0}};
    const double tile = std::floor(low);
    const double half_texel = 0.5 / texels;  // that filters read beside a point
    if (!(high - low < 1.0) || !(std::fabs(low) < 1e6)) return whole;
    const auto cell = [&](double at) { return static_cast<int>(std::floor(at * cells)); };
    int first = cell(low - tile - half_texel), last = cell(high - tile + half_texel);
    if (wrap == TextureWrap::clamp) {
        first = std::clamp(cell(low - half_texel), 0, cells - 1), last = std::clamp(cell(high + half_texel), 0, cells - 1);
    } else if (wrap == TextureWrap::mirror) {
        if (last >= cells) return whole;
        first = std::max(first, 0);
        if (static_cast<long>(tile) % 2 != 0) first = cells - 1 - first, last = cells - 1 - last, std::swap(first, last);
    } else if (last - first + 1 >= cells) {
        return whole;
    } else if (first < 0) {
        return {{cells + first, 0}, {-first, last + 1}};
    } else if (last >= cells) {
        return {{first, 0}, {cells - first, last + 1 - cells}};
    }
    return {{first, 0}, {last - first + 1, 0}};
}

int SeenTexels::seen(int x, int y, int width, int height) const {
    const auto sum = [&](int column, int row) { return int{sums_[static_cast<std::size_t>(row * (width_ + 1) + column)]}; };
    return sum(x + width, y + height) - sum(x, y + height) - sum(x + width, y) + sum(x, y);
}

SeenTexels::Share SeenTexels::share(const Vec2f (&uv)[3]) const {
    if (all()) return Share::all;
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    for (const Vec2f& at : uv) {
        const auto placed = [&](const Vec3f& row) { return (double{row.x} * at.x + double{row.y} * at.y) + double{row.z}; };
        const double place[2] = {placed(use_.row_u), placed(use_.row_v)};
        for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], place[k]), high[k] = std::max(high[k], place[k]);
    }
    const Runs across = runs(low[0], high[0], width_, texels_[0], use_.sampler.wrap_u);
    const Runs down = runs(low[1], high[1], height_, texels_[1], use_.sampler.wrap_v);
    int seen_cells = 0, cells = 0;
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) {
            cells += across.count[i] * down.count[k];
            seen_cells += seen(across.first[i], down.first[k], across.count[i], down.count[k]);
        }
    return seen_cells == 0 ? Share::none : seen_cells == cells ? Share::all : Share::some;
}

}  // namespace halflit::raster
