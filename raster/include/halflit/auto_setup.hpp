// A good picture without decisions: chooses what the caller leaves open, as the command line does.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/export.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"

#include <optional>

namespace halflit {

/// What the caller decides; the rest is chosen.
struct AutoOptions {
    std::optional<Camera> camera{};         ///< the view; empty: choose_camera()'s, or else a view of the whole scene
    bool frame = false;                     ///< a view of the whole scene, whatever cameras the scene has
    ViewSettings view{};                    ///< of a view of the whole scene
    std::optional<Vec3f> ambient_linear{};  ///< ambient light from all directions; empty: chosen
    std::optional<float> exposure{};        ///< factor on all light; empty: chosen
    bool add_lights = true;                 ///< a scene without any light gets some
};

/// What auto_setup() chose; render() takes both. The lights are in the scene.
struct AutoSetup {
    Camera camera;        ///< the view to draw
    Settings settings;    ///< usual_settings(), the exposure, and shadow maps for the picture's size: twice its longer side, 256 to 2048
    bool framed = false;  ///< the camera is a view of the whole scene
};

/// Four samples, the dark grey background #3a3f47, and otherwise the defaults.
[[nodiscard]] HALFLIT_API Settings usual_settings();

/// Chooses camera, lights, ambient light and exposure for a picture of width x height pixels. Adds to the scene the light that it lacks:
///   - no light at all: a key light and ambient light (add_default_lights), which are calibrated, exposure 1;
///   - lights of a file (Scene::calibrated is false): ambient light (soft_ambient), and an exposure from the lights (auto_exposure);
///   - an environment: an exposure by which its mean light makes a white surface 0.5, or 1 if its image is calibrated.
/// Nothing depends on pixels. Call it once for each scene: a second call finds the light that the first one added.
[[nodiscard]] HALFLIT_API AutoSetup auto_setup(Scene& scene, int width, int height, const AutoOptions& options = {});
/// The same. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API AutoSetup auto_setup(Scene& scene, const Bounds& bounds, int width, int height, const AutoOptions& options);

/// The scene's first camera, or null if it has none, or if that camera shows it small or not at all: the box around the scene, between the
/// camera's near and far plane, fills less than a sixth of its picture. Where nothing has bounds, the first camera.
[[nodiscard]] HALFLIT_API const Camera* choose_camera(const Scene& scene, const Bounds& bounds);

}  // namespace halflit
