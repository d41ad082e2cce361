// The page of a contact sheet: pictures in a grid, with names below them.
#pragma once

#include "apps/halflit/flags/values.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace halflit::cli {

/// Places of the cells. A cell has a picture, and beside it a reference if any cell has one; its name is below.
struct SheetLayout {
    PictureSize picture;      ///< largest size of a picture
    bool references = false;  ///< cells have room for two pictures
    int columns = 1, rows = 1;

    static constexpr int kGap = 8;     ///< around cells, and between a picture and its reference, pixels
    static constexpr int kLabel = 22;  ///< height of a name, pixels

    [[nodiscard]] int cell_width() const { return references ? 2 * picture.width + kGap : picture.width; }
    [[nodiscard]] std::int64_t width() const { return kGap + std::int64_t{columns} * (cell_width() + kGap); }
    [[nodiscard]] std::int64_t height() const { return kGap + std::int64_t{rows} * (picture.height + kLabel + kGap); }
    /// Upper left corner of cell i, counted row by row.
    [[nodiscard]] int x_of(std::size_t i) const { return kGap + static_cast<int>(i) % columns * (cell_width() + kGap); }
    [[nodiscard]] int y_of(std::size_t i) const { return kGap + static_cast<int>(i) / columns * (picture.height + kLabel + kGap); }
};

/// The layout of `count` cells; columns 0: as many as give a page about half as wide again as it is high.
[[nodiscard]] SheetLayout sheet_layout(std::size_t count, PictureSize picture, bool references, int columns);

/// A picture of at most this size: larger ones are scaled by the mean over each pixel's area, in linear light. The aspect ratio stays.
[[nodiscard]] Image scaled_to_fit(const Image& picture, PictureSize size);

class SheetPage {
public:
    explicit SheetPage(const SheetLayout& layout);

    /// Puts a picture, at most layout.picture in size, in the middle of its place.
    void add_picture(std::size_t cell, const Image& picture, bool is_reference);
    /// Fills the picture's place with a message.
    void add_error(std::size_t cell, const std::string& message);
    void add_name(std::size_t cell, const std::string& name);

    [[nodiscard]] const Image& image() const { return image_; }

private:
    struct Color {
        std::uint8_t r, g, b;
    };
    void fill(int x, int y, int width, int height, Color color);
    /// Writes one line; `scale` is the width of a stroke in pixels.
    void write(int x, int y, const std::string& text, int scale, Color color);

    SheetLayout layout_;
    Image image_;
};

}  // namespace halflit::cli
