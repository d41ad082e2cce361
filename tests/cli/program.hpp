// Runs the program as a shell would, and reads its output.
#pragma once

#include "tests/support/system.hpp"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace halflit::test {

[[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings = {});

void write_contents(const std::string& path, const std::string& text);

[[nodiscard]] inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);
/// The words of a command line after the program's name; quotes stand around whole words.
[[nodiscard]] std::vector<std::string> words_of_line(const std::string& line);
/// Each line is a value.
[[nodiscard]] std::vector<nlohmann::json> json_lines(const std::string& text);

/// A glTF file of one triangle in the plane z = 0 with corners (0, 0), (1, 0), (0, 2). scale: three numbers with commas between them.
void write_triangle(const std::string& path, const std::string& scale = "1,1,1");

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
