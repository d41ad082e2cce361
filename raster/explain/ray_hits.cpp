#include "raster/explain/ray_hits.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"
#include "shading/reference/reference.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

/// Corner k of a triangle: its index into the vertices.
std::uint32_t corner(const Mesh& mesh, std::size_t triangle, std::size_t k) { return mesh.indices[3 * triangle + k]; }

/// Alpha of the base colour where it counts, else 1.
double alpha_at(const Scene& scene, const Mesh& mesh, const Material& material, std::size_t triangle, const std::array<double, 3>& b) {
    if (material.alpha_mode == AlphaMode::opaque || material.shadow_catcher) return 1.0;
    double alpha = double{material.base_color.w};
    if (!mesh.colors.empty()) {
        double of_vertices = 0.0;
        for (std::size_t k = 0; k < 3; ++k) of_vertices += b[k] * double{mesh.colors[corner(mesh, triangle, k)].w};
        alpha *= of_vertices;
    }
    if (const auto texture = texture_at(scene, mesh, material, TextureSlot::base_color, triangle, b)) alpha *= texture->full_size[3];
    return clamped(alpha, 0.0, 1.0);
}

class RayCast {
public:
    RayCast(const PreparedData& scene, const Ray& ray, RaySees sees, std::size_t count, std::optional<TriangleOfInstance> without)
        : scene_(scene), ray_(ray), sees_(sees), count_(count), without_(without), most_(ray.most) {
        const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z}, o[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
        for (int axis = 0; axis < 3; ++axis) origin_[axis] = o[axis], inverse_[axis] = d[axis] == 0.0 ? 0.0 : 1.0 / d[axis];
    }

    std::vector<SurfaceOnRay> hits() {
        const auto bounds = scene_.instance_bounds();
        for (std::size_t i = 0; i < bounds.size(); ++i) {
            check_();
            if (bounds[i].empty || !meets(bounds[i])) continue;
            const Material& material = scene_.material(scene_.material_of(i));
            if (sees_ == RaySees::layers && !material.is_layer()) continue;
            if (sees_ == RaySees::casters && material.is_layer()) continue;
            if (scene_.scene().meshes[static_cast<std::size_t>(scene_.scene().instances[i].mesh)].topology != Topology::triangles) continue;
            look_into(i, material);
        }
        return std::move(hits_);
    }

private:
    /// True if the part of the ray that is still looked at may meet the box, whose sides may be larger by rounding.
    [[nodiscard]] bool meets(const double (&low)[3], const double (&high)[3]) const {
        double first = ray_.least, last = most_;
        for (int axis = 0; axis < 3; ++axis) {
            if (inverse_[axis] == 0.0) {
                if (origin_[axis] < low[axis] || origin_[axis] > high[axis]) return false;
                continue;
            }
            const double a = (low[axis] - origin_[axis]) * inverse_[axis], b = (high[axis] - origin_[axis]) * inverse_[axis];
            const double slack = 1e-12 * larger(magnitude(a), magnitude(b));
            first = larger(first, (a < b ? a : b) - slack);
            last = (a < b ? b : a) + slack < last ? (a < b ? b : a) + slack : last;
        }
        return first <= last;
    }
    [[nodiscard]] bool meets(const Bounds& box) const {
        return meets({box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z});
    }

    void look_into(std::size_t index, const Material& material) {
        const Instance& instance = scene_.scene().instances[index];
        const PreparedMesh& prepared = scene_.mesh(instance.mesh);
        const Mesh& mesh = scene_.source_mesh(instance.mesh);
        const Mat4& m = instance.world_from_object;
        mirrored_ = determinant3(m) < 0.0;
        for (std::size_t s = 0; s < prepared.superclusters.size(); ++s) {
            const Bounds& b = prepared.superclusters[s];
            if (b.empty) continue;
            const PlacedBox outer({b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}, m);
            if (!meets(outer.low, outer.high)) continue;
            const std::size_t end = std::min((s + 1) * kSuperclusterSize, prepared.cluster_count());
            for (std::size_t c = s * kSuperclusterSize; c < end; ++c) {
                check_();
                const Cluster& cluster = prepared.clusters[c];
                if (cluster.min[0] > cluster.max[0]) continue;
                const PlacedBox box(cluster.min, cluster.max, m);
                if (!meets(box.low, box.high)) continue;
                const IndexRange range = triangles_of_cluster(mesh, c);
                for (std::size_t t = range.begin; t < range.end; ++t) try_triangle(index, mesh, material, m, t);
            }
        }
    }

