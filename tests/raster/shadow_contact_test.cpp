// Contact gaps: the width of the lit sliver between the foot of a body and its shadow, by all kinds of maps. A box hides the floor behind
// it by its far side, so its shadow begins at its foot. A thin wall hides it by a side that lies close to the floor in depth.
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

/// Lengths from the foot of the body away from it. In texels of the map, measured in the map.
struct Gap {
    bool measured = false;
    double texels = 0;    ///< of the farthest lit point that is not near the shadow's end
    double on_floor = 0;  ///< the same along the floor, in widths of a texel
    double lost = 0;      ///< between the last dark point and the end of the shadow by rays
};

/// The gap at a random point of a side of a box that its light does not meet. wall: only a wall of 1 mm stands there.
Gap contact_gap(Random& random, Map kind, int size, bool wall) {
    ShadowSetup setup(Lobe::sloan(0.5f), ShadowMode::hard);
    setup.settings.shadow_size = size;
    setup.settings.shadow_terminator_offset = kind != Map::directional_cut;  // not cut; look-ups of flat surfaces are not moved
    const double half_floor = kind == Map::directional_cut ? 30.0 : 3.0;
    const Vec3d sides[4] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    const Vec3d out = sides[random.index(4)], along = cross(out, {0, 1, 0});
    const Vec3d inwards = out * (wall ? 0.001 : 1.0);
    const Vec3d half = absolute(along * 0.5) + Vec3d{0, 0.5, 0} + absolute(inwards * 0.5),
                middle = Vec3d{0, 0.5, 0} + out * 0.5 - inwards * 0.5;
    const Box body{middle - half, middle + half};
    setup.add(make_box(to_float(half)), translation(to_float(middle)));
    if (kind == Map::directional_cut) add_metre_box(setup, {25, 0, 25}), add_metre_box(setup, {-25, 0, -25});
    setup.add(make_plane(static_cast<float>(half_floor), 1));
    const double azimuth = random.real(0, 6.283185307), height = random.real(0.1, 1.0), across = std::sqrt(1 - height * height);
    const Vec3d to_light{across * std::cos(azimuth), height, across * std::sin(azimuth)};
    const double distance = kind == Map::cube ? random.real(1.5, 6) : random.real(4, 30);
    if (kind == Map::cube)
        for (int k = 0; k < 8; ++k)  // on all sides of the light
            setup.add(make_box({0.01f, 0.01f, 0.01f}),
                      translation(to_float(to_light * distance + Vec3d{k & 1 ? 3.0 : -3.0, k & 2 ? 3.0 : -0.05, k & 4 ? 3.0 : -3.0})));
    Light& light = setup.scene.lights[0];
    light.type = kind == Map::spot                               ? LightType::spot
                 : kind == Map::fitted_lamp || kind == Map::cube ? LightType::point
                                                                 : LightType::directional;
    light.direction_ws = to_float(to_light * -1.0);
    light.position_ws = to_float(to_light * distance);
    light.outer_cone_rad = 1.2f;
    light.inner_cone_rad = 1.1f;
    light.color_linear = Vec3f{4, 4, 4} * (light.type == LightType::directional ? 1.0f : static_cast<float>(distance * distance));

    // A side that faces away from the light, and a point at its foot.
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
    const auto plan = plan_frame(*prepared, prepared->scene(), setup.camera, setup.settings, 4, kHeight);
    REQUIRE(plan);
    const shading::ShadowMapPlan& map = plan->shading.shadow_maps[0];
    REQUIRE((map.kind == shading::ShadowMapPlan::Kind::cube) == (kind == Map::cube));
    // The shadow must reach far enough to be seen in the map at all: 12 texels beyond the foot.
    const Texels start = texels_at(map, foot, foot);
    const auto texels_from_foot = [&](Vec3d p) {
        const Texels t = texels_at(map, p, foot);
        return std::hypot(t.u - start.u, t.v - start.v);
    };
    double reach = 0, end = 0;
    bool ends_in_view = false;
    for (int step = 1; step <= 4000 && !ends_in_view; ++step) {
        const Vec3d p = foot + out * (step * 0.00025);
        ends_in_view = !meets(p, light.type == LightType::directional ? p + to_light * 100.0 : to_light * distance, body);
        if (!ends_in_view) reach = texels_from_foot(p), end = step * 0.00025;
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
    Gap gap{true, 0, 0, 0};
    double last_dark = 0;
    for (int row = kHeight / 2 - 1; row >= 0; --row) {
        const double metres = 1.0 - 2.0 * (row + 0.5) / kHeight, texels = texels_from_foot(foot + out * metres);
        if (metres > end) break;
        const auto at = static_cast<std::size_t>(16 * row + 4);
        if (with[at] < 0.5f * lit[at])
            last_dark = texels;
        else if (texels < reach - 6.0)
            gap.texels = texels, gap.on_floor = metres / start.width;
    }
    if (ends_in_view) gap.lost = reach - last_dark;
    return gap;
}

/// Checks the largest gap and loss over random lights, for each kind of map and size.
void check_contact(int directions, bool wall, double most_gap, double most_lost) {
    Random random(5);
    for (const Map kind : {Map::directional, Map::directional_cut, Map::fitted_lamp, Map::cube, Map::spot})
        for (const int size : {256, 1024, 4096}) {
            Gap worst;
            int measured = 0;
            for (int tried = 0; measured < directions && tried < 20 * directions; ++tried) {
                const Gap gap = contact_gap(random, kind, size, wall);
                if (!gap.measured) continue;
                ++measured;
                worst = {true, std::max(worst.texels, gap.texels), std::max(worst.on_floor, gap.on_floor), std::max(worst.lost, gap.lost)};
            }
            CHECK(measured == directions);
            INFO("map " << static_cast<int>(kind) << " of " << size << ": gap of " << worst.texels << " texels in the map, "
                        << worst.on_floor << " on the floor; " << worst.lost << " lost at the end");
            CHECK(worst.texels <= most_gap);
            CHECK(worst.lost <= most_lost);
        }
}

}  // namespace

TEST_CASE("shadow contact: a box's shadow begins at its foot, and a thin wall's within a texel", "[raster][shadow]") {
    check_contact(4, false, 0.0, 4.0);
    check_contact(4, true, 1.0, 4.0);
}

TEST_CASE("shadow contact: the same for 1,000 lights", "[raster][shadow][deep]") {
    check_contact(67, false, 0.0, 4.0);
    check_contact(67, true, 1.0, 4.0);
}
