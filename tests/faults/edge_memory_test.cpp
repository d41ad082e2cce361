// Memory of edges: what is counted against the limit, and what is allocated.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/geometry/model_edges.hpp"
#include "sh/mat4.hpp"
#include "tests/faults/allocation_counter.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

/// Triangles that share no place, in the cube from -1 to 1.
Mesh loose_triangles(int count) {
    Random random(11);
    Mesh mesh;
    for (std::uint32_t i = 0; i < 3 * static_cast<std::uint32_t>(count); i += 3) {
        const Vec3f middle{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh.positions.push_back(middle +
                                     Vec3f{random.real32(-0.05f, 0.05f), random.real32(-0.05f, 0.05f), random.real32(-0.05f, 0.05f)});
            mesh.indices.push_back(i + k);
        }
    }
    generate_flat_normals(mesh);
    return mesh;
}

Scene scene_of(std::vector<Mesh> meshes, bool apart) {
    Scene scene;
    scene.meshes = std::move(meshes);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        scene.instances.push_back(
            {.mesh = static_cast<int>(i), .world_from_object = translation({apart ? 3.0f * static_cast<float>(i) : 0.0f, 0, 0})});
    return scene;
}

/// Scenes of edges: none is shared, most are, and several surfaces.
std::vector<std::pair<std::string, Scene>> scenes() {
    std::vector<std::pair<std::string, Scene>> out;
    for (const int triangles : {30'000, 44'000, 60'000})  // lists and tables are full to different degrees
        out.emplace_back(std::to_string(triangles) + " loose triangles", scene_of({loose_triangles(triangles)}, false));
    out.emplace_back("a sphere", scene_of({make_sphere_of(1, 50'000)}, false));
    out.emplace_back("one surface of three", scene_of({loose_triangles(9'000), loose_triangles(20'000), make_sphere_of(1, 30'000)}, false));
    out.emplace_back("three surfaces", scene_of({loose_triangles(20'000), make_sphere_of(1, 30'000), loose_triangles(10'000)}, true));
    return out;
}

std::uint64_t triangles_in(const Scene& scene) {
    std::uint64_t sum = 0;
    for (const Mesh& mesh : scene.meshes) sum += triangles_of(mesh);
    return sum;
}

bool has_sizes() {
    const PeakOfBytes peak;
    const std::vector<int> some(1000);
    return peak.bytes() > 0;
}

}  // namespace

TEST_CASE("edges: finding them takes at most the memory that is said, and not half of it", "[faults][edges]") {
    if (!has_sizes()) HALFLIT_SKIP("the C library does not tell the sizes of allocations");
    for (const auto& [name, scene] : scenes()) {
        ModelEdges edges;
        const PeakOfBytes peak;
        edges.find(scene, 30);
        const auto measured = static_cast<std::uint64_t>(peak.bytes()), said = ModelEdges::most_bytes(scene);
        INFO(name << ": " << measured / triangles_in(scene) << " bytes a triangle, said " << said / triangles_in(scene));
        CHECK(measured <= said + 10'000);
        CHECK(said <= 2 * measured);
        CHECK(edges.bytes() <= measured);
    }
}

TEST_CASE("edges: a frame with lines stays within the memory that it was given", "[faults][edges]") {
    if (!has_sizes()) HALFLIT_SKIP("the C library does not tell the sizes of allocations");
    constexpr int kSide = 200;
    Camera camera = camera_at({0, 0, 8}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = 1.5f;
    Settings settings;
    settings.edges = EdgeChoice::all;
    settings.hidden_edges = HiddenEdges::dashed;
    std::vector<std::uint8_t> pixels(std::size_t{4} * kSide * kSide);
    for (const auto& [name, scene] : scenes()) {
        const auto prepared = PreparedScene::make(scene);
        REQUIRE(prepared);
        int drawn = 0, stopped = 0;
        for (std::size_t limit = 8 << 20; drawn == 0 && limit < std::size_t{1} << 30; limit += limit / 8) {
            Renderer renderer;
            const PeakOfBytes peak;
            for (int frame = 0; frame < 2; ++frame) {  // the second has the edges already
                const auto report = renderer.render(*prepared, camera, settings, {.width = kSide, .height = kSide, .pixels = pixels.data()},
                                                    {.threads = 1, .memory_limit = limit});
                if (!report) CHECK(report.error().code == ErrorCode::limit);
                (report ? drawn : stopped) += 1;
            }
            INFO(name << ": " << peak.bytes() << " of " << limit << ", " << triangles_in(scene) << " triangles");
            constexpr std::size_t kOfThread = std::size_t{6} << 20;  // fixed buffers of two renderers
            CHECK(static_cast<std::size_t>(peak.bytes()) <= limit + kOfThread);
        }
        CHECK(drawn > 0);
        CHECK(stopped > 0);
    }
}
