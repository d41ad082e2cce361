// ETC1S under BasisLZ: a book of colours and a book of patterns of 4x4 pixels, and for each block its places in both, coded by what stands
// to the left, above, or was used a short time ago.
#include "apps/io/pictures/ktx2/bit_reader.hpp"
#include "apps/io/pictures/ktx2/blocks.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace halflit::io::detail {
namespace {

/// A canonical Huffman code as deflate has it, of 16 bits at most.
class Huffman {
public:
    static constexpr int kMostBits = 16;

    Huffman() = default;
    /// False: the lengths are those of no code.
    [[nodiscard]] bool set(std::span<const std::uint8_t> lengths) {
        counts_.fill(0);
        for (const std::uint8_t length : lengths) ++counts_[length];
        counts_[0] = 0;
        std::array<std::uint32_t, kMostBits + 2> first{};
        std::uint32_t used = 0;
        for (std::size_t length = 1; length <= kMostBits; ++length) {
            used = 2 * used + counts_[length];
            if (used > 1u << length) return false;
            first[length + 1] = first[length] + counts_[length];
        }
        symbols_.resize(first[kMostBits + 1]);
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol)
            if (lengths[symbol] != 0) symbols_[first[lengths[symbol]]++] = static_cast<std::uint16_t>(symbol);
        return true;
    }
    /// The next symbol; none: no code begins like this, or the stream is over.
    [[nodiscard]] std::optional<std::uint32_t> read(BitReader& bits) const {
        std::uint32_t code = 0, first = 0, index = 0;
        for (std::size_t length = 1; length <= kMostBits; ++length) {
            code |= bits.get(1);
            const std::uint32_t count = counts_[length];
            if (bits.is_over()) break;
            if (code < first + count) return symbols_[index + code - first];
            index += count;
            first = 2 * (first + count);
            code *= 2;
        }
        return std::nullopt;
    }

private:
    std::array<std::uint32_t, kMostBits + 1> counts_{};  ///< codes of each length
    std::vector<std::uint16_t> symbols_;                 ///< in the order of their codes
};

/// Reads a code from the lengths of its symbols, which have a code of their own.
bool read_huffman(BitReader& bits, Huffman& code) {
    static constexpr std::uint8_t kOrder[] = {17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16};
    struct Run {
        std::size_t least;
        int bits;
        bool is_repeat;  ///< of the length before, otherwise of 0
    };
    static constexpr std::uint32_t kFirstRun = Huffman::kMostBits + 1;
    static constexpr Run kRuns[] = {{3, 3, false}, {11, 7, false}, {3, 2, true}, {7, 7, true}};
    const std::size_t symbols = bits.get(14), count = bits.get(5);
    if (symbols == 0) return code.set({});  // a code that nothing uses
    std::array<std::uint8_t, std::size(kOrder)> small{};
    if (count == 0 || count > small.size()) return false;
    for (std::size_t i = 0; i < count; ++i) small[kOrder[i]] = static_cast<std::uint8_t>(bits.get(3));
    Huffman of_lengths;
    if (!of_lengths.set(small)) return false;
    std::vector<std::uint8_t> lengths;
    while (lengths.size() < symbols) {
        const auto symbol = of_lengths.read(bits);
        if (!symbol) return false;
        if (*symbol < kFirstRun) {
            lengths.push_back(static_cast<std::uint8_t>(*symbol));
            continue;
        }
        const Run& run = kRuns[*symbol - kFirstRun];
        const std::size_t length = run.least + bits.get(run.bits);
        if (length > symbols - lengths.size() || (run.is_repeat && (lengths.empty() || lengths.back() == 0))) return false;
        lengths.insert(lengths.end(), length, run.is_repeat ? lengths.back() : std::uint8_t{0});
    }
    return code.set(lengths);
}

/// A count in digits of `bits` bits, the lowest first, each with a bit that says whether another follows.
std::uint32_t read_count(BitReader& bits, int digit) {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += digit) {
        const std::uint32_t read = bits.get(digit + 1);
        value |= (read & ((1u << digit) - 1)) << shift;
        if (read >> digit == 0) break;
    }
    return value;
}

using Palette4 = std::array<Rgba8, 4>;        ///< a block's colours, from dark to light
using Pattern = std::array<std::uint8_t, 4>;  ///< a row each: two bits a pixel, the left one lowest

