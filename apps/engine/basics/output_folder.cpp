#include "apps/engine/basics/output_folder.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/platform/paths.hpp"

#include <fmt/core.h>

#include <filesystem>

namespace halflit::engine {

Result<std::string> parse_folder(const std::string& text) {
    if (text.empty() || text == "-" || (io::is_picture_name(text) && !is_folder(text)))
        return fail(ErrorCode::usage, "expected a folder, found '" + text + "'");
    return text;
}

Result<void> make_folder(const std::string& path) {
    std::error_code error;
    const std::filesystem::path folder = platform::to_path(path);
    std::filesystem::create_directories(folder, error);
    if (!error && !std::filesystem::is_directory(folder, error)) error = std::make_error_code(std::errc::not_a_directory);
    if (error) return fail(ErrorCode::io, fmt::format("{}: {}", printable(path), error.message()));
    return {};
}

}  // namespace halflit::engine
