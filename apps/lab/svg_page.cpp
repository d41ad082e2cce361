#include "apps/lab/svg_page.hpp"

#include "apps/engine/basics/base64.hpp"
#include "apps/lab/rich_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr const char* kFont = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

}  // namespace

double text_width(std::string_view text, double size) {
    const std::string shown = rich_plain(text);
    const auto characters =
        std::count_if(shown.begin(), shown.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    return 0.53 * size * static_cast<double>(characters);
}

std::string text_element(double x, double y, std::string_view svg_content, const TextStyle& style) {
    const std::string turn = style.turn_deg == 0 ? "" : fmt::format(" transform=\"rotate({:g} {:.2f} {:.2f})\"", style.turn_deg, x, y);
    const std::string anchor = std::string_view(style.anchor) == "start" ? "" : fmt::format(" text-anchor=\"{}\"", style.anchor);
    return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" fill=\"{}\"{}{}{}>{}</text>\n", x, y, style.size, style.color,
                       anchor, style.bold ? " font-weight=\"bold\"" : "", turn, svg_content);
}

void SvgPage::text(double x, double y, std::string_view line, const TextStyle& style) {
    body_ += text_element(x, y, rich_svg(line, style.size), style);
}

double SvgPage::paragraph(double x, double y, double width, std::string_view text, const TextStyle& style) {
    const double leading = 1.4 * style.size;
    double baseline = y + style.size;
    std::string line;
    const auto end_line = [&] {
        body_ += text_element(x, baseline, rich_svg(line, style.size), style);
        baseline += leading;
        line.clear();
    };
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (!line.empty() && text_width(line, style.size) + text_width(word, style.size) + style.size / 2 > width) end_line();
        if (!line.empty()) line += ' ';
        line += word;
    }
    if (!line.empty()) end_line();
    return baseline - y - style.size;
}

void SvgPage::png(double x, double y, double width, double height, std::span<const std::uint8_t> bytes) {
    body_ += fmt::format("<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" xlink:href=\"data:image/png;base64,{}\"/>\n",
                         x, y, width, height, base64(bytes));
}

std::string SvgPage::finish(double width, double height, std::string_view title) const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{0:g}\" height=\"{1:g}\" "
        "viewBox=\"0 0 {0:g} {1:g}\" font-family=\"{2}\">\n<title>{3}</title>\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"white\"/>\n{4}</svg>\n",
        std::ceil(width), std::ceil(height), kFont, xml_escaped(rich_plain(title)), body_);
}

}  // namespace halflit::cli
