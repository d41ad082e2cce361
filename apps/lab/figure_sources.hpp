// The literature that figures name by keys such as [SNY11]; the same entries as in sh/README.md.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::cli {

struct FigureSource {
    const char* key;   ///< with brackets
    const char* text;  ///< authors, title, place and year
};

/// The sources whose keys occur in the text, in the order of their first occurrence.
[[nodiscard]] std::vector<FigureSource> sources_in(std::string_view text);

}  // namespace halflit::cli
