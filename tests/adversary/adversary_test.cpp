// A search for scenes that break the promise of an error budget, and the scenes that broke it before.
#include "halflit/gltf.hpp"
#include "tests/adversary/faults.hpp"
#include "tests/adversary/report.hpp"
#include "tests/adversary/search.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>

using namespace halflit;
using namespace halflit::adversary;

namespace {

std::string out_folder() {
    const std::string folder = HALFLIT_ADVERSARY_FOLDER;
    std::filesystem::create_directories(folder);
    return folder;
}

double number_from_environment(const char* name, double usual) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtod(text, nullptr) : usual;
}

/// Searches without what open faults need. Writes each scene that was found.
void check_search(SearchOptions options) {
    options.avoid = avoided();
    Judge judge;
    const SearchResult result = search(options, [&](const Found& found) {
        const Genome small = shrunk(judge, found.genome, options.avoid, 1.0, 400);
        const std::string name = "seed" + std::to_string(options.seed) + "_scene" + std::to_string(found.scene);
        FAIL_CHECK("broken promise: " << text_of(judge.judge(small, options.avoid)) << "\n  halflit_adversary --avoid " << options.avoid
                                      << " --genome " << text_of(small) << "\n"
                                      << written(make_trial(small, options.avoid), out_folder(), name));
    });
    WARN("seed " << options.seed << ": " << text_of(result));
    CHECK(result.drawn > result.scenes / 4);
}

}  // namespace

TEST_CASE("promise: 300 scenes, random ones and those that climbs lead to, keep to the bound on their error", "[adversary]") {
    SearchOptions options;
    options.scenes = 300;
    check_search(options);
}

// HALFLIT_ADVERSARY_SECONDS and HALFLIT_ADVERSARY_SEED; `./dev adversary` runs the same search in several processes.
TEST_CASE("promise: minutes of random scenes and climbs keep to the bound on their error", "[adversary][deep]") {
    SearchOptions options;
    options.seconds = number_from_environment("HALFLIT_ADVERSARY_SECONDS", 600);
    options.seed = static_cast<std::uint64_t>(number_from_environment("HALFLIT_ADVERSARY_SEED", 2));
    check_search(options);
}

TEST_CASE("promise: at most one of twenty shares that are claimed of random scenes is wrong", "[adversary]") {
    Judge judge(Promise::share);
    int claims = 0, wrong = 0;
    double furthest = 0;
    for (std::uint64_t i = 0; i < 60; ++i) {
        const Verdict verdict = judge.judge(random_genome(11, i), avoided());
        claims += verdict.promised() ? 1 : 0;
        wrong += verdict.broken() ? 1 : 0;
        furthest = std::max(furthest, verdict.claimed - verdict.held);
    }
    WARN(claims << " claims, " << wrong << " wrong, the share at most " << furthest << " % below the claim");
    CHECK(claims > 20);
    CHECK(20 * wrong <= claims);
    CHECK(furthest < 1.0);
}

TEST_CASE("promise: scenes of cured faults keep it, and those of open faults are known to break it", "[adversary]") {
    Judge judge;
    int open = 0;
    for (const KnownFault& fault : known_faults()) {
        Genome genome;
        REQUIRE(read_genome(fault.genome, genome));
        const Verdict verdict = judge.judge(genome, 0);
        INFO(fault.what << "\n"
                        << text_of(verdict)
                        << (fault.open && !verdict.broken() ? "\nIt is cured: set `open` to false in faults.cpp." : ""));
        CHECK(verdict.refused.empty());
        CHECK(verdict.broken() == fault.open);
        open += fault.open ? 1 : 0;
        if (fault.open) WARN("expected failure: " << fault.what << ": ratio " << verdict.ratio << " (" << verdict.measured << " codes)");
    }
    WARN(open << " of " << known_faults().size() << " known faults are open");
}

TEST_CASE("promise: a genome's text gives the genome back", "[adversary]") {
    for (std::uint64_t i = 0; i < 20; ++i) {
        const Genome genome = random_genome(1, i);
        Genome again;
        REQUIRE(read_genome(text_of(genome), again));
        CHECK(again == genome);
    }
    Genome genome;
    CHECK(read_genome("", genome));
    const std::string kPast = std::to_string(kGenes) + ":1";
    for (const char* wrong : {"1", "1:", ":1", "1:2,", kPast.c_str(), "1:16777216", "1:2;3:4", "x"})
        CHECK_FALSE(read_genome(wrong, genome));
}

TEST_CASE("promise: a scene read from the file that the search writes has the error of the scene", "[adversary]") {
    Judge judge;
    int compared = 0;
    for (std::uint64_t i = 0; i < 32; ++i) {
        Trial trial = make_trial(random_genome(7, i), ~AvoidSet{0});
        if (trial.scene.environment != nullptr) continue;
        const std::string flags = written(trial, out_folder(), "read_again");
        INFO(flags);
        if (flags.find('#') != std::string::npos) continue;  // not all of it is in the file
        auto loaded = load_gltf(out_folder() + "/read_again.glb");
        if (!loaded) FAIL(loaded.error().message);
        const Verdict before = judge.judge(trial);
        trial.scene.meshes = loaded->scene.meshes;
        trial.scene.instances = loaded->scene.instances;
        trial.scene.materials = loaded->scene.materials;
        trial.scene.textures = loaded->scene.textures;
        trial.scene.lights = loaded->scene.lights;
        trial.camera = loaded->scene.cameras.at(0);
        const Verdict after = judge.judge(trial);
        INFO(text_of(before) << "\n" << text_of(after));
        CHECK(after.bound.codes == Approx(before.bound.codes).epsilon(0.05));
        ++compared;
    }
    CHECK(compared >= 4);
}
