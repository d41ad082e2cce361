#include "apps/engine/pictures/sheet_page.hpp"

#include "halflit/image.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/srgb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace halflit::engine {
namespace {

constexpr Color kPage{0x1f, 0x22, 0x27}, kErrorPage{0x3a, 0x20, 0x20}, kErrorText{0xff, 0xb0, 0xa0}, kNoteText{0xa8, 0xae, 0xb8};
constexpr int kBaseLine = 14;  // from the top of a line of text, pixels

/// Part of a source line that one pixel of a smaller line covers.
struct Span {
    int first;
    std::vector<float> weights;  ///< sum 1
};

std::vector<Span> spans(int from, int to) {
    std::vector<Span> out;
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double begin = i * step, end = (i + 1) * step;
        Span span{static_cast<int>(begin), {}};
        for (int k = span.first; k < from && k < end; ++k)
            span.weights.push_back(static_cast<float>((std::min<double>(end, k + 1) - std::max<double>(begin, k)) / step));
        out.push_back(std::move(span));
    }
    return out;
}

/// Light times alpha, and alpha, of each pixel.
std::vector<std::array<float, 4>> light_of(const Image& picture) {
    static const auto linear = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<float>(shading::linear_from_srgb(static_cast<double>(i) / 255.0));
        return values;
    }();
    std::vector<std::array<float, 4>> light(picture.rgba8.size() / 4);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const std::uint8_t* p = &picture.rgba8[4 * i];
        const float alpha = static_cast<float>(p[3]) / 255.0f;
        light[i] = {linear[p[0]] * alpha, linear[p[1]] * alpha, linear[p[2]] * alpha, alpha};
    }
    return light;
}

std::vector<std::uint8_t> codes_of(const std::vector<std::array<float, 4>>& light) {
    const auto isa = default_isa();
    const shading::ShadeKernels& kernels = shading::shade_kernels(isa ? *isa : Isa::scalar);
    const std::size_t padded = (light.size() + 15) / 16 * 16;
    std::vector<float> rows[4];
    for (auto& row : rows) row.resize(padded);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const float alpha = light[i][3];
        for (std::size_t c = 0; c < 3; ++c) rows[c][i] = alpha > 0.0f ? light[i][c] / alpha : 0.0f;
        rows[3][i] = alpha;
    }
    std::vector<std::uint32_t> packed(padded);
    kernels.encode_srgb8(rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data(), 1.0f, packed.data(),
                         static_cast<int>(light.size()));
    std::vector<std::uint8_t> codes(4 * light.size());
    std::memcpy(codes.data(), packed.data(), codes.size());
    return codes;
}

}  // namespace

Result<SheetLayout> sheet_layout(SheetLayout cells, std::size_t count, int columns) {
    const auto most = static_cast<int>(std::clamp<std::size_t>(count, 1, kMaxImagePixels));
    const auto rows_of = [&](int n) { return (most - 1) / n + 1; };
    if (columns == 0)
        for (columns = 1; columns < most; ++columns) {
            cells.columns = columns, cells.rows = rows_of(columns);
            if (2 * cells.width() >= 3 * cells.height()) break;
        }
    cells.columns = std::min(columns, most);
    cells.rows = rows_of(cells.columns);
    if (cells.width() > kMaxImagePixels / cells.height())
        return fail(ErrorCode::limit, fmt::format("a sheet of {}x{} is more than 2^28 pixels", cells.width(), cells.height()));
    return cells;
}

Image scaled_to_fit(const Image& picture, PictureSize size) {
    if (picture.width <= size.width && picture.height <= size.height) return picture;
    const double factor = std::min(static_cast<double>(size.width) / picture.width, static_cast<double>(size.height) / picture.height);
    const auto side = [factor](int pixels, int most) { return std::clamp(static_cast<int>(pixels * factor + 0.5), 1, most); };
    const int width = side(picture.width, size.width), height = side(picture.height, size.height);
    const std::vector<std::array<float, 4>> light = light_of(picture);
    const std::vector<Span> across = spans(picture.width, width), down = spans(picture.height, height);
    std::vector<std::array<float, 4>> narrow(static_cast<std::size_t>(width) * static_cast<std::size_t>(picture.height));
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < width; ++x) {
            const Span& span = across[static_cast<std::size_t>(x)];
            const auto* from = &light[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width)] + span.first;
            auto& to = narrow[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
            for (std::size_t k = 0; k < span.weights.size(); ++k)
                for (std::size_t c = 0; c < 4; ++c) to[c] += span.weights[k] * from[k][c];
        }
    std::vector<std::array<float, 4>> small(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
        const Span& span = down[static_cast<std::size_t>(y)];
        for (std::size_t k = 0; k < span.weights.size(); ++k)
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
                const auto& from = narrow[(static_cast<std::size_t>(span.first) + k) * static_cast<std::size_t>(width) + x];
                auto& to = small[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x];
                for (std::size_t c = 0; c < 4; ++c) to[c] += span.weights[k] * from[c];
            }
    }
    return {width, height, codes_of(small), {}};
}

