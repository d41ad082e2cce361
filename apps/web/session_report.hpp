// JSON for the page, written by hand: a few short records do not need a library.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "apps/engine/trade/trade_error.hpp"
#include "halflit/report.hpp"

#include <string>

namespace halflit::web {

/// loads: scenes that the session has loaded so far.
[[nodiscard]] std::string picture_report(const engine::RenderJob& job, const RenderReport& report, const Image& picture, int loads);
[[nodiscard]] std::string error_report(const engine::TradeError& error, double reference_ms);

/// A lobe's values at `samples` cosines from -1 to 1, its series of `bands` bands there, the bands, and the error of the series.
[[nodiscard]] std::string lobe_report(const Lobe& lobe, int bands, int samples);

/// The library's version, its named lobes, and the names of its choices.
[[nodiscard]] std::string table_report();

/// The text as a JSON string.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace halflit::web
