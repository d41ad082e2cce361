// Contact gaps: the width of the lit sliver between the foot of a box and its shadow, by all kinds of maps.
#include "raster/frame_plan.hpp"
#include "tests/raster/box_shadow.hpp"
#include "tests/support/random.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

enum class Map { directional, directional_cut, fitted_lamp, cube, spot };

/// A point in a map, in texels; of a cube: in the face of the point `at`.
struct Texels {
    double u, v, width;  ///< width: of a texel there, world units
};
Texels texels_at(const shading::ShadowMapPlan& map, Vec3d p, Vec3d at) {
    if (map.kind == shading::ShadowMapPlan::Kind::cube) {
        const auto offset = [&](Vec3d q) {
            return std::array{q.x - double{map.origin[0]}, q.y - double{map.origin[1]}, q.z - double{map.origin[2]}};
        };
        const auto from = offset(at), o = offset(p);
        std::size_t axis = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if (std::abs(from[i]) > std::abs(from[axis])) axis = i;
        const double depth = std::abs(o[axis]), width = double{map.texel_size} * depth;
        return {o[(axis + 1) % 3] / width, o[(axis + 2) % 3] / width, width};
    }
    const auto row = [&](int i) {
        return double{map.rows[i][0]} * p.x + double{map.rows[i][1]} * p.y + double{map.rows[i][2]} * p.z + double{map.rows[i][3]};
    };
    const double depth = map.kind == shading::ShadowMapPlan::Kind::perspective ? row(2) : 1.0;
    return {row(0) / depth, row(1) / depth, map.texel_size * depth};
}

/// Gap in texels of the map, measured in the map, and in metres on the floor.
struct Gap {
    double texels = 0, metres = 0, texel_width = 0;
    bool measured = false;
};

