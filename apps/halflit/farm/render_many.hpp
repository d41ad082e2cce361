// Many scenes in one run, each to a picture of its own.
#pragma once

#include "apps/halflit/farm/picture_file.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

struct ManyOptions {
    PictureOptions each;              ///< its output: a folder that ends in '/', or a pattern (see picture_name); its report: JSON lines
    std::vector<std::string> scenes;  ///< at least one
    bool skip_existing = false;       ///< leave pictures alone that are there
};

/// The picture of a scene. In a pattern, {stem} is the scene's name without folder and extension, {folder} its folder, and {index} its
/// place among the scenes from 0 on, {index:04} with zeros in front. Fails (usage) for other words in braces.
[[nodiscard]] Result<std::string> picture_name(const std::string& output, std::optional<OutputFormat> format, const std::string& scene,
                                               std::size_t index);

/// Draws small scenes side by side and large ones one by one, with all threads; each has the pixels that it has alone. A scene that fails
/// does not stop the others. Messages and the report's lines come in the order of the scenes. Returns the exit code: the first failure's;
/// or else 1 if a picture is blank and `each.blank_check` is set.
[[nodiscard]] Result<int> render_many(const ManyOptions& options);

}  // namespace halflit::cli