std::vector<std::string> name_lines(const std::string& name, int cell_width) {
    return wrapped_lines(name, kTextSize, cell_width, 2, Cut::middle);
}

SheetPage::SheetPage(const SheetLayout& layout)
    : layout_(layout), canvas_(static_cast<int>(layout.width()), static_cast<int>(layout.height()), kPage) {}

void SheetPage::add_picture(std::size_t cell, const Image& picture, bool is_reference) {
    const int x = layout_.x_of(cell) + (is_reference ? layout_.picture.width + SheetLayout::kGap : 0);
    canvas_.put(x + (layout_.picture.width - picture.width) / 2, layout_.y_of(cell) + (layout_.picture.height - picture.height) / 2,
                picture);
}

void SheetPage::add_error(std::size_t cell, const std::string& message) {
    constexpr int kInset = 6;
    const double x = layout_.x_of(cell), y = layout_.y_of(cell);
    canvas_.fill_box({x, y}, layout_.picture.width, layout_.picture.height, kErrorPage);
    const auto most = static_cast<std::size_t>(std::max(0, layout_.picture.height - 2 * kInset) / SheetLayout::kLine);
    double base = y + kInset + kBaseLine;
    for (const std::string& line : wrapped_lines(message, kSmallTextSize, layout_.picture.width - 2 * kInset, most, Cut::end)) {
        draw_text(canvas_, {x + kInset, base}, line, {kSmallTextSize, kErrorText});
        base += SheetLayout::kLine;
    }
}

void SheetPage::add_title(std::size_t cell, const std::string& title, const std::string& note) {
    const double x = layout_.x_of(cell), width = layout_.cell_width(), base = layout_.y_of(cell) - layout_.above() + kBaseLine;
    const std::string shown_note = cut_to_width(note, kSmallTextSize, width / 2, Cut::end);
    draw_text(canvas_, {x + width, base}, shown_note, {kSmallTextSize, kNoteText, Align::right});
    const double note_width = shown_note.empty() ? 0 : width_of_text(shown_note, kSmallTextSize) + SheetLayout::kGap;
    draw_text(canvas_, {x, base}, cut_to_width(title, kTextSize, width - note_width, Cut::middle), {});
}

void SheetPage::add_lines(std::size_t cell, const std::vector<std::string>& lines, Align align) {
    const int width = layout_.cell_width();
    const double share = align == Align::left ? 0 : align == Align::middle ? 0.5 : 1;
    Point at{layout_.x_of(cell) + share * width,
             static_cast<double>(layout_.y_of(cell) + layout_.picture.height + SheetLayout::kAbove + kBaseLine)};
    for (std::size_t i = 0; i < lines.size() && i < static_cast<std::size_t>(layout_.lines); ++i, at.y += SheetLayout::kLine)
        draw_text(canvas_, at, cut_to_width(lines[i], kTextSize, width, Cut::end), {.align = align});
}

void SheetPage::add_footer(const std::string& text) {
    const int width = canvas_.image().width - 2 * SheetLayout::kGap;
    draw_text(canvas_, {double{SheetLayout::kGap}, static_cast<double>(canvas_.image().height - SheetLayout::kGap)},
              cut_to_width(text, kSmallTextSize, width, Cut::end), {kSmallTextSize, kNoteText});
}

Result<Image> lay_out(std::span<const SheetCell> cells, int columns, const std::string& footer, std::vector<VectorShape>* shapes) {
    SheetLayout shape{.lines = 0, .footer = !footer.empty()};
    for (const SheetCell& cell : cells) {
        shape.picture = {std::max(shape.picture.width, cell.picture.width), std::max(shape.picture.height, cell.picture.height)};
        shape.titles = shape.titles || !cell.title.empty() || !cell.note.empty();
        shape.lines = std::max(shape.lines, static_cast<int>(cell.lines.size()));
    }
    const auto layout = sheet_layout(shape, cells.size(), columns);
    if (!layout) return tl::unexpected(layout.error());
    SheetPage page(*layout);
    page.record(shapes);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        page.add_title(i, cells[i].title, cells[i].note);
        page.add_picture(i, cells[i].picture, false);
        page.add_lines(i, cells[i].lines, Align::left);
    }
    page.add_footer(footer);
    if (shapes == nullptr) return page.image();
    for (VectorShape& text : *shapes) text.color = {};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Image& picture = cells[i].picture;
        const Point corner{layout->x_of(i) + (layout->picture.width - picture.width) / 2.0,
                           layout->y_of(i) + (layout->picture.height - picture.height) / 2.0};
        for (VectorShape moved : cells[i].shapes) {
            for (Contour& contour : moved.contours)
                for (Point& p : contour) p = p + corner;
            shapes->push_back(std::move(moved));
        }
    }
    return page.image();
}

}  // namespace halflit::engine
