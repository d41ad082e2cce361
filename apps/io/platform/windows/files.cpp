#include "apps/io/platform/files.hpp"

#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/windows/names.hpp"
#include "apps/io/platform/windows/wide.hpp"

#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <new>

namespace halflit::platform {
namespace {

/// Opens a file or folder for what it is, not for what it holds. It follows links.
Handle open_to_ask(const std::string& path) {
    const std::wstring name = wide_path(path);
    if (name.empty()) return {};
    Handle file(reinterpret_cast<NativeHandle>(
        CreateFileW(name.c_str(), FILE_READ_ATTRIBUTES, kShareAll, nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr)));
    if (!file.is_open()) set_errno();
    return file;
}

std::int64_t now_ns() {
    FILETIME now{};
    GetSystemTimeAsFileTime(&now);
    return static_cast<std::int64_t>(std::uint64_t{now.dwHighDateTime} << 32 | now.dwLowDateTime) * kTickNs;
}

/// As POSIX's rename: who has the old file open keeps it. Windows has it since version 10, for NTFS.
bool rename_at_once(const std::wstring& from, const std::wstring& to) {
    struct RenameInfo {  // FILE_RENAME_INFO of newer headers
        DWORD flags;
        HANDLE folder;
        DWORD name_bytes;
        wchar_t name[1];
    };
    constexpr auto kRenameInfoEx = static_cast<FILE_INFO_BY_HANDLE_CLASS>(22);
    constexpr DWORD kReplace = 1, kPosixSemantics = 2;
    Handle file(reinterpret_cast<NativeHandle>(
        CreateFileW(from.c_str(), DELETE | SYNCHRONIZE, kShareAll, nullptr, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr)));
    if (!file.is_open()) return false;
    const std::wstring whole = to.starts_with(L"\\\\?\\") ? to : full_path(to);
    std::vector<std::uint64_t> memory((sizeof(RenameInfo) + whole.size() * sizeof(wchar_t)) / sizeof(std::uint64_t) + 1);
    auto* const info =
        new (memory.data()) RenameInfo{kReplace | kPosixSemantics, nullptr, static_cast<DWORD>(whole.size() * sizeof(wchar_t)), {}};
    std::memcpy(reinterpret_cast<char*>(info) + offsetof(RenameInfo, name), whole.data(), whole.size() * sizeof(wchar_t));
    return SetFileInformationByHandle(reinterpret_cast<HANDLE>(file.get()), kRenameInfoEx, info,
                                      static_cast<DWORD>(memory.size() * sizeof(std::uint64_t))) != 0;
}

}  // namespace

std::int64_t age_ns(const FileStatus& status) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(now_ns()) - static_cast<std::uint64_t>(status.changed_ns));
}

int status_of(const std::string& path, FileStatus& status) {
    if (with_slashes(path).starts_with("//./pipe/")) {  // to open it would be to use it
        status = {};
        status.kind = FileKind::pipe;
        return 0;
    }
    const Handle file = open_to_ask(path);
    return file.is_open() ? status_of(file.get(), status) : errno;
}

