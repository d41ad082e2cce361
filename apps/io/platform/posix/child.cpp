#include "apps/io/platform/child.hpp"

#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/posix/confine.hpp"
#include "sh/time_limit.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <utility>

namespace halflit::platform {
namespace {

/// A file without a name that holds the bytes, read from its beginning; not open with errno.
Handle file_of(std::span<const std::byte> bytes) {
#ifdef __linux__
    Handle file(::syscall(SYS_memfd_create, "model", 1U /* close on exec */));  // glibc has a function for it from 2.27 on
#else
    char name[] = "/tmp/halflit-model-XXXXXX";
    Handle file(::mkstemp(name));
    if (file.is_open()) (void)::unlink(name);
#endif
    if (!file.is_open()) return file;
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    errno = write_all(file.get(), {data, bytes.size()});
    return errno == 0 && ::lseek(static_cast<int>(file.get()), 0, SEEK_SET) == 0 ? std::move(file) : Handle();
}

struct Pipe {
    Handle read, write;
};
bool open_pipe(Pipe& pipe) {
    int ends[2] = {-1, -1};
#ifdef __linux__
    if (::pipe2(ends, O_CLOEXEC) != 0) return false;
#else
    if (::pipe(ends) != 0) return false;
    for (const int end : ends) (void)::fcntl(end, F_SETFD, FD_CLOEXEC);
#endif
    pipe.read = Handle(ends[0]), pipe.write = Handle(ends[1]);
    return true;
}

void set_limit(int which, std::uint64_t soft, std::uint64_t hard) {
    struct rlimit limit {};
    if (::getrlimit(which, &limit) != 0) return;
    limit.rlim_max = std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(hard));
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(soft));
    (void)::setrlimit(which, &limit);
}
void set_limit(int which, std::uint64_t most) { set_limit(which, most, most); }

struct ChildEnds {
    const Handle& input;
    const Pipe &output, &errors, &told;
};

/// Between fork and exec: calls that may be made there alone. What is sent through `told` is errno.
[[noreturn]] void become(char* const* words, const ChildEnds& from, pid_t host, const Confinement& confined, const ChildLimits& limits) {
    static char* const kEnvironment[] = {const_cast<char*>("PATH=/usr/bin:/bin"), const_cast<char*>("LC_ALL=C"), nullptr};
    constexpr int kTold = 3;  // the first one behind the standard streams
    int told = static_cast<int>(from.told.write.get());
    (void)::setsid();  // a process group of its own, and no terminal
    // Each is moved out of the way of the others first.
    int ends[] = {static_cast<int>(from.input.get()), static_cast<int>(from.output.write.get()), static_cast<int>(from.errors.write.get()),
                  told};
    bool placed = ::chdir("/") == 0;
    for (int& end : ends) placed = placed && (end = ::fcntl(end, F_DUPFD_CLOEXEC, kLowestOwn)) >= 0;
    if (placed) told = ends[kTold];
    for (int i = 0; i <= kTold && placed; ++i) placed = ::dup2(ends[i], i) == i;
    if (placed && ::fcntl(kTold, F_SETFD, FD_CLOEXEC) == 0) {
        sigset_t none;
        sigemptyset(&none);
        (void)::sigprocmask(SIG_SETMASK, &none, nullptr);
        (void)::signal(SIGPIPE, SIG_DFL);
        (void)::signal(SIGXFSZ, SIG_DFL);
        (void)::signal(SIGXCPU, SIG_DFL);
#ifdef __linux__
        (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != host) ::_exit(127);  // it ended before that
#else
        (void)host;
#endif
        set_limit(RLIMIT_AS, limits.memory_bytes);
        set_limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1ULL);
        set_limit(RLIMIT_FSIZE, 0);
        set_limit(RLIMIT_CORE, 0);
        set_limit(RLIMIT_NOFILE, 64);
        confine(confined);
        close_from(kTold + 1);
        told = kTold;
        (void)::execve(words[0], words, kEnvironment);
    }
    const int error = errno;
    (void)!::write(told, &error, sizeof error);
    ::_exit(127);
}

