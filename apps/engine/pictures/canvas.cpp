#include "apps/engine/pictures/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halflit::engine {
namespace {

/// An edge of a shape that is not level, in a frame whose corner is at a whole pixel and left of and above all points.
struct CanvasEdge {
    Point top, bottom;
    double slope;  ///< change of x with y
    double turn;   ///< 1 if the contour goes down along it, else -1
};

/// The changes of coverage along one row of pixels: the coverage of pixel i is |changes[0] + .. + changes[i]|.
struct CoverageRow {
    int left, right;              ///< columns that the canvas shows, of the shape's frame; right is one past the last
    std::vector<double> changes;  ///< right - left + 1 of them, zeros between rows
    int first, last;              ///< changes that may differ from 0

    void add(int column, double cover, double from_left) {
        const int i = column - left;
        changes[static_cast<std::size_t>(i)] += cover * (1.0 - from_left);
        changes[static_cast<std::size_t>(i) + 1] += cover * from_left;
        first = std::min(first, i), last = std::max(last, i + 1);
    }

    /// Adds the part of an edge that lies between y0 and y1, both in this row.
    void add(const CanvasEdge& edge, double y0, double y1) {
        const double low = std::min(edge.top.x, edge.bottom.x), high = std::max(edge.top.x, edge.bottom.x);
        const double xa = std::clamp(edge.top.x + (y0 - edge.top.y) * edge.slope, low, high);
        const double xb = std::clamp(edge.top.x + (y1 - edge.top.y) * edge.slope, low, high);
        const double x0 = std::min(xa, xb), x1 = std::max(xa, xb), cover = (y1 - y0) * edge.turn;
        if (x1 >= right) last = right - left;
        if (x0 >= right) return;
        if (x1 <= left) return add(left, cover, 0.0);
        if (x1 - x0 < 1e-6) return add(static_cast<int>(x0), cover, x0 - static_cast<int>(x0));
        const double cover_per_x = cover / (x1 - x0);
        if (x0 < left) add(left, cover_per_x * (left - x0), 0.0);
        for (int column = std::max(left, static_cast<int>(x0)); column < right && column < x1; ++column) {
            const double from = std::max<double>(x0, column), to = std::min<double>(x1, column + 1);
            add(column, cover_per_x * (to - from), (from + to) / 2 - column);
        }
    }
};

/// A quarter of the unit circle: 16 points from (1, 0) on. The half-angle's tangent gives them without sine and cosine.
Contour quarter_circle() {
    Contour points;
    for (int i = 0; i < 16; ++i) {
        const double t = i / 16.0;
        points.push_back({(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)});
    }
    return points;
}

double distance(Point a, Point b) { return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)); }

}  // namespace

double on_canvas_grid(double x) { return std::floor(x / kCanvasGrid + 0.5) * kCanvasGrid; }

Canvas::Canvas(Image picture) : image_(std::move(picture)) {}

Canvas::Canvas(int width, int height, Color background) : image_(Image::make(width, height)) {
    for (std::size_t i = 0; i < image_.rgba8.size(); i += 4) {
        image_.rgba8[i] = background.r, image_.rgba8[i + 1] = background.g;
        image_.rgba8[i + 2] = background.b, image_.rgba8[i + 3] = background.a;
    }
}

void Canvas::blend(int x, int y, Color color, unsigned alpha) {
    std::uint8_t* p =
        &image_.rgba8[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x))];
    const unsigned above = 255 * alpha, below = p[3] * (255 - alpha), sum = above + below;  // of 255 * 255
    if (sum == 0) return;
    const unsigned codes[3] = {color.r, color.g, color.b};
    for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>((codes[c] * above + p[c] * below + sum / 2) / sum);
    p[3] = static_cast<std::uint8_t>((sum + 127) / 255);
}

