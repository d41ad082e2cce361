// Whether a view shows anything, judged by the triangles: those outside of it, and those whose back is not drawn, do not count. The first
// one that does ends the search, which is the first triangle or nearly so in all but odd scenes.
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>
#include <span>

namespace halflit {
namespace {

class SurfaceFinder {
public:
    SurfaceFinder(const Camera& camera, float aspect) : clip_(raster::clip_from_world(camera, aspect)), is_parallel_(camera.orthographic) {
        eye_ = axis(camera.world_from_camera, 3);
        back_ = axis(camera.world_from_camera, 2);
    }

    [[nodiscard]] bool sees(const Mesh& mesh, const Mat4& world_from_object, bool both_sides) {
        const std::size_t corners = corners_of(mesh.topology);
        const bool mirrored = determinant3(world_from_object) < 0.0;
        for (std::size_t i = 0; i + corners <= mesh.indices.size(); i += corners) {
            check_();
            Vec3d at[3];
            for (std::size_t c = 0; c < corners; ++c)
                at[c] = to_double(transform_point(world_from_object, mesh.positions[mesh.indices[i + c]]));
            if (!is_inside({at, corners})) continue;
            if (corners < 3) return true;
            const Vec3d normal = cross(at[1] - at[0], at[2] - at[0]);
            const double facing = dot(normal, is_parallel_ ? back_ : eye_ - at[0]) * (mirrored ? -1.0 : 1.0);
            if (both_sides ? facing != 0.0 : facing > 0.0) return true;
        }
        return false;
    }

private:
    /// False if all points lie outside of one of the planes around the view.
    [[nodiscard]] bool is_inside(std::span<const Vec3d> points) const {
        unsigned outside_of_all = 0x3Fu;
        for (const Vec3d& p : points) {
            const auto row = [&](auto of) {
                return ((double{of(clip_.c[0])} * p.x + double{of(clip_.c[1])} * p.y) + double{of(clip_.c[2])} * p.z) +
                       double{of(clip_.c[3])};
            };
            const double x = row([](Vec4f c) { return c.x; }), y = row([](Vec4f c) { return c.y; });
            const double z = row([](Vec4f c) { return c.z; }), w = row([](Vec4f c) { return c.w; });
            const bool in[6] = {x >= -w, x <= w, y >= -w, y <= w, z >= 0, z <= w};  // false for NaN
            unsigned outside = 0;
            for (unsigned plane = 0; plane < 6; ++plane) outside |= in[plane] ? 0u : 1u << plane;
            outside_of_all &= outside;
        }
        return outside_of_all == 0;
    }

    Mat4 clip_;
    bool is_parallel_;
    Vec3d eye_, back_;
    TimeCheck check_;
};

}  // namespace

bool shows_surface(const Scene& scene, const Camera& camera, float aspect) {
    const FpEnvironment environment_of_host;
    SurfaceFinder finder(camera, camera.made_for_aspect() > 0.0f ? camera.made_for_aspect() : aspect);
    for (const Instance& instance : scene.instances) {
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Material* const material = raster::material_of(scene, instance);
        if (material != nullptr && material->alpha_mode == AlphaMode::blend && material->base_color.w == 0.0f) continue;
        if (finder.sees(mesh, instance.world_from_object, material != nullptr && material->double_sided)) return true;
    }
    return false;
}

ViewSettings visible_side(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    constexpr float kBehind = 180.0f, kBelow = -40.0f;
    const auto turned = [&](float azimuth_deg, float elevation_deg) {
        ViewSettings other = view;
        other.azimuth_deg += azimuth_deg;
        other.elevation_deg = elevation_deg;
        return other;
    };
    for (const ViewSettings& side : {view, turned(kBehind, view.elevation_deg), turned(0, kBelow), turned(kBehind, kBelow)})
        if (shows_surface(scene, frame_scene(scene, bounds, aspect, side), aspect)) return side;
    return view;
}

}  // namespace halflit
