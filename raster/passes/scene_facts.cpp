#include "raster/passes/scene_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace halflit::raster {
namespace {

struct Triangle {
    Vec3d a, b, c;
};

/// A run of triangles of one draw, and the box around it.
struct Cluster {
    double low[3], high[3];
    std::size_t first, end;
};
constexpr std::size_t kClusterSize = 32;

double squared(Vec3d v) { return dot(v, v); }

/// Squared distance from the origin to the segment from a to b.
double segment_distance(Vec3d a, Vec3d b) {
    const Vec3d along = b - a;
    const double length = squared(along);
    const double t = length > 0.0 ? std::clamp(-dot(a, along) / length, 0.0, 1.0) : 0.0;
    return squared(a + along * t);
}

/// Squared distance from `p` to the triangle: to its plane where the foot lies inside, otherwise to an edge.
double distance(const Triangle& t, Vec3d p) {
    const Vec3d a = t.a - p, b = t.b - p, c = t.c - p;
    const Vec3d normal = cross(b - a, c - a);
    const double area = squared(normal);
    if (area > 0.0) {
        const double sides[3] = {dot(cross(b - a, Vec3d{} - a), normal), dot(cross(c - b, Vec3d{} - b), normal),
                                 dot(cross(a - c, Vec3d{} - c), normal)};
        if (sides[0] >= 0.0 && sides[1] >= 0.0 && sides[2] >= 0.0) {
            const double height = dot(a, normal);
            return height * height / area;
        }
    }
    return std::min({segment_distance(a, b), segment_distance(b, c), segment_distance(c, a)});
}

double box_distance(const Cluster& cluster, Vec3d p) {
    const double at[3] = {p.x, p.y, p.z};
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = at[axis] < cluster.low[axis] ? cluster.low[axis] - at[axis]
                                                      : at[axis] > cluster.high[axis] ? at[axis] - cluster.high[axis] : 0.0;
        sum += d * d;
    }
    return sum;
}

class Surfaces {
public:
    explicit Surfaces(const Frame& frame) {
        for (const Draw& draw : frame.draws) {
            const Mesh& mesh = *draw.mesh;
            const auto vertex = [&](std::uint32_t index) {
                const Vec3f p = mesh.positions[index];
                const Vec4f* c = draw.world_from_object.c;
                return Vec3d{double{c[0].x} * p.x + double{c[1].x} * p.y + double{c[2].x} * p.z + double{c[3].x},
                             double{c[0].y} * p.x + double{c[1].y} * p.y + double{c[2].y} * p.z + double{c[3].y},
                             double{c[0].z} * p.x + double{c[1].z} * p.y + double{c[2].z} * p.z + double{c[3].z}};
            };
            for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                if (i % (3 * kClusterSize) == 0) open();
                add({vertex(mesh.indices[i]), vertex(mesh.indices[i + 1]), vertex(mesh.indices[i + 2])});
            }
        }
    }

    [[nodiscard]] double nearest_squared(Vec3d p) const {
        double nearest = std::numeric_limits<double>::max(), nearest_box = nearest;
        const auto look_into = [&](const Cluster& cluster) {
            for (std::size_t i = cluster.first; i < cluster.end; ++i) nearest = std::min(nearest, distance(triangles_[i], p));
        };
        // The nearest box first: what is found in it rules most of the others out.
        const Cluster* first = nullptr;
        for (const Cluster& cluster : clusters_) {
            const double d = box_distance(cluster, p);
            if (first != nullptr && d >= nearest_box) continue;
            nearest_box = d;
            first = &cluster;
        }
        if (first != nullptr) look_into(*first);
        for (const Cluster& cluster : clusters_)
            if (&cluster != first && box_distance(cluster, p) < nearest) look_into(cluster);
        return nearest;
    }

    [[nodiscard]] double farthest_squared(Vec3d p) const {
        double farthest = 0.0;
        for (const Cluster& cluster : clusters_) {
            const double at[3] = {p.x, p.y, p.z};
            double sum = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                const double d = std::max(at[axis] - cluster.low[axis], cluster.high[axis] - at[axis]);
                sum += d * d;
            }
            farthest = std::max(farthest, sum);
        }
        return farthest;
    }

private:
    void open() {
        constexpr double kMost = std::numeric_limits<double>::max();
        clusters_.push_back({{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}, triangles_.size(), triangles_.size()});
    }
    void add(const Triangle& triangle) {
        Cluster& cluster = clusters_.back();
        for (const Vec3d v : {triangle.a, triangle.b, triangle.c}) {
            const double at[3] = {v.x, v.y, v.z};
            for (int axis = 0; axis < 3; ++axis) {
                cluster.low[axis] = std::min(cluster.low[axis], at[axis]);
                cluster.high[axis] = std::max(cluster.high[axis], at[axis]);
            }
        }
        triangles_.push_back(triangle);
        cluster.end = triangles_.size();
    }

    std::vector<Triangle> triangles_;
    std::vector<Cluster> clusters_;
};

bool transforms_textures(const shading::MaterialPlan& material) {
    return material.base_color_texture.transform || material.metallic_roughness_texture.transform || material.normal_texture.transform ||
           material.occlusion_texture.transform || material.emissive_texture.transform;
}

}  // namespace

shading::SceneFacts scene_facts(const Frame& frame) {
    shading::SceneFacts facts;
    facts.drawn.assign(frame.plan.materials.size(), false);
    for (const Draw& draw : frame.draws) {
        facts.drawn[static_cast<std::size_t>(draw.material)] = true;
        if (transforms_textures(frame.plan.materials[static_cast<std::size_t>(draw.material)]))
            for (const std::vector<Vec2f>* set : {&draw.mesh->uv0, &draw.mesh->uv1})
                for (const Vec2f uv : *set)
                    facts.largest_uv = std::max({facts.largest_uv, std::fabs(static_cast<double>(uv.x)), std::fabs(static_cast<double>(uv.y))});
        for (const Vec4f& c : draw.mesh->colors)
            facts.vertex_color = std::max({facts.vertex_color, static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)});
    }
    const auto local = [](const shading::LightPlan& light) { return light.type != shading::LightType::directional; };
    const bool any_local = std::any_of(frame.plan.lights.begin(), frame.plan.lights.end(), local);
    if (!any_local) {
        facts.light_attenuation.assign(frame.plan.lights.size(), 1.0);
        facts.light_farthest_squared.assign(frame.plan.lights.size(), 0.0);
        return facts;
    }
    const Surfaces surfaces(frame);
    for (const shading::LightPlan& light : frame.plan.lights) {
        if (!local(light)) {
            facts.light_attenuation.push_back(1.0);
            facts.light_farthest_squared.push_back(0.0);
            continue;
        }
        // A little nearer than found: positions are rounded to float on their way to the screen.
        const Vec3d position{light.position[0], light.position[1], light.position[2]};
        const double nearest = surfaces.nearest_squared(position) * 0.999;
        facts.light_attenuation.push_back(1.0 / std::max(nearest, static_cast<double>(light.min_distance_squared)));
        facts.light_farthest_squared.push_back(surfaces.farthest_squared(position) * 1.001);
    }
    return facts;
}

}  // namespace halflit::raster
