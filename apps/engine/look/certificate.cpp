#include "apps/engine/look/certificate.hpp"

#include "apps/engine/look/triangle_tally.hpp"
#include "apps/io/files/in_parts.hpp"
#include "raster/geometry/welded_surface.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <utility>

namespace halflit::engine {
namespace {

constexpr int kSpread = 100;  ///< directions besides those towards a cube's faces, edges and corners

/// Towards a cube's faces, corners and edges, then spread over the sphere by the golden angle.
std::vector<GivenView> directions_around() {
    std::vector<GivenView> views;
    const auto add = [&](double azimuth, double elevation) {
        views.push_back({fmt::format("{:.1f},{:.1f}", azimuth, elevation), static_cast<float>(azimuth), static_cast<float>(elevation)});
    };
    for (const NamedView& view : kNamedViews)
        if (view.name != "iso") views.push_back({std::string(view.name), view.azimuth_deg, view.elevation_deg, true});
    constexpr double kCorner = 35.26438968;
    for (const double elevation : {kCorner, -kCorner})
        for (const double azimuth : {45.0, 135.0, -135.0, -45.0}) add(azimuth, elevation);
    for (const double elevation : {45.0, -45.0})
        for (const double azimuth : {0.0, 90.0, 180.0, -90.0}) add(azimuth, elevation);
    for (const double azimuth : {45.0, 135.0, -135.0, -45.0}) add(azimuth, 0.0);
    constexpr double kGolden = 137.50776405;
    for (int i = 0; i < kSpread; ++i) {
        const double sine = 1.0 - (2.0 * i + 1.0) / kSpread;  // of the elevation: equal areas
        double low = -90.0, high = 90.0;
        for (int halving = 0; halving < 24; ++halving) {
            const double middle = 0.5 * (low + high);
            (sin_cos(middle * (kPi / 180.0)).sin < sine ? low : high) = middle;
        }
        const double turns = i * kGolden / 360.0;
        add((turns - std::floor(turns)) * 360.0 - 180.0, 0.5 * (low + high));
    }
    return views;
}

/// A triangle in the world.
struct PlacedTriangle {
    Vec3d middle;
    Vec3d area_normal;   ///< its length is the area
    double reach = 0.0;  ///< from the middle to the farthest corner
    bool two_sided = false;
};

class Certifier {
public:
    Certifier(RenderJob& job, Renderer& renderer, std::vector<ViewShot> given, const CertificateLimits& limits)
        : job_(job), renderer_(renderer), limits_(limits), given_(given.size()), numbers_(job.scene()), tally_(numbers_) {
        found_.least = limits.least_pixels;
        place_triangles();
        for (ViewShot& shot : given) {
            const Tally tally = tally_.count(shot);
            keep(std::move(shot), tally);
        }
    }

    Result<Certificate> run() {
        if (const auto looked = look_around(); !looked) return tl::unexpected(looked.error());
        if (const auto chosen = choose_views(); !chosen) return tl::unexpected(chosen.error());
        if (const auto looked = look_closely(); !looked) return tl::unexpected(looked.error());
        for (std::size_t i = 0; i < found_.triangles.size(); ++i) settle(i);
        found_.added = found_.shots.size() - given_;
        for (const Around& around : around_) found_.looked.push_back({around.view.name, around.camera});
        return std::move(found_);
    }

private:
    using Tally = std::vector<SeenTriangle>;
    /// A direction that was looked from.
    struct Around {
        GivenView view;
        Camera camera;
        Vec3d eye, right, up, towards;  ///< towards: the viewer
        double half_width, half_height;
        double pixel_area;         ///< square units of the world
        Tally tally;               ///< of triangles that the view shows with enough pixels; at least those that are wanted
        std::size_t most_new = 0;  ///< upper bound on new_triangles()
        bool used = false;
    };
    /// Data of a thread that draws directions.
    struct Looker {
        explicit Looker(const TriangleNumbers& numbers) : tally(numbers) {}
        Renderer renderer;
        ViewShot shot;
        TriangleTally tally;
    };