/// The book of colours: a base colour of 5 bits a channel, and one of eight steps to the colours around it.
bool read_endpoints(std::span<const std::byte> bytes, std::size_t count, std::vector<Palette4>& book) {
    static constexpr int kSteps[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    BitReader bits(bytes);
    Huffman of_color[3], of_step;  // by the value before: below 10, below 22, others
    for (Huffman& code : of_color)
        if (!read_huffman(bits, code)) return false;
    if (!read_huffman(bits, of_step)) return false;
    const bool is_grey = bits.get(1) != 0;
    std::uint32_t step = 0, color[3] = {16, 16, 16};
    TimeCheck check;
    for (std::size_t i = 0; i < count; ++i) {
        check();
        const auto delta = of_step.read(bits);
        if (!delta) return false;
        step = (step + *delta) & 7;
        for (std::size_t c = 0; c < (is_grey ? 1 : 3); ++c) {
            const auto by = of_color[color[c] < 10 ? 0 : color[c] < 22 ? 1 : 2].read(bits);
            if (!by) return false;
            color[c] = (color[c] + *by) & 31;
        }
        if (is_grey) color[1] = color[2] = color[0];
        const int by[4] = {-kSteps[step][1], -kSteps[step][0], kSteps[step][0], kSteps[step][1]};
        Palette4& palette = book.emplace_back();
        for (std::size_t k = 0; k < palette.size(); ++k) {
            for (std::size_t c = 0; c < 3; ++c) {
                const int base = static_cast<int>(color[c] << 3 | color[c] >> 2);
                palette[k][c] = static_cast<std::uint8_t>(std::clamp(base + by[k], 0, 255));
            }
            palette[k][3] = 255;
        }
    }
    return true;
}

bool read_selectors(std::span<const std::byte> bytes, std::size_t count, std::vector<Pattern>& book) {
    BitReader bits(bytes);
    if (bits.get(2) != 0) return false;
    const bool is_plain = bits.get(1) != 0;
    Huffman of_change;
    if (!is_plain && !read_huffman(bits, of_change)) return false;
    TimeCheck check;
    for (std::size_t i = 0; i < count; ++i) {
        check();
        Pattern pattern{};
        for (std::size_t y = 0; y < pattern.size(); ++y) {
            const auto read = is_plain || i == 0 ? bits.get(8) : of_change.read(bits);
            if (!read || bits.is_over()) return false;
            pattern[y] = static_cast<std::uint8_t>((is_plain || i == 0 ? 0 : book.back()[y]) ^ *read);
        }
        book.push_back(pattern);
    }
    return true;
}

/// The books that all slices of a texture share.
struct Books {
    std::vector<Palette4> colors;
    std::vector<Pattern> patterns;
    Huffman prediction, color_step, pattern, run;
    std::size_t history = 0;  ///< patterns that are remembered
};

bool read_books(const Etc1sParts& parts, Books& books) {
    if (!read_endpoints(parts.endpoints, parts.endpoint_count, books.colors)) return false;
    if (!read_selectors(parts.selectors, parts.selector_count, books.patterns)) return false;
    BitReader bits(parts.tables);
    for (Huffman* code : {&books.prediction, &books.color_step, &books.pattern, &books.run})
        if (!read_huffman(bits, *code)) return false;
    books.history = bits.get(13);
    return !bits.is_over();
}

/// The places of a slice's blocks in the books, block by block.
class Slice {
public:
    Slice(const Books& books, std::span<const std::byte> bytes, std::size_t width)
        : books_(books), bits_(bytes), above_(width), predictions_((width + 1) / 2), history_(books.history), oldest_(books.history / 2) {}

    /// False: the data are damaged or cut off.
    template <class Use>
    [[nodiscard]] bool next_row(Use use) {
        std::uint32_t predictions = 0, above_left = 0;
        for (std::size_t x = 0; x < above_.size(); ++x) {
            check_();
            if (x % 2 == 0 && !next_predictions(x / 2, predictions)) return false;
            const std::uint32_t kind = predictions & 3;
            predictions >>= 2;
            if ((kind % 2 == 0 && x == 0) || ((kind == 1 || kind == 2) && row_ == 0)) return false;
            const std::uint32_t above = above_[x];
            if (kind == 1) color_ = above;
            if (kind == 2) color_ = above_left;
            if (kind == 3) {
                const auto step = books_.color_step.read(bits_);
                if (!step) return false;
                color_ += *step;
                if (color_ >= books_.colors.size()) color_ -= static_cast<std::uint32_t>(books_.colors.size());
            }
            above_left = above;
            above_[x] = color_;
            const auto pattern = next_pattern();
            if (!pattern || color_ >= books_.colors.size()) return false;
            use(x, books_.colors[color_], books_.patterns[*pattern]);
        }
        ++row_;
        return true;
    }

private:
    /// Kinds of prediction of two blocks by two, for this row; those of the row below are kept.
    bool next_predictions(std::size_t pair, std::uint32_t& predictions) {
        constexpr std::uint32_t kRepeat = 256, kLeast = 3;
        if (row_ % 2 != 0) {
            predictions = predictions_[pair];
            return true;
        }
        if (repeats_ > 0) {
            --repeats_;
        } else {
            const auto symbol = books_.prediction.read(bits_);
            if (!symbol || *symbol > kRepeat) return false;
            if (*symbol == kRepeat)
                repeats_ = std::uint64_t{read_count(bits_, 4)} + kLeast - 1;
            else
                last_predictions_ = *symbol;
        }
        predictions = last_predictions_;
        predictions_[pair] = static_cast<std::uint8_t>(predictions >> 4);
        return true;
    }

    std::optional<std::size_t> next_pattern() {
        constexpr std::uint32_t kLeast = 3, kLong = 63;
        const std::size_t count = books_.patterns.size();
        std::size_t symbol = count;  // in a run: the first one of the history
        if (run_ > 0) {
            --run_;
        } else {
            const auto read = books_.pattern.read(bits_);
            if (!read) return std::nullopt;
            symbol = *read;
            if (symbol == count + history_.size()) {
                const auto run = books_.run.read(bits_);
                if (!run) return std::nullopt;
                run_ = std::uint64_t{*run == kLong ? read_count(bits_, 7) : *run} + kLeast - 1;
                symbol = count;
            }
        }
        if (symbol >= count) {
            const std::size_t at = symbol - count;
            if (at >= history_.size() || history_[at] >= count) return std::nullopt;
            const std::size_t pattern = history_[at];
            std::swap(history_[at / 2], history_[at]);  // what is used moves to the front
            return pattern;
        }
        if (!history_.empty()) {
            history_[oldest_] = symbol;
            if (++oldest_ == history_.size()) oldest_ = history_.size() / 2;
        }
        return symbol;
    }

    const Books& books_;
    BitReader bits_;
    std::vector<std::uint32_t> above_;  ///< colours of the row above, and of this one as far as it goes
    std::vector<std::uint8_t> predictions_;
    std::vector<std::size_t> history_;
    std::size_t oldest_, row_ = 0;
    std::uint64_t repeats_ = 0, run_ = 0;
    std::uint32_t last_predictions_ = 0, color_ = 0;
    TimeCheck check_;
};

}  // namespace

