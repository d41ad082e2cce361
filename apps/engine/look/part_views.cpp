#include "apps/engine/look/part_views.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <map>

namespace halflit::engine {
namespace {

/// Makes instances invisible while parts are drawn alone; what they were comes back at the end.
class AloneScene {
public:
    explicit AloneScene(RenderJob& job) : job_(job) {
        for (const Instance& instance : job.scene().instances) visible_.push_back(instance.visible);
        changes_.changed_instances.reserve(visible_.size());  // so that the end needs no memory
    }
    ~AloneScene() {
        (void)show([](std::size_t) { return true; });
    }
    AloneScene(const AloneScene&) = delete;
    AloneScene& operator=(const AloneScene&) = delete;

    /// Shows instances that were visible and that `wanted` says true of.
    template <class Wanted>
    Result<void> show(const Wanted& wanted) {
        changes_.changed_instances.clear();
        for (std::size_t i = 0; i < visible_.size(); ++i) {
            Instance& instance = job_.scene().instances[i];
            const bool visible = visible_[i] && wanted(i);
            if (visible != instance.visible) instance.visible = visible, changes_.changed_instances.push_back(i);
        }
        if (changes_.changed_instances.empty()) return {};
        return job_.prepared->update(changes_, job_.timed_execution());
    }
    Result<void> show_part(int part) {
        return show([&](std::size_t i) { return job_.source.parts->of_instance(i) == part; });
    }

private:
    RenderJob& job_;
    std::vector<bool> visible_;
    SceneChanges changes_;
};

ViewContent content_of(const RenderJob& job, const ViewShot& shot) {
    ViewContent content;
    const Parts& parts = *job.source.parts;
    content.parts.resize(parts.list().size());
    for (std::size_t i = 0; i < content.parts.size(); ++i) content.parts[i].part = static_cast<int>(i);
    const Scene& scene = job.scene();
    for (int y = 0; y < shot.height(); ++y) {
        const std::uint32_t* const row = shot.instance.data() + static_cast<std::ptrdiff_t>(y) * shot.width();
        for (int x = 0, end = 0; x < shot.width(); x = end) {
            const std::uint32_t instance = row[x];
            for (end = x + 1; end < shot.width() && row[end] == instance;) ++end;
            if (instance == 0 || raster::catches_shadows(scene, scene.instances[instance - 1])) continue;
            content.pixels += end - x;
            content.box.add(x, y), content.box.add(end - 1, y);
            const int part = parts.of_instance(instance - 1);
            if (part < 0) continue;
            PartInView& seen = content.parts[static_cast<std::size_t>(part)];
            seen.pixels += end - x;
            seen.box.add(x, y), seen.box.add(end - 1, y);
        }
    }
    return content;
}

constexpr float kRounding = 1e-5f;  // of a vertex in clip space, relative

/// True if a box around the mesh lies within the view, by more than rounding: then so do its vertices.
bool is_box_within(const Mesh& mesh, const Mat4& clip_from_object) {
    if (mesh.positions.empty()) return true;
    Vec3f low = mesh.positions[0], high = low;
    for (const Vec3f& p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    for (unsigned i = 0; i < 8; ++i) {
        const Vec4f c =
            clip_from_object * Vec4f{(i & 1) != 0 ? low.x : high.x, (i & 2) != 0 ? low.y : high.y, (i & 4) != 0 ? low.z : high.z, 1.0f};
        const float side = c.w * (1.0f - kRounding);
        // A comparison with NaN is false.
        if (!(c.w > 0.0f && c.z <= side && c.z >= kRounding * c.w && c.x <= side && c.x >= -side && c.y <= side && c.y >= -side))
            return false;
    }
    return true;
}

/// Looks at the model's vertices: beside the picture, or outside of the camera's depths.
void judge_vertices(const RenderJob& job, const ViewShot& shot, ViewFaults& faults) {
    const Mat4 clip_from_world = raster::clip_from_world(shot.camera, static_cast<float>(shot.width()) / static_cast<float>(shot.height()));
    const Scene& scene = job.scene();
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        check();
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mat4 m = clip_from_world * instance.world_from_object;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (is_box_within(mesh, m)) continue;
        for (const std::uint32_t index : mesh.indices) {
            check();
            const Vec3f& p = mesh.positions[index];
            // Written out: a call for each vertex would take most of the time.
            const auto row = [&](float Vec4f::*r) { return ((m.c[0].*r * p.x + m.c[1].*r * p.y) + m.c[2].*r * p.z) + m.c[3].*r; };
            const float x = row(&Vec4f::x), y = row(&Vec4f::y), z = row(&Vec4f::z), w = row(&Vec4f::w);
            const float side = w * (1.0f + kRounding);
            if (w <= 0.0f || z > side || z < -kRounding * w)
                faults.cut = true;
            else
                faults.cropped |= x > side || x < -side || y > side || y < -side;
        }
    }
}

/// Every triangle is seen along its plane, within the rounding of its corners.
bool is_edge_on(const RenderJob& job, const ViewShot& shot) {
    constexpr double kEdgeOn = 1e-5;  // sine of the angle between the triangle and the ray from the viewer
    const Vec3d eye = axis(shot.camera.world_from_camera, 3), back = axis(shot.camera.world_from_camera, 2);
    const Scene& scene = job.scene();
    bool some = false;
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.topology != Topology::triangles) continue;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            check();
            const auto corner = [&](std::size_t k) {
                return raster::placed_in_double(instance.world_from_object, mesh.positions[mesh.indices[i + k]]);
            };
            const Vec3d a = corner(0), n = cross(corner(1) - a, corner(2) - a), ray = shot.camera.orthographic ? back : eye - a;
            const double along = dot(n, ray);
            if (!(along * along <= kEdgeOn * kEdgeOn * (dot(n, n) * dot(ray, ray)))) return false;
            some = some || dot(n, n) > 0.0;
        }
    }
    return some;
}

