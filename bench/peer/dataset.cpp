// A data set of one model: views from all sides in a row, each as planes in memory.
#include "bench/peer/gl_target.hpp"
#include "bench/peer/measure.hpp"
#include "tests/peer/mesa_context.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <span>

namespace halflit::peer {
namespace {

constexpr int kViewsOfTurn = 10;

/// Views on a spiral from the top to the bottom, each a golden angle on from the last: each stands for an equal part of the sphere.
std::vector<Camera> cameras_around(const Scene& scene, float aspect, int count) {
    constexpr double kGoldenAngleDeg = 137.50776405003785;  // 180 (3 - sqrt(5))
    std::vector<ViewSettings> views;
    for (int i = 0; i < count; ++i) {
        ViewSettings view;
        view.azimuth_deg = static_cast<float>(std::fmod(kGoldenAngleDeg * i, 360));
        view.elevation_deg = static_cast<float>(std::asin(1 - (2 * i + 1.0) / count) * (180 / std::numbers::pi));
        view.any_side = true;
        views.push_back(view);
    }
    return frame_each(scene, scene_bounds(scene), aspect, views);
}

/// llvmpipe. With one sample, colours and planes are drawn at once, into four attachments. With several, colours are drawn as in pictures,
/// and then the planes with one sample a pixel, at the place of the first of several. Planes that are drawn with all samples would cost
/// less for many small triangles and more for few, but their depths and weights would be those of the pixel's centre.
class Peer {
public:
    bool make(const BenchScene& bench, const Subject& subject, const Limits& limits, std::string& reason) {
        aspect_ = static_cast<float>(limits.width) / static_cast<float>(limits.height);
        apart_ = subject.samples > 1;
        context_ = MesaContext::create(reason);
        if (context_ == nullptr) return false;
        GlSceneOptions options{subject.storage, subject.shader, PeerOutputs::colour};
        if (apart_) {
            // The first sample of four lies 2/16 to the left of the centre and 6/16 above it. A picture is 2 wide and high.
            sample_ = {-0.25f / static_cast<float>(limits.width), -0.75f / static_cast<float>(limits.height)};
            if (!GlScene::make(bench, options, colours_, reason)) return false;
            if (!GlTarget::make(limits.width, limits.height, subject.samples, colour_target_, reason)) return false;
        }
        options.outputs = apart_ ? PeerOutputs::planes : PeerOutputs::both;
        return GlScene::make(bench, options, planes_, reason) &&
               GlPlanes::make(limits.width, limits.height, !apart_, planes_target_, reason);
    }
    void draw(const Camera& camera) const {
        if (apart_) {
            colour_target_.begin();
            colours_.look(camera, aspect_);
            colours_.draw(false);
            colour_target_.resolve();
        }
        planes_target_.begin();
        planes_.look(camera, aspect_, sample_);
        planes_.draw(false);
        wait_until_drawn();
    }
    void read(Planes& planes) const {
        if (apart_) colour_target_.read(planes.rgba8);
        planes_target_.read(planes);
    }

private:
    std::unique_ptr<MesaContext> context_;
    GlScene colours_, planes_;
    GlTarget colour_target_;
    GlPlanes planes_target_;
    bool apart_ = false;
    float aspect_ = 1;
    Vec2f sample_{};
};

}  // namespace

Turns measure_dataset(const Subject& subject, const Limits& limits) {
    Turns turns;
    std::string reason;
    const auto failed = [&] {
        std::snprintf(turns.reason, sizeof turns.reason, "%s", reason.c_str());
        return turns;
    };
    const float aspect = static_cast<float>(limits.width) / static_cast<float>(limits.height);
    const BenchScene bench = make_bench_scene(subject.scene, aspect);
    const std::vector<Camera> cameras = cameras_around(bench.scene, aspect, limits.views);
    Peer peer;
    if (!peer.make(bench, subject, limits, reason)) return failed();
    const auto prepared = PreparedScene::make(bench.scene, {.threads = subject.threads});
    if (!prepared) return reason = prepared.error().message, failed();
    Renderer renderer;
    Planes theirs = Planes::make(limits.width, limits.height), ours = theirs;
    const Target target = ours.target();
    const Settings settings = bench_settings(subject.samples);

    const std::vector<Isa> isas = measured_isas();
    TurnTimes times;
    for (int turn = -1; turn * kViewsOfTurn < limits.views; ++turn) {
        const int first = std::max(turn, 0) * kViewsOfTurn, count = std::min(kViewsOfTurn, limits.views - first);
        const std::span<const Camera> views = std::span(cameras).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
        double drawn_ms = 0, read_ms = 0, own_ms[kMostIsas]{};
        Stopwatch watch(limits.clock);
        for (const Camera& camera : views) {
            peer.draw(camera);
            drawn_ms += watch.lap() / count;
            peer.read(theirs);
            read_ms += watch.lap() / count;
        }
        for (std::size_t i = 0; i < isas.size(); ++i) {
            Execution execution{.threads = subject.threads};
            execution.isa = isas[i];
            watch.lap();
            for (const Camera& camera : views) {
                const auto report = renderer.render(*prepared, camera, settings, target, execution);
                if (!report) return reason = report.error().message, failed();
            }
            own_ms[i] = watch.lap() / count;
        }
        if (turn < 0) continue;  // the first frames compile shaders and take memory
        times.add(drawn_ms + read_ms, read_ms, own_ms);
        turns.pictures.add(theirs.rgba8, ours.rgba8);
        turns.planes.add(theirs, ours, bench.scene.meshes[0], views.back(), point_tolerance(subject.samples));
    }
    times.write_to(turns);
    if (const auto written = write_pictures(subject, limits, theirs.rgba8, ours.rgba8); !written)
        return reason = written.error().message, failed();
    return turns;
}

}  // namespace halflit::peer
