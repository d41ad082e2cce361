#include "apps/engine/basics/spelling.hpp"

#include "apps/io/files/text.hpp"

#include <algorithm>
#include <vector>

namespace halflit::engine {
namespace {

using io::lower;

/// Number of characters inserted, deleted or replaced, and of neighbours exchanged (the optimal string alignment distance), whatever the
/// case of letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> d((a.size() + 1) * width);
    for (std::size_t j = 0; j < width; ++j) d[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        d[i * width] = i;
        for (std::size_t j = 1; j < width; ++j) {
            const std::size_t replaced = d[(i - 1) * width + j - 1] + (lower(a[i - 1]) != lower(b[j - 1]));
            d[i * width + j] = std::min({replaced, d[(i - 1) * width + j] + 1, d[i * width + j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i * width + j] = std::min(d[i * width + j], d[(i - 2) * width + j - 2] + 1);
        }
    }
    return d.back();
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
    constexpr std::size_t kLongestWord = 200;  // the distance takes time and memory with the square of the length
    if (word.size() > kLongestWord) return {};
    const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());  // of a flag; they are hardly ever wrong
    std::string best;
    std::size_t best_distance = std::min<std::size_t>(3, (word.size() - dashes) / 2 + 1);
    for (const std::string& candidate : candidates)
        if (candidate.size() <= kLongestWord)
            if (const std::size_t distance = edit_distance(word, candidate); distance < best_distance) {
                best = candidate;
                best_distance = distance;
            }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    const std::string meant = nearest(word, candidates);
    return meant.empty() ? "" : " (did you mean " + meant + "?)";
}

}  // namespace halflit::engine
