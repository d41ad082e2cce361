// Shards: parts of a run by processes of their own, killed and repeated, make what one process makes; merge finds what is missing or
// damaged.
#include "tests/cli/program.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

using namespace halflit::test;

namespace {

using Strings = std::vector<std::string>;
using Variables = std::vector<std::pair<std::string, std::string>>;

Outcome run_in(const TemporaryFolder& folder, Strings arguments, const Variables& environment = {}) {
    return run(arguments, {.environment = environment, .folder = folder.path()});
}

void run_well(const TemporaryFolder& folder, Strings arguments, const Variables& environment = {}) {
    const Outcome outcome = run_in(folder, std::move(arguments), environment);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
}

const Strings kTurn{"render", "sphere:200", "--turntable", "7", "--size", "32x24", "--samples", "1"};

Strings with(Strings words, const Strings& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_CASE("shards: frames by parts are those of one process, and merge makes the same film", "[cli][shard]") {
    const TemporaryFolder folder;
    run_well(folder, with(kTurn, {"-o", "whole/{:02}.png"}));
    run_well(folder, with(kTurn, {"-o", "whole.apng"}));
    // More shards than frames: the last ones have nothing to do.
    for (int i = 0; i < 9; ++i)
        run_well(folder, with(kTurn, {"-o", "parts/{:02}.png", "--report", "r.json", "--shard", fmt::format("{}/9", i)}));
    for (int i = 0; i < 7; ++i) {
        const std::string name = fmt::format("/{:02}.png", i);
        CHECK(contents(folder.file("whole" + name)) == contents(folder.file("parts" + name)));
    }
    Strings merge{"merge"};
    for (int i = 0; i < 9; ++i) merge.push_back(fmt::format("r.{}-of-9.json", i));
    run_well(folder, merge);
    run_well(folder, with(merge, {"-o", "parts.apng"}));
    CHECK(contents(folder.file("whole.apng")) == contents(folder.file("parts.apng")));

    SECTION("a shard that is missing is named") {
        const Outcome outcome = run_in(folder, {"merge", "r.0-of-9.json", "r.2-of-9.json", "r.6-of-9.json"});
        CHECK(outcome.code == 1);
        CHECK(contains(outcome.err, "missing: frames 1, 3, 4, 5; of shards 1, 3, 4, 5 of 9"));
    }
    SECTION("a damaged frame is named") {
        std::string file = contents(folder.file("parts/03.png"));
        file[file.size() / 2] ^= 1;
        write_contents(folder.file("parts/03.png"), file);
        const Outcome outcome = run_in(folder, merge);
        CHECK(outcome.code == 1);
        CHECK(contains(outcome.err, "parts/03.png: expected the file with the hash"));
    }
    SECTION("a frame that is not there is named") {
        std::filesystem::remove(folder.file("parts/05.png"));
        const Outcome outcome = run_in(folder, merge);
        CHECK(outcome.code == 1);
        CHECK(contains(outcome.err, "parts/05.png"));
    }
    SECTION("frames that are there can be left alone") {
        std::filesystem::remove(folder.file("parts/04.png"));
        write_contents(folder.file("parts/06.png"), "kept");
        run_well(folder, with(kTurn, {"-o", "parts/{:02}.png", "--report", "all.json", "--skip-existing"}));
        CHECK(contents(folder.file("whole/04.png")) == contents(folder.file("parts/04.png")));
        CHECK(contents(folder.file("parts/06.png")) == "kept");
        const Strings lines = lines_of(contents(folder.file("all.json")));
        REQUIRE(lines.size() == 7);
        for (std::size_t i = 0; i < 7; ++i) {
            const auto line = nlohmann::json::parse(lines[i]);
            CHECK(line["frame"] == i);
            CHECK(line["status"] == (i == 4 ? "ok" : "skipped"));
        }
    }
}

TEST_CASE("shards: bands of one picture join to the picture, in every lossless format", "[cli][shard]") {
    const TemporaryFolder folder;
    const std::string format = GENERATE("png", "bmp", "tga", "hdr", "pfm", "exr");
    const Strings picture{"render", "sphere:500", "--size", "50x37", "-o", "x." + format};
    const Outcome whole = run_in(folder, picture);
    if (format == "exr" && whole.code == 2) return;  // built without OpenEXR
    REQUIRE(whole.code == 0);
    for (int i = 0; i < 12; ++i) run_well(folder, with(picture, {"--shard", fmt::format("{}/12", i)}));
    Strings merge{"merge"};
    for (int i = 11; i >= 0; --i) merge.push_back(fmt::format("x.{:02}-of-12.json", i));
    run_well(folder, with(merge, {"-o", "joined." + format}));
    CHECK(contents(folder.file("x." + format)) == contents(folder.file("joined." + format)));
    merge.pop_back();  // part 0
    merge.erase(merge.begin() + 4);
    const Outcome outcome = run_in(folder, merge);
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.err, "missing: rows 0, 1, 2, 24, 25, 26; of shards 0, 8 of 12"));
}

