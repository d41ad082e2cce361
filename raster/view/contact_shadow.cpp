#include "raster/view/contact_shadow.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/view/projection.hpp"
#include "sh/smoothstep.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kFoot = 0.02;     ///< of a scene's height
constexpr double kUnstable = 0.3;  ///< of a scene's width: so far from its foot lies the middle of one that floats
/// A foot narrower than this, of the scene's width, has a paler shadow: most of what stands on a point floats, but balls do not.
constexpr double kNarrow = 0.35, kPalest = 0.33;

constexpr int kSide = 64;       ///< cells on a side of the map: bits of a word
constexpr int kCellVoxels = 2;  ///< along each axis
constexpr int kDirections = 64, kCountBits = std::bit_width(unsigned{kDirections});
constexpr double kReach = 0.3;         ///< within which the shadow fades beside the foot, over the longest side
constexpr double kPictureFade = 0.06;  ///< from the picture's border, over its shorter side: a shadow is not cut off there

using Word = BitGrid::Word;

/// The scene's voxels by cells of the map: a layer of rows of z for each height above the ground, bits along x.
BitGrid cells_above(const FilledVoxels& voxels, int ground_row, const int (&first)[2]) {
    BitGrid cells((voxels.size[1] - ground_row + kCellVoxels - 1) / kCellVoxels, kSide);
    for (int z = 0; z < voxels.size[2]; ++z)
        for (int y = ground_row; y < voxels.size[1]; ++y) {
            Word& row = cells.row((y - ground_row) / kCellVoxels, first[1] + z / kCellVoxels);
            for (Word left = voxels.bits.row(z, y); left != 0; left &= left - 1)
                row |= Word{1} << (first[0] + std::countr_zero(left) / kCellVoxels);
        }
    return cells;
}

/// Finds the cells of the ground from which the sky is hidden in a direction. x, z: how far that goes in a cell's height. first_row,
/// end_row: of the cells that something may fill.
void add_hidden(const BitGrid& cells, int first_row, int end_row, double x, double z, Word (&hidden)[kSide]) {
    // From the bottom of a layer to that of the next one so often that it moves by at most a cell.
    const int steps = std::max(1, static_cast<int>(std::ceil(std::max(absolute(x), absolute(z)))));
    for (int k = 0; k < cells.layers; ++k) {
        const Word* const layer = cells.layer(k);
        for (int step = 0; step < steps; ++step) {
            const double height = k + static_cast<double>(step) / steps;
            const int bits = static_cast<int>(std::floor(x * height + 0.5)), rows = static_cast<int>(std::floor(z * height + 0.5));
            if (bits <= -kSide || bits >= kSide) break;
            const int begin = std::max(0, first_row - rows), end = std::min(kSide, end_row - rows);
            if (bits < 0)
                for (int r = begin; r < end; ++r) hidden[r] |= layer[r + rows] << -bits;
            else
                for (int r = begin; r < end; ++r) hidden[r] |= layer[r + rows] >> bits;
        }
    }
}

/// Number of directions of equal light in which each cell's sky is hidden.
std::vector<float> hidden_counts(const BitGrid& cells, int first_row, int end_row) {
    Word counts[kCountBits][kSide] = {};
    for (int i = 0; i < kDirections; ++i) {
        // Points of a spiral that fills a disc evenly [Vog79], lifted to the half sphere above it: equal parts of its light (Malley).
        const double across = std::sqrt((i + 0.5) / kDirections), up = std::sqrt(1.0 - across * across);
        const SinCos turn = sin_cos(2.0 * kPi * kGoldenTurn * i);
        Word hidden[kSide] = {};
        add_hidden(cells, first_row, end_row, turn.cos * across / up, turn.sin * across / up, hidden);
        for (int r = 0; r < kSide; ++r)
            for (Word(&plane)[kSide] : counts) {
                const Word carry = plane[r] & hidden[r];
                plane[r] ^= hidden[r];
                hidden[r] = carry;
            }
    }
    std::vector<float> out;
    for (int r = 0; r < kSide; ++r)
        for (int x = 0; x < kSide; ++x) {
            unsigned count = 0;
            for (unsigned k = 0; k < kCountBits; ++k) count |= static_cast<unsigned>(counts[k][r] >> x & 1u) << k;
            out.push_back(static_cast<float>(count));
        }
    return out;
}

/// Weights 1, 4, 6, 4, 1 along both axes, so that no direction's edge is seen.
void blur(std::vector<float>& values, int step) {
    const std::vector<float> from = values;
    for (int at = 0; at < kSide * kSide; ++at) {
        const int place = at / step % kSide;
        const auto value = [&](int by) {
            return from[static_cast<std::size_t>(at + (std::clamp(place + by, 0, kSide - 1) - place) * step)];
        };
        values[static_cast<std::size_t>(at)] = (6.0f * value(0) + 4.0f * (value(-1) + value(1)) + (value(-2) + value(2))) * (1.0f / 16.0f);
    }
}

