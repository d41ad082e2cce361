// Tests of the kernel against the float64 reference.
#include "random_case.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/scalar.hpp"
#include "shading/planner.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

TEST_CASE("kernels: shade agrees with the float64 reference for every kind of scene", "[shading][reference]") {
    // Textures have small steps between texels, and nearest filters are left out: there the last bit of a coordinate selects another texel,
    // which is no error of the arithmetic. sampling_test covers those.
    FloatMaker make(31);
    double worst = 0, sum = 0;
    int compared = 0, kept = 0;
    for (int round = 0; round < 400; ++round) {
        Case c = make_case(make, true);
        Material& material = c.materials[0];
        for (TextureUse& use : material.textures) {
            use.sampler.mag = use.sampler.min = TextureFilter::linear;
            if (use.sampler.mip == MipFilter::nearest) use.sampler.mip = MipFilter::linear;
        }
        // A lobe with a power below 1 has an unbounded slope at its edge, so its error is unbounded too.
        material.lobe.power = std::max(material.lobe.power, 1.0f);
        if (c.options.lobe) c.options.lobe->power = std::max(c.options.lobe->power, 1.0f);
        material.clearcoat_roughness = std::max(material.clearcoat_roughness, 0.2f);
        material.roughness = std::max(material.roughness, 0.2f);  // exponents up to 1250: above, the last bit of a normal is visible
        const ShadingPlan old = c.plan;
        c.plan = plan_shading({c.materials, c.textures, c.available, plan_lights(c.lights), c.ambient, c.options});
        c.plan.eye_ws = old.eye_ws, c.plan.view_direction_ws = old.view_direction_ws, c.plan.orthographic = old.orthographic;
        c.plan.behind = old.behind;
        const reference::FrameInputs frame = reference_frame(c);
        reference::Surroundings around;
        if (c.plan.behind.rgba != nullptr) around.behind = &c.plan.behind;
        const double bound =
            c.options.specular == SpecularModel::phong ? 1e-4 : 5e-5;  // the mirrored light turns twice as fast as the normal
        FragmentBlock block{};
        fill_block(make, block, false);
        shade_kernels(Isa::scalar).shade(c.plan, c.plan.materials[0], all_lights(c.plan), block, kBlockSize);
        for (int lane = 0; lane < kBlockSize; ++lane) {
            const reference::Rgba want = reference::shade(frame, material, c.available[0], block, lane, around);
            const double got[4] = {block.red[lane], block.green[lane], block.blue[lane], block.alpha[lane]};
            const double expected[4] = {want.r, want.g, want.b, want.a};
            for (int channel = 0; channel < 4; ++channel) {
                const double error = std::fabs(got[channel] - expected[channel]) / std::max(1.0, std::fabs(expected[channel]));
                INFO("round " << round << ", lane " << lane << ", channel " << channel << ", stages " << c.plan.materials[0].stages);
                if (!(error <= bound)) CHECK(got[channel] == Approx(expected[channel]));
                worst = std::max(worst, error), sum += error, ++compared;
            }
            if (!material.transmits()) continue;
            const Vec3d keep = reference::kept(frame, material, c.available[0], block, lane, around);
            for (const auto& [kernel, truth] :
                 {std::pair{block.keep[0][lane], keep.x}, {block.keep[1][lane], keep.y}, {block.keep[2][lane], keep.z}}) {
                INFO("round " << round << ", lane " << lane << ", stages " << c.plan.materials[0].stages);
                if (!(std::fabs(double{kernel} - truth) <= 2e-6)) CHECK(kernel == Approx(truth));
                ++kept;
            }
        }
    }
    INFO("worst " << worst << ", mean " << sum / compared);
    CHECK(compared > 90000);
    CHECK(kept > 10000);
    CHECK(sum / compared <= 2e-7);
}

