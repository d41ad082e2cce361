// An independent computation of a scene's edges and of what hides them: every edge against every triangle, by rays in double.
#pragma once

#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "sh/vec3d.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace halflit::raster::test {

struct Point2 {
    double x, y;
};
struct Segment2 {
    Point2 a, b;
    [[nodiscard]] Point2 at(double t) const { return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; }
    [[nodiscard]] double length() const { return std::hypot(b.x - a.x, b.y - a.y); }
    [[nodiscard]] double distance(Point2 p) const {
        const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
        const double t = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
        return std::hypot(p.x - a.x - dx * t, p.y - a.y - dy * t);
    }
};

/// A camera whose view has the picture's aspect. Window coordinates: pixels, y down.
class WindowOf {
public:
    WindowOf(const Camera& camera, int width, int height)
        : width_(width),
          height_(height),
          orthographic_(camera.orthographic),
          half_(camera.orthographic ? double{camera.half_height} : std::tan(0.5 * double{camera.fov_y_rad})) {
        const auto axis = [&](int i) {
            return Vec3d{camera.world_from_camera.c[i].x, camera.world_from_camera.c[i].y, camera.world_from_camera.c[i].z};
        };
        right_ = axis(0), up_ = axis(1), back_ = axis(2), eye_ = axis(3);
    }
    [[nodiscard]] double depth(Vec3d p) const { return -dot(back_, p - eye_); }
    [[nodiscard]] Point2 point(Vec3d p) const {
        const double w = orthographic_ ? 1.0 : depth(p), scale = 0.5 * height_ / (half_ * w);
        return {0.5 * width_ + dot(right_, p - eye_) * scale, 0.5 * height_ - dot(up_, p - eye_) * scale};
    }
    /// The place from which a point is seen: the eye, or a place far before the point.
    [[nodiscard]] Vec3d seen_from(Vec3d p, double size) const { return orthographic_ ? p + back_ * (4.0 * size) : eye_; }

private:
    int width_, height_;
    bool orthographic_;
    double half_;
    Vec3d right_, up_, back_, eye_;
};

/// Edges of all instances' triangles. Requires: no layers, no mirrored instance, and one surface for each instance.
class EdgeReference {
public:
    struct Face {
        Vec3d p[3];
        bool double_sided;
    };
    struct Edge {
        Vec3d a, b;
        std::vector<std::size_t> faces;
    };

    explicit EdgeReference(const Scene& scene) {
        using Key = std::tuple<double, double, double>;
        Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
            if (mesh.topology != Topology::triangles) continue;
            std::map<std::pair<Key, Key>, std::vector<std::size_t>> uses;
            for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                Face face{{}, mesh.material >= 0 && scene.materials[static_cast<std::size_t>(mesh.material)].double_sided};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Mat4& m = instance.world_from_object;
                    const Vec3f q = mesh.positions[mesh.indices[i + k]];
                    const auto row = [&](float a, float b, float c, float d) {
                        return double{a} * double{q.x} + double{b} * double{q.y} + double{c} * double{q.z} + double{d};
                    };
                    face.p[k] = {row(m.c[0].x, m.c[1].x, m.c[2].x, m.c[3].x), row(m.c[0].y, m.c[1].y, m.c[2].y, m.c[3].y),
                                 row(m.c[0].z, m.c[1].z, m.c[2].z, m.c[3].z)};
                    low = {std::min(low.x, face.p[k].x), std::min(low.y, face.p[k].y), std::min(low.z, face.p[k].z)};
                    high = {std::max(high.x, face.p[k].x), std::max(high.y, face.p[k].y), std::max(high.z, face.p[k].z)};
                }
                const auto key = [&](std::size_t k) { return Key{face.p[k].x, face.p[k].y, face.p[k].z}; };
                for (std::size_t k = 0; k < 3; ++k) uses[std::minmax(key(k), key((k + 1) % 3))].push_back(faces_.size());
                faces_.push_back(face);
            }
            const auto place = [](const Key& key) { return Vec3d{std::get<0>(key), std::get<1>(key), std::get<2>(key)}; };
            for (const auto& [ends, faces] : uses) edges_.push_back({place(ends.first), place(ends.second), faces});
        }
        size_ = length(high - low);
    }

    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
    [[nodiscard]] bool faces_viewer(std::size_t face, const WindowOf& window) const {
        const Face& f = faces_[face];
        return dot(normal(f), window.seen_from(f.p[0], size_) - f.p[0]) > 0.0;
    }
    [[nodiscard]] bool is_line(const Edge& edge, EdgeChoice choice, double angle_deg, const WindowOf& window) const {
        if (choice == EdgeChoice::all || edge.faces.size() != 2) return true;
        const Vec3d a = normal(faces_[edge.faces[0]]), b = normal(faces_[edge.faces[1]]);
        const double angle = std::acos(std::clamp(dot(a, b) / (length(a) * length(b)), -1.0, 1.0)) * 180.0 / 3.14159265358979;
        if (choice == EdgeChoice::feature && angle > angle_deg) return true;
        return faces_viewer(edge.faces[0], window) != faces_viewer(edge.faces[1], window);
    }
    /// No triangle lies before a point of the edge, by more than 1e-5 of the scene's size, and a side of the edge is drawn.
    [[nodiscard]] bool is_seen(const Edge& edge, Vec3d p, const WindowOf& window) const {
        const auto shown = [&](std::size_t face) { return faces_[face].double_sided || faces_viewer(face, window); };
        if (std::none_of(edge.faces.begin(), edge.faces.end(), shown)) return false;
        const Vec3d eye = window.seen_from(p, size_), ray = p - eye;
        const double before = 1.0 - 1e-5 * size_ / length(ray);
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            if (std::find(edge.faces.begin(), edge.faces.end(), i) != edge.faces.end() || !shown(i)) continue;
            const Face& f = faces_[i];
            const Vec3d n = normal(f);
            const double slope = dot(n, ray);
            if (slope == 0.0) continue;
            const double t = dot(n, f.p[0] - eye) / slope;
            if (!(t > 0.0 && t < before)) continue;
            const Vec3d hit = eye + ray * t;
            bool inside = true;
            for (int k = 0; k < 3 && inside; ++k) inside = dot(cross(f.p[(k + 1) % 3] - f.p[k], hit - f.p[k]), n) >= 0.0;
            if (inside) return false;
        }
        return true;
    }
    /// The parts of the lines that are seen, by samples a quarter of a pixel apart.
    [[nodiscard]] std::vector<Segment2> seen_parts(EdgeChoice choice, double angle_deg, const WindowOf& window) const {
        std::vector<Segment2> parts;
        for (const Edge& edge : edges_) {
            if (!is_line(edge, choice, angle_deg, window)) continue;
            const int steps = 1 + static_cast<int>(4.0 * Segment2{window.point(edge.a), window.point(edge.b)}.length());
            int begin = -1;
            for (int i = 0; i <= steps; ++i) {
                const bool seen = i < steps && is_seen(edge, edge.a + (edge.b - edge.a) * ((i + 0.5) / steps), window);
                const auto end_of = [&](int at) { return window.point(edge.a + (edge.b - edge.a) * (1.0 * at / steps)); };
                if (seen && begin < 0) begin = i;
                if (!seen && begin >= 0) parts.push_back({end_of(begin), end_of(i)}), begin = -1;
            }
        }
        return parts;
    }