/// A process that ends with this object, together with what it started.
class Running {
public:
    explicit Running(pid_t process) : process_(process) {}
    ~Running() {
        if (process_ > 0) reap();
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    /// True once it has ended; its number stays its own until reap().
    [[nodiscard]] bool has_ended() const {
        siginfo_t info{};
        return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == process_;
    }
    /// Ends it and what it started. Its status as waitpid() gives it; nothing: somebody else has taken it.
    std::optional<int> reap() {
        const pid_t process = std::exchange(process_, -1);
        if (::kill(-process, SIGKILL) != 0) (void)::kill(process, SIGKILL);
        int status = 0;
        for (;;) {
            if (::waitpid(process, &status, 0) == process) return status;
            if (errno != EINTR) return std::nullopt;
        }
    }

private:
    pid_t process_;
};

constexpr int kAskEveryMs = 20;

/// Takes what there is, and waits for it a little; closes what has ended. False: too much.
bool take_output(Pipe& output, Pipe& errors, std::vector<std::byte>& part, std::size_t most, ChildResult& result) {
    constexpr std::size_t kMostMessages = 4096;
    struct pollfd waits[] = {{static_cast<int>(output.read.get()), POLLIN, 0}, {static_cast<int>(errors.read.get()), POLLIN, 0}};
    if (::poll(waits, 2, kAskEveryMs) < 0) return true;
    for (int i = 0; i < 2; ++i) {
        if ((waits[i].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) == 0) continue;
        Handle& from = i == 0 ? output.read : errors.read;
        const std::ptrdiff_t got = read_some(from.get(), part.data(), part.size());
        if (got <= 0) {
            (void)from.close();
        } else if (i == 0) {
            if (result.output.size() + static_cast<std::size_t>(got) > most) return false;
            result.output.insert(result.output.end(), part.begin(), part.begin() + got);
        } else {
            result.messages.append(reinterpret_cast<const char*>(part.data()), static_cast<std::size_t>(got));
            if (result.messages.size() > kMostMessages) result.messages.erase(0, result.messages.size() - kMostMessages);
        }
    }
    return true;
}

}  // namespace

bool can_run_children() { return true; }

ChildResult run_confined(const std::vector<std::string>& words, std::span<const std::byte> input, const ChildLimits& limits) {
    ChildResult result;
    Pipe output, errors, told;
    const Handle model = file_of(input);
    if (!model.is_open() || !open_pipe(output) || !open_pipe(errors) || !open_pipe(told)) {
        result.number = errno;
        return result;
    }
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const Confinement confined(words[0]);
    const pid_t host = ::getpid(), process = ::fork();
    if (process < 0) {
        result.number = errno;
        return result;
    }
    if (process == 0) become(arguments.data(), {model, output, errors, told}, host, confined, limits);
    Running running(process);
    for (Pipe* pipe : {&output, &errors, &told}) (void)pipe->write.close();
    int error = 0;
    if (read_some(told.read.get(), &error, sizeof error) == static_cast<std::ptrdiff_t>(sizeof error)) {
        result.number = error;
        return result;
    }
    // What it started may hold the pipes open: they are read to their end only while it lives.
    std::vector<std::byte> part(std::size_t{1} << 18);
    for (bool has_ended = false; output.read.is_open() || errors.read.is_open() || !has_ended;) {
        check_time();
        const std::size_t before = result.output.size() + result.messages.size();
        if (!take_output(output, errors, part, limits.output_bytes, result)) {
            result.end = ChildResult::End::too_much_output;
            return result;
        }
        if (has_ended && result.output.size() + result.messages.size() == before) break;
        has_ended = running.has_ended();
    }
    const std::optional<int> status = running.reap();
    if (!status) {
        result.number = ECHILD;
        return result;
    }
    result.end = WIFEXITED(*status) ? ChildResult::End::code : ChildResult::End::signal;
    result.number = WIFEXITED(*status) ? WEXITSTATUS(*status) : WTERMSIG(*status);
    if (result.end == ChildResult::End::signal && result.number == SIGXCPU) result.end = ChildResult::End::out_of_time;
    return result;
}

std::string own_folder() {
    Dl_info info{};
    std::string path;
    if (::dladdr(reinterpret_cast<const void*>(&own_folder), &info) != 0 && info.dli_fname != nullptr) path = info.dli_fname;
#ifdef __linux__
    if (path.find(".so") == path.npos) path = "/proc/self/exe";  // the program's name is as it was typed
#endif
    path = real_path(path);
    const std::size_t slash = last_separator(path);
    return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

}  // namespace halflit::platform
