#include "apps/io/file_access.hpp"

#include "apps/io/errno_text.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined(__linux__)
#include <linux/openat2.h>
#include <sys/syscall.h>
#endif

namespace halflit::io {

namespace {

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    [[nodiscard]] int get() const { return fd_; }

private:
    int fd_;
};

// O_NONBLOCK: opening a FIFO without a writer returns at once, and fstat then refuses it.
constexpr int kOpenFlags = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;

/// Reads an open file that must be regular. `cannot_read` is the code for faults of the file system.
Result<std::vector<std::byte>> read_regular(int fd, std::size_t max_bytes, ErrorCode cannot_read) {
    struct stat info {};
    if (::fstat(fd, &info) != 0) return fail(cannot_read, fmt::format("cannot be read: {}", errno_text(errno)));
    if (!S_ISREG(info.st_mode))
        return fail(cannot_read, S_ISDIR(info.st_mode) ? "is a directory, expected a file" : "is not a regular file");
    const std::uint64_t size = static_cast<std::uint64_t>(info.st_size);
    if (size > max_bytes) return fail(ErrorCode::limit, fmt::format("has {} bytes, the limit is {}", size, max_bytes));
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::size_t have = 0;
    while (have < bytes.size()) {
        const ssize_t got = ::read(fd, bytes.data() + have, bytes.size() - have);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return fail(cannot_read, fmt::format("cannot be read: {}", errno_text(errno)));
        if (got == 0) return fail(ErrorCode::bad_input, fmt::format("ended after {} of {} bytes while it was read", have, bytes.size()));
        have += static_cast<std::size_t>(got);
    }
    std::byte extra{};
    if (::read(fd, &extra, 1) > 0) return fail(ErrorCode::bad_input, "grew while it was read");
    return bytes;
}

/// Opens component by component and follows no symbolic link. Used where openat2 is missing (before Linux 5.6) or filtered.
Descriptor open_by_walk(int folder, const std::string& relative) {
    Descriptor current(::fcntl(folder, F_DUPFD_CLOEXEC, 0));
    std::size_t begin = 0;
    while (current.get() >= 0) {
        const std::size_t slash = relative.find('/', begin);
        const std::string part = relative.substr(begin, slash == std::string::npos ? std::string::npos : slash - begin);
        const bool last = slash == std::string::npos;
        if (part == "..") {
            errno = EXDEV;
            return Descriptor(-1);
        }
        if (!part.empty() && part != ".")
            current = Descriptor(::openat(current.get(), part.c_str(), kOpenFlags | O_NOFOLLOW | (last ? 0 : O_DIRECTORY)));
        if (last) break;
        begin = slash + 1;
    }
    return current;
}

Descriptor open_beneath(int folder, const std::string& relative) {
#if defined(SYS_openat2)
    struct open_how how {};
    how.flags = static_cast<std::uint64_t>(kOpenFlags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    for (int attempt = 0; attempt < 3; ++attempt) {
        const long fd = ::syscall(SYS_openat2, folder, relative.c_str(), &how, sizeof how);
        if (fd >= 0) return Descriptor(static_cast<int>(fd));
        if (errno == EAGAIN || errno == EINTR) continue;  // a rename raced with the lookup
        if (errno != ENOSYS && errno != EPERM) return Descriptor(-1);
        break;
    }
#endif
    return open_by_walk(folder, relative);
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes) {
    const Descriptor file(::open(path.c_str(), kOpenFlags));
    if (file.get() < 0) return fail(ErrorCode::io, fmt::format("{}: cannot be opened: {}", printable(path), errno_text(errno)));
    auto bytes = read_regular(file.get(), max_bytes, ErrorCode::io);
    if (!bytes) return fail(bytes.error().code, fmt::format("{}: {}", printable(path), bytes.error().message));
    return bytes;
}

ModelFolder::ModelFolder(std::string base_dir, std::vector<std::string> also_allowed) : base_dir_(std::move(base_dir)) {
    if (!base_dir_.empty()) folders_.push_back(::open(base_dir_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (const std::string& folder : also_allowed) folders_.push_back(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
}

ModelFolder::~ModelFolder() {
    for (const int fd : folders_)
        if (fd >= 0) ::close(fd);
}

Result<std::vector<std::byte>> ModelFolder::read(std::string_view relative, std::size_t max_bytes) const {
    const std::string shown = printable(relative);
    const auto refuse = [&](std::string why) { return fail(ErrorCode::bad_input, fmt::format("\"{}\": {}", shown, why)); };
    if (folders_.empty()) return refuse("the model has no folder to read other files from");
    if (relative.empty()) return refuse("expected a file name");
    if (relative.find('\0') != std::string_view::npos) return refuse("a file name cannot hold a zero byte");
    if (relative.find('\\') != std::string_view::npos) return refuse("expected '/' between folders, found '\\'");
    if (relative.front() == '/') return refuse("absolute names are not allowed, expected one below the model's folder");

    int error = ENOENT;
    for (const int folder : folders_) {
        if (folder < 0) continue;
        const Descriptor file = open_beneath(folder, std::string(relative));
        if (file.get() < 0) {
            if (error == ENOENT) error = errno;
            continue;
        }
        auto bytes = read_regular(file.get(), max_bytes, ErrorCode::bad_input);
        if (!bytes) return fail(bytes.error().code, fmt::format("\"{}\": {}", shown, bytes.error().message));
        return bytes;
    }
    if (error == EXDEV || error == ELOOP) return refuse("leads out of the model's folder");
    if (error == ENOENT) return refuse("no such file");
    return refuse(fmt::format("cannot be opened: {}", errno_text(error)));
}

}  // namespace halflit::io
