// Texts and handles of Windows, and its errors as errno.
#pragma once

#include "apps/io/platform/handles.hpp"

#include <cstdint>
#include <string>
#include <string_view>

#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace halflit::platform {

/// UTF-16 of UTF-8. Nothing, with errno EILSEQ, where it is not UTF-8 or holds a zero.
[[nodiscard]] std::wstring wide(std::string_view text);
[[nodiscard]] std::string narrow(std::wstring_view text);
/// The same for a path. A long one becomes absolute, with the prefix that allows more than 260 letters. "" stays empty, with ENOENT.
[[nodiscard]] std::wstring wide_path(const std::string& path);
/// The path from its drive on, by the text alone.
[[nodiscard]] std::wstring full_path(const std::wstring& path);
/// A path that Windows tells, with '/' and without the prefix "\\?\".
[[nodiscard]] std::string plain_path(std::wstring path);
/// The path of an open file without links; empty with errno.
[[nodiscard]] std::wstring final_path(HANDLE file);

[[nodiscard]] inline HANDLE native(NativeHandle handle) { return reinterpret_cast<HANDLE>(handle); }

/// Others may read, write, rename and delete a file that is open here.
inline constexpr DWORD kShareAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
inline constexpr std::int64_t kTickNs = 100;  ///< of a FILETIME

[[nodiscard]] int errno_of(DWORD error);
/// Sets errno to what GetLastError() tells, and returns it.
int set_errno();

}  // namespace halflit::platform
