// Pictures of shadows on wrapped light: the step of hard shadows at the terminator, the effect of soft_split on it, and surfaces that
// nothing hides. White diffuse surfaces under one directional light of colour 1, so that a pixel is V f(N.L): V the visibility of the
// light, f the lobe.
#include "shading/environment.hpp"
#include "shading/plan/shadow_map_plan.hpp"
#include "tests/raster/shadow_setup.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

const std::vector<std::pair<const char*, Lobe>>& lobes() {
    static const std::vector<std::pair<const char*, Lobe>> all{{"sloan 0", Lobe::sloan(0)},
                                                               {"sloan .25", Lobe::sloan(0.25f)},
                                                               {"sloan .5", Lobe::sloan(0.5f)},
                                                               {"sloan .75", Lobe::sloan(0.75f)},
                                                               {"sloan 1", Lobe::sloan(1)},
                                                               {"green .5", Lobe::green(0.5f)},
                                                               {"valve", Lobe::valve()},
                                                               {"half-lambert", Lobe::half_lambert()},
                                                               {"green .5 normalized", {0.5f, 1, true}},
                                                               {"sloan .5 normalized", {0.5f, 1.5f, true}},
                                                               {"valve normalized", {1, 2, true}}};
    return all;
}

/// Red values of row `y`.
std::vector<float> row(const std::vector<float>& rgba, int y = kHeight / 2, int width = kWidth) {
    std::vector<float> values;
    for (int x = 0; x < width; ++x) values.push_back(rgba[static_cast<std::size_t>(4 * (y * width + x))]);
    return values;
}

std::vector<float> sphere_profile(const Lobe& lobe, ShadowMode mode, int slices = 2048, int stacks = 64, int map_size = 2048) {
    ShadowSetup setup(lobe, mode);
    setup.settings.shadow_size = map_size;
    setup.add(make_sphere(1, slices, stacks));
    return row(setup.draw());
}

float x_of(int pixel) { return (2.0f * static_cast<float>(pixel) + 1.0f) / kWidth - 1.0f; }

/// Largest change between neighbours for x in [low, high].
float steepest(const std::vector<float>& profile, float low, float high) {
    float most = 0;
    for (int i = 0; i + 1 < kWidth; ++i)
        if (x_of(i) >= low && x_of(i + 1) <= high) most = std::max(most, std::fabs(profile[i + 1] - profile[i]));
    return most;
}

}  // namespace

TEST_CASE("shadows: hard shadows step by (w / (1 + w))^n where a sphere turns away from the light", "[raster][shadow]") {
    // Filtering, and the offset that keeps a surface from hiding itself, put the step at N.L = -sqrt(3 t) to -sqrt(9 t), where t is the
    // texel size over the radius. The look-up is 3 t off the sphere, and the filter reads texels up to 1.5 t to either side.
    const float texel = 2.0f / (2048 - 2 * shading::kShadowBorder);
    const float lit_from = -std::sqrt(2.0f * texel), dark_to = -std::sqrt(11.0f * texel);
    for (const auto& [name, lobe] : lobes()) {
        INFO(name);
        const std::vector<float> hard = sphere_profile(lobe, ShadowMode::hard), off = sphere_profile(lobe, ShadowMode::off);
        int lit_wrong = 0, dark_wrong = 0;
        for (int i = 0; i < kWidth; ++i) {
            lit_wrong += x_of(i) > lit_from && hard[i] != off[i];
            dark_wrong += x_of(i) < dark_to && hard[i] != 0.0f;
        }
        CHECK(lit_wrong == 0);
        CHECK(dark_wrong == 0);
        // Height of the step: the value at N.L = 0, between the two pixels beside it, less the value on the dark side, 0.
        const float at_terminator = 0.5f * (hard[kWidth / 2 - 1] + hard[kWidth / 2]);
        CHECK(at_terminator - hard[kWidth / 2 - 100] == Approx(boundary_value(lobe)).margin(1e-3));
    }
}

