#include "bench/kernel_rows.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/view_geometry.hpp"
#include "tests/support/random.hpp"

#include <cstring>
#include <memory>

namespace halflit::bench {
namespace {

using namespace halflit::raster;
using test::Random;

constexpr int kVertices = 4096;  // fit in the second level of the cache
constexpr int kTriangles = 200000;

struct Vertices {
    std::vector<float> positions, normals, tangents, uv0, records;
    std::vector<ScreenVertex> screen = std::vector<ScreenVertex>(kVertices);
    std::vector<std::uint8_t> outcodes = std::vector<std::uint8_t>(kVertices);

    Vertices() {
        Random random(1);
        const auto fill = [&](std::vector<float>& out, int floats) {
            for (int i = 0; i < floats * kVertices; ++i) out.push_back(random.real32(-1, 1));
        };
        fill(positions, 3), fill(normals, 3), fill(tangents, 4), fill(uv0, 2);
        records.resize(std::size_t{shading::kVertexFloats} * kVertices);
    }
};

constexpr float kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

KernelRow transform_row() {
    return {"transform", "vertex", kVertices, [](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Vertices>();
                TransformArgs args{data->positions.data(), 0, kVertices, {}, {960, 540, 8, 8}, data->screen.data(), data->outcodes.data()};
                // Moved away from the eye, so that no vertex is clipped: clip w = z + 3.
                const float clip_from_object[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.1f, 1, 0, 0, 0.5f, 3};
                std::memcpy(args.clip_from_object, clip_from_object, sizeof clip_from_object);
                return [data, args, &kernels = raster_kernels(isa)] { kernels.transform(args); };
            }};
}

KernelRow records_row(const char* name, shading::SlotMask slots, int slot_count) {
    return {name, "vertex", kVertices, [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Vertices>();
                VertexRecordArgs args{};
                args.positions = data->positions.data();
                args.normals = data->normals.data();
                args.tangents = data->tangents.data();
                args.uv0 = data->uv0.data();
                args.end = kVertices;
                args.slots = slots;
                std::memcpy(args.world_from_object, kIdentity, sizeof kIdentity);
                std::memcpy(args.normal_from_object, kIdentity, sizeof args.normal_from_object);
                args.tangent_sign = 1;
                args.records = data->records.data();
                args.stride = 4 * slot_count;
                return [data, args, &kernels = raster_kernels(isa)] { kernels.vertex_records(args); };
            }};
}

/// A sphere of many triangles in a picture of 1920 x 1080: its geometry pass on one thread.
struct Geometry {
    Scene scene;
    std::unique_ptr<PreparedScene> prepared;
    View view;
    ViewGeometry geometry;
    Executor executor;

    explicit Geometry(int samples) {
        scene.meshes.push_back(make_sphere_of(1.0f, kTriangles));
        scene.instances.push_back({0, {}});
        prepared = std::make_unique<PreparedScene>(std::move(*PreparedScene::make(scene)));
        Camera camera;
        camera.world_from_camera = translation({0, 0, 3});
        view = make_view(camera, 1920, 1080, {0, 0, 1920, 1080}, 64, samples);
        executor.configure({.threads = 1});
    }
};

KernelRow geometry_row(const char* name, int samples) {
    return {name, "triangle", kTriangles, [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Geometry>(samples);
                return [data, &kernels = raster_kernels(isa)] {
                    data->geometry.forget();
                    (void)data->geometry.make(data->prepared->data(), data->view, kernels, data->executor);
                };
            }};
}

}  // namespace

std::vector<KernelRow> geometry_rows() {
    constexpr shading::SlotMask kBase = shading::kBaseSlots, kWithTangents = shading::kBaseSlots | shading::kTangentSlot;
    return {transform_row(), records_row("vertex records: position, normal, uv", kBase, 2),
            records_row("vertex records: with tangents", kWithTangents, 3),
            geometry_row("cull, transform and bin a sphere, half of it culled", 1), geometry_row("the same, 4 samples", 4)};
}

}  // namespace halflit::bench
