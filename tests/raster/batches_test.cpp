// Views of many vertices are transformed and binned in batches and keep only the vertices that their triangles use. No bit may change.
#include "raster/frame_plan.hpp"
#include "raster/passes/view_geometry.hpp"
#include "tests/raster/metamorphic_shots.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

/// Lines and points, and triangles that reach behind the camera.
void add_odd_things(Random& random, Shot& shot) {
    Scene& scene = shot.scene;
    for (const Topology topology : {Topology::lines, Topology::points}) {
        Mesh mesh;
        mesh.topology = topology;
        mesh.material = 0;
        for (int i = 0; i < 50; ++i) mesh.positions.push_back({random.real32(-2, 2), random.real32(-2, 2), random.real32(-2, 2)});
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), {}});
        scene.meshes.push_back(std::move(mesh));
    }
    const Vec4f eye = shot.camera.world_from_camera.c[3];
    Mesh mesh;
    mesh.material = 0;
    for (int i = 0; i < 60; ++i)
        mesh.positions.push_back({eye.x + random.real32(-9, 9), eye.y - random.real32(0.5, 1), eye.z + random.real32(-9, 9)});
    for (std::uint32_t i = 0; i < 60; ++i) mesh.indices.push_back(i);
    generate_flat_normals(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), {}});
    scene.meshes.push_back(std::move(mesh));
    shot.settings.point_size = 3;
}

/// Instances between the others, of two million vertices that all lie in one place of the scene: triangles without area.
void add_vertices(Scene& scene) {
    constexpr std::uint32_t kVertices = 1 << 17;
    Mesh dense;
    dense.material = 0;
    dense.positions.assign(kVertices, scene.meshes[0].positions[0]);
    dense.normals.assign(kVertices, {0, 1, 0});
    for (std::uint32_t i = 0; i < kVertices / 3 * 3; ++i) dense.indices.push_back(i);
    const Mat4 place = scene.instances[0].world_from_object;
    std::vector<Instance> instances;
    for (std::size_t i = 0; i < std::max<std::size_t>(16, scene.instances.size()); ++i) {
        if (i < 16) instances.push_back({static_cast<int>(scene.meshes.size()), place});
        if (i < scene.instances.size()) instances.push_back(scene.instances[i]);
    }
    scene.meshes.push_back(std::move(dense));
    scene.instances = std::move(instances);
}

/// Balls of 5,000 triangles each among the others, some of them masks and layers, some twice in one place.
void add_balls(Random& random, Scene& scene, int count) {
    const int mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(make_sphere_of(1.0f, 5'000));
    for (int i = 0; i < count; ++i) {
        Mat4 place;
        place.c[3] = {random.real32(-0.5, 0.5), random.real32(-0.5, 0.5), random.real32(-0.5, 0.5), 1};
        scene.instances.push_back({mesh, place});
        scene.instances.back().material = i % 8 < 6 ? 0 : random.index(static_cast<int>(scene.materials.size()));
        if (i % 100 != 0) continue;
        scene.instances.push_back(scene.instances.back());
        scene.instances.back().material = 1;
    }
}

struct MadeView {
    bool in_batches;
    std::uint64_t drawn, kept;  ///< triangles
};

MadeView made_view(const Shot& shot, const Execution& execution = {.threads = 1}) {
    const auto prepared = PreparedScene::make(shot.scene);
    REQUIRE(prepared);
    Executor executor;
    executor.configure(execution);
    ViewGeometry geometry;
    const View view = make_view(shot.camera, kViewWidth, kViewHeight, {0, 0, kViewWidth, kViewHeight}, 64, shot.settings.samples);
    REQUIRE(geometry.make(prepared->data(), view, raster_kernels(halflit::test::available_isas().back()), executor));
    MadeView made{geometry.has_only_used_vertices(), geometry.triangles_drawn(), 0};
    for (const auto& chunk : geometry.chunks()) made.kept += chunk->records.size();
    return made;
}

/// True if the scene's view is made in batches.
bool is_in_batches(const Shot& shot) { return made_view(shot).in_batches; }

/// The planes `barycentric` and `uv` of a shot.
std::vector<float> points_of(const Shot& shot, Renderer& renderer, const Execution& execution) {
    constexpr std::size_t kFloats = 2 * kViewWidth * kViewHeight;
    std::vector<float> both(2 * kFloats, -1.0f);
    const PreparedScene prepared = PreparedScene::make(shot.scene).value();
    REQUIRE(renderer.render(prepared, shot.camera, shot.settings,
                            {.width = kViewWidth, .height = kViewHeight, .barycentric = both.data(), .uv = both.data() + kFloats},
                            execution));
    return both;
}

}  // namespace

TEST_CASE("batches: a view of many vertices has the pixels of the same view without them", "[raster][batches]") {
    const auto isas = halflit::test::available_isas();
    constexpr std::uint64_t kScenes = 30;
    std::uint64_t visible = 0, in_batches = 0;
    for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
        Random random(seed + 77);
        Shot shot = any_shot(seed);
        add_odd_things(random, shot);
        shot.settings.shading.max_error_codes = 0;  // a budget's lights depend on where vertices are
        const Isa isa = isas[static_cast<std::size_t>(random.index(static_cast<int>(isas.size())))];
        const Execution execution = execution_of(1 + static_cast<int>(seed % 2), 64, isa);
        Renderer renderer;
        const Pixels few = draw(shot, renderer, execution);
        Shot larger = shot;
        add_vertices(larger.scene);
        INFO("seed " << seed << ", " << isa_name(isa));
        in_batches += is_in_batches(larger) ? 1 : 0;  // unless the camera does not see that place
        CHECK(differing(few, draw(larger, renderer, execution)) == 0);
        CHECK(differing(few, draw(shot, renderer, execution)) == 0);
        if (shot.settings.region.width == 0) CHECK(points_of(shot, renderer, execution) == points_of(larger, renderer, execution));
        visible += few.visible;
    }
    CHECK(visible > kScenes * kViewWidth * kViewHeight / 5);
    CHECK(in_batches >= kScenes * 2 / 3);
}

