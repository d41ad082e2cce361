#include "apps/io/platform/handles.hpp"

#include "apps/io/platform/posix/status.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>
#if defined(__linux__)
#include <linux/openat2.h>
#include <sys/syscall.h>
#endif

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <memory>

namespace halflit::platform {
namespace {

// O_NONBLOCK: opening a FIFO without a writer returns at once, and its status then shows what it is.
constexpr int kOpenFlags = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
#ifdef O_PATH
constexpr int kFolderFlags = O_PATH | O_DIRECTORY | O_CLOEXEC;
#else
constexpr int kFolderFlags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
#endif

int number(NativeHandle handle) { return static_cast<int>(handle); }

/// Opens component by component and follows no symbolic link. Used where openat2 is missing (before Linux 5.6) or filtered.
Handle open_by_walk(NativeHandle folder, const std::string& relative) {
    Handle current(::fcntl(number(folder), F_DUPFD_CLOEXEC, 0));
    std::size_t begin = 0;
    while (current.is_open()) {
        const std::size_t slash = relative.find('/', begin);
        const std::string part = relative.substr(begin, slash == std::string::npos ? std::string::npos : slash - begin);
        const bool last = slash == std::string::npos;
        if (part == "..") {
            errno = EXDEV;
            return {};
        }
        if (!part.empty() && part != ".")
            current = Handle(::openat(number(current.get()), part.c_str(), kOpenFlags | O_NOFOLLOW | (last ? 0 : O_DIRECTORY)));
        if (last) break;
        begin = slash + 1;
    }
    return current;
}

}  // namespace

int close_handle(NativeHandle handle) { return ::close(number(handle)) == 0 ? 0 : errno; }

Handle open_to_read(const std::string& path) { return Handle(::open(path.c_str(), kOpenFlags)); }

Handle open_folder(const std::string& path) { return Handle(::open(path.c_str(), kFolderFlags)); }

Handle open_beneath(NativeHandle folder, const std::string& relative) {
#if defined(SYS_openat2)
    struct open_how how {};
    how.flags = static_cast<std::uint64_t>(kOpenFlags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    for (int attempt = 0; attempt < 3; ++attempt) {
        const long fd = ::syscall(SYS_openat2, number(folder), relative.c_str(), &how, sizeof how);
        if (fd >= 0) return Handle(fd);
        if (errno == EAGAIN || errno == EINTR) continue;  // a rename raced with the lookup
        if (errno != ENOSYS && errno != EPERM) return {};
        break;
    }
#endif
    return open_by_walk(folder, relative);
}

std::string_view fault_of_name(std::string_view /*relative*/) { return {}; }

std::vector<std::string> names_in(NativeHandle folder, std::size_t most) {
    const int copy = ::openat(number(folder), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR* const entries = copy >= 0 ? ::fdopendir(copy) : nullptr;
    if (entries == nullptr) {
        if (copy >= 0) ::close(copy);
        return {};
    }
    const std::unique_ptr<DIR, int (*)(DIR*)> owner(entries, ::closedir);
    std::vector<std::string> names;
    while (names.size() < most) {
        const dirent* const entry = ::readdir(entries);
        if (entry == nullptr) break;
        names.emplace_back(entry->d_name);
    }
    return names;
}

int status_of(NativeHandle handle, FileStatus& status) {
    struct stat info {};
    if (::fstat(number(handle), &info) != 0) return errno;
    status = to_status(info);
    return 0;
}

std::ptrdiff_t read_some(NativeHandle handle, void* into, std::size_t bytes) {
    for (;;) {
        const ssize_t got = ::read(number(handle), into, bytes);
        if (got >= 0 || errno != EINTR) return got;
    }
}

int write_all(NativeHandle handle, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(number(handle), bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 20));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

int flush(NativeHandle handle) { return ::fsync(number(handle)) == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno; }

Handle create_new(const std::string& path, unsigned mode) {
    return Handle(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, static_cast<mode_t>(mode)));
}

Handle create_unnamed(const std::string& folder, unsigned mode) {
#ifdef O_TMPFILE
    if (::access("/proc/self/fd", X_OK) != 0) return {};
    return Handle(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, static_cast<mode_t>(mode)));
#else
    (void)folder, (void)mode;
    return {};
#endif
}

int name_unnamed(NativeHandle handle, const std::string& path) {
    const std::string source = "/proc/self/fd/" + std::to_string(handle);
    return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

int set_mode(NativeHandle handle, unsigned mode) { return ::fchmod(number(handle), static_cast<mode_t>(mode)) == 0 ? 0 : errno; }

Handle open_in_place(const std::string& path, bool is_pipe) {
    constexpr int kTries = 500;
    constexpr timespec kBetween{0, 20'000'000};  // in all 10 s
    Handle file;
    for (int i = 0; i < kTries; ++i) {
        file = Handle(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
        if (file.is_open() || errno != ENXIO || !is_pipe) break;
        (void)::nanosleep(&kBetween, nullptr);
    }
    if (!file.is_open()) return file;
    const int flags = ::fcntl(number(file.get()), F_GETFL);
    if (flags >= 0 && ::fcntl(number(file.get()), F_SETFL, flags & ~O_NONBLOCK) == 0) return file;
    const int error = errno;
    (void)file.close();
    errno = error;
    return {};
}

NativeHandle standard_input() { return STDIN_FILENO; }
NativeHandle standard_output() { return STDOUT_FILENO; }

}  // namespace halflit::platform
