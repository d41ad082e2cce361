#include "raster/view/sky_grid.hpp"

#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr int kMostVoxels = 64;   ///< on a side: bits of a word
constexpr int kFreeVoxels = 4;    ///< at each side of the scene: where its outermost surfaces read
constexpr int kStride = 2;        ///< voxels from one point of the lattice to the next
constexpr double kSpacing = 0.6;  ///< between points that mark a triangle's voxels, voxels
constexpr double kPhase = 0.38;   ///< of the voxels' borders, so that round coordinates, which are rounded in many ways, are none

using Word = std::uint64_t;

/// The bit of matrix[r] at c goes to that of matrix[c] at r.
void transpose(std::array<Word, 64>& matrix) {
    Word mask = 0x00000000FFFFFFFFu;
    for (unsigned step = 32; step != 0; step >>= 1, mask ^= mask << step)
        for (unsigned r = 0; r < 64; r = ((r | step) + 1) & ~step) {
            const Word swapped = ((matrix[r] >> step) ^ matrix[r | step]) & mask;
            matrix[r] ^= swapped << step;
            matrix[r | step] ^= swapped;
        }
}

/// Bits in rows along one axis, which lie in layers.
struct BitGrid {
    int layers = 0, rows = 0;
    std::vector<Word> words;

    BitGrid(int layer_count, int row_count)
        : layers(layer_count), rows(row_count), words(static_cast<std::size_t>(layer_count) * static_cast<std::size_t>(row_count)) {}
    [[nodiscard]] Word* layer(int at) { return &words[index(at, 0)]; }
    [[nodiscard]] const Word* layer(int at) const { return &words[index(at, 0)]; }
    [[nodiscard]] Word& row(int layer, int at) { return words[index(layer, at)]; }
    [[nodiscard]] Word row(int layer, int at) const { return words[index(layer, at)]; }

private:
    [[nodiscard]] std::size_t index(int layer, int at) const { return static_cast<std::size_t>(layer * rows + at); }
};

/// Bits of the voxels that something fills.
class FilledVoxels {
public:
    FilledVoxels(const double (&origin)[3], double per_length, const int (&size)[3]) : per_length_(per_length), bits_(size[2], size[1]) {
        for (int axis = 0; axis < 3; ++axis) origin_[axis] = origin[axis], size_[axis] = size[axis];
    }
    [[nodiscard]] const BitGrid& bits() const { return bits_; }

    [[nodiscard]] Vec3d place(Vec3f p) const {
        return {(double{p.x} - origin_[0]) * per_length_, (double{p.y} - origin_[1]) * per_length_,
                (double{p.z} - origin_[2]) * per_length_};
    }
    void mark(Vec3d p) {
        // Comparisons are false for what is not a number.
        if (!(p.x >= 0.0 && p.x < size_[0] && p.y >= 0.0 && p.y < size_[1] && p.z >= 0.0 && p.z < size_[2])) return;
        bits_.row(static_cast<int>(p.z), static_cast<int>(p.y)) |= Word{1} << static_cast<int>(p.x);
    }
    void mark(Vec3d a, Vec3d b, Vec3d c) {
        const Vec3d ab = b - a, bc = c - b, ca = a - c;
        const double longest = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
        mark(a);
        if (!(longest > kSpacing * kSpacing)) return;
        mark(b), mark(c);
        if (!(longest < 1e18)) return;
        // Rows along the longest side, from it to the third corner.
        Vec3d from = a, to = b, third = c;
        if (longest == dot(bc, bc))
            from = b, to = c, third = a;
        else if (longest == dot(ca, ca))
            from = c, to = a, third = b;
        const Vec3d across = cross(to - from, third - from);
        const double height = std::sqrt(dot(across, across) / longest);
        const int rows = steps(height);
        for (int r = 0; r <= rows; ++r) {
            const double up = static_cast<double>(r) / rows;
            const Vec3d begin = from + (third - from) * up, side = (to + (third - to) * up) - begin;
            mark_line(begin, side);
        }
    }

private:
    [[nodiscard]] static int steps(double length) { return static_cast<int>(std::min(std::ceil(length / kSpacing), 1e6)) | 1; }
    /// Only the part within the grid, as a triangle may reach far beyond it.
    void mark_line(Vec3d begin, Vec3d side) {
        double first = 0.0, last = 1.0;
        const double at[3] = {begin.x, begin.y, begin.z}, along[3] = {side.x, side.y, side.z};
        for (int axis = 0; axis < 3; ++axis) {
            const double to_low = -at[axis], to_high = size_[axis] - at[axis];
            if (along[axis] == 0.0) {
                if (to_low > 0.0 || to_high < 0.0) return;
                continue;
            }
            const double one = to_low / along[axis], other = to_high / along[axis];
            first = std::max(first, std::min(one, other));
            last = std::min(last, std::max(one, other));
        }
        if (!(first <= last)) return;
        const int count = steps(length(side) * (last - first));
        for (int k = 0; k <= count; ++k) mark(begin + side * (first + (last - first) * (static_cast<double>(k) / count)));
    }

