// Error budgets in the corners of float32: views opposite a light at grazing angles, and point lights next to surfaces far from the origin.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr int kWidth = 64, kHeight = 48;

/// Checks that the report's bound is within the budget and holds. Returns the largest linear value.
float check_bound(const Scene& scene, const Camera& camera, double budget, Settings settings = {.shadows = ShadowMode::off}) {
    const auto draw = [&](double codes, std::vector<float>& linear) {
        linear.assign(std::size_t{4} * kWidth * kHeight, 0.0f);
        settings.shading.max_error_codes = codes;
        const auto report = render(scene, camera, settings, {kWidth, kHeight, nullptr, linear.data()});
        REQUIRE(report);
        return report->error;
    };
    std::vector<float> truth, fast;
    draw(0, truth);
    const ErrorBound bound = draw(budget, fast);
    const double exposure = static_cast<double>(settings.exposure);
    const auto code = [&](float v) { return shading::reference::srgb_code(static_cast<double>(v) * exposure); };
    double worst = 0;
    float largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (i % 4 == 3) continue;
        worst = std::max(worst, std::fabs(code(truth[i]) - code(fast[i])));
        largest = std::max(largest, truth[i]);
    }
    INFO("bound " << bound.codes << ", measured " << worst << ", rounding " << bound.rounding);
    CHECK(bound.codes <= budget);
    CHECK(worst <= bound.codes);
    return largest;
}

}  // namespace

TEST_CASE("error budget: highlights opposite a light at grazing angles keep to the bound", "[raster][budget]") {
    int seen = 0;
    for (const float angle : {0.01f, 0.0005f, 0.0001f})
        for (const float roughness : {0.05f, 0.158f, 0.3f})
            for (const double budget : {0.05, 0.5, 2.0})
                for (const bool textured : {false, true}) {
                    Scene scene;
                    scene.materials.resize(1);
                    scene.materials[0].metallic = 1.0f;
                    scene.materials[0].roughness = roughness;
                    if (textured) {
                        const std::vector<std::uint8_t> white(16, 255);
                        scene.textures.push_back(*Texture::from_rgba8(white, 2, 2, ColorSpace::linear));
                        scene.materials[0].textures[TextureSlot::metallic_roughness].texture = 0;
                    }
                    scene.meshes = {make_plane(100, 1)};
                    scene.meshes[0].material = 0;
                    scene.instances = {{0, {}}};
                    scene.lights.resize(1);
                    scene.lights[0].direction_ws = {1, -angle, 0};
                    scene.lights[0].color_linear = {11, 11, 11};
                    const Camera camera = halflit::test::camera_at({40, 40 * angle, 0}, {0, 0, 0}, 6 * angle, 0.01f);
                    INFO("angle " << angle << ", roughness " << roughness << ", budget " << budget << ", textured " << textured);
                    seen += check_bound(scene, camera, budget) > 1e-4f;
                }
    CHECK(seen > 20);
}

TEST_CASE("error budget: point lights next to surfaces far from the origin keep to the bound", "[raster][budget]") {
    halflit::test::Random random(1);
    for (int round = 0; round < 150; ++round) {
        const auto origin = static_cast<float>(std::pow(10.0, random.real(4, 6.5)));
        const float step = origin * 1.2e-7f, height = step * random.real32(0.5, 4), size = 40 * step;
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].metallic = 0.0f;
        Mesh mesh;
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(
                {origin + random.real32(-1, 1) * size, random.real32(-0.1, 0.1) * size, origin + random.real32(-1, 1) * size});
        mesh.normals.assign(3, {0, 1, 0});
        mesh.indices = {0, 1, 2};
        mesh.material = 0;
        scene.meshes = {mesh};
        scene.materials[0].double_sided = true;
        scene.instances = {{0, {}}};
        const Vec3f middle = (mesh.positions[0] + mesh.positions[1] + mesh.positions[2]) * (1.0f / 3.0f);
        scene.lights.resize(1);
        scene.lights[0].type = LightType::point;
        scene.lights[0].position_ws = middle + Vec3f{0, height, 0};
        scene.lights[0].color_linear = Vec3f{1, 1, 1} * (height * height * random.real32(0.05, 0.3));
        const Camera camera = halflit::test::camera_at(middle + Vec3f{0, 3 * size, step}, middle, 0.8f, 0.01f * size);
        INFO("round " << round << ", origin " << origin << ", height " << height);
        check_bound(scene, camera, random.real(0.1, 2));
    }
}

