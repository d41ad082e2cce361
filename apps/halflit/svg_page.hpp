// A page of text and pictures as SVG. Self-contained: no style sheet, script, font file or id, so that it stands alone as well as inline in
// HTML beside others.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halflit::cli {

/// Text for the inside of an element or attribute.
[[nodiscard]] std::string xml_escaped(std::string_view text);

/// Bytes for a data: address.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// How text is set. `anchor`: start, middle or end.
struct TextStyle {
    double size = 12;
    const char* anchor = "start";
    bool bold = false;
    const char* color = "#222";
    double turn_deg = 0;
};

/// A line of text whose content is SVG already; y is the baseline.
[[nodiscard]] std::string text_element(double x, double y, std::string_view svg_content, const TextStyle& style);

/// Wider than most fonts set it, because the viewer's font is not known.
[[nodiscard]] double text_width(std::string_view text, double size);

/// A page that things are put on, from the top left, in pixels.
class SvgPage {
public:
    void text(double x, double y, std::string_view line, const TextStyle& style = {});
    /// Text broken into lines of at most `width`; returns the height that it took. y is the upper edge.
    double paragraph(double x, double y, double width, std::string_view text, const TextStyle& style = {});
    /// A PNG file's bytes, scaled to the box.
    void png(double x, double y, double width, double height, std::span<const std::uint8_t> bytes);
    /// Finished SVG elements.
    void svg(std::string_view elements) { body_ += elements; }

    /// The whole document; `title` is what a screen reader says.
    [[nodiscard]] std::string finish(double width, double height, std::string_view title) const;

private:
    std::string body_;
};

}  // namespace halflit::cli
