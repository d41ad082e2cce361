#include "apps/engine/request/values.hpp"
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <numbers>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

nlohmann::json report_of(std::vector<std::string> flags) {
    const TemporaryFolder folder;
    flags.insert(flags.end(), {folder.file("a.png"), "--size", "64", "--report", "-"});
    const Outcome outcome = run(std::move(flags));
    REQUIRE(outcome.code == 0);
    return nlohmann::json::parse(outcome.out);
}

}  // namespace

TEST_CASE("section flag: an axis, its opposite, a share and four numbers are planes", "[cli][section]") {
    const auto below = parse_section("x=0.5"), above = parse_section("-Y=0.5"), share = parse_section("-z=25%"),
               free = parse_section("1,-2,0.5,3");
    REQUIRE((below && above && share && free));
    CHECK(below->normal == Vec3d{1, 0, 0});
    CHECK(below->offset == 0.5);
    CHECK(above->normal == Vec3d{0, -1, 0});
    CHECK(above->offset == -0.5);
    CHECK(share->is_share);
    CHECK(share->offset == 0.25);
    CHECK(free->normal == Vec3d{1, -2, 0.5});
    CHECK(free->offset == 3.0);
    for (const char* wrong : {"", "x", "x=", "w=1", "x=1e99", "x=101%", "1,2,3", "0,0,0,1", "x=nan", "=1", "1,2,3,4,5"}) {
        INFO(wrong);
        CHECK_FALSE(parse_section(wrong));
    }
}

TEST_CASE("section flag: the report has the areas, and both sides have the same", "[cli][section]") {
    for (const char* plane : {"x=0.25", "--section=-x=0.25"}) {
        std::vector<std::string> flags{"sphere:20000"};
        if (plane[0] == '-')
            flags.emplace_back(plane);
        else
            flags.insert(flags.end(), {"--section", plane});
        flags.emplace_back("-o");
        const auto report = report_of(flags);
        REQUIRE(report["sections"].size() == 1);
        CHECK(report["sections"][0]["closed"] == true);
        // The circle around the middle of the unit sphere at 0.25; its polygon is a little smaller.
        CHECK(report["sections"][0]["area"].get<double>() == Approx(std::numbers::pi * (1.0 - 0.0625)).epsilon(2e-3));
    }
    CHECK_FALSE(report_of({"sphere:500", "-o"}).contains("sections"));
    const auto outside = report_of({"sphere:500", "--section", "y=2", "-o"});
    CHECK_FALSE(outside.contains("sections"));
    CHECK(outside["warnings"].size() == 1);
}

TEST_CASE("section flag: a middle plane and the plane at the centre draw the same picture", "[cli][section]") {
    CHECK(report_of({"sphere:500", "--section", "x=50%", "-o"})["pixel_hash"] ==
          report_of({"sphere:500", "--section", "1,0,0,0", "-o"})["pixel_hash"]);
}
