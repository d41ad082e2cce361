// KHR_materials_clearcoat: against the extension's formulas in float64, the white furnace, extremes, and every instruction set.
#include "random_case.hpp"
#include "tests/shading/surface_bench.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;
using halflit::test::painted_sky;

namespace {

double schlick(double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); }

struct Bench : SurfaceBench {
    Bench() { material.metallic = 0, material.clearcoat = 1; }
};

double blinn(Vec3d n, Vec3d l, Vec3d v, double roughness) {
    const double s = 2 / std::pow(std::max(0.07, roughness), 4) - 2;
    const double cosine = dot(n, unit(l + v));
    return (s * s + 10 * s + 32) / (8 * (s + 4)) * std::pow(cosine, s) * std::max(0.0, dot(n, l));
}

}  // namespace

TEST_CASE("clearcoat: base and emission keep 1 - c F(N.V), and the coat adds its highlight times c F(N.V)", "[shading][clearcoat]") {
    for (const float share : {0.25f, 1.0f})
        for (const float roughness : {0.2f, 0.5f, 1.0f})
            for (const double view : {0.0, 0.6, 1.2, 1.5})
                for (const double light : {0.1, 0.9, 1.4}) {
                    const Vec3d v = at_angle(view), l = at_angle(light, 2.5);
                    Bench bench;
                    bench.material.clearcoat = share, bench.material.clearcoat_roughness = roughness;
                    bench.material.base_color = {0.5f, 0, 0, 1}, bench.material.emissive = {0, 0, 0.75f};
                    bench.material.dielectric_reflectance = 0;
                    bench.add_light(l);
                    const Vec3d got = bench.seen_from(v);
                    const double mirrored = double{share} * schlick(v.z), coat = mirrored * blinn({0, 0, 1}, l, v, double{roughness});
                    INFO("share " << share << ", roughness " << roughness << ", view " << view << ", light " << light);
                    CHECK(got.x == Approx(0.5 * l.z * (1 - mirrored) + coat).epsilon(1e-5).margin(1e-6));
                    CHECK(got.y == Approx(coat).epsilon(1e-5).margin(1e-6));
                    CHECK(got.z == Approx(0.75 * (1 - mirrored) + coat).epsilon(1e-5).margin(1e-6));
                }
}

TEST_CASE("clearcoat: emission is dimmed by the coat where there is no light at all", "[shading][clearcoat]") {
    Bench bench;
    bench.material.emissive = {0.5f, 1, 2};
    const Vec3d v = at_angle(1.0), got = bench.seen_from(v);
    CHECK(got.x == Approx(0.5 * (1 - schlick(v.z))).epsilon(1e-6));
    CHECK(got.z == Approx(2.0 * (1 - schlick(v.z))).epsilon(1e-6));
}

TEST_CASE("clearcoat: with ggx the coat's highlight is that of a black-bodied dielectric of F0 0.04", "[shading][clearcoat][ggx]") {
    for (const float roughness : {0.1f, 0.4f, 1.0f})
        for (const double view : {0.1, 0.8, 1.3}) {
            Bench coated, body;
            coated.options.specular = body.options.specular = SpecularModel::ggx;
            coated.material.base_color = body.material.base_color = {0, 0, 0, 1};
            coated.material.dielectric_reflectance = 0, coated.material.metallic = 1;
            coated.material.specular = 0;  // no grazing part below either
            coated.material.metallic = 0;
            coated.material.clearcoat_roughness = roughness;
            body.material.clearcoat = 0, body.material.roughness = roughness;
            for (Bench* bench : {&coated, &body}) bench->add_light(at_angle(0.5, 1.0), 3);
            const Vec3d v = at_angle(view);
            INFO("roughness " << roughness << ", view " << view);
            CHECK(coated.seen_from(v).x == Approx(body.seen_from(v).x).epsilon(1e-6));
        }
}

TEST_CASE("clearcoat: factor and roughness follow the red and the green channel of their textures", "[shading][clearcoat]") {
    Bench plain, textured;
    plain.material.clearcoat = 0.5f, plain.material.clearcoat_roughness = 0.4f;
    textured.material.clearcoat_roughness = 0.8f;
    textured.material.textures[TextureSlot::clearcoat].texture = textured.add_texel(0.5, 0.1, 0.2);
    textured.material.textures[TextureSlot::clearcoat_roughness].texture = textured.add_texel(0.9, 0.5, 0.3);
    for (Bench* bench : {&plain, &textured}) bench->add_light(at_angle(0.3));
    CHECK(textured.seen_from(at_angle(0.3)).x == Approx(plain.seen_from(at_angle(0.3)).x).epsilon(1e-4));
}

TEST_CASE("clearcoat: without a normal texture of its own the coat ignores the base's, and with one it has that alone",
          "[shading][clearcoat]") {
    const Vec3d bent = unit({0.5, 0.2, 0.8}), v = at_angle(0.4), l = at_angle(0.5, 3.0);
    for (const bool own : {false, true}) {
        Bench bench;
        bench.material.base_color = {0, 0, 0, 1}, bench.material.dielectric_reflectance = 0;
        bench.material.clearcoat_roughness = 0.5f;
        const int texture = bench.add_texel(0.5 + 0.5 * bent.x, 0.5 + 0.5 * bent.y, 0.5 + 0.5 * bent.z);
        (own ? bench.material.textures[TextureSlot::clearcoat_normal] : bench.material.textures[TextureSlot::normal]).texture = texture;
        bench.add_light(l);
        const Vec3d n = own ? bent : Vec3d{0, 0, 1};
        INFO(own);
        CHECK(bench.seen_from(v).x ==
              Approx(schlick(dot(n, v)) * blinn(n, l, v, 0.5)).epsilon(1e-3));  // the texel's rounding, 1e-5, times the exponent
    }
}

