// Cost of a next frame, for whole frames of one renderer: after forget_frames(), with nothing changed, one object moved, the camera moved,
// and a light changed. Then the cost of an error budget of half a code: exact and budget in turn, planning included. The shortest frame
// counts.
//
//     halflit_next_frame_bench [FRAMES [THREADS]]      9 frames, all threads
#include "halflit/camera.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/built_in/hall_of_lamps.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

void light(Scene& scene) {
    Light key, rim;
    key.direction_ws = normalize_or({-1, -1, -1}, {0, -1, 0});
    key.color_linear = {0.9f, 0.9f, 0.9f};
    rim.direction_ws = normalize_or({2, -1, -1}, {0, -1, 0});
    rim.color_linear = {0.1f, 0.15f, 0.25f};
    scene.lights = {key, rim};
    Material clay;
    clay.metallic = 0.0f;
    clay.roughness = 0.6f;
    clay.lobe = Lobe::sloan(0.5f);
    scene.materials.push_back(clay);
    for (Mesh& mesh : scene.meshes) mesh.material = 0;
}

Scene sphere(std::int64_t triangles) {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1.0f, triangles));
    scene.instances.push_back({0, {}});
    light(scene);
    return scene;
}

Scene thousand_objects() {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(0.4f, 2000));
    for (int i = 0; i < 1000; ++i)
        scene.instances.push_back(
            {0, translation({static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)})});
    light(scene);
    return scene;
}

struct Subject {
    std::string name;
    Scene scene;
};

/// Times of the shortest frame, ms. ready: update, plan and view geometry, which is all except shadow maps and tiles.
struct Cost {
    double update = 1e30, ready = 0, maps = 0, tiles = 0, whole = 1e30;
};

class Frames {
public:
    Frames(const Subject& subject, int threads)
        : name_(subject.name), scene_(subject.scene), execution_{.threads = threads}, rgba8_(std::size_t{4} * kWidth * kHeight) {
        auto prepared = PreparedScene::make(scene_);
        if (!prepared) std::exit(1);
        prepared_.push_back(*std::move(prepared));
        camera_ =
            scene_.cameras.empty() ? frame_bounds(prepared_[0].bounds(), static_cast<float>(kWidth) / kHeight, {}) : scene_.cameras[0];
    }

    RenderReport draw(const Settings& settings) {
        auto report = renderer_.render(prepared_[0], camera_, settings, {kWidth, kHeight, rgba8_.data(), nullptr}, execution_);
        if (!report) {
            std::fprintf(stderr, "%s: %s\n", name_.c_str(), report.error().message.c_str());
            std::exit(1);
        }
        return *std::move(report);
    }

    Cost measure(const Settings& settings, int frames, const std::function<void()>& change) {
        Cost best;
        for (int i = 0; i < frames; ++i) {
            const auto start = Clock::now();
            change();
            const double update = ms_since(start);
            const RenderReport report = draw(settings);
            const double whole = ms_since(start);
            if (whole > best.whole) continue;
            const auto& ms = report.ms;
            best = {update, update + ms.plan + ms.cull + ms.transform + ms.bin, ms.shadows, ms.tiles, whole};
        }
        return best;
    }

    void forget() { renderer_.forget_frames(); }
    void move_object() {
        Instance& instance = scene_.instances[scene_.instances.size() / 2];
        instance.world_from_object = translation({0, 0.01f, 0}) * instance.world_from_object;
        told({.changed_instances = {scene_.instances.size() / 2}});
    }
    void move_camera() { camera_.world_from_camera = translation({0.001f, 0, 0}) * camera_.world_from_camera; }
    void change_light() {
        scene_.lights[0].color_linear.x *= 0.999f;
        told({.lights = true});
    }

private:
    void told(const SceneChanges& changes) {
        if (!prepared_[0].update(changes)) std::exit(1);
    }
    std::string name_;
    Scene scene_;
    Execution execution_;
    std::vector<PreparedScene> prepared_;  // one element
    Camera camera_;
    Renderer renderer_;
    std::vector<std::uint8_t> rgba8_;
};

void next_frames(const Subject& subject, int frames, int threads) {
    for (const int samples : {1, 4}) {
        Settings settings;
        settings.samples = samples;
        Frames scene(subject, threads);
        (void)scene.draw(settings);
        const auto row = [&](const char* what, const std::function<void()>& change) {
            const Cost cost = scene.measure(settings, frames, change);
            std::printf("| %s | %d | %s | %.3f | %.3f | %.1f | %.1f | %.1f |\n", subject.name.c_str(), samples, what, cost.update,
                        cost.ready, cost.maps, cost.tiles, cost.whole);
        };
        row("after forget_frames()", [&] { scene.forget(); });
        row("nothing changed", [] {});
        row("one object moved", [&] { scene.move_object(); });
        row("camera moved", [&] { scene.move_camera(); });
        row("a light changed", [&] { scene.change_light(); });
    }
}

void budget_by_turns(const Subject& subject, int frames, int threads) {
    const Settings exact;
    Settings budget = exact;
    budget.shading.max_error_codes = 0.5;
    Frames one(subject, threads), other(subject, threads);
    Cost best[2];
    for (int i = 0; i < frames; ++i) {
        for (int turn = 0; turn < 2; ++turn) {
            const bool first = (turn + i) % 2 == 0;
            Frames& scene = first ? one : other;
            const Cost cost = scene.measure(first ? exact : budget, 1, [&] { scene.forget(); });
            if (i > 0 && cost.whole < best[first ? 0 : 1].whole) best[first ? 0 : 1] = cost;
        }
    }
    std::printf("| %s | %.1f | %.1f | %.3f | %.3f | %.3f |\n", subject.name.c_str(), best[0].whole, best[1].whole,
                best[1].whole / best[0].whole, best[0].ready, best[1].ready);
}

}  // namespace

int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 9, threads = argc > 2 ? std::atoi(argv[2]) : 0;
    if (frames < 1 || threads < 0) {
        std::fprintf(stderr, "usage: halflit_next_frame_bench [FRAMES [THREADS]]\n");
        return 2;
    }
    const Subject subjects[] = {{"demo", demo_scene()},
                                {"1,000 objects", thousand_objects()},
                                {"sphere of 1 M", sphere(1'000'000)},
                                {"sphere of 4 M", sphere(4'000'000)},
                                {"64 lights", lights_scene(64, true)}};
    std::printf("%d x %d, ms, the shortest of %d frames\n\n", kWidth, kHeight, frames);
    std::printf("| scene | samples | change | update | ready to draw | maps | tiles | whole |\n|---|---:|---|---:|---:|---:|---:|---:|\n");
    for (const Subject& subject : subjects) next_frames(subject, frames, threads);
    std::printf(
        "\n| scene | exact | within half a code | ratio | ready to draw: exact | within half a code |\n|---|---:|---:|---:|---:|---:|\n");
    for (const Subject& subject : subjects) budget_by_turns(subject, frames, threads);
    return 0;
}
