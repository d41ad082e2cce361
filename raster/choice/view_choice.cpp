// The view of a scene without a camera, and whether a view shows anything.
//
// The one of a few views that shows most is taken: each is drawn into a small picture of depths, by parallel rays, and judged by the share
// of the scene's surface that it shows, by the share of the picture that this fills, and by the share of the instances. Of many triangles
// the large ones are drawn and some of the others, so the cost does not grow with the scene. The picture's size plays no part.
//
// Whether a view shows anything is judged by the triangles: those outside of it, and those whose back is not drawn, do not count. The
// first one that does ends the search, which is the first triangle or nearly so in all but odd scenes.
#include "halflit/auto_setup.hpp"
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "raster/choice/framed_part.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace halflit {
namespace {

/// True if views look at the instance, and it is not transparent as a whole.
bool is_looked_at(const Scene& scene, const Instance& instance) {
    const Material* const material = raster::material_of(scene, instance);
    const bool is_clear = material != nullptr && material->alpha_mode == AlphaMode::blend && material->base_color.w == 0.0f;
    return raster::counts_for_views(scene, instance) && !is_clear;
}

bool shows_both_sides(const Scene& scene, const Instance& instance) {
    const Material* const material = raster::material_of(scene, instance);
    return material != nullptr && material->double_sided;
}

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

/// A triangle that stands for a share of the scene's surface.
struct SurfaceSample {
    Vec3d corners[3];
    Vec3d normal;  ///< outward, unit
    double area;
    int part;  ///< instance
    bool both_sides;
};

/// Calls f(corners, instance, both_sides) for each triangle of what is framed, as its front is turned.
template <class Fn>
void each_triangle(const Scene& scene, const raster::FramedPart& part, const Fn& f) {
    TimeCheck check;
    for (const int i : part.instances) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(i)];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.topology != Topology::triangles || !is_looked_at(scene, instance)) continue;
        const bool both_sides = shows_both_sides(scene, instance), mirrored = determinant3(instance.world_from_object) < 0.0;
        for (std::size_t k = 0; k + 3 <= mesh.indices.size(); k += 3) {
            check();
            std::array<Vec3d, 3> at;
            for (std::size_t c = 0; c < 3; ++c)
                at[c] = to_double(transform_point(instance.world_from_object, mesh.positions[mesh.indices[k + c]]));
            if (mirrored) std::swap(at[1], at[2]);
            f(at, i, both_sides);
        }
    }
}

/// The large triangles of a scene and some of the others, which stand for all.
std::vector<SurfaceSample> surface_samples(const Scene& scene, const raster::FramedPart& part) {
    constexpr double kLargest = 1024.0, kOthers = 1024.0;
    double total = 0.0, count = 0.0;
    const auto area_vector = [](const std::array<Vec3d, 3>& at) { return cross(at[1] - at[0], at[2] - at[0]) * 0.5; };
    each_triangle(scene, part, [&](const std::array<Vec3d, 3>& at, int, bool) {
        const double area = length(area_vector(at));
        if (area > 0.0 && area < 1e300) total += area, count += 1.0;
    });
    std::vector<SurfaceSample> samples;
    const double large = total / kLargest;
    const auto stride = static_cast<std::size_t>(std::ceil(std::max(1.0, count / kOthers)));
    std::size_t small = 0;
    each_triangle(scene, part, [&](const std::array<Vec3d, 3>& at, int instance, bool both_sides) {
        const Vec3d normal = area_vector(at);
        const double area = length(normal);
        if (!(area > 0.0 && area < 1e300)) return;
        const bool is_large = area >= large;
        if (!is_large && small++ % stride != 0) return;
        samples.push_back(
            {{at[0], at[1], at[2]}, normal * (1.0 / area), area * (is_large ? 1.0 : static_cast<double>(stride)), instance, both_sides});
    });
    return samples;
}

/// Shares that a view shows, each from 0 to 1.
struct ViewWorth {
    double surface;  ///< of the scene's surface, as it is turned to the viewer
    double filled;   ///< of the square picture
    double parts;    ///< of the instances
};

/// A small picture of depths, by parallel rays.
class SmallPicture {
public:
    explicit SmallPicture(const std::vector<SurfaceSample>& samples) : samples_(samples) {
        for (const SurfaceSample& sample : samples) {
            area_ += sample.area;
            if (parts_.empty() || parts_.back() != sample.part) parts_.push_back(sample.part);
        }
    }

    [[nodiscard]] ViewWorth worth(const ViewSettings& view) {
        draw(orbit({}, static_cast<double>(view.azimuth_deg), static_cast<double>(view.elevation_deg), 1.0));
        std::vector<int> seen;
        double covered = 0.0;
        for (const int sample : nearest_) {
            if (sample < 0) continue;
            covered += 1.0;
            seen.push_back(samples_[static_cast<std::size_t>(sample)].part);
        }
        std::sort(seen.begin(), seen.end());
        const auto parts = std::unique(seen.begin(), seen.end()) - seen.begin();
        return {covered / (scale_ * scale_) / area_, covered / (kSide * kSide),
                static_cast<double>(parts) / static_cast<double>(parts_.size())};
    }

private:
    static constexpr int kSide = 32;
    struct Point {
        double x, y, z;
    };

