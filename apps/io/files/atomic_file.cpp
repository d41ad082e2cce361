#include "apps/io/files/atomic_file.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/process.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace halflit::io {
namespace {

using platform::FileKind, platform::FileStatus, platform::Handle;

tl::unexpected<Error> system_error(const std::string& place, int error) {
    return fail(error == ENOMEM ? ErrorCode::limit : ErrorCode::io,
                error == EPIPE ? std::string() : place + ": " + platform::errno_text(error));
}

/// The temporary files that exist now, for abandon_files.
class Pending {
public:
    static Pending& instance() {
        static Pending& pending = *new Pending;  // never destroyed: at the process's end a thread may wait in abandon()
        return pending;
    }

    /// Creates a file; not open with errno where that fails.
    Handle create(const std::string& path, unsigned mode) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        std::string listed = path;
        paths_.reserve(paths_.size() + 1);  // so that no exception leaves a file that is not listed
        Handle file = platform::create_new(path, mode);
        if (!file.is_open() && errno == EEXIST) {
            // Left over from a killed process that had the same process id.
            (void)platform::remove_file(path);
            file = platform::create_new(path, mode);
        }
        if (file.is_open()) paths_.push_back(std::move(listed));
        return file;
    }

    /// Renames the temporary file to the target. Returns 0 or errno; the temporary file is gone either way.
    int publish(const std::string& path, const std::string& target) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        const int error = platform::rename_over(path, target);
        if (error != 0) (void)platform::remove_file(path);
        std::erase(paths_, path);
        published_ |= error == 0;
        return error;
    }

    /// Gives a file without a name the target's. Returns 0 or errno. A kill leaves no other file behind, except between two system calls
    /// where the target exists and has to be replaced.
    int publish_unnamed(const Handle& file, const std::string& temporary, const std::string& target, bool exists) {
        std::unique_lock lock(mutex_);
        wait_if_abandoned(lock);
        int error = exists ? EEXIST : platform::name_unnamed(file.get(), target);
        if (error == EEXIST) {
            (void)platform::remove_file(temporary);
            error = exists ? 0 : platform::flush(file.get());  // another process has made the target meanwhile
            if (error == 0) error = platform::name_unnamed(file.get(), temporary);
            if (error == 0) {
                error = platform::rename_over(temporary, target);
                if (error != 0) (void)platform::remove_file(temporary);
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
        (void)platform::remove_file(path);
        std::erase(paths_, path);
    }

    void abandon() {
        std::unique_lock lock(mutex_);
        // Not for ever: what comes after a picture may be a pipe that nobody reads.
        settled_.wait_for(lock, std::chrono::seconds(2), [this] { return !(in_set_ && published_); });
        abandoned_by_ = std::this_thread::get_id();
        for (const std::string& path : paths_) (void)platform::remove_file(path);
        paths_.clear();
    }

private:
    /// The process is about to end by a signal: its exit code must not tell of a fault that there was not.
    void wait_if_abandoned(std::unique_lock<std::mutex>& lock) {
        if (abandoned_by_ == std::thread::id() || abandoned_by_ == std::this_thread::get_id()) return;
        lock.unlock();
        platform::wait_for_end();
    }

    std::mutex mutex_;
    std::vector<std::string> paths_;
    bool in_set_ = false, published_ = false;
    std::condition_variable settled_;
    std::thread::id abandoned_by_;  ///< the only thread that may write; none: all may
};

/// Returns 0 or errno.
int write_in_place(const std::string& path, std::span<const std::uint8_t> bytes, bool is_pipe) {
    Handle file = platform::open_in_place(path, is_pipe);
    if (!file.is_open()) return errno;
    const int error = platform::write_all(file.get(), bytes);
    const int closed = file.close();
    return error != 0 ? error : closed;
}

std::string temporary_name(const std::string& target) {
    const std::string directory = target.substr(0, platform::last_separator(target) + 1);  // npos + 1 is 0
    // A name may be 255 bytes long; what is added here takes up to 30 of them.
    std::string name = target.substr(directory.size());
    std::size_t bytes = std::min<std::size_t>(name.size(), 220);
    while (bytes > 0 && bytes < name.size() && (name[bytes] & 0xc0) == 0x80) --bytes;  // a letter stays whole
    name.resize(bytes);
    return directory + "." + name + ".halflit-" + std::to_string(platform::process_id()) + ".tmp";
}

/// Writes a file that has no name yet. replaces: it will take the place of one that has this mode, so that it must be on the disk first.
/// Returns 0 or errno.
int fill(const Handle& file, std::span<const std::uint8_t> bytes, unsigned mode, bool replaces) {
    if (const int error = platform::write_all(file.get(), bytes); error != 0 || !replaces) return error;
    if (const int error = platform::set_mode(file.get(), mode); error != 0) return error;
    return platform::flush(file.get());
}

/// The same as replace_file, by a file without a name. None: the file system, or a system without /proc, cannot do it.
std::optional<int> replace_by_unnamed(const std::string& target, std::span<const std::uint8_t> bytes, unsigned mode, bool exists) {
    const std::size_t slash = platform::last_separator(target);
    const Handle file = platform::create_unnamed(target.substr(0, slash == std::string::npos ? 0 : std::max<std::size_t>(slash, 1)), mode);
    if (!file.is_open()) return std::nullopt;  // the other way names the fault
    int error = fill(file, bytes, mode, exists);
    bool can_link = true;
    if (error == 0) {
        error = Pending::instance().publish_unnamed(file, temporary_name(target), target, exists);
        can_link = error != EPERM && error != ENOENT && error != EXDEV && error != EOPNOTSUPP;
    }
    if (!can_link) return std::nullopt;
    return error;
}

/// Removes temporary files of this target whose process was killed. Only halflit makes names of this form; the process may live on another
/// machine that shares the folder, so a file is left alone for an hour.
void remove_stale(const std::string& target) {
    constexpr std::size_t kMostNames = std::size_t{1} << 20;
    constexpr std::int64_t kHourNs = std::int64_t{3600} * 1'000'000'000;
    const std::string own = temporary_name(target);
    const std::size_t number = own.rfind('-') + 1;
    const std::string folder = own.substr(0, platform::last_separator(own) + 1);
    const std::string prefix = own.substr(folder.size(), number - folder.size()), suffix = ".tmp";
    for (const std::string& name : platform::names_in(folder, kMostNames)) {
        if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
        const char* const digits_end = name.data() + name.size() - suffix.size();
        std::int32_t process = 0;
        const auto parsed = std::from_chars(name.data() + prefix.size(), digits_end, process);
        if (parsed.ec != std::errc() || parsed.ptr != digits_end || process <= 0) continue;
        const std::string path = folder + name;
        FileStatus info;
        if (platform::status_of(path, info) != 0 || platform::age_ns(info) < kHourNs) continue;
        if (!platform::may_be_running(process)) (void)platform::remove_file(path);
    }
}

/// exists: the target is a file, whose mode is kept.
int replace_file(const std::string& target, std::span<const std::uint8_t> bytes, unsigned mode, bool exists) {
    if (const auto done = replace_by_unnamed(target, bytes, mode, exists)) return *done;
    Pending& pending = Pending::instance();
    const std::string temporary = temporary_name(target);
    Handle file = pending.create(temporary, mode);
    if (!file.is_open()) return errno;
    int error = fill(file, bytes, mode, exists);
    if (error == 0 && !exists) error = platform::flush(file.get());  // another process may make the target before it is renamed
    if (const int closed = file.close(); error == 0) error = closed;
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
        const int error = platform::write_all(platform::standard_output(), bytes);
        if (error != 0) return system_error("standard output", error);
        return {};
    }
    FileStatus old;
    int error = platform::status_of(path, old);
    if (error == ENOENT) {
        if (path.empty() || platform::last_separator(path) == path.size() - 1) return system_error(path, path.empty() ? ENOENT : EISDIR);
        const std::string target = platform::is_link(path) ? platform::whole_path(path) : path;  // a link to what is not there yet
        if (target.empty()) return system_error(path, errno);
        error = replace_file(target, bytes, 0666, false);
    } else if (error != 0) {
        return system_error(path, error);
    } else if (old.kind == FileKind::folder) {
        error = EISDIR;
    } else if (old.kind != FileKind::file) {
        const bool is_pipe = old.kind == FileKind::pipe;
        error = write_in_place(path, bytes, is_pipe);
        if (error == ENXIO && is_pipe) return fail(ErrorCode::io, printable(path) + ": nobody reads this pipe (waited 10 s)");
    } else {
        error = platform::may_write(path);  // a file that may not be written is not replaced either
        if (error == 0) {
            const std::string target = platform::is_link(path) ? platform::real_path(path) : path;
            if (target.empty()) return system_error(path, errno);
            error = replace_file(target, bytes, old.mode, true);
        }
    }
    if (error != 0) return system_error(path, error);
    return {};
}

void begin_file_set() { Pending::instance().begin_set(); }

void abandon_files() { Pending::instance().abandon(); }

}  // namespace halflit::io
