#include "apps/io/files/atomic_file.hpp"

#include "apps/io/files/errno_text.hpp"
#include "apps/io/files/text.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

namespace halflit::io {
namespace {

tl::unexpected<Error> system_error(const std::string& place, int error) {
    return fail(error == ENOMEM ? ErrorCode::limit : ErrorCode::io, error == EPIPE ? std::string() : place + ": " + errno_text(error));
}

/// Returns 0 or errno. File systems without fsync give EINVAL or ENOSYS, which count as success.
int flush(int fd) { return ::fsync(fd) == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno; }

/// The temporary files that exist now, for abandon_files.
class Pending {
public:
    static Pending& instance() {
        static Pending& pending = *new Pending;  // never destroyed: at the process's end a thread may wait in abandon()
        return pending;
    }

    /// Creates a file and returns its descriptor, or -1 with errno.
    int create(const std::string& path, mode_t mode) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW;
        paths_.reserve(paths_.size() + 1);  // so that no exception leaves a file that is not listed
        int fd = ::open(path.c_str(), kFlags, mode);
        if (fd < 0 && errno == EEXIST) {
            // Left over from a killed process that had the same process id.
            ::unlink(path.c_str());
            fd = ::open(path.c_str(), kFlags, mode);
        }
        if (fd >= 0) paths_.push_back(path);
        return fd;
    }

    /// Renames the temporary file to the target. Returns 0 or errno; the temporary file is gone either way.
    int publish(const std::string& path, const std::string& target) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        const int error = std::rename(path.c_str(), target.c_str()) == 0 ? 0 : errno;
        if (error != 0) ::unlink(path.c_str());
        std::erase(paths_, path);
        published_ |= error == 0;
        return error;
    }

    /// Gives a file without a name the target's. Returns 0 or errno. A kill leaves no other file behind, except between two system calls
    /// where the target exists and has to be replaced.
    int publish_unnamed(int fd, const std::string& temporary, const std::string& target, bool exists) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        const std::string source = "/proc/self/fd/" + std::to_string(fd);
        const auto link = [&](const std::string& name) {
            return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
        };
        int error = exists ? EEXIST : link(target);
        if (error == EEXIST) {
            ::unlink(temporary.c_str());
            error = exists ? 0 : flush(fd);  // another process has made the target meanwhile
            if (error == 0) error = link(temporary);
            if (error == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) {
                error = errno;
                ::unlink(temporary.c_str());
            }
        }
        published_ |= error == 0;
        return error;
    }

    void begin_set() {
        const std::lock_guard lock(mutex_);
        in_set_ = true;
        published_ = false;
        settled_.notify_all();
    }

    void remove(const std::string& path) {
        const std::lock_guard lock(mutex_);
        ::unlink(path.c_str());
        std::erase(paths_, path);
    }

    void abandon() {
        std::unique_lock lock(mutex_);
        // Not for ever: what comes after a picture may be a pipe that nobody reads.
        settled_.wait_for(lock, std::chrono::seconds(2), [this] { return !(in_set_ && published_); });
        abandoned_by_ = std::this_thread::get_id();
        for (const std::string& path : paths_) ::unlink(path.c_str());
        paths_.clear();
    }

private:
    /// The process is about to end by a signal: its exit code must not tell of a fault that there was not.
    void wait_if_abandoned(std::unique_lock<std::mutex>& lock) {
        if (abandoned_by_ == std::thread::id() || abandoned_by_ == std::this_thread::get_id()) return;
        lock.unlock();
        for (;;) ::pause();
    }

    std::mutex mutex_;
    std::vector<std::string> paths_;
    bool in_set_ = false, published_ = false;
    std::condition_variable settled_;
    std::thread::id abandoned_by_;  ///< the only thread that may write; none: all may
};

/// Returns 0 or errno.
int write_all(int fd, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 20));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

/// Waits up to 10 s for a reader of a named pipe, then fails with ENXIO.
int write_in_place(const std::string& path, std::span<const std::uint8_t> bytes, bool pipe) {
    constexpr int kTries = 500;
    constexpr timespec kBetween{0, 20'000'000};  // in all 10 s
    int fd = -1;
    for (int i = 0; i < kTries; ++i) {
        fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
        if (fd >= 0 || errno != ENXIO || !pipe) break;
        (void)::nanosleep(&kBetween, nullptr);
    }
    if (fd < 0) return errno;
    const int flags = ::fcntl(fd, F_GETFL);
    if (flags < 0 || ::fcntl(fd, F_SETFL, flags & ~O_NONBLOCK) != 0) {
        const int error = errno;
        ::close(fd);
        return error;
    }
    const int error = write_all(fd, bytes);
    return ::close(fd) != 0 && error == 0 ? errno : error;
}

std::string temporary_name(const std::string& target) {
    const std::size_t slash = target.rfind('/');
    const std::string directory = slash == std::string::npos ? "" : target.substr(0, slash + 1);
    // A name may be 255 bytes long; what is added here takes up to 30 of them.
    const std::string name = target.substr(directory.size()).substr(0, 220);
    return directory + "." + name + ".halflit-" + std::to_string(::getpid()) + ".tmp";
}