void Canvas::fill(std::span<const Contour> contours, Color color) {
    if (shapes_ != nullptr) shapes_->push_back({{contours.begin(), contours.end()}, color});
    Point low{kCanvasFarthest, kCanvasFarthest}, high{-kCanvasFarthest, -kCanvasFarthest};
    for (const Contour& contour : contours)
        for (const Point p : contour) {
            if (!(std::abs(p.x) <= kCanvasFarthest && std::abs(p.y) <= kCanvasFarthest)) return;
            low = {std::min(low.x, on_canvas_grid(p.x)), std::min(low.y, on_canvas_grid(p.y))};
            high = {std::max(high.x, on_canvas_grid(p.x)), std::max(high.y, on_canvas_grid(p.y))};
        }
    if (low.x >= high.x || low.y >= high.y) return;
    const auto x0 = static_cast<int>(std::floor(low.x)), y0 = static_cast<int>(std::floor(low.y));
    const auto x1 = static_cast<int>(std::ceil(high.x)), y1 = static_cast<int>(std::ceil(high.y));
    CoverageRow row{std::max(0, -x0), std::min(x1, image_.width) - x0, {}, 0, 0};
    if (row.left >= row.right) return;
    row.changes.resize(static_cast<std::size_t>(row.right - row.left) + 1);

    std::vector<CanvasEdge> edges;
    for (const Contour& contour : contours)
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const Point from = contour[i], to = contour[i + 1 == contour.size() ? 0 : i + 1];
            const Point a{on_canvas_grid(from.x) - x0, on_canvas_grid(from.y) - y0};
            const Point b{on_canvas_grid(to.x) - x0, on_canvas_grid(to.y) - y0};
            if (a.y < b.y) edges.push_back({a, b, (b.x - a.x) / (b.y - a.y), 1.0});
            if (a.y > b.y) edges.push_back({b, a, (a.x - b.x) / (a.y - b.y), -1.0});
        }
    for (int y = std::max(0, -y0); y < std::min(y1, image_.height) - y0; ++y) {
        row.first = row.right - row.left, row.last = -1;
        for (const CanvasEdge& edge : edges)
            if (edge.top.y < y + 1 && edge.bottom.y > y) row.add(edge, std::max<double>(edge.top.y, y), std::min(edge.bottom.y, y + 1.0));
        double sum = 0.0;
        for (int i = row.first; i <= row.last; ++i) {
            sum += std::exchange(row.changes[static_cast<std::size_t>(i)], 0.0);
            const auto alpha = static_cast<unsigned>(std::min(std::abs(sum), 1.0) * color.a + 0.5);
            if (alpha > 0 && i < row.right - row.left) blend(x0 + row.left + i, y0 + y, color, alpha);
        }
    }
}

void Canvas::fill_box(Point corner, double width, double height, Color color) {
    const double x1 = corner.x + width, y1 = corner.y + height;
    fill(std::vector<Contour>{{corner, {x1, corner.y}, {x1, y1}, {corner.x, y1}}}, color);
}

void Canvas::put(int x, int y, const Image& picture) {
    const auto first = [](int at) { return std::max<std::int64_t>(0, -std::int64_t{at}); };
    const auto end = [](int at, int pixels, int room) { return std::min<std::int64_t>(pixels, std::int64_t{room} - at); };
    for (std::int64_t j = first(y); j < end(y, picture.height, image_.height); ++j)
        for (std::int64_t i = first(x); i < end(x, picture.width, image_.width); ++i) {
            const std::uint8_t* from = &picture.rgba8[4 * static_cast<std::size_t>(j * picture.width + i)];
            std::uint8_t* to = &image_.rgba8[4 * static_cast<std::size_t>((y + j) * image_.width + x + i)];
            if (from[3] == 255)
                std::copy_n(from, 4, to);
            else
                blend(static_cast<int>(x + i), static_cast<int>(y + j), {from[0], from[1], from[2]}, from[3]);
        }
}

void Canvas::line(Point from, Point to, double width, Color color) {
    const double length = distance(from, to);
    if (!(length > 0.0)) return;
    const Point side{(from.y - to.y) / length * (width / 2), (to.x - from.x) / length * (width / 2)};
    fill(std::vector<Contour>{{from + side, to + side, to - side, from - side}}, color);
}

void Canvas::arrow_head(Point tail, Point tip, double length, Color color) {
    const double whole = distance(tail, tip);
    if (!(whole > 0.0)) return;
    const Point along = (tip - tail) * (1.0 / whole), base = tip - along * length, side = Point{-along.y, along.x} * (0.35 * length);
    fill(std::vector<Contour>{{tip, base + side, base - side}}, color);
}

void Canvas::arrow(Point from, Point to, double width, Color color) {
    const double length = distance(from, to);
    if (!(length > 0.0)) return;
    const double head = std::min(5 * width, length / 2);
    line(from, to - (to - from) * (head / length), width, color);
    arrow_head(from, to, head, color);
}

void Canvas::dot(Point center, double radius, Color color) {
    Contour points;
    for (int quarter = 0; quarter < 4; ++quarter)
        for (const Point p : quarter_circle()) {
            const Point turned[4] = {p, {-p.y, p.x}, {-p.x, -p.y}, {p.y, -p.x}};
            points.push_back(center + turned[quarter] * radius);
        }
    fill(std::vector<Contour>{points}, color);
}

}  // namespace halflit::engine