    /// The ray meets the triangle if it passes its three edges on one side. An edge gives its two triangles the same number with opposite
    /// signs, so that no ray slips between them.
    void try_triangle(std::size_t index, const Mesh& mesh, const Material& material, const Mat4& m, std::size_t t) {
        if (without_ && without_->instance == index && without_->triangle == t) return;
        Vec3d p[3];
        for (std::size_t k = 0; k < 3; ++k) p[k] = to_double(transform_point(m, mesh.positions[corner(mesh, t, k)])) - ray_.origin;
        const double w[3] = {dot(ray_.direction, cross(p[1], p[2])), dot(ray_.direction, cross(p[2], p[0])),
                             dot(ray_.direction, cross(p[0], p[1]))};
        const bool along = w[0] >= 0.0 && w[1] >= 0.0 && w[2] >= 0.0, against = w[0] <= 0.0 && w[1] <= 0.0 && w[2] <= 0.0;
        const double sum = (w[0] + w[1]) + w[2];
        if ((!along && !against) || sum == 0.0) return;
        const bool faces_end = (sum > 0.0) != mirrored_, back = (sees_ == RaySees::casters) != faces_end;
        if (back && !material.double_sided) return;
        SurfaceOnRay hit;
        hit.barycentrics = {w[0] / sum, w[1] / sum, w[2] / sum};
        const Vec3d at = (p[0] * hit.barycentrics[0] + p[1] * hit.barycentrics[1]) + p[2] * hit.barycentrics[2];
        hit.distance = dot(at, ray_.direction);
        if (!(hit.distance > ray_.least && hit.distance < most_)) return;
        hit.alpha = alpha_at(scene_.scene(), mesh, material, t, hit.barycentrics);
        if (material.alpha_mode == AlphaMode::mask && hit.alpha < double{material.alpha_cutoff}) return;
        hit.instance = index, hit.triangle = t;
        hit.mesh = static_cast<std::size_t>(scene_.scene().instances[index].mesh);
        hit.position = ray_.origin + at;
        hit.back = back, hit.layer = material.is_layer();
        keep(hit);
    }

    void keep(const SurfaceOnRay& hit) {
        const auto same = [&](const SurfaceOnRay& other) {  // the neighbour across an edge
            return other.instance == hit.instance && absolute(other.distance - hit.distance) <= 1e-9 * hit.distance;
        };
        if (std::any_of(hits_.begin(), hits_.end(), same)) return;
        const auto nearer = [](const SurfaceOnRay& a, const SurfaceOnRay& b) { return a.distance < b.distance; };
        hits_.insert(std::upper_bound(hits_.begin(), hits_.end(), hit, nearer), hit);
        if (hits_.size() > count_) hits_.pop_back();
        if (hits_.size() == count_) most_ = hits_.back().distance;
    }

    const PreparedData& scene_;
    const Ray ray_;
    const RaySees sees_;
    const std::size_t count_;
    const std::optional<TriangleOfInstance> without_;
    double origin_[3], inverse_[3];  ///< inverse: of the direction; 0 where the ray is parallel to an axis's planes
    double most_;                    ///< farther hits are not kept
    bool mirrored_ = false;          ///< the instance's transform mirrors
    TimeCheck check_;
    std::vector<SurfaceOnRay> hits_;
};

float aspect_of(PictureSize size) { return static_cast<float>(size.width) / static_cast<float>(size.height); }

/// The part of the ray between the camera's planes, with a direction of unit length.
Ray cut_to_view(const Camera& camera, PictureSize size, Vec3d origin, Vec3d direction) {
    direction = direction * (1.0 / length(direction));
    const double slope = -dot(direction, axis(camera.world_from_camera, 2));  // depth for each unit along the ray
    const DepthMap depth = depth_map(camera, aspect_of(size));
    return {origin, direction, depth.distance(1.0) / slope, depth.distance(0.0) / slope};
}

}  // namespace

