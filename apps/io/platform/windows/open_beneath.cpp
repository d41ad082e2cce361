#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/windows/names.hpp"
#include "apps/io/platform/windows/wide.hpp"

#include <winternl.h>

#include <algorithm>
#include <cerrno>

namespace halflit::platform {
namespace {

/// Opens one entry of an open folder by the kernel's own call, which knows no current folder, no drives, no devices and no "..".
/// through_links: otherwise a link itself is opened. Not open with errno.
Handle open_entry(NativeHandle folder, std::string_view name, bool is_folder, bool through_links) {
    std::wstring text = wide(name);
    if (text.empty()) return {};
    UNICODE_STRING wide_name{};
    wide_name.Buffer = text.data();
    wide_name.Length = wide_name.MaximumLength = static_cast<USHORT>(std::min<std::size_t>(text.size(), 32000) * sizeof(wchar_t));
    OBJECT_ATTRIBUTES attributes{};
    InitializeObjectAttributes(&attributes, &wide_name, OBJ_CASE_INSENSITIVE, native(folder), nullptr);
    IO_STATUS_BLOCK status{};
    HANDLE made = nullptr;
    constexpr ULONG kToRead = FILE_READ_DATA | FILE_READ_ATTRIBUTES | SYNCHRONIZE;
    const ULONG options =
        FILE_SYNCHRONOUS_IO_NONALERT | (is_folder ? FILE_DIRECTORY_FILE : 0) | (through_links ? 0 : FILE_OPEN_REPARSE_POINT);
    const NTSTATUS result = NtCreateFile(&made, kToRead, &attributes, &status, nullptr, 0, kShareAll, FILE_OPEN, options, nullptr, 0);
    if (result < 0) {
        errno = errno_of(RtlNtStatusToDosError(result));
        return {};
    }
    return Handle(reinterpret_cast<NativeHandle>(made));
}

/// Links are reparse points whose tag says that they stand for another name: symbolic links and junctions. Others hold the file's own
/// contents in a way of their own, such as files that a cloud's service fetches.
enum class Reparse { none, link, own_contents };

Reparse reparse_of(NativeHandle file) {
    FILE_ATTRIBUTE_TAG_INFO info{};
    if (!GetFileInformationByHandleEx(native(file), FileAttributeTagInfo, &info, sizeof info)) {
        BY_HANDLE_FILE_INFORMATION plain{};
        if (!GetFileInformationByHandle(native(file), &plain)) return Reparse::link;
        return (plain.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0 ? Reparse::link : Reparse::none;
    }
    if ((info.FileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) == 0) return Reparse::none;
    return IsReparseTagNameSurrogate(info.ReparseTag) ? Reparse::link : Reparse::own_contents;
}

/// Both by the system's own spelling. A file that lies elsewhere on the disk has another beginning.
bool lies_in(NativeHandle file, NativeHandle folder) {
    std::wstring inside = final_path(native(file)), outside = final_path(native(folder));
    if (inside.empty() || outside.empty()) return false;
    if (!outside.ends_with(L'\\')) outside += L'\\';
    return inside.starts_with(outside);
}

}  // namespace

std::string_view fault_of_name(std::string_view relative) { return fault_of_parts(relative); }

Handle open_beneath(NativeHandle folder, const std::string& relative) {
    HANDLE copy = nullptr;
    if (!DuplicateHandle(GetCurrentProcess(), native(folder), GetCurrentProcess(), &copy, 0, FALSE, DUPLICATE_SAME_ACCESS)) {
        set_errno();
        return {};
    }
    Handle current(reinterpret_cast<NativeHandle>(copy));
    for (std::size_t at = 0; at < relative.size();) {
        const std::size_t slash = std::min(relative.find('/', at), relative.size());
        const std::string_view part = std::string_view(relative).substr(at, slash - at);
        at = slash + 1;
        if (part.empty() || part == ".") continue;
        if (part == ".." || !fault_of_part(part).empty()) {
            errno = EXDEV;
            return {};
        }
        const bool is_folder = slash < relative.size();
        Handle next = open_entry(current.get(), part, is_folder, false);
        if (!next.is_open()) return {};
        Reparse reparse = reparse_of(next.get());
        if (reparse == Reparse::own_contents) {
            next = open_entry(current.get(), part, is_folder, true);
            if (!next.is_open()) return {};
            if (!lies_in(next.get(), current.get())) reparse = Reparse::link;  // it was exchanged meanwhile
        }
        if (reparse == Reparse::link) {
            errno = ELOOP;
            return {};
        }
        current = std::move(next);
    }
    return current;
}

}  // namespace halflit::platform
