// Files by their names. Names are UTF-8; '/' stands between folders, and on Windows '\\' too. Functions that return an int give 0 or errno.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::platform {

enum class FileKind : std::uint8_t { file, folder, pipe, device };

/// A file's identity, whatever its name.
struct FileId {
    std::uint64_t volume = 0, number = 0;
    auto operator<=>(const FileId&) const = default;
};

struct FileStatus {
    FileKind kind = FileKind::file;
    std::uint64_t bytes = 0;
    FileId id;
    std::int64_t changed_ns = 0;  ///< of its contents, since an epoch of the system's
    unsigned mode = 0;            ///< permissions, where the system has them
};

/// Time since its contents changed.
[[nodiscard]] std::int64_t age_ns(const FileStatus& status);
/// Follows links.
[[nodiscard]] int status_of(const std::string& path, FileStatus& status);
/// True for a symbolic link or a junction, wherever it leads.
[[nodiscard]] bool is_link(const std::string& path);
/// Whether the file, or a new one in the folder, may be written by its permissions. A folder's are not known on Windows.
[[nodiscard]] int may_write(const std::string& file);
[[nodiscard]] int may_write_into(const std::string& folder);
/// The absolute path without links; empty with errno where nothing is there.
[[nodiscard]] std::string real_path(const std::string& path);
/// The same where only some of its folders are there; empty with errno where it cannot be known.
[[nodiscard]] std::string whole_path(const std::string& path);
/// The place that a name below a model's folder leads to, if links are followed; empty: nowhere, or the system's links are not followed.
[[nodiscard]] std::string linked_place(const std::string& path);

/// Makes the folder the current one.
[[nodiscard]] int enter_folder(const std::string& path);
/// The path with '/' for each separator of the system.
[[nodiscard]] std::string with_slashes(std::string path);
/// A reason why the path, with '/', could lead to something else than a file of this machine, as a device or a stream of another file does;
/// empty: none.
[[nodiscard]] std::string_view fault_of_path(std::string_view path);
/// The part before the first name of a path that begins with '/': "/", or on Windows "//" before another computer's.
[[nodiscard]] std::string_view root_of(std::string_view path);
[[nodiscard]] bool is_absolute(std::string_view path);
/// Place of the last separator of folders, or npos.
[[nodiscard]] std::size_t last_separator(std::string_view path);
/// Names of a folder's entries, at most `most`, in no order; "": the current folder.
[[nodiscard]] std::vector<std::string> names_in(const std::string& folder, std::size_t most);

[[nodiscard]] int remove_file(const std::string& path);
/// Replaces `to` in one step.
[[nodiscard]] int rename_over(const std::string& from, const std::string& to);
/// A new or emptied file of text; "-": standard output, at whose end it writes. Null with errno.
[[nodiscard]] std::FILE* open_for_lines(const std::string& path);

}  // namespace halflit::platform
