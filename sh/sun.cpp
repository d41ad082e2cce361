#include "sh/sun.hpp"

#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace halflit::sh {
namespace {

constexpr int kJudgedOrder = 5;
constexpr int kMaxCandidates = 8;
constexpr std::size_t kPixelsPerCheck = 4096;  ///< of a source, between two looks at the clock
/// Choice of the level that a source is cut at. Where nearly all light is the sun's, the sun's own part dominates the bound and hides the
/// part that is left in the image. So the lowest level is taken whose bound is at most kAsGood times the best. Levels go on below the mean
/// luminance where the sun makes most of it, down to kAboveRest times the mean luminance of the rest. The rest is a difference, of which
/// rounding leaves nothing below kRounded times the mean luminance: it may even come out negative.
constexpr double kAsGood = 1.01, kAboveRest = 4.0, kRounded = 0x1p-40;

struct Pixel {
    int x = 0, y = 0;
    double luminance = 0;
};

/// The image without the suns found so far, its projection, those suns, and the bound on the error of both together.
struct State {
    int width, height;
    std::vector<float> rgb;
    Projection projection;
    std::vector<Sun> suns;
    double bound = 0;

    [[nodiscard]] EquirectView view() const { return {width, height, rgb}; }
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] float* pixel(int x, int y) { return &rgb[3 * index(x, y)]; }
};

struct Judge {
    LobeSpectrum lobe = lobe_spectrum({0.0, 1.0, 1.0});

    [[nodiscard]] double bound(const Spectrum& spectrum, const std::vector<Sun>& suns) const {
        return largest(order_bounds(spectrum, lobe).by_order[kJudgedOrder - 1] + sun_bound(suns, lobe));
    }
};

Vec3d center(const State& state, const Pixel& p) { return equirect_direction((p.x + 0.5) / state.width, (p.y + 0.5) / state.height); }

/// Root mean square distance of a pixel's points from its middle.
double pixel_radius(const State& state, int y) {
    const double tall = kPi / state.height, wide = 2.0 * kPi / state.width * sin_cos(kPi * (y + 0.5) / state.height).sin;
    return __builtin_sqrt((tall * tall + wide * wide) / 12.0);
}

std::optional<Pixel> brightest(const State& state, const std::vector<bool>& seen) {
    std::optional<Pixel> best;
    for (int y = 0; y < state.height; ++y) {
        check_time();
        for (int x = 0; x < state.width; ++x) {
            if (seen[state.index(x, y)]) continue;
            const double value = luminance(state.view().at(x, y));
            if (!best || value > best->luminance) best = Pixel{x, y, value};
        }
    }
    return best;
}

/// The pixels connected to a peak that are brighter than `floor` and within the angle `max_radius` of `axis`. Marks them as seen.
std::vector<Pixel> region(const State& state, const Pixel& peak, Vec3d axis, double floor, double max_radius, std::vector<bool>& seen) {
    const double half_chord = sin_cos(0.5 * max_radius).sin, max_chord2 = 4.0 * half_chord * half_chord;
    std::vector<Pixel> found{peak};
    seen[state.index(peak.x, peak.y)] = true;
    for (std::size_t next = 0; next < found.size(); ++next) {
        if (next % kPixelsPerCheck == 0) check_time();
        const Pixel p = found[next];
        const int neighbours[4][2] = {
            {p.x > 0 ? p.x - 1 : state.width - 1, p.y}, {p.x + 1 < state.width ? p.x + 1 : 0, p.y}, {p.x, p.y - 1}, {p.x, p.y + 1}};
        for (const auto& [x, y] : neighbours) {
            if (y < 0 || y >= state.height || seen[state.index(x, y)]) continue;
            const Pixel q{x, y, luminance(state.view().at(x, y))};
            const Vec3d apart = center(state, q) - axis;
            if (!(q.luminance > floor) || dot(apart, apart) > max_chord2) continue;
            seen[state.index(x, y)] = true;
            found.push_back(q);
        }
    }
    return found;
}

