#include "apps/io/platform/windows/wide.hpp"

#include <algorithm>
#include <cerrno>

namespace halflit::platform {

std::wstring wide(std::string_view text) {
    const int bytes = static_cast<int>(std::min<std::size_t>(text.size(), 1u << 20));
    const int count = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text.data(), bytes, nullptr, 0);
    std::wstring made(static_cast<std::size_t>(std::max(count, 0)), L'\0');
    MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text.data(), bytes, made.data(), count);
    if (made.empty() || made.find(L'\0') != std::wstring::npos) {
        errno = EILSEQ;
        return {};
    }
    return made;
}

std::string narrow(std::wstring_view text) {
    const int units = static_cast<int>(std::min<std::size_t>(text.size(), 1u << 20));
    const int count = WideCharToMultiByte(CP_UTF8, 0, text.data(), units, nullptr, 0, nullptr, nullptr);
    std::string made(static_cast<std::size_t>(std::max(count, 0)), '\0');
    WideCharToMultiByte(CP_UTF8, 0, text.data(), units, made.data(), count, nullptr, nullptr);
    return made;
}

std::wstring full_path(const std::wstring& path) {
    std::wstring whole(GetFullPathNameW(path.c_str(), 0, nullptr, nullptr), L'\0');
    whole.resize(GetFullPathNameW(path.c_str(), static_cast<DWORD>(whole.size()), whole.data(), nullptr));
    return whole;
}

std::wstring wide_path(const std::string& path) {
    constexpr std::size_t kLong = 240;  // of 260 that are allowed, and 248 for a folder
    if (path.empty()) {
        errno = ENOENT;
        return {};
    }
    std::wstring made = wide(path);
    if (made.size() < kLong || made.starts_with(L"\\\\?\\")) return made;
    const std::wstring whole = full_path(made);
    if (whole.starts_with(L"\\\\")) return L"\\\\?\\UNC" + whole.substr(1);
    return L"\\\\?\\" + whole;
}

std::string plain_path(std::wstring path) {
    if (path.starts_with(L"\\\\?\\UNC\\"))
        path = L"\\\\" + path.substr(8);
    else if (path.starts_with(L"\\\\?\\"))
        path = path.substr(4);
    std::replace(path.begin(), path.end(), L'\\', L'/');
    return narrow(path);
}

std::wstring final_path(HANDLE file) {
    std::wstring path(MAX_PATH, L'\0');
    for (int attempt = 0; attempt < 3; ++attempt) {
        const DWORD length = GetFinalPathNameByHandleW(file, path.data(), static_cast<DWORD>(path.size()), FILE_NAME_NORMALIZED);
        if (length == 0) break;
        const bool fits = length < path.size();
        path.resize(length);
        if (fits) return path;
    }
    set_errno();
    return {};
}

}  // namespace halflit::platform
