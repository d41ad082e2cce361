// Structs whose first member is their size. A struct of another version of halflit.h may be shorter or longer than this library's.
#pragma once

#include "apps/c/boundary.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace halflit::c {

/// Bytes that a later version may plausibly add. A larger size is taken for memory that was never set.
inline constexpr std::size_t kMostAddedBytes = 4096;

/// Fails (usage) if the size is not one that a version of the struct may have.
[[nodiscard]] inline Result<void> check_size(std::size_t size, std::size_t own_size, const char* name) {
    // Every version's size is a multiple of that of a pointer. Any other would cut a pointer into halves.
    if (size >= 2 * sizeof(std::size_t) && size <= own_size + kMostAddedBytes && size % sizeof(void*) == 0) return {};
    return fail(ErrorCode::usage, std::string(name) + ": the member size is " + std::to_string(size) + ", expected sizeof(" + name +
                                      "), which is " + std::to_string(own_size) + " in this version of halflit");
}

// No padding: a member that a later version appends must not lie in what was padding before, which callers do not set.
template <class T, class Last>
constexpr bool ends_with(std::size_t offset, Last T::*) {
    return offset + sizeof(Last) == sizeof(T);
}
#define HALFLIT_ENDS_WITH(type, member) static_assert(ends_with(offsetof(type, member), &type::member))

/// Whether a reserved member, or some, are 0.
[[nodiscard]] constexpr bool is_zero(std::int32_t reserved) { return reserved == 0; }
template <std::size_t N>
[[nodiscard]] constexpr bool is_zero(const std::int32_t (&reserved)[N]) {
    return std::all_of(reserved, reserved + N, [](std::int32_t one) { return one == 0; });
}

/// The caller's struct over `defaults`, which fill what a shorter one lacks. Fails (usage) if a longer one has set what is not known here.
template <class T>
[[nodiscard]] Result<T> read_struct(const T* given, const T& defaults, const char* name) {
    static_assert(std::is_trivially_copyable_v<T> && offsetof(T, size) == 0);
    const std::size_t size = given->size;
    if (auto ok = check_size(size, sizeof(T), name); !ok) return tl::unexpected<Error>(ok.error());
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    if (size > sizeof(T) && std::any_of(bytes + sizeof(T), bytes + size, [](unsigned char byte) { return byte != 0; }))
        return fail(ErrorCode::usage, std::string(name) + ": members beyond byte " + std::to_string(sizeof(T)) +
                                          " are set, which this version of halflit does not know");
    T value = defaults;
    std::memcpy(&value, bytes, std::min(size, sizeof(T)));
    value.size = sizeof(T);
    if constexpr (requires { value.reserved; })
        if (!is_zero(value.reserved)) return fail(ErrorCode::usage, std::string(name) + ": the member reserved is set, expected 0");
    return value;
}

/// Fills the caller's struct of `size` bytes; members that are not known here become 0. Fails (usage) for an impossible size.
template <class T>
[[nodiscard]] Result<void> write_struct(const T& value, std::size_t size, T* to, const char* name) {
    if (auto ok = check_size(size, sizeof(T), name); !ok) return ok;
    auto* bytes = reinterpret_cast<unsigned char*>(to);
    std::memcpy(bytes, &value, std::min(size, sizeof(T)));
    if (size > sizeof(T)) std::memset(bytes + sizeof(T), 0, size - sizeof(T));
    std::memcpy(bytes, &size, sizeof size);
    return {};
}

/// A struct of the caller's array, whose structs have the size that the first one says. Requires: a size that check_size() lets pass.
template <class T>
[[nodiscard]] T* at(T* first, std::int32_t i) {
    using Byte = std::conditional_t<std::is_const_v<T>, const unsigned char, unsigned char>;
    return reinterpret_cast<T*>(reinterpret_cast<Byte*>(first) + static_cast<std::size_t>(i) * first->size);
}

/// Fills the caller's struct, whose size is set.
template <class T>
[[nodiscard]] Result<void> write_struct(const T& value, T* to, const char* name) {
    return write_struct(value, to->size, to, name);
}

}  // namespace halflit::c
