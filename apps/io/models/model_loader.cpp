#include "halflit/model.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/model_files.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/gltf/loader.hpp"
#include "apps/io/models/formats.hpp"
#include "apps/io/models/importer.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/platform/files.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

namespace halflit {

using namespace io::detail;
using io::folder_of, io::printable, io::read_file;

namespace {

/// Text of two bytes a character, which begins with a mark, as UTF-8; empty if it is none, and by the strict rules. A half of a pair
/// becomes '?'.
std::string utf8_of_utf16(std::span<const std::byte> bytes, bool strict) {
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
    if (strict || bytes.size() < 4 || fits_binary_stl(bytes)) return {};
    const bool little = at(0) == 0xFF && at(1) == 0xFE && at(3) == 0, big = at(0) == 0xFE && at(1) == 0xFF && at(2) == 0;
    if (!little && !big) return {};
    const auto unit = [&](std::size_t i) { return little ? at(i) | at(i + 1) << 8 : at(i) << 8 | at(i + 1); };
    std::string text;
    text.reserve(bytes.size() / 2);
    TimeCheck check;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        check();
        std::uint32_t code = unit(i);
        if (code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
            i += 2;
        } else if (code >= 0xD800 && code < 0xE000) {
            code = '?';
        }
        const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
        if (code < 0x80) {
            put(code);
        } else if (code < 0x800) {
            put(0xC0 | code >> 6), put(0x80 | (code & 0x3F));
        } else if (code < 0x10000) {
            put(0xE0 | code >> 12), put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
        } else {
            put(0xF0 | code >> 18), put(0x80 | (code >> 12 & 0x3F)), put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
        }
    }
    return text;
}

std::string name_of(const std::string& path) {
    const std::size_t slash = platform::last_separator(path);
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

}  // namespace

Result<std::vector<std::string>> io::files_named_by(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<std::vector<std::string>> {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return std::vector<std::string>{};
        const WorkLimit work(allowed_work(options.limits, bytes->size()));
        const std::string text = utf8_of_utf16(*bytes, options.strict);
        const std::span<const std::byte> read = text.empty() ? std::span<const std::byte>(*bytes) : std::as_bytes(std::span(text));
        const FormatRow* const row = find_format(read);
        if (row == nullptr || row->files == nullptr) return std::vector<std::string>{};
        try {
            return row->files({read, folder_of(path), name_of(path)}, options);
        } catch (const LoadFailure&) {
            return std::vector<std::string>{};
        }
    });
}

namespace {

LoadedScene read_model(const ModelFile& file, const LoadOptions& options) {
    const std::span<const std::byte> bytes = file.bytes;
    const WorkLimit work(allowed_work(options.limits, bytes.size()));
    if (bytes.size() > options.limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {} (max_file_bytes)", bytes.size(), options.limits.max_file_bytes),
               ErrorCode::limit);
    if (const std::string text = utf8_of_utf16(bytes, options.strict); !text.empty()) {
        LoadedScene loaded = read_model({std::as_bytes(std::span(text)), file.folder, file.name}, options);
        loaded.warnings.emplace_back("the text has two bytes a character (UTF-16), read as such");
        return loaded;
    }
    if (bytes.empty()) refuse("", "the file is empty");
    if (auto imported = read_by_importer(file, options)) return *std::move(imported);
    const FormatRow* const row = find_format(bytes);
    const ForeignFormat* foreign = find_foreign_format(file);
    if (foreign == nullptr && row == nullptr) foreign = find_foreign_name(file.name);
    if (foreign != nullptr && foreign->picture != nullptr)
        if (auto loaded = foreign->picture(file, options)) {
            if (foreign->picture == read_cad) loaded->info.format = foreign->name;
            return *std::move(loaded);
        }
    if (foreign != nullptr) refuse("", fmt::format("is {}, which is not read; {}", foreign->name, foreign->advice));
    if (row == nullptr) refuse("", "is no model: expected " + list_of_formats(&FormatRow::name));
    return row->read(file, options);
}

}  // namespace

Result<LoadedScene> load_model_bytes(std::span<const std::byte> bytes, const std::string& name, const std::string& base_dir,
                                     const LoadOptions& options) {
    return errors_of(name, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        return read_model({bytes, base_dir, name_of(name)}, options);
    });
}

Result<LoadedScene> load_model(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return tl::unexpected(bytes.error());
        const io::TakenBytes taken(*bytes);
        return read_model({*bytes, folder_of(path), name_of(path)}, options);
    });
}

}  // namespace halflit
