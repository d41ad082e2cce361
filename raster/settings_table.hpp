// The table of settings_table.def.
#pragma once

#include "halflit/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace halflit::raster {

// Names of enumerators, in their order.
inline constexpr std::string_view kAccuracyNames[] = {"reference", "exact"};
inline constexpr std::string_view kRateNames[] = {"flat", "gouraud", "pixel"};
inline constexpr std::string_view kShadowModeNames[] = {"off", "hard", "soft-split"};
inline constexpr std::string_view kSpecularNames[] = {"none", "phong", "blinn", "ggx"};
inline constexpr std::string_view kTextureDetailNames[] = {"full", "bilinear", "nearest"};
inline constexpr std::string_view kToneCurveNames[] = {"none", "reinhard", "aces", "neutral"};
inline constexpr std::string_view kEdgeChoiceNames[] = {"none", "feature", "silhouette", "all"};
inline constexpr std::string_view kHiddenEdgeNames[] = {"none", "dashed"};
inline constexpr std::string_view kAlphaSpaceNames[] = {"linear", "display"};
inline constexpr std::string_view kEyeDomeNames[] = {"off", "auto", "on"};
inline constexpr std::string_view kOffOn[] = {"off", "on"};
inline constexpr int kSampleCounts[] = {1, 4, 8, 16};
inline constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Up to six digits, and all those of whole numbers of up to seven.
inline std::string number_text(double x) {
    char text[32];
    constexpr double kMostWhole = 1e7;
    if (x > -kMostWhole && x < kMostWhole && x == static_cast<double>(static_cast<int>(x))) return std::to_string(static_cast<int>(x));
    return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, 6).ptr};
}

/// Values that a setting may have. All are numbers: names count from 0, a truth is 0 or 1.
struct SettingValues {
    enum class Kind : std::uint8_t { number, whole, named } kind = Kind::number;
    double low = 0, high = 0;
    bool open = false;            ///< low itself is left out
    int step = 0;                 ///< only multiples of it; 0: all
    bool zero_too = false;        ///< 0 besides the range
    std::string_view zero{};      ///< a word for that 0
    std::string_view one{};       ///< a word for a 1 besides the range
    std::span<const int> list{};  ///< of whole numbers; empty: all in the range
    std::span<const std::string_view> names{};
    double unit = 1;  ///< of the number that a flag takes

    [[nodiscard]] constexpr SettingValues or_zero(std::string_view word) const {
        SettingValues out = *this;
        out.zero_too = true, out.zero = word;
        return out;
    }
    [[nodiscard]] constexpr SettingValues or_one(std::string_view word) const {
        SettingValues out = *this;
        out.one = word;
        return out;
    }
    [[nodiscard]] constexpr SettingValues in_units_of(double size) const {
        SettingValues out = *this;
        out.unit = size;
        return out;
    }
    [[nodiscard]] constexpr bool is_truth() const { return names.data() == kOffOn; }
    /// The word for a value; empty: it is written as a number.
    [[nodiscard]] constexpr std::string_view word(double value) const {
        return value == 0.0 ? zero : value == 1.0 ? one : std::string_view();
    }
    [[nodiscard]] bool contains(double value) const;
    /// "1, 4, 8 or 16"; numbers in the flag's unit.
    [[nodiscard]] std::string expected() const;
};
constexpr SettingValues between(double low, double high) { return {.low = low, .high = high}; }
constexpr SettingValues above_zero_to(double high) { return {.low = 0, .high = high, .open = true}; }
constexpr SettingValues whole(double low, double high) { return {.kind = SettingValues::Kind::whole, .low = low, .high = high}; }
constexpr SettingValues multiple_of(int step, int low, int high) {
    return {.kind = SettingValues::Kind::whole, .low = static_cast<double>(low), .high = static_cast<double>(high), .step = step};
}
constexpr SettingValues one_of(std::span<const int> list) {
    return {.kind = SettingValues::Kind::whole,
            .low = static_cast<double>(list.front()),
            .high = static_cast<double>(list.back()),
            .list = list};
}
constexpr SettingValues named(std::span<const std::string_view> names) {
    return {.kind = SettingValues::Kind::named, .high = static_cast<double>(names.size() - 1), .names = names};
}
constexpr SettingValues truth() { return named(kOffOn); }

inline bool SettingValues::contains(double value) const {
    if ((zero_too && value == 0.0) || (!one.empty() && value == 1.0)) return true;
    if (kind == Kind::number) {
        // Numbers are kept as float, so the ends of the range are those that a float has.
        const auto kept = static_cast<float>(value), least = static_cast<float>(low), most = static_cast<float>(high);
        return kept >= least && kept <= most && !(open && kept == least);
    }
    if (!(value >= low && value <= high) || (open && value == low)) return false;
    constexpr double kAllWhole = 0x1p53;
    if (value < kAllWhole && value != static_cast<double>(static_cast<std::int64_t>(value))) return false;
    if (step > 0 && static_cast<std::int64_t>(value) % step != 0) return false;
    return list.empty() || std::find(list.begin(), list.end(), static_cast<int>(value)) != list.end();
}

inline std::string SettingValues::expected() const {
    std::string text = one.empty() ? "" : std::string(one).append(", ");
    text.append(!zero_too ? "" : zero.empty() ? "0, or " : std::string(zero).append(" or "));
    const auto add_all = [&](const auto& items, const auto& text_of) {
        for (std::size_t i = 0; i < items.size(); ++i)
            text.append(i == 0 ? "" : i + 1 < items.size() ? ", " : " or ").append(text_of(items[i]));
    };
    constexpr double kNoLimit = 1e18;
    if (kind == Kind::named)
        add_all(names, [](std::string_view name) { return name; });
    else if (!list.empty())
        add_all(list, [](int value) { return std::to_string(value); });
    else if (step > 0)
        text.append("a multiple of ")
            .append(std::to_string(step))
            .append(" from ")
            .append(number_text(low))
            .append(" to ")
            .append(number_text(high));
    else
        text.append(open                  ? "a number above "
                    : kind == Kind::whole ? "a whole number from "
                                          : "a number from ")
            .append(number_text(low / unit))
            .append(high < kNoLimit ? " to " + number_text(high / unit) : "");
    return text;
}

/// A setting that is one number.
struct Setting {
    std::string_view name;
    SettingValues values;
    std::string_view flag, form, group, help;
    double (*get)(const Settings& from);
    void (*set)(Settings& to, double value);  ///< a value out of the member's type becomes its nearest one, NaN 0 in whole numbers
};

template <class T>
constexpr void set_number(T& to, double value) {
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
        constexpr double kHigh = static_cast<double>(std::numeric_limits<T>::max()),
                         kLow = static_cast<double>(std::numeric_limits<T>::min());
        to = value >= kHigh  ? std::numeric_limits<T>::max()
             : value > kLow  ? static_cast<T>(value)
             : value <= kLow ? std::numeric_limits<T>::min()
                             : T{};
    } else if constexpr (std::is_enum_v<T>) {
        std::underlying_type_t<T> number{};
        set_number(number, value);
        to = static_cast<T>(number);
    } else {
        to = static_cast<T>(value);
    }
}

inline constexpr Setting kSettings[] = {
#define HALFLIT_SETTING(place, name, values, flag, form, group, help)      \
    {#name,                                                                \
     values,                                                               \
     flag,                                                                 \
     form,                                                                 \
     group,                                                                \
     help,                                                                 \
     [](const Settings& from) { return static_cast<double>(from.place); }, \
     [](Settings& to, double value) { set_number(to.place, value); }},
#include "raster/settings_table.def"
};

}  // namespace halflit::raster