TEST_CASE(
    "clearcoat: a white surface with a coat in a white furnace gets no brighter than 1.005, and darker where it is rough and seen at "
    "grazing views",
    "[shading][clearcoat][environment]") {
    // S: what GGX with F0 0.04 reflects of a uniform sky. F takes more from the base than a rough coat gives back at grazing views.
    double most = 0, least = 1, least_facing = 1, least_smooth = 1;
    Bench bench;
    bench.set_sky(1.0);
    for (int i = 0; i <= 20; ++i)
        for (int j = 1; j <= 20; ++j) {
            bench.material.clearcoat_roughness = static_cast<float>(i / 20.0);
            const double cosine = j / 20.0, got = bench.seen_from(at_angle(std::acos(cosine))).x;
            most = std::max(most, got), least = std::min(least, got);
            if (cosine > 0.29) least_facing = std::min(least_facing, got);
            if (cosine > 0.29 && i <= 6) least_smooth = std::min(least_smooth, got);
        }
    INFO("from " << least << " to " << most << "; N.V from 0.3 on: from " << least_facing << ", roughness up to 0.3 " << least_smooth);
    CHECK(most < 1.005);         // measured: 1.0044
    CHECK(least > 0.28);         // 0.282, at roughness 1 and N.V = 0.05
    CHECK(least_facing > 0.82);  // 0.830
    CHECK(least_smooth > 0.96);  // 0.966
}

TEST_CASE("clearcoat: a coat mirrors an environment as a black dielectric of its roughness does", "[shading][clearcoat][environment]") {
    for (const float roughness : {0.0f, 0.3f, 0.8f})
        for (const double view : {0.2, 1.0, 1.5}) {
            Bench coated, body;
            coated.material.base_color = body.material.base_color = {0, 0, 0, 1};
            coated.material.specular = 0, coated.material.clearcoat_roughness = roughness;
            body.material.clearcoat = 0, body.material.roughness = roughness;
            EnvironmentOptions options;
            options.extract_suns = false;
            const auto sky = std::make_shared<Environment>(make_environment(painted_sky(64, 32,
                                                                                        [](Vec3d d) {
                                                                                            return Vec3d{1 + d.x, 1 + d.y * d.z, 1 - d.z};
                                                                                        })
                                                                                .view(),
                                                                            options));
            coated.environment = body.environment = sky;
            const Vec3d v = at_angle(view, 0.7), got = coated.seen_from(v), want = body.seen_from(v);
            INFO("roughness " << roughness << ", view " << view);
            CHECK(got.x == Approx(want.x).epsilon(1e-6));
            CHECK(got.y == Approx(want.y).epsilon(1e-6));
            CHECK(got.z == Approx(want.z).epsilon(1e-6));
        }
}

TEST_CASE("clearcoat: materials without a coat, unlit ones, and frames without highlights have no stage for it", "[shading][clearcoat]") {
    Bench bench;
    bench.add_light({0, 0, 1});
    const auto stages = [&] { return bench.plan().materials[0].stages & kStageClearcoat; };
    CHECK(stages() != 0);
    bench.material.unlit = true;
    CHECK(stages() == 0);
    bench.material.unlit = false, bench.options.specular = SpecularModel::none;
    CHECK(stages() == 0);
    bench.options.specular = SpecularModel::blinn, bench.material.clearcoat = 0;
    CHECK(stages() == 0);
    bench.material.clearcoat = std::numeric_limits<float>::quiet_NaN();
    CHECK(stages() == 0);
}

TEST_CASE("clearcoat: extremes of share, roughness and angle are finite, and the same bits on every set", "[shading][clearcoat][kernels]") {
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn, SpecularModel::ggx})
        for (const bool sky : {false, true})
            for (const float share : {1e-30f, 0.5f, 1.0f, 5.0f})
                for (const float roughness : {-1.0f, 0.0f, 1e-30f, 0.5f, 1.0f, 1e30f}) {
                    Bench bench;
                    bench.options.specular = model;
                    bench.material.clearcoat = share, bench.material.clearcoat_roughness = roughness;
                    for (const double angle : {0.0, 0.7, 1.5707, 1.570797, 3.0}) bench.add_light(at_angle(angle, 2.0));
                    if (sky)
                        bench.set_sky(1.0);
                    else
                        bench.ambient = {{0.5f, 0.6f, 0.7f}, {0.1f, 0.1f, 0.1f}};
                    ShadingPlan frame = bench.plan();
                    for (const double view : {0.0, 0.7, 1.5707, 1.570796, 1.6, 3.1}) {
                        const Vec3d want = bench.seen_from(at_angle(view), Isa::scalar, frame);
                        INFO("share " << share << ", roughness " << roughness << ", view " << view);
                        REQUIRE((std::isfinite(want.x) && want.x >= 0));
                        for (const Isa isa : halflit::test::available_isas())
                            CHECK(bench.seen_from(at_angle(view), isa, frame).x == want.x);
                    }
                }
}
