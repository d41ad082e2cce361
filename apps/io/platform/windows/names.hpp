// Names that a model may give for its files.
#pragma once

#include <string_view>

namespace halflit::platform {

/// Why Windows could take one part of a name, between two '/', for something else than an entry of the folder; empty: it does not.
[[nodiscard]] std::string_view fault_of_part(std::string_view part);
/// The first of a name's parts that has one. Tests on other systems link it beside their own fault_of_name.
[[nodiscard]] std::string_view fault_of_parts(std::string_view name);

}  // namespace halflit::platform
