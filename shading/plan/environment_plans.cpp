#include "shading/plan/environment_plans.hpp"

#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "sh/zonal.hpp"

#include <algorithm>
#include <array>

namespace halflit::shading {
namespace {

/// The polynomial in z that belongs to the real (part = +1) or imaginary (-1) part of (x + iy)^m, in Newton form about kNodes: divided
/// differences of its values there.
std::array<double, sh::kMaxBands> newton_form_about_nodes(const float* coefficients, int bands, int m, int part) {
    const sh::detail::BasisTable& table = sh::detail::kBasisTable;
    std::array<double, sh::kMaxBands> a{};
    const int degree = bands - 1 - m;
    for (int j = 0; j <= degree; ++j) {
        double before = 0.0, q = table.diagonal[m];
        for (int l = m; l < bands; ++l) {
            a[j] += static_cast<double>(coefficients[sh::coefficient_index(l, part * m)]) * q;
            if (l + 1 == bands) break;
            const double next = (static_cast<double>(kNodes[j]) * q) * table.up[l + 1][m] - before * table.back[l + 1][m];
            before = q;
            q = next;
        }
    }
    for (int k = 1; k <= degree; ++k)
        for (int j = degree; j >= k; --j) a[j] = (a[j] - a[j - 1]) / (static_cast<double>(kNodes[j]) - static_cast<double>(kNodes[j - k]));
    return a;
}

using Channels = std::array<double, 3>;
Channels channels_of(Vec3d v) { return {v.x, v.y, v.z}; }

/// An environment's light through a lobe, with all that is known of its error.
struct LightErrors {
    sh::OrderBounds bounds;
    BandErrors errors;
    Vec3d map_error;  ///< where there is a map

