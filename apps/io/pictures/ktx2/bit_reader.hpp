// Bits of a stream that begins at the lowest bit of its first byte.
#pragma once

#include "apps/io/files/little_endian.hpp"

namespace halflit::io::detail {

class BitReader {
public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// The next bits, the first one lowest; at most 32. Beyond the end they are 0, and is_over() is true.
    std::uint32_t get(int count) {
        while (held_ < count) {
            if (at_ < bytes_.size())
                bits_ |= std::uint64_t{byte_at(bytes_, at_++)} << held_;
            else
                is_over_ = true;
            held_ += 8;
        }
        const auto value = static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1));
        bits_ >>= count;
        held_ -= count;
        return value;
    }
    [[nodiscard]] bool is_over() const { return is_over_; }

private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    std::uint64_t bits_ = 0;
    int held_ = 0;
    bool is_over_ = false;
};

}  // namespace halflit::io::detail
