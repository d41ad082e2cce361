// Budgets that are measured instead of proven: a share of the pixels is within some codes of the picture in full quality. Probes are pixels
// that a hash chooses. They are drawn in full quality and in cheaper ones, and the cheapest that keeps the share is taken. Time decides
// nothing, so the same scene and settings give the same choice everywhere.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/report.hpp"
#include "halflit/settings.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Codes from which on a budget is often kept by all cheaper settings together.
inline constexpr double kWideBudget = 4;

/// Facts of the frame that decide which parts can be cheaper.
struct QualityFacts {
    bool textures = false;  ///< some material has one
    int shadow_size = 0;    ///< texels on a side of all shadow maps; 0: there are none, or they differ
};

/// One setting that is cheaper than in full quality.
struct CheaperPart {
    enum class Kind : std::uint8_t { samples, textures, shadows } kind;
    int value;    ///< Settings::samples, ShadingSettings::anisotropy or Settings::shadow_size
    double cost;  ///< share of the time that is left, about
};
[[nodiscard]] std::vector<CheaperPart> cheaper_parts(const Settings& full, const QualityFacts& facts);
[[nodiscard]] Settings with_part(Settings settings, const CheaperPart& part);

/// Parts of different kinds together.
struct Combination {
    Settings settings;
    double cost = 1.0;
    int outside = 0;  ///< probes that some of its parts takes outside of the budget
};
/// All combinations, from the cheapest on. outside: for each part, the probes that it takes outside.
[[nodiscard]] std::vector<Combination> combinations(const Settings& full, const std::vector<CheaperPart>& parts,
                                                    const std::vector<std::vector<bool>>& outside);

/// Pixels of a picture.
class PixelMask {
public:
    PixelMask(int width_px, int height_px)
        : stride_((width_px + 63) / 64), bits_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_px)) {}
    void add(int x_px, int y_px) { bits_[index(x_px, y_px)] |= std::uint64_t{1} << (x_px & 63); }
    [[nodiscard]] bool has(int x_px, int y_px) const { return (word(x_px, y_px) >> (x_px & 63) & 1u) != 0; }
    [[nodiscard]] bool has_any(int x_px, int y_px, int count) const {
        for (int i = 0; i < count;) {
            const int step = std::min(count - i, 64 - ((x_px + i) & 63));
            const std::uint64_t part = word(x_px + i, y_px) >> ((x_px + i) & 63);
            if ((step == 64 ? part : part & ((std::uint64_t{1} << step) - 1u)) != 0) return true;
            i += step;
        }
        return false;
    }

private:
    [[nodiscard]] std::size_t index(int x_px, int y_px) const {
        return static_cast<std::size_t>(y_px) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(x_px >> 6);
    }
    [[nodiscard]] std::uint64_t word(int x_px, int y_px) const { return bits_[index(x_px, y_px)]; }
    int stride_;
    std::vector<std::uint64_t> bits_;
};

/// Pixels to compare, all different, spread over the picture: one of about a hundred, at least 512 and at most 4096. The camera is part of
/// the hash.
[[nodiscard]] std::vector<std::uint32_t> choose_probes(int width_px, int height_px, const Camera& camera);

/// The largest share, in percent, that `off` of `probes` pixels outside still show with a confidence of 1 - doubt: Clopper and Pearson's
/// lower bound, rounded down. It is 100 for no pixel at all.
[[nodiscard]] double share_shown(int probes, int off, double doubt);

/// True if the codes of two pixels differ by more than that in some channel, alpha included.
[[nodiscard]] bool differs(std::uint32_t a, std::uint32_t b, double codes);

}  // namespace halflit::raster