    void place_triangles() {
        const Scene& scene = job_.scene();
        found_.first = numbers_.first;
        placed_.reserve(numbers_.count), found_.triangles.reserve(numbers_.count);
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
            const Material* const material = raster::material_of(scene, instance);
            const bool clear = material != nullptr && material->is_layer();
            const bool drawn = raster::counts_for_views(scene, instance) && !clear;
            const double side = determinant3(instance.world_from_object) < 0.0 ? -1.0 : 1.0;
            TimeCheck check;
            for (std::size_t i = 0; i + 2 < mesh.indices.size() && mesh.topology == Topology::triangles; i += 3) {
                check();
                Vec3d p[3];
                for (std::size_t k = 0; k < 3; ++k)
                    p[k] = raster::placed_in_double(instance.world_from_object, mesh.positions[mesh.indices[i + k]]);
                PlacedTriangle one;
                one.middle = (p[0] + p[1] + p[2]) * (1.0 / 3.0);
                one.area_normal = cross(p[1] - p[0], p[2] - p[0]) * (0.5 * side);
                for (const Vec3d& corner : p) one.reach = std::max(one.reach, length(corner - one.middle));
                one.two_sided = material != nullptr && material->double_sided;
                placed_.push_back(one);
                const double area = length(one.area_normal);
                TriangleView& triangle = found_.triangles.emplace_back();
                if (!drawn)
                    triangle.status = TriangleStatus::not_drawn;
                else if (!(area > 1e-12 * one.reach * one.reach))
                    triangle.status = TriangleStatus::no_area;
            }
        }
        most_.resize(found_.triangles.size(), 0);
    }

    /// Takes a picture into the certificate.
    void keep(ViewShot shot, const Tally& tally) {
        const auto view = static_cast<int>(found_.shots.size());
        for (const SeenTriangle& seen : tally) {
            TriangleView& triangle = found_.triangles[seen.triangle];
            if (seen.pixels > triangle.pixels) triangle.pixels = seen.pixels, triangle.view = view;
        }
        found_.shots.push_back(std::move(shot));
    }

    [[nodiscard]] bool is_wanted(std::size_t triangle) const {
        const TriangleView& one = found_.triangles[triangle];
        return one.status == TriangleStatus::unknown && one.pixels < limits_.least_pixels;
    }
    [[nodiscard]] bool is_new(const SeenTriangle& seen) const { return seen.pixels >= limits_.least_pixels && is_wanted(seen.triangle); }
    /// A triangle about which further directions say nothing new: it has been seen with enough pixels, or with as many as it can have.
    [[nodiscard]] bool is_settled(std::size_t triangle) const {
        if (!is_wanted(triangle) || most_[triangle] >= limits_.least_pixels) return true;
        const bool was_seen = most_[triangle] > 0 || found_.triangles[triangle].pixels > 0;
        return was_seen && length(placed_[triangle].area_normal) < limits_.least_pixels * finest_pixel_;
    }

    Result<void> look_around() {
        const float aspect = static_cast<float>(job_.width) / static_cast<float>(job_.height);
        std::vector<std::uint32_t> open;  // triangles that are not settled
        for (std::uint32_t i = 0; i < found_.triangles.size(); ++i)
            if (is_wanted(i)) open.push_back(i);
        if (open.empty()) return {};
        const std::vector<GivenView> views = directions_around();
        std::vector<ViewSettings> sides;
        for (const GivenView& view : views) {
            const float front_deg = view.named ? front_azimuth_deg(job_.scene()) : 0.0f;
            sides.push_back({.azimuth_deg = view.azimuth_deg + front_deg, .elevation_deg = view.elevation_deg, .orthographic = true});
        }
        const std::vector<Camera> cameras = frame_each(job_.scene(), job_.film.bounds, aspect, sides);
        // Frames are small: threads that draw one each wait less than threads that share one.
        constexpr std::size_t kMostLookers = 16, kMostTriangles = std::size_t{1} << 20;
        const int threads = job_.execution.threads;
        const std::size_t lookers =
            numbers_.count <= kMostTriangles ? io::detail::parts_of(std::min(views.size(), kMostLookers), 1, threads) : 1;
        std::deque<Looker> team;  // a Looker stays where it is
        for (std::size_t i = 0; i < lookers; ++i) team.emplace_back(numbers_);
        // Directions that were drawn in vain after the last one that counts are dropped, so that the result is that of one thread.
        const std::size_t batch = lookers > 1 ? 2 * lookers : 1;
        for (std::size_t begin = 0; begin < views.size() && !open.empty(); begin += batch) {
            const std::size_t end = std::min(begin + batch, views.size());
            std::vector<Result<Tally>> tallies(end - begin);
            std::atomic<std::size_t> next{begin};
            io::detail::in_parts(lookers, lookers, [&](std::size_t looker, std::size_t, std::size_t) {
                for (std::size_t v = next++; v < end; v = next++)
                    tallies[v - begin] = looked(team[looker], cameras[v], lookers > 1 ? 1 : threads);
            });
            for (std::size_t v = begin; v < end && !open.empty(); ++v) {
                if (!tallies[v - begin]) return tl::unexpected(tallies[v - begin].error());
                take(views[v], cameras[v], std::move(*tallies[v - begin]));
                std::erase_if(open, [&](std::uint32_t i) { return is_settled(i); });
            }
        }
        return {};
    }

