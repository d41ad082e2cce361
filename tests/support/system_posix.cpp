#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace halflit::test {
namespace {

std::vector<char*> argv_of(std::vector<std::string>& words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return argv;
}

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

int code_of(int status) { return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status); }

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
    return code_of(status);
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

bool make_link(const std::filesystem::path& target, const std::filesystem::path& link) {
    std::filesystem::create_symlink(target, link);
    return true;
}

bool make_pipe(const std::filesystem::path& path) { return ::mkfifo(path.c_str(), 0600) == 0; }

double processor_s_of_children() {
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

Abilities abilities() { return {true, true, true, true, true, true, true}; }

Outcome run_program(const std::vector<std::string>& given, const RunSettings& settings) {
    const TemporaryFolder folder;
    folder.write("in", settings.input);
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
    std::vector<std::string> words = given;
    std::vector<char*> argv = argv_of(words);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) become_program(argv, settings, streams);
    Outcome outcome;
    outcome.code = wait_for(child, settings, pipe_ends[0]);
    for (const int fd : {streams[0], streams[1], streams[2], pipe_ends[1]})
        if (fd >= 0) ::close(fd);
    outcome.out = terminal ? terminal->text() : contents(folder / "out");
    outcome.err = contents(folder / "err");
    return outcome;
}

int run_shell(const std::string& line) {
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

struct PipedProgram::State {
    pid_t child = -1;
    int input = -1, output = -1;
};

PipedProgram::PipedProgram(const std::vector<std::string>& given) : state_(std::make_unique<State>()) {
    int to_child[2], from_child[2];
    REQUIRE(::pipe2(to_child, O_CLOEXEC) == 0);
    REQUIRE(::pipe2(from_child, O_CLOEXEC) == 0);
    std::vector<std::string> words = given;
    std::vector<char*> argv = argv_of(words);
    state_->child = ::fork();
    REQUIRE(state_->child >= 0);
    if (state_->child == 0) {
        ::dup2(to_child[0], 0);
        ::dup2(from_child[1], 1);
        ::dup2(::open("/dev/null", O_WRONLY), 2);
        ::execv(argv[0], argv.data());
        ::_exit(126);
    }
    ::close(to_child[0]);
    ::close(from_child[1]);
    state_->input = to_child[1], state_->output = from_child[0];
}

PipedProgram::~PipedProgram() {
    if (state_->child > 0) (void)end();
    ::close(state_->output);
}

void PipedProgram::write(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t done = ::write(state_->input, text.data() + sent, text.size() - sent);
        REQUIRE(done > 0);
        sent += static_cast<std::size_t>(done);
    }
}

std::string PipedProgram::read() const {
    constexpr int kPatienceMs = 120'000;
    pollfd ready{state_->output, POLLIN, 0};
    REQUIRE(::poll(&ready, 1, kPatienceMs) == 1);
    std::array<char, 65536> part;
    const ssize_t got = ::read(state_->output, part.data(), part.size());
    REQUIRE(got > 0);
    return {part.data(), static_cast<std::size_t>(got)};
}

int PipedProgram::end() {
    ::close(state_->input);
    int status = 0;
    ::waitpid(state_->child, &status, 0);
    state_->child = -1;
    return code_of(status);
}

}  // namespace halflit::test
