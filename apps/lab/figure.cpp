#include "apps/lab/figure.hpp"

#include "apps/lab/figure_sources.hpp"
#include "apps/lab/rich_text.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr double kMargin = 24, kGap = 8, kRowLabel = 96, kColumnLabel = 22, kSectionTitle = 26, kPartGap = 18, kCaptionGap = 6,
                 kMinWidth = 720;
constexpr int kSheetGap = 8;  ///< pixels between the pictures of a PNG sheet

double label_width(const PictureGrid& grid) {
    const bool any = std::any_of(grid.rows.begin(), grid.rows.end(), [](const std::string& row) { return !row.empty(); });
    return any ? kRowLabel : 0;
}

double width_of(const PictureGrid& grid) {
    return label_width(grid) + static_cast<double>(grid.columns.size()) * (grid.width + kGap) - kGap;
}

double width_of(const PlotRow& plots) {
    double width = 0;
    for (const Plot& plot : plots) width += plot.width;
    return width;
}

double picture_height(const PictureGrid& grid) {
    const Image& first = grid.pictures.front();
    return grid.width * first.height / first.width;
}

/// Row labels may have several lines.
void add_row_label(SvgPage& page, double x, double middle, const std::string& label) {
    const auto lines = static_cast<double>(1 + std::count(label.begin(), label.end(), '\n'));
    double y = middle - 7.5 * lines + 11;
    for (std::size_t start = 0; start <= label.size();) {
        const std::size_t end = std::min(label.find('\n', start), label.size());
        page.text(x, y, std::string_view(label).substr(start, end - start));
        y += 15;
        start = end + 1;
    }
}

/// Returns the height that was used.
Result<double> add_part(SvgPage& page, double top, double page_width, const PictureGrid& grid) {
    const double left = (page_width - width_of(grid)) / 2, first = left + label_width(grid), height = picture_height(grid);
    double y = top;
    if (!grid.title.empty()) {
        page.text(left, y + 14, grid.title, {.size = 14, .bold = true});
        y += kSectionTitle;
    }
    const bool labelled = std::any_of(grid.columns.begin(), grid.columns.end(), [](const std::string& c) { return !c.empty(); });
    if (labelled) {
        for (std::size_t c = 0; c < grid.columns.size(); ++c)
            page.text(first + static_cast<double>(c) * (grid.width + kGap) + grid.width / 2, y + 12, grid.columns[c], {.anchor = "middle"});
        y += kColumnLabel;
    }
    for (std::size_t r = 0; r < grid.rows.size(); ++r) {
        if (!grid.rows[r].empty()) add_row_label(page, left, y + height / 2, grid.rows[r]);
        for (std::size_t c = 0; c < grid.columns.size(); ++c) {
            const auto bytes = encode_image(grid.pictures[r * grid.columns.size() + c], OutputFormat::png);
            if (!bytes) return tl::unexpected(bytes.error());
            page.png(first + static_cast<double>(c) * (grid.width + kGap), y, grid.width, height, *bytes);
        }
        y += height + kGap;
    }
    return y - kGap - top;
}

Result<double> add_part(SvgPage& page, double top, double page_width, const PlotRow& plots) {
    double x = (page_width - width_of(plots)) / 2, height = 0;
    for (const Plot& plot : plots) {
        add_plot(page, x, top, plot);
        x += plot.width;
        height = std::max(height, plot.height);
    }
    return height;
}

/// The plots as the page shows them. A plot that is the figure's only part needs no title beside the figure's.
PlotRow shown_plots(const Figure& figure, const PlotRow& plots) {
    PlotRow shown = plots;
    if (figure.parts.size() == 1 && shown.size() == 1) shown[0].title.clear();
    return shown;
}

std::string source_line(const FigureSource& source) { return fmt::format("{} {}", source.key, source.text); }

/// A page with all parts of the figure, or with the plots alone.
Result<std::string> page_of(const FigureEntry& entry, const Figure& figure, bool plots_alone) {
    double width = kMinWidth;
    for (const auto& part : figure.parts)
        width = std::max(width, 2 * kMargin + std::visit([](const auto& p) { return width_of(p); }, part));
    SvgPage page;
    page.text(kMargin, 34, entry.title, {.size = 18, .bold = true});
    page.text(kMargin, 54, entry.source, {.color = "#666"});
    double y = 74;
    for (const auto& part : figure.parts) {
        if (plots_alone && std::holds_alternative<PictureGrid>(part)) continue;
        const auto* plots = std::get_if<PlotRow>(&part);
        const auto height = plots != nullptr ? add_part(page, y, width, shown_plots(figure, *plots))
                                             : add_part(page, y, width, std::get<PictureGrid>(part));
        if (!height) return tl::unexpected(height.error());
        y += *height + kPartGap;
    }
    y += page.paragraph(kMargin, y, width - 2 * kMargin, figure.caption, {.size = 12.5});
    y += kCaptionGap;
    for (const FigureSource& source : sources_in(entry.source))
        y += page.paragraph(kMargin, y, width - 2 * kMargin, source_line(source), {.size = 11, .color = "#666"});
    return page.finish(width, y + kMargin, entry.title);
}

