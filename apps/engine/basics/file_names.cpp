#include "apps/engine/basics/file_names.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/formats.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>

namespace halflit::engine {
namespace {

using platform::FileKind, platform::FileStatus;

/// "models/" for "models/duck.glb"; empty for a name without a folder.
std::string folder_prefix(const std::string& path) { return path.substr(0, platform::last_separator(path) + 1); }  // npos + 1 is 0

/// Place of the next character in UTF-8.
std::size_t next_character(std::string_view text, std::size_t at) {
    do ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0u) == 0x80u);
    return at;
}

tl::unexpected<Error> refused(const std::string& path, int error) { return fail(ErrorCode::io, path + ": " + platform::errno_text(error)); }

}  // namespace

bool is_file(const std::string& path) {
    FileStatus status;
    return platform::status_of(path, status) == 0 && status.kind != FileKind::folder;
}

bool is_there(const std::string& path) {
    FileStatus status;
    return platform::status_of(path, status) == 0 && status.bytes > 0;
}

bool is_free_or_begins_with(const std::string& path, char first) {
    FileStatus status;
    if (path.empty() || path == "-" || platform::status_of(path, status) != 0 || status.kind != FileKind::file) return true;
    const platform::Handle file = platform::open_to_read(path);
    char found = 0;
    return !file.is_open() || platform::read_some(file.get(), &found, 1) != 1 || found == first;
}

bool is_folder(const std::string& path) {
    FileStatus status;
    return platform::status_of(path, status) == 0 && status.kind == FileKind::folder;
}

bool same_file(const std::string& a, const std::string& b) {
    FileStatus first, second;
    const bool a_is_there = platform::status_of(a, first) == 0, b_is_there = platform::status_of(b, second) == 0;
    if (a_is_there && b_is_there) return first.id == second.id;
    return !a_is_there && !b_is_there && platform::whole_path(a) == platform::whole_path(b);
}

bool is_model_name(std::string_view path) { return io::detail::is_model_name(path); }

bool fits_pattern(std::string_view pattern, std::string_view text, bool fold) {
    const auto same = [fold](char a, char b) { return a == b || (fold && io::lower(a) == io::lower(b)); };
    constexpr std::size_t kNone = std::string_view::npos;
    std::size_t p = 0, t = 0, star = kNone, star_end = 0;  // after a failure, the last star takes one more character
    TimeCheck check;
    while (t < text.size()) {
        check();
        if (p < pattern.size() && pattern[p] == '*') {
            star = ++p, star_end = t;
        } else if (p < pattern.size() && pattern[p] == '?') {
            ++p, t = next_character(text, t);
        } else if (p < pattern.size() && same(pattern[p], text[t])) {
            ++p, ++t;
        } else if (star != kNone) {
            p = star, t = star_end = next_character(text, star_end);
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == kNone;
}

std::vector<std::string> models_named(const std::string& word) {
    constexpr std::size_t kMostNames = 100'000;
    const bool folder = is_folder(word);
    if (!folder && (word.find_first_of("*?") == std::string::npos || is_file(word))) return {};
    const std::string prefix = folder ? path_in(word, "") : folder_prefix(word);
    const std::string pattern = folder ? "*" : word.substr(prefix.size());
    std::vector<std::string> models;
    for (const std::string& name : platform::names_in(prefix, kMostNames))
        if (is_model_name(name) && fits_pattern(pattern, name, true) && is_file(prefix + name)) models.push_back(prefix + name);
    std::sort(models.begin(), models.end());
    return models;
}

Result<std::vector<std::string>> with_models_named(const std::vector<std::string>& words) {
    std::vector<std::string> scenes;
    for (const std::string& word : words) {
        const std::vector<std::string> models = models_named(word);
        if (models.empty() && is_folder(word))
            return fail(ErrorCode::usage, word + ": is a folder without models; folders in it are not looked into");
        if (models.empty() && word.find_first_of("*?") != std::string::npos && !is_file(word) && !io::is_picture_name(word))
            return fail(ErrorCode::usage, word + ": no model fits; * and ? stand for parts of a file's name, not of a folder's");
        if (models.empty()) scenes.push_back(word);
        scenes.insert(scenes.end(), models.begin(), models.end());
    }
    return scenes;
}

std::vector<std::string> files_beside(const std::string& path) {
    constexpr std::size_t kMostNames = 1000;
    const std::string prefix = folder_prefix(path);
    std::vector<std::string> files;
    for (const std::string& name : platform::names_in(prefix, kMostNames))
        if (is_file(prefix + name)) files.push_back(prefix + name);
    return files;
}

std::string did_you_mean_file(const std::string& path, std::vector<std::string> names) {
    if (path.empty() || is_file(path) || is_folder(path)) return {};
    for (std::string& file : files_beside(path)) names.push_back(std::move(file));
    return did_you_mean(path, names);
}

Result<void> check_writable(const std::string& path) {
    if (path == "-") return {};
    FileStatus status;
    std::string target = path;
    if (platform::status_of(path, status) == 0) {
        if (status.kind == FileKind::folder) return refused(path, EISDIR);
        if (const int error = platform::may_write(path); error != 0) return refused(path, error);
        if (status.kind != FileKind::file) return {};  // a device is written in place
        if (std::string real = platform::real_path(path); !real.empty()) target = std::move(real);
    } else if (platform::is_link(path)) {
        target = platform::whole_path(path);
    }
    const std::string prefix = folder_prefix(target), folder = prefix.empty() ? "." : prefix;
    if (const int error = platform::may_write_into(folder); error != 0) return refused(path + ": the folder " + folder, error);
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
    return folder.empty() || platform::last_separator(folder) + 1 == folder.size() ? folder + name : folder + "/" + name;
}

}  // namespace halflit::engine
