#include "apps/engine/basics/printable.hpp"
#include "apps/engine/compare/comparison.hpp"
#include "apps/engine/pictures/html_page.hpp"
#include "apps/engine/pictures/marks.hpp"
#include "apps/engine/pictures/sheet_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostPartLines = 20;

/// Six digits: positions have seven.
Json number(double value) { return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value + 0.0))) : Json(nullptr); }
Json point(Vec3d p) { return {number(p.x), number(p.y), number(p.z)}; }

std::string with_unit(double value, const std::string& unit) { return number_text(value) + (unit.empty() ? "" : " " + unit); }
std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }
std::string yes_or_no(bool value) { return value ? "yes" : "no"; }

Json numbers_json(const ModelNumbers& n) {
    return {{"size", point(n.size)},
            {"area", number(n.area)},
            {"volume", n.watertight ? number(n.volume) : Json(nullptr)},
            {"triangles", n.triangles},
            {"bodies", n.bodies},
            {"watertight", n.watertight},
            {"open_edges", n.open_edges},
            {"flipped_edges", n.flipped_edges},
            {"crowded_edges", n.crowded_edges},
            {"parts", n.parts},
            {"instances", n.instances},
            {"materials", n.materials},
            {"textures", n.textures},
            {"points", n.points},
            {"lines", n.lines},
            {"unseen_area_share", n.unseen_area ? number(*n.unseen_area) : Json(nullptr)}};
}

/// A bound that stays one when it is rounded to six digits.
double outward(double at_most) { return at_most * (1.0 + 1e-5); }

Json farthest_json(const FarthestPoint& found) {
    return {{"at_least", number(found.at_least)}, {"at_most", number(outward(found.at_most))}, {"point", point(found.point)}};
}

Json view_json(const ViewChange& view, double scale) {
    Json pixels = Json::object();
    for (std::size_t i = 0; i < kPixelChanges; ++i) pixels[kPixelChangeNames[i]] = view.pixels[i];
    return {{"name", view.name},
            {"iou", number(view.iou)},
            {"changed", view.changed()},
            {"changed_share", number(view.share())},
            {"pixels", std::move(pixels)},
            {"box", view.box.width == 0 ? Json(nullptr) : Json{view.box.x, view.box.y, view.box.width, view.box.height}},
            {"largest_depth", number(view.depth / scale)},
            {"largest_turn_deg", number(view.turn_deg)},
            {"pixel", number(view.pixel / scale)}};
}

/// A row of the table of measures.
struct Row {
    std::string name, a, b;
};

std::vector<Row> rows_of(const Comparison& c) {
    const ModelNumbers &a = c.models.a, &b = c.models.b;
    const auto size = [](const ModelNumbers& n) { return fmt::format("{:.7g} x {:.7g} x {:.7g}", n.size.x, n.size.y, n.size.z); };
    const auto volume = [](const ModelNumbers& n) {
        return n.watertight ? fmt::format("{:.7g}", n.volume) : std::string("not watertight");
    };
    const auto unseen = [](const ModelNumbers& n) { return n.unseen_area ? percent(*n.unseen_area) : std::string("none"); };
    std::vector<Row> rows{{"size" + (c.unit.empty() ? "" : ", " + c.unit), size(a), size(b)},
                          {"area", fmt::format("{:.7g}", a.area), fmt::format("{:.7g}", b.area)},
                          {"volume", volume(a), volume(b)},
                          {"watertight", yes_or_no(a.watertight), yes_or_no(b.watertight)}};
    const auto count = [&](const char* name, std::uint64_t x, std::uint64_t y) {
        rows.push_back({name, fmt::format("{}", x), fmt::format("{}", y)});
    };
    count("triangles", a.triangles, b.triangles);
    count("bodies", a.bodies, b.bodies);
    count("open edges", a.open_edges, b.open_edges);
    count("flipped edges", a.flipped_edges, b.flipped_edges);
    count("parts", a.parts, b.parts);
    count("materials", a.materials, b.materials);
    count("textures", a.textures, b.textures);
    rows.push_back({"area not seen", unseen(a), unseen(b)});
    return rows;
}

std::string part_line(const ChangedPart& part, const std::string& unit) {
    const std::string name = part.name.empty() ? "(without a name)" : printable(part.name);
    std::string line = fmt::format("{} {}", kPartChangeNames[static_cast<std::size_t>(part.change)], name);
    if (part.change == PartChange::moved) line += " by " + with_unit(length(part.shift), unit);
    return line;
}

std::vector<std::string> part_lines(const Comparison& c) {
    std::vector<std::string> lines;
    for (const ChangedPart& part : c.models.parts) {
        if (lines.size() == kMostPartLines) {
            lines.push_back(fmt::format("{} more parts changed", c.models.parts.size() - kMostPartLines));
            break;
        }
        lines.push_back("part: " + part_line(part, c.unit));
    }
    return lines;
}

