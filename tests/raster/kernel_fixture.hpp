// Raster kernels without a frame around them: a few triangles, one tile.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "reference.hpp"
#include "tests/support/random.hpp"

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace halflit::raster::test {

using halflit::test::Random;

/// The standard positions of 4 and 8 samples, and the renderer's own 16, in 1/256 pixel from the centre.
inline SamplePattern standard_samples(int count) {
    static constexpr int k4[4][2] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
    static constexpr int k8[8][2] = {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
    static constexpr int k16[16][2] = {{1, 3},    {-7, -1}, {5, -5},    {7, 1},   {-3, -7}, {-5, 7},  {3, 11},  {-1, -13},
                                       {-13, -3}, {13, 5},  {-11, -11}, {11, 13}, {-15, 9}, {-9, 15}, {9, -15}, {15, -9}};
    SamplePattern p;
    p.count = count;
    for (int s = 0; s < count && count > 1; ++s) {
        const int unit = count == 16 ? 8 : 16;
        const int* const at = count == 4 ? k4[s] : count == 8 ? k8[s] : k16[s];
        p.x[s] = static_cast<std::int16_t>(unit * at[0]);
        p.y[s] = static_cast<std::int16_t>(unit * at[1]);
    }
    return p;
}

inline std::int64_t doubled_area(const reference::FixedTriangle& t) {
    const auto& c = t.corner;
    return (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
}

/// Triangles as the kernels take them: positive area, one record each, ids from `id_base` on, which is 0 to 3 times kChunk.
class TriangleList {
public:
    static constexpr int kLocalBits = 20;
    static constexpr std::uint32_t kChunk = 1u << kLocalBits;

    explicit TriangleList(std::uint32_t id_base = 0) : id_base_(id_base) {}

    void clear() {
        records_.clear();
        vertices_.clear();
        ids_.clear();
    }
    /// The triangle must have area; z and inv_w belong to its corners in their order.
    void add(const reference::FixedTriangle& t, const float (&z)[3], const float (&inv_w)[3] = {1, 1, 1}) {
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        for (int k = 0; k < 3; ++k)
            vertices_.push_back({static_cast<std::int32_t>(t.corner[k].x), static_cast<std::int32_t>(t.corner[k].y), z[k], inv_w[k]});
        TriangleRecord r{{first, first + 1, first + 2}, 0};
        if (doubled_area(t) < 0) std::swap(r.vertex[1], r.vertex[2]);
        records_.push_back(r);
        ids_.push_back(id_base_ + static_cast<std::uint32_t>(ids_.size()));
        sources_[chunk()] = {records_.data(), vertices_.data(), nullptr, id_base_};
    }
    [[nodiscard]] const TriangleSource& source() const { return sources_[chunk()]; }
    [[nodiscard]] TriangleTable table() const { return {sources_, kLocalBits}; }
    [[nodiscard]] const std::uint32_t* ids() const { return ids_.data(); }
    [[nodiscard]] int count() const { return static_cast<int>(records_.size()); }
    [[nodiscard]] const TriangleRecord& record(int i) const { return records_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const ScreenVertex& vertex(std::uint32_t v) const { return vertices_[v]; }

private:
    [[nodiscard]] std::size_t chunk() const { return id_base_ >> kLocalBits; }

    std::uint32_t id_base_;
    std::vector<TriangleRecord> records_;
    std::vector<ScreenVertex> vertices_;
    std::vector<std::uint32_t> ids_;
    TriangleSource sources_[4]{};
};

/// Clears the first `rows` rows.
inline void clear_tile(TileBuffers& buffers, const SamplePattern& pattern, int rows) {
    for (int s = 0; s < pattern.count; ++s) {
        std::memset(buffers.depth[s], 0, static_cast<std::size_t>(rows) * kTileStride * sizeof(float));
        std::memset(buffers.triangle[s], 0xff, static_cast<std::size_t>(rows) * kTileStride * sizeof(std::uint32_t));
    }
}

}  // namespace halflit::raster::test
