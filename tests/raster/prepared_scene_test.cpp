// A prepared scene is the same whether it was made anew or told of changes, and its boxes are those of the scene itself.
#include "raster/scene/instance_material.hpp"
#include "raster/scene/prepared_data.hpp"
#include "tests/raster/random_geometry.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr int kMaterials = 3;

bool same(const Bounds& a, const Bounds& b) { return a.empty == b.empty && (a.empty || (a.min == b.min && a.max == b.max)); }

bool same(const Cluster& a, const Cluster& b) {
    return std::equal(a.min, a.min + 3, b.min) && std::equal(a.max, a.max + 3, b.max) &&
           std::equal(a.cone_axis, a.cone_axis + 3, b.cone_axis) && a.cone_sine == b.cone_sine && a.cone_cosine == b.cone_cosine &&
           a.least_altitude == b.least_altitude && a.first_group == b.first_group && a.finite == b.finite;
}

bool same(const PreparedMesh& a, const PreparedMesh& b) {
    const auto equal = [](const auto& x, const auto& y) { return same(x, y); };
    return same(a.bounds, b.bounds) && std::equal(a.clusters.begin(), a.clusters.end(), b.clusters.begin(), b.clusters.end(), equal) &&
           std::equal(a.superclusters.begin(), a.superclusters.end(), b.superclusters.begin(), b.superclusters.end(), equal) &&
           a.vertex_groups == b.vertex_groups && a.largest_color == b.largest_color && a.finite == b.finite;
}

/// Compares all that is public, except the revision.
void check_same(const PreparedData& a, const PreparedData& b) {
    CHECK(&a.scene() == &b.scene());
    CHECK(same(a.bounds(), b.bounds()));
    int differing_meshes = 0, differing_instances = 0;
    for (int i = 0; i < static_cast<int>(a.scene().meshes.size()); ++i) differing_meshes += !same(a.mesh(i), b.mesh(i));
    REQUIRE(a.instance_bounds().size() == b.instance_bounds().size());
    for (std::size_t i = 0; i < a.instance_bounds().size(); ++i)
        differing_instances += !same(a.instance_bounds()[i], b.instance_bounds()[i]);
    CHECK(differing_meshes == 0);
    CHECK(differing_instances == 0);
    CHECK(a.triangle_count() == b.triangle_count());
    CHECK(a.largest_color() == b.largest_color());
    CHECK(std::ranges::equal(a.available_slots(), b.available_slots()));
    CHECK(a.drawn_materials() == b.drawn_materials());
    CHECK(std::ranges::equal(a.object_radii(), b.object_radii()));
}

/// Mesh of any kind; some without triangles, some with vertices that are not finite or that no triangle uses.
Mesh any_mesh(Random& random) {
    Mesh mesh = random_mesh(random);
    if (random.chance(0.1)) mesh.indices.clear();
    if (random.chance(0.05)) mesh.positions.clear(), mesh.indices.clear();
    const auto vertices = static_cast<int>(mesh.positions.size());
    for (int i = 0; vertices > 0 && random.chance(0.3) && i < 20; ++i) {
        Vec3f& p = mesh.positions[static_cast<std::size_t>(random.index(vertices))];
        (random.chance(0.5) ? p.x : p.z) = random.chance(0.5) ? kNan : random.chance(0.5) ? kInf : -3e38f;
    }
    if (random.chance(0.3)) mesh.positions.push_back(random_point(random, 100));
    if (random.chance(0.2)) mesh.positions.push_back({kNan, kInf, 0});
    const std::size_t n = mesh.positions.size();
    if (random.chance(0.4)) mesh.uv0.assign(n, {random.real32(-9, 9), random.chance(0.1) ? kNan : 1.0f});
    if (random.chance(0.2)) mesh.uv1.assign(n, {random.real32(-9, 9), 0});
    if (random.chance(0.3)) mesh.colors.assign(n, {random.real32(0, 5), 0, 0, 1});
    if (random.chance(0.3)) mesh.normals.assign(n, {0, 1, 0});
    if (random.chance(0.2)) mesh.tangents.assign(n, {1, 0, 0, 1});
    mesh.material = random.index(kMaterials + 1) - 1;
    return mesh;
}

Mat4 any_place(Random& random) {
    Mat4 place = random_place(random, random_decades(random, 1e-3, 1e4), random_decades(random, 1e-6, 1e6));
    if (random.chance(0.03)) place = scaling({0, 0, 0});
    if (random.chance(0.03)) place.c[3].y = kNan;
    if (random.chance(0.03)) place = place * scaling({1e38f, 1e38f, 1e38f});
    return place;
}

