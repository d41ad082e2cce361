// Projection of environments. An equirectangular image is treated as patches of constant radiance, one per pixel, and integrated exactly:
// along a row by the closed form over each pixel's width, from pole to pole by Gauss quadrature within each row. Besides the coefficients
// that shading uses, the norms of 64 bands are kept, because they bound the error of every lobe at every order (sh/order.hpp).
#pragma once

#include "sh/coefficients.hpp"
#include "sh/equirect.hpp"
#include "sh/quadrature.hpp"
#include "sh/zonal.hpp"

#include <vector>

namespace halflit::sh {

/// Norms of an environment's bands, channel by channel. L is the radiance, L_lm its coefficients.
struct Spectrum {
    std::array<Vec3d, kSpectrumBands> norm{};  ///< |L_l| = sqrt of the sum over m of L_lm^2
    Vec3d tail_norm;                           ///< the same over all bands from kSpectrumBands on
    Vec3d absolute;                            ///< the integral of |L| over the sphere
};

class Projection {
public:
    /// The projection of a black environment.
    Projection() = default;
    explicit Projection(const EquirectView& image);

    /// Adds `factor`, 1 or -1, times the rows [first_row, end_row) of an image; all images added have the same size. To replace rows, add
    /// the old ones with -1 and the new ones with 1.
    void add_rows(const EquirectView& image, int first_row, int end_row, double factor);

    /// The first `bands` bands, 1..10.
    [[nodiscard]] RadianceSh radiance(int bands = kMaxBands) const;
    [[nodiscard]] Spectrum spectrum() const;
    /// Mean radiance over the sphere.
    [[nodiscard]] Vec3d mean() const;
    /// The integral of L^2 over the sphere.
    [[nodiscard]] Vec3d squares() const { return squares_; }
    /// Value of each band in a direction.
    [[nodiscard]] std::array<Vec3d, kSpectrumBands> bands_at(Vec3d direction) const;
    /// Values of the first `bands` bands at the cell centres of a grid of latitudes and longitudes: [row][column][band].
    [[nodiscard]] std::vector<Vec3f> bands_on_grid(int bands, int rows, int columns) const;
    /// The sum of all bands, each times its factor, in the directions with the polar angles pi j / n, j = 0 .. n, and the longitudes pi i /
    /// n, i = 0 .. 2 n, of equirect_direction: [j][i].
    [[nodiscard]] std::vector<Vec3f> weighted_on_globe(const std::array<double, kSpectrumBands>& factors, int n) const;

private:
    // Coefficients in the image's own frame, with polar axis y. radiance() rotates the bands asked for into the world's frame; norms are
    // the same in both.
    std::vector<Vec3d> c_ = std::vector<Vec3d>(static_cast<std::size_t>(kSpectrumBands * kSpectrumBands));
    Vec3d squares_, absolute_;
};

}  // namespace halflit::sh
