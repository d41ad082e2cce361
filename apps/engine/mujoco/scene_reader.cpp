#include "apps/engine/mujoco/scene_reader.hpp"

#include "apps/engine/mujoco/room.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace halflit::engine::mujoco {
namespace {

using shading::finite;

/// One struct of the caller's array.
class Record {
public:
    Record(const std::byte* first, std::int32_t size, int index) : at_(first + std::ptrdiff_t{size} * index) {}
    /// The member at a place, or `otherwise` if there is none.
    template <class T>
    [[nodiscard]] T get(std::int32_t place, T otherwise) const {
        T value = otherwise;
        if (place >= 0) std::memcpy(&value, at_ + place, sizeof value);
        return value;
    }
    [[nodiscard]] float number(std::int32_t place) const { return get(place, 0.0f); }
    [[nodiscard]] std::int32_t integer(std::int32_t place) const { return get(place, std::int32_t{-1}); }
    [[nodiscard]] bool truth(std::int32_t place) const { return get(place, std::uint8_t{0}) != 0; }
    [[nodiscard]] Vec3f vec3(std::int32_t place) const { return get(place, Vec3f{}); }

private:
    const std::byte* at_;
};

/// A number of mjtGeom as a GeomType.
std::int32_t type_of(const Layout& layout, std::int32_t raw) {
    if (raw < 0) return kNotDrawn;
    const std::pair<std::int32_t, GeomType> own[] = {
        {layout.type_skin, kSkin}, {layout.type_flex, kFlex}, {layout.type_linebox, kLineBox}, {layout.type_triangle, kTriangle}};
    for (const auto& [number, type] : own)
        if (raw == number) return type;
    return raw <= kSdf || (raw >= kArrow && raw <= kLine) ? raw : kNotDrawn;
}

/// A light's type: a byte that tells directional ones, or mjtLightType.
LightKind kind_of(const Layout& layout, const Record& from) {
    if (layout.light_type < 0) return from.truth(layout.light_directional) ? LightKind::directional : LightKind::spot;
    const std::int32_t type = from.integer(layout.light_type);
    return type == 0 ? LightKind::spot : type == 1 ? LightKind::directional : LightKind::none;
}

Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

}  // namespace

Result<Geom> read_geom(const Layout& layout, const Scene& scene, int index, std::span<const TextureUse> materials, int texture_count) {
    const Record from(scene.geoms, layout.geom_size, index);
    const auto mat = from.get(layout.geom_mat, std::array<float, 9>{});
    Geom geom{.type = type_of(layout, from.integer(layout.geom_type)),
              .dataid = from.integer(layout.geom_dataid),
              .objtype = from.integer(layout.geom_objtype),
              .objid = from.integer(layout.geom_objid),
              .segid = from.integer(layout.geom_segid),
              .texcoord = from.integer(layout.geom_texcoord),
              .use = {},
              .size = from.vec3(layout.geom_scale),
              .position = from.vec3(layout.geom_pos),
              .axes = {{mat[0], mat[3], mat[6]}, {mat[1], mat[4], mat[7]}, {mat[2], mat[5], mat[8]}},
              .rgba = from.get(layout.geom_rgba, Vec4f{}),
              .emission = from.number(layout.geom_emission),
              .specular = from.number(layout.geom_specular),
              .shininess = from.number(layout.geom_shininess),
              .reflectance = from.number(layout.geom_reflectance),
              .rbound = from.number(layout.geom_modelrbound)};
    const auto wrong = [&](const char* name, std::int32_t found, std::size_t count) {
        return fail(ErrorCode::bad_input, fmt::format("geom {}: {} is {}, the model has {}", index, name, found, count));
    };
    if (layout.geom_texid >= 0) {
        geom.use.texture = std::max(-1, from.integer(layout.geom_texid));
        geom.use.uniform = from.get(layout.geom_texuniform, std::int32_t{0}) != 0;
        const auto repeat = from.get(layout.geom_texrepeat, Vec2f{1, 1});
        geom.use.repeat[0] = repeat.x, geom.use.repeat[1] = repeat.y;
    } else if (const std::int32_t material = from.integer(layout.geom_matid); material >= 0) {
        if (static_cast<std::size_t>(material) >= materials.size()) return wrong("matid", material, materials.size());
        geom.use = materials[static_cast<std::size_t>(material)];
    }
    if (geom.use.texture >= texture_count) return wrong("texid", geom.use.texture, static_cast<std::size_t>(texture_count));
    const Vec4f c = geom.rgba;
    if (!finite(geom.size) || !finite(geom.position) || !finite(geom.axes[0]) || !finite(geom.axes[1]) || !finite(geom.axes[2]) ||
        !finite(Vec3f{c.x, c.y, c.z}) || !finite(c.w) || !finite(Vec3f{geom.emission, geom.specular, geom.shininess}) ||
        !finite(Vec3f{geom.reflectance, geom.rbound, 0}))
        return fail(ErrorCode::bad_input, fmt::format("geom {}: a number is not finite", index));
    return geom;
}

Light read_light(const Layout& layout, const Scene& scene, int index) {
    const Record from(scene.lights, layout.light_size, index);
    const Vec3f attenuation = from.vec3(layout.light_attenuation);
    return {.position = from.vec3(layout.light_pos),
            .direction = from.vec3(layout.light_dir),
            .ambient = from.vec3(layout.light_ambient),
            .diffuse = from.vec3(layout.light_diffuse),
            .specular = from.vec3(layout.light_specular),
            .attenuation = {attenuation.x, attenuation.y, attenuation.z},
            .cutoff = from.number(layout.light_cutoff),
            .exponent = from.number(layout.light_exponent),
            .kind = kind_of(layout, from),
            .headlight = from.truth(layout.light_headlight),
            .castshadow = from.truth(layout.light_castshadow)};
}

Result<Camera> read_camera(const Layout& layout, const std::byte* two) {
    const Record a(two, layout.camera_size, 0), b(two, layout.camera_size, 1);
    const auto mean = [&](std::int32_t place) { return 0.5f * (a.number(place) + b.number(place)); };
    const auto sum = [&](std::int32_t place) { return to_double(a.vec3(place)) + to_double(b.vec3(place)); };
    const Vec3d forward = unit(sum(layout.camera_forward)), up = sum(layout.camera_up);
    const Camera camera{.position = to_float(sum(layout.camera_pos) * 0.5),
                        .forward = to_float(forward),
                        .up = to_float(unit(up - forward * dot(forward, up))),
                        .center = mean(layout.camera_center),
                        .width = mean(layout.camera_width),
                        .bottom = mean(layout.camera_bottom),
                        .top = mean(layout.camera_top),
                        .near_z = mean(layout.camera_near),
                        .far_z = mean(layout.camera_far),
                        .orthographic = a.get(layout.camera_orthographic, std::int32_t{0}) != 0};
    if (finite(camera.position) && finite(camera.forward) && finite(camera.up) && finite(Vec3f{camera.center, camera.width, 0}) &&
        camera.near_z > 1e-15f && camera.far_z > camera.near_z && camera.top > camera.bottom && finite(camera.far_z) &&
        finite(Vec3f{camera.top, camera.bottom, camera.top - camera.bottom}))
        return camera;
    return fail(ErrorCode::usage, fmt::format("camera: near {}, far {}, bottom {}, top {}, expected 0 < near < far and bottom < top: "
                                              "call mjv_updateScene first",
                                              camera.near_z, camera.far_z, camera.bottom, camera.top));
}

}  // namespace halflit::engine::mujoco
