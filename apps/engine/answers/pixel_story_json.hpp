// A pixel's story as JSON, for `halflit explain` and `halflit view`.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "halflit/explain.hpp"
#include "halflit/model.hpp"

namespace halflit::engine {

/// The story in the file's coordinates and lengths, of a scene that is drawn at `placement`.
[[nodiscard]] PixelStory in_file(PixelStory story, const Placement& placement);

/// The keys of docs/answers/explain.txt, :pixel.
[[nodiscard]] Json story_json(const PixelStory& story, const NameOfInstance& name = {});

}  // namespace halflit::engine
