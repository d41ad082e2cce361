// Cutting a scene into other parts, or listing opaque parts in another order, changes no bit of its picture. The scenes have no two
// surfaces of equal depth (separate_bodies says why), because of equal depths the first one stays.
#include "tests/raster/metamorphic_scene.hpp"

#include "tests/support/catch.hpp"

#include <numeric>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kScenes = 100;

template <class T>
void shuffle(Random& random, std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i)
        std::swap(items[i - 1], items[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i) - 1))]);
}

/// A mesh of the triangles from `first` up to `last`, with all vertices.
Mesh part_of(const Mesh& mesh, std::size_t first, std::size_t last) {
    Mesh part = mesh;
    part.indices.assign(mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * first),
                        mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * last));
    return part;
}

/// Draws scenes before and after a change that must not show. most_samples 1: for a change of what triangles have in common, as pixels on
/// an edge then show one surface or two.
template <class Change>
void check_unchanged(std::uint64_t first_seed, const Change& change, int most_samples = 16) {
    std::uint64_t visible = 0;
    for (std::uint64_t seed = first_seed; seed < first_seed + kScenes; ++seed) {
        Random random(seed + 1000);
        Shot shot = separate_bodies(seed);
        shot.settings.samples = std::min(shot.settings.samples, most_samples);
        const Pixels before = draw(shot);
        change(random, shot.scene);
        const Pixels after = draw(shot);
        INFO("seed " << seed << ", shadows " << static_cast<int>(shot.settings.shadows) << ", samples " << shot.settings.samples);
        CHECK(differing(before, after) == 0);
        CHECK(before.visible == after.visible);
        visible += before.visible;
    }
    CHECK(visible > std::uint64_t{kScenes} * kViewWidth * kViewHeight / 5);
}

}  // namespace

TEST_CASE("metamorphic: a mesh split in two gives the same bits", "[raster][metamorphic]") {
    check_unchanged(
        100,
        [](Random& random, Scene& scene) {
            Scene split = scene;
            split.instances.clear();
            for (const Instance& instance : scene.instances) {
                const auto mesh = static_cast<std::size_t>(instance.mesh);
                const std::size_t triangles = scene.meshes[mesh].indices.size() / 3;
                const auto cut = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(triangles)));
                split.meshes.push_back(part_of(scene.meshes[mesh], 0, cut));
                split.meshes.push_back(part_of(scene.meshes[mesh], cut, triangles));
                for (const int back : {2, 1})
                    split.instances.push_back({static_cast<int>(split.meshes.size()) - back, instance.world_from_object});
            }
            scene = split;
        },
        1);
}

TEST_CASE("metamorphic: a mesh whose halves share no vertex gives the same bits", "[raster][metamorphic]") {
    check_unchanged(
        200,
        [](Random&, Scene& scene) {
            const std::size_t count = scene.meshes.size();
            for (std::size_t m = 0; m < count; ++m) {
                Mesh& mesh = scene.meshes[m];
                const std::size_t vertices = mesh.positions.size(), corners = mesh.indices.size();
                // Vertices of their own for the second half of the triangles.
                for (std::size_t i = corners / 6 * 3; i < corners; ++i) mesh.indices[i] += static_cast<std::uint32_t>(vertices);
                const auto twice = [](auto& array) {
                    const auto copy = array;
                    array.insert(array.end(), copy.begin(), copy.end());
                };
                twice(mesh.positions), twice(mesh.normals), twice(mesh.tangents), twice(mesh.uv0), twice(mesh.colors);
            }
        },
        1);
}

TEST_CASE("metamorphic: opaque triangles in another order give the same bits", "[raster][metamorphic]") {
    check_unchanged(300, [](Random& random, Scene& scene) {
        for (Mesh& mesh : scene.meshes) shuffle_triangles(random, mesh);
    });
}

TEST_CASE("metamorphic: vertices in another order give the same bits", "[raster][metamorphic]") {
    check_unchanged(400, [](Random& random, Scene& scene) {
        for (Mesh& mesh : scene.meshes) {
            std::vector<std::uint32_t> from(mesh.positions.size());
            std::iota(from.begin(), from.end(), 0u);
            shuffle(random, from);
            const Mesh old = mesh;
            std::vector<std::uint32_t> to(from.size());
            for (std::size_t i = 0; i < from.size(); ++i) {
                to[from[i]] = static_cast<std::uint32_t>(i);
                mesh.positions[i] = old.positions[from[i]];
                mesh.normals[i] = old.normals[from[i]];
                mesh.tangents[i] = old.tangents[from[i]];
                mesh.uv0[i] = old.uv0[from[i]];
                if (!old.colors.empty()) mesh.colors[i] = old.colors[from[i]];
            }
            for (std::uint32_t& index : mesh.indices) index = to[index];
        }
    });
}

TEST_CASE("metamorphic: opaque instances and meshes in another order give the same bits", "[raster][metamorphic]") {
    check_unchanged(500, [](Random& random, Scene& scene) {
        std::vector<int> from(scene.meshes.size());
        std::iota(from.begin(), from.end(), 0);
        shuffle(random, from);
        const std::vector<Mesh> meshes = scene.meshes;
        std::vector<int> to(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) {
            scene.meshes[i] = meshes[static_cast<std::size_t>(from[i])];
            to[static_cast<std::size_t>(from[i])] = static_cast<int>(i);
        }
        for (Instance& instance : scene.instances) instance.mesh = to[static_cast<std::size_t>(instance.mesh)];
        shuffle(random, scene.instances);
    });
}

TEST_CASE("metamorphic: triangles without area and instances without triangles change no bit", "[raster][metamorphic]") {
    check_unchanged(600, [](Random& random, Scene& scene) {
        // Inside the scene's box, to which shadow maps are fitted.
        Mesh line = make_box({0.3f, 0.3f, 0.3f});
        for (std::size_t i = 0; i < line.indices.size(); i += 3) line.indices[i + 1] = line.indices[i];
        line.material = random.index(4);
        scene.meshes.push_back(line);
        scene.meshes.emplace_back();
        scene.materials.emplace_back();
        for (int i = 0; i < 5; ++i)
            scene.instances.insert(scene.instances.begin() + random.index(static_cast<int>(scene.instances.size())),
                                   {5 + random.index(2), translation({random.real32(-1, 1), 0.5f, random.real32(-1, 1)})});
    });
}
