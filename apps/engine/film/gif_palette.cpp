#include "apps/engine/film/gif_palette.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace halflit::film {
namespace {

constexpr std::size_t kMostColors = 256;
constexpr int kCellBits = 5, kCells = 1 << (3 * kCellBits);
constexpr int kOpaqueFrom = 128;

std::uint32_t key_of(const std::uint8_t* rgb) { return std::uint32_t{rgb[0]} << 16 | std::uint32_t{rgb[1]} << 8 | rgb[2]; }

/// Pixels whose colours have the same upper bits.
struct Cell {
    std::int64_t count = 0;
    std::array<std::int64_t, 3> sum{};  ///< of the codes
    std::int64_t squares = 0;           ///< of the codes, all channels
    std::array<int, 3> at{};            ///< upper bits of the codes
};

/// A range of cells.
struct Box {
    std::size_t begin = 0, end = 0;
    std::int64_t count = 0;
    std::array<std::int64_t, 3> sum{};
    std::int64_t error = 0;  ///< sum of squared distances to the mean, rounded down in each channel
};

Box box_of(const std::vector<Cell>& cells, std::size_t begin, std::size_t end) {
    Box box{begin, end, 0, {}, 0};
    std::int64_t squares = 0;
    for (std::size_t i = begin; i < end; ++i) {
        box.count += cells[i].count;
        for (std::size_t c = 0; c < 3; ++c) box.sum[c] += cells[i].sum[c];
        squares += cells[i].squares;
    }
    // sum (x - m)^2 = sum x^2 - (sum x)^2 / n. With 2^28 pixels of 255, (sum x)^2 is above 2^64, so it is divided in two steps.
    for (std::size_t c = 0; c < 3; ++c) {
        const std::int64_t mean = box.sum[c] / box.count, rest = box.sum[c] % box.count;
        squares -= mean * box.sum[c] + mean * rest + rest * rest / box.count;
    }
    box.error = end - begin > 1 ? squares : 0;  // a single cell cannot be cut
    return box;
}

/// Sorts the box's cells along its longest side and cuts where half of the pixels lie on each side.
std::size_t cut(std::vector<Cell>& cells, const Box& box) {
    std::array<int, 3> low{255, 255, 255}, high{};
    for (std::size_t i = box.begin; i < box.end; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], cells[i].at[c]);
            high[c] = std::max(high[c], cells[i].at[c]);
        }
    std::size_t axis = 1;  // green of equal sides, the brightest
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}})
        if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
    const auto order = [axis](const Cell& cell) {
        return std::array<int, 3>{cell.at[axis], cell.at[(axis + 1) % 3], cell.at[(axis + 2) % 3]};
    };
    const auto at = [&](std::size_t i) { return cells.begin() + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(box.begin), at(box.end), [&](const Cell& a, const Cell& b) { return order(a) < order(b); });
    std::int64_t below = 0;
    std::size_t middle = box.begin;
    while (middle + 1 < box.end && (middle == box.begin || 2 * (below + cells[middle].count) <= box.count)) below += cells[middle++].count;
    return middle;
}

std::vector<Rgb8> median_cut(std::vector<Cell> cells, std::size_t most) {
    std::vector<Box> boxes{box_of(cells, 0, cells.size())};
    while (boxes.size() < most) {
        const auto worst = std::max_element(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.error < b.error; });
        if (worst->error <= 0) break;
        const std::size_t middle = cut(cells, *worst);
        const Box lower = box_of(cells, worst->begin, middle), upper = box_of(cells, middle, worst->end);
        *worst = lower;
        boxes.push_back(upper);
    }
    std::vector<Rgb8> colors;
    for (const Box& box : boxes) {
        Rgb8& color = colors.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>((2 * box.sum[c] + box.count) / (2 * box.count));
    }
    return colors;
}

/// Finds the nearest colour, the first of several, and keeps what it found: most pixels have the colour of an earlier one.
class NearestColor {
public:
    explicit NearestColor(const std::vector<Rgb8>& colors) : found_(kSlots) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < kMostColors; ++i) codes_[c][i] = i < colors.size() ? colors[i][c] : kFar;
    }
    std::uint8_t operator()(const std::array<int, 3>& rgb) {
        const std::uint32_t key = static_cast<std::uint32_t>(rgb[0] << 16 | rgb[1] << 8 | rgb[2]);
        Slot& slot = found_[(key * 2654435761u) >> (32 - kSlotBits)];
        if (slot.key != key) slot = {key, search(rgb)};
        return slot.index;
    }

