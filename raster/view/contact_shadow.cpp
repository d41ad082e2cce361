#include "raster/view/contact_shadow.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/view/projection.hpp"
#include "sh/smoothstep.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kUnstable = 0.3;  ///< of a scene's width: so far from its foot lies the middle of one that floats
/// A foot narrower than this, of the scene's width, has a paler shadow: most of what stands on a point floats, but balls do not.
constexpr double kNarrow = 0.35, kPalest = 0.33;

constexpr int kSide = kGroundCells;  ///< cells on a side of the map, as wide as the lattice's spacing
constexpr int kDirections = 32;
constexpr double kReach = 0.3;         ///< within which the shadow fades beside the foot, over the longest side
constexpr double kPictureFade = 0.06;  ///< from the picture's border, over its shorter side: a shadow is not cut off there

/// Memory for one direction.
struct Grounded {
    std::vector<float> sums = std::vector<float>(kSide * kGroundPitch), shares, x, z;
};

/// Sets the sums over layers of what they hide from each cell of the ground in a direction. first: cell of the lattice's first point;
/// filled: layers that hide something.
void cover(const CoverGrid& grid, double ground, const int (&first)[2], const std::vector<bool>& filled, int direction,
           const RasterKernels& kernels, Grounded& out) {
    const LatticeCovers& covers = grid.along_x;
    out.shares.resize(static_cast<std::size_t>(grid.size[2] + 3) * kGroundPitch);
    std::fill(out.sums.begin(), out.sums.end(), 0.0f);
    GroundCover layer{};
    layer.length = grid.size[0], layer.rows = grid.size[2], layer.row_step = covers.layout.layer_step;
    layer.first_x = first[0], layer.first_z = first[1];
    layer.shares = out.shares.data(), layer.sums = out.sums.data();
    // Points of a spiral that fills a disc evenly [Vog79], lifted to the half sphere above it: equal parts of its light (Malley).
    const double across = std::sqrt((direction + 0.5) / kDirections), up = std::sqrt(1.0 - across * across);
    const SinCos turn = sin_cos(2.0 * kPi * kGoldenTurn * direction);
    const double towards[3] = {turn.cos * across / up, 1.0, turn.sin * across / up};
    // Along a flat direction a layer's shadow is longer than a cell.
    layer.steps = std::max(1, static_cast<int>(std::ceil(std::max(absolute(towards[0]), absolute(towards[2])))));
    for (int k = 0; k < 3; ++k) {
        layer.towards[k] = static_cast<float>(towards[k] / layer.steps);
        layer.size[k] = static_cast<float>(absolute(towards[k]) / layer.steps);
    }
    for (int y = 0; y < grid.size[1]; ++y) {
        if (!filled[static_cast<std::size_t>(y)]) continue;
        const auto row = static_cast<std::size_t>(y);
        for (std::size_t k = 0; k < kCoverParts; ++k) layer.parts[k] = covers.parts[k].data() + row * kCoverPitch;
        layer.filled = covers.filled.data() + row;
        out.x.clear(), out.z.clear();
        for (int step = 0; step < layer.steps; ++step) {
            const double height = std::max(0.0, y - ground + (step + 0.5) / layer.steps - 0.5), beyond = 2.0 * kSide;
            out.x.push_back(static_cast<float>(std::clamp(towards[0] * height, -beyond, beyond)));
            out.z.push_back(static_cast<float>(std::clamp(towards[2] * height, -beyond, beyond)));
        }
        layer.x = out.x.data(), layer.z = out.z.data();
        kernels.cover_ground(layer);
    }
}

