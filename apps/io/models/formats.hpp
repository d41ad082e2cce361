// The formats of models: one row for each. Reading, the files that a model refers to, names in messages and names of files go through it.
#pragma once

#include "halflit/model.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// The begin of a file, for the formats' tests.
struct FileBegin {
    std::span<const std::byte> bytes;  ///< of the whole file
    std::string_view word;             ///< the first word of its text, past a byte order mark, empty lines and comments (#)
};

enum class Likeness : std::uint8_t { none, perhaps, certain };

struct FormatRow {
    ModelFormat format;
    std::string_view name;       ///< model_format_name()
    std::string_view extension;  ///< of files, with its point
    Likeness (*likeness)(const FileBegin& begin);
    /// Throws LoadFailure. bytes, folder for files that it refers to, options.
    LoadedScene (*read)(std::span<const std::byte>, const std::string&, const LoadOptions&);
    /// Paths of all files that the model names, whether or not they exist; null: it names none. Throws LoadFailure.
    std::vector<std::string> (*files)(std::span<const std::byte>, const std::string&, const LoadOptions&);
};

/// In the order in which their tests are asked; of equal likeness the first counts.
[[nodiscard]] std::span<const FormatRow> formats();
/// The row of a file's content; null: of none.
[[nodiscard]] const FormatRow* find_format(std::span<const std::byte> bytes);
/// "A, B or C" of all formats' names or extensions, in the order of ModelFormat.
[[nodiscard]] std::string list_of_formats(std::string_view FormatRow::*column);

/// A format that is known and not read.
struct ForeignFormat {
    std::string_view name, begins;  ///< begins: the file's first bytes, or those at `offset`
    std::string_view advice;        ///< how to come to a format that is read
    std::size_t offset = 0;
    bool (*is_it)(std::span<const std::byte> bytes) = nullptr;  ///< what else holds of its files; null: nothing
};

/// The format of a file that begins as one of a known format that is not read; null: none.
[[nodiscard]] const ForeignFormat* find_foreign_format(std::span<const std::byte> bytes);

}  // namespace halflit::io::detail
