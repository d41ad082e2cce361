// The schemas of docs/schema, which the program holds as its build found them.
#pragma once

#include "apps/halflit/report/run_report.hpp"

#include <string_view>

namespace halflit::cli {

/// A schema that refers to no other file. `place` is a file of docs/schema, "look-1.schema.json", or a place in it,
/// "report-1.schema.json#/$defs/picture". What it refers to becomes part of its "$defs". Its type is object. Requires: there is that place.
[[nodiscard]] Json whole_schema(std::string_view place);

}  // namespace halflit::cli
