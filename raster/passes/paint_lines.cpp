#include "raster/passes/paint_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace halflit::raster {
namespace {

constexpr double kHiddenWidth = 0.7, kHiddenShare = 0.6;  ///< of seen lines' width and cover
constexpr double kDash = 6.0, kGap = 4.0;                 ///< widths of the hidden line, its round ends included

/// Shares of the pixels of some rows that lines cover, 0 to 255.
class CoverRows {
public:
    CoverRows(int x, int y, int width, int height)
        : x_(x), y_(y), width_(width), height_(height), cover_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

    void add(const EdgeLine& line, double width) {
        const double w = line.hidden ? larger(kHiddenWidth * width, 1.0) : width;
        if (!touches(line, w)) return;
        if (!line.hidden) {
            segment(line.x0, line.y0, line.x1, line.y1, w, 1.0);
            return;
        }
        const double dx = line.x1 - line.x0, dy = line.y1 - line.y0, length = std::sqrt(dx * dx + dy * dy);
        const double period = (kDash + kGap) * w, dash = (kDash - 1.0) * w;  // a round end at each side
        if (!(length > 0.0)) return;
        for (double k = std::floor(line.begin_px / period); k * period < line.begin_px + length; k += 1.0) {
            const double from = larger(k * period - line.begin_px, 0.0) / length;
            const double to = smaller(k * period + dash - line.begin_px, length) / length;
            if (from < to) segment(line.x0 + dx * from, line.y0 + dy * from, line.x0 + dx * to, line.y0 + dy * to, w, kHiddenShare);
        }
    }
    [[nodiscard]] const std::uint8_t* row(int y) const { return &cover_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)]; }

private:
    static double larger(double a, double b) { return a < b ? b : a; }
    static double smaller(double a, double b) { return b < a ? b : a; }

    [[nodiscard]] bool touches(const EdgeLine& line, double width) const {
        const double reach = 0.5 * width + 1.0;
        return larger(line.y0, line.y1) + reach > y_ && smaller(line.y0, line.y1) - reach < y_ + height_ &&
               larger(line.x0, line.x1) + reach > x_ && smaller(line.x0, line.x1) - reach < x_ + width_;
    }

    void segment(double x0, double y0, double x1, double y1, double width, double share) {
        const double reach = 0.5 * width + 0.5, thin = smaller(width, 1.0), dx = x1 - x0, dy = y1 - y0, squared = dx * dx + dy * dy;
        const auto bound = [](double v, int low, int high) { return static_cast<int>(larger(low, smaller(v, high))); };
        const int top = bound(std::floor(smaller(y0, y1) - reach), y_, y_ + height_);
        const int bottom = bound(std::floor(larger(y0, y1) + reach) + 1.0, y_, y_ + height_);
        for (int y = top; y < bottom; ++y) {
            const double py = y + 0.5 - y0;
            // Columns that the line may touch in this row: those beside the part of it within reach of the row's middle.
            double from = smaller(x0, x1), to = larger(x0, x1);
            if (absolute(dy) > 1e-9) {
                const double a = x0 + dx * clamp01((py - reach) / dy), b = x0 + dx * clamp01((py + reach) / dy);
                from = smaller(a, b), to = larger(a, b);
            }
            const int left = bound(std::floor(from - reach), x_, x_ + width_), right = bound(std::floor(to + reach) + 1.0, x_, x_ + width_);
            std::uint8_t* const row = &cover_[static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_)];
            for (int x = left; x < right; ++x) {
                const double px = x + 0.5 - x0, t = squared > 0.0 ? clamp01((px * dx + py * dy) / squared) : 0.0;
                const double ax = px - dx * t, ay = py - dy * t;
                const double covered = smaller(reach - std::sqrt(ax * ax + ay * ay), thin);
                if (!(covered > 0.0)) continue;
                const auto code = static_cast<std::uint8_t>(255.0 * share * covered + 0.5);
                row[x - x_] = std::max(row[x - x_], code);
            }
        }
    }
    static double clamp01(double t) { return t > 0.0 ? t < 1.0 ? t : 1.0 : 0.0; }
    static double absolute(double t) { return t < 0.0 ? -t : t; }

    int x_, y_, width_, height_;
    std::vector<std::uint8_t> cover_;
};

/// Lays an opaque colour over a pixel of the caller's memory, by a share of 0 to 255.
class OverPixel {
public:
    OverPixel(Vec3f color_linear, const Output& output, const shading::ShadeKernels& shade) : color_(color_linear), output_(output) {
        alignas(64) float rows[4][16] = {};
        rows[0][0] = color_linear.x, rows[1][0] = color_linear.y, rows[2][0] = color_linear.z, rows[3][0] = 1.0f;
        alignas(64) std::uint32_t packed[16];
        shade.encode_srgb8(rows[0], rows[1], rows[2], rows[3], 1.0f, packed, 1);
        output.finish_codes(packed, 1);
        std::memcpy(codes_, packed, sizeof codes_);
    }

    void paint(int x, int y, unsigned share) const {
        if (output_.codes) {
            std::uint8_t* const p = output_.codes.at(x, y);
            const unsigned alpha = p[3], rest = 255u - share;
            const unsigned sum = 255u * share + alpha * rest;  // new alpha times 255
            // Straight codes count by their alpha, premultiplied ones as they are.
            for (int c = 0; c < 3; ++c)
                p[c] = static_cast<std::uint8_t>(output_.is_premultiplied()
                                                     ? (codes_[c] * share + p[c] * rest + 127u) / 255u
                                                     : (codes_[c] * share * 255u + p[c] * alpha * rest + sum / 2) / sum);
            p[3] = static_cast<std::uint8_t>((sum + 127u) / 255u);
        }
        if (output_.linear) {
            float* const p = output_.linear.at(x, y);
            const float over = static_cast<float>(share) / 255.0f, under = 1.0f - over;
            const float alpha = over + p[3] * under;
            const float color[3] = {color_.x, color_.y, color_.z};
            for (int c = 0; c < 3; ++c)
                p[c] = output_.is_premultiplied() ? color[c] * over + p[c] * under : (color[c] * over + (p[c] * p[3]) * under) / alpha;
            p[3] = alpha;
        }
    }

private:
    Vec3f color_;
    const Output& output_;
    std::uint8_t codes_[4]{};
};

}  // namespace

void paint_lines(std::span<const EdgeLine> lines, const Settings& settings, const Region& region, const Output& output,
                 const shading::ShadeKernels& shade, Executor& executor) {
    const OverPixel over(settings.edge_color_linear, output, shade);
    constexpr int kRows = 32;
    executor.run((region.height + kRows - 1) / kRows, [&](int band) {
        const int y0 = region.y + band * kRows, height = std::min(kRows, region.y + region.height - y0);
        CoverRows cover(region.x, y0, region.width, height);
        for (const EdgeLine& line : lines) cover.add(line, settings.edge_width);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < region.width; ++x)
                if (const unsigned share = cover.row(y)[x]; share > 0) over.paint(region.x + x, y0 + y, share);
    });
}

}  // namespace halflit::raster
