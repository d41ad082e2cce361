// Light in cells: pixels do not depend on tiles, regions, threads or instruction sets, and the error stays within the promise.
#include "shading/reference/reference.hpp"
#include "tests/raster/metamorphic_shots.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

/// A random scene without shadows, under 4 to 43 lights about it, with an error budget.
Shot many_lamps(std::uint64_t seed) {
    Shot shot = any_shot(seed);
    Random random(seed);
    constexpr double kCodes[] = {0.5, 2, 8};
    shot.settings.shadows = ShadowMode::off;
    shot.settings.shading.accuracy = Accuracy::exact;
    shot.settings.shading.rate = ShadingRate::pixel;
    shot.settings.shading.texture_detail = TextureDetail::full;
    if (shot.settings.shading.specular == SpecularModel::ggx)
        shot.settings.shading.specular = SpecularModel::blinn;  // no light in cells with ggx
    shot.settings.shading.max_error_codes = kCodes[random.index(3)];
    for (Material& material : shot.scene.materials) {
        if (random.chance(0.8)) material.textures[TextureSlot::normal] = {};
        if (random.chance(0.5)) material.has_own_lobe = true, material.lobe = Lobe::sloan(random.real32(0, 1));
    }
    const float spread = random.chance(0.5) ? 4.0f : 20.0f;
    const int lamps = 4 + random.index(40);
    for (int i = 0; i < lamps; ++i) {
        Light light;
        light.type = random.chance(0.1) ? LightType::spot : random.chance(0.2) ? LightType::directional : LightType::point;
        light.position_ws = {random.real32(-1, 1) * spread, random.real32(-0.5, 1) * spread, random.real32(-1, 1) * spread};
        light.direction_ws = normalize_or(light.position_ws * -1.0f, {0, -1, 0});
        light.outer_cone_rad = random.real32(0.2, 1.5);
        light.inner_cone_rad = light.outer_cone_rad * random.real32(0, 0.95);
        if (random.chance(0.3)) light.range = spread * random.real32(0.5, 3);
        const float level = (light.type == LightType::directional ? 1.0f : spread * spread) / static_cast<float>(lamps);
        light.color_linear = {level * random.real32(0, 1), level * random.real32(0, 1), level * random.real32(0, 1)};
        shot.scene.lights.push_back(light);
    }
    return shot;
}

RenderReport report_of(const Shot& shot, Pixels& pixels) {
    const auto report = render(shot.scene, shot.camera, shot.settings, pixels.target(), {.threads = 1});
    if (!report) throw std::runtime_error(report.error().message);
    return *report;
}

double code(float linear) { return shading::reference::srgb_code(static_cast<double>(linear)); }

}  // namespace

TEST_CASE("cells: random scenes have the same bits by every instruction set, with several threads and all tiles", "[raster][cells]") {
    int with_cells = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Shot shot = many_lamps(seed);
        Pixels first;
        with_cells += report_of(shot, first).error.cells > 0.0;
        const Pixels expected = draw(shot, execution_of(1, 64, Isa::scalar));
        int turn = static_cast<int>(seed);
        for (const Isa isa : halflit::test::available_isas()) {
            const int tile = 16 << (turn++ % 3), threads = 1 + turn % 3;
            INFO("seed " << seed << ", " << isa_name(isa) << ", threads " << threads << ", tiles " << tile);
            CHECK(differing(expected, draw(shot, execution_of(threads, tile, isa))) == 0);
        }
    }
    CHECK(with_cells >= 25);
}

TEST_CASE("cells: a region of a random scene is the same part of the whole picture", "[raster][cells]") {
    for (std::uint64_t seed = 101; seed <= 140; ++seed) {
        check_regions(seed, many_lamps(seed));
    }
}

TEST_CASE("cells: the tiles that are reported lie in the region", "[raster][cells]") {
    Shot shot = many_lamps(7);
    shot.settings.region = {13, 5, 40, 30};
    Pixels pixels;
    int area = 0;
    Execution execution = execution_of(1, 16, *halflit::default_isa());
    execution.on_tile = [&](const Region& r) {
        CHECK((r.x >= 13 && r.y >= 5 && r.x + r.width <= 53 && r.y + r.height <= 35));
        area += r.width * r.height;
    };
    REQUIRE(render(shot.scene, shot.camera, shot.settings, pixels.target(), execution));
    CHECK(area == 40 * 30);
}

TEST_CASE("cells: no random scene exceeds the promised error", "[raster][cells][budget]") {
    double worst = 0;
    std::uint64_t at_pixels = 0, all = 0;
    for (std::uint64_t seed = 201; seed <= 260; ++seed) {
        Shot shot = many_lamps(seed);
        Pixels drawn, truth;
        const RenderReport report = report_of(shot, drawn);
        if (report.error.cells == 0.0) continue;
        for (const std::uint64_t lanes : report.work.light_lanes) at_pixels += lanes;
        all += report.work.lanes(kStageLights) * shot.scene.lights.size();
        shot.settings.shading.max_error_codes = 0;
        report_of(shot, truth);
        double most = 0;
        for (std::size_t i = 0; i < drawn.linear.size(); ++i)
            if (i % 4 != 3) most = std::max(most, std::fabs(code(drawn.linear[i]) - code(truth.linear[i])));
        INFO("seed " << seed << ": measured " << most << ", promised " << report.error.codes << ", cells " << report.error.cells);
        CHECK(most <= report.error.codes);
        worst = std::max(worst, most / report.error.codes);
    }
    INFO("worst " << worst << ", lights at pixels " << at_pixels << " of " << all);
    CHECK(worst > 0.01);
    CHECK(at_pixels < all * 3 / 4);
}
