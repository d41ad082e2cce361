#include "tests/adversary/search.hpp"

#include <algorithm>
#include <chrono>

namespace halflit::adversary {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

class Search {
public:
    Search(const SearchOptions& options, const std::function<void(const Found&)>& on_broken)
        : options_(options), on_broken_(on_broken), numbers_(options.seed ^ 0xC11B5u), begin_(now()), judge_(options.promise) {}

    SearchResult run() {
        for (std::uint64_t restart = 0; !over(); ++restart) {
            wanted_ = static_cast<int>(restart % (kTerms + 1));
            climb(best_fresh(restart));
        }
        result_.seconds = now() - begin_;
        return std::move(result_);
    }

private:
    [[nodiscard]] bool over() const {
        return result_.scenes >= options_.scenes || now() - begin_ >= options_.seconds ||
               (options_.stop_at_first && !result_.broken.empty());
    }

    /// The number that a climb raises. Each part of the bound has climbs of its own, or all would end where bounds are tightest; the last
    /// is for all.
    [[nodiscard]] double score(const Verdict& v) const {
        return v.broken() || wanted_ == kTerms || static_cast<int>(v.term()) == wanted_ ? v.ratio : 0.1 * v.ratio;
    }

    Found tried(const Genome& genome, const Trial& trial) {
        Found found{genome, judge_.judge(trial), ++result_.scenes};
        const Verdict& v = found.verdict;
        if (!v.refused.empty()) ++result_.refused;
        if (v.promised()) ++result_.drawn;
        if (v.ratio > result_.worst.verdict.ratio) result_.worst = found;
        Found& of_term = result_.worst_of_term[static_cast<int>(v.term())];
        if (v.ratio > of_term.verdict.ratio) of_term = found;
        return found;
    }

    Found best_fresh(std::uint64_t restart) {
        Found best;
        for (int i = 0; i < options_.fresh_per_climb && !over(); ++i) {
            const Genome genome = random_genome(
                options_.seed, restart * static_cast<std::uint64_t>(options_.fresh_per_climb) + static_cast<std::uint64_t>(i));
            Found found = tried(genome, make_trial(genome, options_.avoid));
            result_.fresh += found.verdict.promised() ? 1 : 0;
            result_.fresh_broken += found.verdict.broken() ? 1 : 0;
            if (score(found.verdict) > score(best.verdict) || i == 0) best = std::move(found);
            if (best.verdict.broken()) break;
        }
        return best;
    }

    void climb(Found best) {
        // A climb that is far below 1 and stays there is not worth its time.
        const Trial first = make_trial(best.genome, options_.avoid);
        GeneSet read = first.read;
        const int patience = options_.climb_steps / (first.scene.environment != nullptr ? 4 : 1);  // such scenes take long
        int idle = best.verdict.ratio > 0 ? patience : 0, steps = 0;
        while (idle > 0 && !over()) {
            // A broken promise may be broken worse, but not for long.
            if (best.verdict.broken()) idle = std::min(idle, 15);
            if (best.verdict.broken() && options_.stop_at_first) break;
            const Genome genome = mutated(best.genome, read, numbers_);
            const Trial trial = make_trial(genome, options_.avoid);
            --idle, ++steps;
            Found next = tried(genome, trial);
            if (!(score(next.verdict) > score(best.verdict))) continue;
            if (score(next.verdict) > 1.05 * score(best.verdict)) idle = patience;
            best = std::move(next);
            read = trial.read;
            if (steps > 400) break;
        }
        if (!best.verdict.broken()) return;
        result_.broken.push_back(best);
        if (on_broken_) on_broken_(best);
    }

    const SearchOptions& options_;
    const std::function<void(const Found&)>& on_broken_;
    Numbers numbers_;
    int wanted_ = 0;  ///< a Term, or kTerms for any
    double begin_;
    Judge judge_;
    SearchResult result_;
};

}  // namespace

SearchResult search(const SearchOptions& options, const std::function<void(const Found&)>& on_broken) {
    return Search(options, on_broken).run();
}

Found climbed(Judge& judge, const Genome& genome, AvoidSet avoid, std::uint64_t seed, int steps) {
    Numbers numbers(seed);
    Found best{genome, judge.judge(genome, avoid), 0};
    GeneSet read = make_trial(genome, avoid).read;
    for (int i = 1; i <= steps; ++i) {
        const Genome next = mutated(best.genome, read, numbers);
        const Trial trial = make_trial(next, avoid);
        Verdict verdict = judge.judge(trial);
        if (!(verdict.ratio > best.verdict.ratio)) continue;
        best = {next, std::move(verdict), static_cast<std::uint64_t>(i)};
        read = trial.read;
    }
    return best;
}

Genome shrunk(Judge& judge, const Genome& genome, AvoidSet avoid, double keep, int tries) {
    Genome best = genome;
    const GeneSet read = make_trial(best, avoid).read;
    for (std::size_t i = 0; i < kGenes; ++i)
        if (!read[i]) best[i] = 0;
    // Whole sections, parts of them, then single genes, which may go once others are gone.
    for (const std::size_t step : {std::size_t{kSectionGenes}, std::size_t{4}, std::size_t{1}, std::size_t{1}})
        for (std::size_t at = 0; at < kGenes && tries > 0; at += step) {
            Genome smaller = best;
            for (std::size_t i = at; i < at + step; ++i) smaller[i] = 0;
            if (smaller == best) continue;
            --tries;
            if (judge.judge(smaller, avoid).ratio > keep) best = smaller;
        }
    return best;
}

}  // namespace halflit::adversary