TEST_CASE("shadows: soft-split is as smooth across a sphere's terminator as no shadow", "[raster][shadow]") {
    // The sphere's own body hides no wrapped light. Elsewhere the offset of look-ups keeps it out of the filter's reach.
    std::vector<std::pair<const char*, Lobe>> all = lobes();
    all.insert(all.end(), {{"mcauley .5, 2", Lobe::mcauley(0.5f, 2)}, {"sloan .1", Lobe::sloan(0.1f)}, {"green .25", Lobe::green(0.25f)}});
    for (const int size : {2048, 256}) {
        for (const auto& [name, lobe] : all) {
            if (lobe.wrap == 0) continue;
            const std::vector<float> off = sphere_profile(lobe, ShadowMode::off),
                                     soft = sphere_profile(lobe, ShadowMode::soft_split, 2048, 64, size);
            const float most = steepest(off, -lobe.wrap, 0.1f), got = steepest(soft, -lobe.wrap, 0.1f);
            INFO(name << ", map of " << size << ": steepest " << most << " without shadows, " << got << " with");
            CHECK(got <= 1.1f * most);  // measured: 1.000 for all
            int brighter = 0, lit_wrong = 0;
            float darkened = 0;
            for (int i = 0; i < kWidth; ++i) {
                brighter += soft[i] > off[i];
                lit_wrong += x_of(i) > 0.0f && soft[i] != off[i];
                darkened = std::max(darkened, off[i] - soft[i]);
            }
            CHECK(brighter == 0);
            CHECK(lit_wrong == 0);
            CHECK(darkened <= 1e-4);
        }
    }
    // The step of hard shadows is several times as steep.
    const Lobe lobe = Lobe::sloan(0.5f);
    CHECK(steepest(sphere_profile(lobe, ShadowMode::hard), -0.5f, 0.1f) > 4 * steepest(sphere_profile(lobe, ShadowMode::off), -0.5f, 0.1f));
}

TEST_CASE("shadows: a body hides its own wrapped light only where it is thicker than a sphere", "[raster][shadow]") {
    // Side of a bar that is turned away from the light by x = N.L = -0.6, half-Lambert. The light's path through the bar is 0.2 / 0.6 =
    // 0.33 long. The fade distance d0 is 2.25 R = 1.31 by default, R = sqrt(1.02 / 3) from the bar's box. A sphere of radius R would be
    // 0.70 thick there; the bar is thinner, so nothing is hidden.
    ShadowSetup setup(Lobe::half_lambert(), ShadowMode::soft_split);
    setup.scene.lights[0].direction_ws = {-0.8f, 0, 0.6f};  // from behind
    setup.add(make_box({1, 0.1f, 0.1f}));
    const std::vector<float> soft = row(setup.draw());
    setup.settings.shadows = ShadowMode::off;
    const std::vector<float> off = row(setup.draw());
    CHECK(off[kWidth / 4] == Approx(0.2f).margin(1e-5));  // (1 - 0.6) / 2
    CHECK(soft[kWidth / 4] == off[kWidth / 4]);
    setup.settings.shadow_fade = 0.3f;  // less than the path through the bar
    setup.settings.shadows = ShadowMode::soft_split;
    CHECK(row(setup.draw())[kWidth / 4] == 0.0f);
}

TEST_CASE("shadows: without wrap, soft-split is hard bit for bit", "[raster][shadow]") {
    for (const Lobe& lobe : {Lobe::lambert(), Lobe{0, 2, true}}) {
        ShadowSetup hard(lobe, ShadowMode::hard), soft(lobe, ShadowMode::soft_split), off(lobe, ShadowMode::off);
        for (ShadowSetup* s : {&hard, &soft, &off}) {
            s->scene.lights[0].direction_ws = {-0.6f, -0.8f, 0};
            s->add(make_sphere(0.5f, 64, 32));
            s->add(make_box({0.1f, 0.05f, 0.6f}), translation({0.45f, 0.6f, 0}));
            s->camera.half_height = 1.0f;
        }
        const std::vector<float> picture = hard.draw(256, 256);
        CHECK(differing(picture, soft.draw(256, 256)) == 0);
        CHECK(differing(picture, off.draw(256, 256)) > 1000);
    }
}

