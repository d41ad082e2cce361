// halflit plan: the commands of a run that many processes share, for schedulers.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/farm/render_line.hpp"
#include "apps/halflit/flags/command_line.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>

namespace halflit::cli {
namespace {

constexpr std::string_view kForms[] = {"lines", "parallel", "slurm", "kubernetes", "opencue"};
constexpr int kMostUsualShards = 1000;  // Slurm's arrays end at 1,000 unless its administrator allows more
constexpr int kPictureShards = 16;

struct PlanOptions {
    std::vector<std::string> words;  ///< of the command to divide
    int shards = 0;                  ///< 0: chosen
    std::string form = "lines";
};

/// A run to divide.
struct Divided {
    std::vector<std::string> words;  ///< the command without --shard
    std::int64_t shards = 1;
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

std::string command_of(const Divided& run, const std::string& shard) {
    std::string text = "halflit";
    for (const std::string& word : run.words) text += " " + shell_word(word);
    return text + " --shard " + shell_word(shard);
}

/// The command that follows when all shards have ended.
std::string merge_of(const Divided& run) {
    const std::string name = Shard{0, run.shards}.name_of(run.report),
                      first = fmt::format("{:0{}}-of", 0, std::to_string(run.shards).size());
    const std::size_t at = name.rfind(first + "-" + std::to_string(run.shards));
    std::string text = "halflit merge " + shell_word(name.substr(0, at)) + "*" + shell_word(name.substr(at + first.size() - 3));
    if (!run.join.empty()) text += " -o " + shell_word(run.join);
    return text;
}

/// Reads the words as render does, so that a wrong flag is told now and not by every task.
Result<Divided> divide(const PlanOptions& options) {
    Divided run{options.words, options.shards, {}, {}};
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
    std::int64_t most = kMostShards;
    switch (*kind) {
        case RenderKind::film:
            most = static_cast<std::int64_t>(line.film.range().count());
            break;
        case RenderKind::many:
            most = static_cast<std::int64_t>(line.words.size());
            break;
        case RenderKind::picture:
            run.join = line.output.empty() ? default_output(line.words.empty() ? "" : line.words[0], line.format) : line.output;
            break;
    }
    if (run.shards == 0) run.shards = *kind == RenderKind::picture ? kPictureShards : std::min<std::int64_t>(most, kMostUsualShards);
    if (run.shards > most) print_warning(fmt::format("{} of {} shards have nothing to draw", run.shards - most, run.shards));
    // What only the whole run shows, such as a single file for all frames, is told here.
    line.shard = Shard{0, run.shards};
    line.report.clear();
    if (const auto sharded = settle_shard(line, *kind); !sharded) return tl::unexpected(sharded.error());
    if (*kind == RenderKind::picture && run.report.empty()) {
        run.report = run.join.substr(0, run.join.rfind('.')) + ".json";
    } else if (run.report.empty()) {
        run.report = "report.json";
        run.words.insert(run.words.end(), {"--report", run.report});
    }
    return run;
}

std::string slurm_text(const Divided& run) {
    return fmt::format("#!/bin/sh\n#SBATCH --array=0-{}\n#SBATCH --requeue\n{}\n", run.shards - 1,
                       command_of(run, fmt::format("auto/{}", run.shards)));
}

/// A job of JSON, which is YAML too. The image and the volume are the cluster's matter.
std::string kubernetes_text(const Divided& run) {
    Json words = Json::array({"halflit"});
    for (const std::string& word : run.words) words.push_back(word);
    words.insert(words.end(), {"--shard", fmt::format("auto/{}", run.shards)});
    const Json container{{"name", "halflit"},
                         {"image", "halflit"},
                         {"command", words},
                         {"workingDir", "/work"},
                         {"volumeMounts", {{{"name", "work"}, {"mountPath", "/work"}}}}};
    const Json pod{{"restartPolicy", "OnFailure"},
                   {"containers", Json::array({container})},
                   {"volumes", {{{"name", "work"}, {"persistentVolumeClaim", {{"claimName", "halflit"}}}}}}};
    const Json job{{"apiVersion", "batch/v1"},
                   {"kind", "Job"},
                   {"metadata", {{"name", "halflit"}}},
                   {"spec",
                    {{"completions", run.shards},
                     {"parallelism", std::min<std::int64_t>(run.shards, 10)},
                     {"completionMode", "Indexed"},
                     {"template", {{"spec", pod}}}}}};
    return to_text(job);
}

std::string text_of(const Divided& run, std::string_view form) {
    if (form == "slurm") return slurm_text(run);
    if (form == "kubernetes") return kubernetes_text(run);
    if (form == "opencue") return command_of(run, fmt::format("#IFRAME#/{}", run.shards)) + "\n";
    std::string text;
    for (std::int64_t i = 0; i < run.shards; ++i) text += command_of(run, fmt::format("{}/{}", i, run.shards)) + "\n";
    // Commands that parallel reads are run as they are; in one of its own, {} and {.} would be replaced.
    if (form == "parallel") return "parallel --retries 3 --joblog halflit.log <<'END_OF_COMMANDS'\n" + text + "END_OF_COMMANDS\n";
    return text;
}

Result<int> run_plan(const PlanOptions& options) {
    const auto run = divide(options);
    if (!run) return tl::unexpected(run.error());
    if (options.form == "opencue") print_note(fmt::format("the layer's frames are 0-{}", run->shards - 1));
    print_note("when all have ended: " + merge_of(*run));
    if (const auto written = write_text("-", text_of(*run, options.form)); !written) return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command plan_command() {
    const auto options = std::make_shared<PlanOptions>();
    PlanOptions& o = *options;
    Positional words{.name = "COMMAND",
                     .help = "The command to divide, behind --: render and its arguments",
                     .read = append_to(o.words),
                     .required = true,
                     .repeated = true,
                     .usage = "-- render ..."};
    const auto read_form = [&o](const std::string& text) -> Result<void> {
        const std::vector<std::string> forms(std::begin(kForms), std::end(kForms));
        if (std::find(forms.begin(), forms.end(), text) == forms.end())
            return fail(ErrorCode::usage, "expected " + joined(forms, ", ") + ", found '" + text + "'" + did_you_mean(text, forms));
        o.form = text;
        return {};
    };
    return {"plan",
            "Divide a run of render among processes: print its commands, one a line, or the job of a scheduler",
            {std::move(words)},
            {{"Flags",
              {{"--shards", "N", "Number of parts (default: one for each frame or scene, at most 1000; 16 for one picture)",
                read_int(o.shards, 1, static_cast<int>(kMostShards))},
               {"--for", "lines|parallel|slurm|kubernetes|opencue",
                "Commands as lines, a pipe into GNU parallel, a batch script for sbatch, an indexed job for kubectl, or the command of an "
                "OpenCue layer (default lines)",
                read_form}}}},
            [options] { return run_plan(*options); }};
}

}  // namespace halflit::cli
