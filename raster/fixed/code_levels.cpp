#include "raster/fixed/code_levels.hpp"

#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>

namespace halflit::raster {
namespace {

using Texel = std::array<std::uint8_t, 3>;
/// One picture of a level.
struct Face {
    int width, height;
    std::vector<Texel> texels;
    [[nodiscard]] const Texel& at(int x, int y) const {
        return texels[static_cast<std::size_t>(std::min(y, height - 1)) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(std::min(x, width - 1))];
    }
};

struct Decoding {
    std::array<float, 256> plain, srgb;
    Decoding() {
        for (int i = 0; i < 256; ++i) {
            plain[static_cast<std::size_t>(i)] = static_cast<float>(i) / 255.0f;
            srgb[static_cast<std::size_t>(i)] = static_cast<float>(shading::linear_from_srgb(i / 255.0));
        }
    }
};
const Decoding& decoding() {
    static const Decoding made;
    return made;
}

/// The code whose number is nearest.
std::uint8_t encode(float value, const std::array<float, 256>& numbers) {
    const auto above = std::lower_bound(numbers.begin(), numbers.end(), value);
    if (above == numbers.begin()) return 0;
    if (above == numbers.end()) return 255;
    const auto i = above - numbers.begin();
    return static_cast<std::uint8_t>(value - *(above - 1) < *above - value ? i - 1 : i);
}

/// The level of half the size: its texels' middles are read between the middles of the larger level's, in 1/256 texel, and codes are
/// rounded after each direction.
Face half_of(const Face& from, const std::array<float, 256>& numbers, bool in_codes) {
    Face to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
    to.texels.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    struct Tap {
        int first, second, part;
    };
    const auto tap = [](int i, int size, int half) {
        const float middle = (static_cast<float>(i) + 0.5f) / static_cast<float>(half);
        const int place = static_cast<int>(__builtin_lrintf(middle * (static_cast<float>(size) * 256.0f))) - 128;
        return Tap{std::clamp(place >> 8, 0, size - 1), std::clamp((place >> 8) + 1, 0, size - 1), place & 255};
    };
    const auto mixed = [&](int a, int b, int part) {
        if (in_codes) return a + ((part * (b - a) + 128) >> 8);
        const float low = numbers[static_cast<std::size_t>(a)], high = numbers[static_cast<std::size_t>(b)];
        return int{encode(low + static_cast<float>(part) * (1.0f / 256.0f) * (high - low), numbers)};
    };
    for (int y = 0; y < to.height; ++y) {
        const Tap down = tap(y, from.height, to.height);
        for (int x = 0; x < to.width; ++x) {
            const Tap along = tap(x, from.width, to.width);
            Texel& out = to.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x)];
            for (std::size_t c = 0; c < 3; ++c) {
                const auto row = [&](int of) { return mixed(from.at(along.first, of)[c], from.at(along.second, of)[c], along.part); };
                out[c] = static_cast<std::uint8_t>(mixed(row(down.first), row(down.second), down.part));
            }
        }
    }
    return to;
}

struct Place {
    int face, x, y;
};

/// The texel of a cube that lies at (x, y) of a face, or beyond its border by one.
Place texel_beyond(int face, int x, int y, int size) {
    // Doubled coordinates of the texel's middle, from -size to size, on a face at `size`; one step beyond the border leads to the next
    // face.
    const auto middle = [&](int i) { return 2 * i + 1 - size; };
    int s = middle(x), t = middle(y), d[3];
    const int w = size;
    const auto direction = [&](int a, int b, int c) { d[0] = a, d[1] = b, d[2] = c; };
    switch (face) {
        case 0:
            direction(w, -t, -s);
            break;
        case 1:
            direction(-w, -t, s);
            break;
        case 2:
            direction(s, w, t);
            break;
        case 3:
            direction(s, -w, -t);
            break;
        case 4:
            direction(s, -t, w);
            break;
        default:
            direction(-s, -t, -w);
            break;
    }
    // Beyond the border one coordinate is larger than the face's own, which then counts as that of the border's texels.
    int axis = face / 2;
    for (int k = 0; k < 3; ++k)
        if (std::abs(d[k]) > size) axis = k;
    if (axis != face / 2) {
        d[axis] = d[axis] < 0 ? -w : w;
        d[face / 2] = d[face / 2] < 0 ? -(w - 1) : w - 1;
    }
    const bool low = d[axis] < 0;
    int across = 0, down = 0;
    if (axis == 0) across = low ? d[2] : -d[2], down = -d[1];
    if (axis == 1) across = d[0], down = low ? -d[2] : d[2];
    if (axis == 2) across = low ? -d[0] : d[0], down = -d[1];
    return {2 * axis + (low ? 1 : 0), (across + size - 1) / 2, (down + size - 1) / 2};
}

std::int32_t packed(const Texel& t) { return static_cast<std::int32_t>(t[0] | t[1] << 8 | t[2] << 16); }

/// Appends a face with its border. What lies beyond a corner is the mean of the three texels around it.
void append_with_border(const std::vector<Face>& faces, int face, std::vector<std::int32_t>& out) {
    const int size = faces[0].width;
    const auto of = [&](int x, int y) -> const Texel& {
        const Place p = texel_beyond(face, x, y, size);
        return faces[static_cast<std::size_t>(p.face)].at(p.x, p.y);
    };
    for (int y = -1; y <= size; ++y)
        for (int x = -1; x <= size; ++x) {
            const bool beside = x < 0 || x == size, above = y < 0 || y == size;
            if (!beside || !above) {
                out.push_back(packed(of(x, y)));
                continue;
            }
            const int near_x = std::clamp(x, 0, size - 1), near_y = std::clamp(y, 0, size - 1);
            Texel mean;
            for (std::size_t c = 0; c < 3; ++c)
                mean[c] = static_cast<std::uint8_t>((of(near_x, near_y)[c] + of(x, near_y)[c] + of(near_x, y)[c] + 1) / 3);
            out.push_back(packed(mean));
        }
}

}  // namespace

CodeLevelsData::CodeLevelsData(const CodeTexture& texture) {
    const std::array<float, 256>& numbers = texture.decodes_srgb ? decoding().srgb : decoding().plain;
    std::vector<Face> faces(texture.cube ? 6 : 1, Face{texture.width, texture.height, {}});
    const auto size = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = f * size; i < (f + 1) * size; ++i)
            faces[f].texels.push_back({texture.rgb[3 * i], texture.rgb[3 * i + 1], texture.rgb[3 * i + 2]});
    levels_.decoded = numbers.data();
    levels_.cube = texture.cube;
    levels_.in_codes = !texture.cube && !texture.decodes_srgb;
    while (true) {
        const auto level = static_cast<std::size_t>(levels_.count++);
        levels_.first[level] = static_cast<std::int32_t>(texels_.size());
        levels_.width[level] = faces[0].width;
        levels_.height[level] = faces[0].height;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            if (texture.cube)
                append_with_border(faces, static_cast<int>(f), texels_);
            else
                for (const Texel& t : faces[f].texels) texels_.push_back(packed(t));
        }
        if ((faces[0].width == 1 && faces[0].height == 1) || levels_.count == kMostLevels) break;
        for (Face& face : faces) face = half_of(face, numbers, !texture.decodes_srgb);
    }
    levels_.texels = texels_.data();
}

}  // namespace halflit::raster
