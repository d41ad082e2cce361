// A page of pictures in a grid, with text: the contact sheet of `halflit sheet`, and pages of labelled cells for other commands.
#pragma once

#include "apps/engine/pictures/canvas.hpp"
#include "apps/engine/pictures/lettering.hpp"
#include "apps/engine/request/values.hpp"
#include "halflit/error.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::engine {

/// Places of the cells. A cell has a title, a picture, beside it a reference if any cell has one, and lines of text below.
struct SheetLayout {
    PictureSize picture{};    ///< largest size of a picture
    bool references = false;  ///< cells have room for two pictures
    bool titles = false;      ///< cells have a title above the picture
    int lines = 1;            ///< of text below the picture
    bool footer = false;      ///< the page has a line of text at its end
    int columns = 1, rows = 1;

    static constexpr int kGap = 8;    ///< around cells, and between a picture and its reference, pixels
    static constexpr int kLine = 18;  ///< height of a line of text, pixels
    static constexpr int kAbove = 4;  ///< pixels above the lines of text
    static constexpr int kLabel = kAbove + kLine;

    [[nodiscard]] int cell_width() const { return references ? 2 * picture.width + kGap : picture.width; }
    [[nodiscard]] int above() const { return titles ? kLabel : 0; }
    [[nodiscard]] int cell_height() const { return above() + picture.height + (lines > 0 ? kAbove + lines * kLine : 0); }
    [[nodiscard]] std::int64_t width() const { return kGap + std::int64_t{columns} * (cell_width() + kGap); }
    [[nodiscard]] std::int64_t height() const { return kGap + std::int64_t{rows} * (cell_height() + kGap) + (footer ? kLabel : 0); }
    /// Upper left corner of the picture of cell i, counted row by row.
    [[nodiscard]] int x_of(std::size_t i) const { return kGap + static_cast<int>(i) % columns * (cell_width() + kGap); }
    [[nodiscard]] int y_of(std::size_t i) const { return kGap + static_cast<int>(i) / columns * (cell_height() + kGap) + above(); }
};

/// A layout with columns and rows for `count` cells. columns 0: as many as give a page about half as wide again as it is high. Fails if the
/// page has more than kMaxImagePixels.
[[nodiscard]] Result<SheetLayout> sheet_layout(SheetLayout cells, std::size_t count, int columns);

/// A picture of at most this size: larger ones are scaled by the mean over each pixel's area, in linear light. The aspect ratio stays.
[[nodiscard]] Image scaled_to_fit(const Image& picture, PictureSize size);

/// The lines of a name below a picture: two at most, with an ellipsis in the middle of the second if it is longer.
[[nodiscard]] std::vector<std::string> name_lines(const std::string& name, int cell_width);

class SheetPage {
public:
    explicit SheetPage(const SheetLayout& layout);

    /// Puts a picture, at most layout.picture in size, in the middle of its place.
    void add_picture(std::size_t cell, const Image& picture, bool is_reference);
    /// Fills the picture's place with a message.
    void add_error(std::size_t cell, const std::string& message);
    /// Above the picture: a title on the left, and on the right a note, which takes at most half of the width.
    void add_title(std::size_t cell, const std::string& title, const std::string& note);
    /// Below the picture; lines that are wider than the cell are cut. Lines past layout.lines are left out.
    void add_lines(std::size_t cell, const std::vector<std::string>& lines, Align align);
    void add_footer(const std::string& text);

    /// From now on, texts are written into a list too, in black; null: no more.
    void record(std::vector<VectorShape>* shapes) { canvas_.record(shapes); }

    [[nodiscard]] const Image& image() const { return canvas_.image(); }

private:
    SheetLayout layout_;
    Canvas canvas_;
};

struct SheetCell {
    std::string title, note;  ///< above the picture, on the left and on the right; of all cells or of none
    Image picture;
    std::vector<std::string> lines;     ///< below it
    std::vector<VectorShape> shapes{};  ///< what the picture shows, in its pixels
};
/// A page of cells. All have the size of the largest picture and the most lines. columns 0: chosen, as by sheet_layout. shapes: gets those
/// of the cells and the texts, in pixels of the page, for black on white; null: they are not wanted.
[[nodiscard]] Result<Image> lay_out(std::span<const SheetCell> cells, int columns, const std::string& footer,
                                    std::vector<VectorShape>* shapes = nullptr);

}  // namespace halflit::engine
