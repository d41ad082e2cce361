// The window: a picture that a mouse turns, with controls beside it.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "apps/viewer/rehearsal.hpp"
#include "halflit/explain.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace halflit::viewer {

/// Text in the lower part of the panel.
enum class Tab : std::uint8_t { plan, report, pixel };
inline constexpr std::string_view kTabNames[] = {"plan", "report", "pixel"};

struct ViewerOptions {
    RehearsalPlan rehearsal;
    Tab tab = Tab::plan;
    std::string screenshot;  ///< at the end; empty: none
};

/// Summary of what happened until the window was closed.
struct ViewerSummary {
    int width = 0, height = 0;                ///< of the picture at the end
    int window_width = 0, window_height = 0;  ///< with the panel
    double first_picture_ms = 0;              ///< from the window's opening to its first picture
    double finished_ms = 0;                   ///< from the last motion to all samples
    std::vector<double> frame_ms;             ///< of a rehearsal's turn, from picture to picture
    std::vector<double> draw_ms;              ///< the part of them that drew the pictures
    std::vector<int> divisors;                ///< of their sizes
    double worst_loop_ms = 0;                 ///< the longest time in which the window did not look at its input
    std::optional<PixelStory> story;          ///< of the last click
};

/// True if this build has the window.
[[nodiscard]] bool has_viewer();
/// Why it has none.
[[nodiscard]] std::string missing_libraries();

/// Opens the window and returns when it is closed, or when the rehearsal is over. The job is of the flags in `options`. Fails (usage)
/// without the libraries or a display.
[[nodiscard]] Result<ViewerSummary> run_viewer(engine::RenderJob job, const engine::RenderOptions& options, const ViewerOptions& how);

}  // namespace halflit::viewer
