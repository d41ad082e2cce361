#include "apps/halflit/report/sheet_page.hpp"

#include "apps/halflit/report/line_text.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace halflit::cli {
namespace {

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

SheetLayout sheet_layout(std::size_t count, PictureSize picture, bool references, int columns) {
    SheetLayout layout{picture, references};
    const auto cells = static_cast<int>(count);
    const auto rows_of = [&](int n) { return (cells + n - 1) / n; };
    if (columns == 0)
        for (columns = 1; columns < cells; ++columns) {
            layout.columns = columns, layout.rows = rows_of(columns);
            if (2 * layout.width() >= 3 * layout.height()) break;
        }
    layout.columns = std::min(columns, std::max(cells, 1));
    layout.rows = rows_of(layout.columns);
    return layout;
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

SheetPage::SheetPage(const SheetLayout& layout) : layout_(layout) {
    image_.width = static_cast<int>(layout.width());
    image_.height = static_cast<int>(layout.height());
    image_.rgba8.assign(4 * static_cast<std::size_t>(layout.width()) * static_cast<std::size_t>(layout.height()), 255);
    fill(0, 0, image_.width, image_.height, {0x1f, 0x22, 0x27});
}

void SheetPage::fill(int x, int y, int width, int height, Color color) {
    const int x1 = std::min(x + width, image_.width), y1 = std::min(y + height, image_.height);
    for (int row = std::max(y, 0); row < y1; ++row)
        for (int column = std::max(x, 0); column < x1; ++column) {
            std::uint8_t* p = &image_.rgba8[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                                                 static_cast<std::size_t>(column))];
            p[0] = color.r, p[1] = color.g, p[2] = color.b;
        }
}

void SheetPage::write(int x, int y, const std::string& text, int scale, Color color) {
    for (const TextBar& bar : text_bars(text)) fill(x + scale * bar.x, y + scale * bar.y, scale * bar.width, scale * bar.height, color);
}

void SheetPage::add_picture(std::size_t cell, const Image& picture, bool is_reference) {
    const int place_x = layout_.x_of(cell) + (is_reference ? layout_.picture.width + SheetLayout::kGap : 0);
    const int x0 = place_x + (layout_.picture.width - picture.width) / 2;
    const int y0 = layout_.y_of(cell) + (layout_.picture.height - picture.height) / 2;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::uint8_t* from =
                &picture.rgba8[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x))];
            std::uint8_t* to = &image_.rgba8[4 * (static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(image_.width) +
                                                  static_cast<std::size_t>(x0 + x))];
            const unsigned alpha = from[3];
            for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>((from[c] * alpha + to[c] * (255u - alpha) + 127u) / 255u);
        }
}

void SheetPage::add_error(std::size_t cell, const std::string& message) {
    constexpr int kInset = 6;
    const int x = layout_.x_of(cell), y = layout_.y_of(cell);
    fill(x, y, layout_.picture.width, layout_.picture.height, {0x3a, 0x20, 0x20});
    const int lines = (layout_.picture.height - 2 * kInset) / kTextHeight;
    int line = 0;
    for (const std::string& text : wrapped_lines(message, layout_.picture.width - 2 * kInset)) {
        if (line == lines) break;
        write(x + kInset, y + kInset + kTextHeight * line++, text, 1, {0xff, 0xb0, 0xa0});
    }
}

void SheetPage::add_name(std::size_t cell, const std::string& name) {
    const int width = layout_.cell_width(), scale = 2 * text_width(name) <= width ? 2 : 1;
    const std::string shown = cut_to_width(name, width / scale);
    const int x = layout_.x_of(cell) + (width - scale * text_width(shown)) / 2;
    write(x, layout_.y_of(cell) + layout_.picture.height + (scale == 2 ? 3 : 7), shown, scale, {0xe6, 0xe6, 0xe6});
}

}  // namespace halflit::cli
