// The viewer of a build without its libraries.
#include "apps/viewer/viewer.hpp"

namespace halflit::viewer {

bool has_viewer() { return false; }

std::string missing_libraries() { return HALFLIT_VIEWER_LACKS; }

Result<ViewerSummary> run_viewer(engine::RenderJob, const engine::RenderOptions&, const ViewerOptions&) {
    return fail(ErrorCode::usage, "view: this build lacks " + missing_libraries());
}

}  // namespace halflit::viewer
