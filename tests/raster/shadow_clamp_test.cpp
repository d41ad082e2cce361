// Shadows in degenerate cases: lights inside meshes and in planes, casters without area, maps' edges, equal depths, maps that are too
// large. All instruction sets must draw the same.
#include "tests/raster/shadow_setup.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

/// Picture that must be the same with every instruction set, finite and not negative.
std::vector<float> on_all_sets(ShadowSetup& setup, int size) {
    std::vector<float> first;
    for (const Isa isa : available_isas()) {
        setup.settings.execution.isa = isa;
        const std::vector<float> picture = setup.draw(size, size);
        if (first.empty()) first = picture;
        CHECK(differing(first, picture) == 0);
        int bad = 0;
        for (const float v : picture) bad += !std::isfinite(v) || v < 0;
        CHECK(bad == 0);
    }
    return first;
}

void look_down(ShadowSetup& setup, float half = 1) {
    setup.camera = camera_at({0, 5, 0}, {0, 0, 0});
    setup.camera.orthographic = true, setup.camera.half_height = setup.camera.half_width = half, setup.camera.far_z = 20;
}

void set_local(ShadowSetup& setup, bool spot, Vec3f position, Vec3f direction) {
    Light& light = setup.scene.lights[0];
    light.type = spot ? LightType::spot : LightType::point;
    light.position_ws = position;
    light.direction_ws = direction;
    light.outer_cone_rad = 1.2f, light.inner_cone_rad = 1.0f;
}

}  // namespace

TEST_CASE("shadows: a light sees of a single-sided mesh what a camera sees there", "[raster][shadow]") {
    // A square between the light and the floor. Its front faces up, to the light, or down, away from it.
    for (const bool spot : {false, true}) {
        for (const bool faces_light : {false, true}) {
            for (const bool double_sided : {false, true}) {
                INFO((spot ? "spot" : "point") << (faces_light ? ", front" : ", back") << (double_sided ? ", double-sided" : ""));
                ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::hard);
                setup.settings.shadow_size = 256;
                set_local(setup, spot, {0.01f, 1.0f, 0.02f}, {0, -1, 0});
                setup.scene.materials[0].double_sided = double_sided;
                setup.add(make_plane(1, 4));
                const Mat4 over{{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0, 0.9f, 0, 1}}};  // half a turn around x
                setup.add(make_plane(0.1f, 1), faces_light ? translation({0, 0.9f, 0}) : over);
                look_down(setup);
                setup.camera.world_from_camera.c[3].y = 0.8f;  // below the square
                const std::vector<float> floor = on_all_sets(setup, 64);
                const float middle = floor[4 * (32 * 64 + 32)];
                CHECK((middle == 0.0f) == (faces_light || double_sided));
            }
        }
    }
}

TEST_CASE("shadows: a light inside a closed double-sided mesh lights nothing outside it", "[raster][shadow]") {
    for (const bool spot : {false, true}) {
        for (const bool box : {false, true}) {
            for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split}) {
                INFO((spot ? "spot" : "point") << " in a " << (box ? "box" : "sphere"));
                ShadowSetup setup(Lobe::sloan(0.5f), mode);
                setup.settings.shadow_fade = 0.1f;
                setup.settings.shadow_size = 256;
                set_local(setup, spot, {0.01f, 0.5f, 0.02f}, {0, -1, 0});
                setup.scene.materials[0].double_sided = true;  // the light sees the mesh from inside
                setup.add(make_plane(1, 4));
                ShadowSetup open = setup;
                setup.add(box ? make_box({0.15f, 0.15f, 0.15f}) : make_sphere(0.2f, 32, 16), translation({0, 0.5f, 0}));
                look_down(setup);
                look_down(open);
                const std::vector<float> floor = on_all_sets(setup, 64), lit = open.draw(64, 64);
                int dark = 0, was_lit = 0;
                for (int j = 0; j < 64; ++j)
                    for (int i = 0; i < 64; ++i) {
                        if (i > 20 && i < 43 && j > 20 && j < 43) continue;  // the mesh itself is seen here
                        const auto at = static_cast<std::size_t>(4 * (j * 64 + i));
                        dark += floor[at] == 0.0f, was_lit += lit[at] > 0.0f;
                    }
                CHECK(dark == 64 * 64 - 22 * 22);
                CHECK(was_lit > 1000);
            }
        }
    }
}

