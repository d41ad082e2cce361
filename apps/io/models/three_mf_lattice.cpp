// Lattices of 3MF files as triangles: outlines turned about the axes of struts.
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/three_mf_model.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace halflit::io::detail {

namespace {

using namespace three_mf;

/// A circle of an outline: its place along the axis and radius, the normal in these directions, and whether it is near the second end.
struct Ring {
    double along, radius, normal_along, normal_out;
    bool is_second = false;
};

class Sweeper {
public:
    /// As round as the memory permits for so many beams and balls.
    Sweeper(Object& object, ModelBuilder& builder, std::size_t beams, std::size_t balls) : object_(object), builder_(builder) {
        constexpr std::uint64_t kBytesAVertex = 2 * (kTriangleBytes + sizeof(Triangle)) + 160;
        for (const std::size_t sides : {16, 12, 8, 6, 4, 3}) {
            quarter_ = std::max<int>(1, static_cast<int>(sides) / 4);
            const std::uint64_t bytes =
                (2 * beams + (2 * static_cast<std::uint64_t>(quarter_) + 1) * (beams + balls)) * sides * kBytesAVertex;
            has_ends_ = bytes <= builder.document().geometry.left() / 2;
            if (!has_ends_ && sides > 3) continue;
            for (std::size_t i = 0; i < sides; ++i)
                circle_.push_back(sin_cos(2.0 * kPi * static_cast<double>(i) / static_cast<double>(sides)));
            break;
        }
    }
    [[nodiscard]] bool has_ends() const { return has_ends_; }

    /// The circles of half a ball about `centre`, from its pole to its equator (way -1), or from there to the pole (way 1).
    void add_half_ball(std::vector<Ring>& outline, double centre, double radius, double way) const {
        for (int i = 0; i <= quarter_; ++i) {
            const int step = way < 0 ? i : quarter_ - i;  // from the pole
            const auto [sin, cos] = step == quarter_ ? SinCos{1.0, 0.0} : sin_cos(0.5 * kPi * step / quarter_);
            outline.push_back({centre + way * radius * cos, radius * sin, way * cos, sin, way > 0});
        }
    }

    /// Turns an outline about the axis through `origin`. property: of both ends.
    void turn(Vec3d origin, Vec3d axis, std::span<const Ring> outline, std::uint32_t group, const std::array<std::uint32_t, 2>& property) {
        const std::size_t sides = circle_.size();
        const std::uint64_t vertices = outline.size() * sides, triangles = 2 * (outline.size() - 1) * sides;
        charge_work(kUnitsAVertex * vertices);
        check_time();
        builder_.take_entries<Vec3d>(vertices);
        builder_.take_entries<Vec3f>(vertices);
        builder_.document().geometry.take(triangles * sizeof(Triangle));
        builder_.take_triangles(triangles);
        const double x = std::max(axis.x, -axis.x), y = std::max(axis.y, -axis.y), z = std::max(axis.z, -axis.z);
        const Vec3d least = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
        const Vec3d side = cross(axis, least), u = side * (1.0 / length(side)), v = cross(axis, u);
        auto first = static_cast<std::uint32_t>(object_.vertices.size());
        for (const Ring& ring : outline)
            for (const SinCos& at : circle_) {
                const Vec3d out = u * at.cos + v * at.sin, normal = axis * ring.normal_along + out * ring.normal_out;
                object_.vertices.push_back(origin + axis * ring.along + out * ring.radius);
                object_.normals.push_back({static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
            }
        for (std::size_t r = 0; r + 1 < outline.size(); ++r, first += static_cast<std::uint32_t>(sides)) {
            const Ring &a = outline[r], &b = outline[r + 1];
            if (a.along == b.along && a.radius == b.radius) continue;  // an edge: two normals at a place
            const std::uint32_t of_a = property[a.is_second ? 1 : 0], of_b = property[b.is_second ? 1 : 0];
            for (std::uint32_t i = 0; i < sides; ++i) {
                const std::uint32_t next = i + 1 < sides ? i + 1 : 0, up = static_cast<std::uint32_t>(sides);
                if (a.radius > 0) object_.triangles.push_back({{first + i, first + next, first + up + i}, {of_a, of_a, of_b}, group});
                if (b.radius > 0)
                    object_.triangles.push_back({{first + next, first + up + next, first + up + i}, {of_a, of_b, of_b}, group});
            }
        }
    }

private:
    static constexpr std::uint64_t kUnitsAVertex = 100;  ///< of charge_work

    Object& object_;
    ModelBuilder& builder_;
    int quarter_ = 1;       ///< circles from a ball's pole to its equator
    bool has_ends_ = true;  ///< false: of hundreds of thousands, beams are open
    std::vector<SinCos> circle_;
};

}  // namespace

void sweep_lattice(Object& object, const std::string& where, ModelBuilder& builder) {
    Lattice lattice = std::exchange(object.lattice, {});
    if (lattice.beams.empty() && lattice.balls.empty()) return;
    const std::size_t vertices = object.vertices.size();
    const auto is_size = [](double radius) { return radius > 0 && radius < 1e30; };
    const auto axis_of = [&](const Lattice::Beam& beam) { return object.vertices[beam.vertex[1]] - object.vertices[beam.vertex[0]]; };
    std::size_t bad = std::erase_if(lattice.beams, [&](const Lattice::Beam& beam) {
        const bool is_there = beam.vertex[0] < vertices && beam.vertex[1] < vertices && is_size(beam.radius[0]) && is_size(beam.radius[1]);
        return !is_there || !(length(axis_of(beam)) < 1e30);
    });
    if (lattice.ball_radius > 0)
        for (const Lattice::Beam& beam : lattice.beams)
            for (std::size_t end = 0; end < 2; ++end)
                lattice.balls.try_emplace(beam.vertex[end], Lattice::Ball{lattice.ball_radius, beam.group, beam.property[end]});
    bad += std::erase_if(lattice.balls, [&](const auto& ball) { return ball.first >= vertices || !is_size(ball.second.radius); });
    std::erase_if(lattice.beams, [&](const Lattice::Beam& beam) { return !(length(axis_of(beam)) > std::max(lattice.shortest, 0.0)); });
    Sweeper sweeper(object, builder, lattice.beams.size(), lattice.balls.size());
    std::vector<Ring> outline;
    for (const Lattice::Beam& beam : lattice.beams) {
        const Vec3d axis = axis_of(beam);
        const double size = length(axis), fall = beam.radius[0] - beam.radius[1], slant = std::sqrt(size * size + fall * fall);
        outline.clear();
        const auto add_end = [&](std::size_t end) {
            const double at = end == 0 ? 0 : size, radius = beam.radius[end], way = end == 0 ? -1 : 1;
            if (!sweeper.has_ends()) return;
            if (beam.cap[end] != Lattice::Cap::butt) return sweeper.add_half_ball(outline, at, radius, way);
            for (const double r : {end == 0 ? 0 : radius, end == 0 ? radius : 0}) outline.push_back({at, r, way, 0, end == 1});
        };
        add_end(0);
        outline.push_back({0, beam.radius[0], fall / slant, size / slant});
        outline.push_back({size, beam.radius[1], fall / slant, size / slant, true});
        add_end(1);
        sweeper.turn(object.vertices[beam.vertex[0]], axis * (1.0 / size), outline, beam.group, beam.property);
    }
    for (const auto& [vertex, ball] : lattice.balls) {
        outline.clear();
        sweeper.add_half_ball(outline, 0.0, ball.radius, -1);
        outline.pop_back();
        sweeper.add_half_ball(outline, 0.0, ball.radius, 1);
        sweeper.turn(object.vertices[vertex], {0, 0, 1}, outline, ball.group, {ball.property, ball.property});
    }
    if (bad > 0)
        builder.document().go_on_without({{ErrorCode::bad_input, fmt::format("{}: {} beams and balls are out of range", where, bad)}},
                                         "they are left out");
}

}  // namespace halflit::io::detail
