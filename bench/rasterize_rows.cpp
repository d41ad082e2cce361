#include "bench/kernel_rows.hpp"
#include "tests/raster/kernel_fixture.hpp"

#include <cmath>
#include <memory>

namespace halflit::bench {
namespace {

using namespace halflit::raster;
using namespace halflit::raster::test;
using reference::FixedPoint;
using reference::FixedTriangle;

constexpr int kTile = 64;
constexpr int kFloats = shading::kVertexFloats;

/// Triangles of one size in a tile, the two legs at a right angle and turned at random.
struct Triangles {
    TriangleList list;
    TileBuffers buffers;
    SamplePattern samples;

    Triangles(int count, double area_px, int sample_count) : samples(standard_samples(sample_count)) {
        Random random(2);
        const double leg = 256 * std::sqrt(2 * area_px);
        while (list.count() < count) {
            const double turn = random.real(0, 6.28), x = std::cos(turn) * leg, y = std::sin(turn) * leg;
            const FixedPoint p{random.integer(0, 256 * kTile - 1), random.integer(0, 256 * kTile - 1)};
            const auto moved = [&](double dx, double dy) {
                return FixedPoint{p.x + static_cast<std::int64_t>(dx), p.y + static_cast<std::int64_t>(dy)};
            };
            const FixedTriangle t{{p, moved(x, y), moved(-y, x)}};
            const float z = random.real32(0.1, 1);
            if (doubled_area(t) != 0) list.add(t, {z, z, z});
        }
    }
};

KernelRow rasterize_row(const std::string& size, int count, double area_px, int samples) {
    return {"rasterize, " + size + ", " + std::to_string(samples) + (samples > 1 ? " samples" : " sample"), "triangle",
            static_cast<double>(count), [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Triangles>(count, area_px, samples);
                return [data, &kernels = raster_kernels(isa)] {
                    clear_tile(data->buffers, data->samples, kTile);
                    kernels.rasterize({0, 0, kTile, kTile}, data->samples, data->buffers, data->list.table(), data->list.ids(),
                                      data->list.count());
                };
            }};
}

/// A block of fragments: pixels of one triangle that covers the tile, or of 64 such triangles.
struct Fragments {
    TriangleList list;
    std::vector<float> attributes;
    alignas(64) std::uint32_t ids[shading::kBlockSize];
    alignas(64) std::int32_t x[shading::kBlockSize], y[shading::kBlockSize];
    DrawRecords draw;
    const float* no_clip_records = nullptr;
    InterpolateArgs args{};
    shading::FragmentBlock block{};

    explicit Fragments(bool mixed, shading::SlotMask slots, bool gradients) {
        Random random(3);
        for (int t = 0; t < shading::kBlockSize; ++t) {
            list.add({{{-256 * 80, -256 * 80}, {256 * 200, -256 * 70}, {-256 * 60, 256 * 200}}}, {0.5f, 0.4f, 0.3f}, {1, 0.8f, 0.6f});
            for (int i = 0; i < 3 * kFloats; ++i) attributes.push_back(random.real32(-1, 1));
            ids[t] = mixed ? static_cast<std::uint32_t>(t) : 0;
            x[t] = t % 8, y[t] = t / 8;
        }
        draw = {attributes.data()};
        args.triangles = list.table();
        args.draws = &draw;
        args.clip_records = &no_clip_records;
        args.slots = slots;
        args.stride = kFloats;
        args.gradients = gradients;
        args.count = shading::kBlockSize;
        args.ids = ids, args.x_px = x, args.y_px = y;
    }
};

KernelRow interpolate_row(const std::string& name, bool mixed, shading::SlotMask slots, bool gradients) {
    return {"interpolate, " + name, "pixel", shading::kBlockSize, [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Fragments>(mixed, slots, gradients);
                return [data, &kernels = raster_kernels(isa)] { kernels.interpolate(data->args, data->block); };
            }};
}

}  // namespace

std::vector<KernelRow> rasterize_rows() {
    std::vector<KernelRow> rows;
    for (const int samples : {1, 4}) {
        rows.push_back(rasterize_row("1 pixel", 1024, 1, samples));
        rows.push_back(rasterize_row("10 pixels", 1024, 10, samples));
        rows.push_back(rasterize_row("100 pixels", 256, 100, samples));
        rows.push_back(rasterize_row("2000 pixels", 32, 2000, samples));
    }
    constexpr shading::SlotMask kBase = shading::kBaseSlots, kWithTangents = shading::kBaseSlots | shading::kTangentSlot;
    rows.push_back(interpolate_row("one triangle", false, kBase, false));
    rows.push_back(interpolate_row("one triangle, tangents and gradients", false, kWithTangents, true));
    rows.push_back(interpolate_row("64 triangles", true, kBase, false));
    rows.push_back(interpolate_row("64 triangles, tangents and gradients", true, kWithTangents, true));
    return rows;
}

}  // namespace halflit::bench
