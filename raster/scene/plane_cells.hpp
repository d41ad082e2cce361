// Planes of triangles, and the cells of a grid that they fall into: those of one plane have a cell in common.
#pragma once

#include "raster/detail/view_math.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Rounding of a coordinate that went through some transforms in float32, relative to its size: 8 units in the last place.
inline constexpr double kRounding = 0x1p-20;

struct WorldBox {
    std::array<double, 3> low, high;

    void include(const WorldBox& other) {
        for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], other.low[k]), high[k] = std::max(high[k], other.high[k]);
    }
    [[nodiscard]] bool contains(const WorldBox& other) const {
        bool contains = true;
        for (std::size_t k = 0; k < 3; ++k) contains &= low[k] <= other.low[k] && other.high[k] <= high[k];
        return contains;
    }
    [[nodiscard]] bool meets(const WorldBox& other) const {
        bool meets = true;
        for (std::size_t k = 0; k < 3; ++k) meets &= low[k] <= other.high[k] && other.low[k] <= high[k];
        return meets;
    }
};

/// Table of the cells that planes fall into, and their materials.
class PlaneTable {
public:
    void begin(std::size_t triangles) {
        std::size_t size = 64;
        while (size < 2 * triangles) size *= 2;
        cells_.assign(size, {});
        mask_ = size - 1;
    }
    /// Adds a material to a cell. Returns the cell's place, or kNone if the table is too full.
    std::uint32_t add(std::uint64_t key, std::uint32_t material) {
        const std::uint64_t hash = key * 0x9e3779b97f4a7c15u;
        const auto print = static_cast<std::uint32_t>(hash);
        std::size_t place = static_cast<std::size_t>(hash >> 32) & mask_;
        for (int step = 0; step < kMostSteps; ++step, place = (place + 1) & mask_) {
            Cell& cell = cells_[place];
            if (cell.material == 0) cell = {print, material + 1};
            if (cell.print != print) continue;
            if (cell.material != material + 1) cell.material = kSeveral;
            return static_cast<std::uint32_t>(place);
        }
        return kNone;
    }
    [[nodiscard]] bool has_several(std::uint32_t place) const { return cells_[place].material == kSeveral; }

    static constexpr std::uint32_t kNone = 0xffffffffu;

private:
    static constexpr int kMostSteps = 64;
    static constexpr std::uint32_t kSeveral = 0xffffffffu;
    struct Cell {
        std::uint32_t print = 0, material = 0;  ///< part of the key's hash; 0: empty, 1 + material, or kSeveral
    };
    std::vector<Cell> cells_;
    std::size_t mask_ = 0;
};

/// The planes of a cluster's triangles. Cells are counted by the magnitudes of a normal's x and y and of the plane's distance from a place.
/// A plane near a cell's border falls into both cells. Triangles are arrays, so that the compiler can vectorise over them.
class ClusterPlanes {
public:
    /// middle: the place; over_radius: 1 over the distance that is cut into cells.
    void set_place(const float (&middle)[3], float over_radius) {
        std::copy_n(middle, 3, middle_);
        over_radius_ = over_radius;
    }
    /// Finds the planes of triangles [begin, begin + count). box: around them; reach: those that do not meet it are left out.
    void find(const Mesh& mesh, std::size_t begin, std::size_t count, const Mat4& world_from_object, const WorldBox& box,
              const WorldBox& reach) {
        place(mesh, begin, count, world_from_object);
        find_planes(count, box);
        if (!reach.contains(box)) find_outside(count, reach);
    }
    /// Calls visit(key) for each cell of a triangle's plane.
    template <class Visit>
    void each_cell(std::size_t i, const Visit& visit) const {
        if (is_inside_[i] == 0) return;
        const auto key = [](std::int32_t x, std::int32_t y, std::int32_t d) {
            return static_cast<std::uint64_t>(x << 10 | y) << 32 | static_cast<std::uint32_t>(d);
        };
        if (extended_[i] == 0) return visit(key(low_[0][i], low_[1][i], low_[2][i]));
        for (std::int32_t x = low_[0][i]; x <= high_[0][i]; ++x)
            for (std::int32_t y = low_[1][i]; y <= high_[1][i]; ++y)
                for (std::int32_t d = low_[2][i]; d <= high_[2][i]; ++d) visit(key(x, y, d));
    }

private:
    /// Cells for a magnitude of 1, and for the radius. Planes across an axis lie in the middle of cells.
    static constexpr float kCells = 256.0f, kDistanceCells = 1024.0f, kFirst = 16.5f;

