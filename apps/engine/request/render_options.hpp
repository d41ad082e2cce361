// Flags that decide the picture. render, bench, info and trade share them, so that bench measures and info describes what render draws.
#pragma once

#include "apps/engine/request/camera_orbit.hpp"
#include "apps/engine/request/classic_material.hpp"
#include "apps/engine/request/film_options.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/given_camera.hpp"
#include "apps/engine/request/kept_view.hpp"
#include "apps/engine/request/scene_view.hpp"
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

/// Values of the flags. The initial values here are the defaults; the help text prints them.
struct RenderOptions {
    std::string scene;  ///< a file, "-" for standard input, or a built-in scene
    std::optional<PictureSize> size;
    Settings settings = usual_settings();            ///< the flags' values; lobe and exposure are chosen later, with the scene
    std::vector<std::string_view> given_settings{};  ///< names of settings whose flags were given
    Execution execution;

    std::optional<std::string> camera;            ///< a camera of the file, or of camera_file: its index or name, or kAllCameras
    std::string camera_file;                      ///< empty: the model's own cameras
    std::shared_ptr<const CameraFile> cameras{};  ///< of camera_file, once it is read
    std::optional<CameraOrbit> camera_orbit{};
    ViewSettings view;
    std::optional<PictureSize> fit_px;                    ///< --fit: margins of a view that is as near as its side allows
    bool whole_scene = false;                             ///< --camera frame, --azimuth, --elevation, --zoom, --fit or --view was given
    bool fov_given = false;                               ///< --fov was given
    std::optional<Vec3d> camera_position, camera_target;  ///< in the file's world
    PartFlags parts{};                                    ///< what is drawn of the scene, and how
    bool one_of_many = false;                             ///< pictures that are seen side by side share the usual background
    std::optional<KeptView> kept_view{};                  ///< draws by this one what would be framed; of golden alone
    std::vector<GivenSection> sections{};                 ///< planes that cut the scene
    double hatch_spacing = 0.0;                           ///< of caps, in the file's world; 0: chosen
    bool hatch = true;                                    ///< lines on caps
    bool ground = false;                                  ///< add a ground that only takes shadow

    /// True if the flag of a setting was given.
    [[nodiscard]] bool has_given(std::string_view setting) const {
        return std::find(given_settings.begin(), given_settings.end(), setting) != given_settings.end();
    }
    /// A camera of the flags, not of the file.
    [[nodiscard]] bool own_view() const { return whole_scene || fov_given || camera_position || camera_orbit; }
    /// Some parts are drawn alone, and no camera of the file is named: the view is of these parts.
    [[nodiscard]] bool views_parts() const { return !parts.only.empty() && !camera; }

    std::optional<std::string> lobe_name;
    io::LobeParameters lobe;
    bool own_lobes = true;  ///< materials that have lobes of their own keep them
    ClassicMaterial classic;
    std::optional<Vec3f> ambient_linear;
    std::vector<GivenLight> lights;               ///< in the file's world
    float sun_size_deg = 0.0f, lamp_size = 0.0f;  ///< of lights without a size of their own; the latter in the file's world
    bool scene_lights = true;
    std::string environment;                 ///< a file or "sky"; empty: none, or the studio
    StudioUse studio = StudioUse::for_dark;  ///< if there is no other environment
    bool environment_sun = true;
    float environment_rotate_deg = 0.0f;
    bool may_want_reference = false;         ///< the environment keeps what --accuracy reference needs, though the accuracy is another
    std::optional<Vec4f> background_linear;  ///< none: one that suits the scene
    std::optional<float> exposure;           ///< a factor; none: chosen from the lights
    float exposure_compensation_ev = 0.0f;

    LoadOptions load;
    std::shared_ptr<const std::vector<std::byte>> input{};  ///< of standard input, once it was read
    bool import_cache = true;                               ///< keep what importers make in the user's cache
    bool detail_given = false;                              ///< load.detail_px counts; otherwise it follows from the view
    SceneKeeper* keeper = nullptr;                          ///< loads the scene; null: load_scene() alone
    FilmOptions film;                                       ///< of render alone
    double timeout_s = 0.0;                                 ///< for loading and drawing; 0: none
    /// `load` with that limit.
    [[nodiscard]] LoadOptions timed_load() const {
        LoadOptions timed = load;
        timed.limits.time_limit_s = timeout_s;
        return timed;
    }
    std::size_t max_memory_bytes = 0;  ///< of the process; 0: no limit
};

/// --camera, for a picture by each camera of --camera-file.
inline constexpr const char* kAllCameras = "all";

/// The lobe that the flags choose for materials without one of their own; empty if they choose none.
[[nodiscard]] Result<std::optional<Lobe>> chosen_lobe(const RenderOptions& options);

/// The SCENE argument. `options` must outlive what these functions return.
[[nodiscard]] Positional scene_argument(RenderOptions& options, bool required);

/// Title of the last group of render_flags().
inline constexpr std::string_view kLastPictureGroup = "Untrusted files";

/// `usual`: the default picture size, which is reduced to the aspect ratio of the file's camera.
[[nodiscard]] std::vector<FlagGroup> render_flags(RenderOptions& options, PictureSize usual);

/// Reads flags that are not from a command line, such as those of a list of scenes.
[[nodiscard]] Result<RenderOptions> parse_render_flags(std::span<const std::string> words);

}  // namespace halflit::engine