/// Calls visit(x, z) for each column that has a filled voxel in a row from first to before end.
template <class Visit>
void each_column(const FilledVoxels& voxels, int first, int end, const Visit& visit) {
    for (int z = 0; z < voxels.size[2]; ++z) {
        Word any = 0;
        for (int y = std::max(first, 0); y < std::min(end, voxels.size[1]); ++y) any |= voxels.bits.row(z, y);
        for (; any != 0; any &= any - 1) visit(std::countr_zero(any), z);
    }
}

/// A rectangle around columns, voxels along x and z; empty while low > high.
struct GroundBox {
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    void add(int x, int z) {
        const int at[2] = {x, z};
        for (const int k : {0, 1}) low[k] = std::min(low[k], static_cast<double>(at[k])), high[k] = std::max(high[k], at[k] + 1.0);
    }
    [[nodiscard]] double width() const { return std::max(high[0] - low[0], high[1] - low[1]); }
};

/// Where a scene stands: all that lies a little above its lowest point.
struct Foot {
    GroundBox box;
    double standing = 0;  ///< 1: the middle of the scene lies above it, and it is not narrow; down to 0
};

Foot foot_of(const FilledVoxels& voxels, double ground) {
    GroundBox all;
    double sum[2] = {0, 0}, count = 0;
    int top = 0;
    for (int y = 0; y < voxels.size[1]; ++y)
        each_column(voxels, y, y + 1, [&](int x, int z) {
            all.add(x, z);
            sum[0] += x + 0.5, sum[1] += z + 0.5, count += 1.0, top = y + 1;
        });
    Foot foot;
    const double reach = std::max(1.0, kFoot * (top - ground));
    each_column(voxels, static_cast<int>(ground), static_cast<int>(ground + reach) + 1, [&](int x, int z) { foot.box.add(x, z); });
    if (foot.box.low[0] > foot.box.high[0]) return foot;
    double beside = 0.0;
    for (const int k : {0, 1}) {
        const double middle = sum[k] / count;
        beside = std::max(beside, std::max(foot.box.low[k] - middle, middle - foot.box.high[k]) / all.width());
    }
    const double broad = smoothstep(foot.box.width() / (kNarrow * all.width()));
    foot.standing = (1.0 - smoothstep(beside / kUnstable)) * (kPalest + (1.0 - kPalest) * broad);
    return foot;
}

ContactMap map_of(const FilledVoxels& voxels) {
    ContactMap map;
    map.ground = voxels.lowest;
    if (voxels.bits.words.empty()) return map;
    const double ground = (voxels.lowest - voxels.origin[1]) * voxels.per_length;
    if (!(ground >= 0.0 && ground < voxels.size[1])) return map;
    const Foot foot = foot_of(voxels, ground);
    if (!(foot.standing > 0.0)) return map;
    map.per_length = voxels.per_length / kCellVoxels;
    int first[2];  // cell of the first voxel
    double* const middle[2] = {&map.first_x, &map.first_z};
    for (const int k : {0, 1}) {
        first[k] = (kSide - voxels.size[2 * k] / kCellVoxels) / 2;
        *middle[k] = voxels.origin[2 * k] + (0.5 - first[k]) / map.per_length;
    }
    const int end_row = first[1] + (voxels.size[2] + kCellVoxels - 1) / kCellVoxels;
    map.hidden = hidden_counts(cells_above(voxels, static_cast<int>(ground), first), first[1], end_row);
    blur(map.hidden, 1), blur(map.hidden, kSide);
    const auto beside_foot = [&](int cell, int axis) {
        const double at = (cell - first[axis] + 0.5) * kCellVoxels;
        return std::max({0.0, foot.box.low[axis] - at, at - foot.box.high[axis]});
    };
    const double reach = kReach * (std::max({voxels.size[0], voxels.size[1], voxels.size[2]}) - 2 * kFreeVoxels);
    float* out = map.hidden.data();
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x, ++out) {
            const double across = beside_foot(x, 0), along = beside_foot(z, 1), distance = std::sqrt(across * across + along * along);
            *out = static_cast<float>(double{*out} * (foot.standing * smoothstep(1.0 - distance / reach) / kDirections));
            if (*out == 0.0f) continue;
            map.low[0] = std::min(map.low[0], x - 1), map.high[0] = std::max(map.high[0], x + 1);
            map.low[1] = std::min(map.low[1], z - 1), map.high[1] = std::max(map.high[1], z + 1);
        }
    return map;
}

}  // namespace

void make_contact_map(const FilledVoxels& voxels, KeptContactMap& kept) {
    if (kept.revision == voxels.revision) return;
    kept.map = std::make_shared<const ContactMap>(map_of(voxels));
    kept.revision = voxels.revision;
}

