// The table of equal positions.
#include "sh/place_table.hpp"
#include "halflit/math.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <limits>
#include <map>
#include <tuple>

using namespace halflit;

TEST_CASE("place table: equal positions have the number of the first one, as a map has it", "[sh]") {
    test::Random random(5);
    PlaceTable<Vec3f> table;
    std::vector<Vec3f> list;
    std::map<std::tuple<float, float, float>, std::uint32_t> known;
    const auto coordinate = [&] { return static_cast<float>(random.index(40) - 20) * 0.25f; };
    for (int i = 0; i < 200'000; ++i) {
        const Vec3f p{coordinate(), coordinate(), coordinate()};
        const auto entry = known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(list.size())).first;
        if (table.add(p, list) != entry->second) FAIL("a number differs");
    }
    CHECK(list.size() == known.size());
}

TEST_CASE("place table: the zeros are one place, and so is a NaN", "[sh]") {
    PlaceTable<Vec3f> table;
    std::vector<Vec3f> list;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(table.add({0, 1, 2}, list) == 0);
    CHECK(table.add({-0.0f, 1, 2}, list) == 0);
    CHECK(table.add({nan, 1, 2}, list) == 1);
    CHECK(table.add({nan, 1, 2}, list) == 1);
    CHECK(table.add({nan, 1, 3}, list) == 2);
}

TEST_CASE("place table: positions that differ in few bits take no longer than others", "[sh]") {
    const auto check = [](const auto& position_of) {
        PlaceTable<Vec3d> table;
        std::vector<Vec3d> list;
        for (std::uint64_t i = 0; i < 300'000; ++i)
            if (table.add(position_of(i), list) != i) FAIL("a number differs");
        CHECK(table.add(list[1000], list) == 1000);
    };
    check([](std::uint64_t i) { return Vec3d{static_cast<double>(i), 0, 0}; });
    check([](std::uint64_t i) { return Vec3d{0, static_cast<double>(i), 0}; });
    check([](std::uint64_t i) { return Vec3d{7, 7, static_cast<double>(i)}; });
    // They differ in the highest and in the lowest bits of two coordinates.
    check([](std::uint64_t i) { return Vec3d{std::bit_cast<double>(i % 600 << 50), std::bit_cast<double>(i / 600 << 40 | 1), 0}; });
}