TEST_CASE("shadows: a far caster's shadow is exactly 0 in soft-split too", "[raster][shadow]") {
    for (const auto& [name, lobe] : lobes()) {
        INFO(name);
        ShadowSetup setup(lobe, ShadowMode::soft_split);
        setup.settings.shadow_fade = 0.4f;
        setup.add(make_sphere(0.5f, 128, 64));
        setup.add(make_box({0.01f, 0.6f, 0.6f}), translation({2, 0, 0}));
        const std::vector<float> soft = row(setup.draw());
        setup.settings.shadows = ShadowMode::off;
        const std::vector<float> off = row(setup.draw());
        int checked = 0, wrong = 0;
        for (int i = 0; i < kWidth; ++i) {
            // The box hides the whole sphere.
            if (x_of(i) < 0.49f && x_of(i) > 0.0f) ++checked, wrong += soft[i] != 0.0f || off[i] <= 0.0f;
        }
        CHECK(checked > 200);
        CHECK(wrong == 0);
    }
}

TEST_CASE("shadows: light that leaks in below a touching caster is at most the lobe's value at the terminator", "[raster][shadow]") {
    // A wall on a floor, light from 45 degrees over the wall: in the corner the blocker is as near as possible.
    for (const auto& [name, lobe] : lobes()) {
        ShadowSetup setup(lobe, ShadowMode::soft_split);
        setup.scene.lights[0].direction_ws = {-0.70710678f, -0.70710678f, 0};
        setup.add(make_plane(1, 1));
        setup.add(make_box({0.02f, 0.2f, 0.5f}), translation({0.3f, 0.2f, 0}));
        setup.settings.shadow_fade = 0.3f;
        setup.camera = camera_at({0, 5, 0}, {0, 0, 0});
        setup.camera.orthographic = true;
        setup.camera.half_height = static_cast<float>(kHeight) / kWidth, setup.camera.half_width = 1;
        setup.camera.far_z = 20;
        ShadowSetup plain = setup;
        plain.settings.shadows = ShadowMode::off;
        // Up in the picture is +x for a vertical view, so a column is drawn.
        setup.camera.half_height = 1, setup.camera.half_width = static_cast<float>(kHeight) / kWidth;
        plain.camera = setup.camera;
        const std::vector<float> soft = setup.draw(kHeight, kWidth), off = plain.draw(kHeight, kWidth);
        float leak = 0;
        int shadowed = 0;
        for (int i = 0; i < kWidth; ++i) {
            const float x = -x_of(i);
            const float value = soft[static_cast<std::size_t>(4 * (i * kHeight + 1))];
            // Range: from the foot of the wall to 4 texels before the end of its shadow.
            if (x < 0.278f && x > -0.11f) leak = std::max(leak, value), ++shadowed;
            if (x < -0.2f && x > -0.99f) CHECK(value == off[static_cast<std::size_t>(4 * (i * kHeight + 1))]);
        }
        INFO(name << ": leak " << leak << " of f(0) = " << boundary_value(lobe));
        CHECK(shadowed > 150);
        CHECK(leak <= boundary_value(lobe) + 1e-6);
    }
}

