#include "raster/passes/paint_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

namespace halflit::raster {
namespace {

constexpr double kHiddenWidth = 0.7, kHiddenShare = 0.6;  ///< of seen lines' width and cover
constexpr Vec3f kLightLine{0.74f, 0.74f, 0.74f};          ///< 224 codes
constexpr double kDash = 6.0, kGap = 4.0;                 ///< widths of the hidden line, its round ends included

/// Shares of the pixels of some rows that lines cover, 0 to 255.
class CoverRows {
public:
    CoverRows(int x, int y, int width, int height)
        : x_(x), y_(y), width_(width), height_(height), cover_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

    void add(const EdgeLine& line, double width) {
        const double w = line.hidden ? larger(kHiddenWidth * width, 1.0) : width;
        if (!line.hidden) {
            segment(line, line.t0, line.t1, w, 1.0);
            return;
        }
        const double dx = line.x1 - line.x0, dy = line.y1 - line.y0, length = std::sqrt(dx * dx + dy * dy);
        const double period = (kDash + kGap) * w, dash = (kDash - 1.0) * w;  // a round end at each side
        if (!(length > 0.0)) return;
        const double end = line.begin_px + line.t1 * length;
        for (double k = std::floor((line.begin_px + line.t0 * length) / period); k * period < end; k += 1.0) {
            const double from = larger((k * period - line.begin_px) / length, line.t0);
            const double to = smaller((k * period + dash - line.begin_px) / length, line.t1);
            if (from < to) segment(line, from, to, w, kHiddenShare);
        }
    }
    [[nodiscard]] const std::uint8_t* row(int y) const { return &cover_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)]; }

private:
    static double larger(double a, double b) { return a < b ? b : a; }
    static double smaller(double a, double b) { return b < a ? b : a; }

    /// The part of a line from one share of its length to another.
    void segment(const EdgeLine& line, double t0, double t1, double width, double share) {
        const double x0 = line.x0, y0 = line.y0, dx = line.x1 - x0, dy = line.y1 - y0, squared = dx * dx + dy * dy;
        const double reach = 0.5 * width + 0.5, thin = smaller(width, 1.0);
        const double begin_x = x0 + dx * t0, begin_y = y0 + dy * t0, end_x = x0 + dx * t1, end_y = y0 + dy * t1;
        const auto bound = [](double v, int low, int high) { return static_cast<int>(larger(low, smaller(v, high))); };
        const int top = bound(std::floor(smaller(begin_y, end_y) - reach), y_, y_ + height_);
        const int bottom = bound(std::floor(larger(begin_y, end_y) + reach) + 1.0, y_, y_ + height_);
        for (int y = top; y < bottom; ++y) {
            const double py = y + 0.5 - y0;
            // Columns that the line may touch in this row: those beside the part of it within reach of the row's middle.
            double from = smaller(begin_x, end_x), to = larger(begin_x, end_x);
            if (absolute(dy) > 1e-9) {
                const double a = x0 + dx * within((py - reach) / dy, t0, t1), b = x0 + dx * within((py + reach) / dy, t0, t1);
                from = smaller(a, b), to = larger(a, b);
            }
            const int left = bound(std::floor(from - reach), x_, x_ + width_), right = bound(std::floor(to + reach) + 1.0, x_, x_ + width_);
            std::uint8_t* const row = &cover_[static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_)];
            for (int x = left; x < right; ++x) {
                const double px = x + 0.5 - x0, t = squared > 0.0 ? within((px * dx + py * dy) / squared, t0, t1) : 0.0;
                const double ax = px - dx * t, ay = py - dy * t;
                const double covered = smaller(reach - std::sqrt(ax * ax + ay * ay), thin);
                if (!(covered > 0.0)) continue;
                const auto code = static_cast<std::uint8_t>(255.0 * share * covered + 0.5);
                row[x - x_] = std::max(row[x - x_], code);
            }
        }
    }
    static double within(double t, double low, double high) { return t > low ? t < high ? t : high : low; }
    static double absolute(double t) { return t < 0.0 ? -t : t; }

    int x_, y_, width_, height_;
    std::vector<std::uint8_t> cover_;
};

/// The lines that may touch each band of rows.
class LineBands {
public:
    static constexpr int kRows = 32;
    LineBands(std::span<const EdgeLine> lines, double width, const Region& region, StopSignal& stop)
        : first_(static_cast<std::size_t>((region.height + kRows - 1) / kRows) + 1, 0) {
        const double reach = 0.5 * width + 2.0;
        const auto each = [&](const auto& visit) {
            for (std::uint32_t i = 0; i < lines.size(); ++i) {
                const EdgeLine& line = lines[i];
                const double dy = line.y1 - line.y0, a = line.y0 + dy * line.t0 - region.y, b = line.y0 + dy * line.t1 - region.y;
                const double low = (std::min(a, b) - reach) / kRows, high = (std::max(a, b) + reach) / kRows;
                if (!(high >= 0.0 && low < count())) continue;
                const int last = high < count() ? static_cast<int>(high) : count() - 1;
                for (int band = low > 0.0 ? static_cast<int>(low) : 0; band <= last; ++band) visit(static_cast<std::size_t>(band), i);
            }
        };
        each([&](std::size_t band, std::uint32_t) { ++first_[band]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());  // the ends; filling from there leaves the beginnings
        memory_.hold(stop, first_.back() * sizeof(std::uint32_t));
        lines_.resize(first_.back());
        each([&](std::size_t band, std::uint32_t i) { lines_[--first_[band]] = i; });
    }
    [[nodiscard]] int count() const { return static_cast<int>(first_.size()) - 1; }
    [[nodiscard]] std::span<const std::uint32_t> lines(int band) const {
        const auto at = static_cast<std::size_t>(band);
        return std::span(lines_).subspan(first_[at], first_[at + 1] - first_[at]);
    }

private:
    std::vector<std::size_t> first_;  ///< of each band in lines_, and the end
    std::vector<std::uint32_t> lines_;
    MemoryShare memory_;
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
            // Light may be infinite, as a background's: what does not show is not counted.
            const bool shows = under > 0.0f && p[3] > 0.0f;
            for (int c = 0; c < 3; ++c) {
                const float below = !shows ? 0.0f : output_.is_premultiplied() ? p[c] * under : (p[c] * p[3]) * under;
                p[c] = output_.is_premultiplied() ? color[c] * over + below : (color[c] * over + below) / alpha;
            }
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
    const OverPixel of_color(settings.edge_color_linear, output, shade), of_light(kLightLine, output, shade);
    const LineBands bands(lines, settings.edge_width, region, executor.stop());
    executor.run(bands.count(), [&](int band) {
        const int y0 = region.y + band * LineBands::kRows, height = std::min(LineBands::kRows, region.y + region.height - y0);
        const auto paint = [&](bool light, const OverPixel& over) {
            const auto is_one = [&](std::uint32_t line) { return lines[line].light == light; };
            if (std::none_of(bands.lines(band).begin(), bands.lines(band).end(), is_one)) return;
            CoverRows cover(region.x, y0, region.width, height);
            for (const std::uint32_t line : bands.lines(band))
                if (is_one(line)) cover.add(lines[line], settings.edge_width);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < region.width; ++x)
                    if (const unsigned share = cover.row(y)[x]; share > 0) over.paint(region.x + x, y0 + y, share);
        };
        paint(false, of_color);
        paint(true, of_light);
    });
}

}  // namespace halflit::raster
