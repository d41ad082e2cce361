// Writes files with an index out of range, for each index of the schema: seeds of the targets gltf_text and glb, and a list of them in the
// form that tests/gltf_rules/check_files.cpp reads.
//   halflit_schema_seeds FOLDER
#include "tests/support/schema_files.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

void write(const std::filesystem::path& path, const std::string& bytes) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
}

std::string glb_of(std::string text) {
    while (text.size() % 4 != 0) text += ' ';
    std::string out = "glTF";
    const auto number = [&](std::size_t value) {
        for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(value >> (8 * byte));
    };
    number(2);
    number(20 + text.size());
    number(text.size());
    return out + "JSON" + text;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("usage: halflit_schema_seeds FOLDER\n", stderr), 2;
    const std::filesystem::path folder = argv[1];
    std::string list;
    int number = 0;
    for (const halflit::test::IndexRow& row : halflit::test::index_rows())
        for (const std::int64_t value : {std::int64_t{3}, std::int64_t{12'000'000}, std::int64_t{2147483646}}) {
            nlohmann::json scene = halflit::test::scene_of_all_arrays();
            put(scene, row, value);
            const std::string name = "index_" + std::to_string(number++), text = scene.dump();
            write(folder / "gltf_text" / name, text);
            write(folder / "glb" / name, glb_of(text));
            list += (folder / "gltf_text" / name).string() + "\tseen\tan index out of range: " + row.path + "\t\t\n";
        }
    write(folder / "indices.tsv", list);
    std::printf("%d files\n", number);
    return number > 100 ? 0 : 1;
}
