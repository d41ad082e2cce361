// halflit_adversary: looks for scenes whose measured error is above the promised bound. `./dev adversary --help`.
#include "tests/adversary/faults.hpp"
#include "tests/adversary/glb_writer.hpp"
#include "tests/adversary/search.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

using namespace halflit::adversary;

namespace {

int usage() {
    std::puts(
        "usage: halflit_adversary [--seed N] [--seconds S] [--scenes N] [--out FOLDER] [--known] [--first]\n"
        "       halflit_adversary --genome TEXT [--avoid BITS] [--shrink] [--out FOLDER]\n"
        "Looks for scenes in which the measured error is above the bound that the report promises. Exit code 1 if it finds one.\n"
        "  --known        do not leave out what open known faults need\n"
        "  --first        end with the first one found\n"
        "  --out FOLDER   write each scene that was found as a .glb into it\n"
        "  --genome TEXT  judge one scene, as the search prints it");
    return 2;
}

void print(const Verdict& v, const char* name) {
    std::printf("%s: ratio %.4g: %.4g codes measured (%s, pixel %d,%d channel %d: drawn %.6g, true %.6g), bound %.4g = rounding %.3g + lobes %.3g + "
                "specular %.3g + environment %.3g + left out %.3g; budget %.3g, within: %s\n",
                name, v.ratio, v.measured, v.truth == Truth::reference ? "reference" : "whole sky", v.x, v.y, v.channel, v.drawn, v.true_value,
                v.bound.codes, v.bound.rounding, v.bound.lobes, v.bound.specular, v.bound.environment, v.bound.left_out, v.bound.budget,
                v.bound.within ? "true" : "false");
}

/// Writes the scene into the folder, if one was given, and prints how to draw it.
void write(const Genome& genome, AvoidSet avoid, const std::string& folder, const std::string& name) {
    if (folder.empty()) return;
    const Trial trial = make_trial(genome, avoid);
    const auto flags = write_trial(trial, folder + "/" + name);
    if (!flags) {
        std::printf("  not written: %s\n", flags.error().message.c_str());
        return;
    }
    std::printf("  halflit trade %s\n", flags->c_str());
    std::printf("  halflit render %s --max-error %.9g --report -\n", flags->substr(0, flags->find(" # ")).c_str(), trial.settings.shading.max_error_codes);
}

}  // namespace

int main(int argc, char** argv) {
    SearchOptions options;
    options.avoid = avoided();
    std::string genome_text, out;
    bool one = false, shrink = false;
    for (int i = 1; i < argc; ++i) {
        const std::string flag = argv[i];
        const auto value = [&]() -> const char* { return i + 1 < argc ? argv[++i] : ""; };
        if (flag == "--seed")
            options.seed = std::strtoull(value(), nullptr, 10);
        else if (flag == "--seconds")
            options.seconds = std::strtod(value(), nullptr);
        else if (flag == "--scenes")
            options.scenes = std::strtoull(value(), nullptr, 10);
        else if (flag == "--avoid")
            options.avoid = static_cast<AvoidSet>(std::strtoul(value(), nullptr, 0));
        else if (flag == "--known")
            options.avoid = 0;
        else if (flag == "--first")
            options.stop_at_first = true;
        else if (flag == "--shrink")
            shrink = true;
        else if (flag == "--out")
            out = value();
        else if (flag == "--genome")
            genome_text = value(), one = true;
        else
            return usage();
    }
    Judge judge;
    if (one) {
        Genome genome;
        if (!read_genome(genome_text, genome)) return usage();
        const Verdict v = judge.judge(genome, options.avoid);
        print(v, "scene");
        if (!v.refused.empty()) std::printf("refused: %s\n", v.refused.c_str());
        if (shrink) {
            const Genome small = shrunk(judge, genome, options.avoid, v.broken() ? 1.0 : 0.9 * v.ratio);
            print(judge.judge(small, options.avoid), text_of(small).c_str());
        }
        write(genome, options.avoid, out, "scene");
        return v.broken() ? 1 : 0;
    }
    int unknown = 0;
    const SearchResult result = search(options, [&](const Found& found) {
        const std::string why = explanation(judge, found.genome, options.avoid);
        unknown += why.empty() ? 1 : 0;
        print(found.verdict, "broken promise");
        std::printf("  scene %llu of seed %llu; %s\n", static_cast<unsigned long long>(found.scene), static_cast<unsigned long long>(options.seed),
                    why.empty() ? "not a known fault" : why.c_str());
        const Genome small = shrunk(judge, found.genome, options.avoid, std::max(1.0, 0.5 * found.verdict.ratio), 400);
        print(judge.judge(small, options.avoid), "  made small");
        std::printf("  --avoid %u --genome %s\n", options.avoid, text_of(small).c_str());
        write(small, options.avoid, out, "seed" + std::to_string(options.seed) + "_scene" + std::to_string(found.scene));
        std::fflush(stdout);
    });
    std::printf("seed %llu: %llu scenes in %.1f s (%.0f a second), %llu compared, %llu within their budget, %llu refused, %zu broken promises\n",
                static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(result.scenes), result.seconds,
                static_cast<double>(result.scenes) / result.seconds, static_cast<unsigned long long>(result.drawn),
                static_cast<unsigned long long>(result.within), static_cast<unsigned long long>(result.refused), result.broken.size());
    for (int t = 0; t < kTerms; ++t) print(result.worst_of_term[t].verdict, kTermNames[t]);
    return result.broken.empty() ? 0 : 1;
}