TEST_CASE("shadows: a light in a surface's own plane leaves it as it is without shadows", "[raster][shadow]") {
    for (const bool spot : {false, true}) {
        for (const Vec3f position : {Vec3f{0.1f, 0, 0.2f}, Vec3f{1.5f, 0, 0.3f}, Vec3f{0.25f, 0, 1.5f}, Vec3f{0, 0, 0}}) {
            for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split}) {
                INFO((spot ? "spot at " : "point at ") << position.x << " " << position.z);
                ShadowSetup setup(Lobe::sloan(0.5f), mode);
                setup.settings.shadow_size = 256;
                set_local(setup, spot, position, {-1, 0, 0});
                setup.add(make_plane(1, 4));
                look_down(setup);
                const std::vector<float> picture = on_all_sets(setup, 64);
                setup.settings.shadows = ShadowMode::off;
                CHECK(differing(picture, setup.draw(64, 64)) == 0);
            }
        }
    }
}

TEST_CASE("shadows: leaving out faces of a cube that see nothing changes no pixel", "[raster][shadow]") {
    for (const Vec3f position : {Vec3f{2, 2, 0.5f}, Vec3f{0.3f, 2.5f, -0.2f}, Vec3f{-1.2f, 0.7f, -1.3f}}) {
        ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::hard);
        setup.settings.shadow_size = 256;
        set_local(setup, false, position, {0, -1, 0});
        setup.add(make_plane(1, 2));
        setup.add(make_box({0.2f, 0.2f, 0.2f}), translation({0.1f, 0.3f, 0}));
        // A box behind the light: one view from it does not see them all.
        setup.add(make_box({0.01f, 0.01f, 0.01f}), translation(position + Vec3f{0, 3, 0}));
        look_down(setup);
        const std::vector<float> few_faces = on_all_sets(setup, 64);
        // Tiny boxes on all sides, out of sight, extend the scene's box so that it meets every face.
        for (const float x : {-6.0f, 6.0f})
            for (const float y : {-6.0f, 6.0f}) setup.add(make_box({0.01f, 0.01f, 0.01f}), translation({x, y, x * y / 6}));
        CHECK(differing(few_faces, on_all_sets(setup, 64)) == 0);
        setup.settings.shadows = ShadowMode::off;
        CHECK(differing(few_faces, setup.draw(64, 64)) > 100);
    }
}

TEST_CASE("shadows: casters without area or with a NaN vertex cast nothing", "[raster][shadow]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const int kind : {0, 1, 2}) {
        ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::soft_split);
        setup.settings.shadow_size = 256;
        if (kind > 0) set_local(setup, kind == 2, {0.2f, 1.5f, 0.1f}, {0, -1, 0});
        if (kind == 0) setup.scene.lights[0].direction_ws = {-0.5f, -0.8f, 0.1f};
        setup.add(make_plane(1, 2));
        setup.add(make_box({0.2f, 0.2f, 0.2f}), translation({0.1f, 0.3f, 0}));
        // The map shows the whole box of what follows, with it or without it.
        for (const float x : {-0.5f, 0.5f})
            for (const float z : {-0.5f, 0.5f})
                for (const float y : {0.2f, 0.4f}) setup.add(make_box({0.01f, 0.01f, 0.01f}), translation({x, y, z}));
        look_down(setup);
        const std::vector<float> clean = on_all_sets(setup, 64);
        Mesh broken;
        broken.positions = {{-0.5f, 0.4f, -0.5f}, {0.5f, 0.4f, 0.5f}, {0, 0.4f, 0},      {-0.5f, 0.3f, 0.5f}, {-0.5f, 0.3f, 0.5f},
                            {0.5f, 0.3f, -0.5f},  {nan, 0.4f, 0},     {0.5f, nan, 0.2f}, {0, 0.2f, nan}};
        broken.indices = {0, 1, 2, 3, 4, 5, 3, 3, 3, 0, 1, 6, 0, 7, 5, 8, 1, 3};
        setup.add(std::move(broken));
        INFO("light " << kind);
        CHECK(differing(clean, on_all_sets(setup, 64)) == 0);
    }
}