TEST_CASE("shards: parts of a region join to the region", "[cli][shard]") {
    const TemporaryFolder folder;
    const Strings picture{"render", "demo", "--size", "64x48", "--region", "10,5,40,30", "--background", "transparent", "-o", "x.png"};
    run_well(folder, picture);
    for (int i = 0; i < 4; ++i) run_well(folder, with(picture, {"--shard", fmt::format("{}/4", i)}));
    run_well(folder, {"merge", "x.0-of-4.json", "x.1-of-4.json", "x.2-of-4.json", "x.3-of-4.json", "-o", "joined.png"});
    CHECK(contents(folder.file("x.png")) == contents(folder.file("joined.png")));
}

TEST_CASE("shards: scenes are divided, and their numbers stay those of the whole list", "[cli][shard]") {
    const TemporaryFolder folder;
    const Strings scenes{"render", "sphere:12", "sphere:20", "sphere:30", "demo", "sphere:50", "--size", "16", "-o", "p/{index}.png"};
    run_well(folder, scenes);
    Strings whole;
    for (int i = 0; i < 5; ++i) whole.push_back(contents(folder.file(fmt::format("p/{}.png", i))));
    std::filesystem::remove_all(folder.file("p"));
    for (int i = 0; i < 2; ++i) run_well(folder, with(scenes, {"--report", "r.json", "--shard", fmt::format("{}/2", i)}));
    for (int i = 0; i < 5; ++i) CHECK(contents(folder.file(fmt::format("p/{}.png", i))) == whole[static_cast<std::size_t>(i)]);
    run_well(folder, {"merge", "r.0-of-2.json", "r.1-of-2.json"});
    const Outcome half = run_in(folder, {"merge", "r.1-of-2.json"});
    CHECK(half.code == 1);
    CHECK(contains(half.err, "missing: scenes 0, 2, 4; of shard 0 of 2"));
    const Outcome joined = run_in(folder, {"merge", "r.0-of-2.json", "r.1-of-2.json", "-o", "x.png"});
    CHECK(joined.code == 2);
}

TEST_CASE("shards: a killed process leaves no half file, and its repetition makes the rest", "[cli][shard]") {
    const TemporaryFolder folder;
    const Strings turn{"render", "sphere:3000", "--turntable", "12", "--size", "160x120"};
    const Strings film = with(turn, {"-o", "f/{:02}.png", "--report", "r.json"});
    run_well(folder, with(turn, {"-o", "whole/{:02}.png"}));
    for (int i = 0; i < 3; ++i) {
        const Strings shard = with(film, {"--shard", fmt::format("{}/3", i)});
        const std::string first = folder.file(fmt::format("f/{:02}.png", i));
        (void)run(shard, {.folder = folder.path(), .signal = [&]() -> std::optional<int> {
                              return std::filesystem::exists(first) ? std::optional(kKill) : std::nullopt;
                          }});
        run_well(folder, with(shard, i == 1 ? Strings{"--skip-existing"} : Strings{}));
    }
    for (int i = 0; i < 12; ++i) {
        const std::string name = fmt::format("/{:02}.png", i);
        CHECK(contents(folder.file("whole" + name)) == contents(folder.file("f" + name)));
    }
    const Outcome merged = run_in(folder, {"merge", "r.0-of-3.json", "r.1-of-3.json", "r.2-of-3.json"});
    INFO(merged.err);
    CHECK(merged.code == 0);
}

