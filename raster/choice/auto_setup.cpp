#include "halflit/auto_setup.hpp"

#include "halflit/prepared_scene.hpp"
#include "raster/choice/completed_light.hpp"
#include "raster/choice/framing.hpp"
#include "raster/choice/suited_background.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "shading/environment.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace halflit {
namespace {

/// A duck that is drawn a fifth of the picture wide has a box of 15 %.
constexpr double kLeastShare = 1.0 / 6.0;
/// Long and flat scenes fill little of any picture. Those that lie in it as a whole, and reach over so much of its width or height, are not
/// shown small.
constexpr double kLeastReach = 2.0 / 3.0;

/// Smallest rectangle of the picture around what is added, in [-1, 1]^2.
class PictureRectangle {
public:
    void add(double x, double y) {
        const double at[2] = {x, y};
        for (int axis = 0; axis < 2; ++axis) {
            cut_ |= !(at[axis] >= -1.0 && at[axis] <= 1.0);
            low_[axis] = std::min(low_[axis], std::clamp(at[axis], -1.0, 1.0));
            high_[axis] = std::max(high_[axis], std::clamp(at[axis], -1.0, 1.0));
        }
    }
    /// Its share of the picture; 0 if nothing was added.
    [[nodiscard]] double share() const { return side(0) * side(1); }
    /// The larger of its shares of the picture's width and height; 0 if a part of what was added lies outside.
    [[nodiscard]] double reach() const { return cut_ ? 0.0 : std::max(side(0), side(1)); }
    void add_unseen() { cut_ = true; }

private:
    [[nodiscard]] double side(int axis) const { return std::max(0.0, high_[axis] - low_[axis]) / 2.0; }

    double low_[2] = {1, 1}, high_[2] = {-1, -1};
    bool cut_ = false;
};

/// The part of the camera's picture that the box around the scene fills: that of the box between the near and the far plane.
PictureRectangle rectangle_in_picture(const Camera& camera, const Bounds& bounds) {
    struct Corner {
        double x, y, w;
        double inside[2];  ///< distances to the near and the far plane, negative outside
    };
    const Mat4 m = raster::clip_from_world(camera, camera.made_for_aspect() > 0.0f ? camera.made_for_aspect() : 1.0f);
    Corner corners[8];
    for (unsigned i = 0; i < 8; ++i) {
        const double p[3] = {i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y, i & 4 ? bounds.max.z : bounds.min.z};
        const auto row = [&](auto of) { return ((of(m.c[0]) * p[0] + of(m.c[1]) * p[1]) + of(m.c[2]) * p[2]) + of(m.c[3]); };
        const double z = row([](Vec4f c) { return double{c.z}; }), w = row([](Vec4f c) { return double{c.w}; });
        corners[i] = {row([](Vec4f c) { return double{c.x}; }), row([](Vec4f c) { return double{c.y}; }), w, {w - z, z}};
    }
    PictureRectangle rectangle;
    const auto add = [&](double x, double y, double w) {
        if (w > 0.0) rectangle.add(x / w, y / w);
    };
    for (unsigned i = 0; i < 8; ++i) {
        const Corner& a = corners[i];
        if (a.inside[0] >= 0.0 && a.inside[1] >= 0.0)
            add(a.x, a.y, a.w);
        else
            rectangle.add_unseen();
        for (unsigned axis = 1; axis < 8; axis *= 2) {
            if ((i & axis) != 0) continue;
            const Corner& b = corners[i | axis];
            for (int plane = 0; plane < 2; ++plane) {
                if ((a.inside[plane] < 0.0) == (b.inside[plane] < 0.0)) continue;
                const double t = a.inside[plane] / (a.inside[plane] - b.inside[plane]);
                add(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w));
            }
        }
    }
    return rectangle;
}

float environment_exposure(const Environment& environment) {
    const double level = environment_level(environment);
    if (environment.calibrated || !(level > 1e-18 && level < 1e18)) return 1.0f;
    return static_cast<float>(0.5 / level);
}

bool gives_light(const Light& light) { return !(light.color_linear == Vec3f{}); }

bool is_dark(const Ambient& ambient) { return ambient.sky_linear == Vec3f{} && ambient.ground_linear == Vec3f{}; }

/// The studio's share beside lights that the caller chose: their far sides stay dark, but can be read.
constexpr float kStudioUnderLights = 0.15f;
/// Share of the key light that suns of a file take the place of.
constexpr float kMostKeyReplaced = 0.85f;