TEST_CASE("error budget: wrapped light that a soft-split shadow leaves keeps to the bound", "[raster][budget]") {
    // A slab hangs close above a floor that faces the light: of the lobe's value, about 1, the shadow leaves the excess over N.L, about 0.
    int promised = 0;
    for (const Lobe lobe : {Lobe::sloan(0.2f), Lobe::sloan(0.7f), Lobe::green(0.5f), Lobe::mcauley(0.1f, 1.7f), Lobe::mcauley(0.5f, 4.4f)})
        for (const float tilt : {0.0f, 0.3f, 2.0f})
            for (const double budget : {0.05, 0.5, 4.0, 16.0}) {
                Scene scene;
                scene.materials.resize(1);
                scene.materials[0].lobe = lobe;
                scene.meshes = {make_plane(8, 1), make_box({1, 0.05f, 1})};
                for (Mesh& mesh : scene.meshes) mesh.material = 0;
                scene.instances = {{0, {}}, {1, {}}};
                scene.instances[1].world_from_object.c[3] = {0, 0.5f, 0, 1};
                scene.lights.resize(1);
                scene.lights[0].direction_ws = {tilt, -1, 0};
                Settings settings{.shadows = ShadowMode::soft_split};
                settings.shadow_size = 256;
                settings.exposure = 2;
                settings.shading.specular = SpecularModel::none;
                INFO("w " << lobe.wrap << ", n " << lobe.power << ", tilt " << tilt << ", budget " << budget);
                const Camera camera = halflit::test::camera_at({3, 2, 3}, {0, 0, 0});
                promised += check_bound(scene, camera, budget, settings) > 0;
            }
    CHECK(promised == 60);
}

TEST_CASE("error budget: highlights times a textured colour or metallic factor keep to the bound", "[raster][budget]") {
    halflit::test::Random random(2);
    const auto noise = [&](int size, double low, ColorSpace space) {
        std::vector<std::uint8_t> rgba(static_cast<std::size_t>(4 * size * size));
        for (std::uint8_t& c : rgba) c = static_cast<std::uint8_t>(random.real(low, 255.9));
        return *Texture::from_rgba8(rgba, size, size, space);
    };
    int promised = 0;
    for (const bool metallic_texture : {false, true})
        for (const double low : {0.0, 128.0})
            for (const float roughness : {0.1f, 0.2f, 0.5f})
                for (const float repeats : {1.0f, 50.0f})
                    for (const double budget : {0.1, 1.0, 20.0}) {
                        Scene scene;
                        scene.textures.push_back(noise(1000, low, ColorSpace::linear));
                        scene.materials.resize(1);
                        scene.materials[0].metallic = 1.0f;
                        scene.materials[0].roughness = roughness;
                        TextureUse& use = metallic_texture ? scene.materials[0].textures[TextureSlot::metallic_roughness]
                                                           : scene.materials[0].textures[TextureSlot::base_color];
                        use.texture = 0;
                        use.row_u = {repeats, 0, 0};
                        use.row_v = {0, repeats, 0};
                        scene.meshes = {make_plane(1, 1)};
                        scene.meshes[0].material = 0;
                        scene.instances = {{0, {}}};
                        scene.lights.resize(1);
                        scene.lights[0].direction_ws = {0, -1, 0};
                        // The middle of the highlight is as bright as the texture.
                        scene.lights[0].color_linear = Vec3f{4, 4, 4} * (roughness * roughness * roughness * roughness);
                        const float part = 0.02f / repeats;
                        const Camera camera = halflit::test::camera_at({0.3f, 3, 0.41f}, {0.3f, 0, 0.4f}, 0.2f * part, 0.01f);
                        INFO((metallic_texture ? "metallic" : "colour")
                             << ", from " << low << ", roughness " << roughness << ", repeats " << repeats << ", budget " << budget);
                        promised += check_bound(scene, camera, budget) > 0;
                    }
    CHECK(promised > 60);
}
