// Time of the shading stage alone, for a floor that fills the screen under eight lights: at full accuracy and within error
// budgets, on every instruction set that this processor has. All are measured in turn, in short slices; the shortest slice of each counts.
//
//     halflit_eight_lights_bench [SLICES [POWER [ROUGHNESS]]]      400 slices, t^1.3, highlights of exponent 32
#include "halflit/isa.hpp"
#include "halflit/shapes.hpp"
#include "raster/frame_plan.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace halflit;

namespace {

constexpr int kPatches = 16;  ///< patches on a side of the floor; each is one block of 8 x 8 fragments, as in a tile

Scene eight_lamps(float power, float roughness) {
    Scene scene;
    Material material;
    material.name = "floor";
    material.base_color = {0.8f, 0.6f, 0.5f, 1};
    material.metallic = 0.0f;
    material.roughness = roughness;
    material.lobe = {0.5f, power, true};
    scene.materials.push_back(material);
    Mesh floor = make_plane(2.0f, 8);
    floor.material = 0;
    scene.meshes.push_back(std::move(floor));
    scene.instances.push_back({0, translation({0, 0, 0})});
    for (int i = 0; i < 8; ++i) {
        Light lamp;
        lamp.type = LightType::point;
        lamp.position_ws = {0.9f * static_cast<float>(i % 4) - 1.35f, 0.7f + 0.05f * static_cast<float>(i), i < 4 ? -0.8f : 0.8f};
        lamp.color_linear = {0.16f, 0.14f + 0.01f * static_cast<float>(i % 3), 0.13f};
        scene.lights.push_back(lamp);
    }
    Camera camera;  // looks down from above, so that only the floor is seen
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 3, 0, 1}}};
    camera.fov_y_rad = 0.8f;
    scene.cameras.push_back(camera);
    return scene;
}

/// Blocks of fragments, one per patch of the floor. A wave varies the normals.
std::vector<shading::FragmentBlock> floor_blocks() {
    std::vector<shading::FragmentBlock> blocks(std::size_t{kPatches} * kPatches);
    const int side = static_cast<int>(std::sqrt(static_cast<double>(shading::kBlockSize)));
    for (int patch = 0; patch < kPatches * kPatches; ++patch) {
        shading::FragmentBlock& block = blocks[static_cast<std::size_t>(patch)];
        block = {};
        for (int lane = 0; lane < shading::kBlockSize; ++lane) {
            const float column = static_cast<float>(patch % kPatches) + static_cast<float>(lane % side) / static_cast<float>(side);
            const float row = static_cast<float>(patch / kPatches) + static_cast<float>(lane / side) / static_cast<float>(side);
            const float x = 4.0f * column / kPatches - 2.0f, z = 4.0f * row / kPatches - 2.0f;
            block.lane[shading::kPosX][lane] = x;
            block.lane[shading::kPosZ][lane] = z;
            block.lane[shading::kNormalX][lane] = 0.2f * std::sin(3.0f * x);
            block.lane[shading::kNormalY][lane] = 1.0f;
            block.lane[shading::kNormalZ][lane] = 0.2f * std::sin(3.0f * z);
        }
    }
    return blocks;
}

struct Way {
    std::string name;
    shading::ShadingPlan plan;
    double shortest = 1e30;  ///< ns per fragment
};

std::string described(const shading::ShadingPlan& plan) {
    const shading::MaterialPlan& material = plan.materials.front();
    std::string text = material.lobe.path == shading::LobePath::curve     ? "curve"
                       : material.lobe.path == shading::LobePath::general ? "power"
                                                                          : "simple";
    text += material.specular_curve.squarings >= 0 ? ", highlight curve" : ", highlight power";
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    const int slices = argc > 1 ? std::atoi(argv[1]) : 400;
    const float power = argc > 2 ? static_cast<float>(std::atof(argv[2])) : 1.3f;
    const float roughness = argc > 3 ? static_cast<float>(std::atof(argv[3])) : 0.4925f;
    const Scene scene = eight_lamps(power, roughness);
    const auto prepared = PreparedScene::make(scene);
    if (!prepared) {
        std::fprintf(stderr, "%s\n", prepared.error().message.c_str());
        return 1;
    }
    std::vector<Way> ways;
    const auto add = [&](std::string name, double codes) {
        Settings settings;
        settings.shadows = ShadowMode::off;
        settings.shading.max_error_codes = codes;
        const auto plan = raster::plan_frame(prepared->data(), scene, scene.cameras.front(), settings, 1920, 1080);
        if (!plan) {
            std::fprintf(stderr, "%s\n", plan.error().message.c_str());
            std::exit(1);
        }
        ways.push_back({std::move(name), plan->shading});
    };
    add("exact", 0);
    for (const double codes : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0}) add(std::to_string(codes).substr(0, 4) + " codes", codes);

    for (const Isa isa : built_isas()) {
        if (!isa_available(isa)) continue;
        const shading::ShadeKernels& kernels = shading::shade_kernels(isa);
        std::vector<shading::FragmentBlock> blocks = floor_blocks();
        for (Way& way : ways) way.shortest = 1e30;
        for (int slice = 0; slice < slices; ++slice)
            for (Way& way : ways) {
                const auto start = std::chrono::steady_clock::now();
                for (shading::FragmentBlock& block : blocks)
                    kernels.shade(way.plan, way.plan.materials.front(), {way.plan.lights.data(), static_cast<int>(way.plan.lights.size())},
                                  block, shading::kBlockSize);
                const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - start;
                way.shortest = std::min(way.shortest, passed.count() / static_cast<double>(blocks.size() * shading::kBlockSize));
            }
        std::printf("%s\n", std::string(isa_name(isa)).c_str());
        for (const Way& way : ways)
            std::printf("  %-10s %7.2f ns   %.2fx   bound %6.3f   %s\n", way.name.c_str(), way.shortest,
                        ways.front().shortest / way.shortest, way.plan.error.codes, described(way.plan).c_str());
    }
    return 0;
}
