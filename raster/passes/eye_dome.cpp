#include "raster/passes/eye_dome.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace halflit::raster {
namespace {

/// A steeper rise, by 76 degrees, counts as this. It is a gap between two surfaces then.
constexpr float kMostRise = 4.0f;
/// Where so many neighbours are nearer by a gap, a pixel shows through a hole between points. It then has the shade of a usual slope, as
/// the surface around the hole has.
constexpr float kHole = 6.0f, kRiseOfHole = 2.0f;

constexpr int kBlock = 64;  ///< pixels of a row that are shaded together

std::vector<EyeDome::Neighbour> neighbours_of(int radius) {
    const int aside = std::max(1, static_cast<int>(0.70710678 * radius + 0.5));
    const auto straight = static_cast<float>(radius), slanted = static_cast<float>(1.41421356 * aside);
    return {{radius, 0, straight},   {-radius, 0, straight},   {0, radius, straight},    {0, -radius, straight},
            {aside, aside, slanted}, {-aside, aside, slanted}, {aside, -aside, slanted}, {-aside, -aside, slanted}};
}

}  // namespace

void EyeDome::begin(const FramePlan& plan, Executor& executor) {
    const Region& region = plan.picture.region;
    const int border = plan.eye_dome.radius_px;
    samples_ = plan.picture.samples.count;
    planes_ = std::min(samples_, kMostPlanes);
    x0_ = region.x - border, y0_ = region.y - border;
    stride_ = region.width + 2 * border, rows_ = region.height + 2 * border;
    all_ = plan.eye_dome.all;
    const std::size_t count = static_cast<std::size_t>(planes_) * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride_);
    std::fill_n(depth_.reserve(count, executor.stop()), count, 0.0f);
}

void EyeDome::keep(const TileRect& tile, const TileBuffers* buffers, const ViewGeometry& geometry) {
    if (buffers == nullptr) return;
    const auto is_cloud = [&](const Draw& draw) {
        return draw.topology == Topology::points && geometry.scene().source_mesh(draw.mesh).normals.empty();
    };
    const std::span<const Draw> draws = geometry.draws();
    const bool plain = all_ || std::all_of(draws.begin(), draws.end(), is_cloud);
    for (int plane = 0; plane < planes_; ++plane) {
        const int s = plane * samples_ / planes_;
        for (int y = 0; y < tile.height; ++y) {
            float* const to = at(plane, tile.x, tile.y + y);
            std::memcpy(to, buffers->depth[s] + y * kTileStride, sizeof(float) * static_cast<std::size_t>(tile.width));
            if (plain) continue;
            for (int x = 0; x < tile.width; ++x) {
                const std::uint32_t id = buffers->triangle[s][y * kTileStride + x];
                if (id != kNoTriangle && !is_cloud(geometry.draw_of(geometry.record(id)))) to[x] = -to[x];
            }
        }
    }
}

void EyeDome::shade(const FramePlan& plan, const Output& output, Executor& executor) const {
    const EyeDomePlan& dome = plan.eye_dome;
    const std::vector<Neighbour> neighbours = neighbours_of(dome.radius_px);
    const Region& part = plan.written;
    executor.run(part.height, [&](int row) {
        for (int x = 0; x < part.width; x += kBlock)
            shade_block(dome, neighbours, output, part.x + x, part.y + row, std::min(kBlock, part.width - x));
    });
}

void EyeDome::shade_block(const EyeDomePlan& dome, std::span<const Neighbour> neighbours, const Output& output, int x_px, int y_px,
                          int count) const {
    float share[kBlock] = {};
    bool any = false;
    for (int plane = 0; plane < planes_; ++plane) {
        // Copies, so that the compiler knows that they do not overlap.
        float own[kBlock] = {}, per_depth[kBlock] = {}, rise[kBlock] = {}, gaps[kBlock] = {}, other[kBlock] = {}, step_of[kBlock];
        const auto bytes = sizeof(float) * static_cast<std::size_t>(count);
        std::memcpy(own, at(plane, x_px, y_px), bytes);
        bool shaded = false;
        for (const float z : own) shaded |= z > 0.0f;
        if (!shaded) {
            for (float& one : share) one += 1.0f;
            continue;
        }
        any = true;
        const float offset = dome.depth_offset, scale = dome.scale, strength = dome.strength;
        for (int i = 0; i < kBlock; ++i) {
            const float depth = dome.orthographic ? 1.0f : own[i] + offset;
            per_depth[i] = own[i] > 0.0f ? scale / depth : 0.0f;
        }
        for (const Neighbour& n : neighbours) {
            std::memcpy(other, at(plane, x_px + n.x, y_px + n.y), bytes);
            const float per_run = 1.0f / n.run;
            for (int i = 0; i < kBlock; ++i) {
                const float step = (__builtin_fabsf(other[i]) - own[i]) * (per_depth[i] * per_run);
                step_of[i] = step < kMostRise ? step : kMostRise;
            }
            for (int i = 0; i < kBlock; ++i) rise[i] += step_of[i] > 0.0f ? step_of[i] : 0.0f;
            for (int i = 0; i < kBlock; ++i) gaps[i] += step_of[i] < kMostRise ? 0.0f : 1.0f;
        }
        for (int i = 0; i < kBlock; ++i) {
            const float counted = gaps[i] < kHole ? rise[i] : kRiseOfHole;  // 0 where nothing is shaded
            share[i] += 1.0f / (1.0f + strength * counted);
        }
    }
    if (!any) return;
    const float weight = 1.0f / static_cast<float>(planes_);
    for (int i = 0; i < count; ++i) {
        const float mean = share[i] * weight;
        if (!(mean < 1.0f)) continue;
        if (output.codes) {
            std::uint8_t* const code = output.codes.at(x_px + i, y_px);
            for (int c = 0; c < 3; ++c) code[c] = static_cast<std::uint8_t>(static_cast<float>(code[c]) * mean + 0.5f);
        }
        if (output.linear) {
            float* const light = output.linear.at(x_px + i, y_px);
            for (int c = 0; c < 3; ++c) light[c] *= mean * mean;  // codes are about the square root of light
        }
    }
}

}  // namespace halflit::raster
