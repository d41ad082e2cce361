#include "tests/support/bracket.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halflit::test {
namespace {

constexpr double kLength = 100, kDepth = 60, kHeight = 50;

/// A rectangle of the plate with a hole: upper and lower side, and the hole's wall.
void holed_cell(SolidBuilder& builder, Point2 low, Point2 high, Point2 middle, double radius, double thickness) {
    constexpr int kPoints = 32;
    std::vector<Point2> rim;
    const std::vector<Point2> hole = circle(radius, kPoints, middle);
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kPoints, dx = std::cos(angle), dy = std::sin(angle);
        double reach = 1e9;  // to the side of the rectangle
        if (std::abs(dx) > 1e-9) reach = std::min(reach, ((dx > 0 ? high[0] : low[0]) - middle[0]) / dx);
        if (std::abs(dy) > 1e-9) reach = std::min(reach, ((dy > 0 ? high[1] : low[1]) - middle[1]) / dy);
        rim.push_back({middle[0] + reach * dx, middle[1] + reach * dy});
    }
    for (std::size_t i = 0; i < kPoints; ++i) {
        const std::size_t next = (i + 1) % kPoints;
        const auto at = [](Point2 p, double z) { return Vec3d{p[0], p[1], z}; };
        const Point2 a = rim[i], b = rim[next], c = hole[next], d = hole[i];
        // The rectangle's corner, where two sides meet between the points.
        const bool turns = std::abs(a[0] - b[0]) > 1e-6 && std::abs(a[1] - b[1]) > 1e-6;
        if (turns) {
            const bool a_on_side = std::abs(a[0] - low[0]) < 1e-6 || std::abs(a[0] - high[0]) < 1e-6;
            const Point2 corner = a_on_side ? Point2{a[0], b[1]} : Point2{b[0], a[1]};
            builder.triangle(at(a, thickness), at(corner, thickness), at(b, thickness));
            builder.triangle(at(a, 0), at(b, 0), at(corner, 0));
        }
        builder.quad(at(a, thickness), at(b, thickness), at(c, thickness), at(d, thickness));
        builder.quad(at(d, 0), at(c, 0), at(b, 0), at(a, 0));
        builder.quad(at(c, 0), at(d, 0), at(d, thickness), at(c, thickness));
    }
}

}  // namespace

Bracket make_bracket(const BracketPlan& plan) {
    Bracket out;
    SolidBuilder b;
    const double t = plan.thickness, c = plan.chamfer, band = 4;  // band: depth of the strip behind the chamfer
    const double wall_y = kDepth - plan.wall;
    const auto range = [&](FeatureRange& feature, const auto& build) {
        feature.first = b.triangles();
        build();
        feature.last = b.triangles();
    };
    range(out.holes, [&] {
        const double cell = kLength / plan.holes;
        for (int i = 0; i < plan.holes; ++i) {
            const double shift = plan.shift.empty() ? 0.0 : plan.shift[static_cast<std::size_t>(i)];
            holed_cell(b, {i * cell, band}, {(i + 1) * cell, wall_y}, {(i + 0.5) * cell + shift, 0.5 * (band + wall_y)}, plan.hole_radius,
                       t);
        }
    });
    range(out.chamfer, [&] {
        b.quad({0, c, t}, {kLength, c, t}, {kLength, band, t}, {0, band, t});
        b.quad({0, 0, 0}, {kLength, 0, 0}, {kLength, 0, t - c}, {0, 0, t - c});
        if (c > 0) b.quad({0, 0, t - c}, {kLength, 0, t - c}, {kLength, c, t}, {0, c, t});
    });
    b.quad({0, band, 0}, {kLength, band, 0}, {kLength, 0, 0}, {0, 0, 0});
    b.quad({0, kDepth, 0}, {kLength, kDepth, 0}, {kLength, wall_y, 0}, {0, wall_y, 0});
    for (const double x : {0.0, kLength}) {
        const auto side = [&](Vec3d p, Vec3d q, Vec3d r) { x > 0 ? b.triangle(p, q, r) : b.triangle(p, r, q); };
        side({x, 0, 0}, {x, kDepth, 0}, {x, kDepth, t});
        side({x, 0, 0}, {x, kDepth, t}, {x, c, t});
        if (c > 0) side({x, 0, 0}, {x, c, t}, {x, 0, t - c});
        side({x, wall_y, t}, {x, kDepth, t}, {x, kDepth, kHeight});
        side({x, wall_y, t}, {x, kDepth, kHeight}, {x, wall_y, kHeight});
    }
    b.quad({0, wall_y, t}, {kLength, wall_y, t}, {kLength, wall_y, kHeight}, {0, wall_y, kHeight});
    b.quad({kLength, kDepth, 0}, {0, kDepth, 0}, {0, kDepth, kHeight}, {kLength, kDepth, kHeight});
    b.quad({0, wall_y, kHeight}, {kLength, wall_y, kHeight}, {kLength, kDepth, kHeight}, {0, kDepth, kHeight});
    range(out.rib, [&] {
        if (!plan.rib) return;
        const double x0 = plan.rib_at - 1.5, x1 = plan.rib_at + 1.5, y = wall_y - 10, z = t + 20;
        b.triangle({x0, wall_y, t}, {x0, y, t}, {x0, wall_y, z});
        b.triangle({x1, y, t}, {x1, wall_y, t}, {x1, wall_y, z});
        b.quad({x0, y, t}, {x1, y, t}, {x1, wall_y, z}, {x0, wall_y, z});
    });
    range(out.step, [&] {
        if (plan.step <= 0) return;
        const Mesh patch = box_mesh({plan.step_at, band + 1, t}, {plan.step_at + plan.step_length, band + 3, t + plan.step});
        b.append(patch);
    });
    range(out.body, [&] {
        if (plan.body_inside) b.append(box_mesh({plan.body_at - 1, wall_y + 2, 20}, {plan.body_at + 1, kDepth - 2, 23}));
    });
    out.mesh = b.take();
    return out;
}

BracketPlan random_bracket(Random& random) {
    BracketPlan plan;
    plan.holes = static_cast<int>(random.integer(1, 4));
    plan.hole_radius = random.real(2, 7);
    plan.thickness = random.real(3, 10);
    plan.wall = random.real(5, 12);
    plan.chamfer = random.real(0.5, 2.5);
    plan.rib_at = random.real(5, 95);
    plan.body_at = random.real(5, 95);
    plan.step_at = random.real(5, 40);
    plan.step_length = random.real(5, 40);
    return plan;
}

}  // namespace halflit::test
