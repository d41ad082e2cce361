// Parts of the C++ standard library that libc++ lacks: floating from_chars before version 20, jthread before 18, more in Emscripten 3.1.6,
// whose libc++ is of 2021. Where one is missing, the build includes this file ahead of each source (cmake/libraries.cmake), so that the
// sources need no cases of their own. Each part goes once the library has it.
#pragma once

#include <locale.h>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>
#if defined(__APPLE__)
#include <xlocale.h>
#endif

namespace std {

#ifndef __cpp_lib_bit_cast
template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>) [[nodiscard]] constexpr To
    bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}
#endif

#ifndef __cpp_lib_atomic_ref
template <class T>
class atomic_ref {
public:
    explicit atomic_ref(T& value) : value_(&value) {}
    void store(T value, memory_order order = memory_order_seq_cst) const noexcept {
        __atomic_store(value_, &value, static_cast<int>(order));
    }
    [[nodiscard]] T load(memory_order order = memory_order_seq_cst) const noexcept {
        T value;
        __atomic_load(value_, &value, static_cast<int>(order));
        return value;
    }

private:
    T* value_;
};
#endif

#ifndef __cpp_lib_jthread
/// Without stop tokens, which the project does not use.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
class jthread {  // there are no threads, so the function is called at once
public:
    template <class F, class... Args>
    explicit jthread(F&& f, Args&&... args) {
        std::forward<F>(f)(std::forward<Args>(args)...);
    }
};
#else
class jthread : public thread {
public:
    using thread::thread;
    jthread() noexcept = default;
    jthread(jthread&&) = default;
    jthread& operator=(jthread&& other) noexcept {
        if (joinable()) join();
        thread::operator=(std::move(other));
        return *this;
    }
    ~jthread() {
        if (joinable()) join();
    }
};
#endif
#endif

#ifndef __cpp_lib_smart_ptr_for_overwrite
template <class T>
requires(is_array_v<T>) [[nodiscard]] unique_ptr<T> make_unique_for_overwrite(size_t count) {
    return unique_ptr<T>(new remove_extent_t<T>[count]);
}
#endif

#if !defined(__cpp_lib_to_chars)
/// The fewest digits that give the same number again, as the standard asks. `%g` writes an exponent where it is shorter or the number has
/// more digits than that; the standard's rule differs for some numbers from 1e5 on.
template <class T>
requires(is_floating_point_v<T>) to_chars_result to_chars(char* first, char* last, T value) {
    char text[40];
    int length = 0;
    for (int digits = 1; digits <= 17; ++digits) {
        length = snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(value));
        if (static_cast<T>(strtod(text, nullptr)) == value) break;
    }
    if (length > last - first) return {last, errc::value_too_large};
    memcpy(first, text, static_cast<size_t>(length));
    return {first + length, errc{}};
}

/// As `%.*g`, which is what the standard says of chars_format::general; other formats are not there.
template <class T>
requires(is_floating_point_v<T>) to_chars_result to_chars(char* first, char* last, T value, chars_format, int precision) {
    char text[64];
    const int length = snprintf(text, sizeof text, "%.*g", precision, static_cast<double>(value));
    if (length >= static_cast<int>(sizeof text) || length > last - first) return {last, errc::value_too_large};
    memcpy(first, text, static_cast<size_t>(length));
    return {first + length, errc{}};
}

/// The nearest number, by the C library in the locale "C"; its rounding is exact. Takes what the standard takes for
/// chars_format::general.
template <class T>
requires(is_floating_point_v<T>) from_chars_result
    from_chars(const char* first, const char* last, T& value, chars_format = chars_format::general) {
    const char* end = first;
    const auto digits = [&] {
        const char* const start = end;
        while (end != last && *end >= '0' && *end <= '9') ++end;
        return end - start;
    };
    if (end != last && *end == '-') ++end;
    const T sign = end == first ? T{1} : T{-1};
    const auto takes = [&](const char* word) {
        const char* at = end;
        for (; *word != 0; ++word, ++at)
            if (at == last || (*at | 0x20) != *word) return false;
        end = at;
        return true;
    };
    if (takes("infinity") || takes("inf")) {
        value = sign * numeric_limits<T>::infinity();
        return {end, errc{}};
    }
    if (takes("nan")) {
        value = numeric_limits<T>::quiet_NaN();
        const char* at = end;
        if (at != last && *at == '(')
            for (++at; at != last && ((*at >= '0' && *at <= '9') || ((*at | 0x20) >= 'a' && (*at | 0x20) <= 'z') || *at == '_');) ++at;
        if (at != last && *at == ')') end = at + 1;
        return {end, errc{}};
    }
    auto count = digits();
    if (end != last && *end == '.') {
        ++end;
        count += digits();
    }
    if (count == 0) return {first, errc::invalid_argument};
    if (const char* const mantissa = end; end != last && (*end == 'e' || *end == 'E')) {
        ++end;
        if (end != last && (*end == '+' || *end == '-')) ++end;
        if (digits() == 0) end = mantissa;
    }
    const string text(first, end);
    static const locale_t in_c = newlocale(LC_ALL_MASK, "C", nullptr);
    T read;
    if constexpr (is_same_v<T, float>)
        read = strtof_l(text.c_str(), nullptr, in_c);
    else
        read = strtod_l(text.c_str(), nullptr, in_c);
    const bool zero = text.substr(0, text.find_first_of("eE")).find_first_of("123456789") == string::npos;
    if (read - read != 0 || (read == 0 && !zero)) return {end, errc::result_out_of_range};
    value = read;
    return {end, errc{}};
}
#endif

}  // namespace std
