// Measures of files: the same solid in each format.
#include "halflit/measures.hpp"
#include "tests/io/model_maker.hpp"

using namespace halflit;
using namespace halflit::test;

TEST_CASE("model: the same solid has the same measures in each format", "[io][measures]") {
    const Polyhedron solid = letter();
    struct Case {
        const char* name;
        Bytes file;
    };
    std::vector<Case> cases = {{"glTF", gltf_of(solid)},
                               {"STL", stl_binary_of(solid, "letter")},
                               {"STL text", stl_text_of(solid)},
                               {"PLY", ply_of(solid, PlyKind::little)},
                               {"OBJ", obj_of(solid)}};
    if (has_three_mf())
        cases.push_back({"3MF", three_mf(three_mf_text("millimeter", "<object id=\"1\">" + three_mf_mesh(solid) + "</object>",
                                                       "<item objectid=\"1\"/>"))});
    for (const Case& one : cases) {
        INFO(one.name);
        const LoadedScene loaded = load_any_ok(one.file);
        const auto m = measure_geometry(loaded.scene);
        REQUIRE(m);
        CHECK(m->watertight);
        CHECK(m->bodies == 1);
        CHECK(m->degenerate_triangles == 0);
        CHECK(m->triangles == solid.triangles.size());
        // The letter's area 3 x 1 + 1 x 3, its outline 14, and its height 1.5.
        CHECK(m->volume == Approx(6 * 1.5).epsilon(1e-6));
        CHECK(m->area == Approx(2 * 6 + 14 * 1.5).epsilon(1e-6));
        const Vec3d size = m->size();
        CHECK(size.x == Approx(3).epsilon(1e-6));
        CHECK(size.y == Approx(4).epsilon(1e-6));
        CHECK(size.z == Approx(1.5).epsilon(1e-6));
        const Vec3d center = m->center - m->min;
        CHECK(center.x == Approx((3 * 1.5 + 3 * 0.5) / 6).epsilon(1e-6));
        CHECK(center.y == Approx((3 * 0.5 + 3 * 2.5) / 6).epsilon(1e-6));
        CHECK(center.z == Approx(0.75).epsilon(1e-6));
    }
}