TEST_CASE("shadows: on a coarse sphere soft-split is no rougher than no shadow", "[raster][shadow]") {
    // The equator has 32 facets, all in view, and the light meets them at several angles. A facet turns away from the light as a whole
    // while its normals still reach N.L = 0.084. So in theory hard shadows jump by f(0.084) = .243. With look-ups moved to the smooth
    // surface, where only f(0) is cut, they jump by .140. Of Lambert's light .084 is cut there, and .012 with the move.
    struct Jumps {
        float whole = 0, over_unshadowed = 0;
    };
    const auto measure = [](const Lobe& lobe, ShadowMode mode, bool moved) {
        Jumps jumps;
        for (int turn = 0; turn < 5; ++turn) {
            const float angle = static_cast<float>(turn) / 5 * 11.25f * kRadians, s = std::sin(angle), c = std::cos(angle);
            Mat4 place;
            place.c[0] = {c, 0, -s, 0};
            place.c[2] = {s, 0, c, 0};
            ShadowSetup setup(lobe, mode), open(lobe, ShadowMode::off);
            setup.settings.shadow_terminator_offset = moved;
            setup.add(make_sphere(1, 32, 32), place);
            open.add(make_sphere(1, 32, 32), place);
            const std::vector<float> p = row(setup.draw()), off = row(open.draw());
            // Samples are 1/32 of the radius apart, because the filter turns a step into a ramp of that width.
            for (int i = kWidth / 4; i + 16 < kWidth * 3 / 4; ++i) {
                const float change = p[i + 16] - p[i];
                jumps.whole = std::max(jumps.whole, std::fabs(change));
                jumps.over_unshadowed = std::max(jumps.over_unshadowed, std::fabs(change - (off[i + 16] - off[i])));
            }
        }
        return jumps;
    };
    const Lobe lobe = Lobe::sloan(0.5f);
    const Jumps hard = measure(lobe, ShadowMode::hard, false), hard_moved = measure(lobe, ShadowMode::hard, true);
    const Jumps soft = measure(lobe, ShadowMode::soft_split, false), soft_moved = measure(lobe, ShadowMode::soft_split, true);
    const Jumps plain = measure(Lobe::lambert(), ShadowMode::hard, false);
    INFO("hard " << hard.whole << ", moved " << hard_moved.whole << "; soft-split " << soft.whole << " (over the unshadowed change "
                 << soft.over_unshadowed << "), moved " << soft_moved.whole << " (" << soft_moved.over_unshadowed << "); Lambert "
                 << plain.whole << " (" << plain.over_unshadowed << ")");
    CHECK(hard.whole <= 0.243f);  // measured: .183; the look-up is 3 texels off a facet that is .0048 of its radius below the sphere
    CHECK(hard.whole >= 0.15f);
    CHECK(hard_moved.whole <= 0.16f);  // .142
    CHECK(hard_moved.whole >= 0.12f);
    CHECK(soft.whole <= 0.035f);                 // .026, as without shadows
    CHECK(soft.over_unshadowed <= 0.01f);        // .003; theory .084
    CHECK(soft_moved.over_unshadowed <= 1e-3f);  // .0002; theory .012
    CHECK(plain.over_unshadowed <= 0.01f);
}

TEST_CASE("shadows: look-ups of a fine or flat surface are not moved", "[raster][shadow]") {
    for (const bool sphere : {false, true}) {
        ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::soft_split);
        setup.scene.lights[0].direction_ws = {-0.6f, -0.7f, -0.2f};
        setup.add(sphere ? make_sphere(0.7f, 512, 256) : make_plane(1, 3));
        setup.add(make_box({0.1f, 0.1f, 0.1f}), translation({0.5f, 0.8f, 0.1f}));
        setup.camera = camera_at({0, 5, 0}, {0, 0, 0});
        setup.camera.orthographic = true, setup.camera.half_height = setup.camera.half_width = 1, setup.camera.far_z = 20;
        const std::vector<float> still = setup.draw(200, 200);
        setup.settings.shadow_terminator_offset = true;
        const std::vector<float> moved = setup.draw(200, 200);
        float most = 0;
        for (std::size_t i = 0; i < still.size(); ++i) most = std::max(most, std::fabs(still[i] - moved[i]));
        INFO((sphere ? "sphere" : "plane") << ": " << most << ", " << differing(still, moved) << " values");
        CHECK(most <= (sphere ? 0.05f : 0.0f));
    }
}