/// The gap at a random point of a side of the box that its light does not meet. The scene is one metre wide and stands on a floor.
Gap contact_gap(Random& random, Map kind, int size) {
    ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::hard);
    setup.settings.shadow_size = size;
    setup.settings.shadow_terminator_offset = kind != Map::directional_cut;  // not cut; look-ups of flat surfaces are not moved
    const double half_floor = kind == Map::directional_cut ? 30.0 : 3.0;
    add_metre_box(setup, {});
    if (kind == Map::directional_cut) add_metre_box(setup, {25, 0, 25}), add_metre_box(setup, {-25, 0, -25});
    setup.add(make_plane(static_cast<float>(half_floor), 1));
    const double azimuth = random.real(0, 6.283185307), height = random.real(0.1, 1.0), across = std::sqrt(1 - height * height);
    const Vec3d to_light{across * std::cos(azimuth), height, across * std::sin(azimuth)};
    const double distance = kind == Map::cube ? random.real(1.5, 6) : random.real(4, 30);
    if (kind == Map::cube)
        for (int k = 0; k < 8; ++k)  // on all sides of the lamp
            setup.add(make_box({0.01f, 0.01f, 0.01f}),
                      translation(to_float(to_light * distance + Vec3d{k & 1 ? 3.0 : -3.0, k & 2 ? 3.0 : -0.05, k & 4 ? 3.0 : -3.0})));
    Light& light = setup.scene.lights[0];
    light.type = kind == Map::spot ? LightType::spot : kind == Map::fitted_lamp || kind == Map::cube ? LightType::point : LightType::directional;
    light.direction_ws = to_float(to_light * -1.0);
    light.position_ws = to_float(to_light * distance);
    light.outer_cone_rad = 1.2f;
    light.inner_cone_rad = 1.1f;
    light.color_linear = Vec3f{4, 4, 4} * (light.type == LightType::directional ? 1.0f : static_cast<float>(distance * distance));

    // A side that faces away from the light, and a point at its foot.
    const Vec3d sides[4] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    const Vec3d out = sides[random.index(4)], along = cross(out, {0, 1, 0});
    const Vec3d foot = out * 0.5 + along * random.real(-0.49, 0.49);
    const Vec3d towards = light.type == LightType::directional ? to_light : to_light * distance - foot;
    if (dot(towards, out) > 0) return {};
    // Camera above that foot, so narrow that it sees one line of the floor; up is away from the box.
    constexpr int kHeight = 16384;
    setup.camera = Camera{};
    setup.camera.world_from_camera = {{{static_cast<float>(along.x), 0, static_cast<float>(along.z), 0},
                                       {static_cast<float>(out.x), 0, static_cast<float>(out.z), 0},
                                       {0, 1, 0, 0},
                                       {static_cast<float>(foot.x), 1.5f, static_cast<float>(foot.z), 1}}};
    // right x up = back: `along` is out x y.
    setup.camera.orthographic = true;
    setup.camera.half_height = 1.0f;
    setup.camera.far_z = 3.0f;
    setup.camera.near_z = 0.1f;
    const auto prepared = PreparedData::make(setup.scene);
    REQUIRE(prepared);
    const auto plan = plan_frame(*prepared, setup.camera, setup.settings, 4, kHeight);
    REQUIRE(plan);
    const shading::ShadowMapPlan& map = plan->shading.shadow_maps[0];
    REQUIRE((map.kind == shading::ShadowMapPlan::Kind::cube) == (kind == Map::cube));
    // The shadow must reach far enough to be seen in the map at all: 12 texels beyond the foot.
    const Texels start = texels_at(map, foot, foot);
    const auto texels_from_foot = [&](Vec3d p) {
        const Texels t = texels_at(map, p, foot);
        return std::hypot(t.u - start.u, t.v - start.v);
    };
    const Box box = metre_box({});
    double reach = 0;
    for (int step = 1; step <= 200; ++step) {
        const Vec3d p = foot + out * (step * 0.005);
        if (!meets(p, light.type == LightType::directional ? p + to_light * 100.0 : to_light * distance, box)) break;
        reach = texels_from_foot(p);
    }
    if (reach < 12.0) return {};
    const auto draw = [&](ShadowMode mode) {
        setup.settings.shadows = mode;
        setup.settings.region = {0, 0, 4, kHeight / 2};
        std::vector<float> rgba(std::size_t{4} * 4 * kHeight);
        REQUIRE(render(setup.scene, setup.camera, setup.settings, {4, kHeight, nullptr, rgba.data()}, setup.settings.execution));
        return rgba;
    };
    const std::vector<float> lit = draw(ShadowMode::off), with = draw(ShadowMode::hard);
    Gap gap{1e9, 1e9, start.width, true};
    for (int row = kHeight / 2 - 1; row >= 0; --row) {
        const auto at = static_cast<std::size_t>(16 * row + 4);
        if (!(with[at] < 0.5f * lit[at])) continue;
        gap.metres = 1.0 - 2.0 * (row + 0.5) / kHeight;
        gap.texels = texels_from_foot(foot + out * gap.metres);
        break;
    }
    return gap;
}

/// Largest gap in the map over `directions` random lights for each kind of map and size.
void check_contact(int directions, double bound) {
    Random random(5);
    for (const Map kind : {Map::directional, Map::directional_cut, Map::fitted_lamp, Map::cube, Map::spot})
        for (const int size : {256, 1024, 4096}) {
            double worst = 0, on_floor = 0;
            int measured = 0;
            for (int tried = 0; measured < directions && tried < 20 * directions; ++tried) {
                const Gap gap = contact_gap(random, kind, size);
                if (!gap.measured) continue;
                ++measured;
                worst = std::max(worst, gap.texels);
                on_floor = std::max(on_floor, gap.metres / gap.texel_width);
            }
            CHECK(measured == directions);
            INFO("map " << static_cast<int>(kind) << " of " << size << ": " << worst << " texels in the map, " << on_floor << " on the floor");
            CHECK(worst <= bound);
        }
}

}  // namespace

TEST_CASE("shadow contact: the lit sliver at the foot of a box is at most 5 texels wide in the map", "[raster][shadow]") {
    check_contact(6, 5.0);
}

TEST_CASE("shadow contact: the lit sliver is at most 5 texels wide in any of 1,000 directions", "[raster][shadow][deep]") {
    check_contact(1000, 5.0);
}
