#include "raster/view/sky_grid.hpp"

#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::raster {
namespace {

using Word = BitGrid::Word;

constexpr int kStride = 2;  ///< voxels from one point of the lattice to the next
/// Least distance of filled voxels from the border of the lattice, in spacings of its points; the border may be half a voxel further in.
constexpr float kLeastMargin = (kFreeVoxels - 1.5f) / kStride;
static_assert(shading::kGridFade < kLeastMargin, "the scene's own shares would fade");

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

SkyGrid grid_of(const FilledVoxels& voxels) {
    SkyGrid grid;
    if (voxels.bits.words.empty()) return grid;
    const int(&size)[3] = voxels.size;
    int points[3];
    for (int axis = 0; axis < 3; ++axis) {
        points[axis] = (size[axis] + kStride - 1) / kStride;
        grid.place.size[axis] = points[axis];
        grid.place.origin[axis] = static_cast<float>(voxels.origin[axis] + 0.5 / voxels.per_length);
    }
    grid.place.per_length = static_cast<float>(voxels.per_length / kStride);
    grid.masks.resize(std::size_t{2} * static_cast<std::size_t>(points[0]) * static_cast<std::size_t>(points[1]) *
                      static_cast<std::size_t>(points[2]));
    // A row's words: two bits of each direction, those of the second half from word 32 on.
    const int rows = points[1] * points[2];
    std::vector<std::array<Word, 64>> counts(static_cast<std::size_t>(rows));
    HiddenVoxels hidden(voxels.bits, size);
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

void make_sky_grid(const FilledVoxels& voxels, SkyGrid& grid) {
    if (grid.revision == voxels.revision) return;
    grid = grid_of(voxels);
    grid.revision = voxels.revision;
}

}  // namespace halflit::raster
