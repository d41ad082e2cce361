// The two codes of KTX2 textures that Basis Universal made, by the Khronos Data Format Specification 1.4 and the KTX specification 2.0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace halflit::io::detail {

constexpr std::size_t kBlockSide = 4, kUastcBytes = 16;
using Rgba8 = std::array<std::uint8_t, 4>;
using Block = std::array<Rgba8, kBlockSide * kBlockSide>;  ///< row by row

/// A block of UASTC. One that is not valid has the colour that the specification gives it, (255, 0, 255, 255).
Block decode_uastc(std::span<const std::byte, kUastcBytes> bytes);

/// Where an ETC1S texture's parts are in the file. Sizes that lead out of it have been cut off.
struct Etc1sParts {
    std::uint32_t endpoint_count = 0, selector_count = 0;
    std::span<const std::byte> endpoints, selectors, tables;  ///< the books of colours and of patterns, and the slices' Huffman tables
    std::span<const std::byte> color, alpha;                  ///< slices
    bool has_alpha = false;
};

/// Decodes an ETC1S texture by rows of blocks.
class Etc1sDecoder {
public:
    Etc1sDecoder(const Etc1sParts& parts, std::size_t blocks_a_row);
    ~Etc1sDecoder();
    Etc1sDecoder(const Etc1sDecoder&) = delete;
    Etc1sDecoder& operator=(const Etc1sDecoder&) = delete;

    /// False: the data are damaged or cut off.
    [[nodiscard]] bool next_row(std::span<Block> blocks);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace halflit::io::detail
