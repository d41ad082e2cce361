#include "apps/engine/mujoco/shapes.hpp"

#include "apps/engine/mujoco/mesh_builder.hpp"
#include "sh/trig.hpp"

namespace halflit::engine::mujoco {
namespace {

/// Sine and cosine of an angle that is rounded to float, as floats; u: its share of a whole turn.
struct Turn {
    float cos, sin, u;
    explicit Turn(double angle, float of_turn = 0) : u(of_turn) {
        const SinCos both = sin_cos(static_cast<double>(static_cast<float>(angle)));
        cos = static_cast<float>(both.cos), sin = static_cast<float>(both.sin);
    }
};

/// Surfaces around z. A ring is a function from a Turn to a Corner.
class Rings {
public:
    explicit Rings(const Fineness& f) : has_uv_(f.has_uv) {
        for (int j = 0; j <= f.slices; ++j)
            turns_.emplace_back(2.0 * kPi * j / f.slices, static_cast<float>(j) / static_cast<float>(f.slices));
    }
    /// Texture coordinates, where the shape has some.
    [[nodiscard]] Vec2f uv(float u, float v) const { return has_uv_ ? Vec2f{u, v} : Vec2f{}; }
    template <class Lower, class Upper>
    void band(const Lower& lower, const Upper& upper, bool reversed = false) {
        for (std::size_t j = 0; j + 1 < turns_.size(); ++j)
            builder.quad(lower(turns_[j]), lower(turns_[j + 1]), upper(turns_[j + 1]), upper(turns_[j]), reversed);
    }
    /// tip: the corner in the middle, by the two that it makes a triangle with.
    template <class Ring, class Tip>
    void fan(const Ring& ring, const Tip& tip, bool reversed = false) {
        for (std::size_t j = 0; j + 1 < turns_.size(); ++j) {
            const Corner a = ring(turns_[j]), b = ring(turns_[j + 1]);
            builder.triangle(a, b, tip(a, b), reversed);
        }
    }