TEST_CASE("kernels: a highlight at the sharpest roughness agrees with the reference to 2e-4 of its peak", "[shading][reference]") {
    const SpecularModel highlight = GENERATE(SpecularModel::blinn, SpecularModel::phong);
    ShadingSettings options;
    options.specular = highlight;
    Material material;
    material.metallic = 1.0f, material.roughness = 0.0f;
    const Light light{.direction_ws = {0, 0, -1}};
    const std::vector<SlotMask> available{3u, 3u};
    ShadingPlan plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
    plan.orthographic = true;
    reference::FrameInputs frame{{}, std::span(&light, 1), {}, options, {}, {0, 0, -1}, true};
    FragmentBlock block{};
    for (int lane = 0; lane < kBlockSize; ++lane) {
        // Normals up to 1 degree from the half vector.
        const double angle = 0.0175 * lane / kBlockSize;
        block.lane[kNormalX][lane] = static_cast<float>(std::sin(angle)), block.lane[kNormalZ][lane] = static_cast<float>(std::cos(angle));
    }
    shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    const double peak = reference::shade(frame, material, 3u, block, 0).r;
    CHECK(peak > 1e4);
    for (int lane = 0; lane < kBlockSize; ++lane) {
        INFO("lane " << lane);
        CHECK(std::fabs(block.red[lane] - reference::shade(frame, material, 3u, block, lane).r) <= 2e-4 * peak);
    }
}

TEST_CASE("kernels: Phong with a quarter of Blinn's exponent has nearly the same peak and half width", "[shading][reference]") {
    // View along the light, on a surface tilted by an angle d: N.H = cos d and R.V = cos 2d. H: half vector, R: mirrored light, V: view.
    Material material;
    material.metallic = 1.0f, material.roughness = 0.3f;  // s = 2 / 0.09^2 - 2 = 244.9
    const Light light{.direction_ws = {0, 0, -1}};
    const std::vector<SlotMask> available{3u, 3u};
    FragmentBlock blocks[2]{};
    for (int i = 0; i < 2; ++i) {
        ShadingSettings options;
        options.specular = i == 0 ? SpecularModel::blinn : SpecularModel::phong;
        ShadingPlan plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
        plan.orthographic = true;
        for (int lane = 0; lane < kBlockSize; ++lane) {
            const double angle = 0.15 * lane / kBlockSize;
            blocks[i].lane[kNormalX][lane] = static_cast<float>(std::sin(angle));
            blocks[i].lane[kNormalZ][lane] = static_cast<float>(std::cos(angle));
        }
        shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), blocks[i], kBlockSize);
    }
    const double s = 2.0 / (0.09 * 0.09) - 2.0, peak = (s + 8.0) / 8.0;
    CHECK(blocks[0].red[0] == Approx((s * s + 10.0 * s + 32.0) / (8.0 * (s + 4.0))).epsilon(1e-5));
    CHECK(blocks[1].red[0] == Approx(peak).epsilon(1e-5));
    for (int lane = 0; lane < kBlockSize; ++lane)  // cos^4 d and cos 2d are the same to second order in d: 2 d^4 s / 3 apart
        CHECK(std::fabs(blocks[0].red[lane] / blocks[0].red[0] - blocks[1].red[lane] / blocks[1].red[0]) <= 0.01);
}

