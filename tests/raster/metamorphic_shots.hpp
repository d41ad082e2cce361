// Random scenes of all kinds, and ways to draw them that must not show.
#pragma once

#include "tests/raster/metamorphic_scene.hpp"
#include "tests/raster/random_trial.hpp"
#include "tests/support/catch.hpp"

namespace halflit::raster::test {

/// Bodies apart from each other, shapes with skies and many lights, or heaps of triangles of all sizes, some of them thin, inside each
/// other.
inline Shot any_shot(std::uint64_t seed) {
    if (seed % 3 == 0) return separate_bodies(seed);
    if (seed % 3 == 1) {
        Trial trial = random_trial(static_cast<std::uint32_t>(seed));
        return {std::move(trial.scene), trial.camera, trial.settings};
    }
    Random random(seed);
    Shot shot;
    for (int i = 0; i < 3; ++i) shot.scene.materials.push_back(random_material(random));
    for (Material& material : shot.scene.materials) {
        material.textures[TextureSlot::base_color] = material.textures[TextureSlot::normal] = {};
        material.double_sided = random.chance(0.5);
        if (random.chance(0.2)) material.alpha_mode = AlphaMode::blend, material.base_color.w = 0.5f;
    }
    for (int i = 0; i < 3; ++i) {
        Mesh mesh = random_mesh(random, 2000);
        generate_flat_normals(mesh);
        mesh.material = i;
        shot.scene.meshes.push_back(mesh);
    }
    for (int i = 0; i < 6; ++i) shot.scene.instances.push_back({random.index(3), random_place(random, 2)});
    for (int i = 0; i < 3; ++i) shot.scene.lights.push_back(random_light(random));
    shot.camera = random_camera(random);
    shot.settings = random_settings(random);
    return shot;
}

inline Execution execution_of(int threads, int tile, Isa isa) {
    Execution execution;
    execution.threads = threads;
    execution.tile_size = tile;
    execution.isa = isa;
    return execution;
}

/// Some regions of the shot, by several numbers of threads and sizes of tiles, are the same parts of the whole picture.
inline void check_regions(std::uint64_t seed, Shot shot) {
    Random random(seed);
    const Pixels whole = draw(shot);
    for (int i = 0; i < 4; ++i) {
        const Region region = random_region(random, kViewWidth, kViewHeight);
        shot.settings.region = region;
        const Pixels part = draw(shot, execution_of(1 + i % 2, 16 << random.index(3), *halflit::default_isa()));
        Pixels expected;  // whose pixels outside are untouched
        for (int y = region.y; y < region.y + region.height; ++y)
            for (int x = region.x; x < region.x + region.width; ++x) {
                const auto at = static_cast<std::size_t>(y * kViewWidth + x);
                std::copy_n(&whole.rgba8[4 * at], 4, &expected.rgba8[4 * at]);
                std::copy_n(&whole.linear[4 * at], 4, &expected.linear[4 * at]);
                expected.depth[at] = whole.depth[at];
            }
        INFO("seed " << seed << ", region " << region.x << "," << region.y << "," << region.width << "," << region.height);
        CHECK(differing(expected, part) == 0);
    }
}

}  // namespace halflit::raster::test