    MeshBuilder builder{true};

private:
    std::vector<Turn> turns_;
    bool has_uv_;
};

/// The half of a sphere on the side of z that `sign` gives, moved by `offset` along z. v_equator: coordinate v there; at the upper pole v
/// is 0, at the lower one 1.
void add_half_sphere(Rings& rings, int sign, int stacks, float offset, float v_equator) {
    const float v_pole = sign > 0 ? 0.0f : 1.0f;
    const auto ring = [&](int i) {
        const Turn elevation(kPi / 2 * sign * i / stacks);
        const float v = v_equator + (v_pole - v_equator) * static_cast<float>(i) / static_cast<float>(stacks);
        return [&rings, elevation, offset, v](Turn t) {
            const Vec3f n{t.cos * elevation.cos, t.sin * elevation.cos, elevation.sin};
            return Corner{{n.x, n.y, n.z + offset}, n, rings.uv(t.u, v)};
        };
    };
    const auto side = static_cast<float>(sign);
    rings.fan(
        ring(stacks - 1),
        [&](const Corner& a, const Corner& b) {
            return Corner{{0, 0, side + offset}, {0, 0, side}, rings.uv((a.uv.x + b.uv.x) / 2, v_pole)};
        },
        sign < 0);
    for (int i = 0; i < stacks - 1; ++i) rings.band(ring(i), ring(i + 1), sign < 0);
}

/// sign 0: at z = 0, seen from below.
void add_disk(Rings& rings, int sign, int stacks) {
    const Vec3f middle{0, 0, static_cast<float>(sign)}, normal{0, 0, sign > 0 ? 1.0f : -1.0f};
    const auto ring = [&](int i) {
        const float r = static_cast<float>(i) / static_cast<float>(stacks);
        return [=, &rings](Turn t) {
            const float x = t.cos * r, y = t.sin * r;
            return Corner{{x, y, middle.z}, normal, rings.uv(0.5f + 0.5f * x, 0.5f + 0.5f * y)};
        };
    };
    rings.fan(
        ring(1),
        [&](const Corner&, const Corner&) {
            return Corner{middle, normal, rings.uv(0.5f, 0.5f)};
        },
        sign <= 0);
    for (int i = 1; i < stacks; ++i) rings.band(ring(i + 1), ring(i), sign <= 0);
}

void add_tube(Rings& rings, int stacks) {
    const auto ring = [&](int i) {
        const float z = static_cast<float>(2 * i) / static_cast<float>(stacks) - 1.0f;
        return [=, &rings](Turn t) {
            return Corner{{t.cos, t.sin, z}, normalize_or({t.cos, t.sin, 0}, {1, 0, 0}), rings.uv(t.u, (1.0f - z) / 2)};
        };
    };
    for (int i = 0; i < stacks; ++i) rings.band(ring(i), ring(i + 1));
}

void add_cone(Rings& rings, int stacks) {
    const float slope = 0.70710678118654752440f;  // 1/sqrt(2)
    const auto ring = [&](int i) {
        const float r = static_cast<float>(i) / static_cast<float>(stacks);
        return [=, &rings](Turn t) {
            return Corner{{t.cos * r, t.sin * r, 1.0f - r}, {t.cos * slope, t.sin * slope, slope}, rings.uv(t.u, r)};
        };
    };
    rings.fan(ring(1), [&](const Corner& a, const Corner& b) {
        return Corner{{0, 0, 1}, normalize_or(a.normal + b.normal, {0, 0, 1}), rings.uv((a.uv.x + b.uv.x) / 2, 0)};
    });
    for (int i = 1; i < stacks; ++i) rings.band(ring(i + 1), ring(i));
    add_disk(rings, 0, stacks);
}

/// Two bands, clear at the lower and the upper end. Where they meet is the height at which the cone's shadow of 45 degrees begins.
void add_haze(Rings& rings, float r) {
    const float middle = r / (1.0f + r);  // sqrt(1/2) r sin(a) / sin(3 pi/4 - a) for a = atan2(1, r)
    const auto ring = [&](float z, float alpha) {
        return [=](Turn t) {
            const float radius = 1.0f - r * (1.0f - z);
            return Corner{{t.cos * radius, t.sin * radius, z}, {0, 0, 1}, {alpha, 0}};
        };
    };
    rings.band(ring(0, 0), ring(middle, 1));
    rings.band(ring(middle, 1), ring(1, 0));
}

/// A square of the side of the unit cube at `side` on an axis (0 x, 1 y, 2 z), which has quads x quads.
void add_square(MeshBuilder& builder, int axis, float side, int quads, int x, int y) {
    const float step = 2.0f / static_cast<float>(quads);
    const auto corner = [&](int i, int j) {
        const float u = step * static_cast<float>(i) - 1.0f, v = step * static_cast<float>(j) - 1.0f;
        const Vec3f n{axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0};
        const Vec2f uv{static_cast<float>(i) / static_cast<float>(quads), 1.0f - static_cast<float>(j) / static_cast<float>(quads)};
        return Corner{axis == 0 ? Vec3f{side, u, v} : axis == 1 ? Vec3f{u, side, v} : Vec3f{u, v, side}, n, uv};
    };
    builder.quad(corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1), (axis == 1) == (side > 0));
}

/// Squares of all sides in turn, as transparent boxes are blended where nothing is culled.
Mesh make_box(const Fineness& f, bool with_top, bool with_rest) {
    const int quads = f.quads;
    MeshBuilder builder(f.has_uv);
    for (int x = 0; x < quads; ++x)
        for (int y = 0; y < quads; ++y)
            for (const int axis : {2, 0, 1})
                for (const float side : {1.0f, -1.0f})
                    if (axis == 2 && side > 0 ? with_top : with_rest) add_square(builder, axis, side, quads, x, y);
    return builder.take();
}

Mesh lines(std::vector<Vec3f> positions, std::vector<std::uint32_t> indices) {
    Mesh mesh;
    mesh.normals.assign(positions.size(), {0, 0, 1});
    mesh.positions = std::move(positions);
    mesh.indices = std::move(indices);
    mesh.topology = Topology::lines;
    return mesh;
}

Mesh round_shape(Shape shape, const Fineness& f) {
    Rings rings(f);
    const int half = f.stacks / 2;
    switch (shape) {
        case Shape::sphere:
            add_half_sphere(rings, -1, half, 0, 0.5f);
            add_half_sphere(rings, 1, half, 0, 0.5f);
            break;
        case Shape::upper_cap:
        case Shape::lower_cap: {
            const int sign = shape == Shape::upper_cap ? 1 : -1;
            add_half_sphere(rings, sign, half, static_cast<float>(sign), sign > 0 ? 1.0f : 0.0f);
            break;
        }
        case Shape::cylinder:
            add_disk(rings, -1, half);
            add_tube(rings, f.stacks);
            add_disk(rings, 1, half);
            break;
        case Shape::tube:
            add_tube(rings, f.stacks);
            break;
        case Shape::cone:
            add_cone(rings, f.stacks);
            break;
        default:
            add_haze(rings, f.haze);
    }
    Mesh mesh = rings.builder.take();
    if (shape == Shape::haze)
        for (const Vec2f uv : mesh.uv0) mesh.colors.push_back({f.haze_color.x, f.haze_color.y, f.haze_color.z, uv.x});
    if (!f.has_uv || shape == Shape::haze) mesh.uv0.clear();
    return mesh;
}

}  // namespace

Mesh make_shape(Shape shape, const Fineness& fineness) {
    switch (shape) {
        case Shape::plane: {
            Mesh mesh = make_box(fineness, true, false);
            for (Vec3f& p : mesh.positions) p.z = 0;
            return mesh;
        }
        case Shape::box:
        case Shape::box_top:
        case Shape::box_rest:
            return make_box(fineness, shape != Shape::box_rest, shape != Shape::box_top);
        case Shape::triangle: {
            MeshBuilder flat(fineness.has_uv);
            flat.triangle({{0, 0, 0}, {0, 0, 1}, {0, 1}}, {{1, 0, 0}, {0, 0, 1}, {1, 1}}, {{0, 1, 0}, {0, 0, 1}, {0, 0}});
            return flat.take();
        }
        case Shape::line:
            return lines({{0, 0, 0}, {0, 0, 1}}, {0, 1});
        case Shape::line_box:
            return lines({{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}},
                         {0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7});
        default:
            return round_shape(shape, fineness);
    }
}

}  // namespace halflit::engine::mujoco
