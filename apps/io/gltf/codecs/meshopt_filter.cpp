#include "apps/io/gltf/codecs/meshopt_filter.hpp"

#include "apps/io/files/little_endian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace halflit::io::detail {

namespace {

/// Component `c` of an element of integers T.
template <class T>
T get(std::span<const std::byte> element, std::size_t c) {
    const std::uint32_t bits = sizeof(T) == 1 ? byte_at(element, c) : sizeof(T) == 2 ? u16_at(element, 2 * c) : u32_at(element, 4 * c);
    return static_cast<T>(bits);
}

/// Stores the low bits of a value.
template <class T>
void set(std::span<std::byte> element, std::size_t c, std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) element[sizeof(T) * c + i] = static_cast<std::byte>(bits >> 8 * i & 255u);
}

/// Nearest integer; halves away from zero. Requires: |v| < 2^31.
std::int32_t rounded(float v) { return static_cast<std::int32_t>(v + (v >= 0.0f ? 0.5f : -0.5f)); }

/// x and y of a point on an octahedron, and 1 in the same units, become a vector of length 1 as normalised integers.
template <class T>
void filter_octahedral(std::span<std::byte> element) {
    constexpr float kOne = sizeof(T) == 1 ? 127.0f : 32767.0f;
    float x = get<T>(element, 0), y = get<T>(element, 1);
    const float z = (static_cast<float>(get<T>(element, 2)) - std::fabs(x)) - std::fabs(y);
    const float fold = z >= 0.0f ? 0.0f : z;  // the lower half is folded outwards
    x += x >= 0.0f ? fold : -fold;
    y += y >= 0.0f ? fold : -fold;
    const float length = std::sqrt((x * x + y * y) + z * z);
    const float scale = length > 0.0f ? kOne / length : 0.0f;
    set<T>(element, 0, rounded(x * scale));
    set<T>(element, 1, rounded(y * scale));
    set<T>(element, 2, rounded(z * scale));
}

/// Three components of a unit quaternion and the number of the fourth, which is the largest. The unit is in the upper bits of the last.
void filter_quaternion(std::span<std::byte> element) {
    constexpr float kLargest = 0.70710678118654752f;  // sqrt(1/2), above which no other component can be
    const int last = get<std::int16_t>(element, 3);
    const float unit = kLargest / static_cast<float>(last | 3);
    const float x = static_cast<float>(get<std::int16_t>(element, 0)) * unit, y = static_cast<float>(get<std::int16_t>(element, 1)) * unit,
                z = static_cast<float>(get<std::int16_t>(element, 2)) * unit;
    const float square = ((1.0f - x * x) - y * y) - z * z;
    const float w = std::sqrt(square >= 0.0f ? square : 0.0f);
    const auto largest = static_cast<std::size_t>(last & 3);
    set<std::int16_t>(element, (largest + 1) & 3, rounded(x * 32767.0f));
    set<std::int16_t>(element, (largest + 2) & 3, rounded(y * 32767.0f));
    set<std::int16_t>(element, (largest + 3) & 3, rounded(z * 32767.0f));
    set<std::int16_t>(element, largest, rounded(w * 32767.0f));
}

/// An exponent of 8 bits and a mantissa of 24, both signed, become a float.
void filter_exponential(std::span<std::byte> number) {
    const std::uint32_t bits = u32_at(number, 0);
    const std::int32_t exponent = static_cast<std::int32_t>(bits) >> 24, mantissa = static_cast<std::int32_t>(bits << 8) >> 8;
    const float power = std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23);
    set<std::uint32_t>(number, 0, std::bit_cast<std::int32_t>(power * static_cast<float>(mantissa)));
}

/// Luma, two differences of colours and alpha, all in a unit that alpha's highest bit tells, become RGBA as normalised integers.
template <class T>
void filter_color(std::span<std::byte> element) {
    using Signed = std::make_signed_t<T>;
    constexpr float kOne = sizeof(T) == 1 ? 255.0f : 65535.0f;
    const std::int32_t alpha = get<T>(element, 3);
    std::int32_t unit = alpha;  // all bits below the highest one are set
    for (int shift = 1; shift < 16; shift *= 2) unit |= unit >> shift;
    const float scale = unit > 0 ? kOne / static_cast<float>(unit) : 0.0f;
    const std::int32_t y = get<T>(element, 0), orange = get<Signed>(element, 1), green = get<Signed>(element, 2);
    const std::int32_t rgba[] = {y + orange - green, y + green, y - orange - green, ((alpha << 1) & unit) | (alpha & 1)};
    for (std::size_t c = 0; c < 4; ++c) set<T>(element, c, rounded(std::clamp(static_cast<float>(rgba[c]) * scale, 0.0f, kOne)));
}

}  // namespace

bool fits(file::CompressionFilter filter, std::size_t stride) {
    switch (filter) {
        case file::CompressionFilter::none:
            return true;
        case file::CompressionFilter::octahedral:
        case file::CompressionFilter::color:
            return stride == 4 || stride == 8;
        case file::CompressionFilter::quaternion:
            return stride == 8;
        case file::CompressionFilter::exponential:
            break;
    }
    return stride > 0 && stride % 4 == 0;
}

void apply_filter(file::CompressionFilter filter, std::span<std::byte> data, std::size_t stride) {
    using enum file::CompressionFilter;
    if (filter == none) return;
    const std::size_t step = filter == exponential ? 4 : stride;
    for (std::size_t at = 0; at + step <= data.size(); at += step) {
        const std::span<std::byte> element = data.subspan(at, step);
        switch (filter) {
            case none:
                break;
            case octahedral:
                stride == 4 ? filter_octahedral<std::int8_t>(element) : filter_octahedral<std::int16_t>(element);
                break;
            case quaternion:
                filter_quaternion(element);
                break;
            case exponential:
                filter_exponential(element);
                break;
            case color:
                stride == 4 ? filter_color<std::uint8_t>(element) : filter_color<std::uint16_t>(element);
                break;
        }
    }
}

}  // namespace halflit::io::detail
