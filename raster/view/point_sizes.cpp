#include "raster/view/point_sizes.hpp"

#include "halflit/settings.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/projection.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstddef>

namespace halflit::raster {
namespace {

constexpr int kMostCells = 128;                        ///< on the longer side of the picture
constexpr double kLeastPoints = 4.0;                   ///< of a cell in which some lie, in the mean: of these, 1 in 50 is empty by chance
constexpr std::size_t kMostCounted = 1u << 18;         ///< points; of more, some stand for all
constexpr double kOverlap = 2.7;                       ///< of the mean distance: circles at random leave 0.3 % of the surface open
constexpr double kLayers = 2.0;                        ///< a body has a side that is seen and one that is not
constexpr double kMostOfSide = 0.04, kMostPx = 256.0;  ///< of the shorter side; pixels
constexpr double kUnits = 256.0;                       ///< of a pixel

/// Points in the cells of a picture.
struct CellCounts {
    int columns, rows;
    double side_px;
    std::vector<std::uint32_t> points;

    [[nodiscard]] std::uint32_t at(int column, int row) const {
        return points[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
    }
    [[nodiscard]] double mean() const {
        double sum = 0, met = 0;
        for (const std::uint32_t n : points) sum += n, met += n > 0 ? 1 : 0;
        return met > 0.0 ? sum / met : 0.0;
    }
    /// Cells of twice the side.
    [[nodiscard]] CellCounts halved() const {
        CellCounts out{(columns + 1) / 2, (rows + 1) / 2, 2.0 * side_px, {}};
        out.points.resize(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows));
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                out.points[static_cast<std::size_t>(row / 2) * static_cast<std::size_t>(out.columns) +
                           static_cast<std::size_t>(column / 2)] += at(column, row);
        return out;
    }
};

/// Points in the mean on a cell that the surface fills, from those on a cell in which some lie: such cells alone are known to be of the
/// surface, and of points at random, r = n / (1 - e^-n) lie on one of them. The inverse, within 5 %.
double points_on_cell(double r) {
    constexpr double kLeast = 0.3, kMany = 4.0;
    return r < kMany ? std::max(__builtin_sqrt(12.0 * r - 3.0) - 3.0, kLeast) : r - 0.25;
}

/// stride: only each stride-th point of a mesh is counted.
CellCounts count_points(const Scene& scene, const Mat4& clip_from_world, int width, int height, std::size_t stride) {
    const int longer = std::max(width, height);
    CellCounts cells{(kMostCells * width + longer - 1) / longer,
                     (kMostCells * height + longer - 1) / longer,
                     static_cast<double>(longer) / kMostCells,
                     {}};
    cells.points.resize(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
    const double cells_x = 0.5 * width / cells.side_px, cells_y = 0.5 * height / cells.side_px;
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        if (!counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (!is_cloud(mesh)) continue;
        const Mat4 clip_from_object = clip_from_world * instance.world_from_object;
        for (std::size_t i = 0; i < mesh.indices.size(); i += stride) {
            check();
            const Vec3f p = mesh.positions[mesh.indices[i]];
            const ClipPlace at = clip_place(clip_from_object, {p.x, p.y, p.z});
            const double scale = 1.0 / at.w, x = (at.x * scale + 1.0) * cells_x, y = (1.0 - at.y * scale) * cells_y;
            if (!(at.w > 0.0 && x >= 0.0 && x < cells.columns && y >= 0.0 && y < cells.rows)) continue;
            ++cells.points[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.columns) + static_cast<std::size_t>(x)];
        }
    }
    return cells;
}

}  // namespace

PointSizes closing_point_sizes(const Scene& scene, const Mat4& clip_from_world, int width, int height) {
    std::size_t points = 0;
    for (const Instance& instance : scene.instances)
        if (counts_for_views(scene, instance) && is_cloud(scene.meshes[static_cast<std::size_t>(instance.mesh)]))
            points += scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size();
    if (points == 0) return {};
    const std::size_t stride = points / kMostCounted + 1;
    CellCounts cells = count_points(scene, clip_from_world, width, height, stride);
    while (cells.mean() < kLeastPoints && cells.columns + cells.rows > 2) cells = cells.halved();
    const double least = double{Settings{}.point_size} * kUnits;
    const double most = std::clamp(kMostOfSide * std::min(width, height), 2.0, kMostPx) * kUnits;
    const double side = cells.side_px * kUnits;
    PointSizes out{cells.columns, cells.rows, static_cast<float>(1.0 / side), 0, {}};
    std::vector<float> of_points;
    out.size.reserve(cells.points.size());
    for (int row = 0; row < cells.rows; ++row)
        for (int column = 0; column < cells.columns; ++column) {
            double met = 0, count = 0;
            for (int y = std::max(row - 1, 0); y <= std::min(row + 1, cells.rows - 1); ++y)
                for (int x = std::max(column - 1, 0); x <= std::min(column + 1, cells.columns - 1); ++x)
                    met += cells.at(x, y) > 0 ? 1 : 0, count += static_cast<double>(cells.at(x, y));
            const double on_cell = count > 0.0 ? points_on_cell(count / met) * static_cast<double>(stride) : 0.0;
            const double size = on_cell > 0.0 ? kOverlap * side * __builtin_sqrt(kLayers / on_cell) : least;
            out.size.push_back(static_cast<float>(std::clamp(size, least, most)));
            if (cells.at(column, row) > 0) of_points.push_back(out.size.back());
        }
    const auto middle = of_points.begin() + static_cast<std::ptrdiff_t>(of_points.size() / 2);
    std::nth_element(of_points.begin(), middle, of_points.end());
    out.usual = static_cast<int>(of_points.empty() ? least : *middle);
    return out;
}

}  // namespace halflit::raster
