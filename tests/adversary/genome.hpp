// Genomes: a scene as a list of numbers in [0, 1), and readers that turn them into values.
//
// A gene is a multiple of 2^-24, kept as a whole number, so that a genome's text gives the same scene on every machine. Gene 0 always means
// the simplest choice: no texture, no shadow, the middle of a range. So a scene is made smaller by setting genes to 0.
#pragma once

#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace halflit::adversary {

inline constexpr int kSections = 40;      ///< parts of a scene: see Section in trial.hpp
inline constexpr int kSectionGenes = 32;  ///< genes of each; a part reads at most as many
inline constexpr std::size_t kGenes = std::size_t{kSections} * kSectionGenes;
inline constexpr std::uint32_t kGeneEnd = 1u << 24;  ///< genes lie below; this would be 1

using Genome = std::array<std::uint32_t, kGenes>;
using GeneSet = std::bitset<kGenes>;

/// SplitMix64. The same numbers everywhere; std:: distributions are not.
class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((next() >> 32) * n >> 32); }
    std::uint32_t gene() { return static_cast<std::uint32_t>(next() >> 40); }
    /// Number in [low, high).
    double real(double low, double high) { return low + (high - low) * (static_cast<double>(gene()) * 0x1p-24); }

private:
    std::uint64_t state_;
};

/// 2^y, its mantissa by a straight line: off by up to 6 %, but the same on every machine.
inline double about_exp2(double y) {
    const double whole = std::floor(y);
    return std::ldexp(1.0 + (y - whole), static_cast<int>(whole));
}

/// Reads a section's genes in order, and notes which ones a scene depends on.
class Genes {
public:
    Genes(const Genome& genome, int section, GeneSet& read)
        : genome_(genome), read_(read), at_(section * kSectionGenes), end_(at_ + kSectionGenes) {}

    double next() {
        const auto i = static_cast<std::size_t>(at_ < end_ ? at_++ : end_ - 1);
        read_.set(i);
        return static_cast<double>(genome_[i]) * 0x1p-24;
    }
    /// Skips genes, so that those after a choice keep their places whatever was chosen.
    void skip(int count) { at_ += count; }
    bool chance(double probability) { return next() > 1.0 - probability; }
    int pick(int count) { return static_cast<int>(next() * count); }
    double real(double low, double high) { return low + (high - low) * next(); }
    /// From low to low 2^count.
    double octaves(double low, double count) { return low * about_exp2(count * next()); }
    float real32(double low, double high) { return static_cast<float>(real(low, high)); }
    float octaves32(double low, double count) { return static_cast<float>(octaves(low, count)); }
    std::uint64_t seed() { return static_cast<std::uint64_t>(next() * 0x1p24); }

private:
    const Genome& genome_;
    GeneSet& read_;
    int at_, end_;
};

/// All genes at random, as the seed's `index`-th restart.
Genome random_genome(std::uint64_t seed, std::uint64_t index);
/// The genome with one to four of the genes in `read` changed: replaced, moved a little, or set to an end.
Genome mutated(const Genome& genome, const GeneSet& read, Numbers& numbers);

/// "index:value" of the genes that are not 0, with commas between. The empty text is the simplest scene.
std::string text_of(const Genome& genome);
/// False if the text is not one of a genome.
bool read_genome(std::string_view text, Genome& genome);

}  // namespace halflit::adversary
