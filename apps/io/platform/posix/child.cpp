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
#include <sys/mman.h>
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace halflit::platform {
namespace {

/// A file without a name that holds the bytes, at its begin; not open with errno.
Handle file_of(std::span<const std::byte> bytes) {
#ifdef __linux__
    Handle file(::memfd_create("model", MFD_CLOEXEC));
#else
    Handle file = create_unnamed("/tmp", 0600);
#endif
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const bool is_written =
        file.is_open() && write_all(file.get(), {data, bytes.size()}) == 0 && ::lseek(static_cast<int>(file.get()), 0, SEEK_SET) == 0;
    return is_written ? std::move(file) : Handle();
}

struct Pipe {
    Handle read, write;
};
bool open_pipe(Pipe& pipe) {
    int ends[2] = {-1, -1};
    if (::pipe(ends) != 0) return false;
    for (const int end : ends) (void)::fcntl(end, F_SETFD, FD_CLOEXEC);
    pipe.read = Handle(ends[0]), pipe.write = Handle(ends[1]);
    return true;
}

void set_limit(int which, std::uint64_t most) {
    struct rlimit limit {};
    if (::getrlimit(which, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max = std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(most));
    (void)::setrlimit(which, &limit);
}

/// Between fork and exec: calls that may be made there alone. What is sent through `told` is errno.
[[noreturn]] void become(char* const* words, int input, const Pipe& output, const Pipe& errors, const Pipe& told,
                         const Confinement& confined, const ChildLimits& limits) {
    static char* const kEnvironment[] = {const_cast<char*>("PATH=/usr/bin:/bin"), const_cast<char*>("LC_ALL=C"), nullptr};
    constexpr int kTold = 3;  // the first one behind the standard streams
    (void)::setpgid(0, 0);
    // Each is moved out of the way of the others first.
    int ends[] = {input, static_cast<int>(output.write.get()), static_cast<int>(errors.write.get()), static_cast<int>(told.write.get())};
    bool placed = true;
    for (int& end : ends) placed = (end = ::fcntl(end, F_DUPFD_CLOEXEC, kLowestOwn)) >= 0 && placed;
    for (int i = 0; i <= kTold && placed; ++i) placed = ::dup2(ends[i], i) == i;
    if (placed && ::fcntl(kTold, F_SETFD, FD_CLOEXEC) == 0) {
        sigset_t none;
        sigemptyset(&none);
        (void)::sigprocmask(SIG_SETMASK, &none, nullptr);
        (void)::signal(SIGPIPE, SIG_DFL);
        (void)::signal(SIGXFSZ, SIG_DFL);
#ifdef __linux__
        (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
        set_limit(RLIMIT_AS, limits.memory_bytes);
        set_limit(RLIMIT_CPU, limits.cpu_s);
        set_limit(RLIMIT_FSIZE, 0);
        set_limit(RLIMIT_CORE, 0);
        confine(confined);
        close_from(kTold + 1);
        (void)::execve(words[0], words, kEnvironment);
    }
    const int error = errno;
    (void)!::write(kTold, &error, sizeof error);
    ::_exit(127);
}

/// Ends a process and what it started, unless that was done.
class Running {
public:
    explicit Running(pid_t process) : process_(process) {}
    ~Running() { (void)end(SIGKILL); }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    /// Its status as waitpid() gives it. signal: sent to it first; 0: none.
    int end(int signal) {
        if (process_ < 0) return status_;
        if (signal != 0 && ::kill(-process_, signal) != 0) (void)::kill(process_, signal);
        while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
        }
        if (signal == 0) (void)::kill(-process_, SIGKILL);
        process_ = -1;
        return status_;
    }

private:
    pid_t process_;
    int status_ = 0;
};

}  // namespace

bool can_run_children() { return true; }

ChildResult run_confined(const std::vector<std::string>& words, std::span<const std::byte> input, const ChildLimits& limits) {
    constexpr std::size_t kMostMessages = 4096;
    ChildResult result;
    Pipe output, errors, told;
    const Handle model = file_of(input);
    result.number = errno;
    if (!model.is_open() || !open_pipe(output) || !open_pipe(errors) || !open_pipe(told)) {
        result.number = errno;
        return result;
    }
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const Confinement confined(words[0]);
    const pid_t process = ::fork();
    if (process < 0) {
        result.number = errno;
        return result;
    }
    if (process == 0) become(arguments.data(), static_cast<int>(model.get()), output, errors, told, confined, limits);
    Running running(process);
    for (Pipe* pipe : {&output, &errors, &told}) (void)pipe->write.close();
    int error = 0;
    if (::read(static_cast<int>(told.read.get()), &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
        (void)running.end(0);
        result.number = error;
        return result;
    }
    constexpr int kAskEveryMs = 20;
    std::vector<std::byte> part(std::size_t{1} << 18);
    while (output.read.is_open() || errors.read.is_open()) {
        check_time();
        struct pollfd waits[] = {{static_cast<int>(output.read.get()), POLLIN, 0}, {static_cast<int>(errors.read.get()), POLLIN, 0}};
        if (::poll(waits, 2, kAskEveryMs) < 0 && errno != EINTR) break;
        for (int i = 0; i < 2; ++i) {
            if ((waits[i].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
            Handle& from = i == 0 ? output.read : errors.read;
            const std::ptrdiff_t got = read_some(from.get(), part.data(), part.size());
            if (got <= 0) {
                (void)from.close();
            } else if (i == 0) {
                if (result.output.size() + static_cast<std::size_t>(got) > limits.output_bytes) {
                    (void)running.end(SIGKILL);
                    result.end = ChildResult::End::too_much_output;
                    return result;
                }
                result.output.insert(result.output.end(), part.begin(), part.begin() + got);
            } else {
                result.messages.append(reinterpret_cast<const char*>(part.data()), static_cast<std::size_t>(got));
                if (result.messages.size() > kMostMessages) result.messages.erase(0, result.messages.size() - kMostMessages);
            }
        }
    }
    const int status = running.end(0);
    result.end = WIFEXITED(status) ? ChildResult::End::code : ChildResult::End::signal;
    result.number = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
    if (result.end == ChildResult::End::signal && (result.number == SIGXCPU || result.number == SIGKILL))
        result.end = ChildResult::End::out_of_time;
    return result;
}

std::string own_folder() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || info.dli_fname == nullptr) return {};
#ifdef __linux__
    const std::string path = std::strchr(info.dli_fname, '/') != nullptr && ::access(info.dli_fname, R_OK) == 0
                                 ? real_path(info.dli_fname)
                                 : real_path("/proc/self/exe");
#else
    const std::string path = real_path(info.dli_fname);
#endif
    const std::size_t slash = last_separator(path);
    return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

}  // namespace halflit::platform
