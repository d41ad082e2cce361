#include "apps/io/platform/process.hpp"

#include <pthread.h>
#include <sys/resource.h>
#ifdef __APPLE__
#include <sys/sysctl.h>
#endif
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>
#include <thread>

namespace halflit::platform {
namespace {

void (*words_before_end)(int) = nullptr;

[[noreturn]] void end_by(int signal) {
    std::signal(signal, SIG_DFL);
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, signal);
    pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
    std::raise(signal);
    std::_Exit(128 + signal);
}

void wait_for_signal(sigset_t taken) {
    int signal = 0;
    if (sigwait(&taken, &signal) != 0) return;
    words_before_end(signal);
    end_by(signal);
}

/// The value of the first line of a system's file that begins with the key, without quotes; empty if there is none.
std::string system_value(const char* path, std::string_view key, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(key)) continue;
        const std::size_t begin = line.find_first_not_of(" \t\"", std::min(line.find(separator), line.size() - 1) + 1);
        if (begin == std::string::npos) return {};
        line = line.substr(begin);
        return line.substr(0, line.find_last_not_of('"') + 1);
    }
    return {};
}

}  // namespace

std::vector<std::string> arguments(int argc, char** argv) { return {argv + std::min(argc, 1), argv + argc}; }

std::int64_t process_id() { return ::getpid(); }

bool may_be_running(std::int64_t process) { return ::kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

std::size_t stack_limit() {
    struct rlimit limit {};
    return ::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? static_cast<std::size_t>(limit.rlim_cur) : 0;
}

std::int64_t peak_memory() {
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return usage.ru_maxrss;  // bytes there, kB elsewhere
#else
    return std::int64_t{usage.ru_maxrss} * 1024;
#endif
}

#ifdef __APPLE__

int limit_memory(std::size_t /*bytes*/) { return ENOTSUP; }  // the limit can be set there, and limits nothing

std::string processor_name() {
    char name[128] = "";
    std::size_t bytes = sizeof name - 1;
    return ::sysctlbyname("machdep.cpu.brand_string", name, &bytes, nullptr, 0) == 0 ? name : "";
}

#else

int limit_memory(std::size_t bytes) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_DATA, &limit) == 0) {
        limit.rlim_cur = std::min({limit.rlim_cur, limit.rlim_max, static_cast<rlim_t>(bytes)});
        if (::setrlimit(RLIMIT_DATA, &limit) == 0) return 0;
    }
    return errno;
}

std::string processor_name() { return system_value("/proc/cpuinfo", "model name", ':'); }

#endif

std::string system_name() {
    struct utsname names {};
    if (::uname(&names) != 0) return "unknown";
    const std::string distribution = system_value("/etc/os-release", "PRETTY_NAME=", '=');
    return std::string(names.sysname) + " " + names.release + " " + names.machine + (distribution.empty() ? "" : ", ") + distribution;
}

void call_before_end(void (*last_words)(int signal)) {
    words_before_end = last_words;
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD, SIG_DFL);  // one that ignored it would not be told how importers end
    sigset_t taken;
    sigemptyset(&taken);
    bool any = false;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old {};
        if (sigaction(signal, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) continue;
        sigaddset(&taken, signal);
        any = true;
    }
    if (!any) return;
    pthread_sigmask(SIG_BLOCK, &taken, nullptr);  // inherited by all threads that start later
    try {
        std::thread(wait_for_signal, taken).detach();
    } catch (const std::system_error&) {
        pthread_sigmask(SIG_UNBLOCK, &taken, nullptr);  // the thread could not start: the default action stays
    }
}

void wait_for_end() {
    for (;;) ::pause();
}

}  // namespace halflit::platform
