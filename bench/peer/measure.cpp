#include "bench/peer/measure.hpp"

#include "bench/peer/gl_target.hpp"
#include "halflit/image.hpp"
#include "tests/peer/mesa_context.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace halflit::peer {
namespace {

float aspect_of(const Limits& limits) { return static_cast<float>(limits.width) / static_cast<float>(limits.height); }

/// llvmpipe with a scene and a target.
struct Peer {
    std::unique_ptr<MesaContext> context;
    GlScene scene;
    GlTarget target;

    bool make(const BenchScene& bench, const Subject& subject, const Limits& limits, std::string& reason) {
        context = MesaContext::create(reason);
        if (context == nullptr || !GlScene::make(bench, {subject.storage, subject.shader}, scene, reason)) return false;
        scene.look(bench.camera, aspect_of(limits));
        return GlTarget::make(limits.width, limits.height, subject.samples, target, reason);
    }
    void draw(const Subject& subject) const {
        target.begin();
        scene.draw(subject.depth_first);
        target.resolve();
        wait_until_drawn();
    }
};

/// halflit with a scene and a picture.
struct Ours {
    std::unique_ptr<PreparedScene> prepared;
    Renderer renderer;
    std::vector<std::uint8_t> rgba8;

    bool make(const BenchScene& bench, const Subject& subject, const Limits& limits, std::string& reason) {
        rgba8.resize(static_cast<std::size_t>(limits.width) * static_cast<std::size_t>(limits.height) * 4);
        auto made = PreparedScene::make(bench.scene, {.threads = subject.threads});
        if (!made) return reason = made.error().message, false;
        prepared = std::make_unique<PreparedScene>(std::move(*made));
        return true;
    }
    /// A whole frame, as if everything had moved.
    bool draw(const BenchScene& bench, const Subject& subject, const Limits& limits, std::optional<Isa> isa, std::string& reason) {
        renderer.forget_frames();
        Execution execution{.threads = subject.threads};
        execution.isa = isa;
        const auto report = renderer.render(*prepared, bench.camera, bench_settings(subject.samples),
                                            {limits.width, limits.height, rgba8.data()}, execution);
        if (!report) reason = report.error().message;
        return report.has_value();
    }
};

void state(const std::string& reason, char (&text)[200]) { std::snprintf(text, sizeof text, "%s", reason.c_str()); }

}  // namespace

Limits limits_for(std::string_view scene, Limits limits) {
    if (limits.width == 0) limits.width = is_dataset(scene) ? 256 : 1920, limits.height = is_dataset(scene) ? 256 : 1080;
    return limits;
}

void TurnTimes::add(double peer_ms, double readback_ms, const double (&halflit_ms)[kMostIsas]) {
    peer_ms_.push_back(peer_ms);
    readback_ms_.push_back(readback_ms);
    for (std::size_t i = 0; i < measured_isas().size(); ++i) {
        halflit_ms_[i].push_back(halflit_ms[i]);
        ratio_[i].push_back(peer_ms / halflit_ms[i]);
    }
}

void TurnTimes::write_to(Turns& turns) const {
    turns.rounds = static_cast<int>(peer_ms_.size());
    turns.peer_ms = spread_of(peer_ms_);
    turns.readback_ms = spread_of(readback_ms_);
    for (std::size_t i = 0; i < kMostIsas; ++i) {
        turns.halflit_ms[i] = spread_of(halflit_ms_[i]);
        turns.ratio[i] = spread_of(ratio_[i]);
    }
}

Result<void> write_pictures(const Subject& subject, const Limits& limits, const std::vector<std::uint8_t>& peer,
                            const std::vector<std::uint8_t>& ours) {
    if (subject.pictures.empty()) return {};
    std::filesystem::create_directories(subject.pictures);
    const std::string stem = subject.pictures + "/" + subject.scene + "-" + std::to_string(subject.samples);
    const auto written = write_image(stem + "-llvmpipe.png", {limits.width, limits.height, peer, {}});
    return written ? write_image(stem + "-halflit.png", {limits.width, limits.height, ours, {}}) : written;
}

std::vector<Isa> measured_isas() {
    std::vector<Isa> isas;
    for (const Isa isa : built_isas())
        if (isa_available(isa)) isas.push_back(isa);
    const Isa widest = isas.back();
    const bool avx2 = std::find(isas.begin(), isas.end(), Isa::avx2) != isas.end();
    if (avx2 && widest != Isa::avx2) return {Isa::avx2, widest};
    return {widest};
}

Turns measure_turns(const Subject& subject, const Limits& limits) {
    Turns turns;
    std::string reason;
    const BenchScene bench = make_bench_scene(subject.scene, aspect_of(limits));
    Peer peer;
    Ours ours;
    if (!peer.make(bench, subject, limits, reason) || !ours.make(bench, subject, limits, reason)) return state(reason, turns.reason), turns;
    const std::vector<Isa> isas = measured_isas();
    TurnTimes times;
    std::vector<std::uint8_t> picture;
    Stopwatch all(Clock::wall);
    double spent_ms = 0;
    for (int round = -1; round < limits.rounds && (round < 3 || spent_ms < 1000 * limits.seconds); ++round) {
        Stopwatch watch(limits.clock);
        peer.draw(subject);
        const double drawn_ms = watch.lap();
        peer.target.read(picture);
        const double read_ms = watch.lap();
        double own_ms[kMostIsas]{};
        for (std::size_t i = 0; i < isas.size(); ++i) {
            watch.lap();
            if (!ours.draw(bench, subject, limits, isas[i], reason)) return state(reason, turns.reason), turns;
            own_ms[i] = watch.lap();
        }
        spent_ms += all.lap();
        if (round < 0) continue;  // the first frame compiles shaders and takes memory
        times.add(drawn_ms, read_ms, own_ms);
    }
    times.write_to(turns);
    turns.pictures.add(picture, ours.rgba8);
    if (const auto written = write_pictures(subject, limits, picture, ours.rgba8); !written) state(written.error().message, turns.reason);
    return turns;
}

FirstFrame measure_first_of_peer(const Subject& subject, const Limits& limits) {
    FirstFrame first;
    std::string reason;
    const BenchScene bench = make_bench_scene(subject.scene, aspect_of(limits));
    std::vector<std::uint8_t> picture;
    reset_peak_memory();
    const double before_mb = resident_mb();
    Stopwatch watch(limits.clock);
    Peer peer;
    if (!peer.make(bench, subject, limits, reason)) return state(reason, first.reason), first;
    peer.draw(subject);
    peer.target.read(picture);
    first.ms = watch.lap();
    first.memory_mb = peak_mb() - before_mb;
    return first;
}

FirstFrame measure_first_of_halflit(const Subject& subject, const Limits& limits) {
    FirstFrame first;
    std::string reason;
    const BenchScene bench = make_bench_scene(subject.scene, aspect_of(limits));
    reset_peak_memory();
    const double before_mb = resident_mb();
    Stopwatch watch(limits.clock);
    Ours ours;
    if (!ours.make(bench, subject, limits, reason) || !ours.draw(bench, subject, limits, std::nullopt, reason))
        return state(reason, first.reason), first;
    first.ms = watch.lap();
    first.memory_mb = peak_mb() - before_mb;
    return first;
}

}  // namespace halflit::peer
