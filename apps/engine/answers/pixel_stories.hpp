// Stories of several pixels of one picture, as text and as JSON.
#pragma once

#include "apps/engine/answers/run_report.hpp"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace halflit::engine {

struct PixelStories {
    Json report;                                     ///< the keys of docs/answers/explain.txt
    std::string text;                                ///< for people
    std::vector<std::string> warnings{}, choices{};  ///< of explain()
};

/// Explains pixels of the job's picture by its camera. Requires: RenderOptions::may_want_reference, for the error. Fails (usage) for a
/// pixel beside the picture.
[[nodiscard]] Result<PixelStories> tell_pixels(const RenderJob& job, std::span<const PixelPlace> pixels);

/// Draws nothing: loads the scene, and explains pixels of the picture that the options describe.
[[nodiscard]] Result<PixelStories> explain(RenderOptions options, std::span<const PixelPlace> pixels);

/// The flag --pixel.
[[nodiscard]] Flag pixel_flag(std::vector<PixelPlace>& pixels);

}  // namespace halflit::engine
