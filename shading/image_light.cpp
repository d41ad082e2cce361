#include "shading/image_light.hpp"

#include "sh/basis.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "sh/zonal.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::shading {
namespace {

constexpr double kAnyShare = 1e6;  // a relative error that costs 255 codes

/// Of light whose numbers overflow.
BandErrors no_bound() {
    BandErrors out;
    for (std::size_t n = 0; n + 1 < sh::kMaxBands; ++n) out.absolute[n] = {1e300, 1e300, 1e300}, out.relative[n] = kAnyShare;
    out.least = {-1e300, -1e300, -1e300};
    return out;
}

double& channel_of(Vec3d& v, int channel) { return channel == 0 ? v.x : channel == 1 ? v.y : v.z; }

}  // namespace

BandErrors band_errors(const sh::RadianceSh& radiance, const sh::WrapLobe& lobe) {
    constexpr int kRows = 64, kColumns = 128;
    constexpr std::size_t kBands = sh::kMaxBands;
    // A sum of bands has degree 9, and lies within half its range of its middle, so its second derivative along a great circle is at most
    // 81 times half the range (Bernstein). Every direction is within 0.035 rad of a grid point. So minimum and maximum are beyond the
    // grid's by at most 0.0249 of the range, and the range is at most 1 / (1 - 0.0498) times the grid's.
    constexpr double kBetweenPoints = 0.0263;
    const sh::PreconvolvedSh light = sh::convolve(radiance, sh::zonal_bands(lobe), sh::kMaxBands);
    const float* const channels[3] = {light.r.data(), light.g.data(), light.b.data()};
    BandErrors out;
    // from[channel][point][l]: sum of the bands from l on; from l = 0 it is the light.
    using FromBand = std::array<double, kBands>;
    std::vector<FromBand> from_of[3];
    FromBand least_of[3], most_of[3];
    for (int channel = 0; channel < 3; ++channel) least_of[channel].fill(1e300), most_of[channel].fill(-1e300);
    for (int row = 0; row < kRows; ++row) {
        const SinCos polar = sin_cos(kPi * (row + 0.5) / kRows);
        for (int column = 0; column < kColumns; ++column) {
            const SinCos around = sin_cos(2.0 * kPi * column / kColumns);
            double y[sh::kMaxCoefficients];
            sh::evaluate_basis<sh::kMaxBands>(Vec3d{polar.sin * around.cos, polar.sin * around.sin, polar.cos}, y);
            for (int channel = 0; channel < 3; ++channel) {
                FromBand& at = from_of[channel].emplace_back();
                double sum = 0.0;
                for (std::size_t l = kBands; l-- > 0;) {
                    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) sum += static_cast<double>(channels[channel][i]) * y[i];
                    at[l] = sum;
                    least_of[channel][l] = std::min(least_of[channel][l], sum), most_of[channel][l] = std::max(most_of[channel][l], sum);
                }
            }
        }
    }
    for (int channel = 0; channel < 3; ++channel) {
        double size = 0.0;  // the most that the sum's terms add up to, by the addition theorem
        for (std::size_t l = 0; l < kBands; ++l) {
            double squares = 0.0;
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                squares += static_cast<double>(channels[channel][i]) * channels[channel][i];
            size += std::sqrt(squares * static_cast<double>(2 * l + 1) / (4.0 * kPi));
        }
        if (!(size < 1e300)) return no_bound();
        const std::vector<FromBand>& from = from_of[channel];
        const FromBand &least = least_of[channel], &most = most_of[channel];
        const auto margin = [&](std::size_t l) { return kBetweenPoints * (most[l] - least[l]); };
        const double rounding = 2.0 * 3e-7 * size;
        channel_of(out.least, channel) = least[0] - margin(0);
        for (std::size_t n = 1; n <= kBands; ++n) {
            double absolute = 0.0, relative = 0.0;
            if (n < kBands) {
                absolute = std::max(most[n], -least[n]) + margin(n) + rounding;
                // |error| - r light has the bound of a sum of bands, too, so that r is enough if it is at each grid point, with both
                // margins.
                for (const auto& at : from) {
                    const double floor = at[0] - margin(0);
                    relative = std::max(relative, floor > 0.0 ? (std::fabs(at[n]) + margin(n) + rounding) / floor : kAnyShare);
                }
            }
            channel_of(out.absolute[n - 1], channel) = absolute;
            out.relative[n - 1] = std::min(kAnyShare, channel == 0 ? relative : std::max(out.relative[n - 1], relative));
        }
    }
    return out;
}

