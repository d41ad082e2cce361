#include "apps/engine/answers/picture_compare.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/platform/paths.hpp"
#include "halflit/image.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

namespace halflit::engine {
namespace {

namespace fs = std::filesystem;

/// A missing file's error names files with a similar name.
Result<Image> read_named(const std::string& path) {
    auto picture = io::read_picture(path);
    if (!picture && picture.error().code == ErrorCode::io) return fail(ErrorCode::io, picture.error().message + did_you_mean_file(path));
    return picture;
}

/// Relative paths of the pictures below `folder`.
Result<std::set<std::string>> pictures_below(const std::string& folder) {
    std::set<std::string> paths;
    std::error_code error;
    const fs::path top = platform::to_path(folder);
    for (fs::recursive_directory_iterator it(top, error), end; !error && it != end; it.increment(error))
        if (it->is_regular_file(error) && io::is_picture_name(platform::to_name(it->path().filename())))
            paths.insert(platform::to_name(it->path().lexically_relative(top)));
    if (error) return fail(ErrorCode::io, printable(folder) + ": " + error.message());
    return paths;
}

Result<void> make_parent(const std::string& path) {
    const std::string parent = platform::to_name(platform::to_path(path).parent_path());
    return parent.empty() ? Result<void>() : make_folder(parent);
}

std::string line_of(const DiffedFile& file, std::size_t width) {
    const std::string shown = printable(file.path);
    std::string line = fmt::format("{:<8}  {:<{}}", diff_status_name(file.status), shown, width);
    if (file.diff && file.diff->count > 0)
        line += fmt::format("  max {:>3}  {:>9} of {} pixels  PSNR {:.2f} dB", file.diff->max, file.diff->count, file.diff->pixels,
                            *file.diff->psnr());
    if (!file.message.empty()) line += "  " + printable(file.message);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

std::size_t count(const std::vector<DiffedFile>& files, DiffStatus status) {
    return static_cast<std::size_t>(std::count_if(files.begin(), files.end(), [&](const DiffedFile& f) { return f.status == status; }));
}

constexpr DiffStatus kAllStatus[] = {DiffStatus::equal,   DiffStatus::within, DiffStatus::differs, DiffStatus::size,
                                     DiffStatus::missing, DiffStatus::extra,  DiffStatus::failed};

}  // namespace

const char* diff_status_name(DiffStatus status) {
    constexpr const char* kNames[] = {"equal", "within", "differs", "size", "missing", "extra", "failed"};
    return kNames[static_cast<std::size_t>(status)];
}

Result<DiffedFile> diff_images(const Image& a, const Image& b, const DiffTolerance& tolerance, std::string path,
                               const std::string& picture) {
    DiffedFile file{.path = std::move(path)};
    if (a.width != b.width || a.height != b.height) {
        file.status = DiffStatus::size;
        file.message = fmt::format("{}x{}, expected {}x{}", b.width, b.height, a.width, a.height);
        return file;
    }
    file.diff = compare_pictures(a, b);
    file.status = file.diff->count == 0 ? DiffStatus::equal : passes(*file.diff, tolerance) ? DiffStatus::within : DiffStatus::differs;
    if (picture.empty() || file.diff->count == 0) return file;
    if (const auto made = make_parent(picture); !made) return tl::unexpected(made.error());
    if (const auto written = write_image(picture, difference_image(a, b)); !written) return tl::unexpected(written.error());
    return file;
}

Result<DiffedFile> diff_files(const std::string& a_path, const std::string& b_path, const DiffTolerance& tolerance, std::string path,
                              const std::string& picture) {
    const auto a = read_named(a_path);
    if (!a) return tl::unexpected(a.error());
    const auto b = read_named(b_path);
    if (!b) return tl::unexpected(b.error());
    return diff_images(*a, *b, tolerance, std::move(path), picture);
}

Result<std::vector<DiffedFile>> diff_folders(const std::string& a, const std::string& b, const DiffTolerance& tolerance,
                                             const std::string& pictures) {
    const auto in_a = pictures_below(a), in_b = pictures_below(b);
    if (!in_a) return tl::unexpected(in_a.error());
    if (!in_b) return tl::unexpected(in_b.error());
    if (in_a->empty() && in_b->empty())
        return fail(ErrorCode::bad_input, fmt::format("{}: expected pictures in one of the folders, found none in both", printable(a)));
    std::set<std::string> all = *in_a;
    all.insert(in_b->begin(), in_b->end());
    if (!pictures.empty())
        if (const auto made = make_folder(pictures); !made) return tl::unexpected(made.error());
    std::vector<DiffedFile> files;
    for (const std::string& path : all) {
        if (!in_a->contains(path) || !in_b->contains(path)) {
            files.push_back({.path = path, .status = in_a->contains(path) ? DiffStatus::missing : DiffStatus::extra});
            continue;
        }
        const std::string picture = pictures.empty() ? "" : path_in(pictures, path + ".png");
        auto file = diff_files(path_in(a, path), path_in(b, path), tolerance, path, picture);
        if (!file)
            file = DiffedFile{.path = path, .status = DiffStatus::failed, .message = file.error().message, .error = file.error().code};
        files.push_back(std::move(*file));
    }
    return files;
}

std::string diffs_text(const std::vector<DiffedFile>& files, std::string_view noun) {
    std::size_t width = 0;
    for (const DiffedFile& file : files) width = std::max(width, printable(file.path).size());
    std::string text, sums;
    for (const DiffedFile& file : files) text += line_of(file, width);
    for (const DiffStatus status : kAllStatus)
        if (const std::size_t n = count(files, status); n > 0) sums += fmt::format(", {} {}", n, diff_status_name(status));
    return text + fmt::format("{} {}{}: {}\n", files.size(), noun, files.size() == 1 ? "" : "s", sums.empty() ? "" : sums.substr(2));
}

Json diff_json(const PictureDiff& diff, const DiffTolerance& tolerance) {
    const auto psnr = diff.psnr();
    const std::uint64_t above = diff.count_above(tolerance.max_codes);
    return {{"max", diff.max},
            {"mean", diff.mean()},
            {"count", diff.count},
            {"count_above", above},
            {"share_above", static_cast<double>(above) / static_cast<double>(diff.pixels)},
            {"pixels", diff.pixels},
            {"psnr", psnr ? Json(*psnr) : Json(nullptr)}};
}

Json sums_json(const std::vector<DiffedFile>& files) {
    Json sums = Json::object();
    for (const DiffStatus status : kAllStatus) sums[diff_status_name(status)] = count(files, status);
    return sums;
}

Json folders_json(const std::vector<DiffedFile>& files, const DiffTolerance& tolerance) {
    Json list = Json::array();
    for (const DiffedFile& file : files) {
        Json one{{"path", file.path}, {"status", diff_status_name(file.status)}};
        if (file.diff) one.update(diff_json(*file.diff, tolerance));
        if (!file.message.empty()) one["message"] = file.message;
        list.push_back(std::move(one));
    }
    return {{"sums", sums_json(files)}, {"files", std::move(list)}};
}

int exit_code_of(const std::vector<DiffedFile>& files) {
    for (const DiffedFile& file : files)
        if (file.status == DiffStatus::failed) return static_cast<int>(file.error);
    const bool passed = std::all_of(files.begin(), files.end(), [](const DiffedFile& file) { return file.passed(); });
    return passed ? 0 : static_cast<int>(ErrorCode::negative_result);
}

}  // namespace halflit::engine
