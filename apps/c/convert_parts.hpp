// What both files of conversions use.
#pragma once

#include "apps/c/convert.hpp"
#include "apps/c/versioned.hpp"

#include <cstdint>
#include <string>

namespace halflit::c {

/// Reads the enumerations of one struct; the first value out of range is its error.
class Choices {
public:
    explicit Choices(const char* of) : of_(of) {}
    /// last: the enumeration's last value; they count from 0.
    template <class E>
    void read(std::int32_t given, E last, const char* member, E& to) {
        if (given >= 0 && given <= static_cast<std::int32_t>(last))
            to = static_cast<E>(given);
        else if (result_)
            result_ = fail(ErrorCode::usage, std::string(of_) + ": " + member + " is " + std::to_string(given) + ", expected 0 to " +
                                                 std::to_string(static_cast<int>(last)));
    }
    [[nodiscard]] const Result<void>& result() const { return result_; }

private:
    const char* of_;
    Result<void> result_;
};

[[nodiscard]] inline Lobe lobe(const halflit_lobe& given) { return {given.wrap, given.power, given.normalize != 0}; }
[[nodiscard]] inline halflit_lobe to_c(const Lobe& from) { return {from.wrap, from.power, from.normalize}; }

inline void put(Vec4f v, float to[4]) { to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = v.w; }
[[nodiscard]] inline Vec4f vec4(const float v[4]) { return {v[0], v[1], v[2], v[3]}; }

}  // namespace halflit::c