    double origin_[3], per_length_;
    int size_[3];
    BitGrid bits_;
};

bool hides(const Scene& scene, const Instance& instance) {
    if (!counts_for_views(scene, instance)) return false;
    const Material* const material = material_of(scene, instance);
    return material == nullptr || (material->alpha_mode == AlphaMode::opaque && !material->is_layer());
}

void fill(const PreparedData& prepared, FilledVoxels& filled) {
    TimeCheck check;
    constexpr std::size_t kMostKept = std::size_t{1} << 18;  // vertices; more would take much memory
    const Scene& scene = prepared.scene();
    std::vector<Vec3d> places;
    for (const Instance& instance : scene.instances) {
        if (!hides(scene, instance)) continue;
        const Mesh& mesh = prepared.source_mesh(instance.mesh);
        if (mesh.topology != Topology::triangles) continue;
        const auto place = [&](std::size_t vertex) {
            return filled.place(transform_point(instance.world_from_object, mesh.positions[vertex]));
        };
        const bool kept = mesh.positions.size() <= kMostKept && mesh.positions.size() < mesh.indices.size();
        places.clear();
        for (std::size_t v = 0; kept && v < mesh.positions.size(); ++v) places.push_back(place(v));
        const auto corner = [&](std::size_t i) { return kept ? places[mesh.indices[i]] : place(mesh.indices[i]); };
        for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
            check();
            filled.mark(corner(i), corner(i + 1), corner(i + 2));
        }
    }
}

/// Finds the voxels that something hides one way, which goes on by one layer at a time; bit, row: how far it goes across a layer meanwhile.
void sweep(const BitGrid& filled, double bit, double row, bool from_last, BitGrid& hidden) {
    const auto shift = [](double slope, int k) {
        return static_cast<int>(std::floor((k + 1) * slope + 0.5)) - static_cast<int>(std::floor(k * slope + 0.5));
    };
    for (int k = 0; k < filled.layers; ++k) {
        const int layer = from_last ? filled.layers - 1 - k : k, next = from_last ? layer + 1 : layer - 1;
        if (k == 0) {
            std::fill_n(hidden.layer(layer), hidden.rows, 0);
            continue;
        }
        const int bits = shift(bit, k - 1), rows = shift(row, k - 1);
        const int first = std::max(0, -rows), end = std::min(filled.rows, filled.rows - rows);
        const Word* const solid = filled.layer(next);
        const Word* const before = hidden.layer(next);
        Word* const out = hidden.layer(layer);
        std::fill_n(out, first, 0);
        std::fill(out + end, out + filled.rows, 0);
        if (bits > 0)
            for (int r = first; r < end; ++r) out[r] = (solid[r + rows] | before[r + rows]) >> 1;
        else if (bits < 0)
            for (int r = first; r < end; ++r) out[r] = (solid[r + rows] | before[r + rows]) << 1;
        else
            for (int r = first; r < end; ++r) out[r] = solid[r + rows] | before[r + rows];
    }
}

/// The hidden voxels of all directions. Rows of the grid lie along x, in layers of z.
class HiddenVoxels {
public:
    HiddenVoxels(const BitGrid& filled, const int (&size)[3])
        : filled_(filled),
          by_y_(size[1], size[2]),
          by_x_(size[0], size[2]),
          hidden_by_z_(size[2], size[1]),
          hidden_by_y_(size[1], size[2]),
          hidden_by_x_(size[0], size[2]) {
        for (int axis = 0; axis < 3; ++axis) size_[axis] = size[axis];
        for (int z = 0; z < size[2]; ++z) {
            std::array<Word, 64> plane{};
            for (int y = 0; y < size[1]; ++y) plane[static_cast<std::size_t>(y)] = by_y_.row(y, z) = filled.row(z, y);
            transpose(plane);
            for (int x = 0; x < size[0]; ++x) by_x_.row(x, z) = plane[static_cast<std::size_t>(x)];
        }
    }

    /// Calls keep(row, bits) for each row of the lattice, which are those of every kStride-th layer and row. Bits: what is hidden this way.
    template <class Keep>
    void each_row(Vec3d towards, const Keep& keep) {
        const double x = towards.x, y = towards.y, z = towards.z, ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
        int at = 0;
        if (az >= ax && az >= ay) {
            sweep(filled_, x / az, y / az, z > 0.0, hidden_by_z_);
            for (int k = 0; k < size_[2]; k += kStride)
                for (int j = 0; j < size_[1]; j += kStride) keep(at++, hidden_by_z_.row(k, j));
        } else if (ay >= ax) {
            sweep(by_y_, x / ay, z / ay, y > 0.0, hidden_by_y_);
            for (int k = 0; k < size_[2]; k += kStride)
                for (int j = 0; j < size_[1]; j += kStride) keep(at++, hidden_by_y_.row(j, k));
        } else {
            sweep(by_x_, y / ax, z / ax, x > 0.0, hidden_by_x_);
            for (int k = 0; k < size_[2]; k += kStride) {
                std::array<Word, 64> plane{};
                for (int i = 0; i < size_[0]; ++i) plane[static_cast<std::size_t>(i)] = hidden_by_x_.row(i, k);
                transpose(plane);
                for (int j = 0; j < size_[1]; j += kStride) keep(at++, plane[static_cast<std::size_t>(j)]);
            }
        }
    }

private:
    const BitGrid& filled_;
    BitGrid by_y_, by_x_;  ///< the same in layers of y, and in layers of x with rows along y
    BitGrid hidden_by_z_, hidden_by_y_, hidden_by_x_;
    int size_[3];
};

