#include "halflit/fragment_planes.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "raster/view/projection.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

namespace halflit {
namespace {

/// A number of a plane as an index of the list; none: it has no such entry.
template <class T>
const T* entry_of(const std::vector<T>& list, std::uint32_t number) {
    return number > 0 && number <= list.size() ? &list[number - 1] : nullptr;
}

Result<void> check_length(const char* name, std::size_t found, std::size_t expected) {
    if (found == expected) return {};
    return fail(ErrorCode::usage, std::string(name) + ": " + std::to_string(found) + " numbers, expected " + std::to_string(expected));
}

/// Where a point of a triangle, line or point is in the world; none: the scene does not have it.
std::optional<Vec3d> place_of(const Scene& scene, std::uint32_t instance_number, std::uint32_t triangle_number, const float* barycentric) {
    const Instance* const instance = entry_of(scene.instances, instance_number);
    if (instance == nullptr || instance->mesh < 0) return {};
    const Mesh* const mesh = entry_of(scene.meshes, static_cast<std::uint32_t>(instance->mesh) + 1);
    if (mesh == nullptr) return {};
    const std::size_t corners = corners_of(mesh->topology);
    if (triangle_number == 0 || triangle_number > mesh->indices.size() / corners) return {};
    const double weight[3] = {1.0 - double{barycentric[0]} - double{barycentric[1]}, barycentric[0], barycentric[1]};
    Vec3d sum{};
    for (std::size_t k = 0; k < corners; ++k) {
        const std::uint32_t vertex = mesh->indices[corners * (triangle_number - 1) + k];
        if (vertex >= mesh->positions.size()) return {};
        sum = sum + to_double(mesh->positions[vertex]) * weight[k];
    }
    return raster::placed_in_double(instance->world_from_object, sum);
}

/// A point of a picture, pixels from its middle: x to the right, y down.
struct PicturePoint {
    double x, y;
};

/// Where a point of the world is in a picture; none: it is not before the camera.
std::optional<PicturePoint> project(const Mat4& clip_from_world, PictureSize size, Vec3d p) {
    const raster::ClipPlace at = raster::clip_place(clip_from_world, p);
    if (!(at.w > 0.0)) return {};
    return PicturePoint{0.5 * size.width * (at.x / at.w), -0.5 * size.height * (at.y / at.w)};
}

/// Pixels. A larger motion, or one that is not a number, is none.
constexpr double kLargestMotion = 1e38;

}  // namespace

Result<void> make_ray_distances(const Camera& camera, PictureSize size, const Region& region, std::span<float> depth) {
    const FpEnvironment environment_of_host;
    Settings settings;
    settings.region = region;
    if (auto ok = check_settings(settings, size.width, size.height); !ok) return ok;
    const Region part = region.width > 0 ? region : Region{0, 0, size.width, size.height};
    if (auto ok = check_length("depth", depth.size(), static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height)); !ok)
        return ok;
    if (camera.orthographic) return {};
    const raster::ViewRays rays = raster::view_rays(camera, static_cast<float>(size.width) / static_cast<float>(size.height));
    float* d = depth.data();
    for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x, ++d) {
            // The ray is as long as it takes to go 1 along the axis.
            const Vec3d ray =
                rays.middle + rays.right * ((2.0 * x + 1.0) / size.width - 1.0) + rays.up * (1.0 - (2.0 * y + 1.0) / size.height);
            *d = static_cast<float>(double{*d} * length(ray));
        }
    return {};
}

Result<void> make_view_normals(const Camera& camera, std::span<float> normal) {
    const FpEnvironment environment_of_host;
    if (normal.size() % 3 != 0) return check_length("normal", normal.size(), normal.size() / 3 * 3);
    const Mat4& m = camera.world_from_camera;
    for (std::size_t i = 0; i < normal.size(); i += 3) {
        const Vec3d n{normal[i], normal[i + 1], normal[i + 2]};
        for (int k = 0; k < 3; ++k) normal[i + static_cast<std::size_t>(k)] = static_cast<float>(dot(axis(m, k), n));
    }
    return {};
}

DepthRange make_depth_codes(std::span<const float> depth, std::span<std::uint16_t> codes) {
    const auto is_something = [](float d) { return d < 3e38f; };
    DepthRange range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    for (const float d : depth)
        if (is_something(d)) range = {std::min(range.least, double{d}), std::max(range.most, double{d})};
    if (range.least > range.most) range = {};
    const double extent = range.most - range.least, scale = extent > 0.0 ? 65534.0 / extent : 0.0;
    for (std::size_t i = 0; i < depth.size(); ++i)
        codes[i] = is_something(depth[i]) ? static_cast<std::uint16_t>(1.5 + (double{depth[i]} - range.least) * scale) : std::uint16_t{0};
    return range;
}

void make_mesh_numbers(const Scene& scene, std::span<std::uint32_t> instance) {
    for (std::uint32_t& number : instance) {
        const Instance* const of = entry_of(scene.instances, number);
        number = of != nullptr && of->mesh >= 0 ? static_cast<std::uint32_t>(of->mesh) + 1 : 0;
    }
}

void make_material_numbers(const Scene& scene, std::span<std::uint32_t> instance) {
    for (std::uint32_t& number : instance) {
        const Instance* const of = entry_of(scene.instances, number);
        const Material* const material = of != nullptr ? raster::material_of(scene, *of) : nullptr;
        number = material != nullptr ? static_cast<std::uint32_t>(material - scene.materials.data()) + 1 : 0;
    }
}

Result<void> make_motion(const ScenePose& drawn, const ScenePose& other, PictureSize size, const SeenPoints& points,
                         std::span<float> motion) {
    const FpEnvironment environment_of_host;
    if (auto ok = check_settings({}, size.width, size.height); !ok) return ok;
    const std::size_t count = points.instance.size();
    if (auto ok = check_length("triangle", points.triangle.size(), count); !ok) return ok;
    if (auto ok = check_length("barycentric", points.barycentric.size(), 2 * count); !ok) return ok;
    if (auto ok = check_length("motion", motion.size(), 2 * count); !ok) return ok;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const Mat4 from = raster::clip_from_world(drawn.camera, aspect), to = raster::clip_from_world(other.camera, aspect);
    for (std::size_t i = 0; i < count; ++i) {
        motion[2 * i] = motion[2 * i + 1] = 0.0f;
        const float* const weights = points.barycentric.data() + 2 * i;
        const auto here = place_of(drawn.scene, points.instance[i], points.triangle[i], weights);
        const auto there = place_of(other.scene, points.instance[i], points.triangle[i], weights);
        if (!here || !there) continue;
        const auto a = project(from, size, *here), b = project(to, size, *there);
        if (!a || !b) continue;
        const double x = b->x - a->x, y = b->y - a->y;
        if (!(absolute(x) < kLargestMotion && absolute(y) < kLargestMotion)) continue;
        motion[2 * i] = static_cast<float>(x);
        motion[2 * i + 1] = static_cast<float>(y);
    }
    return {};
}

}  // namespace halflit
