// Pictures of a model and of its twin.
#pragma once

#include "halflit/auto_setup.hpp"
#include "halflit/image.hpp"
#include "halflit/renderer.hpp"

#include "tests/io/gltf_builder.hpp"

#include <cstdlib>

namespace halflit::test {

struct PictureDifference {
    std::size_t drawn = 0;      ///< pixels that show the model
    std::size_t above_one = 0;  ///< pixels that differ by more than one code
};

/// Draws both by the first one's view, lights and materials, 160 x 120 pixels.
inline PictureDifference compare_pictures(Scene a, const Scene& twin) {
    constexpr int kWidth = 160, kHeight = 120;
    const auto setup = auto_setup(a, kWidth, kHeight);
    Scene b = a;
    b.meshes = twin.meshes;
    b.instances = twin.instances;
    const auto draw = [&](const Scene& scene) {
        std::vector<std::uint8_t> rgba(std::size_t{4} * kWidth * kHeight);
        const auto report = render(scene, setup.light, setup.camera, setup.settings, {kWidth, kHeight, rgba.data()});
        if (!report) FAIL(report.error().message);
        return rgba;
    };
    const std::vector<std::uint8_t> first = draw(a), second = draw(b);
    PictureDifference out;
    for (std::size_t i = 0; i < first.size(); i += 4) {
        bool above = false, model = false;
        for (std::size_t c = 0; c < 4; ++c) {
            above = above || std::abs(int{first[i + c]} - int{second[i + c]}) > 1;
            model = model || first[i + c] != first[c];
        }
        out.above_one += above;
        out.drawn += model;
    }
    return out;
}

}  // namespace halflit::test
