#include "apps/web/dropped_files.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/importer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace halflit {
namespace {

web::FileStore no_files;
web::FileStore* store = &no_files;

/// The name without "." and, where it can be resolved, without "..".
std::string plain_name(std::string_view name) {
    std::vector<std::string_view> parts;
    while (!name.empty()) {
        const std::string_view part = name.substr(0, name.find('/'));
        name.remove_prefix(std::min(name.size(), part.size() + 1));
        if (part == ".." && !parts.empty() && parts.back() != "..")
            parts.pop_back();
        else if (!part.empty() && part != ".")
            parts.push_back(part);
    }
    std::string plain;
    for (const std::string_view part : parts) plain.append(plain.empty() ? "" : "/").append(part);
    return plain;
}

Result<std::vector<std::byte>> find_file(const std::string& name, std::size_t max_bytes, ErrorCode absent) {
    const auto found = store->files.find(name);
    if (found == store->files.end()) return fail(absent, "no such file was given");
    if (found->second.size() > max_bytes)
        return fail(ErrorCode::limit, fmt::format("has {} bytes, the limit is {}", found->second.size(), max_bytes));
    return found->second;
}

void want(std::string name) {
    if (std::find(store->wanted.begin(), store->wanted.end(), name) == store->wanted.end()) store->wanted.push_back(std::move(name));
}

}  // namespace

namespace web {

void use_files(FileStore* other) { store = other != nullptr ? other : &no_files; }

std::vector<std::byte>& add_file(const std::string& name, std::vector<std::byte> bytes) {
    return store->files[plain_name(name)] = std::move(bytes);
}

}  // namespace web

// Programs cannot be run here.
Result<Importer> Importer::from(const std::string& /*text*/) { return fail(ErrorCode::usage, "there are no importers in a browser"); }

namespace io {

std::optional<LoadedScene> detail::read_cad(const detail::ModelFile& /*file*/, const LoadOptions& /*options*/) { return std::nullopt; }
std::optional<LoadedScene> detail::read_by_importer(const detail::ModelFile& /*file*/, const LoadOptions& /*options*/) {
    return std::nullopt;
}

Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes) {
    auto file = find_file(plain_name(path), max_bytes, ErrorCode::io);
    if (!file) return fail(file.error().code, fmt::format("{}: {}", printable(path), file.error().message));
    return file;
}

// A module's memory does not shrink.
TakenBytes::TakenBytes(std::span<std::byte> bytes) : bytes_(bytes), outer_(nullptr) {}
TakenBytes::~TakenBytes() = default;
void TakenBytes::before(const void* /*at*/) {}

ModelFolder::ModelFolder(std::string base_dir, std::vector<std::string> /*also_allowed*/) : has_base_(!base_dir.empty()) {
    folders_.push_back({-1, 0, std::move(base_dir), ""});
}

ModelFolder::~ModelFolder() = default;

Result<void> ModelFolder::check() const { return {}; }

std::vector<std::string> ModelFolder::places(std::string_view relative) const {
    return {plain_name(fmt::format("{}/{}", folders_[0].name, relative))};
}

/// A file beside the model. A browser hands over dropped files without their folders, so the last part of the name alone counts too.
Result<std::vector<std::byte>> ModelFolder::read(std::string_view relative, std::size_t max_bytes) {
    const auto refuse = [&](const Error& error) { return fail(error.code, fmt::format("\"{}\": {}", printable(relative), error.message)); };
    auto file = find_file(places(relative)[0], max_bytes, ErrorCode::bad_input);
    if (!file && file.error().code == ErrorCode::bad_input)
        file = find_file(std::string(relative.substr(relative.rfind('/') + 1)), max_bytes, ErrorCode::bad_input);
    if (!file && file.error().code == ErrorCode::bad_input) want(places(relative)[0]);
    if (!file) return refuse(file.error());
    return file;
}

/// Reads the only file whose name is alike but for the case of its letters and its folders.
Result<std::vector<std::byte>> ModelFolder::read_like(std::string_view name, std::size_t max_bytes, std::string& found) {
    found = name;
    auto exact = read(name, max_bytes);
    if (exact || exact.error().code != ErrorCode::bad_input) return exact;
    const auto last_part = [](std::string_view path) {
        path = path.substr(0, path.find_first_of("?#"));
        std::string last(path.substr(path.find_last_of("/\\") + 1));
        std::transform(last.begin(), last.end(), last.begin(), lower);
        return last;
    };
    const std::string wanted = last_part(name);
    std::vector<const std::string*> alike;
    for (const auto& [file, bytes] : store->files)
        if (last_part(file) == wanted) alike.push_back(&file);
    if (alike.size() != 1) return exact;
    found = *alike[0];
    return find_file(found, max_bytes, ErrorCode::bad_input);
}

}  // namespace io
}  // namespace halflit
