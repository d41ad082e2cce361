// Light that surfaces reflect under an environment image of full size, by brute force in double; fast enough for a thousand normals and ten
// lobes.
//
// For one normal N, every lobe sees the image through x = N.d alone, where d is the direction of the light. So each normal sorts the light
// into narrow bins of x once, with its first and second moments about the bin's middle. A lobe is then a table of its value and derivatives
// in the middles of the bins; every lobe ends at the edge of a bin. A pixel is a patch of constant radiance, integrated by 2 x 2 Gauss
// points. Where a lobe ends within the pixel, it takes 16 x 16 points, or 64 x 64 if the pixel holds more than 1e-4 of the light.
#pragma once

#include "tests/sh/bound_check.hpp"

#include <cstdint>

namespace halflit::test {

class FullSizeImage {
public:
    static constexpr std::size_t kLobes = std::size(kTenLobes);

    /// `finer`: factor on the number of points along each side of a pixel where a lobe ends. The change that it makes is the error of the
    /// brute force.
    explicit FullSizeImage(const EquirectView& image, int finer = 1)
        : image_(image),
          coarse_(gauss_legendre(2)),
          fine_(gauss_legendre(16 * finer)),
          finest_(gauss_legendre(64 * finer)),
          table_(kLobes * kBins) {
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) total_ += luminance(image.at(x, y)) * pixel_solid_angle(image.width, image.height, y);
        for (std::size_t i = 0; i < kLobes; ++i)
            for (std::size_t b = 0; b < kBins; ++b) table_[i * kBins + b] = derivatives(kTenLobes[i], middle(b));
    }

    /// (1/pi) times the integral over directions d of L(d) f(N.d), for each of the ten lobes. L: radiance, f: lobe.
    [[nodiscard]] std::array<Vec3d, kLobes> reflected(Vec3d normal) const {
        std::vector<Bin> bins(kBins);
        const int columns = 2 * image_.width;
        std::vector<double> across(static_cast<std::size_t>(columns));  // horizontal part of N.d at the equator
        for (int i = 0; i < columns; ++i)
            across[static_cast<std::size_t>(i)] = level(normal, i / 2 + at(coarse_[static_cast<std::size_t>(i % 2)]));
        for (int y = 0; y < image_.height; ++y) {
            const Row middle_row(image_, normal, y + 0.5);
            const double tall = kPi / image_.height, wide = 2 * kPi / image_.width * middle_row.sine;
            const double radius = 0.5 * std::sqrt(tall * tall + wide * wide);
            const Row rows[] = {Row(image_, normal, y + at(coarse_[0])), Row(image_, normal, y + at(coarse_[1]))};
            for (int x = 0; x < image_.width; ++x) {
                const Vec3d radiance = image_.at(x, y);
                const double* const q = &across[static_cast<std::size_t>(2 * x)];
                if (lobe_ends_near(middle_row.sine * 0.5 * (q[0] + q[1]) + middle_row.height, radius)) {
                    add_finely(bins, normal, x, y, radiance);
                    continue;
                }
                for (const Row& row : rows) {
                    const Vec3d flux = radiance * (0.25 * row.solid_angle);
                    add(bins, row.sine * q[0] + row.height, flux);
                    add(bins, row.sine * q[1] + row.height, flux);
                }
            }
        }
        std::array<Vec3d, kLobes> out{};
        for (std::size_t i = 0; i < kLobes; ++i) {
            for (std::size_t b = 0; b < kBins; ++b) {
                const Vec3d& f = table_[i * kBins + b];
                out[i] = out[i] + (bins[b].flux * f.x + bins[b].first * f.y + bins[b].second * (0.5 * f.z));
            }
            out[i] = out[i] * (1.0 / kPi);
        }
        return out;
    }

private:
    static constexpr std::size_t kBins = 4000;  // bin edges lie where lobes end: 0, -1/4, -1/2, -9/10

    struct Bin {
        Vec3d flux, first, second;
    };

    /// One latitude of the image, in rows from the top.
    struct Row {
        double sine, height, solid_angle;  ///< sine of the polar angle; vertical part of N.d; of a pixel that lay wholly at this latitude
        Row(const EquirectView& image, Vec3d normal, double y)
            : sine(std::sin(kPi * y / image.height)),
              height(normal.y * std::cos(kPi * y / image.height)),
              solid_angle(kPi / image.height * (2 * kPi / image.width) * sine) {}
    };

    static double middle(std::size_t bin) { return -1 + (static_cast<double>(bin) + 0.5) * (2.0 / kBins); }
    static double at(const GaussNode& node) { return 0.5 + 0.5 * node.x; }

    /// The lobe f(x) and its first and second derivatives.
    static Vec3d derivatives(const WrapLobe& lobe, double x) {
        const double inner = 1 / (1 + lobe.wrap), t = (x + lobe.wrap) * inner, n = lobe.power;
        if (!(t > 0)) return {};
        return Vec3d{std::pow(t, n), n * inner * std::pow(t, n - 1), n * (n - 1) * inner * inner * std::pow(t, n - 2)} * lobe.scale;
    }

    static bool lobe_ends_near(double x, double radius) {
        for (const double end : {0.0, -0.25, -0.5, -0.9})
            if (std::fabs(x - end) <= radius) return true;
        return false;
    }

    /// Horizontal part of N.d at the equator; x in columns from the left.
    [[nodiscard]] double level(Vec3d normal, double x) const {
        const double phi = 2 * kPi * (x / image_.width - 0.5);
        return normal.x * std::sin(phi) - normal.z * std::cos(phi);
    }

    static void add(std::vector<Bin>& bins, double x, Vec3d flux) {
        const auto b = static_cast<std::size_t>(std::clamp((x + 1) * (0.5 * kBins), 0.0, kBins - 1.0));
        const double off = x - middle(b);
        Bin& bin = bins[b];
        bin.flux = bin.flux + flux;
        bin.first = bin.first + flux * off;
        bin.second = bin.second + flux * (off * off);
    }

    void add_finely(std::vector<Bin>& bins, Vec3d normal, int x, int y, Vec3d radiance) const {
        const double share = luminance(radiance) * pixel_solid_angle(image_.width, image_.height, y) / total_;
        const auto& rule = share > 1e-4 ? finest_ : fine_;
        std::array<double, 256> across;
        for (std::size_t i = 0; i < rule.size(); ++i) across[i] = level(normal, x + at(rule[i]));
        for (const GaussNode& v : rule) {
            const Row row(image_, normal, y + at(v));
            for (std::size_t i = 0; i < rule.size(); ++i)
                add(bins, row.sine * across[i] + row.height, radiance * (0.25 * v.weight * rule[i].weight * row.solid_angle));
        }
    }

    EquirectView image_;
    std::vector<GaussNode> coarse_, fine_, finest_;
    std::vector<Vec3d> table_;
    double total_ = 0;
};

}  // namespace halflit::test
