// Checks of the bounds on a series' error against brute force over an image.
#pragma once

#include "sh/order.hpp"
#include "tests/sh/sky_images.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

namespace halflit::test {

using namespace halflit::sh;

inline const WrapLobe kTenLobes[] = {{0.0, 1.0, 1.0}, {0.25, 1.0, 1.0},  {0.5, 1.0, normalizing_scale(0.5, 1.0)}, {1.0, 1.0, 1.0},
                                     {1.0, 2.0, 1.0}, {0.25, 1.25, 1.0}, {0.5, 1.5, normalizing_scale(0.5, 1.5)}, {0.9, 1.9, 1.0},
                                     {0.0, 2.0, 1.0}, {0.5, 4.0, 1.0}};

/// Largest error of each order over all normals and channels.
inline std::array<double, kMaxBands> true_errors(const RadianceSh& radiance, const std::vector<LightSample>& samples, const WrapLobe& lobe,
                                                 const std::vector<Vec3d>& normals) {
    const RadianceSh product = scaled_by_band(radiance, zonal_bands(lobe));
    std::array<double, kMaxBands> worst{};
    for (const Vec3d& n : normals) {
        const Vec3d exact = reflected(samples, lobe, n);
        double y[kMaxCoefficients];
        evaluate_basis<kMaxBands>(n, y);
        Vec3d sum{};
        for (int l = 0; l < kMaxBands; ++l) {
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum = sum + product.c[static_cast<std::size_t>(i)] * y[i];
            double& at = worst[static_cast<std::size_t>(l)];
            at = std::max(at, largest_difference(sum, exact));
        }
    }
    return worst;
}

/// Number of orders chosen, and of those that are more than two above the least order that keeps the tolerance.
struct Choices {
    int made = 0;
    int more_than_two_above = 0;
};

/// Checks that the bounds hold, that they are at most 5 times the true error (those from norms: 10 times), and that the orders chosen by
/// them keep the tolerance. `noise` is the error of the brute force itself, as a fraction of the mean.
inline void check_bounds(const Sky& sky, const std::vector<Vec3d>& normals, double noise, Choices& choices) {
    const Projection projection(sky.view());
    const RadianceSh radiance = projection.radiance();
    const BandGrid grid(projection);
    const auto samples = light_samples(sky.view());
    const double mean = largest(projection.mean());
    for (const WrapLobe& lobe : kTenLobes) {
        const auto errors = true_errors(radiance, samples, lobe, normals);
        const LobeSpectrum spectrum = lobe_spectrum(lobe);
        const OrderBounds bounds = grid.order_bounds(spectrum), by_norms = order_bounds(projection.spectrum(), spectrum);
        for (std::size_t i = 0; i < kMaxBands; ++i) {
            const double bound = largest(bounds.by_order[i]);
            INFO("w " << lobe.wrap << " n " << lobe.power << " order " << i + 1 << " error " << errors[i] << " bound " << bound
                      << " by norms " << largest(by_norms.by_order[i]));
            CHECK(errors[i] <= bound + noise * mean);
            CHECK(bound <= largest(by_norms.by_order[i]));
            if (bound > 20 * noise * mean) CHECK(largest(by_norms.by_order[i]) <= 10 * errors[i]);
            if (bound > 20 * noise * mean) CHECK(bound <= 5 * errors[i]);
        }
        for (const double tolerance : {0.3, 0.1, 0.03, 0.01, 0.004}) {
            const OrderChoice choice = pick_order(bounds, tolerance, mean);
            if (!choice.within) continue;
            int least = kMaxBands;
            for (int order = kMaxBands; order >= 1 && errors[static_cast<std::size_t>(order - 1)] <= tolerance * mean; --order)
                least = order;
            INFO("w " << lobe.wrap << " n " << lobe.power << " tolerance " << tolerance << " chosen " << choice.order << " least "
                      << least);
            CHECK(errors[static_cast<std::size_t>(choice.order - 1)] <= (tolerance + noise) * mean);
            ++choices.made;
            choices.more_than_two_above += choice.order > least + 2 ? 1 : 0;
        }
    }
}

}  // namespace halflit::test
