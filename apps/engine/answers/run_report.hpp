// The report: one JSON object about one run, for scripts. It is also written when a run fails. A source that makes such objects itself
// includes <nlohmann/json.hpp>, which takes long to compile.
#pragma once

#include "apps/engine/job/render_job.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace halflit::engine {

using Json = nlohmann::ordered_json;

/// {"schema": "halflit.KIND/1", "status": "ok", "halflit": version, "pixel_epoch": N}. The number is that of
/// docs/answers/KIND.txt. It rises when a key is removed or changes its meaning, and stays when one is added.
[[nodiscard]] Json report_head(std::string_view kind);

/// Adds the frame: size, hash, instruction set, threads, times, counts, warnings, peak memory.
void add_frame(Json& report, const RenderJob& job, const RenderReport& rendered, const Image& picture);

/// The cuts of each plane of --section: [{"plane", "part", "name", "area", "closed", "open_ends"}].
[[nodiscard]] Json sections_json(const RenderJob& job);

/// {"budget_codes", "bound_codes", "parts"}: the budget of --max-error, and the proven bound with its parts.
[[nodiscard]] Json error_bound_json(const ErrorBound& error);

/// The double with the float's shortest decimal digits, so that JSON shows 0.8 and not 0.800000011920929.
[[nodiscard]] Json json_number(float value);

/// [x, y, width, height].
[[nodiscard]] Json region_json(const Region& region);

/// {"animation", "name", "time_s"}. Requires: an animation poses the scene.
[[nodiscard]] Json pose_json(const RenderJob& job);

/// {"order", "bound_linear", "bound_of_white", "tolerance_of_white", "within"}: the number of bands in use, and the bound on the error of
/// leaving out the others: in linear light before exposure, and as a fraction of display white.
[[nodiscard]] Json environment_use_json(const EnvironmentUse& use, const Settings& settings);

/// Text with a newline at the end, and no other if `one_line`. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string to_text(const Json& json, bool one_line = false);

/// An object for people: one indented line for each value, with names escaped (see printable).
[[nodiscard]] std::string to_lines(const Json& json);

/// A report of render with {"status": "error", ..., "error": {"code": N, "message": "..."}}. scene: as in the command line.
[[nodiscard]] std::string error_report(const std::string& scene, int code, const std::string& message, bool one_line = false);

}  // namespace halflit::engine
