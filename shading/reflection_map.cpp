// How the levels are made. B(r) is a bump: (1 - (1 - cos t) / (1 - cos r))^2 up to the angle r. G_0 is the image; G_(k+1) is G_k blurred by
// B(0.02 2^k), so that each is about twice as wide as the one before, and may have half its resolution. The lobes have long tails, which
// bumps have not: level k is a sum of G_k, G_(k+1), G_(k+2) and level k + 1. All is + - * / in a fixed order.
#include "shading/reflection_map.hpp"

#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>

namespace halflit::shading {
namespace {

constexpr double kFirstRadius = 0.02;
constexpr float kMostRadiance = 1e30f;  ///< sums of many values stay finite
/// Weights of G_k, G_(k+1), G_(k+2) and level k + 1; of G_6 .. G_9 for the last level. Fitted in spherical harmonics to the lobes; a band l
/// counts as its share in pictures does, 1 / (l + 1).
constexpr float kWeights[kReflectionLevels][4] = {{0.1233f, 0.5976f, 0.1412f, 0.1379f},  {0.0267f, 0.3484f, 0.3148f, 0.3101f},
                                                  {0.0335f, 0.3546f, 0.3037f, 0.3082f},  {0.0356f, 0.3655f, 0.2997f, 0.2992f},
                                                  {0.0372f, 0.3931f, 0.3036f, 0.2661f},  {0.0423f, 0.4631f, 0.3716f, 0.1230f},
                                                  {0.0610f, 0.5947f, -0.1101f, 0.4544f}, {-0.0101f, 0.0677f, 1.2282f, -0.2858f}};

using Value = std::array<float, 4>;

/// Values of one level, of a Globe or of the map.
struct View {
    int n;
    const Value* values;
    [[nodiscard]] const Value* row(int j) const { return values + static_cast<std::ptrdiff_t>(j) * (2 * n + 1); }
};

/// A level that owns its values.
struct Globe {
    int n = 0;
    std::vector<Value> values;

    explicit Globe(int rows) : n(rows), values(static_cast<std::size_t>(rows + 1) * static_cast<std::size_t>(2 * rows + 1)) {}
    [[nodiscard]] Value* row(int j) { return values.data() + static_cast<std::ptrdiff_t>(j) * (2 * n + 1); }
    [[nodiscard]] const Value* row(int j) const { return values.data() + static_cast<std::ptrdiff_t>(j) * (2 * n + 1); }
    [[nodiscard]] View view() const { return {n, values.data()}; }
    void close_row(int j) { row(j)[2 * n] = row(j)[0]; }
    /// Gives the poles one value each.
    void close_poles() {
        for (const int j : {0, n}) {
            Value sum{};
            for (int i = 0; i < 2 * n; ++i)
                for (std::size_t c = 0; c < 3; ++c) sum[c] += row(j)[i][c];
            for (std::size_t c = 0; c < 3; ++c) sum[c] *= 1.0f / static_cast<float>(2 * n);
            std::fill_n(row(j), 2 * n + 1, sum);
        }
    }
};

/// Weights of `from` pixels in each of `to` larger ones along a side: pixel i of the result is the mean over [i, i + 1) * from / to.
struct Overlap {
    int first, count;      ///< pixels
    double before, after;  ///< shares of the first and the last one that lie outside
    [[nodiscard]] double weight(int k) const { return 1.0 - (k == 0 ? before : 0.0) - (k == count - 1 ? after : 0.0); }
};
Overlap overlap(int i, int from, int to) {
    const double begin = static_cast<double>(std::int64_t{i} * from) / to, end = static_cast<double>((std::int64_t{i} + 1) * from) / to;
    const int first = static_cast<int>(begin), last = std::min(static_cast<int>(end), from - 1);
    const int count = end > last ? last - first + 1 : last - first;
    return {first, count, begin - first, first + count - end};
}

/// An image of fewer pixels, each of which is the mean over its area.
std::vector<float> shrunk(const sh::EquirectView& image, int width, int height) {
    std::vector<float> out;
    out.reserve(static_cast<std::size_t>(3) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
        check_time();
        const Overlap rows = overlap(y, image.height, height);
        for (int x = 0; x < width; ++x) {
            const Overlap columns = overlap(x, image.width, width);
            double sum[3] = {}, area = 0;
            for (int j = 0; j < rows.count; ++j)
                for (int i = 0; i < columns.count; ++i) {
                    const double weight = rows.weight(j) * columns.weight(i);
                    const float* const pixel =
                        image.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(rows.first + j) * image.width + columns.first + i);
                    for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[c] + weight * static_cast<double>(pixel[c]);
                    area = area + weight;
                }
            for (const double s : sum) out.push_back(static_cast<float>(s / area));
        }
    }
    return out;
}

/// Halves an image, by means of squares of pixels, until it has at most kMostReflectionRows rows; from an odd size on, it is shrunk to them
/// at once. `rgb`: its memory.
sh::EquirectView reduced(const sh::EquirectView& image, std::vector<float>& rgb) {
    sh::EquirectView out = image;
    while (out.height > kMostReflectionRows && out.width % 2 == 0 && out.height % 2 == 0) {
        const int width = out.width / 2, height = out.height / 2;
        rgb.resize(std::max(rgb.size(), static_cast<std::size_t>(3) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)));
        for (int y = 0; y < height; ++y) {
            check_time();
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int row, int column) {
                        return out.rgb[static_cast<std::size_t>(((2 * y + row) * out.width + 2 * x + column) * 3 + c)];
                    };
                    rgb[static_cast<std::size_t>((y * width + x) * 3 + c)] = 0.25f * ((at(0, 0) + at(0, 1)) + (at(1, 0) + at(1, 1)));
                }
        }
        out = {width, height, rgb};
    }
    if (out.height > kMostReflectionRows) {
        const int width = std::min(out.width, 2 * kMostReflectionRows);
        std::vector<float> smaller = shrunk(out, width, kMostReflectionRows);
        rgb = std::move(smaller);
        out = {width, kMostReflectionRows, rgb};
    }
    return out;
}