/// Writes to `left` a pixel's radiance scaled to the luminance `level`; the colour stays.
void dim(const State& state, const Pixel& p, double level, float (&left)[3]) {
    const Vec3d rgb = state.view().at(p.x, p.y) * (level / p.luminance);
    left[0] = static_cast<float>(rgb.x), left[1] = static_cast<float>(rgb.y), left[2] = static_cast<float>(rgb.z);
}

struct Candidate {
    Sun sun;
    Vec3d squares_removed;                           ///< integral of L^2 before minus after
    std::array<double, kSpectrumBands> sharpness{};  ///< mean of P_l(cos angle to the direction): 1 for a point, falling with l for a disc
};

/// Gathers the light above `level` into one direction.
Candidate gather(const State& state, const std::vector<Pixel>& pixels, double level) {
    Candidate out;
    Vec3d centroid{};
    double flux = 0;
    std::size_t seen = 0;
    for (const Pixel& p : pixels) {
        if (seen++ % kPixelsPerCheck == 0) check_time();
        if (!(p.luminance > level)) continue;
        float left[3];
        dim(state, p, level, left);
        const double solid_angle = pixel_solid_angle(state.width, state.height, p.y);
        const Vec3d before = state.view().at(p.x, p.y), after{left[0], left[1], left[2]}, taken = before - after;
        out.sun.irradiance = out.sun.irradiance + taken * solid_angle;
        out.sun.solid_angle += solid_angle;
        out.squares_removed = out.squares_removed + (before * before - after * after) * solid_angle;
        centroid = centroid + center(state, p) * (luminance(taken) * solid_angle);
        flux += luminance(taken) * solid_angle;
    }
    if (!(flux > 0)) return out;
    out.sun.direction = centroid * (1.0 / length(centroid));
    double spread = 0;
    for (const Pixel& p : pixels) {
        if (seen++ % kPixelsPerCheck == 0) check_time();
        if (!(p.luminance > level)) continue;
        const Vec3d apart = center(state, p) - out.sun.direction;
        const double chord = length(apart), angle = chord + chord * chord * chord / 16.0;  // at least 2 asin(chord/2), for chords below 1
        const double share = (p.luminance - level) * pixel_solid_angle(state.width, state.height, p.y) / flux;
        spread += share * (angle + pixel_radius(state, p.y));
        const double x = 1.0 - 0.5 * chord * chord;
        double before = 0.0, here = 1.0;
        for (std::size_t l = 0; l < out.sharpness.size(); ++l) {
            out.sharpness[l] += share * here;
            const double next =
                ((2.0 * static_cast<double>(l) + 1.0) * x * here - static_cast<double>(l) * before) / (static_cast<double>(l) + 1.0);
            before = here;
            here = next;
        }
    }
    out.sun.spread_rad = spread;
    return out;
}

/// The pixels that belong to the source around a peak. The brightest pixel may lie at the source's edge, so its middle is found first.
std::vector<Pixel> source(const State& state, const Pixel& peak, double floor, double max_radius, std::vector<bool>& seen) {
    Vec3d axis = center(state, peak);
    for (int pass = 0; pass < 2; ++pass) {
        const std::vector<Pixel> pixels = region(state, peak, axis, floor, max_radius, seen);
        axis = gather(state, pixels, 0.5 * peak.luminance).sun.direction;
        for (const Pixel& p : pixels) seen[state.index(p.x, p.y)] = false;
    }
    return region(state, peak, axis, floor, max_radius, seen);
}

/// The spectrum without a candidate, which is treated as round: cheap, and good enough to choose a level.
Spectrum without(const State& state, const Candidate& candidate) {
    Spectrum out = state.projection.spectrum();
    const auto at = state.projection.bands_at(candidate.sun.direction);
    const Vec3d e = candidate.sun.irradiance;
    Vec3d known{};
    const auto root = [](double x) { return x > 0 ? __builtin_sqrt(x) : 0.0; };
    for (std::size_t l = 0; l < out.norm.size(); ++l) {
        const Vec3d part = e * candidate.sharpness[l];
        const Vec3d square =
            out.norm[l] * out.norm[l] - (part * at[l]) * 2.0 + (part * part) * (static_cast<double>(2 * l + 1) / (4.0 * kPi));
        out.norm[l] = {root(square.x), root(square.y), root(square.z)};
        known = known + out.norm[l] * out.norm[l];
    }
    const Vec3d rest = state.projection.squares() - candidate.squares_removed - known;
    out.tail_norm = {root(rest.x), root(rest.y), root(rest.z)};
    out.absolute = out.absolute - e;
    return out;
}

