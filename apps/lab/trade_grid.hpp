// Settings that `halflit trade` compares because they affect accuracy, and the list of their combinations.
#pragma once

#include "halflit/error.hpp"
#include "halflit/renderer.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::cli {

/// A lobe for all materials, as users name it: NAME, NAME:WRAP or NAME:WRAP:POWER.
struct TradeLobe {
    std::string name;
    Lobe lobe;
};
[[nodiscard]] Result<TradeLobe> parse_trade_lobe(std::string_view text);

/// One way to draw the frame.
struct TradeChoice {
    std::optional<std::size_t> lobe{};  ///< index into TradeSpace::lobes; none: the scene's own
    Accuracy accuracy = Accuracy::exact;
    double max_error_codes = 0.0;  ///< above 0: instead of the accuracy
    int order = 0;                 ///< number of bands for the environment; 0: chosen from the error bound
    ShadingRate rate = ShadingRate::pixel;
    TextureDetail texture = TextureDetail::full;
    ShadowMode shadows = ShadowMode::soft_split;
    int shadow_size = 0;
    int samples = 4, anisotropy = 4;

    friend bool operator==(const TradeChoice&, const TradeChoice&) = default;
};

/// Features of the scene that can be varied, and the most accurate settings, from which all errors are measured.
struct TradeSpace {
    bool environment = false, textures = false, lights = false;
    ShadowMode shadows = ShadowMode::soft_split;
    int shadow_size = 0;
    int samples = 4, anisotropy = 4;
    std::vector<TradeLobe> lobes;

    [[nodiscard]] TradeChoice exact() const {
        return {.shadows = shadows, .shadow_size = shadow_size, .samples = samples, .anisotropy = anisotropy};
    }
    [[nodiscard]] TradeChoice reference(std::optional<std::size_t> lobe) const;
};

enum class TradeExtent : std::uint8_t {
    quick,  ///< one setting at a time, the others as in exact; the error budgets; samples, anisotropy and shadow size together
    usual,  ///< also all combinations of order, rate and texture filter
    all     ///< also those combinations with every kind of shadow
};

/// Each choice once, exact first: for the scene's own lobe, then for each of the others. Features that the scene lacks are not varied.
[[nodiscard]] std::vector<TradeChoice> trade_choices(const TradeSpace& space, TradeExtent extent);

/// Name for reports: "order 3, gouraud"; "exact" where nothing differs from it.
[[nodiscard]] std::string trade_name(const TradeChoice& choice, const TradeSpace& space);
/// Flags to add to a `halflit render` command: "--sh-order 3 --shading gouraud". Empty for exact.
[[nodiscard]] std::string trade_flags(const TradeChoice& choice, const TradeSpace& space);

/// Number of settings that differ from exact.
[[nodiscard]] int settings_varied(const TradeChoice& choice, const TradeSpace& space);

/// Puts everything but the lobe into the frame's settings.
void apply_choice(Settings& settings, const TradeChoice& choice);

}  // namespace halflit::cli
