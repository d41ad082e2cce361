// Flags of the settings in raster/settings_table.def.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "halflit/settings.hpp"
#include "raster/settings_table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// Adds the flags of a group to it. `settings` has the defaults and takes the values, `given` the names of settings whose flags were given;
/// both must outlive them.
void add_setting_flags(FlagGroup& group, Settings& settings, std::vector<std::string_view>& given);

/// The number that a flag's text stands for.
[[nodiscard]] Result<double> read_value(const raster::SettingValues& values, const std::string& text);

/// Reads a setting by its name in C and Python. Numbers are in the setting's own unit. Fails (usage) with the name at its begin.
[[nodiscard]] Result<void> read_setting(Settings& settings, std::string_view name, const std::string& text);

/// " --flag value" of each setting that differs, but for those without a flag.
[[nodiscard]] std::string differing_flags(const Settings& now, const Settings& started);

}  // namespace halflit::engine
