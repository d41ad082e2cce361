// Bound by which an environment's order is chosen, against brute force over the shared pictures at full size: 1,000 normals, ten lobes,
// orders 1 to 10. The figures are in sh/README.md; run with -s to see them.
#include "halflit/image.hpp"
#include "sh/sun.hpp"
#include "shading/environment.hpp"
#include "tests/sh/full_size.hpp"
#include "tests/support/all_cores.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <sstream>
#include <string>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

/// Limit on the error of the brute force, as a fraction of the mean: twice as many points where lobes end change it by at most 2e-9.
constexpr double kNoise = 1e-8;
/// Errors below this fraction of the mean are not compared with bounds. Those are half-Lambert's from order 2 on and its square's from
/// order 3 on, which are 0 as their bounds are; measured 1e-11. The others are above 5e-6.
constexpr double kFloor = 1e-7;

using Reflected = std::vector<std::array<Vec3d, FullSizeImage::kLobes>>;

Reflected by_brute_force(const FullSizeImage& image, const std::vector<Vec3d>& normals) {
    Reflected out(normals.size());
    on_all_cores(static_cast<std::int64_t>(normals.size()),
                 [&](std::int64_t i) { out[static_cast<std::size_t>(i)] = image.reflected(normals[static_cast<std::size_t>(i)]); });
    return out;
}

struct Extreme {
    double value = 0;
    std::string where;
    void take(double v, const std::string& at) {
        if (v > value) value = v, where = at;
    }
};

struct Figures {
    Extreme error_of_bound, bound_of_error;  ///< the first wherever the bound is not 0, the second above the floor
    Extreme with_sun;                        ///< error of series and suns together, divided by the sum of their bounds
    int picks = 0;
    int above[kMaxBands]{};  ///< above[i]: picks that are i orders above the least that keeps the tolerance
    int most_above = 0;

    [[nodiscard]] std::string text() const {
        std::ostringstream s;
        s << "error at most " << error_of_bound.value << " of the bound (" << error_of_bound.where << "), bound at most "
          << bound_of_error.value << " times the error (" << bound_of_error.where << "), with suns " << with_sun.value << " of the bound ("
          << with_sun.where << "); " << picks << " picks, above the least by";
        for (const int count : above) s << ' ' << count;
        return s.str();
    }
};

/// Largest error of each order: the series of `projection` plus `suns`, against `exact`.
std::array<double, kMaxBands> errors_of(const Projection& projection, const std::vector<Sun>& suns, std::size_t lobe,
                                        const Reflected& exact, const std::vector<Vec3d>& normals) {
    const RadianceSh product = scaled_by_band(projection.radiance(), zonal_bands(kTenLobes[lobe]));
    std::array<double, kMaxBands> worst{};
    for (std::size_t i = 0; i < normals.size(); ++i) {
        double y[kMaxCoefficients];
        evaluate_basis<kMaxBands>(normals[i], y);
        Vec3d sum{};
        for (const Sun& sun : suns) sum = sum + sun.irradiance * (lobe_value(kTenLobes[lobe], dot(normals[i], sun.direction)) / kPi);
        for (int l = 0; l < kMaxBands; ++l) {
            for (int k = l * l; k < (l + 1) * (l + 1); ++k) sum = sum + product.c[static_cast<std::size_t>(k)] * y[k];
            double& at = worst[static_cast<std::size_t>(l)];
            at = std::max(at, largest_difference(sum, exact[i][lobe]));
        }
    }
    return worst;
}

