// Values decoded from a fuzz input. An input that is too short gives zeros.
#pragma once

#include "tests/fuzz/target.hpp"

#include <cstring>
#include <limits>

namespace halflit::fuzz {

class Input {
public:
    explicit Input(View bytes) : bytes_(bytes) {}

    [[nodiscard]] bool empty() const { return bytes_.empty(); }
    std::uint8_t byte() { return number<std::uint8_t>(); }
    template <class T>
    T number() {
        T value{};
        const std::size_t size = bytes_.size() < sizeof value ? bytes_.size() : sizeof value;
        if (size > 0) std::memcpy(&value, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
        return value;
    }
    std::size_t below(std::size_t n) { return byte() % n; }
    bool one_in(std::size_t n) { return below(n) == n - 1; }
    bool flag() { return (byte() & 1u) != 0; }
    template <class Range>
    auto pick(const Range& range) {
        return range[below(std::size(range))];
    }
    /// Mostly what scenes have, else any bits: NaN, infinities and denormals too.
    float real() {
        static constexpr float kSpecial[] = {std::numeric_limits<float>::quiet_NaN(),  std::numeric_limits<float>::infinity(),
                                             -std::numeric_limits<float>::infinity(),  std::numeric_limits<float>::max(),
                                             -std::numeric_limits<float>::max(),       std::numeric_limits<float>::min(),
                                             std::numeric_limits<float>::denorm_min(), -0.0f};
        const std::uint8_t kind = byte();
        if (kind < 8) return kSpecial[kind];
        if (kind < 16) return number<float>();
        return static_cast<float>(number<std::int16_t>()) / (kind < 128 ? 32768.0f : 4096.0f);
    }
    View rest() const { return bytes_; }

private:
    View bytes_;
};

}  // namespace halflit::fuzz
