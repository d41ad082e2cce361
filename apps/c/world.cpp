#include "apps/c/world.hpp"

#include "apps/io/gltf/build/scaled_mesh.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halflit::c {
namespace {

using io::scaled, io::scale_lengths;

Vec3f rounded(Vec3d p) {
    const auto within = [](double x) { return std::isfinite(x) ? std::clamp(x, -io::kLargestLength, io::kLargestLength) : x; };
    return to_float({within(p.x), within(p.y), within(p.z)});
}

Vec3d column(const Mat4& m, int i) { return {m.c[i].x, m.c[i].y, m.c[i].z}; }
Vec4f column(Vec3d v, float w) {
    const Vec3f f = rounded(v);
    return {f.x, f.y, f.z, w};
}

/// Calls change(p) for the three floats of each pixel of a plane. pixel: place of the first one that was drawn in a row.
struct PlaneRows {
    const halflit_target& target;
    Region at;  ///< in the memory

    PlaneRows(const halflit_target& of, const Region& region)
        : target(of), at(region.width > 0 ? region : Region{0, 0, of.width, of.height}) {
        if (of.region_alone != 0) at.x = at.y = 0;
    }
    template <class T>
    [[nodiscard]] T* row(T* plane, std::size_t row_bytes, int y, std::size_t channels) const {
        const auto width = static_cast<std::size_t>(target.region_alone != 0 ? at.width : target.width);
        const std::size_t stride = row_bytes != 0 ? row_bytes : channels * sizeof(T) * width;
        auto* const bytes = reinterpret_cast<unsigned char*>(plane) + static_cast<std::size_t>(y) * stride;
        return reinterpret_cast<T*>(bytes) + channels * static_cast<std::size_t>(at.x);
    }
    /// change(p, x, y): of each pixel, in the memory's rows and the region's columns.
    template <class T, class Change>
    void each(T* plane, std::size_t row_bytes, std::size_t channels, const Change& change) const {
        for (int y = at.y; plane != nullptr && y < at.y + at.height; ++y) {
            T* p = row(plane, row_bytes, y, channels);
            for (int x = 0; x < at.width; ++x, p += channels) change(p, x, y);
        }
    }
};

}  // namespace

double World::mesh_scale(int mesh) const {
    const auto index = static_cast<std::size_t>(mesh);
    return mesh >= 0 && index < at_.mesh_scales.size() ? at_.mesh_scales[index] : 1.0;
}

void World::set_mesh_scale(std::size_t mesh, double scale) {
    if (at_.mesh_scales.size() <= mesh) at_.mesh_scales.resize(mesh + 1, 1.0);
    at_.mesh_scales[mesh] = scale;
}

Vec3d World::into(const FinePoint& p) const {
    // In this order what out() gave comes back exactly: the difference of two neighbours has no rounding.
    return ((turned_upright(p.point, at_.up) - at_.origin) + turned_upright(p.rest, at_.up)) * at_.scale;
}

FinePoint World::out(Vec3d p) const {
    const Vec3d away = p * (1.0 / at_.scale);
    const Vec3d coarse = to_double(rounded(away + at_.origin));
    return {turned_back(coarse, at_.up), turned_back(away - (coarse - at_.origin), at_.up)};
}

