// References inside a glTF file: relative names, percent-encoded or plain, and data: URIs with base64.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a data: URI, base64 or percent-encoded. Every character must be valid; padding may be left out. mended: if not null, base64
/// may have white space and percent sequences in it, and it becomes true for that.
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri, std::size_t max_bytes, bool* mended = nullptr);

/// The file name that a relative reference means: percent sequences decoded once, other characters (also spaces) as they are.
/// Refused: schemes ("http:", "file:"), a broken percent sequence, a zero byte. tolerant: the path of "file:" and one with a drive ("C:")
/// are names too, as they are of another computer, and a broken percent sequence is a part of the name.
Result<std::string> decode_file_uri(std::string_view uri, bool tolerant = false);

}  // namespace halflit::io::detail
