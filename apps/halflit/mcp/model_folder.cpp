#include "apps/halflit/mcp/model_folder.hpp"

#include "apps/halflit/program/file_names.hpp"
#include "apps/halflit/render/built_in_scenes.hpp"

#include <algorithm>
#include <system_error>

namespace halflit::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPath = 4096;

}  // namespace

Result<ModelFolder> ModelFolder::enter(const std::string& path, bool allow_external) {
    std::error_code error;
    ModelFolder folder;
    folder.root_ = fs::canonical(path, error);
    if (!error) fs::current_path(folder.root_, error);
    if (error) return fail(ErrorCode::io, "--root " + path + ": " + error.message());
    folder.allow_external_ = allow_external;
    return folder;
}

Result<fs::path> ModelFolder::resolved(const std::string& path) const {
    if (path.empty() || path.size() > kLongestPath || path.find('\0') != std::string::npos)
        return fail(ErrorCode::usage, "expected the path of a file");
    std::error_code error;
    fs::path whole = fs::weakly_canonical(root_ / path, error);
    if (error) return fail(ErrorCode::io, path + ": " + error.message());
    // A link that leads nowhere stays in the path. A file that is written through it would lie elsewhere.
    if (fs::is_symlink(fs::symlink_status(whole, error))) return fail(ErrorCode::io, path + ": no such file");
    return whole;
}

bool ModelFolder::holds(const fs::path& path) const {
    const auto [end, rest] = std::mismatch(root_.begin(), root_.end(), path.begin(), path.end());
    return end == root_.end() && rest != path.end();
}

std::string ModelFolder::shown(const fs::path& path) const {
    if (!holds(path)) return path.string();
    std::string relative = path.lexically_relative(root_).string();
    return is_built_in_name(relative) || relative.starts_with('-') ? "./" + relative : relative;
}

Result<std::string> ModelFolder::to_read(const std::string& path) const {
    auto whole = resolved(path);
    if (!whole) return tl::unexpected(whole.error());
    if (!holds(*whole) && !allow_external_)
        return fail(ErrorCode::io, path + ": leads out of the folder that the server may read (--root, --allow-external)");
    std::error_code error;
    const std::string name = shown(*whole);
    if (!fs::exists(*whole, error)) return fail(ErrorCode::io, path + ": no such file" + did_you_mean_file(name));
    if (!fs::is_regular_file(*whole, error)) return fail(ErrorCode::io, path + ": expected a file");
    return name;
}

Result<std::string> ModelFolder::to_write(const std::string& path) const {
    auto whole = resolved(path);
    if (!whole) return tl::unexpected(whole.error());
    if (!holds(*whole)) return fail(ErrorCode::io, path + ": leads out of the folder that the server may write into (--root)");
    std::error_code error;
    if (fs::exists(*whole, error) && !fs::is_regular_file(*whole, error)) return fail(ErrorCode::io, path + ": expected a file");
    return shown(*whole);
}

}  // namespace halflit::cli
