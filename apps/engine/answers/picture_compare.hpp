// Comparison of two picture files, or of all pictures in two folders. `halflit diff` prints the results.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/pictures/picture_diff.hpp"
#include "halflit/error.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

enum class DiffStatus : std::uint8_t {
    equal,    ///< no pixel differs
    within,   ///< pixels differ, and the tolerance allows it
    differs,  ///< pixels differ by more than the tolerance allows
    size,     ///< the two have different sizes
    missing,  ///< only the first folder has the file
    extra,    ///< only the second folder has it
    failed    ///< a file cannot be read
};
[[nodiscard]] const char* diff_status_name(DiffStatus status);

struct DiffedFile {
    std::string path{};  ///< relative to both folders, with '/'
    DiffStatus status = DiffStatus::equal;
    std::optional<PictureDiff> diff{};  ///< for equal, within and differs
    std::string message{};              ///< for size and failed
    ErrorCode error{};                  ///< for failed

    [[nodiscard]] bool passed() const { return status == DiffStatus::equal || status == DiffStatus::within; }
};

/// Compares two pictures in memory. A difference picture is written to `picture` if that is not empty and a pixel differs.
[[nodiscard]] Result<DiffedFile> diff_images(const Image& a, const Image& b, const DiffTolerance& tolerance, std::string path,
                                             const std::string& picture);
/// Compares two files; `path` is the result's.
[[nodiscard]] Result<DiffedFile> diff_files(const std::string& a, const std::string& b, const DiffTolerance& tolerance, std::string path,
                                            const std::string& picture);

/// Compares all pictures (by extension) of two folders and their subfolders, sorted by path. Symbolic links to folders are not followed. A
/// file that cannot be read is a result, not an error. `pictures`: folder for PATH.png, one difference picture for each file that differs.
[[nodiscard]] Result<std::vector<DiffedFile>> diff_folders(const std::string& a, const std::string& b, const DiffTolerance& tolerance,
                                                           const std::string& pictures);

/// One line for each file, the columns aligned, and a line with the sums; `noun`: "file".
[[nodiscard]] std::string diffs_text(const std::vector<DiffedFile>& files, std::string_view noun);

/// {"max", "mean", "count", "count_above", "share_above", "pixels", "psnr"}; above the tolerance's codes.
[[nodiscard]] Json diff_json(const PictureDiff& diff, const DiffTolerance& tolerance);
/// The number of files by status.
[[nodiscard]] Json sums_json(const std::vector<DiffedFile>& files);
/// {"sums", "files"}
[[nodiscard]] Json folders_json(const std::vector<DiffedFile>& files, const DiffTolerance& tolerance);

/// 0 if all passed, 1 for differences, the error's code if a file has failed.
[[nodiscard]] int exit_code_of(const std::vector<DiffedFile>& files);

}  // namespace halflit::engine