struct Etc1sDecoder::State {
    Books books;
    bool is_sound;
    Slice color;
    std::optional<Slice> alpha;

    State(const Etc1sParts& parts, std::size_t blocks_a_row) : is_sound(read_books(parts, books)), color(books, parts.color, blocks_a_row) {
        if (parts.has_alpha) alpha.emplace(books, parts.alpha, blocks_a_row);
    }
};

Etc1sDecoder::Etc1sDecoder(const Etc1sParts& parts, std::size_t blocks_a_row) : state_(std::make_unique<State>(parts, blocks_a_row)) {}
Etc1sDecoder::~Etc1sDecoder() = default;

bool Etc1sDecoder::next_row(std::span<Block> blocks) {
    if (!state_->is_sound) return false;
    const auto pixel = [](const Palette4& palette, const Pattern& pattern, std::size_t i) -> const Rgba8& {
        return palette[pattern[i / kBlockSide] >> 2 * (i % kBlockSide) & 3u];
    };
    const bool has_color = state_->color.next_row([&](std::size_t x, const Palette4& palette, const Pattern& pattern) {
        for (std::size_t i = 0; i < blocks[x].size(); ++i) blocks[x][i] = pixel(palette, pattern, i);
    });
    if (!has_color || !state_->alpha) return has_color;
    // Alpha is a grey picture; decoders take its green.
    return state_->alpha->next_row([&](std::size_t x, const Palette4& palette, const Pattern& pattern) {
        for (std::size_t i = 0; i < blocks[x].size(); ++i) blocks[x][i][3] = pixel(palette, pattern, i)[1];
    });
}

}  // namespace halflit::io::detail
