#include "shading/budget/power_fit.hpp"

#include "shading/model/code_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace halflit::shading {
namespace {

constexpr int kTerms = kLobeCurveTerms;
/// Relative error of one operation in float32.
constexpr double kRounding = 6e-8;

/// Solves N linear equations, one for each row of `a`, with the right side in column N.
template <int N>
std::array<double, N> solve(std::array<std::array<double, N + 1>, N> a) {
    for (std::size_t k = 0; k < N; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < N; ++i)
            if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        for (std::size_t i = k + 1; i < N; ++i) {
            const double factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j <= N; ++j) a[i][j] -= factor * a[k][j];
        }
    }
    std::array<double, N> x{};
    for (std::size_t k = N; k-- > 0;) {
        double sum = a[k][N];
        for (std::size_t j = k + 1; j < N; ++j) sum -= a[k][j] * x[j];
        x[k] = sum / a[k][k];
    }
    return x;
}

// ---- lobes ---------------------------------------------------------------------------------------------------------

struct Sample {
    double u;       ///< sqrt(t)
    double value;   ///< f = t^n
    double core;    ///< max(0, x); 0 if light is never split
    double weight;  ///< codes for an error of 1

    /// The least light that a split shadow leaves of f: the excess over the core.
    [[nodiscard]] double excess() const { return std::max(0.0, value - core); }
};

/// Number of samples, u = (i / kSamples)^2. They are close together near 0, where the curve bends most and codes are nearest to each other.
constexpr std::size_t kSamples = 256;

std::vector<Sample> samples_of(double n, double amplitude, double split_wrap) {
    constexpr double kNearCore = 1e-3;  // nearer to the core than this, an error of f may show as excess
    std::vector<Sample> samples(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
        Sample& s = samples[i];
        const double root = static_cast<double>(i + 1) / kSamples;
        s.u = root * root;
        s.value = power_of(s.u, 2.0 * n);
        s.core = split_wrap > 0.0 ? std::max(0.0, (1.0 + split_wrap) * s.u * s.u - split_wrap) : 0.0;
        s.weight = amplitude * code_slope(amplitude * (s.value > s.core - kNearCore ? s.excess() : s.value));
    }
    return samples;
}

template <class Coefficients>
double fitted(const Coefficients& c, double u) {
    double sum = 0.0;
    for (std::size_t k = kTerms; k-- > 0;) sum = sum * u + static_cast<double>(c[k]);
    return u * u * sum;
}

/// Remez's exchange on the samples: the coefficients whose largest weighted error is least.
std::array<double, kTerms> least_largest_error(const std::vector<Sample>& samples) {
    constexpr std::size_t kPoints = kTerms + 1;
    std::array<std::size_t, kPoints> at;
    for (std::size_t j = 0; j < kPoints; ++j)
        at[j] = static_cast<std::size_t>((1.0 - std::sqrt(1.0 - static_cast<double>(j + 1) / kPoints)) * (kSamples - 1));
    std::array<double, kTerms> c{};
    for (int step = 0; step < 12; ++step) {
        std::array<std::array<double, kPoints + 1>, kPoints> equations;
        for (std::size_t j = 0; j < kPoints; ++j) {
            const Sample& s = samples[at[j]];
            double basis = s.u * s.u;
            for (std::size_t k = 0; k < kTerms; ++k, basis *= s.u) equations[j][k] = basis * s.weight;
            equations[j][kTerms] = j % 2 == 0 ? 1.0 : -1.0;
            equations[j][kPoints] = s.value * s.weight;
        }
        const auto solution = solve<static_cast<int>(kPoints)>(equations);
        std::copy_n(solution.begin(), kTerms, c.begin());
        // The largest error of each run of one sign.
        std::vector<std::size_t> peaks;
        std::vector<double> errors(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) {
            errors[i] = (fitted(c, samples[i].u) - samples[i].value) * samples[i].weight;
            if (peaks.empty() || (errors[i] > 0.0) != (errors[peaks.back()] > 0.0))
                peaks.push_back(i);
            else if (std::fabs(errors[i]) > std::fabs(errors[peaks.back()]))
                peaks.back() = i;
        }
        if (peaks.size() < kPoints) break;
        while (peaks.size() > kPoints)
            peaks.erase(std::fabs(errors[peaks.front()]) < std::fabs(errors[peaks.back()]) ? peaks.begin() : peaks.end() - 1);
        double largest = 0.0;
        for (const std::size_t peak : peaks) largest = std::max(largest, std::fabs(errors[peak]));
        std::copy_n(peaks.begin(), kPoints, at.begin());
        if (largest <= 1.02 * std::fabs(solution[kTerms])) break;
    }
    return c;
}

struct Point {
    double x, y;
};

/// The least concave function on x >= 0 that does not decrease and is nowhere below the points.
std::vector<Point> concave_majorant(std::vector<Point> points) {
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y > b.y); });
    std::vector<Point> hull{{0.0, points.front().x == 0.0 ? points.front().y : 0.0}};
    for (const Point& p : points) {
        if (p.y <= hull.back().y) continue;
        while (hull.size() > 1) {
            const Point& a = hull[hull.size() - 2];
            const Point& b = hull.back();
            if ((b.y - a.y) * (p.x - b.x) > (p.y - b.y) * (b.x - a.x)) break;
            hull.pop_back();
        }
        hull.push_back(p);
    }
    return hull;
}

