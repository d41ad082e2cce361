#include "apps/engine/request/values.hpp"
#include "apps/engine/basics/printable.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

using namespace halflit;
using namespace halflit::engine;

namespace {

/// The transfer function as the standard writes it, by the C library.
double srgb_decoded(int code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("values: every sRGB code is decoded as the standard says", "[cli][values]") {
    for (int code = 0; code < 256; ++code) {
        char text[8];
        std::snprintf(text, sizeof text, "#%02x%02x%02x", code, code, code);
        const auto color = parse_color(text);
        REQUIRE(color);
        INFO(text);
        CHECK(color->x == static_cast<float>(srgb_decoded(code)));
        CHECK(color->w == 1.0f);
    }
}

TEST_CASE("values: short and long colours agree, and others are refused", "[cli][values]") {
    CHECK(*parse_color("#f80") == *parse_color("#ff8800"));
    CHECK(*parse_color("#ff8800ff") == *parse_color("#ff8800"));
    CHECK(*parse_color("#f80c") == *parse_color("#ff8800cc"));
    CHECK(*parse_color("White") == Vec4f{1, 1, 1, 1});
    CHECK(*parse_color("transparent") == Vec4f{0, 0, 0, 0});
    for (const char* bad : {"", "#", "#12", "#12345", "#1234567", "#ggg", "#-12", "#+12345", "#0x123", "whit", "#ffffff "}) {
        INFO(bad);
        CHECK(!parse_color(bad));
    }
}

TEST_CASE("values: a number must be all of the text, finite and in range", "[cli][values]") {
    CHECK(*parse_float("+1.5e1", 0, 100) == 15.0f);
    CHECK(*parse_int("-3", -5, 5) == -3);
    for (const char* bad : {"", " 1", "1 ", "1,5", "0x10", "nan", "inf", "1e99", "--1", "+-1", "1.5.2"}) {
        INFO(bad);
        CHECK(!parse_float(bad, -100, 100));
        CHECK(!parse_int(bad, -100, 100));
    }
    CHECK(!parse_int("99999999999999999999", 0, std::numeric_limits<std::int64_t>::max()));
    CHECK(!parse_float("1.0001", 0, 1));
}

TEST_CASE("values: a size is two sides, or the one of a square", "[cli][values]") {
    const auto wide = parse_size("1280x720"), comma = parse_size("1280,720"), square = parse_size("256");
    REQUIRE(wide);
    REQUIRE(comma);
    REQUIRE(square);
    CHECK(comma->width == 1280);
    CHECK(comma->height == 720);
    CHECK(wide->width == 1280);
    CHECK(wide->height == 720);
    CHECK(square->width == 256);
    CHECK(square->height == 256);
    for (const char* bad : {"", "x", "8x", "x8", "8x8x8", "0", "-1", "8 x 8", "1.5"}) {
        INFO(bad);
        CHECK(!parse_size(bad));
    }
}

TEST_CASE("values: a light's keys come in any order, with colons or semicolons", "[cli][values]") {
    const auto a = parse_light("spot:pos=1,2,3:dir=0,0,-2:cone=10,30:color=#fff:intensity=4:range=9:radius=0.5");
    const auto b = parse_light("spot;intensity=4;radius=0.5;range=9;cone=10,30;dir=0,0,-2;color=white;pos=1,2,3");
    REQUIRE(a);
    REQUIRE(b);
    CHECK(a->light.type == LightType::spot);
    CHECK(a->light.position_ws == Vec3f{1, 2, 3});
    CHECK(a->position == Vec3d{1, 2, 3});
    CHECK(a->light.direction_ws == Vec3f{0, 0, -1});
    CHECK(a->light.color_linear == Vec3f{4, 4, 4});
    CHECK(a->light.range == 9.0f);
    CHECK(a->light.source_radius == 0.5f);
    CHECK(static_cast<double>(a->light.inner_cone_rad) == Approx(10 * 3.14159265358979 / 180));
    CHECK(static_cast<double>(a->light.outer_cone_rad) == Approx(30 * 3.14159265358979 / 180));
    CHECK(b->light.position_ws == a->light.position_ws);
    CHECK(b->light.direction_ws == a->light.direction_ws);
    CHECK(b->light.color_linear == a->light.color_linear);
    CHECK(b->light.outer_cone_rad == a->light.outer_cone_rad);
    CHECK(parse_light("point:pos=1000000000.5,0,-1e38")->position == Vec3d{1000000000.5, 0, -1e38});  // not rounded to float
    for (const char* bad : {"", "lamp", "point:cone=3", "directional:pos=0,0,0", "spot:cone=1,2,3", "spot:cone=91", "point:pos",
                            "point:pos=1,2", "point:intensity=-1", "point:color=12", "point:", "point:shine=1"}) {
        INFO(bad);
        CHECK(!parse_light(bad));
    }
}

TEST_CASE("messages: controls and broken UTF-8 are escaped, all else is kept", "[cli][values]") {
    CHECK(printable("plain caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80") == "plain caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    CHECK(printable("a\x1b[2Jb\nc\x7f") == "a\\x1b[2Jb\\x0ac\\x7f");
    CHECK(printable("\xc2\x9b") == "\\xc2\\x9b");           // C1: a terminal takes it for ESC [
    CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");           // overlong
    CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");  // surrogate
    // Marks of direction and format: U+202E, U+2066, U+200B, U+FEFF, U+2028, U+00AD, U+E0001.
    for (const std::string mark :
         {"\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x80\x8b", "\xef\xbb\xbf", "\xe2\x80\xa8", "\xc2\xad", "\xf3\xa0\x80\x81"}) {
        const std::string shown = printable("a" + mark + "b");
        CHECK(shown.size() == 2 + 4 * mark.size());
        CHECK(shown.find(mark) == std::string::npos);
    }
    CHECK(printable("\xe2\x80\xa2 \xe2\x80\xb2") == "\xe2\x80\xa2 \xe2\x80\xb2");  // their neighbours: a bullet, a prime
    CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");                // above U+10FFFF
    CHECK(printable("\xe2\x82") == "\\xe2\\x82");                                  // cut off
    CHECK(printable(std::string_view("\0", 1)) == "\\x00");
}