TEST_CASE("shadows: planes and spheres do not hide themselves under any light", "[raster][shadow]") {
    int compared = 0;
    for (const float degrees : {0.0f, 10.0f, 30.0f, 45.0f, 60.0f, 75.0f, 85.0f}) {
        for (const float turn : {0.0f, 0.3f, 0.7853982f}) {
            for (const bool sphere : {false, true}) {
                const float s = std::sin(degrees * kRadians), c = std::cos(degrees * kRadians);
                ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::soft_split);
                setup.scene.lights[0].direction_ws = {-s * std::cos(turn), -c, -s * std::sin(turn)};
                setup.add(sphere ? make_sphere(1, 256, 128) : make_plane(1, 3));
                setup.camera = camera_at({0, 5, 0}, {0, 0, 0});
                setup.camera.orthographic = true, setup.camera.half_height = 1.1f, setup.camera.half_width = 1.1f, setup.camera.far_z = 20;
                const std::vector<float> soft = setup.draw(200, 200);
                setup.settings.shadows = ShadowMode::hard;
                const std::vector<float> hard = setup.draw(200, 200);
                setup.settings.shadows = ShadowMode::off;
                const std::vector<float> off = setup.draw(200, 200);
                int wrong = 0;
                const float lowest = static_cast<float>(boundary_value(Lobe::sloan(0.5f))) * 1.02f;  // N.L > 0.01
                for (std::size_t i = 0; i < off.size(); i += 4) {
                    if (off[i] < lowest) continue;
                    ++compared, wrong += soft[i] != off[i] || hard[i] != off[i];
                }
                INFO(degrees << " degrees, turned by " << turn << (sphere ? ", sphere" : ", plane"));
                CHECK(wrong == 0);
            }
        }
    }
    CHECK(compared > 400000);
}

TEST_CASE("shadows: a box's shadow begins within four texels of where it stands", "[raster][shadow]") {
    for (const float degrees : {30.0f, 45.0f, 60.0f}) {
        const float s = std::sin(degrees * kRadians), c = std::cos(degrees * kRadians);
        ShadowSetup setup(Lobe::lambert(), ShadowMode::hard);
        setup.scene.lights[0].direction_ws = {-s, -c, 0};
        setup.add(make_plane(1, 1));
        setup.add(make_box({0.1f, 0.2f, 0.3f}), translation({0, 0.2f, 0}));
        // View straight down: the box hides nothing of its shadow.
        setup.camera = camera_at({0, 5, 0}, {0, 0, 0});
        setup.camera.orthographic = true;
        setup.camera.half_width = 0;
        setup.camera.half_height = 0.2f, setup.camera.far_z = 20;
        const int height = 2048;
        const std::vector<float> picture = setup.draw(4, height);
        // In the picture up is +x; the wall's foot on the dark side is at x = -0.1.
        const float texel = 2 * 1.5f / 2048;
        float first_dark = -1;
        for (int i = 0; i < height; ++i) {
            const float x = 0.2f - 0.4f * (static_cast<float>(i) + 0.5f) / static_cast<float>(height);
            if (x < -0.1f && picture[static_cast<std::size_t>(16 * i + 4)] < 0.5f * c) {
                first_dark = x;
                break;
            }
        }
        INFO(degrees << " degrees: first dark point at " << first_dark << ", texels from the box " << (-0.1f - first_dark) / texel);
        CHECK(first_dark > -0.1f - 4 * texel);
    }
}

TEST_CASE("shadows: maps that do not fit their memory are halved, and the report says so", "[raster][shadow]") {
    ShadowSetup setup(Lobe::lambert(), ShadowMode::hard);
    setup.add(make_plane(1, 2));
    setup.add(make_box({0.2f, 0.2f, 0.2f}), translation({0.1f, 0.3f, 0}));
    setup.scene.lights[0].direction_ws = {-0.5f, -0.8f, 0.1f};
    Light lamp;
    lamp.type = LightType::point;
    lamp.position_ws = {0.3f, 1, 0.2f};
    setup.scene.lights.push_back(lamp);
    look_down(setup);
    setup.settings.shadow_size = 256;
    const std::vector<float> full = setup.draw(64, 64);
    // Two maps of 256 x 256 floats: 524 288 bytes.
    const auto draw = [&](std::size_t limit, std::vector<float>& rgba) {
        setup.settings.shadow_memory_limit = limit;
        rgba.assign(4 * 64 * 64, 0.0f);
        return render(setup.scene, setup.camera, setup.settings, {64, 64, nullptr, rgba.data()}, setup.settings.execution);
    };
    std::vector<float> fits, halved, small;
    const auto enough = draw(524288, fits), less = draw(524287, halved);
    REQUIRE(enough);
    REQUIRE(less);
    CHECK(enough->warnings.empty());
    CHECK(differing(full, fits) == 0);
    REQUIRE(less->warnings.size() == 1);
    CHECK(less->warnings[0] == "shadow maps of 128 texels a side instead of 256, to stay within 524287 bytes");
    setup.settings.shadow_size = 128;
    REQUIRE(draw(524288, small));
    CHECK(differing(halved, small) == 0);
    setup.settings.shadow_size = 256;
    const auto refused = draw(32767, small);  // two of 64 x 64 take 32 768
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::limit);
}
