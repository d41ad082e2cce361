#include "raster/quality.hpp"

#include "raster/view/shadow_views.hpp"

#include <algorithm>
#include <bit>

namespace halflit::raster {
namespace {

std::uint64_t mixed(std::uint64_t x) {
    x ^= x >> 30, x *= 0xbf58476d1ce4e5b9u;
    x ^= x >> 27, x *= 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Probability that at most `off` of n pixels are outside, if each is with probability p in (0, 1). Terms are taken relative to that of
/// `off`, since those of the ends may be too small for a number. What overflows is that much larger than the rest.
double at_most(int n, int off, double p) {
    constexpr double kEndless = 1e300;
    const double odds = p / (1.0 - p);
    double below = 0.0, above = 0.0;
    double term = 1.0;
    for (int k = off; k >= 0; --k) {
        below += term;
        if (below > kEndless) return 1.0;
        term *= static_cast<double>(k) / ((n - k + 1) * odds);
    }
    term = 1.0;
    for (int k = off; k < n; ++k) {
        term *= static_cast<double>(n - k) / (k + 1) * odds;
        above += term;
        if (above > kEndless) return 0.0;
    }
    return below / (below + above);
}

}  // namespace

std::vector<CheaperPart> cheaper_parts(const Settings& full, const QualityFacts& facts) {
    using Kind = CheaperPart::Kind;
    std::vector<CheaperPart> parts;
    // Medians of ten models at 512x512.
    if (full.samples > 1) parts.push_back({Kind::samples, 1, 0.67});
    if (facts.textures && full.shading.anisotropy > 2) parts.push_back({Kind::textures, 2, 0.88});
    if (facts.textures && full.shading.anisotropy > 1) parts.push_back({Kind::textures, 1, 0.8});
    if (facts.shadow_size >= 2 * kShadowSizeStep) parts.push_back({Kind::shadows, halved_shadow_size(facts.shadow_size), 0.93});
    return parts;
}

Settings with_part(Settings settings, const CheaperPart& part) {
    switch (part.kind) {
        case CheaperPart::Kind::samples:
            settings.samples = part.value;
            break;
        case CheaperPart::Kind::textures:
            settings.shading.anisotropy = part.value;
            break;
        case CheaperPart::Kind::shadows:
            settings.shadow_size = part.value;
            break;
    }
    return settings;
}

std::vector<Combination> combinations(const Settings& full, const std::vector<CheaperPart>& parts,
                                      const std::vector<std::vector<bool>>& outside) {
    std::vector<Combination> out;
    for (unsigned set = 1; set < (1u << parts.size()); ++set) {
        Combination one{full};
        unsigned kinds = 0;
        bool twice = false;
        std::vector<bool> all;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if ((set >> i & 1u) == 0) continue;
            const unsigned kind = 1u << static_cast<unsigned>(parts[i].kind);
            twice |= (kinds & kind) != 0;
            kinds |= kind;
            one.settings = with_part(one.settings, parts[i]);
            one.cost *= parts[i].cost;
            all.resize(outside[i].size());
            for (std::size_t p = 0; p < all.size(); ++p) all[p] = all[p] || outside[i][p];
        }
        if (twice) continue;
        one.outside = static_cast<int>(std::count(all.begin(), all.end(), true));
        out.push_back(one);
    }
    std::stable_sort(out.begin(), out.end(), [](const Combination& a, const Combination& b) { return a.cost < b.cost; });
    return out;
}

std::vector<std::uint32_t> choose_probes(int width_px, int height_px, const Camera& camera) {
    constexpr std::uint64_t kOneOf = 100, kLeast = 512, kMost = 4096;
    const std::uint64_t pixels = static_cast<std::uint64_t>(width_px) * static_cast<std::uint64_t>(height_px);
    const std::uint64_t count = std::min(pixels, std::clamp(pixels / kOneOf, kLeast, kMost)), step = pixels / count;
    std::uint64_t seed = mixed(pixels);
    for (const Vec4f& column : camera.world_from_camera.c)
        for (const float x : {column.x, column.y, column.z, column.w}) seed = mixed(seed ^ std::bit_cast<std::uint32_t>(x));
    // One in each stretch of the picture, from a place on that is any pixel: all are equally likely.
    const std::uint64_t first = seed % pixels;
    std::vector<std::uint32_t> probes;
    probes.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i)
        probes.push_back(static_cast<std::uint32_t>((first + i * step + mixed(seed + 0x9e3779b97f4a7c15u * (i + 1)) % step) % pixels));
    return probes;
}

double share_shown(int probes, int off, double doubt) {
    if (probes <= 0) return 100.0;
    if (off >= probes) return 0.0;
    double low = static_cast<double>(off) / probes, high = 1.0;  // of the share outside
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (at_most(probes, off, middle) > doubt ? low : high) = middle;
    }
    return 100.0 * (1.0 - high);
}

bool differs(std::uint32_t a, std::uint32_t b, double codes) {
    for (int shift = 0; shift < 32; shift += 8) {
        const int of_a = static_cast<int>(a >> shift & 0xffu), of_b = static_cast<int>(b >> shift & 0xffu);
        if (static_cast<double>(of_a > of_b ? of_a - of_b : of_b - of_a) > codes) return true;
    }
    return false;
}

}  // namespace halflit::raster
