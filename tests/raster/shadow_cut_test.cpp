// Shadow maps that are cut to what the picture sees: against rays, and what the cut must not change.
#include "tests/raster/shadow_city.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

void check_city(int count) {
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot})
        for (const Vec3d near_to : {Vec3d{0, 0, 0}, Vec3d{1100, 0, -700}, Vec3d{-1900, 0, -1900}}) {
            INFO("city of " << count << ", light " << static_cast<int>(type) << ", at " << near_to.x << ", " << near_to.z);
            City city(count, type, near_to);
            const FramePlan plan = plan_of(city);
            const shading::ShadowMapPlan& map = plan.shading.shadow_maps[0];
            INFO("texels of " << map.texel_size * (type == LightType::directional ? 1.0 : kLampDistance) << " m");
            check_area(city.area());
        }
}

}  // namespace

TEST_CASE("shadow cut: in a close-up of a city the shadow of a box has the area that rays give it", "[raster][shadow]") { check_city(40); }

TEST_CASE("shadow cut: the same among 200 x 200 houses", "[raster][shadow][deep]") { check_city(200); }

namespace {

/// Boxes on a wide floor, a light and a close-up, all random. Returns the number of floor pixels checked against rays; pixels near a
/// shadow's edge are left out.
int check_close_up(Random& random, int& cut) {
    constexpr int kWidth = 60, kHeight = 40;
    ShadowSetup setup(Lobe::sloan(0), ShadowMode::hard);
    setup.settings.shadow_size = 1024;
    setup.add(make_plane(150, 1));
    std::vector<Box> boxes;
    const auto add = [&](Vec3d foot) {
        const Vec3d half{random.real(0.3, 2), random.real(0.3, 2), random.real(0.3, 2)}, middle = foot + Vec3d{0, half.y, 0};
        boxes.push_back({middle - half, middle + half});
        setup.add(make_box(to_float(half)), translation(to_float(middle)));
    };
    const Vec3d target{random.real(-100, 100), 0, random.real(-100, 100)};
    for (int i = 0; i < 40; ++i) add({random.real(-140, 140), 0, random.real(-140, 140)});
    for (int i = 0; i < 5; ++i) add(target + Vec3d{random.real(-5, 5), 0, random.real(-5, 5)});
    const auto on_hemisphere = [&](double least_height) {
        const double y = random.real(least_height, 1), across = std::sqrt(1 - y * y), turn = random.real(0, 6.283185307);
        return Vec3d{across * std::cos(turn), y, across * std::sin(turn)};
    };
    Light& light = setup.scene.lights[0];
    light.type = static_cast<LightType>(random.index(3));
    const bool directional = light.type == LightType::directional;
    const Vec3d to_light = on_hemisphere(0.4), lamp = target + to_light * random.real(8, 200);
    light.direction_ws = to_float(to_light * -1.0);
    light.position_ws = to_float(lamp);
    light.outer_cone_rad = 1.4f, light.inner_cone_rad = 1.3f;
    if (!directional) light.color_linear = Vec3f{1, 1, 1} * static_cast<float>(dot(lamp - target, lamp - target));
    const Vec3d eye = target + on_hemisphere(0.3) * random.real(4, 15);
    const float fov = random.real32(0.2, 1.0);
    setup.camera = camera_at(to_float(eye), to_float(target), fov);
    const FramePlan plan = plan_of(setup, kWidth, kHeight);
    const shading::ShadowMapPlan& map = plan.shading.shadow_maps[0];
    const double texel = double{map.texel_size} * (directional ? 1.0 : length(lamp - target) + 10);
    cut += texel < (directional ? 0.1 : 0.0005 * length(lamp - target));
    const std::vector<float> with = setup.draw(kWidth, kHeight);
    setup.settings.shadows = ShadowMode::off;
    const std::vector<float> lit = setup.draw(kWidth, kHeight);

    const Mat4& m = setup.camera.world_from_camera;
    const auto axis = [&](int c) { return Vec3d{m.c[c].x, m.c[c].y, m.c[c].z}; };
    const double tangent = std::tan(0.5 * double{fov});
    // The filter and the offset of the receiver reach less than six texels. A box that is smaller by that hides all that the filter reads.
    struct Reach {
        std::vector<Box> sure, possible;
    };
    std::vector<Reach> reaches;  // of each cascade
    for (int k = 0; k <= map.coarser; ++k) {
        const double reach = 6 * texel * double{(&map)[k].texel_size} / double{map.texel_size};
        reaches.push_back({enlarged(boxes, -reach), enlarged(boxes, reach)});
    }
    // A point that all cascades' borders are far from is looked up in the first map that shows it; near a border, perhaps in the next one.
    const auto reach_at = [&](Vec3d p) -> const Reach& {
        int k = 0;
        for (; k < map.coarser; ++k) {
            const auto& rows = (&map)[k].rows;
            const auto place = [&](int row) {
                return double{rows[row][0]} * p.x + double{rows[row][1]} * p.y + double{rows[row][2]} * p.z + double{rows[row][3]};
            };
            const double margin = 2 * shading::kShadowBorder, end = (&map)[k].size - margin;
            if (place(0) > margin && place(0) < end && place(1) > margin && place(1) < end) break;
        }
        return reaches[static_cast<std::size_t>(k)];
    };
    const std::vector<Box> outlines = enlarged(boxes, 0.02);  // corners snap to 1/256 of a pixel, so a pixel beside a box may show it
    int checked = 0, wrong = 0;
    for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth; ++i) {
            const double x = ((i + 0.5) / kWidth * 2 - 1) * tangent * kWidth / kHeight, y = (1 - (j + 0.5) / kHeight * 2) * tangent;
            const Vec3d ray = axis(0) * x + axis(1) * y - axis(2);
            if (!(ray.y < -1e-3)) continue;
            const Vec3d p = eye + ray * (-eye.y / ray.y);
            const auto at = static_cast<std::size_t>(4 * (j * kWidth + i));
            if (std::max(std::abs(p.x), std::abs(p.z)) > 149 || meets_any(eye, p, outlines) || !(lit[at] > 0)) continue;
            if (!directional && length(lamp - p) > length(lamp - target) + 10) continue;  // texels are wider there
            const Vec3d to = directional ? p + to_light * 400.0 : lamp;
            const Reach& reach = reach_at(p);
            const bool dark = meets_any(p, to, reach.sure);
            if (!dark && meets_any(p, to, reach.possible)) continue;
            ++checked;
            wrong += with[at] != (dark ? 0.0f : lit[at]);
        }
    INFO("light " << static_cast<int>(light.type) << ", " << checked << " pixels, texels of " << texel);
    CHECK(wrong == 0);
    return checked;
}