private:
    static constexpr int kSlotBits = 15;
    static constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;
    static constexpr int kFar = 1 << 12;  // of places without a colour
    struct Slot {
        std::uint32_t key = 0xffffffff;  ///< of no colour
        std::uint8_t index = 0;
    };

    [[nodiscard]] std::uint8_t search(const std::array<int, 3>& rgb) const {
        std::array<int, kMostColors> distance;
        for (std::size_t i = 0; i < kMostColors; ++i) {
            const int r = codes_[0][i] - rgb[0], g = codes_[1][i] - rgb[1], b = codes_[2][i] - rgb[2];
            distance[i] = r * r + g * g + b * b;
        }
        int least = distance[0];
        for (std::size_t i = 1; i < kMostColors; ++i) least = std::min(least, distance[i]);
        std::size_t index = 0;
        while (distance[index] != least) ++index;
        return static_cast<std::uint8_t>(index);
    }

    std::array<std::array<int, kMostColors>, 3> codes_;
    std::vector<Slot> found_;
};

/// Bayer's pattern of 8 x 8, from -amplitude to amplitude.
int threshold(std::size_t x, std::size_t y) {
    constexpr int kAmplitude = 6;  // codes
    std::size_t rank = 0;
    for (int bit = 0; bit < 3; ++bit) rank = rank * 4 + ((((x ^ y) >> bit) & 1) * 2 + ((y >> bit) & 1));
    return (static_cast<int>(rank) * 2 - 63) * kAmplitude / 63;
}

/// The picture's own colours, if there are no more than `most`.
bool keep_colors(const Image& picture, std::size_t most, PalettePicture& out) {
    std::unordered_map<std::uint32_t, std::uint8_t> index;
    std::uint32_t last_key = 0xffffffff;
    std::uint8_t last = 0;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const std::uint8_t* rgba = &picture.rgba8[4 * i];
        if (rgba[3] < kOpaqueFrom) continue;
        const std::uint32_t key = key_of(rgba);
        if (key != last_key) {
            const auto [place, is_new] = index.try_emplace(key, static_cast<std::uint8_t>(out.colors.size()));
            if (is_new && out.colors.size() == most) {
                out.colors.clear();
                return false;
            }
            if (is_new) out.colors.push_back({rgba[0], rgba[1], rgba[2]});
            last = place->second, last_key = key;
        }
        out.pixels[i] = last;
    }
    return true;
}

void reduce_colors(const Image& picture, std::size_t most, bool dither, PalettePicture& out) {
    std::vector<Cell> cells(kCells);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const std::uint8_t* rgba = &picture.rgba8[4 * i];
        if (rgba[3] < kOpaqueFrom) continue;
        const int r = rgba[0], g = rgba[1], b = rgba[2];
        Cell& cell = cells[static_cast<std::size_t>((r >> 3) << 10 | (g >> 3) << 5 | b >> 3)];
        ++cell.count;
        cell.sum[0] += r, cell.sum[1] += g, cell.sum[2] += b;
        cell.squares += r * r + g * g + b * b;
        cell.at = {r >> 3, g >> 3, b >> 3};
    }
    std::erase_if(cells, [](const Cell& cell) { return cell.count == 0; });
    out.colors = median_cut(std::move(cells), most);
    NearestColor nearest(out.colors);
    const auto width = static_cast<std::size_t>(picture.width);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const std::uint8_t* rgba = &picture.rgba8[4 * i];
        if (rgba[3] < kOpaqueFrom) continue;
        const int more = dither ? threshold(i % width, i / width) : 0;
        out.pixels[i] =
            nearest({std::clamp(rgba[0] + more, 0, 255), std::clamp(rgba[1] + more, 0, 255), std::clamp(rgba[2] + more, 0, 255)});
    }
}

}  // namespace

PalettePicture with_palette(const Image& picture, bool dither) {
    PalettePicture out;
    out.pixels.resize(picture.rgba8.size() / 4);
    bool transparent = false;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) transparent |= picture.rgba8[4 * i + 3] < kOpaqueFrom;
    const std::size_t most = transparent ? kMostColors - 1 : kMostColors;
    if (!keep_colors(picture, most, out)) reduce_colors(picture, most, dither, out);
    if (transparent) {
        out.transparent = static_cast<int>(out.colors.size());
        out.colors.push_back({0, 0, 0});
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            if (picture.rgba8[4 * i + 3] < kOpaqueFrom) out.pixels[i] = static_cast<std::uint8_t>(out.transparent);
    }
    return out;
}

}  // namespace halflit::film