ContactShadow::ContactShadow(std::shared_ptr<const ContactMap> map, const Camera& camera, int width, int height, float opacity)
    : width_(width), height_(height), fade_px_(kPictureFade * std::min(width, height)), opacity_(opacity) {
    if (map == nullptr || map->hidden.empty() || camera.orthographic || !(camera.world_from_camera.c[3].y > map->ground)) return;
    const Mat4 clip = clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    const double ground = map->ground;
    // (x, y, w) of the picture from (x, z, 1) of the ground, and back.
    const auto row = [&](float Vec4f::*of) {
        return Vec3d{clip.c[0].*of, clip.c[2].*of, double{clip.c[1].*of} * ground + double{clip.c[3].*of}};
    };
    const Vec3d x = row(&Vec4f::x), y = row(&Vec4f::y), w = row(&Vec4f::w);
    const double determinant = dot(x, cross(y, w));
    if (!(absolute(determinant) > 0.0)) return;
    const Vec3d columns_of_inverse[3] = {cross(y, w) * (1.0 / determinant), cross(w, x) * (1.0 / determinant),
                                         cross(x, y) * (1.0 / determinant)};
    const auto inverse_row = [&](double Vec3d::*of) {
        return Vec3d{columns_of_inverse[0].*of, columns_of_inverse[1].*of, columns_of_inverse[2].*of};
    };
    const Vec3d of_weight = inverse_row(&Vec3d::z);
    // The row as a factor on (x, y, 1) in pixels.
    const auto in_pixels = [&](Vec3d row_of_picture) {
        return Vec3d{row_of_picture.x * (2.0 / width_), row_of_picture.y * (-2.0 / height_),
                     (row_of_picture.z - row_of_picture.x) + row_of_picture.y};
    };
    weight_ = in_pixels(of_weight);
    cell_of_x_ = in_pixels((inverse_row(&Vec3d::x) - of_weight * map->first_x) * map->per_length);
    cell_of_z_ = in_pixels((inverse_row(&Vec3d::y) - of_weight * map->first_z) * map->per_length);
    // The rectangle around the shadow's corners, if all lie before the eye.
    double low[2] = {static_cast<double>(width), static_cast<double>(height)}, high[2] = {0, 0};
    for (int corner = 0; corner < 4; ++corner) {
        const Vec3d at{map->first_x + ((corner & 1) != 0 ? map->high : map->low)[0] / map->per_length,
                       map->first_z + ((corner & 2) != 0 ? map->high : map->low)[1] / map->per_length, 1.0};
        const double depth = dot(w, at);
        const double place[2] = {(0.5 + 0.5 * dot(x, at) / depth) * width_, (0.5 - 0.5 * dot(y, at) / depth) * height_};
        for (int k = 0; k < 2; ++k) {
            const double most = k == 0 ? width_ : height_;
            low[k] = depth > 0.0 ? std::min(low[k], clamped(place[k], 0.0, most)) : 0.0;
            high[k] = depth > 0.0 ? std::max(high[k], clamped(place[k], 0.0, most)) : most;
        }
    }
    around_ = {static_cast<int>(low[0]), static_cast<int>(low[1]), 0, 0};
    around_.width = static_cast<int>(std::ceil(high[0])) - around_.x;
    around_.height = static_cast<int>(std::ceil(high[1])) - around_.y;
    if (around_.width > 0 && around_.height > 0) map_ = std::move(map);
}

bool ContactShadow::touches(const Region& rect) const {
    return map_ != nullptr && rect.x < around_.x + around_.width && around_.x < rect.x + rect.width &&
           rect.y < around_.y + around_.height && around_.y < rect.y + rect.height;
}

float ContactShadow::at(int x_px, int y_px) const {
    if (!touches({x_px, y_px, 1, 1})) return 0.0f;
    const Vec3d place{x_px + 0.5, y_px + 0.5, 1.0};
    const double weight = dot(weight_, place);
    if (!(weight > 0.0)) return 0.0f;
    const double per_weight = 1.0 / weight, x = dot(cell_of_x_, place) * per_weight, z = dot(cell_of_z_, place) * per_weight;
    if (!(x >= 0.0 && x < kSide - 1 && z >= 0.0 && z < kSide - 1)) return 0.0f;
    const int i = static_cast<int>(x), k = static_cast<int>(z);
    const float* const upper = &map_->hidden[static_cast<std::size_t>(k * kSide + i)];
    const float* const lower = upper + kSide;
    const double u = x - i, v = z - k;
    const double above = upper[0] + (double{upper[1]} - upper[0]) * u, below = lower[0] + (double{lower[1]} - lower[0]) * u;
    const double share = above + (below - above) * v;
    const int border = std::min(std::min(x_px, y_px), std::min(width_ - 1 - x_px, height_ - 1 - y_px));
    return static_cast<float>(share * (border < fade_px_ ? opacity_ * smoothstep(border / fade_px_) : opacity_));
}

}  // namespace halflit::raster
