#include "apps/engine/look/part_views.hpp"
#include "sh/vec3d.hpp"
#include "tests/look/ray_view.hpp"
#include "tests/look/scene_job.hpp"
#include "tests/support/random.hpp"
#include "tests/support/solids.hpp"

#include <algorithm>
#include <array>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

/// Bodies of random kinds, each of which is a part, that do not touch: depths are told apart.
Scene scene_of_parts(std::uint64_t seed, int parts) {
    Random random(seed);
    Scene scene;
    for (int i = 0; i < parts; ++i) {
        scene.meshes.push_back(random_solid(random));
        Instance instance;
        instance.mesh = i;
        instance.world_from_object =
            translation({3.5f * static_cast<float>(i % 3), random.real32(-1, 1), 3.5f * static_cast<float>(i / 3)}) *
            rotation(Vec3f{1, random.real32(-1, 1), 0.3f}, random.real32(0, 6));
        scene.instances.push_back(instance);
    }
    return scene;
}

std::vector<ViewContent> contents_of(RenderJob& job, std::vector<ViewShot>& shots, std::size_t most_alone = 24) {
    Renderer renderer;
    for (const auto& [azimuth, elevation] : {std::pair(0.0f, 0.0f), {35.0f, 20.0f}, {90.0f, 0.0f}}) {
        auto shot = draw_shot(job, renderer, "view", parallel_view(job, azimuth, elevation), {.picture = false});
        REQUIRE(shot);
        shots.push_back(std::move(*shot));
    }
    auto contents = count_parts(job, renderer, shots, most_alone);
    REQUIRE(contents);
    return std::move(*contents);
}

}  // namespace

TEST_CASE("parts: pixels, boxes and pixels alone are those of rays", "[look]") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const int parts = static_cast<int>(2 + seed % 5);
        RenderJob job = scene_job(scene_of_parts(seed, parts), 160, 128);
        std::vector<ViewShot> shots;
        const std::vector<ViewContent> contents = contents_of(job, shots);
        const std::vector<RayTriangle> triangles = ray_triangles(job.scene());
        for (std::size_t v = 0; v < shots.size(); ++v) {
            const auto counts = count_by_rays(triangles, shots[v].camera, 160, 128, kFirstOfFour);
            std::size_t first = 0;
            for (std::size_t part = 0; part < static_cast<std::size_t>(parts); ++part) {
                const std::size_t last = first + job.scene().meshes[part].indices.size() / 3;
                const PartInView& seen = contents[v].parts[part];
                std::int64_t sure = 0, possible = 0;
                for (std::size_t i = first; i < last; ++i) sure += counts[i].sure, possible += counts[i].possible;
                INFO("seed " << seed << " view " << v << " part " << part);
                CHECK(seen.pixels >= sure);
                CHECK(seen.pixels <= possible);
                // Alone: the part's triangles without others.
                const std::vector<RayTriangle> own(triangles.begin() + static_cast<std::ptrdiff_t>(first),
                                                   triangles.begin() + static_cast<std::ptrdiff_t>(last));
                std::int64_t sure_alone = 0, possible_alone = 0;
                for (const RayCount& one : count_by_rays(own, shots[v].camera, 160, 128, kFirstOfFour))
                    sure_alone += one.sure, possible_alone += one.possible;
                REQUIRE(seen.alone);
                CHECK(*seen.alone >= sure_alone);
                CHECK(*seen.alone <= possible_alone);
                CHECK(*seen.alone >= seen.pixels);
                // The box and the planes: every pixel of the part lies within, and its four sides have one.
                PixelBox box;
                std::size_t at = 0;
                for (int y = 0; y < 128; ++y)
                    for (int x = 0; x < 160; ++x, ++at)
                        if (shots[v].instance[at] == part + 1) box.add(x, y);
                CHECK((box.x0 == seen.box.x0 && box.x1 == seen.box.x1 && box.y0 == seen.box.y0 && box.y1 == seen.box.y1));
                first = last;
            }
        }
    }
}

TEST_CASE("parts: the wall before a body is what hides it", "[look]") {
    Scene scene;
    scene.meshes = {ball_mesh(0.5, 2), box_mesh({-1, -1, 0}, {1, 1, 0.1}), box_mesh({-0.1, -3, 2}, {0.1, 3, 2.1})};
    for (int i = 0; i < 3; ++i) scene.instances.push_back({.mesh = i});
    scene.instances[0].world_from_object = translation({0, 0, -2});
    RenderJob job = scene_job(std::move(scene), 160, 128);
    std::vector<ViewShot> shots;
    const auto contents = contents_of(job, shots);
    const PartInView& ball = contents[0].parts[0];  // seen from +z
    CHECK(ball.pixels == 0);
    REQUIRE(ball.alone);
    CHECK(*ball.alone > 100);
    CHECK(ball.hidden_by == 1);
    // The rod hides a strip of the ball before the wall does.
    CHECK(ball.hidden_pixels < *ball.alone);
    CHECK(ball.hidden_pixels > *ball.alone / 2);
    CHECK(contents[2].parts[0].pixels > 0);  // from the side it is free
    CHECK(contents[2].parts[0].pixels == *contents[2].parts[0].alone);
    for (const Instance& instance : job.scene().instances) CHECK(instance.visible);
}

TEST_CASE("parts: a transparent part counts no pixel, and hides nothing", "[look]") {
    Scene scene;
    scene.meshes = {ball_mesh(0.5, 2), box_mesh({-1, -1, 1}, {1, 1, 1.1})};
    scene.materials.resize(1);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    scene.meshes[1].material = 0;
    for (int i = 0; i < 2; ++i) scene.instances.push_back({.mesh = i});
    RenderJob job = scene_job(std::move(scene), 160, 128);
    std::vector<ViewShot> shots;
    const auto contents = contents_of(job, shots);
    CHECK(contents[0].parts[1].pixels == 0);
    CHECK(contents[0].parts[0].pixels > 100);
    CHECK(contents[0].parts[0].pixels == *contents[0].parts[0].alone);
    CHECK(contents[0].parts[0].hidden_by == -1);
}

TEST_CASE("parts: more parts than are drawn alone have their pixels, and no others", "[look]") {
    RenderJob job = scene_job(scene_of_parts(3, 7), 160, 128);
    std::vector<ViewShot> shots;
    const auto contents = contents_of(job, shots, 6);
    std::int64_t pixels = 0;
    for (const PartInView& part : contents[1].parts) {
        CHECK_FALSE(part.alone);
        CHECK(part.hidden_by == -1);
        pixels += part.pixels;
    }
    CHECK(pixels == contents[1].pixels);
    CHECK(pixels > 0);
}
