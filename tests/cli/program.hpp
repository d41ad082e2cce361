// Runs the program as a shell would, and reads its output.
#pragma once

#include "tests/support/system.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace halflit::test {

[[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings = {});

void write_contents(const std::string& path, const std::string& text);

struct Picture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgba8;
    [[nodiscard]] std::vector<int> pixel(int x, int y) const;
};
/// Picture of a PNG or JPEG file; fails the test if it cannot be read.
[[nodiscard]] Picture read_picture(const std::string& file_contents);
/// PNG file of these pixels.
[[nodiscard]] std::string png_of(int width, int height, std::vector<unsigned char> rgba8);

}  // namespace halflit::test
