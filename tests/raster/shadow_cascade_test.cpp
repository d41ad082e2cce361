// Cascades: directional maps of a wide scene seen from within, against rays, and what they must not change.
#include "tests/raster/shadow_city.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

constexpr int kStreetWidth = 800, kStreetHeight = 600;
constexpr float kFov = 0.9f;

using Maps = std::vector<shading::ShadowMapPlan>;

/// A camera's rays to the floor.
struct FloorView {
    Vec3d eye, axis[3];
    int width, height;

    FloorView(const Camera& camera, int w, int h) : width(w), height(h) {
        const Mat4& m = camera.world_from_camera;
        eye = {m.c[3].x, m.c[3].y, m.c[3].z};
        for (int i = 0; i < 3; ++i) axis[i] = {m.c[i].x, m.c[i].y, m.c[i].z};
    }
    /// The floor at a pixel; false where the ray does not meet it.
    bool meets_floor(int i, int j, Vec3d& p) const {
        const double tangent = std::tan(0.5 * double{kFov});
        const double x = ((i + 0.5) / width * 2 - 1) * tangent * width / height, y = (1 - (j + 0.5) / height * 2) * tangent;
        const Vec3d ray = axis[0] * x + axis[1] * y - axis[2];
        if (!(ray.y < -1e-3)) return false;
        p = eye + ray * (-eye.y / ray.y);
        return true;
    }
};

/// A camera at eye height in a street, which looks to the horizon with the box five metres ahead.
Camera street_camera(const City& city, Vec3d moved = {}, double turn = 0) {
    const Vec3d eye = city.foot + Vec3d{1, 1.7, 5} + moved;
    return camera_at(to_float(eye), to_float(eye + Vec3d{std::sin(turn), -0.05, -std::cos(turn)}), kFov);
}

City street_city(int count) {
    City city(count, LightType::directional, {100, 0, 700});
    city.camera = street_camera(city);
    return city;
}

/// Width of a texel of the map that a floor point is looked up in, or of the next map, where the point is near the border.
double texel_at(const Maps& maps, Vec3d p) {
    for (const shading::ShadowMapPlan& map : maps) {
        const auto row = [&](int i) {
            return double{map.rows[i][0]} * p.x + double{map.rows[i][1]} * p.y + double{map.rows[i][2]} * p.z + double{map.rows[i][3]};
        };
        const double rim = std::min({row(0), row(1), map.size - row(0), map.size - row(1)});
        if (map.coarser == 0 || rim > 2 + double{map.offset}) return map.texel_size;
    }
    return 0;
}

/// Compares the floor with rays, without pixels near a shadow's edge, and within `reach` of the eye. Returns the number of pixels.
int check_floor(const City& city, const std::vector<Box>& boxes, double reach, std::vector<int>& by_map) {
    City unlit = city;
    unlit.settings.shadows = ShadowMode::off;
    const Maps maps = plan_of(city, kStreetWidth, kStreetHeight).shading.shadow_maps;
    REQUIRE(maps.size() > 2);
    const std::vector<float> with = city.draw(kStreetWidth, kStreetHeight), lit = unlit.draw(kStreetWidth, kStreetHeight);
    const FloorView view(city.camera, kStreetWidth, kStreetHeight);
    const std::vector<Box> outlines = enlarged(boxes, 0.05);
    int checked = 0, wrong = 0;
    for (int j = 1; j < kStreetHeight; j += 2)
        for (int i = 1; i < kStreetWidth; i += 2) {
            Vec3d p;
            if (!view.meets_floor(i, j, p) || length(p - view.eye) > reach || meets_any(view.eye, p, outlines)) continue;
            const double texel = texel_at(maps, p);
            const Vec3d to = p + kToLight * 60.0;
            const bool dark = meets_any(p, to, enlarged(boxes, -6 * texel));
            if (!dark && meets_any(p, to, enlarged(boxes, 6 * texel))) continue;
            ++checked;
            for (std::size_t k = 0; k < maps.size(); ++k) by_map[k] += maps[k].texel_size == static_cast<float>(texel);
            const auto at = static_cast<std::size_t>(4 * (j * kStreetWidth + i));
            wrong += with[at] != (dark ? 0.0f : lit[at]);
        }
    CHECK(wrong == 0);
    return checked;
}

}  // namespace

