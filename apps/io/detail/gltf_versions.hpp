// Which glTF files this loader is for: the version, and the extensions that a file may require.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Throws JsonFault (without an offset) for another major version, a minimum above 2.0, or a required extension that is not supported.
/// A later minor version without a minimum loads: it promises that a 2.0 reader can draw it.
void check_versions(std::string_view version_text, std::string_view min_version_text, const std::vector<std::string>& extensions_required);

}  // namespace halflit::io::detail