TEST_CASE("batches: triangles of a smooth mesh are joined across the parts that have copies of its vertices", "[raster][batches]") {
    Shot shot;
    shot.scene.materials.resize(1);
    shot.scene.meshes.push_back(make_sphere_of(1.0f, 200'000));
    shot.scene.meshes[0].material = 0;
    shot.scene.instances.push_back({0, {}});
    shot.scene.lights.push_back({.direction_ws = normalize_or({-1, -1, -1}, {0, -1, 0})});
    shot.camera = frame_scene(shot.scene, static_cast<float>(kViewWidth) / kViewHeight, {});
    shot.settings.samples = 4;
    const Pixels few = draw(shot);
    CHECK_FALSE(is_in_batches(shot));
    add_vertices(shot.scene);
    CHECK(is_in_batches(shot));
    const Pixels many = draw(shot);
    CHECK(differing(few, many) == 0);
    CHECK(few.fragments == many.fragments);
}

TEST_CASE("batches: with little memory hidden triangles are dropped on the way, and no pixel, plane or count shows it",
          "[raster][batches]") {
    const auto isas = halflit::test::available_isas();
    std::uint64_t dropping = 0;
    constexpr std::uint64_t kScenes = 3;
    for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
        Random random(seed + 4321);
        Shot shot = any_shot(seed);
        shot.scene.instances.clear();                           // its materials and lights are enough
        shot.settings.region = {}, shot.settings.samples = 16;  // so that small triangles are kept
        add_odd_things(random, shot);
        add_balls(random, shot.scene, 800);
        shot.camera = frame_scene(shot.scene, static_cast<float>(kViewWidth) / kViewHeight, {});
        const Isa isa = isas[static_cast<std::size_t>(random.index(static_cast<int>(isas.size())))];
        const Execution much = execution_of(1 + static_cast<int>(seed % 2), 64, isa);
        Execution little = much;
        little.memory_limit = std::size_t{112} << 20;
        INFO("seed " << seed << ", " << isa_name(isa));
        Renderer renderer, other;
        const Pixels all = draw(shot, renderer, much), few = draw(shot, other, little);
        CHECK(differing(all, few) == 0);
        CHECK(all.fragments == few.fragments);
        CHECK(points_of(shot, renderer, much) == points_of(shot, other, little));
        const MadeView whole = made_view(shot), made = made_view(shot, little);
        CHECK(whole.kept == whole.drawn);
        CHECK(made.drawn == whole.drawn);
        dropping += made.kept < whole.kept ? 1 : 0;
    }
    CHECK(dropping >= kScenes / 2);  // where enough of the balls are large in the picture
}

TEST_CASE("batches: triangles share a budget of memory with the scene's textures, and no pixel shows it", "[raster][batches]") {
    Random random(5);
    Shot shot = any_shot(5);
    shot.scene.instances.clear();
    shot.settings.region = {}, shot.settings.samples = 4, shot.settings.shadows = ShadowMode::off;
    add_balls(random, shot.scene, 1500);
    shot.camera = frame_scene(shot.scene, static_cast<float>(kViewWidth) / kViewHeight, {});
    const MadeView alone = made_view(shot);
    const Pixels expected = draw(shot);
    CHECK(alone.kept == alone.drawn);
    // Copies share their texels: this takes 22 MB.
    constexpr int kSide = 1440;
    const std::vector<std::uint8_t> texels(std::size_t{4} * kSide * kSide, 255);
    shot.scene.textures.resize(shot.scene.textures.size() + 20, Texture::from_rgba8(texels, kSide, kSide, ColorSpace::linear).value());
    const MadeView beside = made_view(shot);
    CHECK(beside.drawn == alone.drawn);
    CHECK(beside.kept < alone.kept);
    CHECK(differing(expected, draw(shot)) == 0);
}
