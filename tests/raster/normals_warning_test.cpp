// The warning about meshes that are lit, but have no normals.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using Bytes = std::vector<std::uint8_t>;

namespace {

struct Bare {
    Scene scene;
    Settings settings;

    explicit Bare(int meshes, std::size_t with_normals = 1) {
        scene.materials.resize(1);
        for (int i = 0; i < meshes; ++i) {
            Mesh m = make_box({0.2f, 0.2f, 0.2f});
            if (static_cast<std::size_t>(i) >= with_normals) m.normals.clear();
            m.material = 0;
            scene.meshes.push_back(m);
            scene.instances.push_back({i, translation({0.5f * static_cast<float>(i), 0, 0})});
        }
        scene.lights.push_back({});
    }
    [[nodiscard]] std::vector<std::string> warnings() const {
        Bytes pixels(std::size_t{4} * 30 * 30);
        const auto report =
            render(scene, halflit::test::camera_at({1, 1, 5}, {0, 0, 0}), settings, {.width = 30, .height = 30, .pixels = pixels.data()});
        REQUIRE(report);
        return report->warnings;
    }
};

}  // namespace

TEST_CASE("report: lit meshes without normals give one warning", "[raster][frame]") {
    CHECK(Bare(1).warnings().empty());
    const auto one = Bare(2).warnings();
    REQUIRE(one.size() == 1);
    CHECK(one[0].find("mesh 1 has no normals: ") == 0);
    const auto four = Bare(5).warnings();
    REQUIRE(four.size() == 1);
    CHECK(four[0].find("mesh 1 has no normals: ") == 0);
    CHECK(four[0].find("3 other meshes") != std::string::npos);

    // Many instances of one mesh are one mesh.
    Bare bare(2);
    for (int i = 0; i < 10; ++i) bare.scene.instances.push_back({1, {}});
    CHECK(bare.warnings() == one);
    // Ambient light needs normals too.
    bare.scene.lights.clear();
    bare.scene.ambient = {{1, 1, 1}, {0, 0, 0}};
    CHECK(bare.warnings() == one);
}

TEST_CASE("report: meshes whose normals nothing reads give no warning", "[raster][frame]") {
    Bare bare(2);
    bare.scene.materials[0].unlit = true;
    CHECK(bare.warnings().empty());
    bare = Bare(2);
    bare.scene.lights.clear();
    CHECK(bare.warnings().empty());
    bare = Bare(2);
    bare.scene.instances.pop_back();
    CHECK(bare.warnings().empty());
    bare = Bare(2);
    bare.scene.meshes[1].indices.clear();
    CHECK(bare.warnings().empty());
    bare = Bare(2);
    bare.settings.shading.rate = ShadingRate::flat;  // lights triangles by their own normals
    CHECK(bare.warnings().empty());
    bare.settings.shading.rate = ShadingRate::gouraud;
    CHECK(bare.warnings().size() == 1);
    bare = Bare(2);
    generate_flat_normals(bare.scene.meshes[1]);
    CHECK(bare.warnings().empty());
}

TEST_CASE("report: the warning follows updates of a prepared scene", "[raster][frame]") {
    Bare bare(2, 2);
    auto prepared = PreparedScene::make(bare.scene);
    REQUIRE(prepared);
    Renderer renderer;
    Bytes pixels(std::size_t{4} * 30 * 30);
    const auto warnings = [&] {
        return renderer
            .render(*prepared, halflit::test::camera_at({1, 1, 5}, {0, 0, 0}), {}, {.width = 30, .height = 30, .pixels = pixels.data()})
            .value()
            .warnings.size();
    };
    CHECK(warnings() == 0);
    const std::vector<Vec3f> normals = bare.scene.meshes[1].normals;
    bare.scene.meshes[1].normals.clear();
    REQUIRE(prepared->update({.deformed_meshes = {1}}));
    CHECK(warnings() == 1);
    CHECK(warnings() == 1);  // the kept plan has it too
    bare.scene.materials[0].unlit = true;
    REQUIRE(prepared->update({.materials = true}));
    CHECK(warnings() == 0);
    bare.scene.materials[0].unlit = false;
    bare.scene.meshes[1].normals = normals;
    REQUIRE(prepared->update({.deformed_meshes = {1}, .materials = true}));
    CHECK(warnings() == 0);
}