Scene any_scene(Random& random) {
    Scene scene;
    scene.materials.resize(kMaterials);
    const int meshes = random.index(5), instances = meshes == 0 ? 0 : random.index(8);
    for (int i = 0; i < meshes; ++i) scene.meshes.push_back(any_mesh(random));
    for (int i = 0; i < instances; ++i) {
        const int mesh = random.index(meshes);
        scene.instances.push_back({mesh, any_place(random)});
    }
    return scene;
}

/// Changes the scene at random, things of each kind, and returns what update() is to be told.
SceneChanges change(Random& random, Scene& scene) {
    SceneChanges told;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (random.chance(0.2)) {
            scene.instances[i].world_from_object = any_place(random);
            told.changed_instances.push_back(i);
        }
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        if (random.chance(0.2)) {
            if (random.chance(0.5))
                scene.meshes[i] = any_mesh(random);
            else
                for (Vec3f& p : scene.meshes[i].positions) p = p + random_point(random, 0.1);
            told.deformed_meshes.push_back(i);
        }
    // Order and repetition must not matter.
    std::ranges::reverse(told.changed_instances);
    if (!told.deformed_meshes.empty() && random.chance(0.2)) told.deformed_meshes.push_back(told.deformed_meshes[0]);
    told.materials = random.chance(0.2);
    if (told.materials) scene.materials[static_cast<std::size_t>(random.index(kMaterials))].lobe = Lobe::green(random.real32(0, 1));
    told.lights = random.chance(0.2);
    if (told.lights) scene.lights.resize(static_cast<std::size_t>(random.index(4)));
    return told;
}

PreparedData made(const Scene& scene, const Execution& workers = {}) {
    auto prepared = PreparedData::make(scene, workers);
    INFO((prepared ? "" : prepared.error().message));
    REQUIRE(prepared);
    return std::move(*prepared);
}

}  // namespace

TEST_CASE("prepared scene: bounds are those of scene_bounds, of the whole and of each instance", "[raster][prepared]") {
    Random random(1);
    int empty = 0, many_clusters = 0;
    for (int round = 0; round < 400; ++round) {
        const Scene scene = any_scene(random);
        const PreparedData prepared = made(scene, {1 + round % 3});
        INFO("round " << round);
        CHECK(same(prepared.framed_bounds(), scene_bounds(scene)));
        Scene one = scene;
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            one.instances = {scene.instances[i]};
            CHECK(same(has_extent(one, one.instances[0]) ? prepared.instance_bounds()[i] : Bounds{}, scene_bounds(one)));
            many_clusters += prepared.mesh(scene.instances[i].mesh).cluster_count() > 8;
        }
        empty += prepared.bounds().empty;
    }
    CHECK(empty > 20);
    CHECK(many_clusters > 200);
    CHECK(made({}).bounds().empty);
}

TEST_CASE("prepared scene: bounds are those of scene_bounds where float32 has few digits left", "[raster][prepared]") {
    // Below 1e-38 the rounding error is no longer proportional to the coordinate. The mesh is a grid, so that neighbouring clusters reach
    // nearly as far out.
    Random random(2);
    for (int round = 0; round < 800; ++round) {
        Scene scene;
        scene.meshes.push_back(make_plane(1, static_cast<int>(random.integer(30, 60))));
        const Vec3f offset = random_point(random, 1);
        for (Vec3f& p : scene.meshes[0].positions) p = p + offset;
        const float size = random_decades(random, 3e-45, 1e-41);
        scene.instances.push_back({0, random_rotation(random) * scaling({size, size, size})});
        INFO("round " << round << ", size " << size);
        CHECK(same(made(scene, {1}).bounds(), scene_bounds(scene)));
    }
}

TEST_CASE("prepared scene: after any changes it equals one made anew, and its revision tells of their kind", "[raster][prepared]") {
    Random random(3);
    int updates = 0;
    for (int round = 0; round < 60; ++round) {
        Scene scene = any_scene(random);
        PreparedData prepared = made(scene);
        for (int step = 0; step < 8; ++step) {
            const SceneChanges told = change(random, scene);
            const SceneRevision before = prepared.revision();
            INFO("round " << round << ", step " << step);
            REQUIRE(prepared.update(told, {1 + step % 3}));
            check_same(prepared, made(scene));
            const SceneRevision after = prepared.revision();
            const bool geometry = !told.changed_instances.empty() || !told.deformed_meshes.empty();
            CHECK((geometry ? after.geometry > before.geometry : after.geometry == before.geometry));
            CHECK((told.lights ? after.lights > before.lights : after.lights == before.lights));
            // A deformed mesh may have another material: then it counts as a change of materials too.
            if (told.materials)
                CHECK(after.materials > before.materials);
            else if (told.deformed_meshes.empty())
                CHECK(after.materials == before.materials);
            updates += geometry || told.lights || told.materials;
        }
    }
    CHECK(updates > 200);
}

