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
    return fmt::format("{}", fmt::join(setting.values.of_flag().list, "|"));
}

/// The help, with the range and the default.
std::string help_of(const Setting& setting, const Settings& defaults) {
    std::string help(setting.help);
    const SettingValues values = setting.values.of_flag();
    const bool ranged = values.kind != SettingValues::Kind::named && values.list.empty() && values.high < 1e18 && values.zero.empty();
    if (ranged) help.insert(std::min(help.find(" (default"), help.size()), ", " + values.expected());
    if (help.find("default") == std::string::npos && !setting.values.zero_too)
        help += fmt::format(" (default {})", setting_text(setting, defaults));
    return help;
}

}  // namespace

Result<double> read_value(const SettingValues& values, const std::string& text) {
    double value = -1.0;
    if (values.kind == SettingValues::Kind::named) {
        const auto found = std::find(values.names.begin(), values.names.end(), text);
        if (found == values.names.end()) {
            const std::vector<std::string> names(values.names.begin(), values.names.end());
            return fail(ErrorCode::usage,
                        fmt::format("expected one of {}, found '{}'{}", joined(names, ", "), text, did_you_mean(text, names)));
        }
        value = static_cast<double>(found - values.names.begin());
    } else if (!values.zero.empty() && text == values.zero) {
        value = 0.0;
    } else if (!values.one.empty() && text == values.one) {
        value = 1.0;
    } else {
        constexpr float kMost = 3e38f;
        const auto number = values.kind == SettingValues::Kind::whole
                                ? parse_int(text, 0, 1 << 30).map([](std::int64_t whole) { return static_cast<double>(whole); })
                                : parse_float(text, -kMost, kMost).map([](float x) { return static_cast<double>(x); });
        value = number ? *number * values.unit : -1.0;
        if (!number || !values.word(value).empty() || !values.contains(value))
            return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'", values.expected(), text));
    }
    return value;
}

std::string setting_text(const Setting& setting, const Settings& settings) {
    const double value = setting.get(settings);
    if (setting.values.kind == SettingValues::Kind::named) return std::string(setting.values.names[static_cast<std::size_t>(value)]);
    if (const std::string_view word = setting.values.word(value); !word.empty()) return std::string(word);
    return fmt::format("{}", static_cast<float>(value / setting.values.unit));
}

void add_setting_flags(FlagGroup& group, Settings& settings, std::vector<std::string_view>& given) {
    for (const Setting& setting : raster::kSettings)
        if (setting.group == group.title && !setting.flag.empty())
            group.flags.push_back({std::string(setting.flag), form_of(setting), help_of(setting, settings),
                                   [&settings, &given, &setting](const std::string& text) {
                                       given.push_back(setting.name);
                                       const auto value = read_value(setting.values.of_flag(), text);
                                       if (value) setting.set(settings, *value);
                                       return value.map([](double) {});
                                   }});
}

std::string differing_flags(const Settings& now, const Settings& started) {
    std::string line;
    for (const Setting& setting : raster::kSettings)
        if (!setting.flag.empty() && setting.get(now) != setting.get(started))
            line += fmt::format(" {} {}", setting.flag, setting_text(setting, now));
    return line;
}

}  // namespace halflit::engine
