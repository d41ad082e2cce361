#include "apps/io/platform/handles.hpp"

#include "apps/io/platform/windows/wide.hpp"

#include <algorithm>
#include <cerrno>

namespace halflit::platform {
namespace {

Handle open(const std::string& path, DWORD access, DWORD how, DWORD flags) {
    const std::wstring name = wide_path(path);
    if (name.empty()) return {};
    Handle file(reinterpret_cast<NativeHandle>(CreateFileW(name.c_str(), access, kShareAll, nullptr, how, flags, nullptr)));
    if (!file.is_open()) set_errno();
    return file;
}

}  // namespace

int close_handle(NativeHandle handle) { return CloseHandle(native(handle)) ? 0 : set_errno(); }

// Backup semantics: folders can be opened too, and their status shows what they are.
Handle open_to_read(const std::string& path) { return open(path, GENERIC_READ, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS); }

Handle open_folder(const std::string& path) {
    Handle folder = open(path, FILE_LIST_DIRECTORY | FILE_TRAVERSE | FILE_READ_ATTRIBUTES, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    FileStatus status;
    if (!folder.is_open() || status_of(folder.get(), status) != 0 || status.kind == FileKind::folder) return folder;
    (void)folder.close();
    errno = ENOTDIR;
    return {};
}

std::vector<std::string> names_in(NativeHandle folder, std::size_t most) {
    const std::wstring path = final_path(native(folder));
    return path.empty() ? std::vector<std::string>() : names_in(narrow(path), most);
}

int status_of(NativeHandle handle, FileStatus& status) {
    status = {};
    const DWORD type = GetFileType(native(handle));
    if (type != FILE_TYPE_DISK) {
        if (type == FILE_TYPE_UNKNOWN && GetLastError() != NO_ERROR) return set_errno();
        status.kind = type == FILE_TYPE_PIPE ? FileKind::pipe : FileKind::device;
        return 0;
    }
    BY_HANDLE_FILE_INFORMATION info{};
    if (!GetFileInformationByHandle(native(handle), &info)) return set_errno();
    const auto joined = [](DWORD high, DWORD low) { return std::uint64_t{high} << 32 | low; };
    status.kind = (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0 ? FileKind::folder : FileKind::file;
    status.bytes = joined(info.nFileSizeHigh, info.nFileSizeLow);
    status.id = {info.dwVolumeSerialNumber, joined(info.nFileIndexHigh, info.nFileIndexLow)};
    status.changed_ns =
        static_cast<std::int64_t>(joined(info.ftLastWriteTime.dwHighDateTime, info.ftLastWriteTime.dwLowDateTime) * kTickNs);
    return 0;
}

std::ptrdiff_t read_some(NativeHandle handle, void* into, std::size_t bytes) {
    DWORD got = 0;
    if (ReadFile(native(handle), into, static_cast<DWORD>(std::min<std::size_t>(bytes, 1u << 20)), &got, nullptr)) return got;
    if (GetLastError() == ERROR_BROKEN_PIPE || GetLastError() == ERROR_HANDLE_EOF) return 0;  // its writer has closed it
    set_errno();
    return -1;
}

int write_all(NativeHandle handle, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        DWORD written = 0;
        if (!WriteFile(native(handle), bytes.data(), static_cast<DWORD>(std::min<std::size_t>(bytes.size(), 1u << 20)), &written, nullptr))
            return set_errno();
        bytes = bytes.subspan(written);
    }
    return 0;
}

int flush(NativeHandle handle) {
    if (FlushFileBuffers(native(handle)) || GetLastError() == ERROR_INVALID_FUNCTION || GetLastError() == ERROR_NOT_SUPPORTED) return 0;
    return set_errno();
}

Handle create_new(const std::string& path, unsigned /*mode*/) { return open(path, GENERIC_WRITE, CREATE_NEW, FILE_ATTRIBUTE_NORMAL); }

// A file that is deleted on its closing cannot be kept by all of Windows's file systems, so each has a name from the start.
Handle create_unnamed(const std::string& /*folder*/, unsigned /*mode*/) { return {}; }
int name_unnamed(NativeHandle /*handle*/, const std::string& /*path*/) { return ENOSYS; }
int set_mode(NativeHandle /*handle*/, unsigned /*mode*/) { return 0; }

Handle open_in_place(const std::string& path, bool is_pipe) {
    constexpr int kTries = 500;
    constexpr DWORD kBetweenMs = 20;  // in all 10 s
    for (int i = 0; i < kTries; ++i) {
        Handle file = open(path, GENERIC_WRITE, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL);
        if (file.is_open() || GetLastError() != ERROR_PIPE_BUSY || !is_pipe) return file;
        Sleep(kBetweenMs);
    }
    errno = ENXIO;
    return {};
}

NativeHandle standard_input() { return reinterpret_cast<NativeHandle>(GetStdHandle(STD_INPUT_HANDLE)); }
NativeHandle standard_output() { return reinterpret_cast<NativeHandle>(GetStdHandle(STD_OUTPUT_HANDLE)); }

}  // namespace halflit::platform