    void place(const Mesh& mesh, std::size_t begin, std::size_t count, const Mat4& m) {
        const std::uint32_t* const index = mesh.indices.data() + 3 * begin;
        const Vec3f* const positions = mesh.positions.data();
        const bool moves = m != Mat4{};
        auto& to = moves ? of_mesh_ : at_;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f &a = positions[index[3 * i]], &b = positions[index[3 * i + 1]], &c = positions[index[3 * i + 2]];
            to[0][i] = a.x, to[1][i] = a.y, to[2][i] = a.z;
            to[3][i] = b.x, to[4][i] = b.y, to[5][i] = b.z;
            to[6][i] = c.x, to[7][i] = c.y, to[8][i] = c.z;
        }
        if (!moves) return;
        const float rows[3][4] = {
            {m.c[0].x, m.c[1].x, m.c[2].x, m.c[3].x}, {m.c[0].y, m.c[1].y, m.c[2].y, m.c[3].y}, {m.c[0].z, m.c[1].z, m.c[2].z, m.c[3].z}};
        for (int value = 0; value < 9; ++value) {
            const float r0 = rows[value % 3][0], r1 = rows[value % 3][1], r2 = rows[value % 3][2], r3 = rows[value % 3][3];
            const int corner = value - value % 3;
            const float *const x = of_mesh_[corner], *const y = of_mesh_[corner + 1], *const z = of_mesh_[corner + 2];
            float* const placed = at_[value];
            for (std::size_t i = 0; i < count; ++i) placed[i] = ((r0 * x[i] + r1 * y[i]) + r2 * z[i]) + r3;
        }
    }

    /// Marks triangles whose box is outside of another.
    void find_outside(std::size_t count, const WorldBox& reach) {
        const auto least = [](float a, float b, float c) { return a < b ? (a < c ? a : c) : (b < c ? b : c); };
        const auto most = [](float a, float b, float c) { return a > b ? (a > c ? a : c) : (b > c ? b : c); };
        for (std::size_t k = 0; k < 3; ++k) {
            const float low = static_cast<float>(reach.low[k]), high = static_cast<float>(reach.high[k]);
            const float *const a = at_[k], *const b = at_[3 + k], *const c = at_[6 + k];
            for (std::size_t i = 0; i < count; ++i)
                is_inside_[i] &= ((least(a[i], b[i], c[i]) <= high) & (most(a[i], b[i], c[i]) >= low)) ? -1 : 0;
        }
    }

    /// Finds the planes and the cells that they may fall into. box: of the triangles.
    void find_planes(std::size_t count, const WorldBox& box) {
        constexpr float kLeastSlack = 0x1p-14f, kMostSlack = 0x1p-9f, kUnit = static_cast<float>(kRounding), kFarthest = 0x1p20f;
        const auto size = [](float v) { return v < 0.0f ? -v : v; };
        const auto farthest = [&](std::size_t k) { return static_cast<float>(std::max(absolute(box.low[k]), absolute(box.high[k]))); };
        const float far_x = farthest(0), far_y = farthest(1), far_z = farthest(2);
        const float unit_of_far = 0.125f * kUnit * std::max({far_x, far_y, far_z});
        const float over_radius = over_radius_, middle_x = middle_[0], middle_y = middle_[1], middle_z = middle_[2];
        for (std::size_t i = 0; i < count; ++i) {
            const float x0 = at_[0][i], y0 = at_[1][i], z0 = at_[2][i], x1 = at_[3][i], y1 = at_[4][i], z1 = at_[5][i];
            const float x2 = at_[6][i], y2 = at_[7][i], z2 = at_[8][i];
            const float ax = x1 - x0, ay = y1 - y0, az = z1 - z0, bx = x2 - x0, by = y2 - y0, bz = z2 - z0;
            const float nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
            const float area = __builtin_sqrtf(nx * nx + ny * ny + nz * nz), some = area > 1e-30f ? area : 1e-30f, over_area = 1.0f / some;
            const float x = size(nx) * over_area, y = size(ny) * over_area, z = size(nz) * over_area;
            const float distance = size((nx * (x0 - middle_x) + ny * (y0 - middle_y)) + nz * (z0 - middle_z)) * over_area * over_radius;
            // The rounding of corners turns a normal by less than their rounding over the altitude, here below 2 area / perimeter.
            const float perimeter = size(ax) + size(ay) + size(az) + size(bx) + size(by) + size(bz);
            const float turned = unit_of_far * perimeter * over_area;
            const float normal_slack = turned > kLeastSlack ? (turned < kMostSlack ? turned : kMostSlack) : kLeastSlack;
            const float moved = kUnit * ((x * far_x + y * far_y) + z * far_z) * over_radius + normal_slack;
            plane_[0][i] = (x < 2.0f ? x : 2.0f) * kCells;
            plane_[1][i] = (y < 2.0f ? y : 2.0f) * kCells;
            plane_[2][i] = (distance < kFarthest / kDistanceCells ? distance : kFarthest / kDistanceCells) * kDistanceCells;
            slack_[0][i] = normal_slack * kCells;
            slack_[1][i] = (moved < 2.0f * kMostSlack ? moved : 2.0f * kMostSlack) * kDistanceCells;
            is_inside_[i] = ((area > 1e-30f) & (area < 1e30f)) ? -1 : 0;
        }
        for (std::size_t i = 0; i < count; ++i) extended_[i] = 0;
        for (int k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < count; ++i) {
                const float p = plane_[k][i] + kFirst, slack = slack_[k / 2][i];
                const auto low = static_cast<std::int32_t>(p - slack), high = static_cast<std::int32_t>(p + slack);
                low_[k][i] = low;
                high_[k][i] = high;
                extended_[i] |= high ^ low;
            }
    }

    float middle_[3] = {}, over_radius_ = 0.0f;
    alignas(64) float of_mesh_[9][kClusterTriangles], at_[9][kClusterTriangles];   ///< corners in object and world space: [3 corner + axis]
    alignas(64) float plane_[3][kClusterTriangles], slack_[2][kClusterTriangles];  ///< in cells; slack: of the normal, of the distance
    alignas(64) std::int32_t low_[3][kClusterTriangles], high_[3][kClusterTriangles];  ///< cells that the plane may fall into
    alignas(64) std::int32_t extended_[kClusterTriangles];                             ///< not 0: these are several
    alignas(64) std::int32_t is_inside_[kClusterTriangles];                            ///< not 0: it has an area and meets the box
};

}  // namespace halflit::raster
