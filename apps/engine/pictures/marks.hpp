// Marks on pictures of engineering: scale bars, axes, dimension lines.
#pragma once

#include "apps/engine/pictures/lettering.hpp"

#include <array>
#include <string>

namespace halflit::engine {

struct MarkStyle {
    Color color{0xe6, 0xe6, 0xe6};
    Color background{0x1f, 0x22, 0x27};  ///< behind the text of a dimension line
    double text_size = kSmallTextSize;   ///< pixels
    double line_width = 1.5;             ///< pixels
};

/// A number as engineers write it: four significant digits or hundredths, no zeros at the end. With an exponent below 1e-3
/// and from 1e5 on.
[[nodiscard]] std::string number_text(double value);

/// The largest of 1, 2 or 5 times a power of ten that is at most `longest`; 0 if that is not within 1e-20 .. 1e20.
[[nodiscard]] double round_length(double longest);

/// A horizontal bar of a round length with a tick at each end, and its length above it ("20 mm"). (x, y) is its left end, and it is at most
/// `max_width` pixels long. Returns its length in units; 0, and nothing is drawn, where no round length fits.
double draw_scale_bar(Canvas& canvas, Point left_end, double max_width, double units_per_pixel, const std::string& unit,
                      const MarkStyle& style = {});

/// Arrows for the axes of the world: x red, y green, z blue, each with its letter. `axes`: unit vectors as the camera sees them, x right,
/// y up, z towards the viewer. The farthest is drawn first. One that points along the view is a dot. The letters reach `size` + 14 pixels
/// from the centre.
void draw_axes(Canvas& canvas, Point center, double size, const std::array<Vec3d, 3>& axes);

/// A line from `from` to `to` with an arrow head and a cross line at each end, and its text in the middle on the background's colour. A
/// text that has no room between the heads stands beside the line: right of a steep one, below a flat one.
void draw_dimension(Canvas& canvas, Point from, Point to, const std::string& text, const MarkStyle& style = {});

}  // namespace halflit::engine
