// The parts of meshopt compression that are computed here: version 1 of the vertex codec, and the filters.
#include "tests/io/meshopt_encoder.hpp"

#include "apps/io/gltf/codecs/meshopt_filter.hpp"
#include "apps/io/gltf/codecs/meshopt_vertices.hpp"

#include <cstdlib>

#if HALFLIT_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

using namespace halflit;
using namespace halflit::test;
using io::detail::file::CompressionFilter;

namespace {

/// Smooth data with noise here and there, as vertices have.
Bytes elements(std::size_t count, std::size_t stride, Engine& random) {
    Bytes out(count * stride);
    std::vector<unsigned> value(stride);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < stride; ++k) {
            if (k % 3 != 1 || i / 40 % 2 == 0) value[k] += random() % 3 == 0 ? random() % 5 - 2 : i / 64 % 3 == 1 ? random() : 0;
            out[i * stride + k] = static_cast<std::byte>(value[k]);
        }
    return out;
}

}  // namespace

TEST_CASE("meshopt: version 1 of the vertex codec gives back what an encoder by its specification wrote", "[io]") {
    Engine random(3);
    for (const std::size_t stride : {4u, 8u, 12u, 16u, 64u, 256u})
        for (const std::size_t count : {1u, 15u, 16u, 17u, 200u, 256u, 257u, 1000u}) {
            const Bytes data = elements(count, stride, random);
            const Bytes file = encode_vertices_1(data, stride, random);
            Bytes out(data.size());
            CHECK(io::detail::decode_vertices_1(file, out, stride));
            CHECK(out == data);
            for (int i = 0; i < 20; ++i) {  // never reads past the end, and never takes a part for the whole
                const Bytes exact(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(random() % file.size()));
                if (!io::detail::decode_vertices_1(exact, out, stride)) continue;
                CHECK(out != data);
            }
        }
}

TEST_CASE("meshopt filters: exact values of the specification's formulas", "[io]") {
    const auto filtered = [](CompressionFilter filter, Bytes data, std::size_t stride) {
        io::detail::apply_filter(filter, data, stride);
        return data;
    };
    const auto bytes = [](std::initializer_list<std::int8_t> list) {
        Bytes out;
        append<std::int8_t>(out, list);
        return out;
    };
    const auto shorts = [](std::initializer_list<std::int16_t> list) {
        Bytes out;
        append<std::int16_t>(out, list);
        return out;
    };
    using enum CompressionFilter;
    // The six directions of the axes, with 1 stored as 127 and as 7.
    CHECK(filtered(octahedral, bytes({0, 0, 127, 5, 127, 0, 127, 6, 0, -127, 127, 7, 127, 127, 127, 8}), 4) ==
          bytes({0, 0, 127, 5, 127, 0, 0, 6, 0, -127, 0, 7, 0, 0, -127, 8}));
    CHECK(filtered(octahedral, shorts({-7, 0, 7, -3, 0, 0, 7, 9}), 8) == shorts({-32767, 0, 0, -3, 0, 0, 32767, 9}));
    CHECK(filtered(octahedral, bytes({0, 0, 0, 0}), 4) == bytes({0, 0, 0, 0}));
    // A quaternion of four components 1/2: stored ones are 1/2 / sqrt(1/2) of the unit, 2047 | 3.
    for (std::int16_t largest = 0; largest < 4; ++largest) {
        const auto last = static_cast<std::int16_t>(2044 | largest);
        const Bytes out = filtered(quaternion, shorts({1447, 1447, 1447, last}), 8);
        for (std::size_t c = 0; c < 4; ++c) {
            std::int16_t value;
            std::memcpy(&value, &out[2 * c], 2);
            CHECK(std::abs(value - 16384) < 16);  // 32767 / 2047 is the unit's size
        }
    }
    for (std::int16_t largest = 0; largest < 4; ++largest) {  // the component that was left out goes to its place
        const Bytes out = filtered(quaternion, shorts({0, 0, 0, static_cast<std::int16_t>(2044 | largest)}), 8);
        for (int c = 0; c < 4; ++c) {
            std::int16_t value;
            std::memcpy(&value, &out[static_cast<std::size_t>(2 * c)], 2);
            CHECK(value == (c == largest ? 32767 : 0));
        }
    }
    // 3 * 2^-1, -5 * 2^4, 1 * 2^0
    Bytes numbers, floats;
    append<std::uint32_t>(numbers, {0xff000003u, 0x04fffffbu, 1u});
    append<float>(floats, {1.5f, -80.0f, 1.0f});
    CHECK(filtered(exponential, numbers, 12) == floats);
    // y, co, cg of white, red and a half-opaque black; 8-bit units of 127.
    CHECK(filtered(color, bytes({127, 0, 0, 127}), 4) == bytes({-1, -1, -1, -1}));
    const Bytes red = filtered(color, bytes({32, 64, -31, 127}), 4);  // r = 127, g = 1, b = -1
    CHECK(red == bytes({-1, 2, 0, -1}));
}

#if HALFLIT_HAS_MESHOPT

TEST_CASE("meshopt: filters differ from the library's by its rounding alone", "[io]") {
    // All 8-bit directions with 1 stored as 127, and 16-bit ones at random.
    Bytes own, theirs;
    for (int x = -127; x <= 127; ++x)
        for (int y = -127; y <= 127; ++y) append<std::int8_t>(own, {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), 127, 1});
    while (own.size() % 16 != 0) append<std::int8_t>(own, {0, 0, 127, 1});
    theirs = own;
    io::detail::apply_filter(CompressionFilter::octahedral, own, 4);
    meshopt_decodeFilterOct(theirs.data(), theirs.size() / 4, 4);
    int most = 0;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const int d = std::abs(static_cast<std::int8_t>(own[i]) - static_cast<std::int8_t>(theirs[i]));
        most = std::max(most, d);
        differ += d > 0;
    }
    INFO("of " << own.size() << " bytes differ " << differ);
    CHECK(most <= 1);

    Engine random(5);
    for (const CompressionFilter filter : {CompressionFilter::octahedral, CompressionFilter::quaternion}) {
        Bytes a;
        for (int i = 0; i < 40000; ++i) {
            const auto part = [&](int most_part) {
                return static_cast<std::int16_t>(static_cast<int>(random() % static_cast<unsigned>(2 * most_part + 1)) - most_part);
            };
            if (filter == CompressionFilter::octahedral)
                append<std::int16_t>(a, {part(32767), part(32767), 32767, 1});
            else
                append<std::int16_t>(a, {part(1000), part(1000), part(1000), static_cast<std::int16_t>(2044 | random() % 4)});
        }
        Bytes b = a;
        io::detail::apply_filter(filter, a, 8);
        if (filter == CompressionFilter::octahedral)
            meshopt_decodeFilterOct(b.data(), b.size() / 8, 8);
        else
            meshopt_decodeFilterQuat(b.data(), b.size() / 8, 8);
        most = 0;
        for (std::size_t i = 0; i < a.size(); i += 2) {
            std::int16_t u, v;
            std::memcpy(&u, &a[i], 2), std::memcpy(&v, &b[i], 2);
            most = std::max(most, std::abs(u - v));
        }
        CHECK(most <= 1);
    }
    Bytes a;
    for (int i = 0; i < 40000; ++i) append<std::uint32_t>(a, {random() << 8 >> 8 | (random() % 200 - 100u) << 24});
    Bytes b = a;
    io::detail::apply_filter(CompressionFilter::exponential, a, 4);
    meshopt_decodeFilterExp(b.data(), b.size() / 4, 4);
    CHECK(a == b);
}

#endif
