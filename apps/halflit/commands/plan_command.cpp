// halflit plan: the commands of a run that many processes share, for schedulers.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/setting_flags.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/farm/render_line.hpp"
#include "apps/halflit/flags/command_line.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

namespace halflit::cli {
namespace {

constexpr std::string_view kForms[] = {"lines", "parallel", "slurm", "kubernetes", "opencue"};
constexpr int kMostUsualShards = 1000;  // Slurm's arrays end at 1,000 unless its administrator allows more
constexpr int kPictureShards = 16;

/// An indexed job; JSON is YAML too. The image and the volume are the cluster's matter.
constexpr std::string_view kKubernetesJob = R"({"apiVersion": "batch/v1", "kind": "Job", "metadata": {"name": "halflit"},
    "spec": {"completions": 0, "parallelism": 0, "completionMode": "Indexed", "template": {"spec": {"restartPolicy": "OnFailure",
        "containers": [{"name": "halflit", "image": "halflit", "command": [], "workingDir": "/work",
                        "volumeMounts": [{"name": "work", "mountPath": "/work"}]}],
        "volumes": [{"name": "work", "persistentVolumeClaim": {"claimName": "halflit"}}]}}}})";

/// A run to divide, and the answer's form.
struct Division {
    std::vector<std::string> words;  ///< the command, without --shard
    int shards = 0;                  ///< 0: chosen
    std::string_view form = kForms[0];
    std::string report;  ///< as in the command line: without the shard
    std::string join;    ///< the file that merge makes; empty: it verifies
};

/// A word as a shell reads it.
std::string shell_word(const std::string& word) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string out = "'";
    for (const char letter : word) out += letter == '\'' ? "'\\''" : std::string(1, letter);
    return out + "'";
}

std::string command_of(const Division& run, const std::string& shard) {
    std::string text = "halflit";
    for (const std::string& word : run.words) text += " " + shell_word(word);
    return text + " --shard " + shell_word(fmt::format("{}/{}", shard, run.shards));
}

/// The command that follows when all shards have ended.
std::string merge_of(const Division& run) {
    const std::string name = Shard{0, run.shards}.name_of(run.report, "*");
    const std::size_t star = name.rfind('*');  // a shell replaces it where it is not quoted
    std::string text = "halflit merge " + shell_word(name.substr(0, star)) + "*" + shell_word(name.substr(star + 1));
    if (!run.join.empty()) text += " -o " + shell_word(run.join);
    return text;
}

/// Reads the words as render does, so that a wrong flag is told now and not by every task.
Result<void> divide(Division& run) {
    if (run.words.empty() || run.words[0] != "render") run.words.insert(run.words.begin(), "render");
    RenderLine line;
    const Command table = render_table(line);
    const auto parsed = parse_command_line(std::span(&table, 1), run.words);
    if (!parsed) return tl::unexpected(parsed.error());
    if (parsed->wanted != ParsedLine::Wanted::run) return fail(ErrorCode::usage, "expected a command that draws");
    if (line.shard) return fail(ErrorCode::usage, "--shard: plan chooses it; --shards has their number");
    if (line.report == "-") return fail(ErrorCode::usage, "--report: expected a file, found -");
    run.report = line.report;
    const auto kind = settle(line);
    if (!kind) return tl::unexpected(kind.error());
    const bool picture = *kind == RenderKind::picture;
    if (picture) run.join = line.output.empty() ? default_output(line.words.empty() ? "" : line.words[0], line.format) : line.output;
    const auto most = static_cast<std::int64_t>(*kind == RenderKind::film ? line.film.range().count() : line.words.size());
    if (run.shards == 0) run.shards = picture ? kPictureShards : static_cast<int>(std::min<std::int64_t>(most, kMostUsualShards));
    if (!picture && run.shards > most) print_warning(fmt::format("{} of {} shards have nothing to draw", run.shards - most, run.shards));
    // Errors that only the whole run shows, such as a single file for all frames, are told here.
    line.shard = Shard{0, run.shards};
    line.report.clear();
    if (const auto sharded = settle_shard(line, *kind); !sharded) return sharded;
    if (!run.report.empty()) return {};
    run.report = picture ? run.join.substr(0, run.join.rfind('.')) + ".json" : "report.json";
    if (!picture) run.words.insert(run.words.end(), {"--report", run.report});
    return {};
}

std::string kubernetes_text(const Division& run) {
    Json job = Json::parse(kKubernetesJob);
    Json& spec = job["spec"];
    spec["completions"] = run.shards;
    spec["parallelism"] = std::min(run.shards, 10);
    Json& words = spec["template"]["spec"]["containers"][0]["command"] = {"halflit"};
    for (const std::string& word : run.words) words.push_back(word);
    words.insert(words.end(), {"--shard", fmt::format("auto/{}", run.shards)});
    return to_text(job);
}

std::string text_of(const Division& run) {
    if (run.form == "kubernetes") return kubernetes_text(run);
    if (run.form == "opencue") return command_of(run, "#IFRAME#") + "\n";
    if (run.form == "slurm")
        return fmt::format("#!/bin/sh\n#SBATCH --array=0-{}\n#SBATCH --requeue\n{}\n", run.shards - 1, command_of(run, "auto"));
    std::string text;
    for (int i = 0; i < run.shards; ++i) text += command_of(run, std::to_string(i)) + "\n";
    // Commands that parallel reads are run as they are; in one of its own, {} and {.} would be replaced.
    if (run.form == "parallel") return "parallel --retries 3 --joblog halflit.log <<'END_OF_COMMANDS'\n" + text + "END_OF_COMMANDS\n";
    return text;
}

Result<int> run_plan(Division run) {
    if (const auto divided = divide(run); !divided) return tl::unexpected(divided.error());
    if (run.form == "opencue") print_note(fmt::format("the layer's frames are 0-{}", run.shards - 1));
    print_note("when all have ended: " + merge_of(run));
    return write_text("-", text_of(run)).map([] { return 0; });
}

}  // namespace

Command plan_command() {
    const auto options = std::make_shared<Division>();
    Division& o = *options;
    Positional words{.name = "COMMAND",
                     .help = "The command to divide, behind --: render and its arguments",
                     .read = append_to(o.words),
                     .required = true,
                     .repeated = true,
                     .usage = "-- render ..."};
    return {"plan",
            "Divide a run of render among processes: print one command a line, or the job of a scheduler",
            {std::move(words)},
            {{"Flags",
              {{"--shards", "N", "Number of parts (default: one for each frame or scene, at most 1000; 16 for one picture)",
                read_int(o.shards, 1, static_cast<int>(kMostShards))},
               {"--for", joined({std::begin(kForms), std::end(kForms)}, "|"),
                "Form of the output: commands as lines, a pipe into GNU parallel, a batch script for sbatch, an indexed job for kubectl, "
                "or the command of an OpenCue layer (default lines)",
                [&o](const std::string& text) {
                    return read_value(raster::named(kForms), text).map([&](double i) { o.form = kForms[static_cast<int>(i)]; });
                }}}}},
            [options] { return run_plan(*options); }};
}

}  // namespace halflit::cli