void check_close_ups(int count) {
    int checked = 0, cut = 0;
    for (int i = 0; i < count; ++i) {
        Random random(static_cast<std::uint64_t>(i));
        INFO("close-up " << i);
        checked += check_close_up(random, cut);
    }
    CHECK(checked > 400 * count);
    CHECK(cut > count / 2);
}

}  // namespace

TEST_CASE("shadow cut: in random close-ups rays agree with all pixels that are not near a shadow's edge", "[raster][shadow]") {
    check_close_ups(60);
}

TEST_CASE("shadow cut: rays agree in 3,000 random close-ups", "[raster][shadow][deep]") { check_close_ups(3000); }

TEST_CASE("shadow cut: a region, threads, tiles and instruction sets do not change a picture of a cut map", "[raster][shadow]") {
    constexpr int kWidth = 200, kHeight = 150;
    for (const LightType type : {LightType::directional, LightType::point}) {
        City city(20, type, {1100, 0, -700});
        city.camera = camera_at(to_float(city.foot + Vec3d{3, 6, 4}), to_float(city.foot + Vec3d{-0.5, 0, 0}));
        City uncut = city;
        uncut.settings.shadow_terminator_offset = true;
        CHECK(plan_of(city, kWidth, kHeight).shading.shadow_maps[0].texel_size <
              0.02f * plan_of(uncut, kWidth, kHeight).shading.shadow_maps[0].texel_size);
        check_parts(city, kWidth, kHeight, {Region{}, Region{0, 0, 30, 40}, Region{101, 67, 1, 1}, Region{50, 20, 150, 90}});
    }
}

