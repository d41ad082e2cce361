// A good picture without decisions: chooses what the caller leaves open, as the command line does.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/prepared_scene.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace halflit {

/// When auto_setup() puts the scene into the built-in studio (studio_environment).
enum class StudioUse : std::uint8_t {
    for_dark,  ///< in full where the scene has no light from all around; lights of an unknown unit, as those of files, add to it
    always,    ///< always, in full, instead of the scene's ambient light and environment
    never,     ///< never: add_default_lights() takes its place
    /// As for_dark, but 0.15 of it under any lights: without it what faces away from them is black, and metals have nothing to mirror.
    under_lights
};

/// The caller's part of a choice; empty members are chosen.
struct AutoOptions {
    std::optional<Camera> camera{};          ///< the view; empty: choose_camera()'s, or else a view of the whole scene
    bool frame = false;                      ///< a view of the whole scene, whatever cameras the scene has
    ViewSettings view{};                     ///< of a view of the whole scene; with the usual angles, choose_view()'s
    std::optional<Lighting> light{};         ///< the light to begin with; empty: the scene's own
    std::optional<Vec3f> ambient_linear{};   ///< ambient light from all directions; empty: chosen
    std::optional<float> exposure{};         ///< factor on all light; empty: chosen
    float exposure_compensation_ev = 0.0f;   ///< stops brighter than that, given or chosen
    bool add_lights = true;                  ///< a scene without any light gets some
    StudioUse studio = StudioUse::for_dark;  ///< when the built-in studio is a part of the light
    double studio_turn_rad = 0.0;            ///< turns the studio about the vertical, counter-clockwise seen from above
};

/// The choice of auto_setup(); render() takes all of it.
struct AutoSetup {
    Camera camera;                               ///< the view to draw
    Lighting light;                              ///< the scene's own, with what it lacks
    Settings settings;                           ///< usual_settings(), the exposure, and a background that suits the surfaces' colours
    bool framed = false;                         ///< the camera is a view of the whole scene
    ViewSettings view{};                         ///< of a view of the whole scene: AutoOptions::view, or another side's
    ViewReason view_reason = ViewReason::given;  ///< for that view
};

/// The caller's part of the choice of a picture, with its size.
struct PictureRequest : AutoOptions {
    std::optional<PictureSize> size{};          ///< empty: the largest of the camera's shape that fits into usual_size
    PictureSize usual_size{1280, 720};          ///< pixels; a view of the whole scene has it
    std::optional<std::string> scene_camera{};  ///< the view: a camera of the scene, by its name, or else its index
};

/// The choice of choose_picture().
struct PictureChoice : AutoSetup {
    PictureSize size;       ///< of the picture
    int scene_camera = -1;  ///< index into Scene::cameras of the view; -1: another camera
};

/// Four samples, the dark grey background #2c3036, the neutral tone curve, sky shadows by a grid, a contact shadow, textures filtered along
/// footprints up to four times as long as wide, and otherwise the defaults.
[[nodiscard]] HALFLIT_API Settings usual_settings();

/// Azimuth of the side that the scene faces (Scene::faces_back), degrees: what named views are relative to.
[[nodiscard]] inline float front_azimuth_deg(const Scene& scene) { return scene.faces_back ? 180.0f : 0.0f; }

/// `view`, or with the usual angles, the same from the side that the scene faces (Scene::faces_back).
[[nodiscard]] HALFLIT_API ViewSettings front_view(const Scene& scene, ViewSettings view);

/// Chooses camera, light and exposure for a picture of width x height pixels. To the scene's own light it adds what that lacks:
///   - no light at all: the studio with a key light (add_studio; StudioUse::never: add_default_lights), exposure 1;
///   - lights of a file (Scene::calibrated is false), where nothing else lights it from all around: the same studio besides, and an
///     exposure by which lights that are brighter than white are as white (min(1, auto_exposure)); with StudioUse::never soft_ambient, and
///     else alone, at auto_exposure;
///   - an environment: an exposure by which its mean light makes a white surface 0.5, or 1 if its image is calibrated.
/// The background is dark grey (#2c3036), or light grey (codes 180, 186, 194) where surfaces are dark in the mean: their silhouette stands
/// out from it. By parallel rays that are asked for (ViewSettings::orthographic) there are no shadows: their borders look like edges.
/// Nothing depends on pixels.
[[nodiscard]] HALFLIT_API AutoSetup auto_setup(const Scene& scene, int width, int height, const AutoOptions& options = {});
/// The same. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API AutoSetup auto_setup(const Scene& scene, const Bounds& bounds, int width, int height, const AutoOptions& options);

/// Chooses the picture's size too, by the shape of the camera: the one place that decides what a picture shows. Program, C and Python call
/// it. Errors: usage, for a scene_camera that the scene does not have, and a size below 1.
[[nodiscard]] HALFLIT_API Result<PictureChoice> choose_picture(const Scene& scene, const PictureRequest& request = {});
/// The same of a prepared scene, which keeps what views are fitted to. bounds: scene.bounds(), or around all that a film shows.
[[nodiscard]] HALFLIT_API Result<PictureChoice> choose_picture(const PreparedScene& scene, const Bounds& bounds,
                                                               const PictureRequest& request);

/// The scene's first camera, or null if it has none, or if that camera shows it small or not at all: the box around the scene, between the
/// camera's near and far plane, fills less than a sixth of its picture, unless it lies in it as a whole and spans two thirds of its width
/// or height; or because it lies inside of a body or behind a surface, so that it shows no side that is drawn. Where nothing has bounds,
/// the first camera.
[[nodiscard]] HALFLIT_API const Camera* choose_camera(const Scene& scene, const Bounds& bounds);

}  // namespace halflit
