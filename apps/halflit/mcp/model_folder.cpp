#include "apps/halflit/mcp/model_folder.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/built_in_scenes.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"

#include <cerrno>
#include <system_error>

namespace halflit::cli {
namespace {

using platform::FileKind;

constexpr std::size_t kLongestPath = 4096;

}  // namespace

Result<ModelFolder> ModelFolder::enter(const std::string& path, bool allow_external) {
    ModelFolder folder;
    folder.root_ = platform::real_path(path);
    const int error = folder.root_.empty() ? errno : platform::enter_folder(folder.root_);
    if (error != 0) return fail(ErrorCode::io, "--root " + path + ": " + platform::errno_text(error));
    folder.root_ = path_in(folder.root_, "");
    folder.allow_external_ = allow_external;
    return folder;
}

Result<std::string> ModelFolder::resolved(const std::string& path) const {
    if (path.empty() || path.size() > kLongestPath || path.find('\0') != std::string::npos)
        return fail(ErrorCode::usage, "expected the path of a file");
    const std::string typed = platform::with_slashes(path);
    if (const std::string_view fault = platform::fault_of_path(typed); !fault.empty())
        return fail(ErrorCode::io, path + ": " + std::string(fault));
    std::string whole = platform::whole_path(platform::is_absolute(typed) ? typed : root_ + typed);
    if (whole.empty()) return fail(ErrorCode::io, path + ": " + platform::errno_text(errno));
    // A link that leads nowhere stays in the path. A file that is written through it would lie elsewhere.
    if (platform::is_link(whole)) return fail(ErrorCode::io, path + ": no such file");
    return whole;
}

bool ModelFolder::holds(const std::string& path) const { return path.size() > root_.size() && path.starts_with(root_); }

std::string ModelFolder::shown(const std::string& path) const {
    if (!holds(path)) return path;
    std::string relative = path.substr(root_.size());
    return is_built_in_name(relative) || relative.starts_with('-') ? "./" + relative : relative;
}

Result<std::string> ModelFolder::to_read(const std::string& path) const {
    auto whole = resolved(path);
    if (!whole) return tl::unexpected(whole.error());
    if (!holds(*whole) && !allow_external_)
        return fail(ErrorCode::io, path + ": leads out of the folder that the server may read (--root, --allow-external)");
    const std::string name = shown(*whole);
    platform::FileStatus status;
    if (platform::status_of(*whole, status) != 0) return fail(ErrorCode::io, path + ": no such file" + did_you_mean_file(name));
    if (status.kind != FileKind::file) return fail(ErrorCode::io, path + ": expected a file");
    return name;
}

Result<std::string> ModelFolder::to_write(const std::string& path) const {
    auto whole = resolved(path);
    if (!whole) return tl::unexpected(whole.error());
    if (!holds(*whole)) return fail(ErrorCode::io, path + ": leads out of the folder that the server may write into (--root)");
    platform::FileStatus status;
    if (platform::status_of(*whole, status) == 0 && status.kind != FileKind::file) return fail(ErrorCode::io, path + ": expected a file");
    return shown(*whole);
}

}  // namespace halflit::cli
