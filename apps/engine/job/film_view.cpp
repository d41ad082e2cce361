#include "apps/engine/job/film_view.hpp"

#include "apps/engine/job/job_steps.hpp"
#include "halflit/camera.hpp"
#include "raster/scene/framed_part.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace halflit::engine {
namespace {

/// The volume swept by a scene that turns around a vertical axis: discs on top of each other.
class Profile {
public:
    explicit Profile(const Bounds& bounds)
        : center_(to_double(bounds.center())), low_(bounds.min.y), height_(double{bounds.max.y} - double{bounds.min.y}) {}

    void add(Vec3d p) {
        const double x = p.x - center_.x, z = p.z - center_.z, place = height_ > 0.0 ? (p.y - low_) / height_ * kDiscs : 0.0;
        if (!(x * x + z * z < 1e70) || !(place >= -1.0 && place <= kDiscs + 1.0)) return;  // not finite
        double& squared = squared_[static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, kDiscs - 1))];
        squared = std::max(squared, x * x + z * z);
    }

    /// Points around the discs, as a scene that can be framed.
    [[nodiscard]] Scene scene() const {
        Mesh mesh;
        for (int disc = 0; disc < kDiscs; ++disc) {
            const double squared = squared_[static_cast<std::size_t>(disc)];
            if (squared < 0.0) continue;
            // Points of a polygon around the circle.
            const double radius = std::sqrt(squared) / sin_cos(kPi / kAround).cos;
            for (int edge = 0; edge < 2; ++edge)
                for (int i = 0; i < kAround; ++i) {
                    const SinCos turn = sin_cos(2.0 * kPi * i / kAround);
                    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                    mesh.positions.push_back(
                        to_float({center_.x + radius * turn.sin, low_ + height_ * (disc + edge) / kDiscs, center_.z + radius * turn.cos}));
                }
        }
        while (mesh.indices.size() % 3 != 0) mesh.indices.push_back(0);
        Scene out;
        out.meshes.push_back(std::move(mesh));
        out.instances.push_back({});
        return out;
    }

private:
    static constexpr int kDiscs = 64, kAround = 64;
    Vec3d center_;
    double low_, height_;
    std::array<double, kDiscs> squared_ = [] {
        std::array<double, kDiscs> none{};
        none.fill(-1.0);
        return none;
    }();
};

void add_vertices(const Scene& scene, Profile& profile) {
    const raster::FramedPart part = raster::framed_part(scene);
    for (const int i : part.instances) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(i)];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const raster::FramedVertices& framed = part.meshes[static_cast<std::size_t>(instance.mesh)];
        const auto add = [&](Vec3f p) { profile.add(raster::placed_in_double(instance.world_from_object, p)); };
        for (const std::uint32_t v : framed.vertices) add(mesh.positions[v]);
        for (const Vec3f& p : framed.points) add(p);
    }
}

}  // namespace

Result<SceneChanges> pose_job(RenderJob& job, double time_s) {
    Scene& scene = job.scene();
    const PoseRules& rules = job.film.pose;
    auto changes = pose_at(*job.source.motion, rules.animation, time_s, scene);
    if (!changes) return changes;
    if (changes->lights) follow_lights(job);
    changes->lights = changes->lights && job.film.scene_lights;
    if (changes->materials && !rules.own_materials)
        return fail(ErrorCode::usage, "--kd, --ks, --shininess: cannot be combined with an animation that changes materials");
    if (changes->materials && !rules.own_lobes) drop_own_lobes(scene);
    return changes;
}

Result<Bounds> swept_bounds(RenderJob& job) {
    constexpr int kSteps = 32;
    Bounds bounds;
    for (int step = kSteps; step >= 0; --step) {
        const auto posed = pose_job(job, job.animation()->end_s * step / kSteps);
        if (!posed) return tl::unexpected(posed.error());
        bounds.include(raster::framed_bounds(job.scene()));
    }
    return bounds;
}

Camera film_camera(const Scene& scene, const Bounds& bounds, const FilmOptions& film, float aspect, const ViewSettings& view) {
    if (film.turntable == 0) return frame_bounds(bounds, aspect, view);
    Profile profile(bounds);
    if (film.animates()) {
        for (const float x : {bounds.min.x, bounds.max.x})
            for (const float z : {bounds.min.z, bounds.max.z})
                for (const float y : {bounds.min.y, bounds.max.y}) profile.add(to_double(Vec3f{x, y, z}));
    } else {
        add_vertices(scene, profile);
    }
    const Scene discs = profile.scene();
    return frame_scene(discs, aspect, view);
}

Camera turned_camera(const Camera& camera, const Bounds& bounds, std::int64_t frame, int frames_of_turn) {
    const auto part = static_cast<int>(frame % frames_of_turn);
    if (part == 0) return camera;
    const SinCos turn = sin_cos(2.0 * kPi * part / frames_of_turn);
    const auto turned = [&](Vec3d v) { return Vec3d{v.x * turn.cos + v.z * turn.sin, v.y, v.z * turn.cos - v.x * turn.sin}; };
    const Vec3d center = bounds.empty ? Vec3d{} : to_double(bounds.center());
    Camera out = camera;
    for (std::size_t i = 0; i < 4; ++i) {
        Vec4f& column = out.world_from_camera.c[i];
        const Vec3d around = i == 3 ? center : Vec3d{};
        const Vec3f v = to_float(turned(Vec3d{column.x, column.y, column.z} - around) + around);
        column = {v.x, v.y, v.z, column.w};
    }
    return out;
}

}  // namespace halflit::engine
