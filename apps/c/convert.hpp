// Structs of halflit.h to those of the C++ headers, and back. A struct's defaults are those of its C++ twin.
#pragma once

#include "apps/c/world.hpp"
#include "halflit/halflit.h"

#include <halflit/auto_setup.hpp>
#include <halflit/camera.hpp>
#include <halflit/environment.hpp>
#include <halflit/error.hpp>
#include <halflit/light.hpp>
#include <halflit/material.hpp>
#include <halflit/math.hpp>
#include <halflit/model.hpp>
#include <halflit/report.hpp>
#include <halflit/settings.hpp>
#include <halflit/target.hpp>

#include <string>

namespace halflit::c {

[[nodiscard]] inline Vec3f vec3(const float v[3]) { return {v[0], v[1], v[2]}; }
inline void put(Vec3f v, float to[3]) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }
[[nodiscard]] inline Vec3d vec3(const double v[3]) { return {v[0], v[1], v[2]}; }
inline void put(Vec3d v, double to[3]) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }
inline void put(Vec3d v, float to[3]) { to[0] = static_cast<float>(v.x), to[1] = static_cast<float>(v.y), to[2] = static_cast<float>(v.z); }
[[nodiscard]] Mat4 mat4(const float m[16]);
void put(const Mat4& m, float to[16]);

// Each fails (usage) for a value that has no twin. Null pointers give the defaults where the header allows them.
[[nodiscard]] Result<LoadOptions> load_options(const halflit_load_options* given);
[[nodiscard]] Result<Material> material(const halflit_material* given);
[[nodiscard]] Result<CallersLight> light(const halflit_light* given);
[[nodiscard]] Result<CallersCamera> camera(const halflit_camera* given);
[[nodiscard]] Result<Settings> settings(const halflit_settings* given);
[[nodiscard]] Result<ViewSettings> view(const halflit_view* given);
/// A camera of the request, and lengths, in the world that is drawn.
[[nodiscard]] Result<PictureRequest> picture_request(const halflit_picture_request* given, const World& world);
[[nodiscard]] Result<CallersInstance> instance(const halflit_instance* given);
[[nodiscard]] Result<Execution> execution(const halflit_execution* given);
/// Whether SIGINT stops what is drawn by it. given: one that execution() has let pass; older programs have a shorter struct.
[[nodiscard]] bool stops_at_interrupt(const halflit_execution* given);
struct TextureColor {
    ColorSpace space;
    MipRule rule;
};
[[nodiscard]] Result<TextureColor> texture_color(std::int32_t given);

/// An environment's options, and whether its image is calibrated.
struct EnvironmentRequest {
    EnvironmentOptions options;
    bool calibrated = false;
};
[[nodiscard]] Result<EnvironmentRequest> environment_request(const halflit_environment_options* given);

/// The target as given, of this version's size, with a valid format.
[[nodiscard]] Result<halflit_target> target_struct(const halflit_target* given);
[[nodiscard]] Target target(const halflit_target& given);
[[nodiscard]] constexpr bool is_float(std::int32_t format) {
    return format == HALFLIT_FORMAT_RGBA_F32 || format == HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED;
}
[[nodiscard]] constexpr bool is_premultiplied(std::int32_t format) {
    return format == HALFLIT_FORMAT_RGBA8_PREMULTIPLIED || format == HALFLIT_FORMAT_BGRA8_PREMULTIPLIED ||
           format == HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED;
}
[[nodiscard]] constexpr bool is_bgra(std::int32_t format) {
    return format == HALFLIT_FORMAT_BGRA8 || format == HALFLIT_FORMAT_BGRA8_PREMULTIPLIED;
}

// Strings in these refer to the argument.
[[nodiscard]] halflit_load_options to_c(const LoadOptions& from);
[[nodiscard]] halflit_material to_c(const Material& from);
[[nodiscard]] halflit_light to_c(const CallersLight& from);
[[nodiscard]] halflit_camera to_c(const CallersCamera& from);
[[nodiscard]] halflit_settings to_c(const Settings& from);
[[nodiscard]] halflit_report to_c(const RenderReport& from);
[[nodiscard]] halflit_environment_options default_environment_options();
[[nodiscard]] halflit_view default_view();
[[nodiscard]] halflit_picture_request default_picture_request();
[[nodiscard]] halflit_instance to_c(const CallersInstance& from);
[[nodiscard]] halflit_execution default_execution();
[[nodiscard]] halflit_target default_target();
[[nodiscard]] halflit_mesh default_mesh();
[[nodiscard]] halflit_splats default_splats();

}  // namespace halflit::c