    [[nodiscard]] Result<Tally> looked(Looker& looker, const Camera& camera, int threads) const {
        if (const auto drawn = draw_numbers(job_, looker.renderer, camera, threads, looker.shot); !drawn)
            return tl::unexpected(drawn.error());
        return looker.tally.count(looker.shot);
    }

    /// Takes a direction that was looked from into account.
    void take(const GivenView& view, const Camera& camera, Tally tally) {
        for (const SeenTriangle& seen : tally) most_[seen.triangle] = std::max(most_[seen.triangle], seen.pixels);
        std::erase_if(tally, [&](const SeenTriangle& seen) { return !is_new(seen); });
        const double pixel = pixel_size(camera, job_.width, job_.height, 1.0), half_height = camera.half_height;
        const double aspect = static_cast<float>(job_.width) / static_cast<float>(job_.height);
        const Mat4& m = camera.world_from_camera;
        const std::size_t count = tally.size();
        around_.push_back({view, camera, axis(m, 3), axis(m, 0), axis(m, 1), axis(m, 2), half_height * aspect, half_height, pixel * pixel,
                           std::move(tally), count});
        finest_pixel_ = std::min(finest_pixel_, pixel * pixel);
    }

    /// Draws a view of the whole model again, and keeps it.
    Result<void> add(Around& around) {
        around.used = true;
        auto shot = draw_shot(job_, renderer_, around.view.name, around.camera, limits_.kept);
        if (!shot) return tl::unexpected(shot.error());
        const Tally tally = tally_.count(*shot);
        keep(std::move(*shot), tally);
        return {};
    }

    Result<void> choose_views() {
        while (found_.shots.size() < limits_.most_views) {
            Around* best = nullptr;
            std::size_t most = 0;
            for (Around& around : around_) {
                if (around.used || around.most_new <= most) continue;
                // A triangle that is not new now will not be later.
                std::erase_if(around.tally, [&](const SeenTriangle& seen) { return !is_new(seen); });
                around.most_new = around.tally.size();
                if (around.most_new > most) most = around.most_new, best = &around;
            }
            if (best == nullptr) return {};
            if (const auto added = add(*best); !added) return added;
        }
        return {};
    }

    /// The view shows the triangle whole if nothing hides it. Where a model has a part that is far off, views leave that out.
    [[nodiscard]] static bool is_within(const PlacedTriangle& one, const Around& around) {
        const Vec3d from_eye = one.middle - around.eye;
        const double depth = -dot(from_eye, around.towards);
        return absolute(dot(from_eye, around.right)) + one.reach <= around.half_width &&
               absolute(dot(from_eye, around.up)) + one.reach <= around.half_height && depth - one.reach >= double{around.camera.near_z} &&
               depth + one.reach <= double{around.camera.far_z};
    }
    /// Area of a triangle as seen from a direction; 0: its back is seen, which is not drawn.
    [[nodiscard]] static double seen_area(const PlacedTriangle& one, const Around& around) {
        const double towards = dot(one.area_normal, around.towards);
        return one.two_sided ? absolute(towards) : std::max(towards, 0.0);
    }
    /// Pixels that a triangle would cover if nothing hid it; 0 if the view does not show it whole.
    [[nodiscard]] double expected(std::size_t triangle, const Around& around) const {
        const PlacedTriangle& one = placed_[triangle];
        return is_within(one, around) ? seen_area(one, around) / around.pixel_area : 0.0;
    }

    /// The direction that a triangle faces most.
    [[nodiscard]] const Around& best_direction(std::size_t triangle) const {
        std::size_t best = 0;
        double most = -1.0;
        for (std::size_t i = 0; i < around_.size(); ++i)
            if (const double area = seen_area(placed_[triangle], around_[i]); area > most) most = area, best = i;
        return around_[best];
    }

    /// A view by parallel rays in which the triangle would cover many pixels.
    [[nodiscard]] Camera close_up(std::size_t triangle, const Around& around) const {
        constexpr double kMoreThanLeast = 4.0;
        const PlacedTriangle& one = placed_[triangle];
        Camera camera = around.camera;
        const double area = seen_area(one, around);
        const double pixel = std::sqrt(std::max(area, 1e-300) / (kMoreThanLeast * limits_.least_pixels));
        // Matrices and vertices are float32: they place a point within 2.5e-7 of its coordinates, which must be an eighth of a pixel at
        // most.
        const Bounds& bounds = job_.film.bounds;
        double farthest = 0.0;
        for (const Vec3d& p : {to_double(bounds.min), to_double(bounds.max)})
            farthest = std::max({farthest, absolute(p.x), absolute(p.y), absolute(p.z)});
        const double least = 0.5 * job_.height * 2e-6 * farthest;
        camera.half_height = static_cast<float>(std::min(std::max(0.5 * job_.height * pixel, least), double{camera.half_height}));
        // The planes enclose the whole model, so that all that hides the triangle is drawn.
        double front = -1e300, back = 1e300;  // along the view, towards the viewer, from the triangle's middle
        for (int k = 0; k < 8; ++k) {
            const Vec3d corner{k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y,
                               k & 4 ? bounds.max.z : bounds.min.z};
            const double along = dot(corner - one.middle, around.towards);
            front = std::max(front, along), back = std::min(back, along);
        }
        const double room = 0.1 * (front - back);
        const Vec3f eye = to_float(one.middle + around.towards * (front + room));
        camera.world_from_camera.c[3] = {eye.x, eye.y, eye.z, 1.0f};
        camera.near_z = 0.0f;
        camera.far_z = static_cast<float>((front - back) + 2.0 * room);
        return camera;
    }

