// The JSON part of a model: scanned once, checked against the schema on the way, and put into a file::File.
#pragma once

#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/file/file.hpp"
#include "apps/io/gltf/file/notes.hpp"
#include "apps/io/gltf/text/json_scan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// `text` must outlive the result, whose names point into it, and begins after its byte order mark. Faults of elements go to `notes`;
/// the values that they concern have their defaults. No index is out of range. Unless `strict`, keys that are there twice go to
/// `notes.twins`: the result is then not checked, and the text is to be read again without them.
/// Throws LoadFailure for other faults, with path, line and column. Takes the memory of all objects from `memory`.
file::File read_gltf_json(std::string_view text, const JsonScanLimits& limits, Budget memory, Notes& notes, bool strict);

/// The JSON text without what glTF forbids before and after it: a byte order mark, which is warned of, or if strict refused, and zeros.
std::string_view trimmed(std::string_view text, std::vector<std::string>& warnings, bool strict);

/// A failure with path, line and column of `offset`.
[[nodiscard]] LoadFailure failure_at(std::string_view text, const JsonScanLimits& limits, std::size_t offset, std::string_view what,
                                     ErrorCode code);

}  // namespace halflit::io::detail