TEST_CASE("prepared scene: a deformed mesh that all threads work on equals one made anew", "[raster][prepared]") {
    Scene scene;
    scene.materials.resize(kMaterials);
    scene.meshes.push_back(make_sphere_of(1, 40'000));
    scene.instances = {{0, {}}, {0, translation({3, 0, 0})}};
    PreparedData prepared = made(scene, {3});
    for (Vec3f& p : scene.meshes[0].positions) p = p * (1.0f + 0.2f * p.x);
    REQUIRE(prepared.update({{}, {0}}, {3}));
    check_same(prepared, made(scene, {1}));
    CHECK(same(prepared.bounds(), scene_bounds(scene)));
}

TEST_CASE("prepared scene: counts and maxima include only what is drawn", "[raster][prepared]") {
    Scene scene;
    scene.materials.resize(kMaterials);
    scene.meshes = {make_box({1, 1, 1}), make_sphere(1, 8, 5), make_plane(1, 1)};
    scene.meshes[0].material = 1;
    scene.meshes[1].material = -1;
    scene.meshes[1].uv0.clear();
    scene.meshes[2].material = 2;
    scene.meshes[2].colors.assign(scene.meshes[2].positions.size(), {1, 9, 1, 1});
    scene.instances = {{0, {}}, {0, scaling({2, 2, 2})}, {1, {}}};
    PreparedData prepared = made(scene);
    CHECK(prepared.triangle_count() == 12 + 12 + 2 * 8 * 4);
    CHECK(prepared.largest_color() == 1.0);
    CHECK(prepared.drawn_materials() == std::vector{false, true, false, true});
    CHECK(prepared.object_radii()[1] == Approx(2.0).epsilon(1e-6));  // the half side of the larger box
    CHECK(prepared.object_radii()[2] == 0.0);
    CHECK((prepared.available_slots()[2] & shading::kColorSlot) != 0);
    CHECK((prepared.available_slots()[1] & shading::kColorSlot) == 0);
    scene.instances.push_back({2, {}});
    prepared = made(scene);
    CHECK(prepared.largest_color() == 9.0);
}

TEST_CASE("prepared scene: no revision is used twice", "[raster][prepared]") {
    Random random(4);
    std::vector<std::uint64_t> geometry, materials, lights;
    for (int round = 0; round < 30; ++round) {
        const Scene scene = any_scene(random);
        for (int copy = 0; copy < 2; ++copy) {
            PreparedData prepared = made(scene);
            for (int step = 0; step < 3; ++step) {
                geometry.push_back(prepared.revision().geometry);
                materials.push_back(prepared.revision().materials);
                lights.push_back(prepared.revision().lights);
                if (scene.meshes.empty()) break;
                REQUIRE(prepared.update({{}, {0}, true, true}));
            }
        }
    }
    for (std::vector<std::uint64_t>* numbers : {&geometry, &materials, &lights}) {
        std::ranges::sort(*numbers);
        CHECK(std::ranges::adjacent_find(*numbers) == numbers->end());
        CHECK(numbers->front() > 0);  // 0 stands for no scene
    }
}

TEST_CASE("prepared scene: a material's colour leaves coverage as it was, its sides, alpha mode and mask do not", "[raster][prepared]") {
    Scene scene;
    scene.materials.resize(2);
    scene.meshes = {make_box({1, 1, 1})};
    scene.meshes[0].material = 0;
    scene.instances = {{0, {}}};
    PreparedData prepared = made(scene);
    const auto changes_coverage = [&] {
        const SceneRevision before = prepared.revision();
        REQUIRE(prepared.update({.materials = true}));
        CHECK(prepared.revision().materials != before.materials);
        CHECK(prepared.revision().geometry == before.geometry);
        return prepared.revision().coverage != before.coverage;
    };
    scene.materials[0].base_color = {1, 0, 0, 1};
    scene.materials[0].roughness = 0.2f;
    CHECK_FALSE(changes_coverage());
    scene.materials[0].double_sided = true;
    CHECK(changes_coverage());
    scene.materials[1].alpha_mode = AlphaMode::blend;
    CHECK(changes_coverage());
    CHECK_FALSE(changes_coverage());
    scene.materials[1].alpha_mode = AlphaMode::mask;
    CHECK(changes_coverage());
    scene.materials[1].alpha_cutoff = 0.7f;
    CHECK(changes_coverage());
}
