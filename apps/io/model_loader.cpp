#include "halflit/model.hpp"

#include "apps/io/detail/gltf_choices.hpp"
#include "apps/io/detail/load_failure.hpp"
#include "apps/io/detail/model_readers.hpp"
#include "apps/io/file_access.hpp"
#include "apps/io/model_files.hpp"
#include "apps/io/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

namespace halflit {

using namespace io::detail;
using io::folder_of, io::printable, io::read_file;

namespace {

LoadedScene read(ModelFormat format, std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    switch (format) {
        case ModelFormat::stl:
            return read_stl(bytes, options);
        case ModelFormat::ply:
            return read_ply(bytes, base_dir, options);
        case ModelFormat::obj:
            return read_obj(bytes, base_dir, options);
        default:
            return read_three_mf(bytes, options);
    }
}

}  // namespace

std::string io::folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

Result<std::vector<std::string>> io::files_named_by(const std::string& path, const LoadOptions& options) {
    const TimeLimit limit(options.limits.time_limit_s);
    try {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        const auto format = bytes ? find_model_format(*bytes) : std::nullopt;
        if (!format) return std::vector<std::string>{};
        if (*format == ModelFormat::gltf || *format == ModelFormat::glb) return io::files_of_gltf(*bytes, folder_of(path), options);
        if (*format == ModelFormat::obj) return files_of_obj(*bytes, folder_of(path), options);
        if (*format == ModelFormat::ply) return files_of_ply(*bytes, folder_of(path), options);
        return std::vector<std::string>{};
    } catch (const LoadFailure&) {
        return std::vector<std::string>{};
    } catch (const OutOfTime&) {
        return fail(ErrorCode::limit, printable(path) + ": " + kOutOfTime);
    }
}

Result<LoadedScene> load_model_bytes(std::span<const std::byte> bytes, const std::string& name, const std::string& base_dir,
                                     const LoadOptions& options) {
    return errors_of(name, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        if (bytes.size() > options.limits.max_file_bytes)
            refuse("", fmt::format("has {} bytes, the limit is {}", bytes.size(), options.limits.max_file_bytes), ErrorCode::limit);
        const std::optional<ModelFormat> format = find_model_format(bytes);
        // The glTF reader says what is wrong with a file that is nothing at all.
        if (!format && !bytes.empty()) refuse("", "is no model: expected glTF, GLB, STL, PLY, OBJ or 3MF");
        if (!format || *format == ModelFormat::gltf || *format == ModelFormat::glb) return load_gltf_bytes(bytes, name, base_dir, options);
        check_threads(options);
        refuse_choices(options);
        return read(*format, bytes, base_dir, options);
    });
}

Result<LoadedScene> load_model(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return tl::unexpected(bytes.error());
        return load_model_bytes(*bytes, path, folder_of(path), options);
    });
}

}  // namespace halflit
