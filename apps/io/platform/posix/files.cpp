#include "apps/io/platform/files.hpp"

#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/posix/status.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <system_error>

namespace halflit::platform {
namespace {

// strerror_r returns the text (GNU) or writes it into the buffer (POSIX).
const char* error_words(const char* text, const char* /*buffer*/) { return text; }
[[maybe_unused]] const char* error_words(int /*failed*/, const char* buffer) { return buffer; }

}  // namespace

std::string errno_text(int error) {
    char buffer[128] = "";
    return error_words(::strerror_r(error, buffer, sizeof buffer), buffer);
}

std::int64_t age_ns(const FileStatus& status) { return std::int64_t{::time(nullptr)} * 1'000'000'000 - status.changed_ns; }

int status_of(const std::string& path, FileStatus& status) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) return errno;
    status = to_status(info);
    return 0;
}

bool is_link(const std::string& path) {
    struct stat info {};
    return ::lstat(path.c_str(), &info) == 0 && S_ISLNK(info.st_mode);
}

int may_write(const std::string& file) { return ::access(file.c_str(), W_OK) == 0 ? 0 : errno; }

int may_write_into(const std::string& folder) { return ::access(folder.c_str(), W_OK | X_OK) == 0 ? 0 : errno; }

std::string real_path(const std::string& path) {
    const std::unique_ptr<char, void (*)(void*)> found(::realpath(path.c_str(), nullptr), ::free);
    return found == nullptr ? "" : found.get();
}

std::string whole_path(const std::string& path) {
    namespace fs = std::filesystem;
    constexpr int kMostLinks = 40;  // as the kernel allows
    std::error_code error;
    fs::path whole = fs::weakly_canonical(path, error);
    for (int i = 0; !error && i < kMostLinks && is_link(whole.string()); ++i) {  // a link to what is not there
        const fs::path target = fs::read_symlink(whole, error);
        if (!error) whole = fs::weakly_canonical(whole.parent_path() / target, error);
    }
    errno = error.value();
    return error ? "" : whole.string();
}

std::string linked_place(const std::string& path) { return real_path(path); }

int enter_folder(const std::string& path) { return ::chdir(path.c_str()) == 0 ? 0 : errno; }

std::string with_slashes(std::string path) { return path; }

std::string_view fault_of_path(std::string_view /*path*/) { return {}; }

std::string_view root_of(std::string_view /*path*/) { return "/"; }

bool is_absolute(std::string_view path) { return path.starts_with('/'); }

std::size_t last_separator(std::string_view path) { return path.rfind('/'); }

std::vector<std::string> names_in(const std::string& folder, std::size_t most) {
    const Handle opened = open_folder(folder.empty() ? "." : folder);
    return opened.is_open() ? names_in(opened.get(), most) : std::vector<std::string>();
}

int remove_file(const std::string& path) { return ::unlink(path.c_str()) == 0 ? 0 : errno; }

int rename_over(const std::string& from, const std::string& to) { return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno; }

std::FILE* open_for_lines(const std::string& path) {
    return std::fopen(path == "-" ? "/dev/stdout" : path.c_str(), path == "-" ? "a" : "w");
}

}  // namespace halflit::platform
