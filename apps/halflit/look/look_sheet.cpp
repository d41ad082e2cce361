#include "apps/halflit/look/look_sheet.hpp"

#include "apps/halflit/report/marks.hpp"
#include "apps/halflit/report/measures_json.hpp"
#include "apps/halflit/report/sheet_page.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace halflit::cli {
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
    for (int k = 0; k < 8; ++k) {
        const Vec3d p =
            window_point(shot.camera, shot.width(), shot.height(),
                         {k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y, k & 4 ? bounds.max.z : bounds.min.z});
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    const Vec3d size = to_double(bounds.max) - to_double(bounds.min);
    const auto along = [&](const Vec4f& v) { return absolute(v.x) * size.x + absolute(v.y) * size.y + absolute(v.z) * size.z; };
    const auto text = [&](double length) { return number_text(length * unit.per_drawn_unit) + (unit.name.empty() ? "" : " ") + unit.name; };
    constexpr double kBeside = 15, kClear = 6;  // pixels from the model to a line, and to a text
    const double below = std::max(y1, double(seen.y1)), right = std::max(x1, double(seen.x1));
    if (x1 - x0 > 1) draw_dimension(canvas, {x0, below + kBeside}, {x1, below + kBeside}, text(along(m.c[0])), kMarks);
    if (y1 - y0 > 1) {
        const std::string height = text(along(m.c[1]));
        const double x = right + kClear + 0.5 * width_of_text(height, kMarks.text_size);
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

SheetCell cell_of(const RenderJob& job, const ViewShot& shot, const ViewContent& content, const ShownUnit& unit) {
    Canvas canvas(shot.picture);
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
    std::string note;
    for (const std::string& fault : content.faults.names()) note += (note.empty() ? "" : ", ") + fault;
    return {shot.name, note, canvas.take(), {}};
}

}  // namespace

ShownUnit shown_unit(const SceneSource& source, double largest) {
    const double scale = 1.0 / source.placement.scale;
    const std::string name = unit_name(source);
    constexpr double kSmall = 1.0;  // metres
    return name == "m" && largest * scale < kSmall ? ShownUnit{"mm", 1000.0 * scale} : ShownUnit{name, scale};
}

Result<Image> look_sheet(const RenderJob& job, std::span<const ViewShot> shots, std::span<const ViewContent> contents,
                         Projection projection, const std::string& footer) {
    const Bounds& bounds = job.film.bounds;
    const Vec3d size = bounds.empty ? Vec3d{} : to_double(bounds.max) - to_double(bounds.min);
    const ShownUnit unit = shown_unit(job.source, std::max({size.x, size.y, size.z}));
    std::vector<SheetCell> cells;
    for (std::size_t i = 0; i < shots.size(); ++i) cells.push_back(cell_of(job, shots[i], contents[i], unit));
    const std::array<const char*, 4> drawing =
        projection == Projection::third_angle ? std::array{"top", "iso", "front", "right"} : std::array{"right", "front", "iso", "top"};
    std::vector<SheetCell> arranged;
    for (const char* const name : drawing)
        for (SheetCell& cell : cells)
            if (cell.title == name && arranged.size() < drawing.size() && cells.size() == drawing.size()) arranged.push_back(cell);
    const bool is_drawing = arranged.size() == drawing.size();
    return lay_out(is_drawing ? arranged : cells, is_drawing ? 2 : 0, footer);
}

}  // namespace halflit::cli