bool is_link(const std::string& path) {
    const std::wstring name = wide_path(path);
    WIN32_FIND_DATAW entry{};
    const HANDLE search = name.empty() ? INVALID_HANDLE_VALUE : FindFirstFileW(name.c_str(), &entry);
    if (search == INVALID_HANDLE_VALUE) return false;
    FindClose(search);
    return (entry.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0 && IsReparseTagNameSurrogate(entry.dwReserved0);
}

int may_write(const std::string& file) {
    const std::wstring name = wide_path(file);
    const DWORD attributes = name.empty() ? INVALID_FILE_ATTRIBUTES : GetFileAttributesW(name.c_str());
    if (attributes == INVALID_FILE_ATTRIBUTES) return name.empty() ? errno : set_errno();
    return (attributes & FILE_ATTRIBUTE_READONLY) != 0 ? EACCES : 0;
}

int may_write_into(const std::string& folder) {
    FileStatus status;
    if (const int error = status_of(folder, status); error != 0) return error;
    return status.kind == FileKind::folder ? 0 : ENOTDIR;
}

std::string real_path(const std::string& path) {
    const Handle file = open_to_ask(path);
    return file.is_open() ? plain_path(final_path(reinterpret_cast<HANDLE>(file.get()))) : "";
}

std::string whole_path(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path whole = fs::absolute(fs::path(wide(path)), ignored).lexically_normal();
    // The longest part that exists of a path that does not.
    fs::path there = whole, rest;
    for (;;) {
        const std::string name = narrow(there.native());
        if (const std::string real = real_path(name); !real.empty()) {
            const fs::path made = rest.empty() ? fs::path(wide(real)) : fs::path(wide(real)) / rest;
            return plain_path(made.native());
        }
        // A file that is there and cannot be judged, as a link to a volume without a letter, could lead anywhere.
        const int error = errno;
        const bool is_missing = (error == ENOENT || error == ENOTDIR) && !is_link(name);
        errno = error;
        if (!is_missing || !there.has_relative_path()) return {};
        if (const fs::path last = there.filename(); !last.empty()) rest = rest.empty() ? last : last / rest;
        there = there.parent_path();
    }
}

std::string linked_place(const std::string& /*path*/) { return {}; }

int enter_folder(const std::string& path) {
    const std::wstring name = wide_path(path);
    if (name.empty()) return errno;
    return SetCurrentDirectoryW(name.c_str()) ? 0 : set_errno();
}

std::string with_slashes(std::string path) {
    std::replace(path.begin(), path.end(), '\\', '/');
    return path;
}

std::string_view fault_of_path(std::string_view path) {
    if (path.starts_with("//")) return "names of computers and devices are not allowed";
    const bool has_drive = path.size() > 2 && path[1] == ':' && path[2] == '/' && std::isalpha(static_cast<unsigned char>(path[0])) != 0;
    return fault_of_parts(has_drive ? path.substr(2) : path);
}

std::string_view root_of(std::string_view path) { return path.starts_with("//") ? "//" : "/"; }

bool is_absolute(std::string_view path) {
    const auto is_separator = [](char c) { return c == '/' || c == '\\'; };
    return (!path.empty() && is_separator(path[0])) || (path.size() > 2 && path[1] == ':' && is_separator(path[2]));
}

std::size_t last_separator(std::string_view path) { return path.find_last_of("/\\"); }

std::vector<std::string> names_in(const std::string& folder, std::size_t most) {
    std::vector<std::string> names;
    std::wstring pattern = wide_path(folder.empty() ? "." : folder);
    if (pattern.empty()) return names;
    pattern += L"\\*";
    WIN32_FIND_DATAW entry{};
    const HANDLE search = FindFirstFileW(pattern.c_str(), &entry);
    if (search == INVALID_HANDLE_VALUE) return names;
    do names.push_back(narrow(entry.cFileName));
    while (names.size() < most && FindNextFileW(search, &entry));
    FindClose(search);
    return names;
}

int remove_file(const std::string& path) {
    const std::wstring name = wide_path(path);
    if (name.empty()) return errno;
    return DeleteFileW(name.c_str()) ? 0 : set_errno();
}

int rename_over(const std::string& from, const std::string& to) {
    const std::wstring old_name = wide_path(from), new_name = wide_path(to);
    if (old_name.empty() || new_name.empty()) return errno;
    if (rename_at_once(old_name, new_name)) return 0;
    // A scanner or an indexer may hold the old file for a moment.
    constexpr int kTries = 20;
    constexpr DWORD kBetweenMs = 10;
    for (int i = 0; i < kTries; ++i) {
        if (i > 0) Sleep(kBetweenMs);
        if (MoveFileExW(old_name.c_str(), new_name.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) return 0;
        if (GetLastError() != ERROR_SHARING_VIOLATION && GetLastError() != ERROR_ACCESS_DENIED) break;
    }
    return set_errno();
}

std::FILE* open_for_lines(const std::string& path) {
    if (path == "-") {
        const int copy = _dup(_fileno(stdout));
        return copy < 0 ? nullptr : _fdopen(copy, "ab");
    }
    const std::wstring name = wide_path(path);
    return name.empty() ? nullptr : _wfopen(name.c_str(), L"wb");
}

}  // namespace halflit::platform
