// The bust is a distance field of ellipsoids, joined or cut out with rounded seams. Ellipsoids with x != 0 stand on both sides. A surface
// net turns the field into triangles: one vertex in each grid cell that the surface crosses, moved onto the surface, and one quad for each
// grid edge that the surface crosses.
#include "apps/lab/figure_bust.hpp"

#include "halflit/math.hpp"

#include <algorithm>
#include <array>

namespace halflit::cli {
namespace {

/// An ellipsoid. Its seam with the parts before it is rounded over the distance `blend`; `cut` takes it away instead of adding it.
struct Part {
    Vec3d center, radii;
    double blend;
    bool cut = false;
};

constexpr Part kParts[] = {
    {{0, 0.30, -0.14}, {0.70, 0.74, 0.86}, 0.05},           // cranium
    {{0, -0.22, 0.10}, {0.52, 0.74, 0.62}, 0.22},           // face
    {{0, -0.80, 0.46}, {0.19, 0.13, 0.19}, 0.24},           // chin
    {{0.27, -0.58, 0.12}, {0.19, 0.22, 0.34}, 0.24},        // jaw
    {{0.30, -0.20, 0.45}, {0.18, 0.15, 0.18}, 0.20},        // cheek
    {{0.24, 0.18, 0.60}, {0.23, 0.07, 0.13}, 0.13},         // brow
    {{0.25, 0.02, 0.80}, {0.17, 0.09, 0.17}, 0.14, true},   // eye socket
    {{0.25, 0.005, 0.565}, {0.145, 0.12, 0.145}, 0.03},     // eye
    {{0, -0.04, 0.70}, {0.07, 0.26, 0.12}, 0.12},           // bridge of the nose
    {{0, -0.25, 0.81}, {0.09, 0.08, 0.12}, 0.10},           // its tip
    {{0.09, -0.28, 0.74}, {0.065, 0.055, 0.085}, 0.06},     // its wings
    {{0.055, -0.465, 0.665}, {0.115, 0.045, 0.085}, 0.06},  // upper lip
    {{0, -0.555, 0.65}, {0.14, 0.05, 0.09}, 0.06},          // lower lip
    {{0.70, -0.04, -0.12}, {0.06, 0.20, 0.12}, 0.08},       // ear
    {{0, -1.20, -0.18}, {0.35, 0.80, 0.37}, 0.18},          // neck
    {{0.52, -1.80, -0.24}, {0.62, 0.34, 0.40}, 0.40},       // shoulder
    {{0, -1.95, -0.10}, {0.78, 0.46, 0.48}, 0.40},          // chest
};
constexpr double kFoot = -1.90;  ///< y where the bust is cut off
constexpr Vec3d kLow{-1.32, -2.0, -1.12}, kHigh{1.32, 1.16, 1.08};

double ellipsoid(Vec3d p, const Part& part) {
    const Vec3d d = p - part.center, q{d.x / part.radii.x, d.y / part.radii.y, d.z / part.radii.z};
    const Vec3d g{q.x / part.radii.x, q.y / part.radii.y, q.z / part.radii.z};
    const double k = length(q), slope = length(g);
    return slope > 1e-9 ? k * (k - 1) / slope : -part.radii.y;
}

/// min(a, b) with the corner rounded over k.
double smooth_min(double a, double b, double k) {
    const double h = std::max(k - (a > b ? a - b : b - a), 0.0) / k;
    return std::min(a, b) - h * h * k / 4;
}

/// The distance field, negative inside. Parts with x != 0 are evaluated on both sides; mirroring the point instead would leave a crease at
/// x = 0.
double field(Vec3d p) {
    double distance = 1e9;
    for (const Part& part : kParts)
        for (const double side : {1.0, -1.0}) {
            if (part.center.x == 0 && side < 0) continue;
            const double other = ellipsoid({side * p.x, p.y, p.z}, part);
            distance = part.cut ? -smooth_min(-distance, other, part.blend) : smooth_min(distance, other, part.blend);
        }
    return std::max(distance, kFoot - p.y);
}

Vec3d gradient(Vec3d p) {
    constexpr double h = 1e-3;
    return {field(p + Vec3d{h, 0, 0}) - field(p - Vec3d{h, 0, 0}), field(p + Vec3d{0, h, 0}) - field(p - Vec3d{0, h, 0}),
            field(p + Vec3d{0, 0, h}) - field(p - Vec3d{0, 0, h})};
}

/// Moves p onto the surface by three Newton steps. gradient() returns 2e-3 times the gradient.
Vec3d onto_surface(Vec3d p) {
    for (int i = 0; i < 3; ++i) {
        const Vec3d g = gradient(p);
        const double square = dot(g, g);
        if (square > 1e-12) p = p - g * (field(p) * 2e-3 / square);
    }
    return p;
}

class SurfaceNet {
public:
    explicit SurfaceNet(double cell) : cell_(cell) {
        const Vec3d size = kHigh - kLow;
        count_ = {steps(size.x), steps(size.y), steps(size.z)};
        values_.resize(points());
        vertex_.assign(points(), kNone);
        for (int k = 0; k < count_[2]; ++k)
            for (int j = 0; j < count_[1]; ++j)
                for (int i = 0; i < count_[0]; ++i) values_[index({i, j, k})] = field(at({i, j, k}));
    }