TEST_CASE("kernels: a highlight's peak is ks times the norm of its exponent, and 1 - ks is left to the diffuse part",
          "[shading][reference]") {
    const Light light{.direction_ws = {0, 0, -1}};
    const std::vector<SlotMask> available{3u, 3u};
    ShadingSettings options;
    options.specular = GENERATE(SpecularModel::blinn, SpecularModel::phong);
    const double s = GENERATE(0.0, 2.0, 40.0, 1000.0, 80000.0);
    Material material;
    material.metallic = 0.0f, material.base_color = {0.25f, 0.5f, 0, 1};
    material.roughness = static_cast<float>(roughness_of_exponent(s));
    const double norm = options.specular == SpecularModel::phong ? (s + 8) / 8 : (s * s + 10 * s + 32) / (8 * (s + 4));
    for (const float ks : {0.0f, 0.04f, 0.3f, 1.0f}) {
        material.dielectric_reflectance = ks;
        ShadingPlan plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
        plan.orthographic = true;
        reference::FrameInputs frame{{}, std::span(&light, 1), {}, options, {}, {0, 0, -1}, true};
        FragmentBlock block{};
        for (int lane = 0; lane < kBlockSize; ++lane) block.lane[kNormalZ][lane] = 1.0f;
        shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
        const double peak = static_cast<double>(ks) * norm, matt = 1 - static_cast<double>(ks);
        INFO("ks " << ks << ", s " << s);
        CHECK(block.red[0] == Approx(0.25 * matt + peak).epsilon(2e-5));
        CHECK(block.green[0] == Approx(0.5 * matt + peak).epsilon(2e-5));
        CHECK(block.blue[0] == Approx(peak).epsilon(2e-5));
        const auto truth = reference::shade(frame, material, 3u, block, 0);
        CHECK(truth.r == Approx(0.25 * matt + peak).epsilon(1e-6));
        CHECK(truth.b == Approx(peak).epsilon(1e-6));
    }
}

TEST_CASE("kernels: no highlight where the light is behind the surface, however far the lobe wraps", "[shading]") {
    Material material;
    material.metallic = 1.0f, material.roughness = 0.8f, material.lobe = Lobe::valve();
    const Light light{.direction_ws = {0, 0, -1}};
    const std::vector<SlotMask> available{3u, 3u};
    const SpecularModel highlight = GENERATE(SpecularModel::blinn, SpecularModel::phong);
    ShadingSettings options;
    options.specular = highlight;
    ShadingPlan plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
    plan.orthographic = true;
    plan.view_direction_ws = {-1, 0, 0};
    FragmentBlock block{};
    for (int lane = 0; lane < kBlockSize; ++lane) {
        const double x = -1.0 * lane / kBlockSize;  // N.L from 0 to -1
        block.lane[kNormalX][lane] = static_cast<float>(std::sqrt(1 - x * x)), block.lane[kNormalZ][lane] = static_cast<float>(x);
    }
    shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    // A metal has no diffuse light, so any light here would be the highlight.
    for (int lane = 0; lane < kBlockSize; ++lane) CHECK(block.red[lane] == 0.0f);
}

TEST_CASE("kernels: a spot's cosine power falls off as cos(angle)^power inside the cone", "[shading][reference]") {
    // [CMSC]: intensity (-L.d)^f. L: direction to the light, d: direction of the spot, f: cone_power. The points lie on a sphere of radius
    // 1 around the light, and the surface faces the light at every point.
    Material material;
    Light light{.type = LightType::spot, .position_ws = {0, 0, 0}, .direction_ws = {0, 0, -1}};
    light.inner_cone_rad = 1.4f, light.outer_cone_rad = 1.45f;
    const float power = GENERATE(1.0f, 7.5f, 64.0f, 20000.0f);
    light.cone_power = power;
    const std::vector<SlotMask> available{3u, 3u};
    ShadingSettings options;
    options.specular = SpecularModel::none;
    const ShadingPlan plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
    FragmentBlock block{};
    for (int lane = 0; lane < kBlockSize; ++lane) {
        const double angle = 1.35 * lane / kBlockSize / std::sqrt(static_cast<double>(power));
        block.lane[kPosX][lane] = static_cast<float>(std::sin(angle)), block.lane[kPosZ][lane] = static_cast<float>(-std::cos(angle));
        block.lane[kNormalX][lane] = static_cast<float>(-std::sin(angle)), block.lane[kNormalZ][lane] = static_cast<float>(std::cos(angle));
    }
    shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    for (int lane = 0; lane < kBlockSize; ++lane) {
        const double x = block.lane[kPosX][lane], z = block.lane[kPosZ][lane];
        const double want = std::pow(1.0 / std::sqrt(1.0 + (x / z) * (x / z)), static_cast<double>(power));
        INFO("power " << power << ", lane " << lane);
        CHECK(std::fabs(block.red[lane] - want) <= 1e-5 + 2e-4 * want);
    }
}
