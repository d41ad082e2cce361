// The JSON part of a model: scanned once, checked against the schema on the way, and put into a file::File.
#pragma once

#include "apps/io/detail/gltf_file.hpp"
#include "apps/io/detail/json_scan.hpp"
#include "apps/io/detail/load_failure.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// `text` must outlive the result, whose names point into it. Faults name path, line and column; no message has a file prefix.
/// Throws LoadFailure. Takes the memory of all objects from `memory`.
file::File read_gltf_json(std::string_view text, const JsonScanLimits& limits, Budget memory, std::vector<std::string>& warnings);

}  // namespace halflit::io::detail
