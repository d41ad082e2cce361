// Finds equal positions: a hash table from positions to numbers.
#pragma once

#include "sh/time_limit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <random>
#include <type_traits>
#include <vector>

namespace halflit {

/// Gives equal positions equal numbers. -0 equals 0; a NaN equals one of the same bits. V: Vec3f or Vec3d.
template <class V>
class PlaceTable {
public:
    static constexpr std::uint32_t kEmpty = 0xFFFFFFFFu;

    /// Reserves memory for `places` places.
    void reserve(std::size_t places, const std::vector<V>& list) {
        const std::size_t size = std::bit_ceil(std::max<std::size_t>(512, places + 1)) * 2;
        if (size > slots_.size()) spread(size, list);
    }
    /// Hint: the position is looked for soon.
    void prefetch(const V& position) const {
        if (!slots_.empty()) __builtin_prefetch(&slots_[first_slot(hash_of(bits(position)))]);
    }
    /// Number of the place of a position: that of an earlier one that equals it, else `number`, below kEmpty. list[n] is the position that
    /// became number n.
    std::uint32_t find(const V& position, std::uint32_t number, const std::vector<V>& list) {
        if (2 * (used_ + 1) > slots_.size()) spread(std::max<std::size_t>(1024, 2 * slots_.size()), list);
        ++finds_;
        const auto wanted = bits(position);
        std::uint64_t hash = hash_of(wanted);
        for (std::size_t slot = first_slot(hash);; slot = (slot + 1) & (slots_.size() - 1)) {
            Slot& held = slots_[slot];
            const auto tag = static_cast<std::uint32_t>(hash);
            if (held.number == kEmpty) {
                held = {number, tag};
                ++used_;
                return number;
            }
            if (held.tag == tag && bits(list[held.number]) == wanted) return held.number;
            if (++steps_ <= kMostSteps * finds_ + (std::uint64_t{1} << 20)) continue;
            // Positions that were made to collide. Nobody can make some for secrets that are drawn now; numbers do not depend on them.
            for (std::uint64_t& secret : secret_) secret = std::uint64_t{std::random_device()()} << 32 | std::random_device()();
            steps_ = finds_ = 0;
            spread(slots_.size(), list);
            hash = hash_of(wanted);
            slot = first_slot(hash) - 1;
        }
    }
    /// Number of a position in a list, at whose end it is added if it is not there. The list holds what was added alone.
    std::uint32_t add(const V& position, std::vector<V>& list) {
        const auto next = static_cast<std::uint32_t>(list.size()), number = find(position, next, list);
        if (number == next) list.push_back(position);
        return number;
    }

private:
    static constexpr std::uint64_t kMostSteps = 16;  ///< in the mean, each way; a table that is half full takes below 1

    using Scalar = std::remove_cvref_t<decltype(V{}.x)>;
    using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
    static std::array<Bits, 3> bits(const V& p) {
        const Scalar zero{0};
        return {std::bit_cast<Bits>(p.x + zero), std::bit_cast<Bits>(p.y + zero), std::bit_cast<Bits>(p.z + zero)};
    }
    /// Both halves of a product of 128 bits, folded: each bit of a factor reaches every bit.
    static std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
        const std::uint64_t a0 = a & 0xFFFFFFFFu, a1 = a >> 32, b0 = b & 0xFFFFFFFFu, b1 = b >> 32;
        const std::uint64_t low = a0 * b0, cross = a1 * b0 + (low >> 32), other = a0 * b1 + (cross & 0xFFFFFFFFu);
        return (a1 * b1 + (cross >> 32) + (other >> 32)) ^ (other << 32 | (low & 0xFFFFFFFFu));
    }
    [[nodiscard]] std::uint64_t hash_of(const std::array<Bits, 3>& key) const {
        std::uint64_t h = 0;
        for (std::size_t i = 0; i < 3; ++i) h = folded_product(h ^ secret_[3], key[i] ^ secret_[i]);
        return h;
    }
    [[nodiscard]] std::size_t first_slot(std::uint64_t hash) const { return static_cast<std::size_t>(hash >> 24) & (slots_.size() - 1); }
    /// Puts all numbers into a table of this size, a power of two.
    void spread(std::size_t size, const std::vector<V>& list) {
        std::vector<Slot> old(size);
        old.swap(slots_);
        TimeCheck check;
        for (const Slot& moved : old) {
            check();
            if (moved.number == kEmpty) continue;
            const std::uint64_t hash = hash_of(bits(list[moved.number]));
            std::size_t slot = first_slot(hash);
            while (slots_[slot].number != kEmpty) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = {moved.number, static_cast<std::uint32_t>(hash)};
        }
    }

    struct Slot {
        std::uint32_t number = kEmpty;
        std::uint32_t tag = 0;  ///< part of the hash: others are rarely looked up
    };
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
    std::uint64_t finds_ = 0, steps_ = 0;
    std::uint64_t secret_[4] = {0x9E3779B97F4A7C15u, 0xD6E8FEB86659FD93u, 0xA0761D6478BD642Fu, 0xE7037ED1A0B428DBu};
};

}  // namespace halflit
