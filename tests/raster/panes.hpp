// Panes of glass and coloured panels across the picture of camera_flat().
#pragma once

#include "halflit/renderer.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace halflit::test {

struct Picture {
    std::vector<std::uint8_t> codes;
    std::vector<float> linear;
    friend bool operator==(const Picture&, const Picture&) = default;
};

inline Picture draw(const Scene& scene, const Settings& settings, int width, int height, const Execution& execution = {}) {
    Picture picture{std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height)), {}};
    picture.linear.resize(picture.codes.size());
    const auto report = render(scene, camera_flat(), settings, {width, height, picture.codes.data(), picture.linear.data()}, execution);
    REQUIRE(report);
    return picture;
}

/// The largest difference, in linear light, between the kernels' picture and that of Accuracy::reference.
inline double off_reference(const Scene& scene, int width, int height) {
    Settings settings;
    const Picture exact = draw(scene, settings, width, height);
    settings.shading.accuracy = Accuracy::reference;
    const Picture reference = draw(scene, settings, width, height);
    double worst = 0;
    for (std::size_t i = 0; i < exact.linear.size(); ++i)
        worst = std::max(worst, std::abs(double{exact.linear[i]} - double{reference.linear[i]}));
    return worst;
}

/// Checks that each instruction set, some sizes of tiles and numbers of threads draw this picture.
inline void check_sets_and_tiles(const Picture& first, const Scene& scene, const Settings& settings, int width, int height) {
    for (const Isa isa : available_isas()) {
        Execution execution;
        execution.isa = isa;
        INFO(isa_name(isa));
        CHECK(draw(scene, settings, width, height, execution) == first);
    }
    for (const int tile : {16, 32, 64}) {
        Execution execution;
        execution.tile_size = tile, execution.threads = tile == 32 ? 3 : 1;
        CHECK(draw(scene, settings, width, height, execution) == first);
    }
}

/// A quad across the picture at depth z, whose normal is turned from +z about y by `tilt`, while its corners are not.
inline void add_pane(Scene& scene, const Material& material, float z, double tilt, float left = -2, float right = 2) {
    Mesh mesh;
    mesh.positions = {{left, -2, z}, {right, -2, z}, {right, 2, z}, {left, 2, z}};
    mesh.normals.assign(4, {static_cast<float>(std::sin(tilt)), 0, static_cast<float>(std::cos(tilt))});
    mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
}

inline Material glass(float share) {
    Material material;
    material.metallic = 0, material.roughness = 0.1f;
    material.transmission = share;
    return material;
}

inline Material panel(Vec4f color) {
    Material material;
    material.unlit = true;
    material.base_color = color;
    return material;
}

/// The pixel in the middle.
inline std::array<double, 4> middle(const Picture& picture, int width, int height) {
    const float* at = &picture.linear[static_cast<std::size_t>(4 * ((height / 2) * width + width / 2))];
    return {double{at[0]}, double{at[1]}, double{at[2]}, double{at[3]}};
}

}  // namespace halflit::test