/// Sum over directions of equal light of the share that is hidden from each cell of the ground.
std::vector<float> hidden_sums(const CoverGrid& grid, double ground, const int (&first)[2], const RasterKernels& kernels,
                               const shading::ForEachRow& for_each) {
    constexpr int kAtOnce = 8;
    static_assert(kDirections % kAtOnce == 0);
    std::vector<bool> filled;
    for (int y = 0; y < grid.size[1]; ++y) {
        bool any = false;
        for (int k = 0; k < grid.size[2]; ++k) any |= grid.along_x.filled[static_cast<std::size_t>(k * grid.size[1] + y)] != 0;
        filled.push_back(any);
    }
    std::vector<float> out(kSide * kSide);
    std::vector<Grounded> of(kAtOnce);
    for (int begin = 0; begin < kDirections; begin += kAtOnce) {
        for_each(kAtOnce, [&](int i) { cover(grid, ground, first, filled, begin + i, kernels, of[static_cast<std::size_t>(i)]); });
        for (const Grounded& one : of)
            for (int row = 0; row < kSide; ++row) {
                const float* const from = &one.sums[static_cast<std::size_t>(row * kGroundPitch)];
                float* const to = &out[static_cast<std::size_t>(row * kSide)];
                for (int k = 0; k < kSide; ++k) to[k] += from[k] < 1.0f ? from[k] : 1.0f;
            }
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

/// 1: the middle of the scene lies above its foot, which is not narrow; down to 0.
double standing(const CoverGrid& grid) {
    const Foot& foot = grid.foot;
    if (foot.empty()) return 0.0;
    const double width = std::max(grid.width[0], grid.width[2]);
    double beside = 0.0, broad = 0.0;
    for (const int k : {0, 1}) {
        const double low = double{foot.low[k]}, high = double{foot.high[k]};
        beside = std::max(beside, std::max(low - grid.middle[k], grid.middle[k] - high) / width);
        broad = std::max(broad, (high - low) / (kNarrow * width));
    }
    return (1.0 - smoothstep(beside / kUnstable)) * (kPalest + (1.0 - kPalest) * smoothstep(broad));
}

ContactMap map_of(const CoverGrid& grid, const RasterKernels& kernels, const shading::ForEachRow& for_each) {
    ContactMap map;
    map.ground = grid.lowest;
    if (grid.empty()) return map;
    const double stands = standing(grid);
    if (!(stands > 0.0)) return map;
    map.per_length = grid.per_length;
    int first[2];
    double* const middle[2] = {&map.first_x, &map.first_z};
    for (const int k : {0, 1}) {
        first[k] = (kSide - grid.size[2 * k]) / 2;
        *middle[k] = grid.origin[2 * k] - first[k] / map.per_length;
    }
    map.hidden = hidden_sums(grid, (grid.lowest - grid.origin[1]) * grid.per_length, first, kernels, for_each);
    blur(map.hidden, 1), blur(map.hidden, kSide);
    const auto beside_foot = [&](int cell, int axis) {
        const double at = cell - first[axis];
        return std::max({0.0, double{grid.foot.low[axis]} - at, at - double{grid.foot.high[axis]}});
    };
    const double reach = kReach * std::max({grid.width[0], grid.width[1], grid.width[2]});
    float* out = map.hidden.data();
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x, ++out) {
            const double across = beside_foot(x, 0), along = beside_foot(z, 1), distance = std::sqrt(across * across + along * along);
            *out = static_cast<float>(double{*out} * (stands * smoothstep(1.0 - distance / reach) / kDirections));
            if (x == 0 || z == 0 || x == kSide - 1 || z == kSide - 1) *out = 0.0f;
            if (*out == 0.0f) continue;
            map.low[0] = std::min(map.low[0], x - 1), map.high[0] = std::max(map.high[0], x + 1);
            map.low[1] = std::min(map.low[1], z - 1), map.high[1] = std::max(map.high[1], z + 1);
        }
    return map;
}

}  // namespace

void make_contact_map(const CoverGrid& covers, const RasterKernels& kernels, const shading::ForEachRow& for_each, KeptContactMap& kept) {
    if (kept.revision == covers.revision) return;
    kept.map = std::make_shared<const ContactMap>(map_of(covers, kernels, for_each));
    kept.revision = covers.revision;
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

void ContactShadow::row(const RasterKernels& kernels, int x_px, int y_px, int count, float* opacity) const {
    if (!touches({x_px, y_px, count, 1})) {
        std::fill_n(opacity, count, 0.0f);
        return;
    }
    const double middle = y_px + 0.5;
    const auto in_row = [&](double(&to)[3], Vec3d of) { to[0] = of.x, to[1] = of.y * middle, to[2] = of.z; };
    GroundShadow shadow{};
    shadow.hidden = map_->hidden.data();
    in_row(shadow.weight, weight_), in_row(shadow.cell_x, cell_of_x_), in_row(shadow.cell_z, cell_of_z_);
    shadow.width = width_, shadow.border = std::min(y_px, height_ - 1 - y_px);
    shadow.fade_px = fade_px_, shadow.opacity = opacity_;
    kernels.shadow_row(shadow, x_px, count, opacity);
}

}  // namespace halflit::raster