/// Ways about a direction, a third of a turn from each other: so the edges of what hides it are soft. Not unit.
std::array<Vec3d, shading::kGridWays> ways_about(Vec3d towards, int direction) {
    const Vec3d side = std::abs(towards.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d u = cross(side, towards) * (1.0 / length(cross(side, towards))), v = cross(towards, u);
    std::array<Vec3d, shading::kGridWays> ways;
    for (int k = 0; k < shading::kGridWays; ++k) {
        const SinCos turn = sin_cos(2.0 * kPi * (static_cast<double>(k) / shading::kGridWays + 0.618 * direction));
        ways[static_cast<std::size_t>(k)] = towards + (u * turn.cos + v * turn.sin) * shading::kGridWayTangent;
    }
    return ways;
}

/// The next one of 1, 1.25, 1.5 and 1.75 times the powers of 2.
double rounded_up(double x) {
    int exponent = 0;
    const double part = std::frexp(x, &exponent);  // 0.5 to 1
    return std::ldexp(std::ceil(part * 8.0) / 8.0, exponent);
}

SkyGrid grid_of(const PreparedData& scene) {
    SkyGrid grid;
    const Bounds& bounds = scene.framed_bounds();
    if (bounds.empty) return grid;
    const Vec3d low = to_double(bounds.min), high = to_double(bounds.max), side = high - low, middle = (low + high) * 0.5;
    const double longest = std::max({side.x, side.y, side.z});
    if (!(longest > 1e-6 * length(middle) && longest > 1e-18 && longest < 1e18)) return grid;
    // Sizes are steps, and voxels lie at multiples of their size: where parts of a scene move, most frames have one grid.
    const double voxel = rounded_up(longest / (kMostVoxels - 2 * kFreeVoxels - 1)), per_length = 1.0 / voxel;
    const double lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    double origin[3];
    int size[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double first = std::floor(lows[axis] / voxel - kPhase) - kFreeVoxels,
                     last = std::floor(highs[axis] / voxel - kPhase) + kFreeVoxels;
        origin[axis] = (first + kPhase) * voxel;
        size[axis] = std::min(kMostVoxels, static_cast<int>(last - first) + 1);
    }
    FilledVoxels filled(origin, per_length, size);
    fill(scene, filled);
    int points[3];
    for (int axis = 0; axis < 3; ++axis) {
        points[axis] = (size[axis] + kStride - 1) / kStride;
        grid.place.size[axis] = points[axis];
        grid.place.origin[axis] = static_cast<float>(origin[axis] + 0.5 / per_length);
    }
    grid.place.per_length = static_cast<float>(per_length / kStride);
    grid.masks.resize(std::size_t{2} * static_cast<std::size_t>(points[0]) * static_cast<std::size_t>(points[1]) *
                      static_cast<std::size_t>(points[2]));
    // A row's words: two bits of each direction, those of the second half from word 32 on.
    const int rows = points[1] * points[2];
    std::vector<std::array<Word, 64>> counts(static_cast<std::size_t>(rows));
    HiddenVoxels hidden(filled.bits(), size);
    int direction = 0;
    for (const Vec3d& towards : shading::sky_directions(shading::kGridDirections)) {
        const auto low_bit = static_cast<std::size_t>(32 * (direction / shading::kGridInWord) + 2 * (direction % shading::kGridInWord));
        for (const Vec3d& way : ways_about(towards, direction))
            hidden.each_row(way, [&](int row, Word word) {
                Word &ones = counts[static_cast<std::size_t>(row)][low_bit], &twos = counts[static_cast<std::size_t>(row)][low_bit + 1];
                twos ^= ones & word;
                ones ^= word;
            });
        ++direction;
    }
    std::int32_t* out = grid.masks.data();
    for (std::array<Word, 64>& columns : counts) {
        if (std::all_of(columns.begin(), columns.end(), [](Word word) { return word == 0; })) {
            out += 2 * points[0];
            continue;
        }
        transpose(columns);
        for (int x = 0; x < points[0]; ++x) {
            const Word words = columns[static_cast<std::size_t>(kStride * x)];
            *out++ = static_cast<std::int32_t>(static_cast<std::uint32_t>(words));
            *out++ = static_cast<std::int32_t>(static_cast<std::uint32_t>(words >> 32));
        }
    }
    return grid;
}

}  // namespace

void make_sky_grid(const PreparedData& scene, SkyGrid& grid) {
    SceneRevision revision = scene.revision();
    revision.lights = 0;
    if (grid.revision == revision) return;
    grid.revision.reset();  // until it is made, as the time may end before
    grid = grid_of(scene);
    grid.revision = revision;
}

}  // namespace halflit::raster
