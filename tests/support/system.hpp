// Functions of the system for tests: folders, links, pipes and other processes. A test is skipped for what the system lacks (HALFLIT_SKIP).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::test {

/// A new folder that is removed with the object. Names are UTF-8, with '/' between folders.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] std::string path() const;
    [[nodiscard]] std::string file(const std::string& name) const;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const;
    /// Names of all files in it, hidden ones too, sorted.
    [[nodiscard]] std::vector<std::string> names() const;
    /// Writes a file, and the folders that its name has.
    void write(const std::string& name, std::string_view text) const;

private:
    std::filesystem::path path_;
};

/// A file's bytes; none where it cannot be read.
[[nodiscard]] std::string contents(const std::filesystem::path& path);

/// Makes a symbolic link to a file or folder. False where the system makes none: Windows without the right to, and wine.
[[nodiscard]] bool make_link(const std::filesystem::path& target, const std::filesystem::path& link);
/// Makes a pipe with a name in a folder. False where the system has no such pipes.
[[nodiscard]] bool make_pipe(const std::filesystem::path& path);

/// A signal that ends a process at once.
inline constexpr int kKill = 9;

/// Optional requests of RunSettings; the other members are for every system.
struct Abilities {
    bool signals;          ///< SIGINT and SIGTERM to another process
    bool terminals;        ///< a terminal without a screen
    bool limits_of_files;  ///< a limit of the size of written files
    bool limits_of_memory;
    bool shell;
    bool replaces_open_files;  ///< a file that somebody reads gets a successor
    bool follows_links;        ///< a model's names may pass through links that stay in its folder
};
[[nodiscard]] Abilities abilities();

/// Processor time of the processes that this one has run, seconds; 0 where the system does not tell.
[[nodiscard]] double processor_s_of_children();

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

struct Outcome {
    int code = -1;  ///< as a shell shows it: 128 + n when signal n ended the program
    std::string out, err;
};

/// Runs a program and waits for its end. The environment has TERM=xterm and neither COLUMNS nor NO_COLOR.
[[nodiscard]] Outcome run_program(const std::vector<std::string>& words, const RunSettings& settings);

/// Runs a line of sh. Its exit code; below 0 where there is no such shell.
[[nodiscard]] int run_shell(const std::string& line);

/// A program with pipes to its standard input and from its standard output.
class PipedProgram {
public:
    explicit PipedProgram(const std::vector<std::string>& words);
    ~PipedProgram();
    PipedProgram(const PipedProgram&) = delete;
    PipedProgram& operator=(const PipedProgram&) = delete;

    void write(const std::string& text) const;
    /// The output since the last call; waits for some of it up to two minutes, then fails the test.
    [[nodiscard]] std::string read() const;
    /// Closes its input and waits for its end; the exit code.
    int end();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace halflit::test
