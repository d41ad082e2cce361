// Structs of halflit.h in memory of exactly their size, which may be that of an older or a newer version, or none at all.
#pragma once

#include "tests/fuzz/input.hpp"

#include "halflit/halflit.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

namespace halflit::fuzz {

template <class T>
class Sized {
public:
    /// Sizes of other versions, and wrong ones, are seldom.
    explicit Sized(Input& input) {
        switch (input.below(24)) {
            case 0:
                size_ = sizeof(T) - 4 * (input.below(sizeof(T) / 4) + 1);
                break;
            case 1:
                size_ = sizeof(T) + 8 * input.below(9);
                break;
            case 2:
                size_ = input.number<std::uint16_t>();
                break;
            case 3:
                size_ = input.number<std::size_t>();
                break;
            default:
                size_ = sizeof(T);
        }
        // A size beyond what a version may have is refused before anything but the size is read.
        const std::size_t most = sizeof(T) + 4096;
        bytes_ = size_ < sizeof(std::size_t) ? sizeof(std::size_t) : size_ <= most ? size_ : sizeof(std::size_t);
        memory_.reset(new unsigned char[bytes_]());
        std::memcpy(memory_.get(), &size_, sizeof size_);
    }
    T* get() { return reinterpret_cast<T*>(memory_.get()); }
    [[nodiscard]] std::size_t size() const { return size_; }

    /// Sets a member, or the part of it that is within the size.
    template <class Member, class Value>
    void set(Member T::*member, const Value& value) {
        static const T example{};
        const auto offset = static_cast<std::size_t>(reinterpret_cast<const unsigned char*>(&(example.*member)) -
                                                     reinterpret_cast<const unsigned char*>(&example));
        if (offset >= bytes_) return;
        Member typed{};
        static_assert(sizeof(Value) == sizeof(Member) || !std::is_array_v<Member>);
        if constexpr (std::is_array_v<Member>)
            std::memcpy(&typed, &value, sizeof typed);
        else
            typed = static_cast<Member>(value);
        std::memcpy(memory_.get() + offset, &typed, std::min(sizeof typed, bytes_ - offset));
    }
    /// Any bytes somewhere behind the size.
    void damage(Input& input, std::size_t first) {
        if (bytes_ <= first) return;
        const std::size_t at = first + input.number<std::uint16_t>() % (bytes_ - first);
        memory_[at] = input.byte();
    }

private:
    std::size_t size_ = 0, bytes_ = 0;
    std::unique_ptr<unsigned char[]> memory_;
};

}  // namespace halflit::fuzz
