// A page of text and pictures as SVG. Self-contained: no style sheet, script, font file or id, so that it stands alone as well as inline in
// HTML beside others.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include "apps/engine/basics/base64.hpp"
#include "apps/engine/basics/xml_text.hpp"
#include "apps/halflit/program/engine.hpp"

namespace halflit::cli {

/// Style of a line of text. `anchor`: start, middle or end.
struct TextStyle {
    double size = 12;
    const char* anchor = "start";
    bool bold = false;
    const char* color = "#222";
    double turn_deg = 0;
};

/// A line of text whose content is SVG already; y is the baseline.
[[nodiscard]] std::string text_element(double x, double y, std::string_view svg_content, const TextStyle& style);

/// Estimated width in pixels, larger than in most fonts, because the viewer's font is not known.
[[nodiscard]] double text_width(std::string_view text, double size);

/// A page under construction. Positions are in pixels from the top left.
class SvgPage {
public:
    /// Text may have the marks of rich_text.hpp.
    void text(double x, double y, std::string_view line, const TextStyle& style = {});
    /// Adds such text broken into lines of at most `width`; returns its height. y is the upper edge.
    double paragraph(double x, double y, double width, std::string_view text, const TextStyle& style = {});
    /// Adds a picture, the bytes of a PNG file, scaled to the box.
    void png(double x, double y, double width, double height, std::span<const std::uint8_t> bytes);
    /// Adds finished SVG elements.
    void svg(std::string_view elements) { body_ += elements; }

    /// The whole document; `title` is for screen readers.
    [[nodiscard]] std::string finish(double width, double height, std::string_view title) const;

private:
    std::string body_;
};

}  // namespace halflit::cli
