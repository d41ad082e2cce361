#include "raster/passes/eye_dome.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace halflit::raster {
namespace {

/// Where depths are read around a pixel: eight directions at one distance. x and y in pixels; run: their distance.
struct Neighbour {
    int x, y;
    float run;
};

/// A steeper rise, by 76 degrees, counts as this. It is a gap between two surfaces then.
constexpr float kMostRise = 4.0f;
/// Where so many neighbours are beyond gaps, a pixel shows through a hole between points, and is as bright as the surface around it.
constexpr float kHole = 6.0f;

std::vector<Neighbour> neighbours_of(int radius) {
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
    const auto count = static_cast<std::size_t>(part.width);
    executor.run(part.height, [&](int row) {
        const int y = part.y + row;
        std::vector<float> sum(count, 0.0f), per_depth(count), rise(count), gaps(count);
        for (int plane = 0; plane < planes_; ++plane) {
            const float* const own = at(plane, part.x, y);
            for (std::size_t x = 0; x < count; ++x)
                per_depth[x] = own[x] > 0.0f ? dome.scale / (dome.orthographic ? 1.0f : own[x] + dome.depth_offset) : 0.0f;
            std::fill(rise.begin(), rise.end(), 0.0f);
            std::fill(gaps.begin(), gaps.end(), 0.0f);
            for (const Neighbour& n : neighbours) {
                const float* const other = at(plane, part.x + n.x, y + n.y);
                const float per_run = 1.0f / n.run;
                for (std::size_t x = 0; x < count; ++x) {
                    const float z = other[x] < 0.0f ? -other[x] : other[x];
                    const float step = (z - own[x]) * (per_depth[x] * per_run), up = step > 0.0f ? step : 0.0f;
                    rise[x] += up < kMostRise ? up : kMostRise;
                    gaps[x] += up < kMostRise ? 0.0f : 1.0f;
                }
            }
            for (std::size_t x = 0; x < count; ++x) sum[x] += 1.0f / (1.0f + (gaps[x] < kHole ? dome.strength : 0.0f) * rise[x]);
        }
        const float mean = 1.0f / static_cast<float>(planes_);
        for (std::size_t x = 0; x < count; ++x) {
            const float share = sum[x] * mean;
            if (!(share < 1.0f)) continue;
            const int at_x = part.x + static_cast<int>(x);
            if (output.codes) {
                std::uint8_t* const code = output.codes.at(at_x, y);
                for (int c = 0; c < 3; ++c) code[c] = static_cast<std::uint8_t>(static_cast<float>(code[c]) * share + 0.5f);
            }
            if (output.linear) {
                float* const light = output.linear.at(at_x, y);
                for (int c = 0; c < 3; ++c) light[c] *= share * share;
            }
        }
    });
}

}  // namespace halflit::raster