/// u, v in [0, 1].
Value bilinear(const sh::EquirectView& image, double u, double v) {
    const double x = u * image.width - 0.5, y = std::clamp(v * image.height - 0.5, 0.0, image.height - 1.0);
    const int x0 = static_cast<int>(x + 1.0) - 1, y0 = static_cast<int>(y);
    const auto right = static_cast<float>(x - x0), down = static_cast<float>(y - y0);
    const auto pixel = [&](int i, int j) {
        i = i < 0 ? i + image.width : i >= image.width ? i - image.width : i;
        j = std::min(j, image.height - 1);
        return image.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(j) * image.width + i);
    };
    const float *a = pixel(x0, y0), *b = pixel(x0 + 1, y0), *c = pixel(x0, y0 + 1), *d = pixel(x0 + 1, y0 + 1);
    Value out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float upper = a[i] + right * (b[i] - a[i]), lower = c[i] + right * (d[i] - c[i]);
        const float value = upper + down * (lower - upper);
        out[i] = value < kMostRadiance ? value : kMostRadiance;  // not a number: infinities have met
    }
    return out;
}

Globe sampled(const sh::EquirectView& image, int n, const ForEachRow& for_each_row) {
    Globe out(n);
    for_each_row(n + 1, [&](int j) {
        for (int i = 0; i < 2 * n; ++i) out.row(j)[i] = bilinear(image, i / (2.0 * n), j / static_cast<double>(n));
        out.close_row(j);
    });
    out.close_poles();
    return out;
}

/// Blurs `from` by a bump of the given radius. n: rows of the result, those of `from` or half of them.
Globe blurred(const Globe& from, int n, double radius, const ForEachRow& for_each_row) {
    Globe out(n);
    const int columns = 2 * from.n, ratio = from.n / n;
    const double step = kPi / from.n, half_sine = sin_cos(0.5 * std::min(radius, kPi)).sin;
    const double scale = 0.5 / (half_sine * half_sine);  // 1 / (1 - cos radius)
    const int reach = static_cast<int>(radius / step) + 1;
    std::vector<double> cosines;  // of longitudes
    for (int i = 0; i <= from.n; ++i) cosines.push_back(sin_cos(step * i).cos);
    for_each_row(n + 1, [&](int y) {
        const SinCos polar = sin_cos(kPi * y / n);
        std::vector<Value> sums(static_cast<std::size_t>(2 * n));
        float total = 0.0f;
        std::vector<float> weights;  // of the columns at a distance of 0 .. from the middle
        for (int j = std::max(0, y * ratio - reach); j <= std::min(from.n, y * ratio + reach); ++j) {
            const SinCos other = sin_cos(step * j);
            const double solid_angle = j == 0 || j == from.n ? step / 8 : other.sin;
            weights.clear();
            for (int i = 0; i <= from.n; ++i) {
                const double cosine = polar.cos * other.cos + polar.sin * other.sin * cosines[static_cast<std::size_t>(i)];
                const double near = 1.0 - (1.0 - cosine) * scale;
                if (!(near > 0.0)) break;
                weights.push_back(static_cast<float>(near * near * solid_angle));
            }
            const auto count = static_cast<int>(weights.size());
            const Value* const row = from.row(j);
            for (int offset = 1 - count; offset < count; ++offset) {
                if (offset == -from.n) continue;  // the same column as at from.n
                const float weight = weights[static_cast<std::size_t>(offset < 0 ? -offset : offset)];
                total += weight;
                int at = offset < 0 ? offset + columns : offset;
                for (int x = 0; x < 2 * n; ++x, at += ratio) {
                    if (at >= columns) at -= columns;
                    for (std::size_t c = 0; c < 4; ++c) sums[static_cast<std::size_t>(x)][c] += weight * row[at][c];
                }
            }
        }
        for (int x = 0; x < 2 * n; ++x)
            for (std::size_t c = 0; c < 3; ++c) out.row(y)[x][c] = sums[static_cast<std::size_t>(x)][c] / total;
        out.close_row(y);
    });
    out.close_poles();
    return out;
}