TEST_CASE("shadow cut: where a camera that moves a little sees the same place, only pixels at a shadow's edge change", "[raster][shadow]") {
    for (const LightType type : {LightType::directional, LightType::point}) {
        City city(20, type, {1100, 0, -700});
        const Camera still = city.camera;
        const auto dark = [&] {
            const std::vector<float> with = city.draw(kSide, kSide);
            std::vector<bool> out;
            // A light of colour d^2 at the distance d gives the floor the cosine 0.77.
            for (int i = 0; i < kSide * kSide; ++i) out.push_back(with[static_cast<std::size_t>(4 * i)] < 0.4f);
            return out;
        };
        const std::vector<bool> before = dark();
        std::vector<Mat4> views;
        int compared = 0;
        for (int step = 1; step <= 60; ++step) {  // whole pixels along +z, which is to the right
            city.camera = still;
            city.camera.world_from_camera.c[3].z += static_cast<float>(step * 2.0 * kHalfView / kSide);
            const auto plan = plan_of(city);
            if (views.empty() || !(views.back() == plan.shadow_views[0].view.clip_from_world))
                views.push_back(plan.shadow_views[0].view.clip_from_world);
            if (step % 6 != 0) continue;
            const std::vector<bool> after = dark();
            int away_from_edges = 0;
            for (int j = 1; j < kSide - 1; ++j)
                for (int i = step + 1; i < kSide - 1; ++i) {
                    const auto at = static_cast<std::size_t>(j * kSide + i);
                    ++compared;
                    if (after[at - static_cast<std::size_t>(step)] == before[at]) continue;
                    bool edge = false;
                    for (const std::size_t next : {at - 1, at + 1, at - kSide, at + kSide}) edge |= before[next] != before[at];
                    away_from_edges += !edge;
                }
            INFO("light " << static_cast<int>(type) << ", moved by " << step << " pixels");
            CHECK(away_from_edges == 0);
        }
        CHECK(compared > 1000000);
        // The camera moved by a seventh of what it sees: maps are kept over most of its steps.
        INFO("light " << static_cast<int>(type) << ": " << views.size() << " maps");
        CHECK(views.size() <= 4);
    }
}

TEST_CASE("shadow cut: a camera that sees the whole scene leaves the map as it is fitted to the scene", "[raster][shadow]") {
    ShadowSetup setup(Lobe::sloan(0), ShadowMode::hard);
    setup.add(make_plane(3, 1));
    add_metre_box(setup, {});
    setup.scene.lights[0].direction_ws = to_float(kToLight * -1.0);
    std::vector<Mat4> maps;
    for (const float azimuth : {0.0f, 35.0f, 200.0f}) {
        setup.camera = frame_scene(setup.scene, 1.0f, {.azimuth_deg = azimuth, .elevation_deg = 20});
        maps.push_back(plan_of(setup).shadow_views[0].view.clip_from_world);
    }
    CHECK(maps[0] == maps[1]);
    CHECK(maps[0] == maps[2]);
}

TEST_CASE("shadow cut: faces of a cube that nothing seen looks up are not drawn, and change no pixel", "[raster][shadow]") {
    Random random(3);
    int left_out = 0;
    for (int i = 0; i < 150; ++i) {
        ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::hard);
        setup.settings.shadow_size = 256;
        setup.add(make_plane(20, 1), translation({0, -2, 0}));
        for (int k = 0; k < 60; ++k)
            setup.add(make_box({0.3f, 0.3f, 0.3f}), translation(to_float({random.real(-9, 9), random.real(-1.7, 9), random.real(-9, 9)})));
        Light& light = setup.scene.lights[0];
        light.type = LightType::point;
        light.color_linear = {20, 20, 20};
        setup.camera = camera_at({random.real32(-9, 9), random.real32(0, 9), random.real32(-9, 9)},
                                 {random.real32(-3, 3), random.real32(-2, 3), random.real32(-3, 3)}, random.real32(0.3, 1.6));
        const FramePlan plan = plan_of(setup, 64, 64);
        if (plan.shadow_views.size() != 6) continue;  // it sees so little that one view is enough
        const std::vector<float> with = setup.draw(64, 64);
        setup.settings.shadow_terminator_offset = true;  // draws all faces; flat surfaces' look-ups are not moved
        for (const ShadowView& face : plan_of(setup, 64, 64).shadow_views) CHECK(face.sees_casters);
        CHECK(differing(with, setup.draw(64, 64)) == 0);
        for (const ShadowView& face : plan.shadow_views) left_out += !face.sees_casters;
    }
    INFO(left_out << " faces");
    CHECK(left_out >= 10);
}

