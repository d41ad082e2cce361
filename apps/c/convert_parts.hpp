// Shared by both files of conversions.
#pragma once

#include "apps/c/convert.hpp"
#include "apps/c/versioned.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace halflit::c {

/// Threads of a frame, or of loading: more than any machine has.
inline constexpr std::int32_t kMostThreads = 4096;

/// Checks the members of one struct; the first that is out of range is its error.
class Members {
public:
    explicit Members(const char* of) : of_(of) {}
    /// last: the enumeration's last value; they count from 0.
    template <class E>
    void read(std::int32_t given, E last, const char* member, E& to) {
        if (given >= 0 && given <= static_cast<std::int32_t>(last))
            to = static_cast<E>(given);
        else
            wrong(member, "is " + std::to_string(given) + ", expected 0 to " + std::to_string(static_cast<int>(last)));
    }
    /// Requires numbers that are neither infinite nor NaN.
    template <class... Numbers>
    void finite(const char* member, const Numbers&... numbers) {
        if (!(... && all_finite(numbers))) wrong(member, "is not finite");
    }
    /// Requires a number above 0 and below the limit.
    void positive(const char* member, float number, int limit) {
        if (!(number > 0.0f && number < static_cast<float>(limit))) wrong(member, "is not above 0 and below " + std::to_string(limit));
    }
    /// Requires degrees above the horizon, below it negative.
    void elevation(float degrees) {
        if (!(degrees >= -90.0f && degrees <= 90.0f)) wrong("elevation_deg", "is not from -90 to 90");
    }
    /// Requires what halflit_view and halflit_picture_request say of a view to be in range.
    template <class Struct>
    void view(const Struct& read) {
        elevation(read.elevation_deg);
        positive("zoom", read.zoom, 1000000000);
        positive("fov_y_deg", read.fov_y_deg, 180);
        for (const double margin : {read.margin_x, read.margin_y})
            if (!(margin >= 0.0 && margin <= 0.9)) wrong("margin_x or margin_y", "is not from 0 to 0.9");
    }
    void wrong(const char* member, const std::string& what) {
        if (result_) result_ = fail(ErrorCode::usage, std::string(of_) + ": " + member + " " + what);
    }
    [[nodiscard]] const Result<void>& result() const { return result_; }

private:
    static bool all_finite(float number) { return number - number == 0.0f; }
    static bool all_finite(double number) { return number - number == 0.0; }
    template <class T, std::size_t N>
    static bool all_finite(const T (&numbers)[N]) {
        return std::all_of(numbers, numbers + N, [](T number) { return all_finite(number); });
    }
    const char* of_;
    Result<void> result_;
};

[[nodiscard]] inline Lobe lobe(const halflit_lobe& given) { return {given.wrap, given.power, given.normalize != 0}; }
[[nodiscard]] inline halflit_lobe to_c(const Lobe& from) { return {from.wrap, from.power, from.normalize}; }

inline void put(Vec4f v, float to[4]) { to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = v.w; }
[[nodiscard]] inline Vec4f vec4(const float v[4]) { return {v[0], v[1], v[2], v[3]}; }

}  // namespace halflit::c