    void draw(const Mat4& world_from_camera) {
        const Vec3d right = axis(world_from_camera, 0), up = axis(world_from_camera, 1), back = axis(world_from_camera, 2);
        points_.clear();
        double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
        for (const SurfaceSample& sample : samples_)
            for (const Vec3d& p : sample.corners) {
                const Point at{dot(p, right), dot(p, up), dot(p, back)};
                low_x = std::min(low_x, at.x), high_x = std::max(high_x, at.x);
                low_y = std::min(low_y, at.y), high_y = std::max(high_y, at.y);
                points_.push_back(at);
            }
        scale_ = kSide / std::max({high_x - low_x, high_y - low_y, 1e-300});
        nearest_.fill(-1);
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            if (!samples_[i].both_sides && !(dot(samples_[i].normal, back) > 0.0)) continue;
            Point* const corner = &points_[3 * i];
            for (int c = 0; c < 3; ++c) corner[c].x = (corner[c].x - low_x) * scale_, corner[c].y = (corner[c].y - low_y) * scale_;
            draw(corner, static_cast<int>(i));
        }
    }
    void draw(const Point* p, int sample) {
        const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x});
        const auto [low_y, high_y] = std::minmax({p[0].y, p[1].y, p[2].y});
        const auto pixel = [](double x) { return std::clamp(static_cast<int>(x), 0, kSide - 1); };
        const double twice_area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
        bool any = false;
        if (twice_area != 0.0)
            for (int y = pixel(low_y); y <= pixel(high_y); ++y)
                for (int x = pixel(low_x); x <= pixel(high_x); ++x) {
                    const double at_x = x + 0.5, at_y = y + 0.5;
                    const auto share = [&](const Point& a, const Point& b) {
                        return ((b.x - a.x) * (at_y - a.y) - (at_x - a.x) * (b.y - a.y)) / twice_area;
                    };
                    const double w0 = share(p[1], p[2]), w1 = share(p[2], p[0]), w2 = share(p[0], p[1]);
                    if (!(w0 >= 0.0 && w1 >= 0.0 && w2 >= 0.0)) continue;
                    any = true;
                    put(x, y, (w0 * p[0].z + w1 * p[1].z) + w2 * p[2].z, sample);
                }
        if (!any)
            put(pixel((p[0].x + p[1].x + p[2].x) / 3.0), pixel((p[0].y + p[1].y + p[2].y) / 3.0), (p[0].z + p[1].z + p[2].z) / 3.0, sample);
    }
    void put(int x, int y, double z, int sample) {
        const auto i = static_cast<std::size_t>(y * kSide + x);
        if (nearest_[i] >= 0 && depth_[i] >= z) return;
        depth_[i] = z, nearest_[i] = sample;
    }

    const std::vector<SurfaceSample>& samples_;
    double area_ = 0.0, scale_ = 1.0;
    std::vector<int> parts_;
    std::vector<Point> points_;
    std::array<double, kSide * kSide> depth_{};
    std::array<int, kSide * kSide> nearest_{};  ///< sample; -1: none
};

/// A view, relative to the usual one. preference: the smaller, the more it has to show to be taken.
struct Candidate {
    float turn_deg, rise_deg;
    double preference;
};
constexpr Candidate kCandidates[] = {{0, 0, 1.0},      // the usual one
                                     {0, 15, 0.77},    // from farther above: what is low
                                     {0, 25, 0.67},    // and what is flat
                                     {-25, -8, 0.85},  // upright and thin: nearly from the front,
                                     {45, -8, 0.7},    // or from the right
                                     {-70, 0, 0.7}};   // from the left

/// Half of the surface of a thin body can be seen at once. What shows nearly that needs no preference.
constexpr double kNearlyAll = 0.42;

/// The candidate that shows most.
ViewSettings telling_view(const Scene& scene, const ViewSettings& view) {
    const std::vector<SurfaceSample> samples = surface_samples(scene, raster::framed_part(scene));
    if (samples.empty()) return view;
    SmallPicture picture(samples);
    // From above, upright lines of what is tall run together.
    constexpr double kTall = 2.0;
    Bounds bounds;
    for (const SurfaceSample& sample : samples)
        for (const Vec3d& corner : sample.corners) bounds.add(to_float(corner));
    const Vec3f side = bounds.max - bounds.min;
    const bool is_tall = side.y > kTall * std::max(side.x, side.z);
    ViewSettings best = view;
    double most = 0.0;
    for (const Candidate& candidate : kCandidates) {
        if (is_tall && candidate.rise_deg > 0.0f) continue;
        ViewSettings other = view;
        other.azimuth_deg += candidate.turn_deg;
        other.elevation_deg += candidate.rise_deg;
        const ViewWorth worth = picture.worth(other);
        const double preference = worth.surface > kNearlyAll ? 1.0 : candidate.preference;
        const double value = preference * worth.surface * worth.filled * (1.0 + worth.parts);
        if (value > most) most = value, best = other;
    }
    return best;
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
        if (is_looked_at(scene, instance) && finder.sees(mesh, instance.world_from_object, shows_both_sides(scene, instance))) return true;
    }
    return false;
}

ViewSettings front_view(const Scene& scene, ViewSettings view) {
    if (is_usual(view)) view.azimuth_deg += front_azimuth_deg(scene);
    return view;
}

FramedView choose_view(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view) {
    const FpEnvironment environment_of_host;
    if (!is_usual(view)) return {view, frame_scene(scene, bounds, aspect, view)};
    constexpr float kBehind = 180.0f, kBelow = -40.0f;
    const ViewSettings most = telling_view(scene, front_view(scene, view));
    const auto turned = [&](float azimuth_deg, float elevation_deg) {
        ViewSettings other = most;
        other.azimuth_deg += azimuth_deg;
        other.elevation_deg = elevation_deg;
        return other;
    };
    std::optional<Camera> usual;
    for (const ViewSettings& side : {most, turned(kBehind, most.elevation_deg), turned(0, kBelow), turned(kBehind, kBelow)}) {
        const Camera camera = frame_scene(scene, bounds, aspect, side);
        if (shows_surface(scene, camera, aspect)) return {side, camera};
        if (!usual) usual = camera;
    }
    return {most, *usual};
}

}  // namespace halflit
