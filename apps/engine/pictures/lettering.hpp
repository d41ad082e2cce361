// Text on pictures, in DejaVu Sans (apps/engine/fonts). Text is UTF-8. Characters that the font lacks, control characters and bytes that
// are not UTF-8 are boxes. Sizes are those of the em square in pixels; letters are kerned, and not hinted.
#pragma once

#include "apps/engine/pictures/canvas.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// Sizes at which small letters are whole pixels high (8 and 7), which makes them sharp.
inline constexpr double kTextSize = 14.625, kSmallTextSize = 12.8;

enum class Align { left, middle, right };

struct LetterStyle {
    double size = kTextSize;  ///< pixels, at most 1000
    Color color{0xe6, 0xe6, 0xe6};
    Align align = Align::left;
};

/// Pixels from the pen's start to its end.
[[nodiscard]] double width_of_text(std::string_view text, double size);
/// Height of capital letters, pixels.
[[nodiscard]] double cap_height(double size);

enum class Cut { middle, end };
/// The text, or as much of it as has room in `width` pixels with an ellipsis for what was cut. Empty if not even that has room.
[[nodiscard]] std::string cut_to_width(std::string_view text, double size, double width, Cut cut);
/// At most `most` lines of at most `width` pixels; the last one is cut if the text is longer. A line breaks after its last space, else
/// after the last of -_/.:, if that is in its second half, else anywhere. A line has one character even if that is wider.
[[nodiscard]] std::vector<std::string> wrapped_lines(std::string_view text, double size, double width, std::size_t most, Cut cut);

/// Draws one line of text: its pen starts, has its middle or ends at `at`, on the base line. The start is rounded to whole pixels.
void draw_text(Canvas& canvas, Point at, std::string_view text, const LetterStyle& style);

}  // namespace halflit::engine