void judge(const RenderJob& job, const ViewShot& shot, ViewContent& content) {
    ViewFaults& faults = content.faults;
    content.edge_on = content.pixels == 0 && is_edge_on(job, shot);
    faults.blank = content.pixels == 0 && !content.edge_on;
    if (shot.detail) return;
    constexpr int kLeastSpan = 6;
    const PixelBox& box = content.box;
    faults.tiny = content.pixels > 0 && kLeastSpan * (box.x1 - box.x0) < shot.width() && kLeastSpan * (box.y1 - box.y0) < shot.height();
    const Bounds& bounds = job.film.bounds;
    const Vec4f& eye = shot.camera.world_from_camera.c[3];
    faults.inside = !bounds.empty && !shot.camera.orthographic && eye.x > bounds.min.x && eye.x < bounds.max.x && eye.y > bounds.min.y &&
                    eye.y < bounds.max.y && eye.z > bounds.min.z && eye.z < bounds.max.z;
    judge_vertices(job, shot, faults);
}

/// Counts what a part shows alone, and what hides it in the shot.
void count_alone(const RenderJob& job, const ViewShot& all, const ViewShot& alone, PartInView& part) {
    std::map<int, std::int64_t> hiding;
    std::int64_t pixels = 0;
    int last = -2;
    std::int64_t* count = nullptr;
    for (std::size_t i = 0; i < alone.instance.size(); ++i) {
        if (alone.instance[i] == 0) continue;
        ++pixels;
        const int shown = all.instance[i] == 0 ? -1 : job.source.parts->of_instance(all.instance[i] - 1);
        if (shown == part.part) continue;
        if (shown != last) count = &hiding[shown], last = shown;
        ++*count;
    }
    part.alone = pixels;
    for (const auto& [by, hidden] : hiding)
        if (by >= 0 && hidden > part.hidden_pixels) part.hidden_by = by, part.hidden_pixels = hidden;
}

}  // namespace

void PixelBox::add(int x, int y) {
    if (empty()) *this = {x, y, x + 1, y + 1};
    x0 = std::min(x0, x), x1 = std::max(x1, x + 1), y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
}

std::vector<std::string> ViewFaults::names() const {
    std::vector<std::string> names;
    const std::pair<bool, const char*> all[] = {{blank, "blank"}, {cropped, "cropped"}, {cut, "cut"}, {inside, "inside"}, {tiny, "tiny"}};
    for (const auto& one : all)
        if (one.first) names.emplace_back(one.second);
    return names;
}

Result<std::vector<ViewContent>> count_parts(RenderJob& job, Renderer& renderer, std::span<const ViewShot> shots, std::size_t most_alone) {
    std::vector<ViewContent> contents;
    for (const ViewShot& shot : shots) {
        contents.push_back(content_of(job, shot));
        judge(job, shot, contents.back());
    }
    const std::size_t parts = job.source.parts->list().size();
    if (parts < 2 || parts > most_alone) {
        if (parts == 1)
            for (ViewContent& content : contents) content.parts[0].alone = content.parts[0].pixels;
        return contents;
    }
    AloneScene scene(job);
    for (std::size_t part = 0; part < parts; ++part) {
        if (const auto shown = scene.show_part(static_cast<int>(part)); !shown) return tl::unexpected(shown.error());
        for (std::size_t i = 0; i < shots.size(); ++i) {
            const auto alone = draw_shot(job, renderer, shots[i].name, shots[i].camera, {.picture = false});
            if (!alone) return tl::unexpected(alone.error());
            count_alone(job, shots[i], *alone, contents[i].parts[part]);
        }
    }
    return contents;
}

}  // namespace halflit::engine