    Mesh mesh() {
        mesh_.name = "bust";
        for_cells([&](Cell c) { add_vertex(c); });
        for_cells([&](Cell c) {
            for (int axis = 0; axis < 3; ++axis) add_quad(c, axis);
        });
        return std::move(mesh_);
    }

private:
    using Cell = std::array<int, 3>;
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] int steps(double length) const { return static_cast<int>(length / cell_) + 2; }
    [[nodiscard]] std::size_t points() const { return index({0, 0, count_[2]}); }
    [[nodiscard]] std::size_t index(Cell c) const {
        return static_cast<std::size_t>(c[0]) +
               static_cast<std::size_t>(count_[0]) *
                   (static_cast<std::size_t>(c[1]) + static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(c[2]));
    }
    [[nodiscard]] Vec3d at(Cell c) const {
        return kLow + Vec3d{static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])} * cell_;
    }
    static Cell stepped(Cell c, int axis, int by) {
        c[static_cast<std::size_t>(axis)] += by;
        return c;
    }

    template <class Fn>
    void for_cells(Fn&& fn) {
        for (int k = 0; k + 1 < count_[2]; ++k)
            for (int j = 0; j + 1 < count_[1]; ++j)
                for (int i = 0; i + 1 < count_[0]; ++i) fn(Cell{i, j, k});
    }

    /// Adds a vertex at the mean of the points where the surface crosses the cell's twelve edges, moved onto the surface.
    void add_vertex(Cell cell) {
        Vec3d sum{0, 0, 0};
        int crossings = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 4; ++side) {
                const Cell a = stepped(stepped(cell, (axis + 1) % 3, side & 1), (axis + 2) % 3, side >> 1), b = stepped(a, axis, 1);
                const double fa = values_[index(a)], fb = values_[index(b)];
                if ((fa < 0) == (fb < 0)) continue;
                sum = sum + at(a) + (at(b) - at(a)) * (fa / (fa - fb));
                ++crossings;
            }
        if (crossings == 0) return;
        const Vec3d p = onto_surface(sum * (1.0 / crossings)), g = gradient(p);
        const auto to_float = [](Vec3d v) { return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; };
        vertex_[index(cell)] = static_cast<std::uint32_t>(mesh_.positions.size());
        mesh_.positions.push_back(to_float(p));
        mesh_.normals.push_back(normalize_or(to_float(g), {0, 1, 0}));
    }

    /// Adds a quad between the vertices of the four cells around the edge from `corner` along `axis`, if the surface crosses that edge.
    void add_quad(Cell corner, int axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (corner[static_cast<std::size_t>(u)] == 0 || corner[static_cast<std::size_t>(v)] == 0) return;
        const bool inside = values_[index(corner)] < 0;
        if (inside == (values_[index(stepped(corner, axis, 1))] < 0)) return;
        const Cell left = stepped(corner, u, -1);
        const std::uint32_t a = vertex_[index(stepped(left, v, -1))], b = vertex_[index(stepped(corner, v, -1))],
                            c = vertex_[index(corner)], d = vertex_[index(left)];
        if (inside)
            mesh_.indices.insert(mesh_.indices.end(), {a, b, c, a, c, d});
        else
            mesh_.indices.insert(mesh_.indices.end(), {a, c, b, a, d, c});
    }

    double cell_;
    Cell count_{};
    std::vector<double> values_;
    std::vector<std::uint32_t> vertex_;
    Mesh mesh_;
};

}  // namespace

Mesh make_bust(double cell) { return SurfaceNet(cell).mesh(); }

}  // namespace halflit::cli
