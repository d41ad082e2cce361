// Labels and captions with superscripts and subscripts: "x^{2}" and "f_{3}". All other text is shown as it is, in UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace halflit::cli {

/// Content of an SVG text element of this font size: escaped, with raised and lowered parts.
[[nodiscard]] std::string rich_svg(std::string_view text, double size);

/// HTML: escaped, with <sup> and <sub>.
[[nodiscard]] std::string rich_html(std::string_view text);

/// Text for CSV files and attributes: "x^2", "f_3", "x^(1+a)", and ASCII signs for the minus and the dot product.
[[nodiscard]] std::string rich_plain(std::string_view text);

}  // namespace halflit::cli
