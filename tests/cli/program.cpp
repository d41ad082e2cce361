#include "tests/cli/program.hpp"

#include "apps/io/pictures/image_reader.hpp"
#include "halflit/image.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

namespace halflit::test {

Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings) {
    std::vector<std::string> words = {HALFLIT_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words, settings);
}

void write_contents(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<int> Picture::pixel(int x, int y) const {
    const auto first = rgba8.begin() + 4 * (std::ptrdiff_t{y} * width + x);
    return {first, first + 4};
}

Picture read_picture(const std::string& file_contents) {
    const auto decoded = io::decode_image(std::as_bytes(std::span(file_contents)));
    REQUIRE(decoded);
    return {decoded->width, decoded->height, decoded->rgba8};
}

std::string png_of(int width, int height, std::vector<unsigned char> rgba8) {
    const auto bytes = encode_image({width, height, std::move(rgba8), {}}, OutputFormat::png);
    REQUIRE(bytes);
    return {bytes->begin(), bytes->end()};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> words_of_line(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    std::string word;
    stream >> word;
    while (stream >> word) {
        std::erase(word, '\'');
        words.push_back(word);
    }
    return words;
}

std::vector<nlohmann::json> json_lines(const std::string& text) {
    std::vector<nlohmann::json> values;
    for (const std::string& line : lines_of(text)) values.push_back(nlohmann::json::parse(line));
    return values;
}

void write_triangle(const std::string& path, const std::string& scale) {
    write_contents(path, R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[)" + scale + R"(]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}]})");
}

}  // namespace halflit::test
