#include "apps/lab/rich_text.hpp"

#include "apps/lab/svg_page.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr double kScale = 0.72;  ///< font size of raised and lowered parts
constexpr double kRaise = 0.38, kLower = 0.22;

/// Calls plain(text) and part(sign, text) in order; `sign` is '^' or '_'.
template <class Plain, class Part>
void split(std::string_view text, const Plain& plain, const Part& part) {
    while (!text.empty()) {
        const std::size_t at = std::min(text.find("^{"), text.find("_{"));
        const std::size_t end = at == std::string_view::npos ? at : text.find('}', at);
        if (end == std::string_view::npos) return plain(text);
        if (at > 0) plain(text.substr(0, at));
        part(text[at], text.substr(at + 2, end - at - 2));
        text.remove_prefix(end + 1);
    }
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
    std::string result;
    for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from)) {
        result.append(text.substr(0, at)).append(to);
        text.remove_prefix(at + from.size());
    }
    return result.append(text);
}

}  // namespace

std::string rich_svg(std::string_view text, double size) {
    std::string svg;
    double shift = 0;  // of the baseline, to be taken back by what follows
    const auto add = [&](std::string_view content, double font_size, double to) {
        if (to == shift && to == 0) {
            svg += xml_escaped(content);
            return;
        }
        // Some viewers drop a space at the start of an element; between elements it is kept.
        for (; content.starts_with(' '); content.remove_prefix(1)) svg += ' ';
        if (content.empty()) return;
        svg += fmt::format("<tspan dy=\"{:.2f}\" font-size=\"{:g}\">{}</tspan>", to - shift, font_size, xml_escaped(content));
        shift = to;
    };
    split(
        text, [&](std::string_view plain) { add(plain, size, 0); },
        [&](char sign, std::string_view part) { add(part, kScale * size, sign == '^' ? -kRaise * size : kLower * size); });
    return svg;
}

std::string rich_html(std::string_view text) {
    std::string html;
    split(
        text, [&](std::string_view plain) { html += xml_escaped(plain); },
        [&](char sign, std::string_view part) {
            const char* element = sign == '^' ? "sup" : "sub";
            html += fmt::format("<{0}>{1}</{0}>", element, xml_escaped(part));
        });
    return html;
}

std::string rich_plain(std::string_view text) {
    std::string plain_text;
    split(
        text, [&](std::string_view plain) { plain_text += plain; },
        [&](char sign, std::string_view part) {
            const bool one_word = part.find_first_of("+-*/ ") == std::string_view::npos;
            plain_text += fmt::format(fmt::runtime(one_word ? "{}{}" : "{}({})"), sign, part);
        });
    return replaced(replaced(plain_text, "\u2212", "-"), "\u00b7", ".");
}

}  // namespace halflit::cli
