#include "halflit/target.hpp"

#include "tests/support/catch.hpp"

#include <set>
#include <string>
#include <vector>

using namespace halflit;

namespace {

std::uint64_t hash_of(const std::string& text) { return pixel_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }

}  // namespace

TEST_CASE("pixel hash: gives the published XXH64 values", "[raster][hash]") {
    CHECK(hash_of("") == 0xef46db3751d8e999u);
    CHECK(hash_of("a") == 0xd24ec4f1a98c6e5bu);
    CHECK(hash_of("abc") == 0x44bc2cf5ad770999u);
    CHECK(hash_of("Nobody inspects the spammish repetition") == 0xfbcea83c8a378bf1u);  // 39 bytes: the four lanes and every tail step
}

TEST_CASE("pixel hash: every byte and the length count", "[raster][hash]") {
    std::vector<std::uint8_t> bytes(131, 0);
    std::set<std::uint64_t> seen;
    for (std::size_t n = 0; n <= bytes.size(); ++n) seen.insert(pixel_hash({bytes.data(), n}));
    CHECK(seen.size() == bytes.size() + 1);
    for (std::uint8_t& byte : bytes) {
        byte = 1;
        seen.insert(pixel_hash(bytes));
        byte = 0;
    }
    CHECK(seen.size() == 2 * bytes.size() + 1);
}
