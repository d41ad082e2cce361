#include "apps/halflit/program/file_names.hpp"

#include "apps/halflit/program/spelling.hpp"
#include "apps/io/files/errno_text.hpp"
#include "apps/io/models/formats.hpp"

#include <fmt/format.h>

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

namespace halflit::cli {
namespace {

/// "models/" for "models/duck.glb"; empty for a name without a folder.
std::string folder_prefix(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }  // npos + 1 is 0

bool ends_with_any_case(std::string_view text, std::string_view end) {
    if (text.size() < end.size()) return false;
    for (std::size_t i = 0; i < end.size(); ++i) {
        const char c = text[text.size() - end.size() + i];
        if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != end[i]) return false;
    }
    return true;
}

tl::unexpected<Error> refused(const std::string& path, int error) { return fail(ErrorCode::io, path + ": " + io::errno_text(error)); }

}  // namespace

bool is_file(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && !S_ISDIR(status.st_mode);
}

bool is_there(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && status.st_size > 0;
}

bool is_free_or_begins_with(const std::string& path, char first) {
    struct stat status {};
    if (path.empty() || path == "-" || ::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return true;
    std::ifstream file(path, std::ios::binary);
    char found = 0;
    return !file.get(found) || found == first;
}

bool is_folder(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

bool same_file(const std::string& a, const std::string& b) {
    struct stat first {
    }, second{};
    const bool a_is_there = ::stat(a.c_str(), &first) == 0, b_is_there = ::stat(b.c_str(), &second) == 0;
    if (a_is_there && b_is_there) return first.st_dev == second.st_dev && first.st_ino == second.st_ino;
    if (a_is_there || b_is_there) return false;
    std::error_code ignored;
    return std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored);
}

bool is_model_name(std::string_view path) {
    const auto rows = io::detail::formats();
    return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return ends_with_any_case(path, row.extension); });
}

std::vector<std::string> files_beside(const std::string& path) {
    constexpr std::size_t kMostNames = 1000;
    const std::string prefix = folder_prefix(path);
    std::vector<std::string> files;
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(prefix.empty() ? "." : prefix.c_str()), &::closedir);
    if (!folder) return files;
    for (std::size_t i = 0; i < kMostNames; ++i) {
        const struct dirent* entry = ::readdir(folder.get());
        if (entry == nullptr) break;
        if (is_file(prefix + entry->d_name)) files.push_back(prefix + entry->d_name);
    }
    return files;
}

std::string did_you_mean_file(const std::string& path, std::vector<std::string> names) {
    if (path.empty() || is_file(path) || is_folder(path)) return {};
    for (std::string& file : files_beside(path)) names.push_back(std::move(file));
    return did_you_mean(path, names);
}

Result<void> check_writable(const std::string& path) {
    if (path == "-") return {};
    struct stat status {};
    std::string target = path;
    if (::stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) return refused(path, EISDIR);
        if (::access(path.c_str(), W_OK) != 0) return refused(path, errno);
        if (!S_ISREG(status.st_mode)) return {};  // a device is written in place
        if (char* real = ::realpath(path.c_str(), nullptr)) {
            target = real;
            std::free(real);
        }
    }
    const std::string prefix = folder_prefix(target), folder = prefix.empty() ? "." : prefix;
    if (::access(folder.c_str(), W_OK | X_OK) != 0) return refused(path + ": the folder " + folder, errno);
    return {};
}

std::string stem_of(const std::string& path) {
    const std::string name = path.substr(folder_prefix(path).size());
    return name.substr(0, name.rfind('.'));
}

bool is_pattern(std::string_view name) { return name.find('{') != std::string_view::npos; }

Result<std::string> fill_pattern(const std::string& pattern, std::string_view expected,
                                 const std::function<std::optional<std::string>(std::string_view)>& text_of) {
    std::string name;
    for (std::size_t at = 0; at < pattern.size(); ++at) {
        if (pattern[at] != '{') {
            name += pattern[at];
            continue;
        }
        const std::size_t end = pattern.find('}', at);
        const auto text = end == std::string::npos ? std::nullopt : text_of(std::string_view(pattern).substr(at + 1, end - at - 1));
        if (!text)
            return fail(ErrorCode::usage, fmt::format("-o {}: expected {}, found {}", pattern, expected,
                                                      pattern.substr(at, end == std::string::npos ? end : end + 1 - at)));
        name += *text;
        at = end;
    }
    return name;
}

std::optional<std::string> digits_for(std::string_view word, std::string_view name, std::int64_t number) {
    if (!word.starts_with(name)) return std::nullopt;
    word.remove_prefix(name.size());
    if (word.empty()) return std::to_string(number);
    if (word.size() != 3 || !word.starts_with(":0") || word[2] < '1' || word[2] > '9') return std::nullopt;
    return fmt::format("{:0{}}", number, word[2] - '0');
}

std::string path_in(const std::string& folder, const std::string& name) {
    return folder.empty() || folder.ends_with('/') ? folder + name : folder + "/" + name;
}

}  // namespace halflit::cli