/// Writes a file that has no name yet. replaces: it will take the place of one that has this mode, so that it must be on the disk first.
/// Returns 0 or errno.
int fill(int fd, std::span<const std::uint8_t> bytes, mode_t mode, bool replaces) {
    if (const int error = write_all(fd, bytes); error != 0 || !replaces) return error;
    return ::fchmod(fd, mode) != 0 ? errno : flush(fd);
}

/// The same as replace_file, by a file without a name. None: the file system, or a system without /proc, cannot do it.
std::optional<int> replace_by_unnamed(const std::string& target, std::span<const std::uint8_t> bytes, mode_t mode, bool exists) {
#ifdef O_TMPFILE
    const std::size_t slash = target.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : slash == 0 ? "/" : target.substr(0, slash);
    if (::access("/proc/self/fd", X_OK) != 0) return std::nullopt;
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    if (fd < 0) return std::nullopt;  // the other way names the fault
    int error = fill(fd, bytes, mode, exists);
    bool can_link = true;
    if (error == 0) {
        error = Pending::instance().publish_unnamed(fd, temporary_name(target), target, exists);
        can_link = error != EPERM && error != ENOENT && error != EXDEV && error != EOPNOTSUPP;
    }
    ::close(fd);
    if (!can_link) return std::nullopt;
    return error;
#else
    (void)target, (void)bytes, (void)mode, (void)exists;
    return std::nullopt;
#endif
}

/// Removes temporary files of this target whose process was killed. Only halflit makes names of this form; the process may live on another
/// machine that shares the folder, so a file is left alone for an hour.
void remove_stale(const std::string& target) {
    const std::string own = temporary_name(target);
    const std::size_t slash = own.rfind('/'), number = own.rfind('-') + 1;
    const std::string folder = slash == std::string::npos ? "" : own.substr(0, slash + 1);
    const std::string prefix = own.substr(folder.size(), number - folder.size()), suffix = ".tmp";
    DIR* const list = ::opendir(folder.empty() ? "." : folder.c_str());
    if (list == nullptr) return;
    while (const dirent* entry = ::readdir(list)) {
        const std::string_view name = entry->d_name;
        if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
        const std::string_view digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
        pid_t process = 0;
        const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), process);
        if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size() || process <= 0) continue;
        const std::string path = folder + std::string(name);
        struct stat info {};
        constexpr time_t kHour = 3600;
        if (::stat(path.c_str(), &info) != 0 || ::time(nullptr) - info.st_mtime < kHour) continue;
        if (::kill(process, 0) != 0 && errno == ESRCH) ::unlink(path.c_str());
    }
    ::closedir(list);
}

/// exists: the target is a file, whose mode is kept.
int replace_file(const std::string& target, std::span<const std::uint8_t> bytes, mode_t mode, bool exists) {
    if (const auto done = replace_by_unnamed(target, bytes, mode, exists)) return *done;
    Pending& pending = Pending::instance();
    const std::string temporary = temporary_name(target);
    const int fd = pending.create(temporary, mode);
    if (fd < 0) return errno;
    int error = fill(fd, bytes, mode, exists);
    if (error == 0 && !exists) error = flush(fd);  // another process may make the target before it is renamed
    if (::close(fd) != 0 && error == 0) error = errno;
    if (error != 0) {
        pending.remove(temporary);
        return error;
    }
    error = pending.publish(temporary, target);
    if (error == 0) remove_stale(target);
    return error;
}

}  // namespace

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
    if (path == "-") {
        const int error = write_all(STDOUT_FILENO, bytes);
        if (error != 0) return system_error("standard output", error);
        return {};
    }
    struct stat old {};
    int error = 0;
    if (::stat(path.c_str(), &old) != 0) {
        if (errno != ENOENT) return system_error(path, errno);
        if (path.empty() || path.back() == '/') return system_error(path, path.empty() ? ENOENT : EISDIR);
        error = replace_file(path, bytes, 0666, false);
    } else if (S_ISDIR(old.st_mode)) {
        error = EISDIR;
    } else if (!S_ISREG(old.st_mode)) {
        error = write_in_place(path, bytes, S_ISFIFO(old.st_mode));
        if (error == ENXIO && S_ISFIFO(old.st_mode)) return fail(ErrorCode::io, printable(path) + ": nobody reads this pipe (waited 10 s)");
    } else if (::access(path.c_str(), W_OK) != 0) {
        error = errno;  // a file that may not be written is not replaced either
    } else {
        char* real = ::realpath(path.c_str(), nullptr);
        if (real == nullptr) return system_error(path, errno);
        const std::string target = real;
        std::free(real);
        error = replace_file(target, bytes, old.st_mode & 0777, true);
    }
    if (error != 0) return system_error(path, error);
    return {};
}

void begin_file_set() { Pending::instance().begin_set(); }

void abandon_files() { Pending::instance().abandon(); }

}  // namespace halflit::io