Ray ray_of_pixel(const Camera& camera, PictureSize size, int px, int py) {
    const Mat4& m = camera.world_from_camera;
    const double x = (2.0 * px + 1.0) / size.width - 1.0, y = 1.0 - (2.0 * py + 1.0) / size.height;
    const ViewRays rays = view_rays(camera, aspect_of(size));
    Vec3d origin = axis(m, 3);
    if (camera.orthographic) {
        // The eye's place in the picture, and how far a unit to the right and up moves there, from the matrix.
        const Mat4 clip = clip_from_world(camera, aspect_of(size));
        const Vec3d row_x{clip.c[0].x, clip.c[1].x, clip.c[2].x}, row_y{clip.c[0].y, clip.c[1].y, clip.c[2].y};
        const Vec3d eye = origin;
        const double step_x = dot(row_x, axis(m, 0)), step_y = dot(row_y, axis(m, 1));
        if (step_x != 0.0) origin = origin + axis(m, 0) * ((x - (dot(row_x, eye) + double{clip.c[3].x})) / step_x);
        if (step_y != 0.0) origin = origin + axis(m, 1) * ((y - (dot(row_y, eye) + double{clip.c[3].y})) / step_y);
    }
    return cut_to_view(camera, size, origin, (rays.middle + rays.right * x) + rays.up * y);
}

Ray ray_to(const Camera& camera, PictureSize size, Vec3d point) {
    const Vec3d eye = axis(camera.world_from_camera, 3), ahead = axis(camera.world_from_camera, 2) * -1.0;
    if (camera.orthographic) return cut_to_view(camera, size, point - ahead * dot(point - eye, ahead), ahead);
    return cut_to_view(camera, size, eye, point - eye);
}

std::vector<SurfaceOnRay> hits_along(const PreparedData& scene, const Ray& ray, RaySees sees, std::size_t count,
                                     std::optional<TriangleOfInstance> without) {
    if (count == 0) return {};
    std::vector<SurfaceOnRay> hits = RayCast(scene, ray, sees, count, without).hits();
    for (SurfaceOnRay& hit : hits) {
        hit.mesh_name = scene.scene().meshes[hit.mesh].name;
        hit.material_name = scene.material(scene.material_of(hit.instance)).name;
    }
    return hits;
}

Vec2<double> uv_at(const Mesh& mesh, int set, std::size_t triangle, const std::array<double, 3>& barycentrics) {
    const std::vector<Vec2f>& uv = set == 1 ? mesh.uv1 : mesh.uv0;
    Vec2<double> sum{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2f at = uv[corner(mesh, triangle, k)];
        sum = sum + Vec2<double>{at.x, at.y} * barycentrics[k];
    }
    return sum;
}

std::optional<TextureAt> texture_at(const Scene& scene, const Mesh& mesh, const Material& material, TextureSlot slot, std::size_t triangle,
                                    const std::array<double, 3>& barycentrics) {
    const TextureUse& use = material.textures[slot];
    if (!use.used() || static_cast<std::size_t>(use.texture) >= scene.textures.size()) return {};
    const Texture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    if (texture.levels().empty() || (use.uv_set == 1 ? mesh.uv1 : mesh.uv0).empty()) return {};
    const Vec2<double> uv = uv_at(mesh, use.uv_set, triangle, barycentrics);
    TextureAt at{slot, use.texture, use.uv_set};
    at.u = (double{use.row_u.x} * uv.x + double{use.row_u.y} * uv.y) + double{use.row_u.z};
    at.v = (double{use.row_v.x} * uv.x + double{use.row_v.y} * uv.y) + double{use.row_v.z};
    const shading::reference::Rgba texel = shading::reference::sample(texture, use.sampler, at.u, at.v, 0.0);
    at.full_size = {texel.r, texel.g, texel.b, texel.a};
    return at;
}

}  // namespace halflit::raster
