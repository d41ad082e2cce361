// The kernel against the float64 reference.
#include "random_case.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

TEST_CASE("kernels: shade agrees with the float64 reference for every kind of scene", "[shading][reference]") {
    // Textures with small steps between texels, nearest filters left out: there a coordinate's last bit picks another texel, which is
    // no error of the arithmetic. sampling_test has those.
    FloatMaker make(31);
    double worst = 0, sum = 0;
    int compared = 0;
    for (int round = 0; round < 400; ++round) {
        Case c = make_case(make, true);
        Material& material = c.materials[0];
        for (TextureUse* use : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                                &material.occlusion_texture, &material.emissive_texture}) {
            use->sampler.mag = use->sampler.min = Filter::linear;
            if (use->sampler.mip == MipFilter::nearest) use->sampler.mip = MipFilter::linear;
        }
        // Below power 1 the lobe has no bounded slope at its edge, so neither has the error.
        material.lobe.power = std::max(material.lobe.power, 1.0f);
        c.options.lobe.power = std::max(c.options.lobe.power, 1.0f);
        material.roughness = std::max(material.roughness, 0.2f);  // exponents up to 1250: beyond, a normal's last bit shows
        const FramePlan old = c.plan;
        c.plan = make_frame_plan(c.materials, c.textures, c.available, c.lights, c.ambient, c.options);
        c.plan.eye_ws = old.eye_ws, c.plan.view_direction_ws = old.view_direction_ws, c.plan.orthographic = old.orthographic;
        const reference::Frame frame = reference_frame(c);
        FragmentBlock block{};
        fill_block(make, block, false);
        shade_kernels(Isa::scalar).shade(c.plan, c.plan.materials[0], all_lights(c.plan), block, kBlockSize);
        for (int lane = 0; lane < kBlockSize; ++lane) {
            const reference::Rgba want = reference::shade(frame, material, c.available[0], block, lane);
            const double got[4] = {block.red[lane], block.green[lane], block.blue[lane], block.alpha[lane]};
            const double expected[4] = {want.r, want.g, want.b, want.a};
            for (int channel = 0; channel < 4; ++channel) {
                const double error = std::fabs(got[channel] - expected[channel]) / std::max(1.0, std::fabs(expected[channel]));
                INFO("round " << round << ", lane " << lane << ", channel " << channel << ", stages " << c.plan.materials[0].stages);
                if (!(error <= 5e-5)) CHECK(got[channel] == Approx(expected[channel]));
                worst = std::max(worst, error), sum += error, ++compared;
            }
        }
    }
    INFO("worst " << worst << ", mean " << sum / compared);
    CHECK(compared > 90000);
    CHECK(sum / compared <= 2e-7);
}

TEST_CASE("kernels: a highlight at the sharpest roughness agrees with the reference to 2e-4 of its peak", "[shading][reference]") {
    Material material;
    material.metallic = 1.0f, material.roughness = 0.0f;
    const Light light{.direction_ws = {0, 0, -1}};
    const std::vector<QuadMask> available{3u, 3u};
    FramePlan plan = make_frame_plan(std::span(&material, 1), {}, available, std::span(&light, 1), {}, {});
    plan.orthographic = true;
    reference::Frame frame{{}, std::span(&light, 1), {}, {}, {}, {0, 0, -1}, true};
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
