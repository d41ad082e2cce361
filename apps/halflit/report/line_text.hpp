// Lines of text as rectangles, for pictures: the letters of stb_easy_font.
#pragma once

#include <string>
#include <vector>

namespace halflit::cli {

inline constexpr int kTextHeight = 12;  ///< of a line, in strokes

/// A rectangle in units of a stroke's width, from the upper left corner of the line.
struct TextBar {
    int x, y, width, height;
};
/// Characters that are not ASCII become '?'.
[[nodiscard]] std::vector<TextBar> text_bars(const std::string& text);
[[nodiscard]] int text_width(const std::string& text);

/// The text, cut to this width with ".." at its end if it is wider.
[[nodiscard]] std::string cut_to_width(std::string text, int width);
/// Lines of at most this width, broken at spaces where there are some.
[[nodiscard]] std::vector<std::string> wrapped_lines(const std::string& text, int width);

}  // namespace halflit::cli