namespace {

/// Counts of the floor around the box as the street's camera sees it.
ShadowArea street_area(const City& city) {
    const std::vector<float> with = city.draw(kStreetWidth, kStreetHeight);
    const FloorView view(city.camera, kStreetWidth, kStreetHeight);
    const std::vector<Box> outlines = enlarged({city.boxes[0]}, 0.02);
    ShadowArea area;
    for (int j = 0; j < kStreetHeight; ++j)
        for (int i = 0; i < kStreetWidth; ++i) {
            Vec3d p;
            if (!view.meets_floor(i, j, p) || length(p - city.foot) > 2.5 || meets_any(view.eye, p, outlines)) continue;
            const bool hidden = meets_any(p, p + kToLight * 60.0, city.boxes);
            const bool dark = with[static_cast<std::size_t>(4 * (j * kStreetWidth + i))] < 0.35f;  // the floor has 0.77
            area.hidden += hidden;
            area.wrong += dark != hidden;
            area.drawn += dark;
        }
    return area;
}

}  // namespace

TEST_CASE("shadow cascades: in a street the shadow of a box five metres ahead has the area that rays give it", "[raster][shadow]") {
    // The offset takes up to 2.8 texels from a shadow's end: a map of half the size may miss twice as much.
    for (const int size : {2048, 4096}) {
        City city = street_city(200);
        city.settings.shadow_size = size;
        const Maps maps = plan_of(city, kStreetWidth, kStreetHeight).shading.shadow_maps;
        REQUIRE(maps.size() == shading::kMostCascades);
        const ShadowArea area = street_area(city);
        INFO("texels of " << maps[0].texel_size << ", " << maps[1].texel_size << ", " << maps[2].texel_size << ", " << maps[3].texel_size);
        INFO(area.hidden << " pixels by rays, " << area.drawn << " drawn, " << area.wrong << " differ");
        const double share = size == 4096 ? 0.02 : 0.04;
        CHECK(area.hidden > 5000);
        CHECK(std::abs(area.drawn - area.hidden) <= share * area.hidden);
        CHECK(area.wrong <= share * area.hidden);
    }
}

TEST_CASE("shadow cascades: rays agree with the floor in all maps away from shadows' edges, also when the camera moves",
          "[raster][shadow]") {
    City city = street_city(100);
    std::vector<int> by_map(shading::kMostCascades);
    int checked = 0;
    for (int step = 0; step < 6; ++step) {
        INFO("step " << step);
        city.camera = street_camera(city, {0.11 * step, 0, -0.13 * step}, 0.01 * step);
        checked += check_floor(city, city.boxes, 60, by_map);
    }
    CHECK(checked > 6 * 10000);
    INFO(by_map[0] << ", " << by_map[1] << ", " << by_map[2]);
    CHECK((by_map[0] > 1000 && by_map[1] > 1000));
}

TEST_CASE("shadow cascades: most maps are kept when the camera moves by a tenth of a metre", "[raster][shadow]") {
    City city = street_city(40);
    std::vector<ShadowView> before;
    int kept = 0, all = 0;
    for (int step = 0; step < 30; ++step) {
        city.camera = street_camera(city, {0, 0, -0.1 * step});
        const auto views = plan_of(city, kStreetWidth, kStreetHeight).shadow_views;
        for (std::size_t i = 0; i < std::min(views.size(), before.size()); ++i) ++all, kept += views[i] == before[i];
        before = views;
    }
    INFO(kept << " of " << all);
    CHECK(all > 80);
    CHECK(kept > 0.8 * all);
}