std::optional<World::Box> World::out(const Bounds& bounds) const {
    if (bounds.empty) return {};
    const Vec3d a = at_.out(to_double(bounds.min)), b = at_.out(to_double(bounds.max));  // quarter turns may exchange the ends of an axis
    return Box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}, {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

Camera World::into(const CallersCamera& given) const {
    Camera camera = given.camera;
    camera.world_from_camera = turned_upright(camera.world_from_camera, at_.up);
    camera.world_from_camera.c[3] = column(into(FinePoint{column(given.camera.world_from_camera, 3), given.rest}), 1);
    scale_lengths(camera, at_.scale);
    return camera;
}

CallersCamera World::out(const Camera& drawn) const {
    CallersCamera returned{drawn, {}};
    const FinePoint place = out(column(drawn.world_from_camera, 3));
    returned.rest = place.rest;
    returned.camera.world_from_camera = turned_back(drawn.world_from_camera, at_.up);
    returned.camera.world_from_camera.c[3] = column(place.point, 1);
    scale_lengths(returned.camera, 1.0 / at_.scale);
    return returned;
}

Light World::into(const CallersLight& given) const {
    Light light = given.light;
    light.direction_ws = to_float(turned_upright(to_double(light.direction_ws), at_.up));
    light.position_ws = rounded(into(FinePoint{to_double(light.position_ws), given.rest}));
    scale_lengths(light, at_.scale);
    return light;
}

CallersLight World::out(const Light& drawn) const {
    CallersLight returned{drawn, {}};
    const FinePoint place = out(to_double(drawn.position_ws));
    returned.light.position_ws = to_float(place.point), returned.rest = place.rest;
    returned.light.direction_ws = to_float(turned_back(to_double(drawn.direction_ws), at_.up));
    scale_lengths(returned.light, 1.0 / at_.scale);
    return returned;
}

Mat4 World::into(const Placing& given, int mesh) const {
    const double size = at_.scale / mesh_scale(mesh);
    const auto turned = [&](Vec3d v) { return column(turned_upright(v, at_.up) * size, 0); };
    return {{turned(given.axes[0]), turned(given.axes[1]), turned(given.axes[2]), column(into(FinePoint{given.place, given.rest}), 1)}};
}

CallersInstance World::out(const Instance& drawn) const {
    const double size = mesh_scale(drawn.mesh) / at_.scale;
    const Mat4& m = drawn.world_from_object;
    const auto turned = [&](int i) { return column(turned_back(column(m, i) * size, at_.up), 0); };
    const FinePoint place = out(column(m, 3));
    CallersInstance returned{drawn, place.rest};
    returned.instance.world_from_object = {{turned(0), turned(1), turned(2), column(place.point, 1)}};
    return returned;
}

void World::into(Mesh& mesh, std::size_t index) const {
    const double size = mesh_scale(static_cast<int>(index));
    if (size != 1.0) scale_lengths(mesh, size);
}

Settings World::into(Settings given) const {
    given.shadow_fade = scaled(given.shadow_fade, at_.scale);
    return given;
}

Settings World::out(Settings drawn) const {
    drawn.shadow_fade = scaled(drawn.shadow_fade, 1.0 / at_.scale);
    return drawn;
}

void World::out(const halflit_target& target, const Region& region) const {
    if (at_.up == UpAxis::y && at_.scale == 1.0 && !moves()) return;
    const PlaneRows rows(target, region);
    if (at_.up != UpAxis::y)
        for (const auto& [plane, row_bytes] :
             {std::pair(target.normal, target.normal_row_bytes), std::pair(target.shading_normal, target.shading_normal_row_bytes)})
            rows.each(plane, row_bytes, 3, [&](float* p, int, int) {
                const Vec3f returned = to_float(turned_back(Vec3d{p[0], p[1], p[2]}, at_.up));
                p[0] = returned.x, p[1] = returned.y, p[2] = returned.z;
            });
    const auto shows = [&](int x, int y) {
        if (!moves()) return true;
        if (target.instance != nullptr) return rows.row(target.instance, target.instance_row_bytes, y, 1)[x] != 0;
        return target.depth == nullptr || std::isfinite(rows.row(target.depth, target.depth_row_bytes, y, 1)[x]);
    };
    rows.each(target.position, target.position_row_bytes, 3, [&](float* p, int x, int y) {
        if (!shows(x, y)) return;
        const Vec3f returned = rounded(at_.out(Vec3d{p[0], p[1], p[2]}));
        p[0] = returned.x, p[1] = returned.y, p[2] = returned.z;
    });
    const auto smaller = static_cast<float>(1.0 / at_.scale);  // a power of two; infinity stays
    if (smaller != 1.0f) rows.each(target.depth, target.depth_row_bytes, 1, [=](float* d, int, int) { *d *= smaller; });
}

}  // namespace halflit::c
