#include "apps/engine/pictures/marks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::engine {

std::string number_text(double value) {
    const double size = std::abs(value);
    if (size == 0.0) return "0";
    if (!(size >= 1e-3 && size < 1e5)) return fmt::format("{:.4g}", value);
    int decimals = size >= 10.0 ? 2 : 3;  // four digits, or hundredths
    if (size < 1.0) decimals = size >= 0.1 ? 4 : size >= 0.01 ? 5 : 6;
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (decimals > 0) text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

double round_length(double longest) {
    if (!(longest >= 1e-20 && longest <= 1e20)) return 0.0;
    // Powers of ten up to 1e22 are exact, so each of these is the double nearest to its decimal.
    double power = 1.0;
    if (longest >= 1.0) {
        while (power * 10.0 <= longest) power *= 10.0;
        return longest >= 5.0 * power ? 5.0 * power : longest >= 2.0 * power ? 2.0 * power : power;
    }
    while (1.0 / power > longest) power *= 10.0;
    return longest >= 5.0 / power ? 5.0 / power : longest >= 2.0 / power ? 2.0 / power : 1.0 / power;
}

double draw_scale_bar(Canvas& canvas, Point left_end, double max_width, double units_per_pixel, const std::string& unit,
                      const MarkStyle& style) {
    const double length = round_length(max_width * units_per_pixel), pixels = length / units_per_pixel;
    if (!(length > 0.0)) return 0.0;
    constexpr double kTick = 5;
    const double half = style.line_width / 2;
    const Point right_end = left_end + Point{pixels, 0};
    canvas.line(left_end, right_end, style.line_width, style.color);
    for (const double x : {left_end.x + half, right_end.x - half})
        canvas.line({x, left_end.y - kTick}, {x, left_end.y + kTick}, style.line_width, style.color);
    const std::string label = number_text(length) + (unit.empty() ? "" : " ") + unit;
    draw_text(canvas, left_end + Point{pixels / 2, -kTick - 3}, label, {style.text_size, style.color, Align::middle});
    return length;
}

void draw_axes(Canvas& canvas, Point center, double size, const std::array<Vec3d, 3>& axes) {
    constexpr Color kColors[] = {{0xe8, 0x54, 0x4c}, {0x62, 0xbd, 0x50}, {0x5c, 0x93, 0xf5}};
    constexpr const char* kNames[] = {"x", "y", "z"};
    constexpr double kWidth = 2, kLetterAt = 8;  // pixels; the letter's middle from the tip
    std::size_t order[] = {0, 1, 2};
    std::stable_sort(std::begin(order), std::end(order), [&](std::size_t a, std::size_t b) { return axes[a].z < axes[b].z; });
    for (const std::size_t i : order) {
        const Point along{axes[i].x, -axes[i].y};
        const double length = std::sqrt(along.x * along.x + along.y * along.y);
        Point letter = center + Point{kLetterAt, -kLetterAt};
        if (size * length >= 2 * kWidth) {
            canvas.arrow(center, center + along * size, kWidth, kColors[i]);
            letter = center + along * (size + kLetterAt / length);
        } else {
            canvas.dot(center, 1.5 * kWidth, kColors[i]);
        }
        // Small letters are 3/4 as high as capitals.
        draw_text(canvas, letter + Point{0, 0.375 * cap_height(kSmallTextSize)}, kNames[i], {kSmallTextSize, kColors[i], Align::middle});
    }
}

void draw_dimension(Canvas& canvas, Point from, Point to, const std::string& text, const MarkStyle& style) {
    const Point along = to - from;
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    if (!(length > 0.0)) return;
    constexpr double kCross = 5, kInset = 4;  // pixels: half a cross line, and around the text
    const double head = std::min(5 * style.line_width, length / 3);
    const Point unit = along * (1 / length), side{-unit.y * kCross, unit.x * kCross};
    canvas.line(from + unit * (head / 2), to - unit * (head / 2), style.line_width, style.color);
    for (const auto& [tip, tail] : {std::pair(from, to), std::pair(to, from)}) {
        canvas.arrow_head(tail, tip, head, style.color);
        canvas.line(tip - side, tip + side, style.line_width / 2, style.color);
    }

    const double width = width_of_text(text, style.text_size) + 2 * kInset, high = cap_height(style.text_size) + 2 * kInset;
    const bool steep = std::abs(along.y) > std::abs(along.x);
    Point middle = from + along * 0.5;
    // The line crosses the text's box along its width or its height.
    if (length - 2 * head < std::min(width / std::max(std::abs(unit.x), 1e-9), high / std::max(std::abs(unit.y), 1e-9)) + 4)
        middle = middle + (steep ? Point{kCross + width / 2, 0} : Point{0, kCross + high / 2});
    canvas.fill_box({std::round(middle.x - width / 2), std::round(middle.y - high / 2)}, std::round(width), std::round(high),
                    style.background);
    draw_text(canvas, middle + Point{0, cap_height(style.text_size) / 2}, text, {style.text_size, style.color, Align::middle});
}

}  // namespace halflit::engine
