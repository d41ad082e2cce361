// Every allocation of loading, drawing and encoding fails in turn, inside one process: the call says so, nothing leaks, and the Renderer
// draws on.
#include "halflit/auto_setup.hpp"
#include "halflit/gltf.hpp"
#include "halflit/image.hpp"
#include "halflit/renderer.hpp"
#include "tests/faults/allocation_counter.hpp"
#include "tests/io/rich_file.hpp"

#include "tests/support/catch.hpp"

#include <new>
#include <optional>

using namespace halflit;
using halflit::test::AllocationFault;

namespace {

constexpr int kSide = 32;

Image blank() { return {kSide, kSide, std::vector<std::uint8_t>(4 * kSide * kSide, 0xCD), {}}; }

Settings settings_of(ShadowMode shadows) {
    Settings settings = usual_settings();
    settings.shadows = shadows;
    settings.shadow_size = 64;
    return settings;
}

/// All calls from the bytes of a model to the bytes of a picture, and what is left of them after one failed.
struct Run {
    std::optional<Result<LoadedScene>> loaded;
    std::optional<PreparedScene> prepared;
    std::optional<Renderer> renderer;
    Camera camera;
    Image image = blank();
    std::vector<std::uint8_t> file;
    std::optional<ErrorCode> error;  ///< of the call that failed
    bool threw = false;              ///< std::bad_alloc left a call that has no Result
    bool threw_wrongly = false;      ///< an exception left a call that has one

    void all(const halflit::test::Bytes& model, const Settings& settings, int threads) {
        Execution execution;
        execution.threads = threads;
        if (!keep(loaded, [&] { return load_gltf_bytes(model, "model", ""); })) return;
        Scene& scene = (*loaded)->scene;
        try {
            AutoSetup setup = auto_setup(scene, kSide, kSide);
            camera = setup.camera;
            static_cast<Lighting&>(scene) = std::move(setup.light);
            renderer.emplace();
        } catch (const std::bad_alloc&) {
            threw = true;
            return;
        }
        std::optional<Result<PreparedScene>> made;
        if (!keep(made, [&] { return PreparedScene::make(scene, execution); })) return;
        prepared.emplace(std::move(**made));
        std::optional<Result<RenderReport>> report;
        const Target target{kSide, kSide, image.rgba8.data()};
        if (!keep(report, [&] { return renderer->render(*prepared, camera, settings, target, execution); })) return;
        std::optional<Result<std::vector<std::uint8_t>>> bytes;
        if (keep(bytes, [&] { return encode_image(image, OutputFormat::png); })) file = std::move(**bytes);
    }

private:
    /// Keeps the call's result; true if it is a value. Allocates nothing itself.
    template <class T, class Call>
    bool keep(std::optional<Result<T>>& result, const Call& call) {
        try {
            result.emplace(call());
        } catch (...) {
            threw_wrongly = true;
            return false;
        }
        if (!*result) error = result->error().code;
        return result->has_value();
    }
};

/// Fails each `stride`-th allocation.
void fail_each(int threads, ShadowMode shadows, long stride, bool all_later) {
    const halflit::test::Bytes model = halflit::test::rich_file();
    const Settings settings = settings_of(shadows);
    Image expected = blank();
    std::vector<std::uint8_t> expected_file;
    long count = 0;
    Run{}.all(model, settings, 0);             // makes what the process keeps
    for (int round = 0; round < 2; ++round) {  // so does the first one
        Run undisturbed;
        const AllocationFault none(0);
        undisturbed.all(model, settings, threads);
        count = AllocationFault::made();
        REQUIRE_FALSE((undisturbed.error || undisturbed.threw || undisturbed.threw_wrongly));
        expected.rgba8 = undisturbed.image.rgba8;
        expected_file = undisturbed.file;
    }
    REQUIRE(expected.rgba8 != blank().rgba8);
    REQUIRE(count > 100);

    long wrong_codes = 0, exceptions = 0, wrong_pixels = 0, leaks = 0, failed = 0, first_wrong = 0;
    for (long at = 1; at <= count; at += stride) {
        const long before = halflit::test::live_allocations();
        {
            Run run;
            {
                const AllocationFault fault(at, all_later);
                run.all(model, settings, threads);
            }
            const bool refused = run.error.has_value() || run.threw || run.threw_wrongly;
            failed += refused;
            exceptions += run.threw_wrongly;
            const bool right = refused ? !run.error || run.error == ErrorCode::limit : run.file == expected_file;
            wrong_codes += !right;
            if (first_wrong == 0 && (!right || run.threw_wrongly)) first_wrong = at;
            if (run.prepared && run.renderer) {  // the same Renderer again, with memory
                Image again = blank();
                const auto report = run.renderer->render(*run.prepared, run.camera, settings, {kSide, kSide, again.rgba8.data()});
                wrong_pixels += !report || again.rgba8 != expected.rgba8;
            }
        }
        leaks += halflit::test::live_allocations() != before;
    }
    INFO(count << " allocations, " << threads << " threads; first wrong one " << first_wrong);
    CHECK(wrong_codes == 0);
    CHECK(exceptions == 0);
    CHECK(wrong_pixels == 0);
    CHECK(leaks == 0);
    // A shrunk vector or a sort may do without the memory that it asks for.
    CHECK(failed > (count / stride) * 9 / 10);
}

}  // namespace

TEST_CASE("faults: a failed allocation is a limit, leaks nothing and leaves the Renderer usable", "[faults]") {
    fail_each(1, ShadowMode::off, 11, false);
    fail_each(1, ShadowMode::soft_split, 7, false);
}

TEST_CASE("faults: with two threads a failed allocation is a limit too", "[faults]") {
    fail_each(2, ShadowMode::off, 11, false);
    fail_each(2, ShadowMode::soft_split, 7, false);
}

TEST_CASE("faults: memory that ends for good is a limit, leaks nothing and leaves the Renderer usable", "[faults]") {
    fail_each(1, ShadowMode::soft_split, 7, true);
}

TEST_CASE("faults: each of all allocations that fails is a limit, leaks nothing and leaves the Renderer usable", "[faults][deep]") {
    for (const int threads : {1, 2})
        for (const ShadowMode shadows : {ShadowMode::off, ShadowMode::soft_split}) fail_each(threads, shadows, 1, false);
    fail_each(1, ShadowMode::soft_split, 1, true);
}