std::string distance_text(const Comparison& c) {
    const ModelChange& m = c.models;
    if (m.too_many) return fmt::format("not computed: a model has more than {} triangles", kMostComparedTriangles);
    if (!m.distance) return "none: a model has no triangles";
    return fmt::format("{} (at most {})", with_unit(m.distance->at_least(), c.unit), with_unit(m.distance->at_most(), c.unit));
}

std::string verdict(const Comparison& c) {
    if (!c.differs()) return "No difference.";
    std::string text;
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (c.changed_pixels() > 0) {
        const auto most = std::max_element(c.views.begin(), c.views.end(),
                                           [](const ViewChange& x, const ViewChange& y) { return x.changed() < y.changed(); });
        add(fmt::format("{} of the pixels of the view {} changed", percent(most->share()), printable(most->name)));
    } else {
        add("no pixel changed");
    }
    if (c.models.distance) add("surfaces are up to " + with_unit(c.models.distance->at_least(), c.unit) + " apart");
    if (!c.models.parts.empty()) add(fmt::format("{} part{} changed", c.models.parts.size(), c.models.parts.size() == 1 ? "" : "s"));
    return "Differs: " + text + ".";
}

std::string unseen_text(const Comparison& c) {
    std::string text = fmt::format(
        "A triangle counts as seen if at least one pixel of the {} views shows it at the pixel's first sample. Two changes of a surface "
        "that is seen may leave no mark: a shift of its outline by less than one pixel ({}), and a shift by less than {} along the view "
        "where it faces the view.",
        c.views.size(), with_unit(c.pixel(), c.unit), with_unit(c.depth(), c.unit));
    if (c.models.a.unseen_area && c.models.b.unseen_area)
        text += fmt::format(" Not seen: {} of the area of A, {} of that of B.", percent(*c.models.a.unseen_area),
                            percent(*c.models.b.unseen_area));
    if (c.models.distance)
        text +=
            fmt::format(" The distance between the surfaces does not depend on views: no point of one is farther than {} from the other.",
                        with_unit(c.models.distance->at_most(), c.unit));
    text += fmt::format(" Colours that differ by at most {} codes count as equal. Faces that are turned show only in the numbers of edges.",
                        c.max_codes);
    if (c.models.a.points + c.models.a.lines + c.models.b.points + c.models.b.lines > 0)
        text += " Points and lines are compared by pixels and by their number.";
    return text;
}

std::string view_line(const ViewChange& v, const Comparison& c) {
    std::string text =
        fmt::format("IoU {:.4f}, {} of {} pixels changed ({})", v.iou, v.changed(), v.changed() + v.pixels[0], percent(v.share()));
    for (std::size_t i = 1; i < kPixelChanges; ++i)
        if (v.pixels[i] > 0) text += fmt::format(", {} {}", v.pixels[i], kPixelChangeNames[i]);
    if (v.depth > 0) text += ", depth up to " + with_unit(v.depth / c.scale, c.unit);
    if (v.pixels[static_cast<std::size_t>(PixelChange::turned)] > 0) text += fmt::format(", normals up to {:.3g} deg", v.turn_deg);
    return text;
}

std::string legend() {
    std::string html = "<p>Marks: ";
    for (std::size_t i = 1; i < kPixelChanges; ++i)
        html += fmt::format("<span style=\"color: rgb({},{},{})\">&#9632;</span> {}{}", kPixelChangeColors[i][0], kPixelChangeColors[i][1],
                            kPixelChangeColors[i][2], kPixelChangeNames[i], i + 1 < kPixelChanges ? ", " : ".</p>\n");
    return html;
}

