// The controls of the window as values: read from a job, changed by the user, and put into settings and lights.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/light.hpp"
#include "halflit/lobe.hpp"
#include "halflit/settings.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::viewer {

/// Light from all around.
enum class Sky : std::uint8_t {
    as_started,  ///< what the flags and the file say
    none,        ///< a scene without light gets a key light and two-coloured ambient light
    studio,
    sky
};
inline constexpr const char* kSkyNames[] = {"as started", "none", "studio", "sky"};

struct LightControl {
    LightType type = LightType::directional;
    bool on = true;
    float intensity = 1.0f;  ///< factor on the light's colour
    /// The side that a directional light comes from, as a view's: 0 is from +z, 90 from +x; and its height above the horizon.
    float azimuth_deg = 0.0f, elevation_deg = 0.0f;
    friend bool operator==(const LightControl&, const LightControl&) = default;
};

/// Lights come from the scene anew where these differ.
struct SkyControls {
    Sky sky = Sky::as_started;
    float rotate_deg = 0.0f;  ///< in the place of --env-rotate
    friend bool operator==(const SkyControls&, const SkyControls&) = default;
};

struct Controls {
    bool own_lobes = true;  ///< materials keep the lobes of the scene
    /// The lobe also replaces those of materials that chose their own, as --own-lobes off does.
    bool over_own_lobes = false;
    int model = 0;  ///< index into kNamedLobes
    Lobe lobe = Lobe::lambert();
    SpecularModel specular = SpecularModel::blinn;
    bool normalize_specular = true;
    ShadowMode shadows = ShadowMode::soft_split;
    int sky_shadows = 0;
    int sh_order = 0;  ///< 0: as few bands as the error allows
    SkyControls sky;
    float exposure_ev = 0.0f;  ///< added to the exposure that was chosen
    ToneCurve tone_curve = ToneCurve::neutral;
    int samples = 4;
    float max_error_codes = 0.0f;  ///< 0: exact
    std::vector<LightControl> lights;
    friend bool operator==(const Controls&, const Controls&) = default;
};

/// The controls' first values, for a job as its flags made it.
[[nodiscard]] Controls controls_of(const engine::RenderJob& job, const engine::RenderOptions& options);

/// Controls of these lights as they are.
[[nodiscard]] std::vector<LightControl> light_controls(const std::vector<Light>& lights);

/// Chooses a model of kNamedLobes, with its wrap, power and norm; one that takes a wrap keeps the present one.
void choose_model(Controls& controls, int model);
/// Moves the wrap. The power follows in models where the wrap decides it, unless it was moved away from there.
void choose_wrap(Controls& controls, float wrap);

/// `started`: the settings that the flags made.
[[nodiscard]] Settings settings_of(const Controls& controls, const Settings& started);

/// `started`: the lights before the controls; there may be more of them than controls.
[[nodiscard]] std::vector<Light> lights_of(const Controls& controls, const std::vector<Light>& started);

/// The flags' light with the controls' sky.
[[nodiscard]] engine::LightRequest with_sky(engine::LightRequest light, const SkyControls& sky);

/// The flags of `halflit render` that give the same lobe, highlights, shadows, sky, exposure and samples, where they differ from those of
/// the start. There are none for changes of single lights, nor for a lobe's part that the start's flags set and that was taken back.
/// exposure: the factor on all light without the control's.
[[nodiscard]] std::string as_flags(const Controls& controls, const Controls& started, float exposure);

}  // namespace halflit::viewer