TEST_CASE("shadow cut: what a picture sees lies in the volume, and all of the volume nearly in view", "[raster][shadow]") {
    Random random(11);
    int seen_points = 0;
    for (int i = 0; i < 300; ++i) {
        Bounds scene;
        const double size = std::exp(random.real(-3, 6));
        for (int k = 0; k < 2; ++k)
            scene.add(
                to_float({size * random.real(-1, 1), random.chance(0.2) ? 0.0 : size * random.real(-1, 1), size * random.real(-1, 1)}));
        const auto place = [&](double reach) {
            return to_float(Vec3d{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)} * reach);
        };
        Camera camera =
            camera_at(place(2 * size), place(size), random.real32(0.01, 2.5), static_cast<float>(size * random.real(1e-3, 0.5)));
        camera.orthographic = random.chance(0.3);
        camera.half_height = static_cast<float>(size * random.real(0.01, 2));
        if (camera.orthographic || random.chance(0.3)) camera.far_z = camera.near_z + static_cast<float>(size * random.real(0.1, 3));
        const View view = make_view(camera, 200, 100, {}, 64, 1);
        const auto seen = seen_volume(view, depth_map(camera, 2.0f), scene);
        REQUIRE(seen);
        INFO("volume " << i);
        const Mat4& m = view.clip_from_world;
        const auto clip = [&](Vec3d p, int row) {
            const auto at = [row](const Vec4f& c) -> double { return row == 0 ? c.x : row == 1 ? c.y : row == 2 ? c.z : c.w; };
            return at(m.c[0]) * p.x + at(m.c[1]) * p.y + at(m.c[2]) * p.z + at(m.c[3]);
        };
        // All corners of the volume are within the margins.
        for (const Polygon& side : seen->sides)
            for (const Vec3d p : side) {
                const double w = clip(p, 3), rounding = 1e-5 * w;
                CHECK(w > 0);
                CHECK(std::abs(clip(p, 0)) <= 1.012 * w + rounding);
                CHECK(std::abs(clip(p, 1)) <= 1.022 * w + rounding);
                CHECK(clip(p, 2) <= 1.0011 * w + rounding);
                CHECK(clip(p, 2) >= -0.0011 * w - rounding);
                const double margin = 1.1e-5 * size;
                CHECK((p.x >= scene.min.x - margin && p.x <= scene.max.x + margin));
                CHECK((p.y >= scene.min.y - margin && p.y <= scene.max.y + margin));
                CHECK((p.z >= scene.min.z - margin && p.z <= scene.max.z + margin));
            }
        // No point that is in view lies beyond all corners in any direction.
        for (int k = 0; k < 300; ++k) {
            const auto between = [&](float a, float b) { return a + (static_cast<double>(b) - a) * random.real(0, 1); };
            const Vec3d p{between(scene.min.x, scene.max.x), between(scene.min.y, scene.max.y), between(scene.min.z, scene.max.z)};
            const double w = clip(p, 3);
            if (!(w > 0) || std::abs(clip(p, 0)) > w || std::abs(clip(p, 1)) > w || clip(p, 2) < 0 || clip(p, 2) > w) continue;
            ++seen_points;
            const Vec3d along{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
            double farthest = -1e300;
            for (const Polygon& side : seen->sides)
                for (const Vec3d corner : side) farthest = std::max(farthest, dot(along, corner));
            CHECK(dot(along, p) <= farthest);
        }
    }
    CHECK(seen_points > 5000);
}
