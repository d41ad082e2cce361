#include "apps/engine/pictures/vector_file.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

namespace halflit::engine {
namespace {

constexpr double kDash = 4.0;  // pixels

/// Hundredths of a pixel, without zeros at the end.
std::string number(double x) {
    std::string text = fmt::format("{:.2f}", x);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? "0" : text;
}

/// move, line and close: the format's words for them.
std::string path_of(const VectorShape& shape, bool words_first, const char* move, const char* line, const char* close) {
    std::string path;
    for (const Contour& contour : shape.contours) {
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const std::string at = number(contour[i].x) + ' ' + number(contour[i].y);
            const char* const word = i == 0 ? move : line;
            path += words_first ? word + at : at + ' ' + word + '\n';
        }
        if (shape.stroke_width == 0.0) path += close;
    }
    return path;
}

std::string svg_of(std::span<const VectorShape> shapes, int width, int height) {
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{0}\" "
        "height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        width, height);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const VectorShape& shape = shapes[i];
        if (i == 0 || shapes[i - 1].layer != shape.layer)
            text += fmt::format("<g id=\"{0}-{1}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\">\n", shape.layer, i);
        const std::string color = fmt::format("#{:02x}{:02x}{:02x}", shape.color.r, shape.color.g, shape.color.b);
        text += "<path d=\"" + path_of(shape, true, "M", "L", "Z") + '"';
        if (shape.stroke_width > 0.0)
            text += fmt::format(" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"{}",
                                color, number(shape.stroke_width), shape.dashed ? fmt::format(" stroke-dasharray=\"{0} {0}\"", kDash) : "");
        else
            text += fmt::format(" fill=\"{}\"", color);
        text += "/>\n";
        if (i + 1 == shapes.size() || shapes[i + 1].layer != shape.layer) text += "</g>\n";
    }
    return text + "</svg>\n";
}

std::string pdf_of(std::span<const VectorShape> shapes, int width, int height) {
    constexpr double kPoints = 0.75;  // of 1/72 inch, a pixel
    std::string page = fmt::format("{0} 0 0 -{0} 0 {1} cm\n1 J 1 j\n", kPoints, number(kPoints * height));
    for (const VectorShape& shape : shapes) {
        const bool is_stroke = shape.stroke_width > 0.0;
        page += fmt::format("{:.3f} {:.3f} {:.3f} {}\n", shape.color.r / 255.0, shape.color.g / 255.0, shape.color.b / 255.0,
                            is_stroke ? "RG" : "rg");
        if (is_stroke) page += fmt::format("{} w [{}] 0 d\n", number(shape.stroke_width), shape.dashed ? number(kDash) : "");
        page += path_of(shape, false, "m", "l", "h\n") + (is_stroke ? "S\n" : "f\n");
    }
    const std::string objects[] = {"<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
                                   fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {} {}] /Contents 4 0 R /Resources << >> >>",
                                               number(kPoints * width), number(kPoints * height)),
                                   fmt::format("<< /Length {} >>\nstream\n{}endstream", page.size(), page)};
    std::string text = "%PDF-1.4\n", places;
    for (std::size_t i = 0; i < std::size(objects); ++i) {
        places += fmt::format("{:010} 00000 n \n", text.size());
        text += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    const std::size_t count = std::size(objects) + 1;
    return text + fmt::format("xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\nstartxref\n{2}\n%%EOF\n", count,
                              places, text.size());
}

}  // namespace

VectorFormat vector_format_of(const std::string& path) {
    return io::ends_with_word(path, ".svg") ? VectorFormat::svg : io::ends_with_word(path, ".pdf") ? VectorFormat::pdf : VectorFormat::none;
}

std::string vector_file(VectorFormat format, std::span<const VectorShape> shapes, int width, int height) {
    return format == VectorFormat::pdf ? pdf_of(shapes, width, height) : svg_of(shapes, width, height);
}

std::vector<Contour> joined_lines(std::span<const std::pair<Point, Point>> parts) {
    constexpr double kPerPixel = 1024.0;  // ends that are nearer are one
    const auto key = [](Point p) { return std::pair(std::llround(p.x * kPerPixel), std::llround(p.y * kPerPixel)); };
    std::map<std::pair<long long, long long>, std::vector<std::size_t>> at;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (const Point p : {parts[i].first, parts[i].second}) at[key(p)].push_back(i);
    std::vector<bool> is_used(parts.size());
    // The part that goes on from the end `p` of part i; none: another number of parts end there.
    const auto next = [&](std::size_t i, Point p) {
        const std::vector<std::size_t>& there = at[key(p)];
        if (there.size() != 2) return parts.size();
        const std::size_t other = there[0] == i ? there[1] : there[0];
        return is_used[other] ? parts.size() : other;
    };
    std::vector<Contour> lines;
    for (std::size_t first = 0; first < parts.size(); ++first) {
        if (is_used[first]) continue;
        is_used[first] = true;
        Contour ends[2];  // from the first part's two ends on
        for (const bool forward : {true, false}) {
            Point p = forward ? parts[first].second : parts[first].first;
            Contour& line = ends[forward ? 1 : 0];
            line.push_back(p);
            for (std::size_t i = first, other = 0; (other = next(i, p)) < parts.size(); i = other) {
                is_used[other] = true;
                p = key(parts[other].first) == key(p) ? parts[other].second : parts[other].first;
                line.push_back(p);
            }
        }
        Contour line(ends[0].rbegin(), ends[0].rend());
        line.insert(line.end(), ends[1].begin(), ends[1].end());
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace halflit::engine
