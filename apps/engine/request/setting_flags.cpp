#include "apps/engine/request/setting_flags.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/values.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace halflit::engine {
namespace {

using raster::Setting;
using raster::SettingValues;

std::string form_of(const Setting& setting) {
    if (!setting.form.empty()) return std::string(setting.form);
    if (setting.values.kind == SettingValues::Kind::named) return fmt::format("{}", fmt::join(setting.values.names, "|"));
    return fmt::format("{}", fmt::join(setting.values.list, "|"));
}

/// A setting's value as its flag takes it.
std::string setting_text(const Setting& setting, const Settings& settings) {
    const double value = setting.get(settings);
    if (setting.values.kind == SettingValues::Kind::named) return std::string(setting.values.names[static_cast<std::size_t>(value)]);
    if (const std::string_view word = setting.values.word(value); !word.empty()) return std::string(word);
    return fmt::format("{}", static_cast<float>(value / setting.values.unit));
}

/// The help, with the range and the default.
std::string help_of(const Setting& setting, const Settings& defaults) {
    std::string help(setting.help);
    const SettingValues values = setting.values;
    const bool ranged = values.kind != SettingValues::Kind::named && values.list.empty() && values.high < 1e18 && values.zero.empty();
    if (ranged) help.insert(std::min(help.find(" (default"), help.size()), "; " + values.expected());
    const bool is_zero = setting.values.zero_too && setting.get(defaults) == 0.0;  // which the help describes
    if (help.find("default") == std::string::npos && !is_zero) help += fmt::format(" (default {})", setting_text(setting, defaults));
    return help;
}

}  // namespace

Result<double> read_value(const SettingValues& values, const std::string& text) {
    if (values.kind == SettingValues::Kind::named) {
        std::string name = text;
        std::replace(name.begin(), name.end(), '_', '-');  // as names of languages have it
        const auto found = std::find(values.names.begin(), values.names.end(), name);
        if (found != values.names.end()) return static_cast<double>(found - values.names.begin());
        const std::vector<std::string> names(values.names.begin(), values.names.end());
        return fail(ErrorCode::usage,
                    fmt::format("expected one of {}, found '{}'{}", joined(names, ", "), text, did_you_mean(text, names)));
    }
    if (!values.zero.empty() && text == values.zero) return 0.0;
    if (!values.one.empty() && text == values.one) return 1.0;
    constexpr float kMost = 3e38f;
    constexpr std::int64_t kMostWhole = std::int64_t{1} << 62;
    const auto number = values.kind == SettingValues::Kind::whole
                            ? parse_int(text, -kMostWhole, kMostWhole).map([](std::int64_t whole) { return static_cast<double>(whole); })
                            : parse_float(text, -kMost, kMost).map([](float x) { return static_cast<double>(x); });
    if (!number || !values.contains(*number * values.unit))
        return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'", values.expected(), text));
    return *number * values.unit;
}

Result<void> read_setting(Settings& settings, std::string_view name, const std::string& text) {
    for (const Setting& setting : raster::kSettings) {
        if (setting.name != name) continue;
        const auto value = read_value(setting.values.in_units_of(1.0), text);
        if (!value) return fail(ErrorCode::usage, fmt::format("{}: {}", name, value.error().message));
        setting.set(settings, *value);
        return {};
    }
    return fail(ErrorCode::usage, fmt::format("unknown setting '{}'", name));
}

void add_setting_flags(FlagGroup& group, Settings& settings, std::vector<std::string_view>& given) {
    for (const Setting& setting : raster::kSettings)
        if (setting.group == group.title && !setting.flag.empty())
            group.flags.push_back({.names = std::string(setting.flag),
                                   .form = form_of(setting),
                                   .help = help_of(setting, settings),
                                   .read =
                                       [&settings, &given, &setting](const std::string& text) {
                                           given.push_back(setting.name);
                                           const auto value = read_value(setting.values, text);
                                           if (value) setting.set(settings, *value);
                                           return value.map([](double) {});
                                       },
                                   .stage = Stage::draw});
}

std::string differing_flags(const Settings& now, const Settings& started) {
    std::string line;
    for (const Setting& setting : raster::kSettings)
        if (!setting.flag.empty() && setting.get(now) != setting.get(started))
            line += fmt::format(" {} {}", setting.flag, setting_text(setting, now));
    return line;
}

}  // namespace halflit::engine
