#include "apps/engine/look/look_sheet.hpp"

#include "apps/engine/answers/measures_json.hpp"
#include "apps/engine/pictures/marks.hpp"
#include "apps/engine/pictures/sheet_page.hpp"
#include "apps/engine/pictures/vector_file.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace halflit::engine {
namespace {

constexpr MarkStyle kMarks{.color = {0x2b, 0x33, 0x3d}, .background = {0xec, 0xee, 0xf1}};

/// The axes of the file as the camera sees them.
std::array<Vec3d, 3> seen_axes(const RenderJob& job, const Camera& camera) {
    const Mat4& m = camera.world_from_camera;
    std::array<Vec3d, 3> seen;
    const Vec3d of_file[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d of_world = turned_upright(of_file[i], job.source.placement.up);
        seen[i] = {dot(of_world, axis(m, 0)), dot(of_world, axis(m, 1)), dot(of_world, axis(m, 2))};
    }
    return seen;
}

/// Dimension lines of the model's box, below it and on its right, where the view looks along an axis: others would be foreshortened. seen:
/// pixels that the lines keep clear of; points and lines are wider than their box. Returns the pixels of the line below.
PixelBox draw_dimensions(const RenderJob& job, const ViewShot& shot, const PixelBox& seen, const ShownUnit& unit, Canvas& canvas) {
    const Mat4& m = shot.camera.world_from_camera;
    const Bounds& bounds = job.film.bounds;
    const auto is_axis = [](const Vec4f& v) {
        constexpr float kAlmostOne = 1.0f - 1e-6f;
        return std::max({v.x * v.x, v.y * v.y, v.z * v.z}) > kAlmostOne;
    };
    if (!shot.camera.orthographic || bounds.empty || !is_axis(m.c[0]) || !is_axis(m.c[1])) return {};
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    for (unsigned k = 0; k < 8; ++k) {
        const Vec3d p =
            window_point(shot.camera, shot.width(), shot.height(),
                         {k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y, k & 4 ? bounds.max.z : bounds.min.z});
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    const FileBox box = file_box(job, to_double(bounds.min), to_double(bounds.max));
    const Vec3d size = absolute(turned_upright(box.max - box.min, job.source.placement.up)) * job.source.placement.scale;
    const auto along = [&](const Vec4f& v) { return absolute(v.x) * size.x + absolute(v.y) * size.y + absolute(v.z) * size.z; };
    const auto text = [&](double length) { return number_text(length * unit.per_drawn_unit) + (unit.name.empty() ? "" : " ") + unit.name; };
    constexpr double kBeside = 15, kClear = 6;  // pixels from the model to a line, and to a text
    const double below = std::max(y1, double(seen.y1)), right = std::max(x1, double(seen.x1));
    if (x1 - x0 > 1) draw_dimension(canvas, {x0, below + kBeside}, {x1, below + kBeside}, text(along(m.c[0])), kMarks);
    if (y1 - y0 > 1) {
        const std::string height = text(along(m.c[1]));
        const double half = 0.5 * width_of_text(height, kMarks.text_size);
        const double x = std::min(right + kClear + half, shot.width() - 2.0 - half);  // over the model where there is no room beside it
        draw_dimension(canvas, {x, y0}, {x, y1}, height, kMarks);
    }
    const double high = kBeside + (x1 - x0 < 60 ? 21 : 7);  // a short line has its text below
    return {static_cast<int>(x0), static_cast<int>(below), static_cast<int>(x1), static_cast<int>(below + high)};
}

/// No pixel of a box shows the model, or lies in the other box.
bool is_free(const ViewShot& shot, const PixelBox& box, const PixelBox& other) {
    if (box.x0 < other.x1 && other.x0 < box.x1 && box.y0 < other.y1 && other.y0 < box.y1) return false;
    for (int y = std::max(box.y0, 0); y < std::min(box.y1, shot.height()); ++y) {
        const auto row = shot.instance.begin() + std::ptrdiff_t{y} * shot.width();
        for (int x = std::max(box.x0, 0); x < std::min(box.x1, shot.width()); ++x)
            if (row[x] != 0) return false;
    }
    return true;
}

/// The shot's edges as lines, those that are hidden dashed.
std::vector<VectorShape> edge_shapes(const ViewShot& shot, const Settings& settings) {
    std::vector<VectorShape> shapes;
    for (const bool hidden : {true, false}) {
        std::vector<std::pair<Point, Point>> parts;
        for (const DrawnEdge& edge : shot.edges)
            if (edge.hidden == hidden) parts.emplace_back(Point{edge.x0, edge.y0}, Point{edge.x1, edge.y1});
        if (parts.empty()) continue;
        const double width = static_cast<double>(settings.edge_width);
        constexpr Color kHidden{0x80, 0x80, 0x80};
        shapes.push_back({.contours = joined_lines(parts),
                          .color = hidden ? kHidden : Color{},
                          .stroke_width = hidden ? 0.5 * width : width,
                          .dashed = hidden,
                          .layer = hidden ? "hidden" : "visible"});
    }
    return shapes;
}

/// shapes: gets the marks; null: they are not wanted.
Image marked_picture(const RenderJob& job, const ViewShot& shot, const ViewContent& content, const ShownUnit& unit,
                     std::vector<VectorShape>* shapes = nullptr) {
    Canvas canvas(shot.picture);
    canvas.record(shapes);
    const int width = shot.width(), height = shot.height();
    const PixelBox dimension = draw_dimensions(job, shot, content.box, unit, canvas);
    // The axes stand in the lower left corner, the scale in the lower right one, where they cover nothing.
    constexpr int kBeyondAxes = 16;  // pixels: letters, and from the edge
    for (const int axis : {26, 18, 10}) {
        const int side = 2 * (axis + kBeyondAxes);
        if (2 * side > height || !is_free(shot, {0, height - side, side, height}, dimension)) continue;
        draw_axes(canvas, {0.5 * side, height - 0.5 * side}, axis, seen_axes(job, shot.camera));
        break;
    }
    if (shot.camera.orthographic && !job.film.bounds.empty) {
        constexpr double kLongest = 0.2;  // of the picture's width
        constexpr int kHigh = 18;         // pixels of the bar and its text
        const int inset = std::clamp(width / 30, 4, 16);
        const double units = pixel_size(shot.camera, width, height, 1.0) * unit.per_drawn_unit;
        const double left = width - inset - round_length(kLongest * width * units) / units;
        if (is_free(shot, {static_cast<int>(left) - 4, height - inset - kHigh, width, height}, dimension))
            draw_scale_bar(canvas, {left, static_cast<double>(height - inset)}, kLongest * width, units, unit.name, kMarks);
    }
    return canvas.take();
}

ShownUnit unit_of(const RenderJob& job) {
    const Bounds& bounds = job.film.bounds;
    const Vec3d size = bounds.empty ? Vec3d{} : to_double(bounds.max) - to_double(bounds.min);
    return shown_unit(job.source, std::max({size.x, size.y, size.z}));
}

SheetCell cell_of(const RenderJob& job, const ViewShot& shot, const ViewContent& content, const ShownUnit& unit, bool as_vectors) {
    std::string note = content.edge_on ? "edge-on" : "";
    for (const std::string& fault : content.faults.names()) note += (note.empty() ? "" : ", ") + fault;
    if (!as_vectors) return {shot.name, note, marked_picture(job, shot, content, unit), {}};
    SheetCell cell{shot.name, note, {}, {}, edge_shapes(shot, job.settings)};
    std::vector<VectorShape> marks;
    cell.picture = marked_picture(job, shot, content, unit, &marks);
    for (VectorShape& mark : marks) {
        if (mark.color == kMarks.background) mark.color = {0xff, 0xff, 0xff};  // behind texts
        cell.shapes.push_back(std::move(mark));
    }
    return cell;
}

/// Place of a side in a drawing of third angle, in cells from the front: to the right and down. Whatever is on the right of the front is
/// drawn on its right. In first angle it is on the other side, but for the back, which comes last in both.
struct DrawingPlace {
    std::string_view name;
    int right, down;
};
constexpr DrawingPlace kDrawing[] = {{"front", 0, 0},  {"right", 1, 0}, {"left", -1, 0}, {"top", 0, -1},
                                     {"bottom", 0, 1}, {"iso", 1, -1},  {"back", 2, 0}};

const DrawingPlace* place_in_drawing(std::string_view name) {
    const auto* const found = std::find_if(std::begin(kDrawing), std::end(kDrawing), [&](const auto& one) { return one.name == name; });
    return found != std::end(kDrawing) ? found : nullptr;
}

/// The cells row by row, in the columns and rows that have one; cells between them are empty.
struct Drawing {
    std::vector<SheetCell> cells;
    int columns = 0;
};
Drawing drawing_of(std::vector<SheetCell> cells, Projection projection) {
    const int side = projection == Projection::third_angle ? 1 : -1;
    std::map<int, std::map<int, SheetCell*>> rows;
    std::set<int> columns;
    for (SheetCell& cell : cells) {
        const DrawingPlace& place = *place_in_drawing(cell.title);
        const int right = place.name == "back" ? place.right : side * place.right;
        rows[side * place.down][right] = &cell;
        columns.insert(right);
    }
    Drawing drawing{{}, static_cast<int>(columns.size())};
    for (auto& [down, row] : rows)
        for (const int column : columns) {
            const auto found = row.find(column);
            drawing.cells.push_back(found != row.end() ? std::move(*found->second) : SheetCell{});
        }
    return drawing;
}

}  // namespace

bool make_drawing(std::span<const std::string> names) {
    std::set<std::string> once(names.begin(), names.end());
    return once.size() == names.size() && names.size() > 1 && once.contains("front") &&
           std::all_of(names.begin(), names.end(), [](const std::string& name) { return place_in_drawing(name) != nullptr; });
}

ShownUnit shown_unit(const SceneSource& source, double largest) {
    const ShownUnit unit = file_unit(source);
    constexpr double kSmall = 1.0;  // metres
    return unit.name == "m" && largest * unit.per_drawn_unit < kSmall ? ShownUnit{"mm", 1000.0 * unit.per_drawn_unit} : unit;
}

Image marked_view(const RenderJob& job, const ViewShot& shot, const ViewContent& content) {
    return marked_picture(job, shot, content, unit_of(job));
}

Result<Image> look_sheet(const RenderJob& job, std::span<const ViewShot> shots, std::span<const ViewContent> contents,
                         Projection projection, const std::string& footer, std::vector<VectorShape>* shapes) {
    const ShownUnit unit = unit_of(job);
    std::vector<SheetCell> cells;
    for (std::size_t i = 0; i < shots.size(); ++i) cells.push_back(cell_of(job, shots[i], contents[i], unit, shapes != nullptr));
    std::vector<std::string> names;
    for (const ViewShot& shot : shots) names.push_back(shot.name);
    if (!make_drawing(names)) return lay_out(cells, 0, footer, shapes);
    const Drawing drawing = drawing_of(std::move(cells), projection);
    return lay_out(drawing.cells, drawing.columns, footer, shapes);
}

}  // namespace halflit::engine
