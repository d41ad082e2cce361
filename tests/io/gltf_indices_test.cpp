// Indices of a glTF file: none that is out of range is left once the JSON text is read, whatever was said of it.
#include "apps/io/gltf/file/indices.hpp"

#include "apps/io/gltf/file/json.hpp"
#include "apps/io/gltf/file/schema.hpp"
#include "tests/support/schema_files.hpp"

#include "tests/support/catch.hpp"

#include <set>

namespace halflit::io::detail {
namespace {

/// Number of indices with this value among all members of the file.
int count_indices(const nlohmann::json& scene, int value) {
    const std::string text = scene.dump();
    Notes notes;
    file::File file = read_gltf_json(text, {64, 1'000'000}, Budget("test", 1 << 30), notes, true);
    int count = 0;
    for_each_index(file, [&](Target, const int& index) { count += index == value ? 1 : 0; });
    return count;
}

}  // namespace

TEST_CASE("gltf indices: every member that the schema fills is visited", "[io][gltf]") {
    int rows = 0;
    for (const test::IndexRow& row : test::index_rows()) {
        if (!row.stored) continue;
        INFO(row.path);
        nlohmann::json scene = test::scene_of_all_arrays();
        put(scene, row, 0);
        const int before = count_indices(scene, 2);
        put(scene, row, 2);
        CHECK(count_indices(scene, 2) == before + 1);
        ++rows;
    }
    CHECK(rows > 50);
}

TEST_CASE("gltf indices: one that is out of range is gone, or refuses the file", "[io][gltf]") {
    int gone = 0;
    for (const test::IndexRow& row : test::index_rows()) {
        if (!row.stored) continue;
        INFO(row.path);
        nlohmann::json scene = test::scene_of_all_arrays();
        put(scene, row, 12'000'000);
        int left = 0;
        try {
            left = count_indices(scene, 12'000'000);
            ++gone;
        } catch (const LoadFailure&) {  // of the graph of the nodes
        }
        CHECK(left == 0);
    }
    CHECK(gone > 50);
}

TEST_CASE("gltf indices: an element that is not there is refused where it is looked up", "[io][gltf]") {
    std::vector<int> list{5, 6};
    CHECK(element(list, 1, "numbers") == 6);
    for (const int bad : {-1, 2, 2147483647}) CHECK_THROWS_AS(element(list, bad, "numbers"), LoadFailure);
}

TEST_CASE("gltf indices: no object of the schema has more members than a mask has bits", "[io][gltf]") {
    std::set<const SchemaNode*> seen;
    std::vector<const SchemaNode*> left{&gltf_schema()};
    while (!left.empty()) {
        const SchemaNode* node = left.back();
        left.pop_back();
        if (node == nullptr || !seen.insert(node).second) continue;
        CHECK(node->members.size() <= 32);
        left.push_back(node->every);
        for (const auto& member : node->members) left.push_back(member.second);
    }
    CHECK(seen.size() > 100);
}

}  // namespace halflit::io::detail
