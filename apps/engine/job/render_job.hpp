// A render job: the scene, loaded and prepared, with camera, lights and exposure chosen from the flags.
#pragma once

#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/job/part_look.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/render_options.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/error.hpp"
#include "halflit/renderer.hpp"
#include "halflit/section.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

/// What the flags say of poses at other times.
struct PoseRules {
    std::string animation;      ///< LoadOptions::animation
    bool own_lobes = true;      ///< materials keep their own lobes
    bool own_materials = true;  ///< the flags replace nothing of the materials
};

/// Data that decide each frame of a moving picture and do not depend on which frames are drawn.
struct Film {
    PoseRules pose;
    Bounds bounds;                          ///< of all poses; of the scene, if it stands still
    std::vector<Camera> views;              ///< of --view, if it gives several
    int file_camera = -1;                   ///< index into Scene::cameras of the view; -1: another
    bool framed = false;                    ///< the camera is a view of the whole scene, fitted to it or kept
    std::optional<ViewSettings> view;       ///< its direction; none: kept
    ViewReason reason = ViewReason::given;  ///< for that direction
    bool scene_lights = true;               ///< the light begins with the scene's lights
    AutoOptions choice;                     ///< of auto_setup; with a light, the scene's and the flags'
    float sun_radius = 0, lamp_radius = 0;  ///< Light::shadow_radius of lights that have none
};

struct RenderJob {
    SceneSource source;
    std::optional<PreparedScene> prepared;  ///< made from that scene
    Lighting light;                         ///< that is drawn: the scene's, the flags', and what auto_setup adds
    Camera camera;
    Settings settings;  ///< the region is never empty
    Execution execution;
    int width = 0, height = 0;  ///< of the whole picture
    double load_ms = 0, prepare_ms = 0;
    double pose_time_s = 0;         ///< of the animation, if there is one
    Stopwatch started;              ///< with the job's loading
    double timeout_s = 0.0;         ///< from then on; 0: none
    std::vector<PartLook> looks{};  ///< of each part; empty: all as they are
    SectionReport sections;         ///< of the flags' planes
    std::vector<int> removed;       ///< indices into Parts::list() of parts that these planes remove wholly, in order
    Film film;                      ///< what the frames of a moving picture share
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

/// Errors that can be found without the scene are reported before it is loaded.
[[nodiscard]] Result<RenderJob> make_render_job(const RenderOptions& options);

/// The same for answers with measures: the exact ones of the file too, if its format has them.
[[nodiscard]] Result<RenderJob> make_measured_job(RenderOptions options);

/// Takes the materials' own lobes away, so that the settings' lobe counts for all.
void drop_own_lobes(Scene& scene);

/// Turns the light that was chosen for the viewer, such as the studio, with another camera. The exposure stays. False: there is none.
bool relight(RenderJob& job, const Camera& camera);

/// Moves the file's lights in the job's light to where they are in the scene.
void follow_lights(RenderJob& job);

/// Chooses the light anew, from the scene's own, by the flags' lights, environment and exposure. The camera and other settings stay.
[[nodiscard]] Result<void> change_light(RenderJob& job, const LightRequest& request);

/// Makes of the job what make_render_job would make of the flags, if they differ from the job's in settings, view, lights and environment
/// alone: the scene stays loaded and prepared. same_light: in settings and view alone.
[[nodiscard]] Result<void> change_job(RenderJob& job, RenderOptions options, bool same_light);

/// Allocates the region of the picture that is drawn: 8-bit codes, and linear floats if `linear`.
[[nodiscard]] Image make_image(const RenderJob& job, bool linear);
/// The whole picture, of which `image`, made by make_image(), holds the region.
[[nodiscard]] Target target_of(const RenderJob& job, Image& image);

}  // namespace halflit::engine