double at(const std::vector<Point>& hull, double x) {
    for (std::size_t i = 1; i < hull.size(); ++i)
        if (x <= hull[i].x) return hull[i - 1].y + (x - hull[i - 1].x) * (hull[i].y - hull[i - 1].y) / (hull[i].x - hull[i - 1].x);
    return hull.back().y;
}

// ---- highlights ----------------------------------------------------------------------------------------------------

/// cos((2 i + 1) pi / (2 N)), rising.
constexpr double kChebyshev4[] = {-0.92387953251128674, -0.38268343236508977, 0.38268343236508977, 0.92387953251128674};
constexpr double kChebyshev8[] = {-0.98078528040323044, -0.83146961230254524, -0.55557023301960222, -0.19509032201612827,
                                  0.19509032201612827,  0.55557023301960222,  0.83146961230254524,  0.98078528040323044};

}  // namespace

LobeFit fit_lobe(double n, double amplitude, double split_wrap) {
    LobeFit fit{};
    fit.codes = 255.0;
    if (!(n >= 1.0 && n <= 64.0 && amplitude > 0.0 && amplitude < 1e6)) return fit;
    const std::vector<Sample> samples = samples_of(n, amplitude, split_wrap);
    const std::array<double, kTerms> c = least_largest_error(samples);
    for (std::size_t k = 0; k < kTerms; ++k) fit.c[k] = static_cast<float>(c[k]);

    // |error| as a function of the light that is drawn: f, or the excess alone. Between two samples it is entered at the lesser value of
    // the two: f rises with t, and the excess rises up to x = 0 and falls from there on, because f is convex.
    std::vector<Point> errors;
    double before = 0.0, last = 0.0;  // u and error of `lower`
    Sample lower{};
    for (const Sample& s : samples) {
        // `bend` bounds the second derivative of the error between the sample before and this one.
        double size = 0.0, fit_bend = 0.0, fit_bends = 0.0, fit_twist = 0.0, power = 1.0;
        for (std::size_t k = 0; k < kTerms; ++k, power *= s.u) {
            const double term = static_cast<double>(fit.c[k]) * power, twice = static_cast<double>((k + 2) * (k + 1));
            size += std::fabs(term);
            fit_bend += twice * term;
            fit_bends += twice * std::fabs(term);
            fit_twist += twice * static_cast<double>(k) * std::fabs(term) / s.u;
        }
        const double true_bend = 2.0 * n * (2.0 * n - 1.0) * s.value / (s.u * s.u), step = s.u - before;
        double bend = true_bend + fit_bends;
        if (before > 0.0) {
            const double true_twist = true_bend * (2.0 * n - 2.0) / s.u * (n < 1.5 ? s.u / before : 1.0);  // largest u^(2n-3) in between
            bend = std::min(bend, std::fabs(true_bend - fit_bend) + step * (true_twist + fit_twist));
        }
        // Between two samples the error is at most that of the worse one, plus an eighth of the second derivative times the squared step.
        const double here = std::fabs(fitted(fit.c, s.u) - s.value) + s.u * s.u * size * (2 * kTerms) * kRounding;
        const double between = 0.125 * bend * step * step, error = std::max(here, last) + between;
        errors.push_back({lower.value, error});
        // Where f is below the core, only the part of the error that reaches past the core shows as excess. The gap is concave in t, and a
        // place between the two samples divides u and t in shares that differ by at most a quarter of the step over the sum.
        const double gap = s.core - s.value, gap_before = lower.core - lower.value;
        if (s.core > 0.0 && std::min(gap, gap_before) >= 0.0)
            errors.push_back(
                {0.0, std::max({0.0, here - gap, last - gap_before}) + 0.25 * step / (s.u + before) * std::fabs(here - last) + between});
        else if (s.core > 0.0)
            errors.push_back({std::min(s.excess(), lower.excess()), error});
        before = s.u, last = here, lower = s;
    }
    const std::vector<Point> majorant = concave_majorant(std::move(errors));
    // The part of the error that is there even where nothing is drawn counts as absolute.
    const double always = majorant.front().y;
    const double codes =
        largest_on_curve([&](const CurvePoint& on) { return on.slope * amplitude * (at(majorant, on.v / amplitude) - always); });
    fit.codes = std::min(255.0, codes + codes_of_absolute(amplitude * always));
    return fit;
}

