#include "apps/lab/trade_grid.hpp"

#include "apps/engine/request/plan_names.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/io/files/lobe_name.hpp"
#include "sh/basis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace halflit::cli {
namespace {

constexpr std::array kRates{ShadingRate::pixel, ShadingRate::gouraud, ShadingRate::flat};
constexpr std::array kTextures{TextureDetail::full, TextureDetail::bilinear, TextureDetail::nearest};
constexpr std::array kBudgets{0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::array kShadowSizes{2048, 1024, 512};
constexpr int kAutoShadowSize = 1024;  ///< sizes below it are offered beside auto

std::vector<int> orders(const TradeSpace& space) {
    std::vector<int> list{0};
    for (int order = 1; order <= sh::kMaxBands && space.environment; ++order) list.push_back(order);
    return list;
}

std::vector<TextureDetail> textures(const TradeSpace& space) {
    return space.textures ? std::vector(kTextures.begin(), kTextures.end()) : std::vector{TextureDetail::full};
}

struct Shadows {
    ShadowMode mode;
    int size;
};

/// The given kind of shadow first, then all cheaper ones.
std::vector<Shadows> shadows(const TradeSpace& space) {
    std::vector<Shadows> list{{space.shadows, space.shadow_size}};
    if (!space.lights) return list;
    for (const ShadowMode mode : {ShadowMode::soft_split, ShadowMode::hard}) {
        if (mode > space.shadows) continue;
        if (mode != space.shadows) list.push_back({mode, space.shadow_size});
        for (const int size : kShadowSizes)
            if (size < (space.shadow_size > 0 ? space.shadow_size : kAutoShadowSize)) list.push_back({mode, size});
    }
    if (space.shadows != ShadowMode::off) list.push_back({ShadowMode::off, space.shadow_size});
    return list;
}

/// Collects each choice once.
class Collector {
public:
    void add(const TradeChoice& choice) {
        if (std::find(choices_.begin(), choices_.end(), choice) == choices_.end()) choices_.push_back(choice);
    }
    [[nodiscard]] std::vector<TradeChoice> take() { return std::move(choices_); }

private:
    std::vector<TradeChoice> choices_;
};

void add_alone(Collector& list, const TradeSpace& space, const TradeChoice& exact) {
    const auto vary = [&](auto TradeChoice::*member, const auto& values) {
        for (const auto& value : values) {
            TradeChoice choice = exact;
            choice.*member = value;
            list.add(choice);
        }
    };
    vary(&TradeChoice::order, orders(space));
    vary(&TradeChoice::rate, kRates);
    vary(&TradeChoice::texture, textures(space));
    vary(&TradeChoice::max_error_codes, kBudgets);
    vary(&TradeChoice::samples, std::array{1});
    if (space.textures) vary(&TradeChoice::anisotropy, std::array{1});
    for (const Shadows& kind : shadows(space)) {
        // Mode and size are varied one at a time.
        if (kind.mode != space.shadows && kind.size != space.shadow_size) continue;
        TradeChoice choice = exact;
        choice.shadows = kind.mode;
        choice.shadow_size = kind.size;
        list.add(choice);
    }
    // Cheap settings whose errors are seldom seen, together.
    TradeChoice cheap = exact;
    cheap.samples = 1;
    if (space.textures) cheap.anisotropy = 1;
    if (const std::vector<Shadows> kinds = shadows(space); kinds.size() > 1 && kinds[1].mode == space.shadows)
        cheap.shadow_size = kinds[1].size;
    list.add(cheap);
}

void add_product(Collector& list, const TradeSpace& space, const TradeChoice& exact, const std::vector<Shadows>& kinds) {
    for (const Shadows& kind : kinds)
        for (const int order : orders(space))
            for (const ShadingRate rate : kRates)
                for (const TextureDetail texture : textures(space)) {
                    TradeChoice choice = exact;
                    choice.order = order;
                    choice.rate = rate;
                    choice.texture = texture;
                    choice.shadows = kind.mode;
                    choice.shadow_size = kind.size;
                    list.add(choice);
                }
}

/// Calls add(name, flag) for each setting that differs from exact.
template <class Add>
void describe(const TradeChoice& choice, const TradeSpace& space, const Add& add) {
    if (choice.lobe) add("lobe " + space.lobes[*choice.lobe].name, "");
    if (choice.max_error_codes > 0)
        add(fmt::format("within {:g} code{}", choice.max_error_codes, choice.max_error_codes == 1 ? "" : "s"),
            fmt::format("--max-error {:g}", choice.max_error_codes));
    if (choice.accuracy != Accuracy::exact)
        add(std::string(accuracy_name(choice.accuracy)), fmt::format("--accuracy {}", accuracy_name(choice.accuracy)));
    if (choice.samples != space.samples)
        add(fmt::format("{} sample{}", choice.samples, choice.samples == 1 ? "" : "s"), fmt::format("--samples {}", choice.samples));
    if (choice.anisotropy != space.anisotropy)
        add(fmt::format("anisotropy {}", choice.anisotropy), fmt::format("--anisotropy {}", choice.anisotropy));
    if (choice.order > 0) add(fmt::format("order {}", choice.order), fmt::format("--sh-order {}", choice.order));
    if (choice.rate != ShadingRate::pixel) add(std::string(rate_name(choice.rate)), fmt::format("--shading {}", rate_name(choice.rate)));
    if (choice.texture != TextureDetail::full)
        add(std::string(texture_detail_name(choice.texture)), fmt::format("--texture-filter {}", texture_detail_name(choice.texture)));
    if (choice.shadows != space.shadows)
        add(choice.shadows == ShadowMode::off ? "no shadows" : fmt::format("{} shadows", shadow_mode_name(choice.shadows)),
            fmt::format("--shadows {}", shadow_mode_name(choice.shadows)));
    if (choice.shadow_size != space.shadow_size)
        add(fmt::format("shadow map {}", choice.shadow_size), fmt::format("--shadow-size {}", choice.shadow_size));
}

}  // namespace

Result<TradeLobe> parse_trade_lobe(std::string_view text) {
    std::vector<std::string_view> parts;
    for (std::string_view rest = text;; rest.remove_prefix(parts.back().size() + 1)) {
        parts.push_back(rest.substr(0, rest.find(':')));
        if (parts.back().size() == rest.size()) break;
    }
    if (parts.size() > 3) return fail(ErrorCode::usage, fmt::format("expected NAME, NAME:WRAP or NAME:WRAP:POWER, found '{}'", text));
    io::LobeParameters parameters;
    if (parts.size() > 1) {
        const auto wrap = parse_float(parts[1], 0.0f, 1.0f);
        if (!wrap) return tl::unexpected(wrap.error());
        parameters.wrap = *wrap;
    }
    if (parts.size() > 2) {
        const auto power = parse_float(parts[2], 0.0f, kMaxLobePower);
        if (!power) return tl::unexpected(power.error());
        parameters.power = *power;
    }
    const auto lobe = io::lobe_from_name(parts[0], parameters);
    if (!lobe) return fail(ErrorCode::usage, lobe.error().message);
    return TradeLobe{std::string(text), *lobe};
}

TradeChoice TradeSpace::reference(std::optional<std::size_t> lobe) const {
    TradeChoice choice = exact();
    choice.lobe = lobe;
    choice.accuracy = Accuracy::reference;
    return choice;
}

std::vector<TradeChoice> trade_choices(const TradeSpace& space, TradeExtent extent) {
    Collector list;
    for (std::size_t i = 0; i <= space.lobes.size(); ++i) {
        TradeChoice exact = space.exact();
        if (i > 0) exact.lobe = i - 1;
        list.add(exact);
        add_alone(list, space, exact);
        if (extent == TradeExtent::usual) add_product(list, space, exact, {{space.shadows, space.shadow_size}});
        if (extent == TradeExtent::all) add_product(list, space, exact, shadows(space));
    }
    return list.take();
}

std::string trade_name(const TradeChoice& choice, const TradeSpace& space) {
    std::string name;
    describe(choice, space, [&](const std::string& part, const std::string&) { name += (name.empty() ? "" : ", ") + part; });
    return name.empty() ? "exact" : name;
}

std::string trade_flags(const TradeChoice& choice, const TradeSpace& space) {
    std::string flags;
    describe(choice, space, [&](const std::string&, const std::string& flag) {
        if (!flag.empty()) flags += (flags.empty() ? "" : " ") + flag;
    });
    return flags;
}

int settings_varied(const TradeChoice& choice, const TradeSpace& space) {
    int count = 0;
    describe(choice, space, [&](const std::string&, const std::string&) { ++count; });
    return count;
}

void apply_choice(Settings& settings, const TradeChoice& choice) {
    settings.shading.accuracy = choice.accuracy;
    settings.shading.max_error_codes = choice.max_error_codes;
    settings.shading.environment_bands = choice.order;
    settings.shading.rate = choice.rate;
    settings.shading.texture_detail = choice.texture;
    settings.shadows = choice.shadows;
    settings.shadow_size = choice.shadow_size;
    settings.samples = choice.samples;
    settings.shading.anisotropy = choice.anisotropy;
}

}  // namespace halflit::cli