ImageLight::ImageLight(int width, int height, std::vector<float> rgb, const sh::Projection& projection)
    : width_(width), height_(height), rgb_(std::move(rgb)), radiance_(projection.radiance()), projection_(projection) {}

ImageLight::ImageLight(ImageLightParts parts)
    : width_(parts.width),
      height_(parts.height),
      rgb_(std::move(parts.rgb)),
      radiance_(parts.radiance),
      lobes_(std::move(parts.lobes)),
      reflections_(std::make_shared<const ReflectionMap>(std::move(parts.reflections))) {}

LobeLight& ImageLight::known(const sh::WrapLobe& lobe) const {
    constexpr std::size_t kMostLobes = 64;  // a host may go through any number of them
    const auto found = std::find_if(lobes_.begin(), lobes_.end(), [&](const LobeLight& one) { return one.lobe == lobe; });
    if (found != lobes_.end()) return *found;
    if (lobes_.size() < kMostLobes) return lobes_.emplace_back(LobeLight{lobe, {}, {}, {}});
    return other_ = {lobe, {}, {}, {}};
}

const sh::Projection& ImageLight::projection() const {
    if (!projection_) projection_.emplace(image());
    return *projection_;
}

std::shared_ptr<const IrradianceMap> ImageLight::irradiance(const sh::WrapLobe& lobe) const {
    const auto kept = [&] {
        const std::scoped_lock lock(mutex_);
        (void)projection();
        return known(lobe).map.lock();
    };
    if (auto map = kept()) return map;
    // Made without the lock, as reflections are. The projection does not change any more.
    constexpr double kStepShare = 5e-4;  // of the mean light: a twentieth of a code
    const double mean = sh::lobe_spectrum(lobe).f[0] * sh::largest(projection_->mean());
    auto made = std::make_shared<const IrradianceMap>(make_irradiance_map(*projection_, lobe, kStepShare * mean));
    const std::scoped_lock lock(mutex_);
    LobeLight& light = known(lobe);
    if (auto map = light.map.lock()) return map;
    light.map = made;
    return made;
}

sh::OrderBounds ImageLight::order_bounds(const sh::WrapLobe& lobe) const {
    const std::scoped_lock lock(mutex_);
    LobeLight& light = known(lobe);
    if (!light.bounds) {
        if (!grid_) grid_.emplace(projection());
        light.bounds = grid_->order_bounds(sh::lobe_spectrum(lobe));
    }
    return *light.bounds;
}

BandErrors ImageLight::band_errors(const sh::WrapLobe& lobe) const {
    const std::scoped_lock lock(mutex_);
    LobeLight& light = known(lobe);
    if (!light.errors) light.errors = shading::band_errors(radiance_, lobe);
    return *light.errors;
}

std::shared_ptr<const ReflectionMap> ImageLight::reflections(const ForEachRow& for_each_row) const {
    const auto known = [&] {
        const std::scoped_lock lock(mutex_);
        return reflections_;
    };
    if (auto map = known()) return map;
    // Made without the lock: for_each_row may run other work on this thread, which may ask for the same map. The first one made is kept.
    auto made = std::make_shared<const ReflectionMap>(make_reflection_map(image(), for_each_row));
    const std::scoped_lock lock(mutex_);
    if (reflections_ == nullptr) reflections_ = std::move(made);
    return reflections_;
}

}  // namespace halflit::shading