/// A level to cut a source at, and the bound expected for it.
struct Cut {
    double level, bound;
    Sun sun;
};

/// Takes the light above `level` out of the image and updates the projection. Undone if the new bound exceeds `target`.
void take(State& state, const Judge& judge, const std::vector<Pixel>& pixels, double level, const Sun& sun, double target) {
    int first = state.height, end = 0;
    for (const Pixel& p : pixels) first = std::min(first, p.y), end = std::max(end, p.y + 1);
    Projection projection = state.projection;
    projection.add_rows(state.view(), first, end, -1.0);
    std::vector<Vec3f> before;
    for (const Pixel& p : pixels) {
        float* const rgb = state.pixel(p.x, p.y);
        before.push_back({rgb[0], rgb[1], rgb[2]});
        float left[3];
        dim(state, p, level, left);
        if (p.luminance > level) rgb[0] = left[0], rgb[1] = left[1], rgb[2] = left[2];
    }
    projection.add_rows(state.view(), first, end, 1.0);
    std::vector<Sun> suns = state.suns;
    suns.push_back(sun);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (pixels[i].luminance > level) {
            suns.back().pixels.push_back(static_cast<std::int32_t>(state.index(pixels[i].x, pixels[i].y)));
            suns.back().before.push_back(before[i]);
        }
    const double bound = judge.bound(projection.spectrum(), suns);
    if (bound <= target) {
        state.projection = std::move(projection);
        state.suns = std::move(suns);
        state.bound = bound;
        return;
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        float* const rgb = state.pixel(pixels[i].x, pixels[i].y);
        rgb[0] = before[i].x, rgb[1] = before[i].y, rgb[2] = before[i].z;
    }
}

}  // namespace

SunExtraction extract_suns(int width, int height, std::vector<float> rgb, const Projection& full, const SunOptions& options) {
    const Judge judge;
    State state{width, height, std::move(rgb), full, {}, 0.0};
    state.bound = judge.bound(full.spectrum(), {});
    std::vector<bool> seen(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int tried = 0; tried < kMaxCandidates && static_cast<int>(state.suns.size()) < options.max_suns; ++tried) {
        const double mean = luminance(state.projection.mean());
        const std::optional<Pixel> peak = brightest(state, seen);
        if (!peak || !(peak->luminance > options.min_contrast * mean)) break;
        const std::vector<Pixel> pixels = source(state, *peak, mean, options.max_radius_rad, seen);
        const double target = (1.0 - options.min_gain) * state.bound;
        std::vector<Cut> cuts;
        double best = target, floor = mean;
        for (double level = 0.5 * peak->luminance; level > floor; level *= 0.5) {
            const Candidate candidate = gather(state, pixels, level);
            std::vector<Sun> suns = state.suns;
            suns.push_back(candidate.sun);
            cuts.push_back({level, judge.bound(without(state, candidate), suns), candidate.sun});
            best = std::min(best, cuts.back().bound);
            const double rest = luminance(state.projection.mean() - candidate.sun.irradiance * (0.25 / kPi));
            floor = std::min(mean, kAboveRest * std::max(rest, kRounded * mean));
        }
        if (!(best < target)) continue;
        const auto lowest = std::find_if(cuts.rbegin(), cuts.rend(), [best](const Cut& cut) { return cut.bound <= kAsGood * best; });
        take(state, judge, pixels, lowest->level, lowest->sun, target);
    }
    return {std::move(state.suns), std::move(state.rgb), std::move(state.projection)};
}

Vec3d sun_bound(const std::vector<Sun>& suns, const LobeSpectrum& lobe) {
    Vec3d sum{};
    for (const Sun& sun : suns) sum = sum + sun.irradiance * (sun.spread_rad * lobe.slope / kPi);
    return sum;
}

}  // namespace halflit::sh
