// The view of a scene without a camera, and whether a view shows anything.
//
// The usual view is changed a little or more by where the surface faces and whether it is hollow from above: by whole degrees, without
// jumps. The picture's size plays no part.
//
// Whether a view shows anything is judged by the triangles: those outside of it, and those whose back is not drawn, do not count. The
// first one that does ends the search, which is the first triangle or nearly so in all but odd scenes.
#include "halflit/auto_setup.hpp"
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "raster/choice/framing.hpp"
#include "raster/choice/hollows.hpp"
#include "raster/choice/part_triangles.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/smoothstep.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

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
            const std::uint32_t* const index = &mesh.indices[i];
            if (std::any_of(index, index + corners, [&](std::uint32_t v) { return v >= mesh.positions.size(); })) continue;
            Vec3d at[3];
            for (std::size_t c = 0; c < corners; ++c) at[c] = to_double(transform_point(world_from_object, mesh.positions[index[c]]));
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

/// How far the usual view is turned and raised for the shape of what is seen. Each share of the surface has a range over which a view
/// changes, so that like models get like views; below it, as for a cube or a ball, whose shares are a third each, the usual view stays.
struct Rule {
    double from, to;  ///< share, where the view begins to change and where it has changed
    double turn_deg, rise_deg;
    ViewReason reason;
};
constexpr Rule kFlat{0.44, 0.68, 0, 25, ViewReason::flat};         // faces up or down: from farther above
constexpr Rule kThinAlongZ{0.7, 0.95, -25, -8, ViewReason::thin};  // upright and thin: nearly from the front,
constexpr Rule kThinAlongX{0.7, 0.95, 45, -8, ViewReason::thin};   // or from the right
constexpr Rule kHollow{0.02, 0.08, 0, 15, ViewReason::hollow};     // open at the top, of what is seen from there
/// From above, upright lines of what is tall run together: height over width from which on it is raised less, and not at all.
constexpr double kHigh = 1.0, kTall = 2.0;

double part_of(const Rule& rule, double share) { return smoothstep((share - rule.from) / (rule.to - rule.from)); }

struct ChosenView {
    ViewSettings view;
    ViewReason reason;
};

ChosenView telling_view(const Scene& scene, const raster::FramedPart& part, const Bounds& box, const ViewSettings& usual) {
    const Vec3f side = box.max - box.min;
    const double high = static_cast<double>(side.y) / static_cast<double>(std::max({side.x, side.z, 1e-30f}));
    const double raised = 1.0 - smoothstep((high - kHigh) / (kTall - kHigh));
    raster::Hollows hollows(scene, part, box);
    Vec3d faces{};  // area that faces along each axis
    raster::each_triangle(scene, part, [&](const std::array<Vec3d, 3>& at, bool both_sides) {
        if (raised > 0.0) hollows.add(at, both_sides);
        const Vec3d doubled = absolute(cross(at[1] - at[0], at[2] - at[0]));
        const double sum = (doubled.x + doubled.y) + doubled.z;
        if (sum < 1e300) faces = faces + doubled;
    });
    const double all = (faces.x + faces.y) + faces.z;
    if (!(all > 0.0)) return {usual, ViewReason::usual};
    const double hollow = raised > 0.0 ? raised * part_of(kHollow, hollows.share()) : 0.0;
    const std::pair<const Rule*, double> parts[] = {{&kFlat, raised * part_of(kFlat, faces.y / all)},
                                                    {&kHollow, hollow},
                                                    {&kThinAlongZ, part_of(kThinAlongZ, faces.z / all)},
                                                    {&kThinAlongX, part_of(kThinAlongX, faces.x / all)}};
    double turn = 0.0, rise = 0.0, most = 0.0;
    ViewReason reason = ViewReason::usual;
    for (const auto& [rule, share] : parts) {
        turn += share * rule->turn_deg;
        rise = std::min(rise + share * rule->rise_deg, kFlat.rise_deg);
        if (share * std::abs(rule->rise_deg) > most) most = share * std::abs(rule->rise_deg), reason = rule->reason;
    }
    const auto whole = [](double degrees) { return static_cast<float>(std::floor(degrees + 0.5)); };
    ViewSettings view = usual;
    view.azimuth_deg += whole(turn), view.elevation_deg += whole(rise);
    return {view, view == usual ? ViewReason::usual : reason};
}

/// A view that was asked for stays.
bool is_usual(const ViewSettings& view) {
    const ViewSettings usual;
    return view.azimuth_deg == usual.azimuth_deg && view.elevation_deg == usual.elevation_deg;
}

}  // namespace

bool shows_surface(const Scene& scene, const Camera& camera, float aspect) {
    const FpEnvironment environment_of_host;
    SurfaceFinder finder(camera, camera.made_for_aspect() > 0.0f ? camera.made_for_aspect() : aspect);
    for (const Instance& instance : scene.instances) {
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (raster::counts_for_views(scene, instance) &&
            finder.sees(mesh, instance.world_from_object, raster::shows_both_sides(scene, instance)))
            return true;
    }
    return false;
}

ViewSettings front_view(const Scene& scene, ViewSettings view) {
    if (is_usual(view)) view.azimuth_deg += front_azimuth_deg(scene);
    return view;
}

FramedView choose_view(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    return raster::choose_view(scene, raster::framed_part(scene), bounds, aspect, view);
}

FramedView raster::choose_view(const Scene& scene, const FramedPart& part, const Bounds& bounds, float aspect, const ViewSettings& view) {
    constexpr float kBehind = 180.0f, kBelow = -40.0f;
    if (!is_usual(view)) return {view, frame_with_shadow(scene, part, bounds, aspect, view), ViewReason::given};
    const ChosenView telling = telling_view(scene, part, part.whole ? bounds : part.bounds, front_view(scene, view));
    const ViewSettings& most = telling.view;
    const ViewReason reason = telling.reason;
    const auto turned = [&](float azimuth_deg, float elevation_deg) {
        ViewSettings other = most;
        other.azimuth_deg += azimuth_deg;
        other.elevation_deg = elevation_deg;
        return other;
    };
    std::optional<Camera> usual;
    for (const ViewSettings& side : {most, turned(kBehind, most.elevation_deg), turned(0, kBelow), turned(kBehind, kBelow)}) {
        const Camera camera = frame_with_shadow(scene, part, bounds, aspect, side);
        if (shows_surface(scene, camera, aspect)) return {side, camera, usual ? ViewReason::backs : reason};
        if (!usual) usual = camera;
    }
    return {most, *usual, reason};
}

}  // namespace halflit
