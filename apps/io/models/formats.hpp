// The formats of models: one row for each. Reading, the files that a model refers to, names in messages and names of files go through it.
#pragma once

#include "apps/io/models/importer.hpp"
#include "apps/io/models/model_readers.hpp"
#include "halflit/model.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// The begin of a file, for the formats' scores.
struct FileBegin {
    explicit FileBegin(std::span<const std::byte> whole);
    /// The first word of its text, past a byte order mark, empty lines and comments (#).
    [[nodiscard]] std::string_view word() const {
        return lines.empty() ? std::string_view() : lines[0].substr(0, lines[0].find_first_of(" \t\v\f"));
    }

    std::span<const std::byte> bytes;  ///< of the whole file
    bool is_text;                      ///< begins_as_text()
    std::vector<std::string_view>
        lines;  ///< the first ones that are neither empty nor a comment, without blanks around; of binary files, one
};

struct FormatRow {
    ModelFormat format;
    std::string_view name;       ///< model_format_name()
    std::string_view extension;  ///< of files, with its point
    /// How much the begin of a file looks like this format: 0 not at all.
    int (*likeness)(const FileBegin& begin);
    /// Throws LoadFailure.
    LoadedScene (*read)(const ModelFile&, const LoadOptions&);
    /// Paths of all files that the model names, whether or not they exist; null: it names none. Throws LoadFailure.
    std::vector<std::string> (*files)(const ModelFile&, const LoadOptions&);
};

/// In the order in which they are asked; of equal likeness the first counts.
[[nodiscard]] std::span<const FormatRow> formats();
/// The row of a file's content; null: of none.
[[nodiscard]] const FormatRow* find_format(std::span<const std::byte> bytes);
/// "A, B or C" of all formats' names or extensions, in the order of ModelFormat; behind them those of ForeignFormat::is_drawn().
[[nodiscard]] std::string list_of_formats(std::string_view FormatRow::*column);
/// True for a name with the extension of a format that is drawn.
[[nodiscard]] bool is_model_name(std::string_view name);

/// A format that is known and not read, one of 3D Gaussians, or one that an importer reads.
struct ForeignFormat {
    std::string_view name;
    std::string_view extensions;  ///< of files, without points, by blanks
    std::string_view begins;      ///< the file's first bytes, or those at `offset`; empty: its files have no mark
    std::string_view advice;      ///< how to come to a format that is read
    std::string_view holds = {};  ///< stands in the first kilobyte too
    std::size_t offset = 0;
    bool (*is_it)(std::span<const std::byte> bytes) = nullptr;  ///< what else holds of its files; null: nothing
    /// Draws 3D Gaussians, or a picture that its files may hold; null: they hold none.
    std::optional<LoadedScene> (*picture)(const ModelFile&, const LoadOptions&) = nullptr;

    /// Files with its extensions are models.
    [[nodiscard]] bool is_drawn() const { return picture != nullptr && (picture == read_cad || name.starts_with("3D Gaussians")); }
};

/// The format of a file that begins as one of a known format without a row above: it is not read, or drawn by `picture` alone; null:
/// none. Among several, the one of the name's extension.
[[nodiscard]] const ForeignFormat* find_foreign_format(const ModelFile& file);
/// The format of the name's extension alone, for files whose content says nothing.
[[nodiscard]] const ForeignFormat* find_foreign_name(std::string_view name);

}  // namespace halflit::io::detail
