#include "apps/io/platform/windows/names.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

namespace halflit::platform {
namespace {

/// CON, NUL, COM1 and the like name devices in every folder, with any extension and any spaces before it.
/// https://learn.microsoft.com/windows/win32/fileio/naming-a-file
bool is_device(std::string_view part) {
    const std::string_view name = part.substr(0, part.find('.'));
    constexpr std::size_t kLongest = 7;  // bytes of CONOUT$
    const std::size_t length = name.find_last_not_of(' ') + 1;
    if (length > kLongest) return false;
    std::string stem(name.substr(0, length));
    std::transform(stem.begin(), stem.end(), stem.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (const char* device : {"CON", "PRN", "AUX", "NUL", "CLOCK$", "CONIN$", "CONOUT$"})
        if (stem == device) return true;
    if (!stem.starts_with("COM") && !stem.starts_with("LPT")) return false;
    const std::string_view number = std::string_view(stem).substr(3);
    constexpr std::string_view kSuperscripts[] = {"\xc2\xb9", "\xc2\xb2", "\xc2\xb3"};  // of 1, 2 and 3 count as digits
    return (number.size() == 1 && number[0] >= '0' && number[0] <= '9') ||
           std::find(std::begin(kSuperscripts), std::end(kSuperscripts), number) != std::end(kSuperscripts);
}

/// A switch and no search: a file may hold megabytes of what it calls a name.
bool is_reserved(unsigned char c) {
    switch (c) {
        case '<':
        case '>':
        case '"':
        case '|':
        case '?':
        case '*':
            return true;
        default:
            return c < 0x20;
    }
}

}  // namespace

std::string_view fault_of_part(std::string_view part) {
    if (part.empty() || part == "." || part == "..") return {};
    if (part.find('\\') != std::string_view::npos) return "expected '/' between folders, found '\\'";
    if (part.find(':') != std::string_view::npos) return "names with ':' lead to drives and streams and are not allowed on Windows";
    if (std::any_of(part.begin(), part.end(), is_reserved)) return "holds a character that Windows does not allow in names";
    if (part.ends_with('.') || part.ends_with(' ')) return "names that end in a dot or a space are not allowed on Windows";
    if (is_device(part)) return "names a device of Windows";
    return {};
}

std::string_view fault_of_parts(std::string_view name) {
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t slash = std::min(name.find('/', at), name.size());
        if (const std::string_view fault = fault_of_part(name.substr(at, slash - at)); !fault.empty()) return fault;
        at = slash + 1;
    }
    return {};
}

}  // namespace halflit::platform
