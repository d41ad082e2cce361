// A render job: the scene, loaded and prepared, with camera, lights and exposure chosen from the flags.
#pragma once

#include "apps/halflit/render_options.hpp"
#include "apps/halflit/scene_source.hpp"
#include "apps/halflit/stopwatch.hpp"
#include "halflit/error.hpp"
#include "halflit/renderer.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct RenderJob {
    SceneSource source;                     ///< has the job's lights and ambient light
    std::optional<PreparedScene> prepared;  ///< made from that scene
    Camera camera;
    Settings settings;  ///< the region is never empty
    Execution execution;
    int width = 0, height = 0;  ///< of the whole picture
    double load_ms = 0, prepare_ms = 0;
    double pose_time_s = 0;  ///< of the animation, if there is one
    Stopwatch started;       ///< with the job's loading
    double timeout_s = 0.0;  ///< from then on; 0: none
    std::vector<std::string> warnings;
    std::vector<std::string> choices;  ///< what was chosen, one line each

    /// The animation that poses the scene; null: none.
    [[nodiscard]] const AnimationInfo* animation() const {
        return source.animation < 0 ? nullptr : &source.animations[static_cast<std::size_t>(source.animation)];
    }
    [[nodiscard]] Scene& scene() { return *source.scene; }
    [[nodiscard]] const Scene& scene() const { return *source.scene; }
    /// The execution with the time that is left.
    [[nodiscard]] Execution timed_execution() const;
};

/// `usual`: the picture size without --size; it is reduced to the aspect ratio of the file's camera. Errors that can be found without the
/// scene are reported before it is loaded.
[[nodiscard]] Result<RenderJob> make_render_job(const RenderOptions& options, PictureSize usual);

/// Allocates the region of the picture that is drawn: 8-bit codes, and linear floats if `linear`.
[[nodiscard]] Image make_image(const RenderJob& job, bool linear);
/// The whole picture, of which `image`, made by make_image(), holds the region.
[[nodiscard]] Target target_of(const RenderJob& job, Image& image);

}  // namespace halflit::cli
