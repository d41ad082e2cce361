// Comparison of generated tangents with those in model files, which other tools made by MikkTSpace's rules, as far as they kept to them.
#include "halflit/mesh.hpp"
#include "tests/io/gltf_builder.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::test;

namespace {

/// Angles in degrees between given and made tangents, corner by corner, sorted, and how many corners differ in w.
struct Comparison {
    std::vector<double> degrees;
    std::size_t other_sign = 0;
    [[nodiscard]] double at(double quantile) const {
        return degrees[static_cast<std::size_t>(quantile * static_cast<double>(degrees.size() - 1))];
    }
};

Comparison compare(const Scene& scene) {
    Comparison out;
    for (const Mesh& given : scene.meshes) {
        const TextureUse* normal_map =
            given.material < 0 ? nullptr : &scene.materials[static_cast<std::size_t>(given.material)].textures[TextureSlot::normal];
        const int uv_set = normal_map == nullptr || !normal_map->used() ? 0 : normal_map->uv_set;
        if (given.tangents.empty() || (uv_set == 1 ? given.uv1 : given.uv0).empty()) continue;
        Mesh made = given;
        made.tangents.clear();
        generate_tangents(made, uv_set);
        for (std::size_t i = 0; i < given.indices.size(); ++i) {
            const Vec4f a = given.tangents[given.indices[i]], b = made.tangents[made.indices[i]];
            const double cosine = (double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z) /
                                  std::sqrt((double{a.x} * a.x + double{a.y} * a.y + double{a.z} * a.z) *
                                            (double{b.x} * b.x + double{b.y} * b.y + double{b.z} * b.z));
            out.degrees.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / 3.14159265358979);
            out.other_sign += a.w != b.w ? 1 : 0;
        }
    }
    std::sort(out.degrees.begin(), out.degrees.end());
    return out;
}

}  // namespace

TEST_CASE("models: generated tangents agree with those in model files", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    struct Case {
        const char* path;
        double median, p90, most;  // degrees
        double other_sign;         // share of the corners, at most
        bool opposite_sign;
    };
    // Blender's exporter and the glTF asset generator keep MikkTSpace's rules, so only float rounding is left. But the exporter of 2018
    // (VertexColorTest) wrote w = 1 also for the 6 of 108 corners whose chart is mirrored. Maya's exporter has its own rules, which agree
    // on most corners. The VKTS exporter (Cube, TwoSidedPlane) stores w with the opposite sign of all others.
    for (const Case& c : {Case{"VertexColorTest/VertexColorTest.glb", 1e-4, 1e-4, 1e-3, 6.0 / 108, false},
                          {"AlphaBlendModeTest/AlphaBlendModeTest.glb", 1e-4, 1e-4, 2e-3, 0, false},
                          {"ShadowsDirectional/shadows-directional.gltf", 1e-4, 1e-4, 1e-3, 0, false},
                          {"AssetGenerator/Material_DoubleSided/Material_DoubleSided_03.gltf", 1e-4, 1e-4, 1e-3, 0, false},
                          {"Cube/Cube.gltf", 1e-4, 1e-4, 1e-3, 0, true},
                          {"TwoSidedPlane/TwoSidedPlane.gltf", 1e-4, 1e-4, 1e-3, 0, true},
                          {"FlightHelmet/FlightHelmet.gltf", 0.5, 3.0, 181.0, 1e-4, false},
                          {"CornellBox/cornellBox.glb", 0.3, 2.0, 181.0, 1e-3, false}}) {
        const auto loaded = load_gltf((*assets / "models" / c.path).string());
        INFO(c.path);
        REQUIRE(loaded);
        const Comparison found = compare(loaded->scene);
        REQUIRE(!found.degrees.empty());
        CHECK(found.at(0.5) <= c.median);
        CHECK(found.at(0.9) <= c.p90);
        CHECK(found.at(1.0) <= c.most);
        const std::size_t other_sign = c.opposite_sign ? found.degrees.size() - found.other_sign : found.other_sign;
        CHECK(static_cast<double>(other_sign) <= c.other_sign * static_cast<double>(found.degrees.size()));
    }
}
