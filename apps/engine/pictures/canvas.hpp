// A picture to draw on: boxes, pictures, lines, dots and filled shapes, with smooth edges.
// Coordinates are pixels, x right and y down; pixel (0, 0) covers 0..1. A pixel takes a colour by the exact share of its area that the
// shape covers, mixed in sRGB codes. Only + - * / and comparisons of doubles decide, so the bytes are the same on every machine.
#pragma once

#include "halflit/math.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::engine {

struct Color {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;  ///< sRGB codes; alpha linear
    friend bool operator==(const Color&, const Color&) = default;
};

using Point = Vec2<double>;
using Contour = std::vector<Point>;  ///< closed: the last point is joined to the first

/// Points are rounded to multiples of this, pixels: a power of two, so a shape that moves by whole pixels keeps its coverage.
inline constexpr double kCanvasGrid = 1.0 / 4096;
/// A shape with a point farther than this from the corner, or with one that is not a number, is not drawn.
inline constexpr double kCanvasFarthest = 1 << 20;

/// The multiple of kCanvasGrid that is nearest to x.
[[nodiscard]] double on_canvas_grid(double x);

/// A shape of a drawing that is a file of vectors (vector_file.hpp).
struct VectorShape {
    std::vector<Contour> contours;  ///< closed and filled, as Canvas::fill has it; or lines
    Color color;
    double stroke_width = 0.0;  ///< pixels, of lines; 0: it is filled
    bool dashed = false;        ///< of lines
    const char* layer = "marks";
};

class Canvas {
public:
    /// Draws on a picture, which must have rgba8 of its size.
    explicit Canvas(Image picture);
    Canvas(int width, int height, Color background);

    [[nodiscard]] const Image& image() const { return image_; }
    [[nodiscard]] Image take() { return std::move(image_); }

    /// From now on, what is filled is written into a list too; null: no more.
    void record(std::vector<VectorShape>* shapes) { shapes_ = shapes; }

    /// Fills what the contours enclose. A pixel's coverage is |sum over contours of turns times area|, at most 1: holes turn the other way.
    /// Time: rows times points.
    void fill(std::span<const Contour> contours, Color color);
    void fill_box(Point corner, double width, double height, Color color);
    /// Puts a picture over this one, with its upper left corner at pixel (x, y).
    void put(int x, int y, const Image& picture);

    /// A line with square ends at `from` and `to`. Nothing if the two are one point.
    void line(Point from, Point to, double width, Color color);
    /// A filled triangle with its tip at `tip`, pointing away from `tail`; 0.7 times as wide as long.
    void arrow_head(Point tail, Point tip, double length, Color color);
    /// A line with an arrow head at `to`, five widths long, or half as long as the line if that is less.
    void arrow(Point from, Point to, double width, Color color);
    /// A disc, as a polygon of 64 sides: at most 0.3 % less area.
    void dot(Point center, double radius, Color color);

private:
    void blend(int x, int y, Color color, unsigned alpha);

    Image image_;
    std::vector<VectorShape>* shapes_ = nullptr;
};

}  // namespace halflit::engine
