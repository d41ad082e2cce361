#include "tests/cli/program.hpp"

#include "apps/io/pictures/image_reader.hpp"
#include "halflit/image.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

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

}  // namespace halflit::test
