// Labelled views of a model on one sheet, and a report of what they show: `halflit look` without its files.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/look/look_sheet.hpp"
#include "apps/engine/pictures/vector_file.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

inline constexpr PictureSize kViewSize{480, 400};  ///< of each view without --size

struct LookOptions : RenderOptions {
    std::optional<Projection> projection;  ///< none: third angle, where the views make a drawing
    bool perspective = false;
    int certify = 0;  ///< pixels that count as seen; 0: no certificate
    int most_views = 24;
    bool sheet = true;                          ///< draw the sheet
    VectorFormat vectors = VectorFormat::none;  ///< draw it as a file of vectors too
    std::string folder;                         ///< of a picture of each view; empty: none
};

/// Flags of a sheet, and those of its pictures. `options` must outlive what this returns.
[[nodiscard]] std::vector<FlagGroup> look_flags(LookOptions& options);

/// A picture and the file that it is for.
struct ViewPicture {
    std::string path;
    Image picture;
};

struct LookResult {
    Json report;                        ///< the keys of docs/answers/look.txt
    std::optional<Image> sheet;         ///< none without LookOptions::sheet
    std::string drawing;                ///< the file of LookOptions::vectors
    std::vector<ViewPicture> pictures;  ///< of each view; none without LookOptions::folder
    std::vector<std::string> inputs;    ///< files that the model refers to
    std::vector<std::string> warnings;  ///< of the scene
    std::vector<std::string> faults;    ///< one line each: views that should not be relied on, parts that no view shows
    std::string certificate;            ///< one line; empty: none was asked for
    bool good = true;                   ///< no view has a fault, and the certificate is complete
};

/// The scene with the views that the flags ask for, or else front, right, top and iso. Fails (usage) where they ask for moving pictures or
/// a part of a picture. Writes what a sheet has by default into the options.
[[nodiscard]] Result<RenderJob> look_job(LookOptions& options);

/// Draws the views, counts what they show, and lays out the sheet.
[[nodiscard]] Result<LookResult> look(const LookOptions& options);

}  // namespace halflit::engine
