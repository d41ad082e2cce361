// An importer that does what its file asks for, to test what importers may do: halflit_odd_importer 1 --pixels N < FILE > GLB.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#ifdef __linux__
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#endif
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

extern char** environ;

namespace {

int says(const std::string& text, int code) {
    std::cerr << text << '\n';
    return code;
}

int opens(const std::string& path, int flags) {
    const int file = ::open(path.c_str(), flags, 0600);
    return says(file < 0 ? "refused" : "allowed", 3);
}

std::string environment() {
    std::string all;
    for (char** one = environ; *one != nullptr; ++one) all += std::string(*one) + ' ';
    return all;
}

int descriptors() {
    int open = 0;
    for (int i = 3; i < 4096; ++i) open += ::fcntl(i, F_GETFD) >= 0 ? 1 : 0;
    return open;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
    const std::string order = text.substr(0, text.find('\n')), rest = text.substr(std::min(text.size(), order.size() + 1));
    const std::string what = order.substr(0, order.find(' ')), value = order.substr(std::min(order.size(), what.size() + 1));
    if (what == "gives") return std::fwrite(rest.data(), 1, rest.size(), stdout) == rest.size() ? 0 : 4;
    if (what == "words") {
        std::string all;
        for (int i = 1; i < argc; ++i) all += std::string(argv[i]) + ' ';
        return says(all, 3);
    }
    if (what == "code") return says("the reason", std::atoi(value.c_str()));
    if (what == "silent") return 3;
    if (what == "crash") std::abort();
    if (what == "hang")
        for (volatile bool on = true; on;) {
        }
    if (what == "sleep") std::this_thread::sleep_for(std::chrono::hours(1));
    if (what == "flood")
        for (std::vector<char> zeros(1 << 20);;)
            if (std::fwrite(zeros.data(), 1, zeros.size(), stdout) != zeros.size()) return 4;
    if (what == "talk") {
        for (int i = 0; i < 100'000; ++i) std::cerr << "a line that is long enough to fill a pipe " << i << '\n';
        return says("the last line", 3);
    }
    if (what == "memory") {
        std::vector<char*> taken;
        for (int i = 0; i < 1 << 14; ++i) {
            char* const some = static_cast<char*>(std::malloc(1 << 20));
            if (some == nullptr) return says("took " + std::to_string(i) + " MiB", 5);
            taken.push_back(some);
        }
        return says("took all", 3);
    }
    if (what == "writes") return opens(value, O_WRONLY | O_CREAT);
    if (what == "reads") return opens(value, O_RDONLY);
    if (what == "removes") return says(::unlink(value.c_str()) == 0 ? "allowed" : "refused", 3);
    if (what == "renames") return says(::rename(value.c_str(), (value + "2").c_str()) == 0 ? "allowed" : "refused", 3);
    if (what == "makes") return says(::mkdir(value.c_str(), 0700) == 0 ? "allowed" : "refused", 3);
    if (what == "kills") return says(::kill(std::atoi(value.c_str()), 0) == 0 ? "allowed" : "refused", 3);
    if (what == "socket") return says(::socket(AF_INET, SOCK_STREAM, 0) < 0 ? "refused" : "allowed", 3);
    if (what == "forks") {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(0);
        return says(child < 0 ? "refused" : "allowed", 3);
    }
    if (what == "closes") {
        ::close(1), ::close(2);
        std::this_thread::sleep_for(std::chrono::hours(1));
    }
#ifdef __linux__
    if (what == "thread-kills")
        return says(::syscall(SYS_tgkill, std::atoi(value.c_str()), std::atoi(value.c_str()), 0) == 0 ? "allowed" : "refused", 3);
    if (what == "queues") {
        siginfo_t info{};
        info.si_code = SI_QUEUE;
        return says(::syscall(SYS_rt_sigqueueinfo, std::atoi(value.c_str()), 0, &info) == 0 ? "allowed" : "refused", 3);
    }
    if (what == "limits") {
        struct rlimit none {};
        return says(::syscall(SYS_prlimit64, std::atoi(value.c_str()), RLIMIT_FSIZE, nullptr, &none) == 0 ? "allowed" : "refused", 3);
    }
    if (what == "changes") return says(::syscall(452 /* fchmodat2 */, AT_FDCWD, value.c_str(), 0600, 0) == 0 ? "allowed" : "refused", 3);
    if (what == "outlives") return says(::prctl(PR_SET_PDEATHSIG, 0) == 0 ? "allowed" : "refused", 3);
#endif
    if (what == "thread") {
        int x = 0;
        std::thread([&] { x = 1; }).join();
        return says(x == 1 ? "allowed" : "refused", 3);
    }
    if (what == "environment") return says(environment(), 3);
    if (what == "descriptors") return says(std::to_string(descriptors()), 3);
    return says("does not know '" + what + "'", 3);
}
