#include "apps/io/models/model_colors.hpp"

#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/writer_habits.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace halflit::io::detail {

namespace {

/// Linear light of whole sRGB codes.
float linear_of_code(std::uint8_t code) {
    static const std::array<float, 256> kLinear = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i) table[i] = linear_color(static_cast<double>(i) / 255.0);
        return table;
    }();
    return kLinear[code];
}

Vec4f linear_of_codes(const double (&codes)[3]) {
    return {linear_color(codes[0] / 255.0), linear_color(codes[1] / 255.0), linear_color(codes[2] / 255.0), 1};
}

bool is_finite(const Vec4f& c) { return shading::finite(c.x) && shading::finite(c.y) && shading::finite(c.z); }

}  // namespace

void make_linear_by_range(std::span<Vec4f> colors, bool are_whole, Document& document) {
    constexpr float kMostShare = 2.0f;
    float most = 0;
    std::size_t bright = 0, fractions = 0, shares = 0, broken = 0;
    for (const Vec4f& c : colors) {
        if (!is_finite(c)) ++broken;
        for (const float value : {c.x, c.y, c.z}) {
            if (!(value > 0) || !shading::finite(value)) continue;
            most = std::max(most, value);
            ++bright;
            if (value == std::floor(value)) continue;
            ++fractions;
            if (value <= kMostShare) ++shares;
        }
    }
    const bool are_shares = !are_whole && (most <= kMostShare || 2 * shares > bright);
    const int unit = are_shares ? 1 : most <= 255 ? 255 : 65535;
    if (broken > 0) document.warn(fmt::format("{} colours are not finite, and drawn as white", broken));
    if (fractions > 0 && most > kMostShare)
        document.warn(fmt::format("its colours are fractions up to {:.4g}: read as from 0 to {}{}", most, unit,
                                  are_shares ? ", what is above as 1" : ""));
    make_linear(colors, unit);
}

void make_linear(std::span<Vec4f> colors, double unit) {
    const auto linear = [&](float value) {
        if (unit == 255 && value >= 0 && value <= 255)
            if (const auto code = static_cast<std::uint8_t>(value); static_cast<float>(code) == value) return linear_of_code(code);
        return linear_color(static_cast<double>(value) / unit);
    };
    for (Vec4f& c : colors) c = is_finite(c) ? Vec4f{linear(c.x), linear(c.y), linear(c.z), c.w} : Vec4f{1, 1, 1, c.w};
}

bool drop_no_colors(ModelFormat format, Soup& soup, Document& document) {
    const std::vector<Vec4f>& colors = soup.colors;
    if (colors.empty() || !std::all_of(colors.begin(), colors.end(), [&](const Vec4f& c) { return c == colors[0]; })) return false;
    const bool means_none = means_no_color(format, [&](std::uint32_t value) {
        const double codes[3] = {static_cast<double>(value >> 16 & 255u), static_cast<double>(value >> 8 & 255u),
                                 static_cast<double>(value & 255u)};
        const Vec4f none = linear_of_codes(codes);
        return colors[0].x == none.x && colors[0].y == none.y && colors[0].z == none.z;
    });
    if (!means_none) return false;
    soup.colors.clear();
    soup.color_of.clear();
    document.warn("its colours are all black, as where none were set: drawn in grey");
    return true;
}

Vec4f viridis(double t) {
    static constexpr double kCodes[9][3] = {{68, 1, 84},    {71, 44, 122}, {59, 81, 139},  {44, 113, 142}, {33, 144, 141},
                                            {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};
    const double at = std::clamp(t, 0.0, 1.0) * 8;
    const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), 7);
    const double weight = at - static_cast<double>(below);
    double codes[3];
    for (std::size_t c = 0; c < 3; ++c) codes[c] = kCodes[below][c] + weight * (kCodes[below + 1][c] - kCodes[below][c]);
    return linear_of_codes(codes);
}

Vec4f label_color(double label) {
    // Kelly's colours of greatest contrast, without white, black and grey.
    static constexpr double kCodes[19][3] = {{243, 195, 0},   {135, 86, 146}, {243, 132, 0},   {161, 202, 241}, {190, 0, 50},
                                             {194, 178, 128}, {0, 136, 86},   {230, 143, 172}, {0, 103, 165},   {249, 147, 121},
                                             {96, 78, 151},   {246, 166, 0},  {179, 68, 108},  {220, 211, 0},   {136, 45, 23},
                                             {141, 182, 0},   {101, 69, 34},  {226, 88, 34},   {43, 61, 38}};
    static constexpr double kGrey[3] = {132, 132, 130};
    if (!(label >= 1 && label < 9e15)) return linear_of_codes(kGrey);
    return linear_of_codes(kCodes[(static_cast<std::uint64_t>(label) - 1) % std::size(kCodes)]);
}

}  // namespace halflit::io::detail