void paste(Image& sheet, const Image& picture, int x, int y) {
    for (int row = 0; row < picture.height; ++row) {
        const auto from = picture.rgba8.begin() + std::ptrdiff_t{4} * row * picture.width;
        std::copy(from, from + std::ptrdiff_t{4} * picture.width,
                  sheet.rgba8.begin() + std::ptrdiff_t{4} * (std::ptrdiff_t{y + row} * sheet.width + x));
    }
}

/// All pictures of the figure's grids, one grid below the other, on white.
Image sheet_of(const std::vector<const PictureGrid*>& grids) {
    Image sheet;
    for (const PictureGrid* grid : grids) {
        const int columns = static_cast<int>(grid->columns.size()), rows = static_cast<int>(grid->rows.size());
        sheet.width = std::max(sheet.width, columns * (grid->pictures.front().width + kSheetGap) - kSheetGap);
        sheet.height += rows * (grid->pictures.front().height + kSheetGap);
    }
    sheet.height -= kSheetGap;
    sheet.rgba8.assign(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height) * 4, 255);
    int y = 0;
    for (const PictureGrid* grid : grids)
        for (std::size_t r = 0; r < grid->rows.size(); ++r) {
            int x = 0;
            for (std::size_t c = 0; c < grid->columns.size(); ++c) {
                const Image& picture = grid->pictures[r * grid->columns.size() + c];
                paste(sheet, picture, x, y);
                x += picture.width + kSheetGap;
            }
            y += grid->pictures.front().height + kSheetGap;
        }
    return sheet;
}

FigureFile text_file(std::string name, const std::string& text) { return {std::move(name), {text.begin(), text.end()}}; }

constexpr const char* kIndexHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>halflit: figures</title>
<style>
body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff }
img { max-width: 100%; height: auto; border: 1px solid #ddd }
section { margin-bottom: 3rem }
.source { color: #666 }
</style>
</head>
<body>
<h1>Figures</h1>
<p>Drawn and computed by halflit. The sources are listed at the end.</p>
)";

}  // namespace

Result<std::vector<FigureFile>> figure_files(const FigureEntry& entry, const Figure& figure, FigureFormat format) {
    std::vector<const PictureGrid*> grids;
    std::vector<Plot> plots;
    for (const auto& part : figure.parts) {
        if (const auto* grid = std::get_if<PictureGrid>(&part)) grids.push_back(grid);
        if (const auto* row = std::get_if<PlotRow>(&part)) plots.insert(plots.end(), row->begin(), row->end());
    }
    const std::string name = entry.name;
    const bool sheet = format == FigureFormat::png && !grids.empty();
    std::vector<FigureFile> files;
    if (sheet) {
        auto png = encode_image(sheet_of(grids), OutputFormat::png);
        if (!png) return tl::unexpected(png.error());
        files.push_back({name + ".png", std::move(*png)});
    }
    if (!sheet || !plots.empty()) {
        const auto page = page_of(entry, figure, sheet);
        if (!page) return tl::unexpected(page.error());
        files.push_back(text_file(name + ".svg", *page));
    }
    if (!plots.empty()) files.push_back(text_file(name + ".csv", plots_csv(plots)));
    return files;
}

std::string figure_index(std::span<const MadeFigure> figures) {
    std::string html = kIndexHead, all_sources;
    html += "<ul>\n";
    for (const MadeFigure& figure : figures) {
        html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", figure.entry->name, rich_html(figure.entry->title));
        all_sources += figure.entry->source;
    }
    html += "</ul>\n";
    for (const MadeFigure& figure : figures) {
        html += fmt::format("<section id=\"{}\">\n", figure.entry->name);
        // An SVG page shows title, source, caption and sources itself.
        const bool on_page = std::any_of(figure.files.begin(), figure.files.end(), [](const auto& file) { return file.ends_with(".svg"); });
        if (!on_page)
            html +=
                fmt::format("<h2>{}</h2>\n<p class=\"source\">{}</p>\n", rich_html(figure.entry->title), xml_escaped(figure.entry->source));
        for (const std::string& file : figure.files)
            html += file.ends_with(".csv")
                        ? fmt::format("<p><a href=\"{0}\">{0}</a>: the numbers</p>\n", file)
                        : fmt::format("<img src=\"{}\" alt=\"{}\">\n", file, xml_escaped(rich_plain(figure.entry->title)));
        if (!on_page) {
            html += fmt::format("<p>{}</p>\n", rich_html(figure.caption));
            for (const FigureSource& source : sources_in(figure.entry->source))
                html += fmt::format("<p class=\"source\">{}</p>\n", xml_escaped(source_line(source)));
        }
        html += "</section>\n";
    }
    html += "<h2>Sources</h2>\n<ul>\n";
    for (const FigureSource& source : sources_in(all_sources)) html += fmt::format("<li>{}</li>\n", xml_escaped(source_line(source)));
    return html + "</ul>\n</body>\n</html>\n";
}

}  // namespace halflit::cli