TEST_CASE("shadow cascades: a lit plane is not darkened", "[raster][shadow]") {
    Random random(8);
    for (int trial = 0; trial < 40; ++trial) {
        ShadowSetup setup(Lobe::sloan(0), ShadowMode::hard);
        setup.settings.shadow_size = 256 << trial % 3;
        // Tilted, it counts as a caster.
        const double tilt = random.real(0.005, 0.05), c = std::cos(tilt), s = std::sin(tilt);
        Mat4 place;
        const auto cf = static_cast<float>(c), sf = static_cast<float>(s);
        place.c[0] = {cf, sf, 0, 0}, place.c[1] = {-sf, cf, 0, 0};
        setup.add(make_plane(2000, 1), place);
        const double y = random.real(0.15, 1), turn = random.real(0, 6.283185307), across = std::sqrt(1 - y * y);
        setup.scene.lights[0].direction_ws = to_float(Vec3d{across * std::cos(turn), y, across * std::sin(turn)} * -1.0);
        const Vec3d eye{0, random.real(1, 3), 0};
        const double look = random.real(0, 6.283185307);
        setup.camera = camera_at(to_float(eye), to_float(eye + Vec3d{std::cos(look), -0.1, std::sin(look)}), kFov);
        INFO("trial " << trial);
        CHECK(plan_of(setup, 300, 200).shading.shadow_maps.size() > 2);
        const std::vector<float> with = setup.draw(300, 200);
        setup.settings.shadows = ShadowMode::off;
        CHECK(differing(with, setup.draw(300, 200)) == 0);
    }
}

TEST_CASE("shadow cascades: a region, threads, tiles and instruction sets do not change a picture", "[raster][shadow]") {
    constexpr int kWidth = 200, kHeight = 150;
    for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split}) {
        City city = street_city(20);
        city.scene.materials[0].lobe = Lobe::sloan(0.5f);
        city.settings.shadows = mode;
        CHECK(plan_of(city, kWidth, kHeight).shading.shadow_maps.size() > 2);
        check_parts(city, kWidth, kHeight, {Region{}, Region{0, 0, 30, 40}, Region{101, 97, 1, 1}, Region{50, 20, 150, 90}});
    }
}

TEST_CASE("shadow cascades: a renderer that keeps maps draws what a new one draws", "[raster][shadow][retention]") {
    City city = street_city(20);
    const auto prepared = PreparedScene::make(city.scene);
    REQUIRE(prepared);
    Renderer kept;
    for (const auto& [moved, turn] : {std::pair{Vec3d{}, 0.0},
                                      {Vec3d{0.02, 0, -0.02}, 0.0},
                                      {Vec3d{0.5, 0, -0.5}, 0.02},
                                      {Vec3d{0, 9, 0}, 0.5},
                                      {Vec3d{30, 2500, 0}, 0.5},
                                      {Vec3d{}, 0.0}}) {
        city.camera = street_camera(city, moved, turn);
        std::vector<float> first(4 * 160 * 120), second(first.size());
        Renderer fresh;
        REQUIRE(kept.render(*prepared, city.camera, city.settings, {160, 120, nullptr, first.data()}));
        REQUIRE(fresh.render(*prepared, city.camera, city.settings, {160, 120, nullptr, second.data()}));
        CHECK(differing(first, second) == 0);
    }
}

TEST_CASE("shadow cascades: all count against the memory limit, and scenes that are seen from outside have one map", "[raster][shadow]") {
    City city = street_city(20);
    city.settings.shadow_memory_limit = std::size_t{4} * 1024 * 1024 * sizeof(float);
    const Maps maps = plan_of(city, kStreetWidth, kStreetHeight).shading.shadow_maps;
    REQUIRE(maps.size() == 4);
    CHECK(maps[0].size == 1024);
    for (std::size_t i = 0; i < maps.size(); ++i) CHECK(maps[i].coarser == static_cast<int>(maps.size() - 1 - i));
    for (std::size_t i = 1; i < maps.size(); ++i) CHECK(maps[i - 1].texel_size < 0.51f * maps[i].texel_size);
    for (const float azimuth : {0.0f, 35.0f, 200.0f}) {
        city.camera = frame_scene(city.scene, 1.0f, {.azimuth_deg = azimuth, .elevation_deg = 20});
        CHECK(plan_of(city, kStreetWidth, kStreetHeight).shading.shadow_maps.size() == 1);
    }
}