TEST_CASE("shards: a scheduler's number of the task is the shard", "[cli][shard]") {
    const TemporaryFolder folder;
    struct Case {
        Variables environment;
        std::string shard;
        std::string report;  ///< empty: refused
    };
    const auto [environment, shard, report] = GENERATE(
        Case{{{"SLURM_ARRAY_TASK_ID", "3"}}, "auto/8", "r.3-of-8.json"},
        Case{{{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "8"}, {"SLURM_ARRAY_TASK_MAX", "7"}}, "auto", "r.3-of-8.json"},
        // Three tasks of a larger array, submitted again.
        Case{{{"SLURM_ARRAY_TASK_ID", "1"}, {"SLURM_ARRAY_TASK_COUNT", "3"}, {"SLURM_ARRAY_TASK_MAX", "9"}}, "auto", ""},
        Case{{{"JOB_COMPLETION_INDEX", "0"}}, "auto/8", "r.0-of-8.json"}, Case{{{"JOB_COMPLETION_INDEX", "0"}}, "auto", ""},
        Case{{{"AWS_BATCH_JOB_ARRAY_INDEX", "9"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "10"}}, "auto", "r.09-of-10.json"},
        Case{{{"PARALLEL_SEQ", "8"}}, "auto/8", "r.7-of-8.json"}, Case{{{"PARALLEL_SEQ", "9"}}, "auto/8", ""},
        Case{{{"PARALLEL_SEQ", "1"}, {"SLURM_ARRAY_TASK_ID", "1"}}, "auto/8", ""}, Case{{{"SLURM_ARRAY_TASK_ID", "8"}}, "auto/8", ""},
        Case{{{"SLURM_ARRAY_TASK_ID", "x"}}, "auto/8", ""}, Case{{}, "auto/8", ""});
    const Outcome outcome = run_in(folder, with(kTurn, {"-o", "{:02}.png", "--report", "r.json", "--shard", shard}), environment);
    INFO(outcome.err);
    CHECK(outcome.code == (report.empty() ? 2 : 0));
    if (!report.empty()) CHECK(std::filesystem::exists(folder.file(report)));
}

TEST_CASE("shards: what has no parts is refused", "[cli][shard]") {
    const TemporaryFolder folder;
    const Strings flags = GENERATE(Strings{"--shard", "3/3"}, Strings{"--shard", "-1/3"}, Strings{"--shard", "1"},
                                   Strings{"--shard", "1/0"}, Strings{"--shard", "0/2", "-o", "x.gif", "--turntable", "4"},
                                   Strings{"--shard", "0/2", "-o", "-"}, Strings{"--shard", "0/2", "-o", "x.jpg"},
                                   Strings{"--shard", "0/2", "--report", "-"}, Strings{"--shard", "0/2", "--aov", "depth"},
                                   Strings{"--shard", "0/99"}, Strings{"--shard", "0/2", "-o", "x.exr", "--background", "transparent"});
    const Outcome outcome = run_in(folder, with({"render", "sphere:12", "--size", "8"}, flags));
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    for (const std::string& name : folder.names()) CHECK(name.ends_with(".json"));  // that of a fault found while drawing
}

TEST_CASE("merge: what is no report of one run is refused", "[cli][shard]") {
    const TemporaryFolder folder;
    run_well(folder, {"render", "sphere:12", "--size", "8", "--shard", "0/2", "-o", "a.png"});
    run_well(folder, {"render", "sphere:12", "--size", "8x16", "--shard", "1/2", "-o", "b.png"});
    CHECK(run_in(folder, {"merge", "a.0-of-2.json", "b.1-of-2.json"}).code == 2);
    const std::string good = contents(folder.file("a.0-of-2.json"));
    const std::string text = GENERATE_COPY(std::string("{}"), std::string("[]"), std::string("no"), std::string("{\"schema\":1}"),
                                           std::string(R"({"schema":"halflit.report/1","status":"ok"})"), good.substr(0, good.size() / 2),
                                           good + good.substr(0, 40), "{\"status\":\"ok\"}\n" + good);
    write_contents(folder.file("bad.json"), text);
    const Outcome outcome = run_in(folder, {"merge", "a.0-of-2.json", "bad.json"});
    INFO(outcome.err);
    CHECK(outcome.code == 3);
    CHECK(contains(outcome.err, "bad.json"));
}

TEST_CASE("merge: films of two scenes, or a frame twice, are refused", "[cli][shard]") {
    const TemporaryFolder folder;
    const auto film = [&](const char* scene, const std::string& name) {
        run_well(folder, {"render", scene, "--turntable", "2", "--size", "8", "-o", name + "/{}.png", "--report", name + ".json"});
    };
    film("sphere:12", "a");
    film("lights:1", "b");
    film("sphere:12", "c");
    CHECK(contains(run_in(folder, {"merge", "a.json", "b.json"}).err, "which are of two"));
    CHECK(contains(run_in(folder, {"merge", "a.json", "c.json"}).err, "which have the same place in it"));
    CHECK(run_in(folder, {"merge", "a.json", "a.json"}).code == 0);
}
