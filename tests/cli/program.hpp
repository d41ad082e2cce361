// Runs the program as a shell would, and reads its output.
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
    std::string folder{};                                            ///< folder to run in; empty: the current one
    std::optional<std::size_t> largest_file{};                       ///< bytes; a larger file fails as on a full disk
    std::optional<int> closed{};                                     ///< a standard stream that is closed
    /// Called repeatedly while the program runs. A number is a signal, which is sent once.
    std::function<std::optional<int>()> signal{};
    /// Standard output and standard error are a terminal of this width; `out` has both, with "\r\n" as its lines end.
    std::optional<int> terminal_columns{};
    bool hold_input_open = false;  ///< standard input does not end; `signal` is called once `input` has been read
};

[[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings = {});

/// A new folder that is removed with the object.
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
/// Picture of a PNG or JPEG file; fails the test if it cannot be read.
[[nodiscard]] Picture read_picture(const std::string& file_contents);
/// PNG file of these pixels.
[[nodiscard]] std::string png_of(int width, int height, std::vector<unsigned char> rgba8);

}  // namespace halflit::test
