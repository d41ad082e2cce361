#include "raster/fixed/shadow_lookups.hpp"

#include "raster/fixed/projection.hpp"
#include "raster/view/culling.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <limits>

namespace halflit::raster {
namespace {

constexpr std::size_t kRoom = 16;  // whole vectors are read
constexpr float kFarAway = 2.0f;   ///< reversed depth that nothing is nearer than

Mat4 clip_of(const FixedLight& light) {
    const Vec3f d = normalize_or(light.direction_ws, {0, 0, -1}), across = cross(d, Vec3f{-1, 0, 0});
    const Vec3f up = dot(across, across) > 0.01f ? across : cross(d, Vec3f{0, 1, 0});
    Frustum frustum{};
    frustum.parallel = light.directional;
    frustum.near_z = light.shadow_near, frustum.far_z = light.shadow_far;
    const SinCos half = sin_cos(light.shadow_fov_deg * (kPi / 360.0));
    const double extent = light.directional ? double{light.shadow_half_width} : half.sin / half.cos * light.shadow_near;
    frustum.left = frustum.bottom = -extent;
    frustum.right = frustum.top = extent;
    return multiply_in_double(clip_from_view(frustum), view_from_world(light.position_ws, d, up));
}

}  // namespace

LightMap::LightMap(const FixedLight& light) : clip_from_world_(clip_of(light)), size_(static_cast<float>(light.shadow_size)) {
    // A border of one texel stays empty, so that nothing beyond the map is in shadow.
    Mat4 inside = clip_from_world_;
    const float part = (size_ - 2.0f) / size_;
    for (Vec4f& c : inside.c) c.x *= part, c.y *= part;
    view_ = make_view(inside, light.shadow_size, light.shadow_size, {}, kMaxTileSize, 1);
}

MapPlace LightMap::of(Vec3f p) const {
    const Vec4f clip = ((clip_from_world_.c[0] * p.x + clip_from_world_.c[1] * p.y) + clip_from_world_.c[2] * p.z) + clip_from_world_.c[3];
    const auto held = [](float x, float most) { return x > 0.0f ? (x < most ? x : most) : 0.0f; };
    const float inv = 1.0f / clip.w, last = size_ - 1.0f;
    const int x = static_cast<int>(held((clip.x * inv * 0.5f + 0.5f) * size_, last));
    const int up = static_cast<int>(held((clip.y * inv * 0.5f + 0.5f) * size_, last));
    // Triangles beyond the map reach into its border, which is empty.
    const int end = static_cast<int>(last);
    const bool inside = (x > 0) & (x < end) & (up > 0) & (up < end);
    return {x, end - up, inside ? held(clip.z * inv, 1.0f) : kFarAway, 0};
}

Result<void> LightOcclusion::find(const PreparedData& casters, const LightMap& map, const ShadowRule& rule,
                                  std::span<const std::span<ShadowLookup>> groups, const RasterKernels& kernels, Executor& executor) {
    // The part of the map that is asked for.
    int x0 = map.view().region.width, y0 = x0, x1 = -1, y1 = -1;
    for (const std::span<ShadowLookup> group : groups)
        for (const auto& [fragment, code, at] : group) {
            x0 = std::min(x0, at.x), x1 = std::max(x1, at.x);
            y0 = std::min(y0, at.y), y1 = std::max(y1, at.y);
        }
    if (x1 < 0) return {};
    View view = map.view();
    view.mirrored = rule.back_faces_alone;
    // Small tiles, so that most triangles touch none that is asked for, but not too many.
    constexpr int kMostTiles = 1 << 13;
    int shift = 4;
    while (1 << shift < kMaxTileSize && (((x1 - x0) >> shift) + 1) * (((y1 - y0) >> shift) + 1) > kMostTiles) ++shift;
    const int side = 1 << shift;
    view.tile_size = side;
    set_region(view, {x0, y0, x1 - x0 + 1, y1 - y0 + 1});
    const auto tile_of = [x0, y0, shift, row = view.tiles_x](const MapPlace& at) {
        return static_cast<std::size_t>(((at.y - y0) >> shift) * row + ((at.x - x0) >> shift));
    };
    const auto tiles = static_cast<std::size_t>(view.tile_count());
    const float units = rule.offset_units * (1.0f / 16777216.0f);
    constexpr std::int16_t kMost = std::numeric_limits<std::int16_t>::max();  // above all texels of a map of 16384
    tiles_.assign(tiles + 1, {0, kFarAway, kMost, kMost, -1, -1});
    for (const std::span<ShadowLookup> group : groups)
        for (const auto& [fragment, code, at] : group) {
            const std::size_t t = tile_of(at);
            OcclusionTile& tile = tiles_[t];
            const auto x = static_cast<std::int16_t>(at.x), y = static_cast<std::int16_t>(at.y);
            tile.farthest = std::min(tile.farthest, at.z);
            tile.x0 = std::min(tile.x0, x), tile.y0 = std::min(tile.y0, y), tile.x1 = std::max(tile.x1, x), tile.y1 = std::max(tile.y1, y);
            ++tiles_[t + 1].first;
        }
    for (std::size_t t = 0; t < tiles; ++t) tiles_[t + 1].first += tiles_[t].first;
    std::vector<std::uint32_t> next(tiles);
    std::transform(tiles_.begin(), tiles_.end() - 1, next.begin(), [](const OcclusionTile& tile) { return tile.first; });
    const std::size_t size = tiles_[tiles].first + kRoom;
    x_.resize(size), y_.resize(size), z_.resize(size);
    hidden_.assign(size, 0);
    place_.clear();
    for (const std::span<ShadowLookup> group : groups)
        for (const auto& [fragment, code, at] : group) {
            const std::size_t t = tile_of(at);
            const std::uint32_t i = next[t]++;
            place_.push_back(i);
            x_[i] = (at.x - x0) & (side - 1), y_[i] = (at.y - y0) & (side - 1), z_[i] = at.z;
        }
    const OcclusionGrid grid{
        x0, y0, side, view.tiles_x, tiles_.data(), x_.data(), y_.data(), z_.data(), rule.offset_factor, units, hidden_.data()};
    if (auto ok = geometry_.occlude(casters, view, grid, kernels, executor); !ok) return ok;
    std::size_t i = 0;
    for (const std::span<ShadowLookup> group : groups)
        for (ShadowLookup& of : group) of.place.hidden = hidden_[place_[i++]];
    return {};
}

}  // namespace halflit::raster
