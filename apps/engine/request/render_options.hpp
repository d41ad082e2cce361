// Flags that decide the picture. render, bench, info and trade share them, so that bench measures and info describes what render draws.
#pragma once

#include "apps/engine/request/camera_orbit.hpp"
#include "apps/engine/request/classic_material.hpp"
#include "apps/engine/request/film_options.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/given_camera.hpp"
#include "apps/engine/request/kept_view.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/io/files/lobe_name.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/camera.hpp"
#include "halflit/gltf.hpp"
#include "halflit/light.hpp"
#include "halflit/settings.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

class SceneKeeper;

/// Picture size of render and info without --size.
inline constexpr PictureSize kRenderSize{1280, 720};

/// Values of the flags of parts, as given: names, numbers or patterns.
struct PartFlags {
    std::vector<std::string> only, hide, ghost, highlight;
    Vec3f highlight_linear{1.0f, 0.23f, 0.0f};  ///< orange
    [[nodiscard]] bool any() const { return !only.empty() || !hide.empty() || !ghost.empty() || !highlight.empty(); }
};

/// The model, and how it is read.
struct ModelRequest {
    std::string scene;  ///< a file, "-" for standard input, or a built-in scene
    LoadOptions load = [] {
        LoadOptions usual;
        usual.import_cache = true;
        return usual;
    }();
    bool detail_given = false;                              ///< load.detail_px counts; otherwise it follows from the view
    std::shared_ptr<const std::vector<std::byte>> input{};  ///< of standard input, once it was read
    SceneKeeper* keeper = nullptr;                          ///< loads the scene; null: load_scene()
};

/// What is drawn of the model, and with which materials.
struct ContentRequest {
    PartFlags parts{};
    std::vector<GivenSection> sections{};  ///< planes that cut the scene
    double hatch_spacing = 0.0;            ///< of caps, in the file's world; 0: chosen
    bool hatch = true;                     ///< lines on caps
    bool ground = false;                   ///< add a ground that only takes shadow
    ClassicMaterial classic;
    bool own_lobes = true;  ///< materials that have lobes of their own keep them
};

/// The picture's size and camera. Points are in the file's world.
struct ViewRequest {
    std::optional<PictureSize> size;
    PictureSize usual_size = kRenderSize;         ///< without `size`; reduced to the aspect ratio of the file's camera
    std::optional<std::string> camera;            ///< a camera of the file, or of camera_file: its index or name, or kAllCameras
    std::string camera_file;                      ///< empty: the model's own cameras
    std::shared_ptr<const CameraFile> cameras{};  ///< of camera_file, once it is read
    std::optional<CameraOrbit> camera_orbit{};
    ViewSettings view;
    std::optional<PictureSize> fit_px;  ///< --fit: margins of a view that is as near as its side allows
    bool whole_scene = false;           ///< --camera frame, --azimuth, --elevation, --zoom, --fit or --view was given
    bool fov_given = false;             ///< --fov was given
    std::optional<Vec3d> camera_position, camera_target;
    std::optional<KeptView> kept_view{};  ///< draws by this one what would be framed; of golden alone

    [[nodiscard]] PictureSize picture_size() const { return size.value_or(usual_size); }
    /// A camera of the flags, not of the file.
    [[nodiscard]] bool own_view() const { return whole_scene || fov_given || camera_position || camera_orbit; }
};

/// Light and exposure. Lights and lengths are in the file's world.
struct LightRequest {
    std::optional<Vec3f> ambient_linear;
    std::vector<GivenLight> lights;
    float sun_size_deg = 0.0f, lamp_size = 0.0f;  ///< of lights without a size of their own
    bool scene_lights = true;
    std::string environment;                 ///< a file or "sky"; empty: none, or the studio
    StudioUse studio = StudioUse::for_dark;  ///< if there is no other environment
    bool environment_sun = true;
    float environment_rotate_deg = 0.0f;
    bool may_want_reference = false;  ///< the environment keeps what --accuracy reference needs, though the accuracy is another
    std::optional<float> exposure;    ///< a factor; none: chosen from the lights
    float exposure_compensation_ev = 0.0f;
};

/// Settings of drawing, and which of them are chosen by the scene.
struct SettingsRequest {
    Settings settings = usual_settings();            ///< the flags' values; lobe and exposure are chosen later, with the scene
    std::vector<std::string_view> given_settings{};  ///< names of settings whose flags were given
    std::optional<std::string> lobe_name;
    io::LobeParameters lobe;
    std::optional<Vec4f> background_linear;  ///< none: one that suits the scene
    bool one_of_many = false;                ///< pictures that are seen side by side share the usual background

    /// True if the flag of a setting was given.
    [[nodiscard]] bool has_given(std::string_view setting) const {
        return std::find(given_settings.begin(), given_settings.end(), setting) != given_settings.end();
    }
};

/// Values of all flags of a picture. Each step of a job takes the part that it reads. The initial values here are the defaults; the help
/// text prints them.
struct RenderOptions : ModelRequest, ContentRequest, ViewRequest, LightRequest, SettingsRequest {
    FilmOptions film;  ///< of render alone, but for its views
    Execution execution;
    double timeout_s = 0.0;            ///< for loading and drawing; 0: none
    std::size_t max_memory_bytes = 0;  ///< of the process; 0: no limit

    /// `load` with the limit of time and the threads.
    [[nodiscard]] LoadOptions timed_load() const {
        LoadOptions timed = load;
        timed.limits.time_limit_s = timeout_s;
        timed.threads = execution.threads;
        return timed;
    }
    /// A view of the whole scene, or of the parts that are drawn alone, is asked for. A turntable goes around the scene.
    [[nodiscard]] bool asks_for_frame() const { return own_view() || (!camera && (!parts.only.empty() || film.turntable > 0)); }
};

/// --camera, for a picture by each camera of --camera-file.
inline constexpr const char* kAllCameras = "all";

/// The SCENE argument. `model` must outlive what this returns.
[[nodiscard]] Positional scene_argument(ModelRequest& model, bool required);

/// Title of the last group of render_flags().
inline constexpr std::string_view kLastPictureGroup = "Untrusted files";

/// `options` must outlive what this returns. usual: for ViewRequest::usual_size.
[[nodiscard]] std::vector<FlagGroup> render_flags(RenderOptions& options, PictureSize usual);

/// Reads flags that are not from a command line, such as those of a list of scenes.
[[nodiscard]] Result<RenderOptions> parse_render_flags(std::span<const std::string> words);

}  // namespace halflit::engine
