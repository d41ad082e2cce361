#include "sh/project.hpp"

#include "sh/time_limit.hpp"

#include "sh/detail/legendre.hpp"
#include "sh/rotate.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <limits>

namespace halflit::sh {
namespace {

constexpr int kBands = kSpectrumBands;
using Harmonics = std::array<Vec3d, kBands>;

/// The image's frame: x along -z, y along +x, z along +y of the world, so that z = cos theta and atan2(y, x) = phi. The map is a
/// reflection.
constexpr Rotation kImageToWorld{{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

/// Integrals of one row against cos(m phi) and sin(m phi), m = 0..63.
///
/// Mirrored columns are added and subtracted first. An even width then needs half of the columns for each harmonic, an odd width all of
/// them. If 4 divides the width, the columns mirror at a quarter turn as well, and a quarter of them is enough; even and odd m then need
/// different sums.
class RowTransform {
public:
    explicit RowTransform(int width) : width_(width), fold_(width % 4 == 0 ? 4 : width % 2 == 0 ? 2 : 1), columns_(width / fold_) {
        table_.resize(static_cast<std::size_t>(columns_) * 2 * kBands);
        for (int k = 0; k < columns_; ++k) {
            const SinCos step = sin_cos(angle(k));
            double c = 1.0, s = 0.0;
            for (int m = 0; m < kBands; ++m) {
                cos_of(k)[m] = c;
                sin_of(k)[m] = s;
                // A fresh pair every 8 steps keeps the recurrence's error at a few ulp.
                if (m % 8 == 7) {
                    const SinCos fresh = sin_cos(angle(k) * (m + 1));
                    c = fresh.cos, s = fresh.sin;
                } else {
                    const double turned = c * step.cos - s * step.sin;
                    s = s * step.cos + c * step.sin;
                    c = turned;
                }
            }
        }
        const double half = kPi / width;  // half a pixel's width
        for (int m = 0; m < kBands; ++m) pixel_[static_cast<std::size_t>(m)] = m == 0 ? 2.0 * half : 2.0 * sin_cos(m * half).sin / m;
    }

    void run(const EquirectView& image, int row, Harmonics& cosines, Harmonics& sines) const {
        cosines.fill({});
        sines.fill({});
        for (int k = 0; k < columns_; ++k) {
            // Sums for even and for odd m, for the cosine and for the sine.
            Vec3d cos_even, cos_odd, sin_even, sin_odd;
            if (fold_ == 1) {
                cos_even = cos_odd = sin_even = sin_odd = image.at(k, row);
            } else {
                const int right = width_ / 2 + k, left = width_ / 2 - 1 - k;
                const Vec3d near_sum = image.at(right, row) + image.at(left, row),
                            near_difference = image.at(right, row) - image.at(left, row);
                cos_even = cos_odd = near_sum;
                sin_even = sin_odd = near_difference;
                if (fold_ == 4) {
                    const int far_right = width_ - 1 - k, far_left = k;
                    const Vec3d far_sum = image.at(far_right, row) + image.at(far_left, row);
                    const Vec3d far_difference = image.at(far_right, row) - image.at(far_left, row);
                    cos_even = near_sum + far_sum;
                    cos_odd = near_sum - far_sum;
                    sin_even = near_difference - far_difference;
                    sin_odd = near_difference + far_difference;
                }
            }
            const double* const c = cos_of(k);
            const double* const s = sin_of(k);
            for (std::size_t m = 0; m < kBands; m += 2) {
                cosines[m] = cosines[m] + cos_even * c[m];
                cosines[m + 1] = cosines[m + 1] + cos_odd * c[m + 1];
                sines[m] = sines[m] + sin_even * s[m];
                sines[m + 1] = sines[m + 1] + sin_odd * s[m + 1];
            }
        }
        for (std::size_t m = 0; m < kBands; ++m) {
            cosines[m] = cosines[m] * pixel_[m];
            sines[m] = sines[m] * pixel_[m];
        }
    }

private:
    /// phi at the middle of column k after folding. Folded columns start at phi = 0, unfolded ones at -pi.
    [[nodiscard]] double angle(int k) const {
        const double turn = (k + 0.5) / width_;
        return 2.0 * kPi * (fold_ == 1 ? turn - 0.5 : turn);
    }
    [[nodiscard]] double* cos_of(int k) { return &table_[static_cast<std::size_t>(k) * 2 * kBands]; }
    [[nodiscard]] double* sin_of(int k) { return cos_of(k) + kBands; }
    [[nodiscard]] const double* cos_of(int k) const { return &table_[static_cast<std::size_t>(k) * 2 * kBands]; }
    [[nodiscard]] const double* sin_of(int k) const { return cos_of(k) + kBands; }

    int width_, fold_, columns_;
    std::vector<double> table_;
    std::array<double, kBands> pixel_{};  ///< integral of cos(m phi) over a pixel centred on 0
};

/// Integrals of p_lm(cos theta) sin theta over one row, by eight nodes per panel. The highest band turns by less than a radian per panel,
/// so the error is below 1e-15.
void integrate_row(int height, int row, const std::vector<GaussNode>& rule, std::array<detail::LegendreRow, kBands>& integrals) {
    for (auto& r : integrals) r.p.fill(0.0);
    const int panels = 1 + static_cast<int>(kBands * kPi / height);
    const double half = 0.5 * kPi / height / panels;
    std::array<detail::LegendreRow, kBands> values;
    for (int panel = 0; panel < panels; ++panel)
        for (const GaussNode& node : rule) {
            const SinCos theta = sin_cos(half * (2.0 * (row * panels + panel) + 1.0 + node.x));
            const double weight = half * node.weight * theta.sin;
            detail::legendre(theta.cos, theta.sin, values);
            for (std::size_t m = 0; m < kBands; ++m)
                for (std::size_t i = 0; i < kBands - m; ++i) integrals[m].p[i] += weight * values[m].p[i];
        }
}

double positive_sqrt(double x) { return x > 0.0 ? __builtin_sqrt(x) : 0.0; }
Vec3d positive_sqrt(Vec3d v) { return {positive_sqrt(v.x), positive_sqrt(v.y), positive_sqrt(v.z)}; }
}  // namespace

Projection::Projection(const EquirectView& image) { add_rows(image, 0, image.height, 1.0); }

void Projection::add_rows(const EquirectView& image, int first_row, int end_row, double factor) {
    const RowTransform transform(image.width);
    const std::vector<GaussNode> rule = gauss_legendre(8);
    Harmonics cosines, sines;
    std::array<detail::LegendreRow, kBands> integrals;
    const auto add_row = [&](int row, double odd) {  // odd: sign of the integrals of odd l - m
        transform.run(image, row, cosines, sines);
        const double signs[2] = {factor, factor * odd};
        for (std::size_t m = 0; m < kBands; ++m)
            for (std::size_t l = m; l < kBands; ++l) {
                const double p = signs[(l - m) % 2] * integrals[m].p[l - m];
                Vec3d& plus = c_[l * l + l + m];
                plus = plus + cosines[m] * p;
                Vec3d& minus = c_[l * l + l - m];
                if (m > 0) minus = minus + sines[m] * p;
            }
        Vec3d squares{}, absolutes{};
        for (int x = 0; x < image.width; ++x) {
            const Vec3d value = image.at(x, row);
            squares = squares + value * value;
            absolutes = absolutes + Vec3d{absolute(value.x), absolute(value.y), absolute(value.z)};
        }
        const double weight = factor * pixel_solid_angle(image.width, image.height, row);
        squares_ = squares_ + squares * weight;
        absolute_ = absolute_ + absolutes * weight;
    };
    for (int row = first_row; row < end_row; ++row) {
        // The row as far below the equator as this one is above it: p_lm(-z) = (-1)^(l - m) p_lm(z).
        const int mirrored = image.height - 1 - row;
        const bool both = mirrored >= first_row && mirrored < end_row;
        if (both && mirrored < row) continue;
        check_time();
        integrate_row(image.height, row, rule, integrals);
        add_row(row, 1.0);
        if (both && mirrored != row) add_row(mirrored, -1.0);
    }
}

RadianceSh Projection::radiance(int bands) const {
    RadianceSh own{bands, {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(bands)); ++i) own.c[i] = c_[i];
    return rotated(own, kImageToWorld);
}

Spectrum Projection::spectrum() const {
    Spectrum out;
    Vec3d known{};
    for (int l = 0; l < kBands; ++l) {
        Vec3d sum{};
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum = sum + c_[static_cast<std::size_t>(i)] * c_[static_cast<std::size_t>(i)];
        known = known + sum;
        out.norm[static_cast<std::size_t>(l)] = positive_sqrt(sum);
    }
    // The difference cancels when the bands hold nearly all light. The term with kRounding covers the rounding error, so that the norm
    // stays a bound.
    constexpr double kRounding = 256 * std::numeric_limits<double>::epsilon();
    const Vec3d rest = squares_ - known;
    out.tail_norm = positive_sqrt(Vec3d{rest.x > 0 ? rest.x : 0, rest.y > 0 ? rest.y : 0, rest.z > 0 ? rest.z : 0} + squares_ * kRounding);
    out.absolute = absolute_;
    return out;
}

Vec3d Projection::mean() const { return c_[0] * detail::kBasisTable.diagonal[0]; }

std::array<Vec3d, kSpectrumBands> Projection::bands_at(Vec3d direction) const {
    std::array<Vec3d, kSpectrumBands> values;
    detail::band_values(c_.data(), inverse(kImageToWorld) * direction, values);
    return values;
}

std::vector<Vec3f> Projection::bands_on_grid(int bands, int rows, int columns) const {
    const auto count = static_cast<std::size_t>(bands), width = static_cast<std::size_t>(columns), half = (width + 1) / 2;
    std::vector<Vec3f> out(count * static_cast<std::size_t>(rows) * width);
    std::vector<SinCos> around(count * half);  // [m][column]
    for (std::size_t m = 0; m < count; ++m)
        for (std::size_t x = 0; x < half; ++x)
            around[m * half + x] = sin_cos(2.0 * kPi * static_cast<double>(m) * (static_cast<double>(x) + 0.5) / columns);
    std::array<detail::LegendreRow, kBands> p;
    // Columns mirror at phi = 0, where sines change their sign, and rows at the equator, where odd l - m do. So a quarter of the grid is
    // summed: sums[cosine or sine][even or odd l - m].
    std::vector<Vec3d> sums[2][2];
    for (auto& of_sign : sums)
        for (std::vector<Vec3d>& sum : of_sign) sum.resize(half);
    for (int row = 0; row < (rows + 1) / 2; ++row) {
        const SinCos theta = sin_cos(kPi * (row + 0.5) / rows);
        detail::legendre(theta.cos, theta.sin, p);
        for (std::size_t l = 0; l < count; ++l) {
            for (auto& of_sign : sums)
                for (std::vector<Vec3d>& sum : of_sign) std::fill(sum.begin(), sum.end(), Vec3d{});
            std::fill(sums[0][l % 2].begin(), sums[0][l % 2].end(), c_[l * l + l] * p[0].p[l]);
            for (std::size_t m = 1; m <= l; ++m) {
                const Vec3d c = c_[l * l + l + m] * p[m].p[l - m], s = c_[l * l + l - m] * p[m].p[l - m];
                Vec3d *const cosines = sums[0][(l - m) % 2].data(), *const sines = sums[1][(l - m) % 2].data();
                for (std::size_t x = 0; x < half; ++x) {
                    cosines[x] = cosines[x] + c * around[m * half + x].cos;
                    sines[x] = sines[x] + s * around[m * half + x].sin;
                }
            }
            const auto write = [&](int at_row, std::size_t at_column, Vec3d value) {
                out[(static_cast<std::size_t>(at_row) * width + at_column) * count + l] = {
                    static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
            };
            for (std::size_t x = 0; x < half; ++x) {
                const Vec3d upper_cos = sums[0][0][x] + sums[0][1][x], upper_sin = sums[1][0][x] + sums[1][1][x];
                const Vec3d lower_cos = sums[0][0][x] - sums[0][1][x], lower_sin = sums[1][0][x] - sums[1][1][x];
                write(row, x, upper_cos + upper_sin);
                write(row, width - 1 - x, upper_cos - upper_sin);
                write(rows - 1 - row, x, lower_cos + lower_sin);
                write(rows - 1 - row, width - 1 - x, lower_cos - lower_sin);
            }
        }
    }
    return out;
}

std::vector<Vec3f> Projection::weighted_on_globe(const std::array<double, kSpectrumBands>& factors, int n) const {
    // Columns mirror at phi = 0, where sines change their sign, and rows at the equator, where odd l - m do. So a quarter of the globe is
    // summed, the bands first.
    const auto rows = static_cast<std::size_t>(n), width = 2 * rows + 1, half = rows + 1, count = std::size_t{kSpectrumBands};
    std::vector<Vec3f> out((rows + 1) * width);
    std::vector<SinCos> around(count * half);  // [m][column]
    for (std::size_t m = 0; m < count; ++m)
        for (std::size_t x = 0; x < half; ++x)  // the first column is phi = -pi
            around[m * half + x] = sin_cos(kPi * (static_cast<double>(m * x) / n - static_cast<double>(m)));
    std::array<detail::LegendreRow, kBands> p;
    std::vector<Vec3d> sums[2][2];  // [cosine or sine][even or odd l - m]
    for (std::size_t row = 0; row <= rows / 2; ++row) {
        check_time();
        const SinCos theta = sin_cos(kPi * static_cast<double>(row) / n);
        detail::legendre(theta.cos, row == 0 ? 0.0 : theta.sin, p);
        for (auto& of_sign : sums)
            for (std::vector<Vec3d>& sum : of_sign) sum.assign(half, Vec3d{});
        for (std::size_t m = 0; m < count; ++m) {
            Vec3d cosine[2]{}, sine[2]{};
            for (std::size_t l = m; l < count; ++l) {
                const double weight = factors[l] * p[m].p[l - m];
                cosine[(l - m) % 2] = cosine[(l - m) % 2] + c_[l * l + l + m] * weight;
                if (m > 0) sine[(l - m) % 2] = sine[(l - m) % 2] + c_[l * l + l - m] * weight;
            }
            for (std::size_t parity = 0; parity < 2; ++parity)
                for (std::size_t x = 0; x < half; ++x) {
                    sums[0][parity][x] = sums[0][parity][x] + cosine[parity] * around[m * half + x].cos;
                    if (m > 0) sums[1][parity][x] = sums[1][parity][x] + sine[parity] * around[m * half + x].sin;
                }
        }
        const auto write = [&](std::size_t at_row, std::size_t at_column, Vec3d value) {
            out[at_row * width + at_column] = {static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
        };
        for (std::size_t x = 0; x < half; ++x) {
            const Vec3d upper_cos = sums[0][0][x] + sums[0][1][x], upper_sin = sums[1][0][x] + sums[1][1][x];
            const Vec3d lower_cos = sums[0][0][x] - sums[0][1][x], lower_sin = sums[1][0][x] - sums[1][1][x];
            write(row, x, upper_cos + upper_sin);
            write(row, width - 1 - x, upper_cos - upper_sin);
            write(rows - row, x, lower_cos + lower_sin);
            write(rows - row, width - 1 - x, lower_cos - lower_sin);
        }
    }
    return out;
}

}  // namespace halflit::sh
