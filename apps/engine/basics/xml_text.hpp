// Text inside of XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace halflit::engine {

/// Text escaped for the inside of an element or attribute.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace halflit::engine
