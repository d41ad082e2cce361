// Open files and folders. Functions that fail set errno, on Windows too.
#pragma once

#include "apps/io/platform/files.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::platform {

/// A file descriptor of POSIX, or a HANDLE of Windows.
using NativeHandle = std::intptr_t;
inline constexpr NativeHandle kNoHandle = -1;

/// Returns 0 or errno.
int close_handle(NativeHandle handle);

class Handle {
public:
    Handle() = default;
    explicit Handle(NativeHandle handle) : handle_(handle) {}
    ~Handle() { (void)close(); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, kNoHandle)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    [[nodiscard]] bool is_open() const { return handle_ != kNoHandle; }
    [[nodiscard]] NativeHandle get() const { return handle_; }
    [[nodiscard]] NativeHandle release() { return std::exchange(handle_, kNoHandle); }
    /// Returns 0 or errno.
    int close() { return is_open() ? close_handle(release()) : 0; }

private:
    NativeHandle handle_ = kNoHandle;
};

/// Opens what the user named. It may be a folder or a device; a pipe without a writer does not make it wait.
[[nodiscard]] Handle open_to_read(const std::string& path);
/// Opens a folder for open_beneath() alone.
[[nodiscard]] Handle open_folder(const std::string& path);
/// Opens a name below a folder; '/' stands between folders. Never opens what lies outside: fails with EXDEV or ELOOP for a name that leads
/// out, by itself or by a link. Linux follows links that stay inside; other systems follow none.
[[nodiscard]] Handle open_beneath(NativeHandle folder, const std::string& relative);
/// A reason why the system could take the name below a folder for something else than a file there: a device, a stream of another file, a
/// drive. Empty: none, which open_beneath() expects.
[[nodiscard]] std::string_view fault_of_name(std::string_view relative);
/// Names of the entries of a folder that is open for reading, at most `most`, in no order.
[[nodiscard]] std::vector<std::string> names_in(NativeHandle folder, std::size_t most);

/// Returns 0 or errno.
int status_of(NativeHandle handle, FileStatus& status);
/// Reads up to `bytes`. Returns how many, 0 at the end, or -1 with errno.
[[nodiscard]] std::ptrdiff_t read_some(NativeHandle handle, void* into, std::size_t bytes);
/// Returns 0 or errno; EPIPE where nobody reads.
int write_all(NativeHandle handle, std::span<const std::uint8_t> bytes);
/// Waits until the file is on its disk. Returns 0 or errno; file systems that cannot do it count as success.
int flush(NativeHandle handle);

/// Creates a file that must not exist. mode: its permissions, where the system has them.
[[nodiscard]] Handle create_new(const std::string& path, unsigned mode);
/// Creates a file without a name in a folder ("": the current one). Not open where the system or the file system has no such files.
[[nodiscard]] Handle create_unnamed(const std::string& folder, unsigned mode);
/// Gives such a file a name that must not exist. Returns 0 or errno.
int name_unnamed(NativeHandle handle, const std::string& path);
/// Returns 0 or errno.
int set_mode(NativeHandle handle, unsigned mode);
/// Opens a device or a pipe for writing. A pipe's reader is waited for up to 10 s; then it fails with ENXIO.
[[nodiscard]] Handle open_in_place(const std::string& path, bool is_pipe);

[[nodiscard]] NativeHandle standard_input();
[[nodiscard]] NativeHandle standard_output();

}  // namespace halflit::platform
