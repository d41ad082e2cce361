#include "halflit/model.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/model_files.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/gltf/loader.hpp"
#include "apps/io/models/formats.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

namespace halflit {

using namespace io::detail;
using io::folder_of, io::printable, io::read_file;

Result<std::vector<std::string>> io::files_named_by(const std::string& path, const LoadOptions& options) {
    const TimeLimit limit(options.limits.time_limit_s);
    try {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        const FormatRow* const row = bytes ? find_format(*bytes) : nullptr;
        if (row == nullptr || row->files == nullptr) return std::vector<std::string>{};
        return row->files(*bytes, folder_of(path), options);
    } catch (const LoadFailure&) {
        return std::vector<std::string>{};
    } catch (const OutOfTime&) {
        return fail(ErrorCode::limit, printable(path) + ": " + kOutOfTime);
    }
}

namespace {

LoadedScene read_model(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    if (bytes.size() > options.limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {} (max_file_bytes)", bytes.size(), options.limits.max_file_bytes),
               ErrorCode::limit);
    const FormatRow* const row = find_format(bytes);
    // The glTF reader says what is wrong with a file that is nothing at all.
    if (const ForeignFormat* const foreign = find_foreign_format(bytes))
        refuse("", fmt::format("is {}, which is not read; {}", foreign->name, foreign->advice));
    if (row == nullptr && !bytes.empty()) refuse("", "is no model: expected " + list_of_formats(&FormatRow::name));
    return row == nullptr ? read_gltf(bytes, base_dir, options) : row->read(bytes, base_dir, options);
}

}  // namespace

Result<LoadedScene> load_model_bytes(std::span<const std::byte> bytes, const std::string& name, const std::string& base_dir,
                                     const LoadOptions& options) {
    return errors_of(name, options.limits.time_limit_s, [&]() -> Result<LoadedScene> { return read_model(bytes, base_dir, options); });
}

Result<LoadedScene> load_model(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return tl::unexpected(bytes.error());
        return read_model(*bytes, folder_of(path), options);
    });
}

}  // namespace halflit
