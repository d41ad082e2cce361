#include "tests/adversary/genome.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

namespace halflit::adversary {

Genome random_genome(std::uint64_t seed, std::uint64_t index) {
    Numbers numbers(seed * 0x2545F4914F6CDD1Du + index);
    Genome genome;
    for (std::uint32_t& gene : genome) gene = numbers.gene();
    return genome;
}

Genome mutated(const Genome& genome, const GeneSet& read, Numbers& numbers) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < kGenes; ++i)
        if (read[i]) places.push_back(i);
    Genome out = genome;
    if (places.empty()) return out;
    const std::uint32_t count = 1 + numbers.below(4);
    for (std::uint32_t k = 0; k < count; ++k) {
        std::uint32_t& gene = out[places[numbers.below(static_cast<std::uint32_t>(places.size()))]];
        switch (numbers.below(8)) {
            case 0:
            case 1:
                gene = numbers.gene();
                break;
            case 2:
                gene = numbers.below(2) == 0 ? 0 : kGeneEnd - 1;
                break;
            default: {
                // Steps of all sizes: half the range down to 2^-14 of it.
                const std::uint32_t reach = kGeneEnd >> (1 + numbers.below(14));
                const std::int64_t moved = std::int64_t{gene} + numbers.below(2 * reach + 1) - reach;
                gene = static_cast<std::uint32_t>(std::clamp<std::int64_t>(moved, 0, kGeneEnd - 1));
            }
        }
    }
    return out;
}

std::string text_of(const Genome& genome) {
    std::string text;
    for (std::size_t i = 0; i < kGenes; ++i)
        if (genome[i] != 0) text.append(text.empty() ? "" : ",").append(std::to_string(i)).append(":").append(std::to_string(genome[i]));
    return text;
}

bool read_genome(std::string_view text, Genome& genome) {
    genome.fill(0);
    const char *at = text.data(), *const end = at + text.size();
    while (at != end) {
        std::size_t index = 0;
        std::uint32_t value = 0;
        const auto first = std::from_chars(at, end, index);
        if (first.ec != std::errc{} || first.ptr == end || *first.ptr != ':') return false;
        const auto second = std::from_chars(first.ptr + 1, end, value);
        if (second.ec != std::errc{} || index >= kGenes || value >= kGeneEnd) return false;
        genome[index] = value;
        at = second.ptr;
        if (at != end && (*at++ != ',' || at == end)) return false;
    }
    return true;
}

}  // namespace halflit::adversary
