#include "apps/halflit/golden/self_test.hpp"

#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/isa.hpp"
#include "halflit/target.hpp"
#include "halflit/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <thread>

namespace halflit::cli {
namespace {

constexpr SelfTestScene kSelfTestScenes[] = {
#define HALFLIT_SELF_TEST(name, scene, flags, expected) {name, scene, flags, expected},
#include "apps/halflit/golden/self_test_scenes.def"
#undef HALFLIT_SELF_TEST
};

#if defined(__clang__)
constexpr const char* kCompiler = __VERSION__;  // "Clang 14.0.6"
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

std::vector<Isa> isas_of_machine() {
    std::vector<Isa> isas;
    std::copy_if(built_isas().begin(), built_isas().end(), std::back_inserter(isas), isa_available);
    return isas;
}

/// The build and the machine, which a report of a fault needs.
std::string self_test_head(const std::vector<Isa>& isas) {
    std::vector<std::string> names;
    for (const Isa isa : isas) names.emplace_back(isa_name(isa));
    const auto chosen = default_isa();
    const std::string processor = platform::processor_name();
    return fmt::format(
        "halflit {}\npixel epoch: {}\nprocessor: {}\ninstruction sets: {}; in use: {}\ncompiler: {}\nsystem: {}\n"
        "threads: {}\n",
        version(), pixel_epoch(), processor.empty() ? "unknown" : processor, joined(names, ", "),
        chosen ? std::string(isa_name(*chosen)) : "none, " + chosen.error().message, kCompiler, platform::system_name(),
        std::max(1u, std::thread::hardware_concurrency()));
}

/// "ok", or what is wrong with the first instruction set that gives another picture.
Result<std::string> self_test_outcome(const SelfTestScene& scene, const std::vector<Isa>& isas) {
    auto options = parse_render_flags(words_of(scene.flags, ' '));
    if (!options) return tl::unexpected(options.error());
    options->scene = scene.scene;
    auto job = make_render_job(*options);
    if (!job) return tl::unexpected(job.error());
    for (const Isa isa : isas) {
        job->execution.isa = isa;
        Image image = make_image(*job, false);
        const auto drawn =
            Renderer().render(*job->prepared, job->light, job->camera, job->settings, target_of(*job, image), job->execution);
        if (!drawn) return tl::unexpected(drawn.error());
        if (const std::uint64_t found = pixel_hash(image.rgba8); found != scene.expected)
            return fmt::format("DIFFERENT expected {} found {} by {}", hash_text(scene.expected), hash_text(found), isa_name(isa));
    }
    return "ok";
}

}  // namespace

std::span<const SelfTestScene> self_test_scenes() { return kSelfTestScenes; }

SelfTest run_self_test(std::span<const SelfTestScene> scenes) {
    const std::vector<Isa> isas = isas_of_machine();
    SelfTest test{self_test_head(isas)};
    for (const SelfTestScene& scene : scenes) {
        const auto outcome = self_test_outcome(scene, isas);
        const std::string text = outcome ? *outcome : "FAILED " + outcome.error().message;
        test.passed &= text == "ok";
        test.text += fmt::format("{:<12} {}\n", scene.name, text);
    }
    return test;
}

}  // namespace halflit::cli