void check_orders(const std::string& name, const Projection& projection, const Reflected& exact, const std::vector<Vec3d>& normals,
                  Figures& figures) {
    const BandGrid grid(projection);
    const double mean = largest(projection.mean());
    for (std::size_t i = 0; i < FullSizeImage::kLobes; ++i) {
        const WrapLobe& lobe = kTenLobes[i];
        const auto errors = errors_of(projection, {}, i, exact, normals);
        const OrderBounds bounds = grid.order_bounds(lobe_spectrum(lobe));
        for (std::size_t n = 0; n < kMaxBands; ++n) {
            const double bound = largest(bounds.by_order[n]);
            std::ostringstream where;
            where << name << ", w " << lobe.wrap << " n " << lobe.power << " order " << n + 1;
            INFO(where.str() << ": error " << errors[n] << ", bound " << bound << ", mean " << mean);
            CHECK(errors[n] <= bound + kNoise * mean);
            if (bound > 0) figures.error_of_bound.take(errors[n] / bound, where.str());
            if (errors[n] <= kFloor * mean) {
                CHECK(bound == 0.0);
                continue;
            }
            CHECK(bound <= 10 * errors[n]);
            figures.bound_of_error.take(bound / errors[n], where.str());
        }
        for (const double tolerance : {0.3 * mean, 0.1 * mean, 0.03 * mean, 0.01 * mean, 0.003 * mean, 0.001 * mean, 1.0 / 510}) {
            const OrderChoice choice = pick_order(bounds, tolerance);
            int least = 1;
            while (least <= kMaxBands && errors[static_cast<std::size_t>(least - 1)] > tolerance) ++least;
            if (choice.within) CHECK(errors[static_cast<std::size_t>(choice.order - 1)] <= tolerance + kNoise * mean);
            if (least > kMaxBands) continue;
            ++figures.picks;
            ++figures.above[std::max(0, choice.order - least)];
            figures.most_above = std::max(figures.most_above, choice.order - least);
        }
    }
}

}  // namespace

TEST_CASE("environment: at full size no error is above its bound, and no bound ten times the error", "[io][environment][deep]") {
    if (!asset_dir() || !std::filesystem::is_directory(*asset_dir() / "environments")) HALFLIT_SKIP("no environments among the assets");
    const auto normals = random_normals(1000, 81);
    Figures as_is, without_suns;
    double noise = 0;
    for (const std::string name : {"kiara_1_dawn_1k.hdr", "studio_small_03_1k.hdr", "spiaggia_di_mondello_1k.hdr"}) {
        const auto picture = read_environment((*asset_dir() / "environments" / name).string());
        REQUIRE(picture);
        const Projection whole(shading::view_of(*picture));
        const Reflected exact = by_brute_force(FullSizeImage(shading::view_of(*picture)), normals);
        check_orders(name, whole, exact, normals, as_is);
        const FullSizeImage finer(shading::view_of(*picture), 2);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto again = finer.reflected(normals[i]);
            for (std::size_t k = 0; k < FullSizeImage::kLobes; ++k)
                noise = std::max(noise, largest_difference(again[k], exact[i][k]) / largest(whole.mean()));
        }
        const SunExtraction parts = extract_suns(shading::view_of(*picture), whole);
        if (parts.suns.empty()) {
            check_orders(name, whole, exact, normals, without_suns);
            continue;
        }
        const EquirectView rest{picture->width, picture->height, parts.residual_rgb};
        check_orders(name + " without its suns", parts.residual, by_brute_force(FullSizeImage(rest), normals), normals, without_suns);
        const BandGrid grid(parts.residual);
        for (std::size_t k = 0; k < FullSizeImage::kLobes; ++k) {
            const auto errors = errors_of(parts.residual, parts.suns, k, exact, normals);
            const LobeSpectrum spectrum = lobe_spectrum(kTenLobes[k]);
            const OrderBounds bounds = grid.order_bounds(spectrum);
            for (std::size_t n = 0; n < kMaxBands; ++n) {
                const double bound = largest(bounds.by_order[n] + sun_bound(parts.suns, spectrum));
                INFO(name << ", w " << kTenLobes[k].wrap << " n " << kTenLobes[k].power << " order " << n + 1);
                CHECK(errors[n] <= bound);
                without_suns.with_sun.take(errors[n] / bound, name);
            }
        }
    }
    INFO("noise " << noise << " of the mean; suns left in: " << as_is.text() << "; suns taken out: " << without_suns.text());
    CHECK(noise < kNoise);
    CHECK(without_suns.picks > 100);
    CHECK(without_suns.most_above <= 2);
}
