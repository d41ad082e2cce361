// Encoding of linear light as 8-bit sRGB codes.
#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

std::vector<std::uint32_t> encode(const std::vector<float>& values, float exposure = 1.0f) {
    std::vector<std::uint32_t> out(values.size());
    shade_kernels(Isa::scalar)
        .encode_srgb8(values.data(), values.data(), values.data(), values.data(), exposure, out.data(), static_cast<int>(values.size()));
    return out;
}

}  // namespace

TEST_CASE("color: a code is at most 0.501 from the exact sRGB value, and codes never fall", "[shading][color]") {
    std::vector<float> values;
    for (std::uint32_t i = 0; i <= std::bit_cast<std::uint32_t>(1.0f); i += 509) values.push_back(std::bit_cast<float>(i));
    while (values.size() % 16 != 0) values.push_back(1.0f);
    const std::vector<std::uint32_t> codes = encode(values);
    double worst = 0;
    std::uint32_t previous = 0;
    int falls = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t code = codes[i] & 255u;
        worst = std::max(worst, std::fabs(code - reference::srgb_code(values[i])));
        falls += code < previous;
        previous = code;
    }
    CHECK(values.size() > 2000000);
    CHECK(worst <= 0.501);
    CHECK(falls == 0);
}

TEST_CASE("color: alpha is linear, rounded to nearest", "[shading][color]") {
    std::vector<float> values;
    for (int i = 0; i < 4096; ++i) values.push_back(static_cast<float>(i) / 4095.0f);
    const std::vector<std::uint32_t> codes = encode(values);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::fabs((codes[i] >> 24) - 255.0 * static_cast<double>(values[i])) > 0.50001) FAIL("alpha " << values[i]);
    SUCCEED();
}

TEST_CASE("color: values outside [0, 1] are clamped, NaN gives 0", "[shading][color]") {
    const std::vector<float> values{-1.0f, -0.0f,  -kInf,   kNan, -kNan, 1.0f,  1.5f,   kInf,
                                    3e38f, 1e-45f, -1e-45f, 0.0f, 2.0f,  -3.0f, 1e-30f, 0.5f};
    const std::vector<std::uint32_t> codes = encode(values);
    for (const std::size_t i : {0, 1, 2, 3, 4, 9, 10, 11, 13, 14}) CHECK(codes[i] == 0u);
    for (const std::size_t i : {5, 6, 7, 8, 12}) CHECK(codes[i] == 0xffffffffu);
    CHECK(codes[15] == 0x80bcbcbcu);  // 0.5: code 188; alpha 127.5 rounds to even
}

TEST_CASE("color: exposure scales colour and not alpha", "[shading][color]") {
    std::vector<float> half(16, 0.25f);
    CHECK(encode(half, 2.0f)[0] == 0x40bcbcbcu);
}

TEST_CASE("color: channels are packed red first", "[shading][color]") {
    std::vector<float> one(16, 1.0f), zero(16, 0.0f);
    std::vector<std::uint32_t> out(16);
    shade_kernels(Isa::scalar).encode_srgb8(one.data(), zero.data(), zero.data(), one.data(), 1.0f, out.data(), 16);
    CHECK(out[0] == 0xff0000ffu);
    shade_kernels(Isa::scalar).encode_srgb8(zero.data(), one.data(), zero.data(), zero.data(), 1.0f, out.data(), 16);
    CHECK(out[0] == 0x0000ff00u);
}