private:
    static Vec3d normal(const Face& f) { return cross(f.p[1] - f.p[0], f.p[2] - f.p[0]); }
    std::vector<Face> faces_;
    std::vector<Edge> edges_;
    double size_ = 1.0;
};

/// Shares of pixels that lines cover, 0 to 1.
struct Cover {
    int width, height;
    std::vector<float> rgba;
    [[nodiscard]] double at(int x, int y) const {
        return double{rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))]};
    }
    [[nodiscard]] double at(Point2 p) const { return at(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y))); }
};

/// Draws red lines over black surfaces without light: red is the share that lines cover.
inline Cover cover_of(Scene scene, const Camera& camera, Settings settings, int width, int height, const Execution& execution = {}) {
    for (Material& material : scene.materials) material.base_color = {0, 0, 0, material.base_color.w}, material.unlit = true;
    for (Mesh& mesh : scene.meshes)
        if (mesh.material < 0) {
            mesh.material = static_cast<int>(scene.materials.size());
            Material& black = scene.materials.emplace_back();
            black.base_color = {0, 0, 0, 1}, black.unlit = true;
        }
    settings.edge_color_linear = {1, 0, 0};
    settings.shadows = ShadowMode::off;
    Cover cover{width, height, std::vector<float>(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
    Target target{width, height};
    target.linear = cover.rgba.data();
    target.premultiplied = true;
    const auto report = render(scene, camera, settings, target, execution);
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    return cover;
}

/// The largest distances, in pixels, between what is painted and lines that should be.
struct Worst {
    double painted = 0;  ///< from the middle of a painted pixel to the nearest line
    int missing = 0;     ///< points of lines, half a pixel apart, in pixels that are not painted
    int points = 0;
};
inline Worst compare(const Cover& cover, const std::vector<Segment2>& lines) {
    Worst worst;
    for (int y = 0; y < cover.height; ++y)
        for (int x = 0; x < cover.width; ++x) {
            if (!(cover.at(x, y) > 0)) continue;
            double nearest = 1e9;
            for (const Segment2& line : lines) nearest = std::min(nearest, line.distance({x + 0.5, y + 0.5}));
            worst.painted = std::max(worst.painted, nearest);
        }
    for (const Segment2& line : lines) {
        const int steps = 1 + static_cast<int>(2.0 * line.length());
        for (int i = 0; i < steps; ++i) {
            const Point2 p = line.at((i + 0.5) / steps);
            if (!(p.x >= 0 && p.x < cover.width && p.y >= 0 && p.y < cover.height)) continue;
            ++worst.points;
            worst.missing += cover.at(p) > 0 ? 0 : 1;
        }
    }
    return worst;
}

}  // namespace halflit::raster::test
