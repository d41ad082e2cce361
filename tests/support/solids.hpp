// Meshes of simple bodies, closed unless said otherwise, whose fronts face outwards. Lengths are of any unit.
#pragma once

#include "halflit/mesh.hpp"
#include "halflit/scene.hpp"
#include "sh/vec3d.hpp"
#include "tests/support/random.hpp"

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace halflit::test {

/// Triangles that are collected; each face has vertices of its own.
class SolidBuilder {
public:
    void triangle(Vec3d a, Vec3d b, Vec3d c);
    /// Two triangles; a, b, c, d run around the quad, counter-clockwise seen from its front.
    void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d);
    /// A quad of n x n quads.
    void grid(Vec3d a, Vec3d b, Vec3d c, Vec3d d, int n);
    void append(const Mesh& mesh);
    [[nodiscard]] std::size_t triangles() const { return mesh_.indices.size() / 3; }
    /// The mesh with normals of its faces.
    [[nodiscard]] Mesh take();

private:
    Mesh mesh_;
};

using Point2 = std::array<double, 2>;

/// Each face has 2 n^2 triangles.
[[nodiscard]] Mesh box_mesh(Vec3d low, Vec3d high, int n = 1);
/// Between z = low and z = high. outer: counter-clockwise. inner: a hole with as many points, counter-clockwise; empty: none, and the
/// outer contour must see the origin from everywhere.
[[nodiscard]] Mesh prism_mesh(std::span<const Point2> outer, std::span<const Point2> inner, double low, double high);
[[nodiscard]] std::vector<Point2> circle(double radius, int points, Point2 middle = {0, 0});
/// Teeth between the two radii, four points each.
[[nodiscard]] std::vector<Point2> gear_contour(double root, double tip, int teeth);
[[nodiscard]] Mesh torus_mesh(double radius, double tube, int around, int across);
/// 20 * 4^level triangles.
[[nodiscard]] Mesh ball_mesh(double radius, int level);
/// Fronts become backs.
void flip(Mesh& mesh);
/// Without the triangles of these numbers.
[[nodiscard]] Mesh without_triangles(const Mesh& mesh, std::span<const std::size_t> left_out);
void move(Mesh& mesh, Vec3d by);

/// A box, cylinder, torus, ball or gear, closed, 2 units across and up to a few hundred triangles.
[[nodiscard]] Mesh random_closed_solid(Random& random);
/// The same, or one of other kinds: with holes, with another within it, a thin wall, an open sheet.
[[nodiscard]] Mesh random_solid(Random& random);
/// A model of one to five such bodies: beside each other, one within the other, holed, open, thin, mirrored, placed more than once,
/// double-sided, transparent or not shown.
[[nodiscard]] Scene random_model(std::uint64_t seed);

}  // namespace halflit::test