    /// Codes by which an error of light shows: as absolute, most on a surface that is dark otherwise; or, where the light is nowhere dark,
    /// as a share of at least `least`, whatever the surface's colour is and whatever else shines on it.
    [[nodiscard]] static double codes_of(const CodeCosts& costs, Vec3d error, Vec3d least, double exposure) {
        const Channels e = channels_of(error), low = channels_of(least);
        double absolute = 0.0, relative = 0.0;  // for the worst channel: a tone curve mixes channels
        for (std::size_t c = 0; c < 3; ++c) {
            absolute = std::max(absolute, costs.absolute(e[c] * exposure));
            relative = std::max(relative, e[c] < low[c] ? costs.relative(e[c] / (low[c] - e[c])) : e[c] > 0.0 ? 255.0 : 0.0);
        }
        return std::min(absolute, relative);
    }
    /// Codes between the light of so many bands and all light.
    [[nodiscard]] double error_codes(int bands, double exposure) const {
        const Vec3d rest = bounds.by_order[sh::kMaxBands - 1];
        return codes_of(CodeCosts{}, bounds.by_order[static_cast<std::size_t>(bands - 1)], errors.least - rest, exposure);
    }
    /// Codes between the light of so many bands and the map's, or that of `exact` bands.
    [[nodiscard]] double codes_beside(int bands, int exact, const EnvironmentOrder& order) const {
        const auto n = static_cast<std::size_t>(bands - 1);
        if (exact == 0)
            return codes_of(order.costs, bounds.by_order[n] + map_error, errors.least - bounds.by_order[sh::kMaxBands - 1], order.exposure);
        if (bands >= exact) return 0.0;
        const auto last = static_cast<std::size_t>(exact - 1);
        const double share = errors.relative[n] + errors.relative[last], kept = 1.0 - share;
        return std::min(order.costs.absolute(sh::largest(errors.absolute[n] + errors.absolute[last]) * order.exposure),
                        kept > 0.0 ? order.costs.relative(share / kept) : 255.0);
    }
};

/// Bound on the error of drawing suns as directional lights, worst channel, for the lobe f of x = N.L.
///
/// Let y be N.d for a piece of the sun, y0 = N.D, q the mean of |d - D|^2, m the length of the mean of d - D. f lies in [0, scale], and its
/// slope in [0, S], n >= 1. f - S/2 x has slopes within S/2, and means of x are off by m, so f's mean is off by S/2 (sqrt(q) + m) at most.
/// And f(y) - f(y0) - f'(y0) (y - y0) is within scale |y - y0|^n / (1 + w)^n for n <= 2, whose mean is at most the power n / 2 of q's
/// (Jensen), and within n (n - 1) / 2 scale (y - y0)^2 / (1 + w)^2 from n = 2 on. So f's mean is also off by no more than that plus S m.
/// For n < 1, |f(y) - f(y0)| <= scale |y - y0|^n / (1 + w)^n. A split shadow draws b f - (b - a) core, 0 <= a <= b <= 1, so the core's
/// error, by its own slope, is added.
double sun_bound(const Environment& environment, const sh::WrapLobe& lobe, bool split) {
    const double n = lobe.power, width = 1.0 + lobe.wrap, slope = n / width * lobe.scale;
    const auto half_slope = [](double s, double square, double drift) { return 0.5 * s * (__builtin_sqrt(square) + drift); };
    const auto error = [&](double square, double drift) {
        const double bend = square > 0.0 ? lobe.scale * power_of(square / (width * width), 0.5 * std::min(n, 2.0)) : 0.0;
        double of_lobe =
            n < 1.0 ? bend : std::min(half_slope(slope, square, drift), bend * std::max(1.0, 0.5 * n * (n - 1.0)) + slope * drift);
        if (split) of_lobe += half_slope(n > width ? std::max(slope, lobe.scale) : lobe.scale, square, drift);
        return std::min(of_lobe, lobe.scale);
    };
    Vec3d sum{};
    for (std::size_t i = 0; i < environment.suns.size(); ++i) {
        const SunShape& sun = environment.sun_shapes[i];
        const Vec3d drawn = to_double(environment.suns[i].color_linear);
        const auto channel = [&](double light, double square, double drift, double drawn_light) {
            return light * error(square, drift) + lobe.scale * absolute(light - drawn_light);
        };
        sum = sum + Vec3d{channel(sun.light.x, sun.mean_square.x, sun.drift.x, drawn.x),
                          channel(sun.light.y, sun.mean_square.y, sun.drift.y, drawn.y),
                          channel(sun.light.z, sun.mean_square.z, sun.drift.z, drawn.z)};
    }
    return sh::largest(sum);
}

}  // namespace

void make_newton_form(EnvironmentPlan& plan) {
    float* next = plan.newton;
    for (int m = 0; m < plan.bands; ++m) {
        std::array<double, sh::kMaxBands> a[2][3];
        const int parts = m > 0 ? 2 : 1;
        for (int part = 0; part < parts; ++part)
            for (int channel = 0; channel < 3; ++channel)
                a[part][channel] = newton_form_about_nodes(channel == 0   ? plan.red
                                                           : channel == 1 ? plan.green
                                                                          : plan.blue,
                                                           plan.bands, m, 1 - 2 * part);
        for (int k = plan.bands - 1 - m; k >= 0; --k)
            for (int part = 0; part < parts; ++part)
                for (int channel = 0; channel < 3; ++channel) *next++ = static_cast<float>(a[part][channel][static_cast<std::size_t>(k)]);
    }
}

EnvironmentPlan plan_environment(const Environment& environment, const sh::WrapLobe& lobe, const EnvironmentOrder& order) {
    LightErrors light;
    if (environment.light != nullptr) light.bounds = environment.light->order_bounds(lobe);
    EnvironmentPlan plan;
    if (order.fixed > 0) {
        plan.bands = std::min(order.fixed, sh::kMaxBands);
    } else {
        light.errors = environment.light != nullptr ? environment.light->band_errors(lobe) : band_errors(environment.radiance, lobe);
        // The error is small in linear light, and in codes on a dark surface. Where ten bands are not enough, a map is taken.
        plan.bands = sh::pick_order(light.bounds, order.tolerance, 1.0 / order.exposure).order;
        const auto enough = [&] { return light.error_codes(plan.bands, order.exposure) <= 255.0 * order.tolerance; };
        while (plan.bands < sh::kMaxBands && !enough()) ++plan.bands;
        if (environment.light != nullptr && !enough()) {
            plan.bands = 0;
            plan.kept_map = environment.light->irradiance(lobe);
            light.map_error = plan.kept_map->error + light.bounds.beyond;
        }
        for (int bands = 1, exact = plan.bands; order.codes > 0.0 && bands <= sh::kMaxBands && bands != exact; ++bands) {
            const double codes = light.codes_beside(bands, exact, order);
            if (codes > order.codes) continue;
            plan.bands = bands, plan.bound_codes = codes;
            plan.kept_map.reset();
            break;
        }
    }
    if (plan.bands == 0) {
        plan.map = plan.kept_map->rgba.data()->data();
        plan.map_rows = static_cast<float>(plan.kept_map->rows);
        plan.map_turned = turned_share(environment.rotate_rad);
    }
    plan.bound = sh::largest(plan.bands == 0 ? light.map_error : light.bounds.by_order[static_cast<std::size_t>(plan.bands - 1)]);
    plan.bound += sun_bound(environment, lobe, order.split_shadows);
    plan.within = plan.bound * order.exposure <= order.tolerance;
    const sh::PreconvolvedSh product = sh::convolve(environment.radiance, sh::zonal_bands(lobe), std::max(plan.bands, 1));
    // Y_0 is 1 / (2 sqrt(pi)), so the integral of the radiance over pi is its first coefficient times 2 / sqrt(pi).
    const double middle = lobe.wrap > 0.0 ? lobe.scale * power_of(lobe.wrap / (1.0 + lobe.wrap), lobe.power) : 0.0;
    const Vec3d flat = environment.radiance.c[0] * (1.1283791670955126 * middle);
    plan.at_zero_normal[0] = static_cast<float>(flat.x), plan.at_zero_normal[1] = static_cast<float>(flat.y);
    plan.at_zero_normal[2] = static_cast<float>(flat.z);
    std::copy(product.r.begin(), product.r.end(), plan.red);
    std::copy(product.g.begin(), product.g.end(), plan.green);
    std::copy(product.b.begin(), product.b.end(), plan.blue);
    make_newton_form(plan);
    return plan;
}

void EnvironmentPlans::use(std::shared_ptr<const Environment> environment) {
    ++frame_;
    if (!environment_.replace(std::move(environment))) return;
    entries_.clear();
}

ReflectionPlan EnvironmentPlans::reflections(const ForEachRow& for_each_row) {
    const Environment& environment = *environment_;
    return {environment.light->reflections(for_each_row), environment.light, environment.rotate_rad};
}

EnvironmentPlan EnvironmentPlans::plan(const sh::WrapLobe& lobe, const EnvironmentOrder& order) {
    constexpr std::size_t kMostEntries = 256;  // from here on only those of this frame and the last one are kept
    for (Entry& entry : entries_)
        if (entry.lobe == lobe && entry.order == order) {
            entry.last_frame = frame_;
            return entry.plan;
        }
    if (entries_.size() >= kMostEntries) std::erase_if(entries_, [&](const Entry& e) { return e.last_frame + 1 < frame_; });
    return entries_.emplace_back(Entry{lobe, order, plan_environment(*environment_, lobe, order), frame_}).plan;
}

}  // namespace halflit::shading