/// Light that suns shed on faces between up and the viewer, in parts of white: they need the key light so much less.
float sunlit_share(const Lighting& light, const Camera& camera, float level) {
    const Vec4f back = camera.world_from_camera.c[2];
    const Vec3f towards = normalize_or(normalize_or(Vec3f{back.x, back.y, back.z}, {0, 0, 1}) + Vec3f{0, 1, 0}, {0, 1, 0});
    double sum = 0.0;
    for (const Light& one : light.lights)
        if (!kind_of(one.type).placed)
            sum += sh::luminance(to_double(one.color_linear)) * std::max(0.0, -dot(to_double(one.direction_ws), to_double(towards)));
    return static_cast<float>(std::clamp(sum / level, 0.0, 1.0));
}

/// Adds the light that is lacking. Returns the exposure.
float complete(Lighting& light, const Bounds& bounds, const Camera& camera, const AutoOptions& options) {
    const bool in_studio = light.environment != nullptr && light.environment->studio_level != 0.0f;
    const bool always = options.studio == StudioUse::always && !options.ambient_linear;
    if (light.environment != nullptr && !in_studio && !always) return environment_exposure(*light.environment);
    const bool dark = light.environment == nullptr && is_dark(light.ambient);
    const bool has_lights = std::any_of(light.lights.begin(), light.lights.end(), gives_light);
    const bool unknown_unit = !light.calibrated && has_lights;
    const auto set_studio = [&](float level) {
        light.ambient = {};
        light.environment = studio_environment(camera, options.studio_turn_rad, level);
    };
    if (!has_lights && dark && options.add_lights) {
        light.calibrated = true;
        if (options.studio == StudioUse::never || options.ambient_linear)
            add_default_lights(light, camera);
        else
            add_studio(light, camera, options.studio_turn_rad);
    }
    // Lights of a file add to the studio, so that a file is not darker with them than without; strong ones are as bright as white in it.
    // Suns that light what the viewer sees take the key light's place, so that their shadows are seen.
    const bool can_add = unknown_unit && options.studio == StudioUse::for_dark && !options.ambient_linear, adds = can_add && dark;
    float level = unknown_unit ? 1.0f / auto_exposure(light, bounds) : 1.0f;
    if (adds)
        level = std::max(level, 1.0f);
    else if (can_add && in_studio)  // the light was completed before, and has the key light
        level = light.environment->studio_level;
    if (adds) {
        const float key = 1.0f - kMostKeyReplaced * sunlit_share(light, camera, level);
        add_studio(light, camera, options.studio_turn_rad, level);
        light.lights.back().color_linear = light.lights.back().color_linear * key;
    } else if (options.ambient_linear)
        light.ambient = {*options.ambient_linear, *options.ambient_linear};
    else if (always && !in_studio)
        set_studio(level);
    else if (has_lights && dark && options.studio == StudioUse::under_lights)
        set_studio(kStudioUnderLights * level);
    else if (unknown_unit && dark)
        light.ambient = soft_ambient(light, bounds);
    return 1.0f / level;
}

/// The largest size with the camera's aspect ratio that fits into the usual one.
PictureSize shaped(PictureSize usual, const Camera& camera) {
    const auto aspect = static_cast<double>(camera.made_for_aspect());
    if (!(aspect > 1e-3 && aspect < 1e3)) return usual;
    const double fitted = std::min(static_cast<double>(usual.width), static_cast<double>(usual.height) * aspect);
    const auto side = [](double pixels) { return std::max(1, static_cast<int>(pixels + 0.5)); };
    return {side(fitted), side(fitted / aspect)};
}

Result<const Camera*> find_camera(const std::vector<Camera>& cameras, const std::string& wanted) {
    for (const Camera& camera : cameras)
        if (camera.name == wanted) return &camera;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < cameras.size()) return &cameras[index];
    if (cameras.empty()) return fail(ErrorCode::usage, "camera: the scene has no camera, found '" + wanted + "'");
    return fail(ErrorCode::usage,
                "camera: expected an index below " + std::to_string(cameras.size()) + " or a camera's name, found '" + wanted + "'");
}

}  // namespace

raster::CompletedLight raster::completed_light(const Scene& scene, const Bounds& bounds, const Camera& camera, const AutoOptions& options) {
    const FpEnvironment environment_of_host;
    CompletedLight out{options.light ? *options.light : static_cast<const Lighting&>(scene)};
    out.exposure = complete(out.light, bounds, camera, options);
    return out;
}

Settings usual_settings() {
    const FpEnvironment environment_of_host;
    Settings settings;
#define HALFLIT_USUAL(place, value) settings.place = value;
#include "raster/settings_table.def"
    settings.background_linear = raster::suited_background({});
    return settings;
}

