// Pages of reports in HTML: their common style. A page that holds its pictures needs no other file.
#pragma once

#include "halflit/error.hpp"
#include "halflit/target.hpp"

#include <string>

namespace halflit::engine {

/// From <!DOCTYPE> to the headline. program: "halflit golden", the first words of the window's title. style: rules of this page alone.
[[nodiscard]] std::string page_head(const std::string& program, const std::string& title, const std::string& style);
inline constexpr const char* kPageEnd = "</body>\n</html>\n";

/// A picture inside the page, as a data: URL, with its caption. Fails where a PNG cannot be made.
[[nodiscard]] Result<std::string> embedded_figure(const Image& picture, const std::string& caption);

/// Text for the inside of an element: names from files cannot end it, nor control a terminal.
[[nodiscard]] std::string page_text(const std::string& text);

}  // namespace halflit::engine
