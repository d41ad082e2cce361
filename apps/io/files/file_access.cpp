#include "apps/io/files/file_access.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <iterator>
#include <utility>

namespace halflit::io {

namespace {

using platform::FileKind, platform::Handle;

/// Reads an open file that must be regular. `no_file`: the error code if it is not a regular file. Faults of the file system are always io.
Result<std::vector<std::byte>> read_regular(const Handle& file, std::size_t max_bytes, ErrorCode no_file) {
    platform::FileStatus info;
    if (const int error = platform::status_of(file.get(), info); error != 0)
        return fail(ErrorCode::io, fmt::format("cannot be read: {}", platform::errno_text(error)));
    if (info.kind != FileKind::file)
        return fail(no_file, info.kind == FileKind::folder ? "is a directory, expected a file" : "is not a regular file");
    if (info.bytes > max_bytes)
        return fail(ErrorCode::limit, fmt::format("has {} bytes, the limit is {} (max_file_bytes)", info.bytes, max_bytes));
    std::vector<std::byte> bytes(static_cast<std::size_t>(info.bytes));
    std::size_t have = 0;
    while (have < bytes.size()) {
        const std::ptrdiff_t got = platform::read_some(file.get(), bytes.data() + have, bytes.size() - have);
        if (got < 0) return fail(ErrorCode::io, fmt::format("cannot be read: {}", platform::errno_text(errno)));
        if (got == 0) return fail(ErrorCode::bad_input, fmt::format("ended after {} of {} bytes while it was read", have, bytes.size()));
        have += static_cast<std::size_t>(got);
    }
    std::byte extra{};
    if (platform::read_some(file.get(), &extra, 1) > 0) return fail(ErrorCode::bad_input, "grew while it was read");
    return bytes;
}

/// True for errors of opening that say what the file's name is: that of no file, or of a socket or device that nobody serves. Others say
/// that the file system, or the process, cannot read now.
bool means_no_file(int error) {
    static constexpr int kErrors[] = {ENOENT, ENOTDIR, ENAMETOOLONG, EINVAL, EILSEQ, ENXIO, ENODEV, EISDIR};
    return std::find(std::begin(kErrors), std::end(kErrors), error) != std::end(kErrors);
}

/// Removes "." and resolves ".." by the text alone, as RFC 3986 (5.2.4) does. A relative name may begin with ".." afterwards. A name that
/// must be a folder's keeps its last slash, so that a file is not found by it.
std::string normalised(std::string_view path) {
    const bool is_absolute = path.starts_with('/');
    std::vector<std::string_view> parts;
    bool folder = true;
    for (std::size_t at = 0; at < path.size();) {
        const std::size_t slash = std::min(path.find('/', at), path.size());
        const std::string_view part = path.substr(at, slash - at);
        folder = part.empty() || part == "." || part == "..";
        if (part == ".." && !parts.empty() && parts.back() != "..")
            parts.pop_back();
        else if (part == ".." ? !is_absolute : !folder)
            parts.push_back(part);
        folder = folder || slash + 1 == path.size();
        at = slash + 1;
    }
    std::string out(is_absolute ? platform::root_of(path) : "");
    for (std::size_t i = 0; i < parts.size(); ++i) out.append(i == 0 ? "" : "/").append(parts[i]);
    if (folder && !parts.empty() && parts.back() != "..") out += '/';
    return out;
}

/// The path from the root, with links as they are.
std::string absolute(const std::string& path) {
    std::string out = normalised(platform::is_absolute(path) ? path : platform::real_path(".") + "/" + path);
    if (out.size() > 1 && out.ends_with('/')) out.pop_back();
    return out;
}

/// The rest of `path` below `folder`, both absolute and normalised; nothing if it is not below.
std::string name_below(const std::string& folder, const std::string& path) {
    if (folder.empty() || path.empty() || !path.starts_with(folder)) return "";
    if (folder == "/") return path.substr(1);
    return path.size() > folder.size() && path[folder.size()] == '/' ? path.substr(folder.size() + 1) : "";
}

/// The one entry of a folder that has a name but for the case of ASCII letters; nothing if there is none, or several.
std::string entry_like(const Handle& folder, const std::string& name) {
    constexpr std::size_t kMostEntries = 1 << 16;
    const auto same = [&](const std::string& entry) {
        return std::equal(entry.begin(), entry.end(), name.begin(), name.end(), [](char a, char b) { return lower(a) == lower(b); });
    };
    std::string found;
    for (std::string& entry : platform::names_in(folder.get(), kMostEntries)) {
        if (!same(entry)) continue;
        if (!found.empty()) return "";
        found = std::move(entry);
    }
    return found;
}

/// The name with the case that files and folders below `folder` have; nothing if there are none, or several.
std::string in_their_case(platform::NativeHandle folder, const std::string& name) {
    std::string found;
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t slash = std::min(name.find('/', at), name.size());
        const Handle in = platform::open_beneath(folder, found.empty() ? "." : found);
        const std::string entry = in.is_open() ? entry_like(in, name.substr(at, slash - at)) : "";
        if (entry.empty()) return "";
        found.append(found.empty() ? "" : "/").append(entry);
        at = slash + 1;
    }
    return found;
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes) {
    if (path.find('\0') != std::string::npos)
        return fail(ErrorCode::io, fmt::format("{}: cannot be opened: a file name cannot hold a zero byte", printable(path)));
    const Handle file = platform::open_to_read(path);
    if (!file.is_open()) return fail(ErrorCode::io, fmt::format("{}: cannot be opened: {}", printable(path), platform::errno_text(errno)));
    auto bytes = read_regular(file, max_bytes, ErrorCode::io);
    if (!bytes) return fail(bytes.error().code, fmt::format("{}: {}", printable(path), bytes.error().message));
    return bytes;
}

namespace {
thread_local TakenBytes* taken_bytes = nullptr;
}  // namespace

TakenBytes::TakenBytes(std::span<std::byte> bytes) : bytes_(bytes), outer_(std::exchange(taken_bytes, this)) {}
TakenBytes::~TakenBytes() { taken_bytes = outer_; }

void TakenBytes::before(const void* at) {
    constexpr std::size_t kAtOnce = std::size_t{8} << 20;
    TakenBytes* const taken = taken_bytes;
    if (taken == nullptr) return;
    const auto* const place = static_cast<const std::byte*>(at);
    const std::span<std::byte> bytes = taken->bytes_;
    if (std::less<>()(place, bytes.data()) || !std::less<>()(place, bytes.data() + bytes.size())) return;
    const auto end = static_cast<std::size_t>(place - bytes.data());
    if (taken->given_back_ == 0) taken->given_back_ = end;
    if (end < taken->given_back_ + kAtOnce) return;
    platform::give_back(bytes.data() + taken->given_back_, end - taken->given_back_);
    taken->given_back_ = end;
}

ModelFolder::ModelFolder(std::string base_dir, std::vector<std::string> also_allowed) : has_base_(!base_dir.empty()) {
    if (has_base_) add(base_dir);
    for (const std::string& folder : also_allowed) {
        const bool is_name = !folder.empty() && folder.find('\0') == std::string::npos;
        errno = ENOENT;
        if (is_name) add(folder);
        if ((!is_name || folders_.back().handle == platform::kNoHandle) && missing_.empty())
            missing_ = fmt::format("the allowed folder \"{}\" cannot be opened: {}", printable(folder), platform::errno_text(errno));
    }
}

void ModelFolder::add(const std::string& path) {
    Handle folder = platform::open_folder(path);
    const int error = folder.is_open() ? 0 : errno;
    folders_.push_back({platform::kNoHandle, error, absolute(path), error == 0 ? platform::real_path(path) : ""});
    folders_.back().handle = folder.release();
    errno = error;
}

ModelFolder::~ModelFolder() {
    for (const Folder& folder : folders_)
        if (folder.handle != platform::kNoHandle) (void)platform::close_handle(folder.handle);
}

Result<void> ModelFolder::check() const {
    if (!missing_.empty()) return fail(ErrorCode::usage, missing_);
    return {};
}

std::vector<std::string> ModelFolder::places(std::string_view relative) const {
    std::vector<std::string> paths;
    for (const Folder& folder : folders_) paths.push_back(fmt::format("{}/{}", folder.name, relative));
    return paths;
}

Result<std::vector<std::byte>> ModelFolder::read(std::string_view relative, std::size_t max_bytes) {
    const std::string shown = printable(relative);
    const auto refuse = [&](std::string why) { return fail(ErrorCode::bad_input, fmt::format("\"{}\": {}", shown, why)); };
    if (folders_.empty()) return refuse("the model has no folder to read other files from");
    if (relative.empty()) return refuse("expected a file name");
    if (relative.find('\0') != std::string_view::npos) return refuse("a file name cannot hold a zero byte");
    if (relative.find('\\') != std::string_view::npos) return refuse("expected '/' between folders, found '\\'");
    if (relative.front() == '/') return refuse("absolute names are not allowed, expected one below the model's folder");
    if (const std::string_view fault = platform::fault_of_name(relative); !fault.empty()) return refuse(std::string(fault));

    // Whatever name is made below, open_beneath never leaves the folder that it is given.
    int error = ENOENT;
    const auto open_in = [&](const Folder& folder, const std::string& name) {
        Handle file = folder.error != 0 || name.empty() ? Handle() : platform::open_beneath(folder.handle, name);
        if (!file.is_open() && error == ENOENT) error = folder.error != 0 ? folder.error : name.empty() ? EISDIR : errno;
        return file;
    };
    const std::string name = normalised(relative);
    const bool leads_up = name == ".." || name.starts_with("../");
    Handle file;
    if (!leads_up)
        for (std::size_t i = 0; i < folders_.size() && !file.is_open(); ++i) file = open_in(folders_[i], name);
    if (!file.is_open() && has_base_ && !folders_[0].at.empty()) {
        // A name that leads out of the model's folder, itself or by a symbolic link, may lead back, or into one that is allowed.
        if (leads_up) error = EXDEV;
        const std::string target = normalised(folders_[0].at + "/" + std::string(relative));
        const std::string real = folders_.size() > 1 ? platform::linked_place(target) : "";
        for (std::size_t i = 0; i < folders_.size() && !file.is_open(); ++i)
            for (const auto& [path, folder] : {std::pair(&target, &folders_[i].name), {&target, &folders_[i].at}, {&real, &folders_[i].at}})
                if (const std::string below = name_below(*folder, *path); !file.is_open() && !below.empty())
                    file = open_in(folders_[i], below);
    }
    if (file.is_open()) {
        auto bytes = read_regular(file, max_bytes, ErrorCode::bad_input);
        if (!bytes) return fail(bytes.error().code, fmt::format("\"{}\": {}", shown, bytes.error().message));
        return bytes;
    }
    if (error == EXDEV || error == ELOOP)
        return refuse(folders_.size() > (has_base_ ? 1 : 0) ? "leads out of the model's folder and of those that are allowed"
                                                            : "leads out of the model's folder");
    if (error == ENOENT) return refuse("no such file");
    return fail(error == ENOMEM        ? ErrorCode::limit
                : means_no_file(error) ? ErrorCode::bad_input
                                       : ErrorCode::io,
                fmt::format("\"{}\": cannot be opened: {}", shown, platform::errno_text(error)));
}

Result<std::vector<std::byte>> ModelFolder::read_like(std::string_view name, std::size_t max_bytes, std::string& found) {
    found = name;
    auto exact = read(name, max_bytes);
    if (exact || exact.error().code != ErrorCode::bad_input || name.empty() || name.find('\0') != std::string_view::npos) return exact;
    std::string path(name.substr(0, name.find_first_of("?#")));
    std::replace(path.begin(), path.end(), '\\', '/');
    const std::string last = path.substr(path.rfind('/') + 1);
    std::vector<std::string> names{path, last, "textures/" + last};
    if (path.size() > 1 && (path[0] == '/' || path[1] == ':')) names.erase(names.begin());
    for (const std::string& one : names) {
        if (last.empty()) break;
        std::vector<std::string> spelled{one};
        const std::string clean = normalised(one);
        for (const Folder& folder : folders_)
            if (folder.error == 0 && !clean.starts_with(".."))
                if (std::string other = in_their_case(folder.handle, clean); !other.empty()) spelled.push_back(std::move(other));
        for (const std::string& spelling : spelled) {
            auto bytes = read(spelling, max_bytes);
            if (!bytes && bytes.error().code == ErrorCode::bad_input) continue;
            found = spelling;
            return bytes;
        }
    }
    return exact;
}

}  // namespace halflit::io
