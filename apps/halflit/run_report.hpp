// The report: one JSON object about one run, for scripts. It is written when a run fails, too.
#pragma once

#include "apps/halflit/render_job.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace halflit::cli {

using Json = nlohmann::ordered_json;

/// {"status": "ok", "halflit": version, "pixel_epoch": N}
[[nodiscard]] Json report_head();
/// {"status": "error", ..., "error": {"code": N, "message": "..."}}
[[nodiscard]] Json error_report(int code, const std::string& message);

/// Adds what was drawn and what it took: size, hash, instruction set, threads, times, counts, warnings, peak memory.
void add_frame(Json& report, const RenderJob& job, const raster::RenderReport& rendered, const raster::Image& picture);

/// {"budget_codes", "bound_codes", "within", "parts"}: what --max-error asked for and what is promised.
[[nodiscard]] Json error_bound_json(const shading::ErrorBound& error);

/// {"plan": ms, ...}: the renderer's stages.
[[nodiscard]] Json stages_ms(const raster::RenderReport& rendered);

/// {"order", "bound_linear", "bound_of_white", "tolerance_of_white", "within"}: the bands in use and what the others may amount to, in
/// linear light before exposure and as a part of display white.
[[nodiscard]] Json environment_use_json(const raster::EnvironmentUse& use, const raster::Settings& settings);

/// As text with a newline at the end; strings that are not UTF-8 have the offending bytes replaced.
[[nodiscard]] std::string to_text(const Json& json);

/// To a file (replaced in one step) or "-".
Result<void> write_json(const std::string& path, const Json& json);

}  // namespace halflit::cli
