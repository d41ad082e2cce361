#include "tests/cli/program.hpp"

#include "apps/io/pictures/image_reader.hpp"
#include "halflit/image.hpp"

#include "tests/support/catch.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <thread>

namespace halflit::test {
namespace {

/// Turns the child process into the program.
[[noreturn]] void become_program(std::vector<char*>& argv, const RunSettings& settings, const int (&streams)[3]) {
    for (int fd = 0; fd < 3; ++fd) ::dup2(streams[fd], fd);
    if (settings.closed) ::close(*settings.closed);
    if (!settings.folder.empty() && ::chdir(settings.folder.c_str()) != 0) ::_exit(125);
    ::unsetenv("COLUMNS");
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "xterm", 1);
    for (const auto& [name, value] : settings.environment) ::setenv(name.c_str(), value.c_str(), 1);
    if (settings.largest_file) {
        const struct rlimit limit { *settings.largest_file, *settings.largest_file };
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ::execv(argv[0], argv.data());
    ::_exit(126);
}

/// True if all that was written to a pipe has been read. `input` is its reading end, or below 0 if there is no pipe.
bool input_taken(int input) {
    int left = 0;
    return input < 0 || (::ioctl(input, FIONREAD, &left) == 0 && left == 0);
}

int wait_for(pid_t child, const RunSettings& settings, int held_input) {
    int status = 0;
    bool sent = false;
    while (::waitpid(child, &status, settings.signal && !sent ? WNOHANG : 0) == 0) {
        if (const auto signal = input_taken(held_input) ? settings.signal() : std::nullopt) {
            ::kill(child, *signal);
            sent = true;
        }
        ::usleep(500);
    }
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// A terminal without a screen: what the program writes to it is collected.
class Terminal {
public:
    explicit Terminal(int columns) : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
        REQUIRE(master_ >= 0);
        REQUIRE(::grantpt(master_) == 0);
        REQUIRE(::unlockpt(master_) == 0);
        slave_ = ::open(::ptsname(master_), O_RDWR | O_NOCTTY | O_CLOEXEC);
        REQUIRE(slave_ >= 0);
        struct winsize size {};
        size.ws_col = static_cast<unsigned short>(columns);
        REQUIRE(::ioctl(slave_, TIOCSWINSZ, &size) == 0);
        reader_ = std::thread([this] {
            char part[4096];
            for (ssize_t got; (got = ::read(master_, part, sizeof part)) > 0;) text_.append(part, static_cast<std::size_t>(got));
        });
    }
    ~Terminal() {
        if (reader_.joinable()) (void)text();
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] int end() const { return slave_; }
    /// All that was written. Call it when the program has ended: reading ends when nobody holds the other end.
    std::string text() {
        ::close(slave_);
        reader_.join();
        ::close(master_);
        return text_;
    }

private:
    int master_, slave_ = -1;
    std::thread reader_;
    std::string text_;
};

}  // namespace

Outcome run(const std::vector<std::string>& arguments, const RunSettings& settings) {
    const TemporaryFolder folder;
    write_contents(folder.file("in"), settings.input);
    int pipe_ends[2] = {-1, -1};
    if (settings.hold_input_open) {
        REQUIRE(::pipe2(pipe_ends, O_CLOEXEC) == 0);
        REQUIRE(::write(pipe_ends[1], settings.input.data(), settings.input.size()) == static_cast<ssize_t>(settings.input.size()));
    }
    std::optional<Terminal> terminal;
    if (settings.terminal_columns) terminal.emplace(*settings.terminal_columns);
    const auto output = [&](const char* name) {
        return terminal ? ::dup(terminal->end()) : ::open(folder.file(name).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    };
    const int streams[3] = {settings.hold_input_open ? pipe_ends[0] : ::open(folder.file("in").c_str(), O_RDONLY | O_CLOEXEC),
                            output("out"), output("err")};
    std::vector<std::string> words = {HALFLIT_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) become_program(argv, settings, streams);
    Outcome outcome;
    outcome.code = wait_for(child, settings, pipe_ends[0]);
    for (const int fd : {streams[0], streams[1], streams[2], pipe_ends[1]})
        if (fd >= 0) ::close(fd);
    outcome.out = terminal ? terminal->text() : contents(folder.file("out"));
    outcome.err = contents(folder.file("err"));
    return outcome;
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "halflit-test-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
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