const Camera* choose_camera(const Scene& scene, const Bounds& bounds) {
    const FpEnvironment environment_of_host;
    if (scene.cameras.empty()) return nullptr;
    const Camera& first = scene.cameras.front();
    if (bounds.empty) return &first;
    const PictureRectangle filled = rectangle_in_picture(first, bounds);
    const bool is_near = filled.share() >= kLeastShare || filled.reach() >= kLeastReach;
    return is_near && shows_surface(scene, first, 1.0f) ? &first : nullptr;
}

namespace {

/// prepared: keeps the framed part; null: the scene is not prepared.
AutoSetup setup_of(const Scene& scene, const raster::PreparedData* prepared, const Bounds& bounds, int width, int height,
                   const AutoOptions& options) {
    AutoSetup setup;
    const Camera* chosen = options.camera ? &*options.camera : options.frame ? nullptr : choose_camera(scene, bounds);
    setup.framed = chosen == nullptr;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const FramedView seen = chosen != nullptr     ? FramedView{front_view(scene, options.view), *chosen}
                            : prepared != nullptr ? raster::choose_view(scene, prepared->framed_part(), bounds, aspect, options.view)
                                                  : choose_view(scene, bounds, aspect, options.view);
    setup.view = seen.view, setup.camera = seen.camera, setup.view_reason = seen.reason;
    setup.settings = usual_settings();
    if (options.view.orthographic && setup.camera.orthographic) setup.settings.shadows = ShadowMode::off;
    setup.settings.background_linear = raster::suited_background(scene);
    auto [light, exposure] = raster::completed_light(scene, bounds, setup.camera, options);
    setup.light = std::move(light);
    setup.settings.exposure = options.exposure.value_or(exposure) * exposure_factor(options.exposure_compensation_ev);
    // A file whose lights are thousands of lux has an exposure for these, which would hide what glows. Viewers of the field show emission
    // as it would be at the exposure 1; so it is at least as bright as there.
    if (!options.exposure && exposure < 1.0f) setup.settings.shading.emission_scale = 1.0f / exposure;
    return setup;
}

Result<PictureChoice> chosen_picture(const Scene& scene, const raster::PreparedData* prepared, const Bounds& bounds,
                                     const PictureRequest& request) {
    const FpEnvironment environment_of_host;
    const Camera* chosen = request.camera ? &*request.camera : request.frame ? nullptr : choose_camera(scene, bounds);
    if (request.scene_camera && !request.camera) {
        const auto found = find_camera(scene.cameras, *request.scene_camera);
        if (!found) return tl::unexpected(found.error());
        chosen = *found;
    }
    const PictureSize usual = request.usual_size;
    const PictureSize size = request.size ? *request.size : chosen != nullptr ? shaped(usual, *chosen) : usual;
    if (size.width < 1 || size.height < 1)
        return fail(ErrorCode::usage,
                    "size: expected at least 1 x 1 pixels, found " + std::to_string(size.width) + " x " + std::to_string(size.height));
    AutoOptions options = request;
    options.frame = chosen == nullptr;
    if (chosen != nullptr) options.camera = *chosen;
    PictureChoice choice{setup_of(scene, prepared, bounds, size.width, size.height, options), size, -1};
    if (chosen != nullptr && !request.camera) choice.scene_camera = static_cast<int>(chosen - scene.cameras.data());
    return choice;
}

}  // namespace

Result<PictureChoice> choose_picture(const PreparedScene& scene, const Bounds& bounds, const PictureRequest& request) {
    return raster::guarded("choosing a picture", {}, [&] {
        const WorkLimit work(scene.scene().frame_work);
        return chosen_picture(scene.scene(), &scene.data(), bounds, request);
    });
}

Result<PictureChoice> choose_picture(const Scene& scene, const PictureRequest& request) {
    return raster::guarded("choosing a picture", {}, [&] {
        const WorkLimit work(scene.frame_work);
        return chosen_picture(scene, nullptr, scene_bounds(scene), request);
    });
}

AutoSetup auto_setup(const Scene& scene, int width, int height, const AutoOptions& options) {
    const FpEnvironment environment_of_host;
    return auto_setup(scene, scene_bounds(scene), width, height, options);
}

AutoSetup auto_setup(const Scene& scene, const Bounds& bounds, int width, int height, const AutoOptions& options) {
    const FpEnvironment environment_of_host;
    return setup_of(scene, nullptr, bounds, width, height, options);
}

}  // namespace halflit
