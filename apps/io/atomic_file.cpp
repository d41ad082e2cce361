#include "apps/io/atomic_file.hpp"

#include "apps/io/errno_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

namespace halflit::io {
namespace {

tl::unexpected<Error> system_error(const std::string& place, int error) {
    return fail(ErrorCode::io, error == EPIPE ? std::string() : place + ": " + errno_text(error));
}

/// The temporary files that exist now, for abandon_files.
class Pending {
public:
    static Pending& instance() {
        static Pending pending;
        return pending;
    }

    /// Creates a file and returns its descriptor, or -1 with errno.
    int create(const std::string& path, mode_t mode) {
        const std::lock_guard lock(mutex_);
        if (closed_to_this_thread()) return errno = EINTR, -1;
        constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW;
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
        const std::lock_guard lock(mutex_);
        if (closed_to_this_thread()) return EINTR;
        const int error = std::rename(path.c_str(), target.c_str()) == 0 ? 0 : errno;
        if (error != 0) ::unlink(path.c_str());
        std::erase(paths_, path);
        return error;
    }

    void remove(const std::string& path) {
        const std::lock_guard lock(mutex_);
        ::unlink(path.c_str());
        std::erase(paths_, path);
    }

    void abandon() {
        const std::lock_guard lock(mutex_);
        abandoned_by_ = std::this_thread::get_id();
        for (const std::string& path : paths_) ::unlink(path.c_str());
        paths_.clear();
    }

private:
    [[nodiscard]] bool closed_to_this_thread() const {
        return abandoned_by_ != std::thread::id() && abandoned_by_ != std::this_thread::get_id();
    }

    std::mutex mutex_;
    std::vector<std::string> paths_;
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

int write_in_place(const std::string& path, std::span<const std::uint8_t> bytes) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) return errno;
    const int error = write_all(fd, bytes);
    return ::close(fd) != 0 && error == 0 ? errno : error;
}

/// Returns 0 or errno. File systems without fsync give EINVAL or ENOSYS, which count as success.
int flush(int fd) { return ::fsync(fd) == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno; }

std::string temporary_name(const std::string& target) {
    const std::size_t slash = target.rfind('/');
    const std::string directory = slash == std::string::npos ? "" : target.substr(0, slash + 1);
    // A name may be 255 bytes long; what is added here takes up to 30 of them.
    const std::string name = target.substr(directory.size()).substr(0, 220);
    return directory + "." + name + ".halflit-" + std::to_string(::getpid()) + ".tmp";
}

int replace_file(const std::string& target, std::span<const std::uint8_t> bytes, mode_t mode, bool keep_mode) {
    Pending& pending = Pending::instance();
    const std::string temporary = temporary_name(target);
    const int fd = pending.create(temporary, mode);
    if (fd < 0) return errno;
    int error = write_all(fd, bytes);
    if (error == 0 && keep_mode && ::fchmod(fd, mode) != 0) error = errno;
    if (error == 0) error = flush(fd);
    if (::close(fd) != 0 && error == 0) error = errno;
    if (error != 0) {
        pending.remove(temporary);
        return error;
    }
    return pending.publish(temporary, target);
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
        error = write_in_place(path, bytes);
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

void abandon_files() { Pending::instance().abandon(); }

}  // namespace halflit::io
