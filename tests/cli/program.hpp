// Runs the program as a shell would, and looks at what comes out.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace halflit::test {

struct Outcome {
    int code = -1;  ///< as a shell shows it: 128 + n when signal n ended the program
    std::string out, err;
};

struct RunSettings {
    std::string input{};                                             ///< its standard input
    std::vector<std::pair<std::string, std::string>> environment{};  ///< added to ours
    std::string folder{};                                            ///< where it runs; empty: here
    std::optional<std::size_t> largest_file{};                       ///< bytes, as a full disk would have it
    std::optional<int> closed{};                                     ///< a standard stream that is closed
    /// Called again and again while the program runs; a number is a signal to send, once.
    std::function<std::optional<int>()> signal{};
    bool hold_input_open = false;  ///< standard input does not end; signals are asked for once `input` has been read
};

[[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings = {});

/// A folder of its own that goes with the object.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] std::string path() const { return path_.string(); }
    /// Names of all files in it, hidden ones too, sorted.
    [[nodiscard]] std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

[[nodiscard]] std::string contents(const std::string& path);
void write_contents(const std::string& path, const std::string& text);

struct Picture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgba8;
    [[nodiscard]] std::vector<int> pixel(int x, int y) const;
};
/// Of a PNG or JPEG; fails the test when it cannot be read.
[[nodiscard]] Picture read_picture(const std::string& file_contents);
/// A PNG of one colour.
[[nodiscard]] std::string png_of(int width, int height, std::vector<unsigned char> rgba8);

}  // namespace halflit::test