/// Value at row j, column i of a globe of n rows, from one that has as many or fewer by a power of two.
Value resampled(const View& from, int n, int j, int i) {
    const int ratio = n / from.n, y = std::min(j / ratio, from.n - 1), x = std::min(i / ratio, 2 * from.n - 1);
    const float down = static_cast<float>(j - y * ratio) / static_cast<float>(ratio);
    const float right = static_cast<float>(i - x * ratio) / static_cast<float>(ratio);
    const Value *upper = from.row(y) + x, *lower = from.row(y + 1) + x;
    Value out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float above = upper[0][c] + right * (upper[1][c] - upper[0][c]), below = lower[0][c] + right * (lower[1][c] - lower[0][c]);
        out[c] = above + down * (below - above);
    }
    return out;
}

/// Writes the weighted sum of four levels, not below 0, as n rows.
void write_sum(const View (&parts)[4], const float (&weights)[4], int n, Value* out, const ForEachRow& for_each_row) {
    for_each_row(n + 1, [&](int j) {
        for (int i = 0; i <= 2 * n; ++i) {
            Value sum{};
            for (std::size_t part = 0; part < 4; ++part) {
                const Value value = resampled(parts[part], n, j, i);
                for (std::size_t c = 0; c < 3; ++c) sum[c] += weights[part] * value[c];
            }
            for (float& channel : sum) channel = channel > 0.0f ? channel : 0.0f;
            out[static_cast<std::ptrdiff_t>(j) * (2 * n + 1) + i] = sum;
        }
    });
}

}  // namespace

ReflectionMap make_reflection_map(const sh::EquirectView& image, const ForEachRow& for_each_row) {
    constexpr int kBlurs = kReflectionLevels + 2;  // G_0 .. G_9
    std::vector<float> rgb;
    const sh::EquirectView source = reduced(image, rgb);
    int most = kLeastReflectionRows;
    while (most < kMostReflectionRows && most < source.height) most *= 2;
    const auto rows_of = [&](int k) { return std::clamp(kMostReflectionRows >> k, kLeastReflectionRows, most); };
    // Maps blurred by bumps of 147 degrees and more need fewer.
    const auto blurred_rows = [&](int k) { return k < 8 ? rows_of(k) : kLeastReflectionRows / 2; };

    std::vector<Globe> blurs;
    blurs.push_back(sampled(source, most, for_each_row));
    for (int k = 0; k + 1 < kBlurs; ++k) {
        if ((kMostReflectionRows >> k) > most)  // the image has no details that this bump would blur
            blurs.push_back(blurs.back());
        else
            blurs.push_back(blurred(blurs.back(), blurred_rows(k + 1), kFirstRadius * (1 << k), for_each_row));
    }
    ReflectionMap map{};
    std::size_t size = 0;
    for (int k = 0; k < kReflectionLevels; ++k) {
        map.rows[k] = rows_of(k);
        map.first[k] = static_cast<std::int32_t>(size);
        size += static_cast<std::size_t>(map.rows[k] + 1) * static_cast<std::size_t>(2 * map.rows[k] + 1);
    }
    map.rgba.resize(size);
    const auto level = [&](int k) { return View{map.rows[k], map.rgba.data() + map.first[k]}; };
    for (int k = kReflectionLevels - 1; k >= 0; --k) {
        const auto blur = [&](int number) { return blurs[static_cast<std::size_t>(number)].view(); };
        const bool last = k == kReflectionLevels - 1;
        const int from = last ? k - 1 : k;
        write_sum({blur(from), blur(from + 1), blur(from + 2), last ? blur(from + 3) : level(k + 1)}, kWeights[k], map.rows[k],
                  map.rgba.data() + map.first[k], for_each_row);
    }
    return map;
}

}  // namespace halflit::shading
