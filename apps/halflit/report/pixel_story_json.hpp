// A pixel's story as JSON, for `halflit explain` and `halflit view`.
#pragma once

#include "apps/halflit/render/scene_source.hpp"
#include "apps/halflit/report/run_report.hpp"
#include "halflit/explain.hpp"
#include "halflit/model.hpp"

namespace halflit::cli {

/// The story in the file's coordinates and lengths, of a scene that is drawn at `placement`.
[[nodiscard]] PixelStory in_file(PixelStory story, const Placement& placement);

/// The keys of docs/schema/explain-1.schema.json, $defs/pixel.
[[nodiscard]] Json story_json(const PixelStory& story, const NameOfInstance& name = {});

}  // namespace halflit::cli