SpecularFit fit_specular(double half_exponent, double least, int terms) {
    SpecularFit fit{};
    const std::size_t nodes = static_cast<std::size_t>(terms);
    double power = half_exponent, times = 1.0;
    for (fit.curve.squarings = 0; power >= 2.0; ++fit.curve.squarings, power *= 0.5) times *= 2.0;
    // Interpolation at Chebyshev's nodes: Newton's divided differences, expanded into powers of x.
    const double* const chebyshev = terms == SpecularCurve::kFewTerms ? kChebyshev4 : kChebyshev8;
    const double middle = 0.5 * (1.0 + least), half = 0.5 * (1.0 - least);
    double x[SpecularCurve::kMostTerms], difference[SpecularCurve::kMostTerms], c[SpecularCurve::kMostTerms] = {};
    for (std::size_t i = 0; i < nodes; ++i) {
        x[i] = middle + half * chebyshev[i];
        difference[i] = power_of(x[i], power);
    }
    for (std::size_t k = 1; k < nodes; ++k)
        for (std::size_t i = nodes - 1; i >= k; --i) difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - k]);
    for (std::size_t k = nodes; k-- > 0;) {
        for (std::size_t i = nodes - 1; i > 0; --i) c[i] = c[i - 1] - x[k] * c[i];
        c[0] = difference[k] - x[k] * c[0];
    }
    double size = 0.0;
    for (std::size_t i = 0; i < nodes; ++i) {
        fit.curve.c[i] = static_cast<float>(c[i]);
        size += std::fabs(c[i]);
    }
    fit.curve.terms = terms;
    fit.curve.least = static_cast<float>(least);
    fit.rounding = times * 2.0 * kRounding + half_exponent * 20.0 * kRounding;
    fit.least_root = power_of(least, power);
    fit.root_error = 1e30;
    if (!(least > 1e-6 && least < 1.0)) return fit;
    // No derivative of x^power but those of a polynomial has a zero, so by Rolle's theorem the error has one extreme between two nodes, and
    // none outside. The golden section finds it.
    const auto error_at = [&](double at) {
        double p = c[nodes - 1];
        for (std::size_t i = nodes - 1; i-- > 0;) p = p * at + c[i];
        return std::fabs(p - power_of(at, power));
    };
    double largest = std::max(error_at(least), error_at(1.0));
    for (std::size_t i = 0; i + 1 < nodes; ++i) {
        constexpr double kGolden = 0.6180339887498949;
        double low = x[i], high = x[i + 1];
        for (int k = 0; k < 24; ++k) {
            const double inner = high - kGolden * (high - low), outer = low + kGolden * (high - low);
            error_at(inner) < error_at(outer) ? low = inner : high = outer;
        }
        largest = std::max(largest, error_at(0.5 * (low + high)));
    }
    // Rounding: of the coefficients, and two for each term.
    fit.root_error = 1.001 * largest + (2.0 * terms + 1.0) * kRounding * size;
    return fit;
}

double SpecularFit::relative_error(double share) const {
    // (r + e)^m against r^m, r being the root and e its error: a relative error of m e / r, and the higher terms of (1 + e / r)^m.
    const double m = static_cast<double>(std::int64_t{1} << std::max(0, curve.squarings));
    const double root = std::max(least_root, power_of(share, 1.0 / m)), bent = m * root_error / root;
    if (!(root > 0.0 && bent < 0.5)) return 1e30;
    return rounding + (m > 1.0 ? bent * (1.0 + bent) : bent);
}

double SpecularFit::codes(double peak, int count) const {
    const double top = peak * count;
    if (!(top > 0.0)) return 0.0;
    if (relative_error(0.0) > 1.0) return 255.0;
    // v times the relative error is made of v^(1 - 1/m) and v^(1 - 2/m), and is linear below the cut. It is concave, so that lights add up.
    return std::min(255.0, largest_on_curve([&](const CurvePoint& at) {
                        const double v = std::min(at.v, top);
                        return at.slope * v * relative_error(v / top);
                    }));
}

namespace {

/// Looks up a fit, or makes it. Entries are limited, because a scene whose light changes all the time must not fill the memory. They are in
/// a deque, so that references stay valid when entries are added.
template <class Entries, class Same, class Make>
auto& find_or_make(Entries& entries, const Same& same, const Make& make) {
    constexpr std::size_t kMostEntries = 1024;
    for (auto& entry : entries)
        if (same(entry)) return entry.fit;
    if (entries.size() == kMostEntries) entries.clear();
    return entries.emplace_back(make()).fit;
}

}  // namespace

const LobeFit& PowerFits::lobe(double n, double amplitude, double split_wrap) {
    // The amplitude is rounded up to a quarter of a power of two. More light has a larger error, so the bound holds for less light too.
    const double held = amplitude > 1e-30 && amplitude < 1e6 ? exp2_of(std::ceil(4.0 * log2_of(amplitude)) / 4.0) : 0.0;
    return find_or_make(
        lobes_, [&](const LobeEntry& e) { return e.n == n && e.amplitude == held && e.split_wrap == split_wrap; },
        [&] {
            return LobeEntry{n, held, split_wrap, fit_lobe(n, held, split_wrap)};
        });
}

const SpecularFit& PowerFits::specular(double half_exponent, double least, int terms) {
    return find_or_make(
        speculars_, [&](const SpecularEntry& e) { return e.half_exponent == half_exponent && e.least == least && e.terms == terms; },
        [&] {
            return SpecularEntry{half_exponent, least, terms, fit_specular(half_exponent, least, terms)};
        });
}

}  // namespace halflit::shading