    /// Close-ups of triangles that were too small, and of those that are hidden from all directions as far as pixels could tell.
    Result<void> look_closely() {
        constexpr std::size_t kMostTries = 256;
        std::vector<std::uint32_t> left;
        for (std::uint32_t i = 0; i < found_.triangles.size(); ++i)
            if (is_wanted(i) && !is_hidden(i)) left.push_back(i);
        std::size_t tries = 0;
        for (const std::uint32_t triangle : left) {
            if (!is_wanted(triangle)) continue;  // another close-up shows it
            if (found_.shots.size() >= limits_.most_views || tries++ >= kMostTries || around_.empty()) return {};
            const Around& around = best_direction(triangle);
            const Camera camera = close_up(triangle, around);
            const std::string name = fmt::format("detail {}", found_.shots.size() + 1);
            auto shot = draw_shot(job_, renderer_, name, camera, {.picture = false});
            if (!shot) return tl::unexpected(shot.error());
            const Tally tally = tally_.count(*shot);
            if (std::none_of(tally.begin(), tally.end(), [&](const SeenTriangle& seen) { return is_new(seen); })) continue;
            if (limits_.kept.picture) shot = draw_shot(job_, renderer_, name, camera, limits_.kept);
            if (!shot) return tl::unexpected(shot.error());
            shot->detail = true;
            keep(std::move(*shot), tally);
        }
        return {};
    }

    /// No pixel showed it from any direction, of which some would have shown enough of it.
    [[nodiscard]] bool is_hidden(std::size_t triangle) const { return most_[triangle] == 0 && directions_of(triangle) > 0; }
    [[nodiscard]] int directions_of(std::size_t triangle) const {
        int directions = 0;
        for (const Around& around : around_) directions += expected(triangle, around) >= limits_.least_pixels ? 1 : 0;
        return directions;
    }

    void settle(std::size_t i) {
        TriangleView& triangle = found_.triangles[i];
        if (triangle.status != TriangleStatus::unknown) return;
        if (triangle.pixels >= limits_.least_pixels)
            triangle.status = TriangleStatus::seen;
        else if (triangle.pixels > 0)
            triangle.status = TriangleStatus::less;
        else if (is_hidden(i))
            triangle.status = TriangleStatus::hidden, triangle.directions = directions_of(i);
    }

    RenderJob& job_;
    Renderer& renderer_;
    CertificateLimits limits_;
    std::size_t given_;
    TriangleNumbers numbers_;
    TriangleTally tally_;
    Certificate found_;
    std::vector<PlacedTriangle> placed_;
    std::vector<Around> around_;
    std::vector<std::int32_t> most_;  ///< pixels that show each triangle in the best of the directions
    double finest_pixel_ = 1e300;     ///< least area of a pixel in a direction
};

}  // namespace

std::size_t Certificate::count(TriangleStatus status, std::span<const int> instances) const {
    const auto has = [&](const TriangleView& triangle) { return triangle.status == status; };
    if (instances.empty()) return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), has));
    std::size_t sum = 0;
    for (const int i : instances) {
        const auto instance = static_cast<std::size_t>(i);
        const auto begin = triangles.begin() + static_cast<std::ptrdiff_t>(first[instance]);
        const auto end =
            instance + 1 < first.size() ? triangles.begin() + static_cast<std::ptrdiff_t>(first[instance + 1]) : triangles.end();
        sum += static_cast<std::size_t>(std::count_if(begin, end, has));
    }
    return sum;
}

Result<Certificate> certify(RenderJob& job, Renderer& renderer, std::vector<ViewShot> given, const CertificateLimits& limits) {
    constexpr std::uint64_t kMostTriangles = 1u << 24;  // a record of each, over all instances
    if (job.prepared->triangle_count() > kMostTriangles)
        return fail(ErrorCode::limit, fmt::format("--certify: expected at most {} triangles over all instances, found {}", kMostTriangles,
                                                  job.prepared->triangle_count()));
    return Certifier(job, renderer, std::move(given), limits).run();
}

}  // namespace halflit::engine