/// Text inside a table or a line of Markdown: characters that would be its syntax are escaped.
std::string markdown_text(const std::string& text) {
    std::string out;
    for (const char c : printable(text)) {
        if (std::string_view("\\`*_{}[]<>()#+-!|~&@").find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

/// A path inside of <>, as Markdown links have it.
std::string markdown_path(const std::string& path) {
    std::string out;
    for (const char c : path)
        if (c == '<' || c == '>' || c == '\\' || c == ' ' || static_cast<unsigned char>(c) < 32)
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        else
            out += c;
    return out;
}

}  // namespace

std::uint64_t Comparison::changed_pixels() const {
    std::uint64_t sum = 0;
    for (const ViewChange& view : views) sum += view.changed();
    return sum;
}

double Comparison::pixel() const {
    double most = 0.0;
    for (const ViewChange& view : views) most = std::max(most, view.pixel / scale);
    return most;
}

double Comparison::depth() const { return depth_step(pixel(), 1.0, 0.0); }

Json comparison_json(const Comparison& c) {
    Json json = report_head("compare");
    json["a"] = c.a, json["b"] = c.b;
    json["differs"] = c.differs();
    json["unit"] = c.unit.empty() ? Json(nullptr) : Json(c.unit);
    json["max_codes"] = c.max_codes;
    json["models"] = {{"a", numbers_json(c.models.a)}, {"b", numbers_json(c.models.b)}};
    Json parts = Json::array();
    for (const ChangedPart& part : c.models.parts)
        parts.push_back(
            {{"name", part.name}, {"change", kPartChangeNames[static_cast<std::size_t>(part.change)]}, {"shift", point(part.shift)}});
    json["parts"] = std::move(parts);
    json["distance"] = nullptr;
    if (const auto& d = c.models.distance)
        json["distance"] = {{"at_least", number(d->at_least())},
                            {"at_most", number(outward(d->at_most()))},
                            {"from_a", farthest_json(d->from_a)},
                            {"from_b", farthest_json(d->from_b)},
                            {"tolerance", number(c.models.tolerance)}};
    json["unseen"] = {{"pixel", number(c.pixel())}, {"depth", number(c.depth())}, {"text", unseen_text(c)}};
    Json views = Json::array();
    for (const ViewChange& view : c.views) views.push_back(view_json(view, c.scale));
    json["views"] = std::move(views);
    json["warnings"] = c.warnings;
    return json;
}

std::string comparison_text(const Comparison& c) {
    std::string text = verdict(c) + "\n";
    for (const ViewChange& view : c.views) text += fmt::format("view {}: {}\n", printable(view.name), view_line(view, c));
    text += "distance of the surfaces: " + distance_text(c) + "\n";
    for (const Row& row : rows_of(c))
        if (row.a != row.b) text += fmt::format("{}: {} -> {}\n", row.name, row.a, row.b);
    for (const std::string& line : part_lines(c)) text += line + "\n";
    return text + unseen_text(c) + "\n";
}

std::string comparison_markdown(const Comparison& c, const std::string& picture) {
    std::string text = fmt::format("**{}**\n\nA: {}, B: {}\n\n", markdown_text(verdict(c)), markdown_text(c.a), markdown_text(c.b));
    if (!picture.empty()) text += fmt::format("![A, B, and what changed]({})\n\n", markdown_path(picture));
    text += "| view | IoU | changed | added | removed | moved | turned | recolored |\n|---|---|---|---|---|---|---|---|\n";
    for (const ViewChange& view : c.views) {
        text += fmt::format("| {} | {:.4f} | {} |", markdown_text(view.name), view.iou, percent(view.share()));
        for (std::size_t i = 1; i < kPixelChanges; ++i) text += fmt::format(" {} |", view.pixels[i]);
        text += "\n";
    }
    text += "\n| | A | B |\n|---|---|---|\n";
    for (const Row& row : rows_of(c))
        text += row.a == row.b ? fmt::format("| {} | {} | {} |\n", row.name, markdown_text(row.a), markdown_text(row.b))
                               : fmt::format("| **{}** | {} | **{}** |\n", row.name, markdown_text(row.a), markdown_text(row.b));
    text += fmt::format("\nDistance of the surfaces: {}\n", markdown_text(distance_text(c)));
    for (const std::string& line : part_lines(c)) text += "\n- " + markdown_text(line);
    if (!c.models.parts.empty()) text += "\n";
    return text + "\n" + markdown_text(unseen_text(c)) + "\n";
}

Result<std::string> comparison_page(const Comparison& c) {
    std::string html = page_head("halflit compare", verdict(c), ".changed { font-weight: 600 }\nh2 { margin-top: 1.5rem }\n");
    html += fmt::format("<p>A: <code>{}</code>, B: <code>{}</code></p>\n<p>Distance of the surfaces: {}</p>\n", page_text(c.a),
                        page_text(c.b), page_text(distance_text(c)));
    for (const std::string& line : part_lines(c)) html += fmt::format("<p>{}</p>\n", page_text(line));
    html += legend();
    for (const ViewChange& view : c.views) {
        html += fmt::format("<h2>{}</h2>\n<p>{}</p>\n<div class=\"pictures\">\n", page_text(view.name), page_text(view_line(view, c)));
        for (const auto& [image, caption] :
             {std::pair<const Image*, const char*>{&view.a, "A"}, {&view.b, "B"}, {&view.marked, "changed"}}) {
            const auto figure = embedded_figure(*image, caption);
            if (!figure) return figure;
            html += *figure;
        }
        html += "</div>\n";
    }
    html += "<h2>Measures</h2>\n<table>\n<tr><th></th><th>A</th><th>B</th></tr>\n";
    for (const Row& row : rows_of(c))
        html += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td></tr>\n", row.a == row.b ? "" : " class=\"changed\"", row.name, row.a,
                            row.b);
    html += fmt::format("</table>\n<p>{}</p>\n", page_text(unseen_text(c)));
    for (const std::string& warning : c.warnings) html += fmt::format("<p>Warning: {}</p>\n", page_text(warning));
    return html + kPageEnd;
}

Result<Image> comparison_sheet(const Comparison& c) {
    std::vector<SheetCell> cells;
    for (const ViewChange& view : c.views) {
        cells.push_back({view.name, "A", view.a, {}});
        cells.push_back({view.name, "B", view.b, {}});
        cells.push_back({view.name, "changed", view.marked, {fmt::format("{} changed, IoU {:.4f}", percent(view.share()), view.iou)}});
    }
    return lay_out(cells, 3, verdict(c));
}

}  // namespace halflit::engine
