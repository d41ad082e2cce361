// halflit_adversary: looks for scenes whose measured error is above the promised bound. `./dev adversary --help`.
#include "tests/adversary/faults.hpp"
#include "tests/adversary/report.hpp"
#include "tests/adversary/search.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

using namespace halflit::adversary;

namespace {

constexpr int kShrunk = 3;  ///< scenes of one kind that are made small and written

int usage() {
    std::puts(
        "usage: halflit_adversary [--shares] [--seed N] [--seconds S] [--scenes N] [--out FOLDER] [--known | --avoid BITS] [--first]\n"
        "       halflit_adversary [--shares] --genome TEXT [--avoid BITS] [--climb N] [--shrink] [--out FOLDER]\n"
        "Looks for scenes in which the measured error is above the bound that the report promises. Exit code 1 if it finds one.\n"
        "  --shares       look for scenes in which fewer pixels are within the budget than Renderer::measure claims; exit code 1 if more\n"
        "                 than 5 % of the claims about random scenes are wrong\n"
        "  --known        do not leave out what open known faults need\n"
        "  --avoid BITS   leave out these parts of scenes: Avoid in tests/adversary/trial.hpp\n"
        "  --first        end with the first one found\n"
        "  --out FOLDER   write each scene that was found as a .glb into it\n"
        "  --genome TEXT  judge one scene, as the search prints it\n"
        "  --climb N      climb from it, N steps\n"
        "  --shrink       make it small");
    return 2;
}

struct Arguments {
    SearchOptions search;
    std::string genome, out;
    bool one = false, shrink = false, sound = true;
    int climb = 0;
};

Arguments read_arguments(int argc, char** argv) {
    Arguments a;
    a.search.avoid = avoided();
    for (int i = 1; i < argc; ++i) {
        const std::string flag = argv[i];
        const auto value = [&]() -> const char* { return i + 1 < argc ? argv[++i] : ""; };
        if (flag == "--shares")
            a.search.promise = Promise::share;
        else if (flag == "--seed")
            a.search.seed = std::strtoull(value(), nullptr, 10);
        else if (flag == "--seconds")
            a.search.seconds = std::strtod(value(), nullptr);
        else if (flag == "--scenes")
            a.search.scenes = std::strtoull(value(), nullptr, 10);
        else if (flag == "--avoid")
            a.search.avoid = static_cast<AvoidSet>(std::strtoul(value(), nullptr, 0));
        else if (flag == "--known")
            a.search.avoid = 0;
        else if (flag == "--first")
            a.search.stop_at_first = true;
        else if (flag == "--climb")
            a.climb = std::atoi(value());
        else if (flag == "--shrink")
            a.shrink = true;
        else if (flag == "--out")
            a.out = value();
        else if (flag == "--genome")
            a.genome = value(), a.one = true;
        else
            a.sound = false;
    }
    return a;
}

void say(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
}

int judge_one(const Arguments& arguments, const Genome& given) {
    Judge judge(arguments.search.promise);
    const AvoidSet avoid = arguments.search.avoid;
    Genome genome = arguments.climb > 0 ? climbed(judge, given, avoid, arguments.search.seed, arguments.climb).genome : given;
    Verdict verdict = judge.judge(genome, avoid);
    if (!verdict.refused.empty()) say("refused: " + verdict.refused);
    if (arguments.shrink) {
        genome = shrunk(judge, genome, avoid, verdict.broken() ? 1.0 : 0.9 * verdict.ratio);
        verdict = judge.judge(genome, avoid);
    }
    if (arguments.shrink || arguments.climb > 0) say("--avoid " + std::to_string(avoid) + " --genome " + text_of(genome));
    say(text_of(verdict));
    if (!arguments.out.empty() && verdict.promise == Promise::bound) say(written(make_trial(genome, avoid), arguments.out, "scene"));
    return verdict.broken() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    const Arguments arguments = read_arguments(argc, argv);
    Genome genome;
    if (!arguments.sound || (arguments.one && !read_genome(arguments.genome, genome))) return usage();
    if (arguments.one) return judge_one(arguments, genome);

    Judge judge(arguments.search.promise);
    const bool shares = arguments.search.promise == Promise::share;
    const AvoidSet avoid = arguments.search.avoid;
    const std::string seed = std::to_string(arguments.search.seed);
    std::map<std::string, std::pair<int, double>> kinds;  // how often, and the worst ratio
    const SearchResult result = search(arguments.search, [&](const Found& found) {
        std::string why = explanation(judge, found.genome, avoid);
        if (why.empty()) why = "no known fault";
        auto& [count, worst] = kinds[why];
        worst = std::max(worst, found.verdict.ratio);
        if (++count > kShrunk) return;
        const std::string number = std::to_string(found.scene);
        say("broken promise, scene " + number + " of seed " + seed + ": " + why + "\n  " + text_of(found.verdict));
        const Genome small = shrunk(judge, found.genome, avoid, std::max(1.0, 0.5 * found.verdict.ratio), 400);
        say("  made small: " + text_of(judge.judge(small, avoid)));
        say("  --avoid " + std::to_string(avoid) + " --genome " + text_of(small));
        if (!arguments.out.empty() && !shares) say(written(make_trial(small, avoid), arguments.out, "seed" + seed + "_scene" + number));
    });
    say("seed " + seed + ": " + text_of(result));
    for (const auto& [why, seen] : kinds)
        say("broken " + std::to_string(seen.first) + " times, worst ratio " + std::to_string(seen.second) + ": " + why);
    return (shares ? 20 * result.fresh_broken <= result.fresh : result.broken.empty()) ? 0 : 1;
}
