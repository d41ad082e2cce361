// The flags of a picture as JSON, from which the package's build makes the names of options and their types.
#pragma once

#include <string>

namespace halflit::web {

/// {"version", "pixel_epoch", "flags": [{"names", "form", "help", "group", "number", "repeated"}, ...]}: those that mean something to the
/// module.
[[nodiscard]] std::string flag_table();

}  // namespace halflit::web
