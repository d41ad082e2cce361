// Reports of shards, read back: which pictures there should be, which are there, and whether they are those that were drawn.
#pragma once

#include "apps/halflit/farm/picture_file.hpp"
#include "halflit/error.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

/// A picture that a report names.
struct ReportedPicture {
    PictureFile file;         ///< without bytes; file_hash 0: not known, since the picture was there already (--skip-existing)
    std::string path;         ///< where it is: its name in the report, or that name in the report's folder
    std::string pixel_hash;   ///< as in the report
    std::string scene;        ///< as in the report; empty: it does not tell
    PictureSize size;         ///< of the whole picture
    Region region;            ///< what was drawn of it
    std::int64_t epoch = -1;  ///< of the pixels
};

struct ReportedRun {
    enum class Kind : std::uint8_t { parts, film, scenes };
    Kind kind = Kind::scenes;
    std::vector<ReportedPicture> pictures;  ///< by their place; each once
    std::vector<std::string> failures;      ///< messages of what failed
};

/// Reads JSON objects and JSON lines. An output that is named twice counts once; a drawn one before a skipped one. Fails for files that are
/// no reports (bad_input), and for reports of different runs (usage): of other scenes, sizes or frames, or two pictures of one place.
[[nodiscard]] Result<ReportedRun> read_reports(const std::vector<std::string>& paths);

/// What the run lacks: nothing, or one line that names the first ones and the shards that draw them. Requires: a picture.
[[nodiscard]] std::string missing_of(const ReportedRun& run);

/// The bytes of a picture's file. Fails (io) if they cannot be read, (negative_result) if they are not those that were written.
[[nodiscard]] Result<std::vector<std::byte>> read_verified(const ReportedPicture& picture);

}  // namespace halflit::cli
