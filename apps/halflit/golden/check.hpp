// Drawing of the scenes of a golden list, and their comparison with the expected pictures.
#pragma once

#include "apps/engine/answers/picture_compare.hpp"
#include "apps/halflit/golden/list.hpp"
#include "apps/halflit/program/engine.hpp"
#include "halflit/error.hpp"

#include <functional>
#include <string>
#include <vector>

namespace halflit::cli {

/// The result of one scene; `path` is its name, and "missing" means that it has no expected picture.
struct GoldenResult : DiffedFile {
    const GoldenScene* scene = nullptr;
    std::string hash{};           ///< of the drawn pixels; empty if the scene could not be drawn
    std::string expected_hash{};  ///< empty: none is recorded
    DiffTolerance tolerance{};
    bool framed = false;  ///< the camera is a view of the whole scene: `kept` if it was recorded, else chosen anew
    bool kept = false;
    double ms = 0;  ///< for loading, drawing and comparing

    // Names of files in the report's folder; empty where there is none.
    std::string expected_picture{}, actual_picture{}, difference_picture{};
};

struct GoldenCheck {
    std::string report_folder;
    std::optional<int> max_codes;     ///< instead of the list's
    std::optional<double> max_share;  ///< instead of the list's
};

/// Draws the scenes again. One whose pixels have the recorded hash passes at once; another is compared with its expected picture, and
/// expected, actual and difference pictures are written to the report's folder, which must exist. A scene that cannot be drawn is a
/// result, not an error.
[[nodiscard]] Result<std::vector<GoldenResult>> check_golden(const GoldenList& list, const std::vector<const GoldenScene*>& scenes,
                                                             const GoldenCheck& options);

/// Draws the scenes, writes the pictures whose pixels have changed, and changes the list's hashes. "differs" is a picture that was
/// replaced, "missing" one that is new. A picture that the hashes do not name is not overwritten, because it may be a texture: that scene
/// fails. Cameras that were framed are recorded in the list; recorded ones stay unless `reframe`.
[[nodiscard]] std::vector<GoldenResult> update_golden(GoldenList& list, const std::vector<const GoldenScene*>& scenes, bool reframe);

}  // namespace halflit::cli
