#include "shading/reference/reference.hpp"

#include "sh/lobe_error.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/model/sheen_table.hpp"
#include "shading/model/srgb.hpp"
#include "shading/model/thin_film.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::shading::reference {
namespace {

/// The model's constant as a decimal, not rounded to float.
constexpr double kHeldRoughness = 0.07;
static_assert(static_cast<float>(kHeldRoughness) == kMinRoughness);

Vec3d scale(Vec3d v, double s) { return {v.x * s, v.y * s, v.z * s}; }
Vec3d unit(Vec3d v) {
    const double size = length(v);
    return size > 0 ? scale(v, 1.0 / size) : v;
}
Vec3d row3(const FragmentBlock& block, int row, int lane) {
    return {block.lane[row][lane], block.lane[row + 1][lane], block.lane[row + 2][lane]};
}
Rgba mix(const Rgba& a, const Rgba& b, double t) {
    return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), a.a + t * (b.a - a.a)};
}

/// Index of the texel that is read at index i of the endless picture.
int wrapped(long long i, int size, TextureWrap mode) {
    const auto modulo = [](long long value, long long period) { return ((value % period) + period) % period; };
    switch (mode) {
        case TextureWrap::repeat:
            return static_cast<int>(modulo(i, size));
        case TextureWrap::mirror: {
            const long long m = modulo(i, 2LL * size);
            return static_cast<int>(m < size ? m : 2LL * size - 1 - m);
        }
        case TextureWrap::clamp:
            break;
    }
    return static_cast<int>(std::clamp<long long>(i, 0, size - 1));
}

Rgba texel(const Texture& texture, const TextureLevel& level, const Sampler& sampler, long long x, long long y) {
    const std::int64_t at =
        level.offset + std::int64_t{wrapped(y, level.height, sampler.wrap_v)} * level.width + wrapped(x, level.width, sampler.wrap_u);
    const std::uint16_t* c = texture.data().data() + 4 * at;
    return {c[0] / 65535.0, c[1] / 65535.0, c[2] / 65535.0, c[3] / 65535.0};
}

/// Coordinates are clamped to +-2^20; NaN reads as 0.
double held_coordinate(double x) { return std::isnan(x) ? 0.0 : std::clamp(x, -0x1p20, 0x1p20); }

Rgba sample_level(const Texture& texture, const TextureLevel& level, const Sampler& sampler, TextureFilter filter, double u, double v) {
    const double x = u * level.width, y = v * level.height;
    if (filter == TextureFilter::nearest) return texel(texture, level, sampler, std::llround(std::floor(x)), std::llround(std::floor(y)));
    const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5);
    const long long i = std::llround(x0), j = std::llround(y0);
    const Rgba upper = mix(texel(texture, level, sampler, i, j), texel(texture, level, sampler, i + 1, j), x - 0.5 - x0);
    const Rgba lower = mix(texel(texture, level, sampler, i, j + 1), texel(texture, level, sampler, i + 1, j + 1), x - 0.5 - x0);
    return mix(upper, lower, y - 0.5 - y0);
}

/// True if the coordinates are used as they are: a transform would carry a NaN from one coordinate to the other.
bool is_identity(const TextureUse& use) { return use.row_u == Vec3f{1, 0, 0} && use.row_v == Vec3f{0, 1, 0}; }

/// Changes of (u, v) in texels of level 0 by a step of one pixel to the right, and down.
struct Steps {
    double ux, vx, uy, vy;
};
Steps texel_steps(const Texture& texture, const TextureUse& use, const FragmentBlock& block, int lane) {
    const int first = use.uv_set == 1 ? kDu1Dx : kDu0Dx;
    const auto step = [&](int at, double& x, double& y) {
        double du = block.lane[at][lane], dv = block.lane[at + 1][lane];
        if (!is_identity(use)) {
            const double du_in = du;
            du = double{use.row_u.x} * du_in + double{use.row_u.y} * dv;
            dv = double{use.row_v.x} * du_in + double{use.row_v.y} * dv;
        }
        x = du * texture.width(), y = dv * texture.height();
    };
    Steps out{};
    step(first, out.ux, out.vx);
    step(first + 2, out.uy, out.vy);
    return out;
}

/// The mean of probes along the longer axis of a footprint (kernels/anisotropic_kernel.hpp).
Rgba sample_ellipse(const Texture& texture, const TextureUse& use, const FragmentBlock& block, int lane, double u, double v, int most) {
    Steps s = texel_steps(texture, use, block, lane);
    for (double* x : {&s.ux, &s.vx, &s.uy, &s.vy}) *x = std::isnan(*x) ? 0.0 : std::clamp(*x, -1e8, 1e8);
    // The longer axis is at the angle t with tan 2t = 2 uv / (uu - vv).
    const double uu = s.ux * s.ux + s.uy * s.uy, vv = s.vx * s.vx + s.vy * s.vy, uv = s.ux * s.vx + s.uy * s.vy;
    const double angle = 0.5 * std::atan2(2 * uv, uu - vv),
                 length = std::sqrt(0.5 * (uu + vv) + std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv));
    const double width = length > 0 ? std::abs(s.ux * s.vy - s.uy * s.vx) / length : 0.0;
    const double ratio = std::clamp(length / std::max(width, 1.0), 1.0, static_cast<double>(most)), between = length / ratio;
    const double du = between * std::cos(angle) / texture.width(), dv = between * std::sin(angle) / texture.height();
    Rgba sum{};
    for (int i = -9; i <= 9; ++i) {
        const double weight = i == 0 ? 1.0 : std::clamp(0.5 * (ratio - (2 * std::abs(i) - 1)), 0.0, 1.0);
        if (weight == 0.0) continue;
        const Rgba at = sample(texture, use.sampler, u + i * du, v + i * dv, std::log2(between));
        sum = {sum.r + weight * at.r, sum.g + weight * at.g, sum.b + weight * at.b, sum.a + weight * at.a};
    }
    return {sum.r / ratio, sum.g / ratio, sum.b / ratio, sum.a / ratio};
}

/// A material's texture at a lane; `fallback` where it is not used.
Rgba material_texture(const FrameInputs& frame, const TextureUse& use, SlotMask available, const FragmentBlock& block, int lane,
                      const Rgba& fallback) {
    if (use.texture < 0 || static_cast<std::size_t>(use.texture) >= frame.textures.size()) return fallback;
    const Texture& texture = frame.textures[static_cast<std::size_t>(use.texture)];
    if (texture.levels().empty()) return fallback;
    double u = block.lane[use.uv_set == 1 ? kU1 : kU0][lane], v = block.lane[use.uv_set == 1 ? kV1 : kV0][lane];
    double lod = level_of_detail(texture, use, block, lane);
    if (use.uv_set == 1 && (available & 16u) == 0) u = v = 0, lod = -100;
    const bool has_uv = use.uv_set != 1 || (available & 16u) != 0;
    double tu = u, tv = v;
    if (!is_identity(use)) {
        tu = double{use.row_u.x} * u + double{use.row_u.y} * v + double{use.row_u.z};
        tv = double{use.row_v.x} * u + double{use.row_v.y} * v + double{use.row_v.z};
    }
    const bool smooth = use.sampler.mag == TextureFilter::linear && use.sampler.min == TextureFilter::linear &&
                        use.sampler.mip == MipFilter::linear && texture.levels().size() > 1;
    if (smooth && has_uv && frame.options.anisotropy > 1)
        return sample_ellipse(texture, use, block, lane, tu, tv, frame.options.anisotropy);
    return sample(texture, use.sampler, tu, tv, lod);
}

struct Surface {
    Vec3d base, normal, albedo, f0, to_eye;
    double roughness, occlusion, metallic;
    Vec3d diffuse;     ///< base colour where not metallic, and where light does not pass through
    Vec3d dielectric;  ///< F0 there
    double weight;     ///< factor of what is mirrored at grazing views there
    bool brushed;      ///< longer facets along a direction
    Vec3d along;       ///< unit; with alpha_across and alpha_along, whose geometric mean is roughness^2
    double alpha_along, alpha_across;
    [[nodiscard]] Vec3d beside() const { return cross(normal, along); }
    [[nodiscard]] double largest_dielectric() const { return std::max({dielectric.x, dielectric.y, dielectric.z}); }
    [[nodiscard]] double at_grazing() const { return metallic + (1 - metallic) * weight; }
};

/// Unit direction and attenuation of a light at a point.
struct Arrival {
    Vec3d direction;
    double attenuation;
};
Arrival arrival(const Light& light, Vec3d position) {
    const Vec3d travel = unit(to_double(light.direction_ws));
    if (light.type == LightType::directional) return {scale(travel, -1), 1.0};
    const Vec3d offset = to_double(light.position_ws) - position;
    const double distance = length(offset);
    const Vec3d direction = unit(offset);
    const double radius = std::max(double{kMinSourceRadius}, double{light.source_radius});
    double attenuation = 1.0 / std::max(distance * distance, radius * radius);
    if (light.range > 0) attenuation *= std::clamp(1.0 - std::pow(distance / double{light.range}, 4.0), 0.0, 1.0);
    if (light.type == LightType::spot) {
        const double cosine = -dot(direction, travel);
        const double outer = std::cos(double{light.outer_cone_rad});
        const double inner = std::cos(std::min(double{light.inner_cone_rad}, double{light.outer_cone_rad}));
        const double cone = inner > outer ? std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0) : (cosine > outer ? 1.0 : 0.0);
        attenuation *= cone * cone;
        if (light.cone_power > 0) attenuation *= std::pow(std::max(cosine, 0.0), double{light.cone_power});
    }
    return {direction, attenuation};
}

Vec3d hemisphere(const Ambient& ambient, double up) {
    const Vec3d sky = to_double(ambient.sky_linear), ground = to_double(ambient.ground_linear);
    return ground + scale(sky - ground, 0.5 * (1.0 + up));
}

double environment_share(double f0, double weight, double roughness, double n_dot_v) {
    return f0 + (std::max((1.0 - roughness) * weight, f0) - f0) * std::pow(1.0 - std::clamp(n_dot_v, 0.0, 1.0), 5.0);
}

/// The normal turned to the visible side, by the texture `map` with a factor on x and y, if it is used.
Vec3d mapped_normal(const FrameInputs& frame, const Material& material, const TextureUse& map, float factor, SlotMask available,
                    const FragmentBlock& block, int lane) {
    Vec3d normal = unit(row3(block, kNormalX, lane));
    if (map.used() && (available & 4u) != 0) {
        const Rgba c = material_texture(frame, map, available, block, lane, {0.5, 0.5, 1, 1});
        const Vec3d tangent = unit(row3(block, kTangentX, lane));
        const Vec3d bitangent = scale(cross(normal, tangent), block.lane[kTangentW][lane]);
        const double strength = factor;
        normal = unit(scale(tangent, (2 * c.r - 1) * strength) + scale(bitangent, (2 * c.g - 1) * strength) + scale(normal, 2 * c.b - 1));
    }
    return material.double_sided ? scale(normal, block.lane[kFacing][lane]) : normal;
}

/// A roughness that grows by what the normals of the texture `map` lost where it is minified.
double rougher(const FrameInputs& frame, const TextureUse& map, float factor, double roughness, SlotMask available,
               const FragmentBlock& block, int lane) {
    const double lost = material_texture(frame, map, available, block, lane, {}).a;
    const bool loses = map.used() && (available & 4u) != 0 && lost != 0.0 &&
                       static_cast<std::size_t>(map.texture) < frame.textures.size() &&
                       frame.textures[static_cast<std::size_t>(map.texture)].rule() == MipRule::normal;
    if (!loses) return roughness;
    return std::min(1.0, std::pow(std::pow(std::max(roughness, kHeldRoughness), 4.0) + std::pow(lost * double{factor}, 2.0), 0.25));
}

/// Value of a level of the environment's map towards a direction.
Vec3d map_value(const ReflectionPlan& reflections, int level, Vec3d d) {
    const ReflectionMap& map = *reflections.map;
    const int rows = map.rows[level];
    const double u = std::atan2(d.x, -d.z) / (2 * kPi) + 0.5 + double{reflections.turned};
    const double x = (u - std::floor(u)) * 2 * rows, y = std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) / kPi * rows;
    const int i = std::clamp(static_cast<int>(x), 0, 2 * rows - 1), j = std::clamp(static_cast<int>(y), 0, rows - 1);
    const auto value = [&](int column, int row) {
        const std::array<float, 4>& at = map.rgba[static_cast<std::size_t>(map.first[level] + row * (2 * rows + 1) + column)];
        return Vec3d{at[0], at[1], at[2]};
    };
    const Vec3d upper = value(i, j) + scale(value(i + 1, j) - value(i, j), x - i);
    const Vec3d lower = value(i, j + 1) + scale(value(i + 1, j + 1) - value(i, j + 1), x - i);
    return upper + scale(lower - upper, y - j);
}

/// Mean radiance over a level's lobe about a direction of any length; 0 for the zero vector.
Vec3d blurred(const ReflectionPlan& map, Vec3d d, double level) {
    if (!(dot(d, d) > 0)) return {};
    const int fine = std::clamp(static_cast<int>(level), 0, kReflectionLevels - 2);
    const Vec3d near = map_value(map, fine, d);
    return near + scale(map_value(map, fine + 1, d) - near, level - fine);
}

/// Values between the nodes of a table at a roughness and a cosine N.V.
class TableCell {
public:
    TableCell(double roughness, double n_dot_v) {
        constexpr int kLast = kReflectionNodes - 1;
        const double rough = roughness > kHeldRoughness ? std::min(roughness, 1.0) : kHeldRoughness;  // NaN too
        const double held = n_dot_v > 0.0 ? std::min(n_dot_v, 1.0) : 0.0;
        const double x = rough * kLast, y = 1.2 * held / (held + 0.2) * kLast;
        i_ = std::min(static_cast<int>(x), kLast - 1), j_ = std::min(static_cast<int>(y), kLast - 1);
        down_ = x - i_, right_ = y - j_;
    }
    template <class Shape>
    [[nodiscard]] double value(const Shape* table, float Shape::*member) const {
        const auto node = [&](int down, int right) { return double{table[(i_ + down) * kReflectionNodes + j_ + right].*member}; };
        const double left = node(0, 0) + down_ * (node(1, 0) - node(0, 0)), next = node(0, 1) + down_ * (node(1, 1) - node(0, 1));
        return left + right_ * (next - left);
    }

private:
    int i_, j_;
    double down_, right_;
};

class MirrorTable : TableCell {
public:
    using TableCell::TableCell;
    double operator()(float ReflectionShape::*member) const { return value(kReflectionShapes, member); }
};

/// The environment as a rough mirror sees it: GGX's A and B, and the mean radiance over its lobes (shading/model/reflection_tables.hpp).
struct Mirrored {
    double a, b;
    Vec3d radiance;
};
Mirrored mirrored_environment(const ReflectionPlan& map, int lobes, const Surface& surface) {
    if (surface.brushed) {
        const MirrorTable all(surface.roughness, dot(surface.normal, surface.to_eye));
        Mirrored out{all(&ReflectionShape::a), all(&ReflectionShape::b), {}};
        const double spread =
            std::sqrt(std::max(0.0, surface.alpha_along * surface.alpha_along - surface.alpha_across * surface.alpha_across));
        for (const StretchTap& tap : kStretchTaps) {
            Surface mirror = surface;
            mirror.brushed = false;
            mirror.normal = unit(surface.normal + scale(surface.along, spread * double{tap.place}));
            const double turned = std::max(0.0, double{kStretchEdge} - dot(mirror.normal, surface.to_eye));
            mirror.normal = unit(mirror.normal + scale(surface.to_eye, 2 * turned));
            const double wide = double{kStretchWidth} * spread;
            mirror.roughness = std::pow(std::min(1.0, surface.alpha_across * surface.alpha_across + wide * wide), 0.25);
            out.radiance = out.radiance + scale(mirrored_environment(map, 1, mirror).radiance, double{tap.weight});
        }
        return out;
    }
    const double n_dot_v = dot(surface.normal, surface.to_eye);
    const MirrorTable at(surface.roughness, n_dot_v);
    const Vec3d reflection = scale(surface.normal, 2 * n_dot_v) - surface.to_eye;
    const auto towards = [&](double turn, double level) {
        return blurred(map, reflection + scale(surface.normal - scale(reflection, n_dot_v), turn), level);
    };
    Mirrored out{at(&ReflectionShape::a), at(&ReflectionShape::b), {}};
    if (lobes == 1) {
        out.radiance = towards(at(&ReflectionShape::turn0), at(&ReflectionShape::level0));
    } else {
        const double turn = at(&ReflectionShape::turn1), spread = at(&ReflectionShape::spread), level = at(&ReflectionShape::level1);
        out.radiance = scale(towards(turn - spread, level) + towards(turn + spread, level), 0.5);
    }
    return out;
}

struct SkySeen {
    Vec3d diffuse{1, 1, 1};
    double mirrored = 1;
};

/// The share of it by the grid (plan/sky_grid_plan.hpp).
double seen_in_grid(Vec3d n, const Surroundings& around) {
    double hidden = 0.0, total = 0.0, all = 0.0;
    const double factors[kGridTerms] = {1, n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.x * n.y, n.x * n.z, n.y * n.z};
    for (std::size_t k = 0; k < around.sky_terms.size(); ++k) hidden += around.sky_terms[k] * factors[k];
    for (const LightPlan& light : around.sky) {
        const double cosine = dot(n, Vec3d{light.to_light[0], light.to_light[1], light.to_light[2]}), l = double{light.brightness};
        total += l * (kGridLobe.constant + kGridLobe.linear * cosine + kGridLobe.square * cosine * cosine);
        all += l;
    }
    const double share = hidden / std::max({total, kLeastGridTotal * all, 1e-30}), least = double{kGridThreshold};
    return 1.0 - std::clamp((share - least) / (1.0 - least), 0.0, 1.0) * (1.0 - double{kGridBounce});
}

/// Shares of the light of the surroundings that a surface sees.
SkySeen sky_seen(const FrameInputs& frame, const Lobe& lobe, const Surface& surface, const Surroundings& around) {
    if (around.sky.empty()) return {};
    if (around.sky_grid != nullptr) {
        const double seen = seen_in_grid(surface.normal, around);
        return {{seen, seen, seen}, seen};
    }
    const Vec3d reflection = scale(surface.normal, 2 * dot(surface.normal, surface.to_eye)) - surface.to_eye;
    const double roughness = std::max(surface.roughness, kHeldRoughness);
    const double focus = std::min(around.sky_focus, 1.0 - double{kSkyFocusByAlpha} * roughness * roughness);
    Vec3d total{}, hidden{};
    double mirrored = 0, mirrored_hidden = 0;
    for (std::size_t i = 0; i < around.sky.size(); ++i) {
        const LightPlan& light = around.sky[i];
        const Vec3d direction{light.to_light[0], light.to_light[1], light.to_light[2]},
            color{light.color[0], light.color[1], light.color[2]};
        const double x = dot(surface.normal, direction), f = lobe_value(lobe, x);
        total = total + scale(color, f);
        hidden = hidden + scale(color, f - shadowed_lobe(lobe, x, around.hidden_sky[i], frame.shadow_mode));
        const double glance = std::pow(std::max(0.0, dot(reflection, direction) - focus), 2.0) * std::max({color.x, color.y, color.z});
        mirrored += glance;
        mirrored_hidden += glance * around.hidden_sky[i].hard;
    }
    const auto seen = [](double part, double all) { return all > 0 ? 1.0 - std::min(part / all, 1.0) : 1.0; };
    return {{seen(hidden.x, total.x), seen(hidden.y, total.y), seen(hidden.z, total.z)}, seen(mirrored_hidden, mirrored)};
}

/// GGX's highlight of a directional light of colour 1, by the textbook's formulas: pi D V (N.L) F and light that bounces between facets.
Vec3d ggx_highlight(const Surface& surface, Vec3d to_light) {
    const double n_dot_l = dot(surface.normal, to_light), n_dot_v = std::clamp(dot(surface.normal, surface.to_eye), 0.0, 1.0);
    const Vec3d both = to_light + surface.to_eye, half = unit(both);
    if (!(n_dot_l > 0) || !(dot(surface.normal, both) > double{kLeastHalfVector})) return {};
    const double roughness = std::max(surface.roughness, kHeldRoughness), a2 = std::pow(roughness, 4.0);
    const Vec3d sine = cross(surface.normal, half);
    const double n_dot_h = dot(surface.normal, half), d = dot(sine, sine) + a2 * n_dot_h * n_dot_h;
    const auto root = [&](double x) { return std::sqrt(x * x * (1 - a2) + a2); };
    double masking = 0.5 / (n_dot_l * root(n_dot_v) + n_dot_v * root(n_dot_l)), facets = a2 / (d * d);
    if (surface.brushed) {
        const double t = surface.alpha_along, b = surface.alpha_across, x = dot(surface.along, half) / t,
                     y = dot(surface.beside(), half) / b;
        facets = 1 / (t * b * std::pow(x * x + y * y + n_dot_h * n_dot_h, 2.0));
        const auto size = [&](Vec3d w, double n_dot_w) {
            return length(Vec3d{t * dot(surface.along, w), b * dot(surface.beside(), w), n_dot_w});
        };
        masking = 0.5 / (n_dot_l * size(surface.to_eye, n_dot_v) + n_dot_v * size(to_light, n_dot_l));
    }
    const double value = facets * masking * n_dot_l, schlick = std::pow(1 - std::min(dot(surface.to_eye, half), 1.0), 5.0);
    const MirrorTable at(roughness, n_dot_v);
    const double more = 1.0 / (at(&ReflectionShape::a) + at(&ReflectionShape::b)) - 1.0;
    const auto channel = [&](double f0) { return value * (f0 * (1 - schlick) + surface.at_grazing() * schlick) * (1 + f0 * more); };
    return {channel(surface.f0.x), channel(surface.f0.y), channel(surface.f0.z)};
}

Vec3d lit(const FrameInputs& frame, const Material& material, const Surface& surface, Vec3d position, const Surroundings& around) {
    const bool specular = frame.options.specular != SpecularModel::none;
    const Lobe& lobe = lobe_of(material, frame.options);
    const double alpha = std::pow(std::max(surface.roughness, kHeldRoughness), 2.0), s = 2.0 / (alpha * alpha) - 2.0;
    Vec3d sum{};
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const Light& light = frame.lights[i];
        const Arrival at = arrival(light, position);
        const double n_dot_l = dot(surface.normal, at.direction);
        const Hidden hidden = around.hidden.empty() ? Hidden{} : around.hidden[i];
        const Vec3d color = to_double(light.color_linear);
        const auto lobe_at = [&](Vec3d direction) {
            return shadowed_lobe(lobe, dot(surface.normal, direction), hidden, frame.shadow_mode);
        };
        const SunShape* const sun = frame.suns.empty() ? nullptr : frame.suns[i];
        Vec3d through_lobe{};
        if (sun == nullptr)
            through_lobe = scale(color, lobe_at(at.direction));
        else
            for (const SunPatch& patch : sun->patches) through_lobe = through_lobe + scale(patch.light, lobe_at(patch.direction));
        Vec3d reflected = surface.albedo * through_lobe;
        if (frame.options.specular == SpecularModel::ggx) {
            reflected = reflected + color * scale(ggx_highlight(surface, at.direction), 1.0 - hidden.hard);
        } else if (specular && n_dot_l > 0 && surface.brushed) {
            const Vec3d half = unit(at.direction + surface.to_eye);
            const double cosine = dot(surface.normal, half), x = dot(surface.along, half), y = dot(surface.beside(), half);
            const auto exponent = [](double width) { return 2 / (width * width) - 2; };
            const double by_side = x * x + y * y > 0
                                       ? (x * x * exponent(surface.alpha_along) + y * y * exponent(surface.alpha_across)) / (x * x + y * y)
                                       : 0.0;
            const double factor = frame.options.normalize_specular ? (s * s + 10 * s + 32) / (8 * (s + 4)) : 1.0;
            if (cosine > 0)
                reflected = reflected +
                            color * scale(surface.f0, factor * std::pow(std::min(cosine, 1.0), by_side) * n_dot_l * (1.0 - hidden.hard));
        } else if (specular && n_dot_l > 0) {
            const bool phong = frame.options.specular == SpecularModel::phong;
            const Vec3d reflection = scale(surface.normal, 2 * n_dot_l) - at.direction;
            const double cosine = phong ? dot(surface.to_eye, unit(reflection)) : dot(surface.normal, unit(at.direction + surface.to_eye));
            const double factor = !frame.options.normalize_specular ? 1.0 : phong ? (s + 8) / 8 : (s * s + 10 * s + 32) / (8 * (s + 4));
            if (cosine > 0)
                reflected = reflected + color * scale(surface.f0, factor * std::pow(std::min(cosine, 1.0), phong ? s / 4 : s) * n_dot_l *
                                                                      (1.0 - hidden.hard));
        }
        sum = sum + scale(reflected, at.attenuation);
    }
    const SkySeen seen = sky_seen(frame, lobe, surface, around);
    const auto min3 = [](Vec3d v, double most) { return Vec3d{std::min(v.x, most), std::min(v.y, most), std::min(v.z, most)}; };
    const Vec3d diffuse_seen = min3(seen.diffuse, surface.occlusion);
    const double mirrored_seen = std::min(seen.mirrored, surface.occlusion);
    const bool environment = around.diffuse != nullptr;
    Vec3d ambient = surface.albedo * (environment ? around.diffuse->at(surface.normal) : hemisphere(frame.ambient, surface.normal.y));
    if (specular && environment) {
        const Mirrored mirrored = mirrored_environment(*around.reflections, around.reflection_lobes, surface);
        const auto share = [&](double f0, double weight) {
            const double more = 1.0 / (mirrored.a + mirrored.b) - 1.0;
            return (mirrored.a * f0 + mirrored.b * weight) * (1.0 + f0 * more);
        };
        const double end = surface.at_grazing();
        ambient =
            scale(surface.diffuse * around.diffuse->at(surface.normal), 1.0 - share(surface.largest_dielectric(), surface.weight)) *
                diffuse_seen +
            scale(Vec3d{share(surface.f0.x, end), share(surface.f0.y, end), share(surface.f0.z, end)} * mirrored.radiance, mirrored_seen);
    } else if (specular) {
        const double n_dot_v = dot(surface.normal, surface.to_eye), roughness = std::max(surface.roughness, kHeldRoughness);
        const Vec3d reflection = scale(surface.normal, 2 * n_dot_v) - surface.to_eye;
        const double end = surface.at_grazing();
        const Vec3d share{environment_share(surface.f0.x, end, roughness, n_dot_v),
                          environment_share(surface.f0.y, end, roughness, n_dot_v),
                          environment_share(surface.f0.z, end, roughness, n_dot_v)};
        ambient = ambient * diffuse_seen + scale(share * hemisphere(frame.ambient, reflection.y), mirrored_seen);
    } else {
        ambient = ambient * diffuse_seen;
    }
    return sum + ambient;
}

}  // namespace

double lobe_value(const Lobe& lobe, double x) {
    const double w = lobe.wrap, n = lobe.power;
    return sh::lobe_value({w, n, lobe.normalize ? (n + 1) / (2 * (1 + w)) : 1.0}, x);
}

Rgba sample(const Texture& texture, const Sampler& sampler, double u, double v, double lod) {
    u = held_coordinate(u), v = held_coordinate(v);
    const auto levels = texture.levels();
    const bool magnified = !(lod > 0);  // NaN too
    const TextureFilter filter = magnified ? sampler.mag : sampler.min;
    const double last = static_cast<double>(levels.size() - 1);
    if (sampler.mip == MipFilter::none || magnified) return sample_level(texture, levels[0], sampler, filter, u, v);
    const double held = std::clamp(lod, 0.0, last);
    if (sampler.mip == MipFilter::nearest)
        return sample_level(texture, levels[static_cast<std::size_t>(std::nearbyint(held))], sampler, filter, u, v);
    const auto low = static_cast<std::size_t>(held), high = std::min(low + 1, levels.size() - 1);
    return mix(sample_level(texture, levels[low], sampler, filter, u, v), sample_level(texture, levels[high], sampler, filter, u, v),
               held - static_cast<double>(low));
}

double level_of_detail(const Texture& texture, const TextureUse& use, const FragmentBlock& block, int lane) {
    const Steps step = texel_steps(texture, use, block, lane);
    const auto length = [](double x, double y) { return std::sqrt(x * x + y * y); };  // NaN if one is, where hypot may be infinite
    // A footprint that is NaN: the step down decides, so that of a NaN there is no footprint at all.
    const double right = length(step.ux, step.vx), down = length(step.uy, step.vy);
    return std::log2(right > down ? right : down);
}

namespace {

Rgba base_color(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane) {
    Rgba base = material_texture(frame, material.textures[TextureSlot::base_color], available, block, lane, {1, 1, 1, 1});
    base = {base.r * material.base_color.x, base.g * material.base_color.y, base.b * material.base_color.z, base.a * material.base_color.w};
    if ((available & 8u) != 0)
        base = {base.r * block.lane[kColorR][lane], base.g * block.lane[kColorG][lane], base.b * block.lane[kColorB][lane],
                base.a * block.lane[kColorA][lane]};
    return base;
}

double alpha_of(const Material& material, double alpha) {
    const double held = std::clamp(alpha, 0.0, 1.0);
    if (material.alpha_mode == AlphaMode::blend) return held;
    if (material.alpha_mode == AlphaMode::mask && material.transmits()) return held >= double{material.alpha_cutoff} ? 1.0 : 0.0;
    return 1.0;
}

/// Share of the light that enters the surface which passes through it.
double transmitted(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane) {
    if (!material.transmits()) return 0.0;
    return std::clamp(double{material.transmission}, 0.0, 1.0) *
           material_texture(frame, material.textures[TextureSlot::transmission], available, block, lane, {1, 1, 1, 1}).r;
}

/// Share of the light that is scattered which leaves on the far side.
double scattered_through(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane) {
    return std::clamp(double{material.diffuse_transmission}, 0.0, 1.0) *
           material_texture(frame, material.textures[TextureSlot::diffuse_transmission], available, block, lane, {1, 1, 1, 1}).a;
}

/// F0 of a surface below a thin film, by the formulas of KHR_materials_iridescence: indices of refraction, phases, and Schlick's curve
/// turned around. The phase belongs to the channel, not to X, Y or Z.
double below_film(double f0, double ior, double thickness_nm, double n_dot_v, int channel) {
    const double cosine = std::clamp(n_dot_v, double{kLeastFilmCosine}, 1.0), n2 = ior,
                 cosine2 = std::sqrt(1 - (1 - cosine * cosine) / (n2 * n2));
    const auto schlick = [](double f, double c) { return f + (1 - f) * std::pow(1 - c, 5.0); };
    const double n3 = (1 + std::sqrt(std::clamp(f0, 0.0, 0.999999))) / (1 - std::sqrt(std::clamp(f0, 0.0, 0.999999)));
    const double amplitude = (n3 - n2) / (n3 + n2), r12 = schlick(std::pow((n2 - 1) / (n2 + 1), 2.0), cosine), t121 = 1 - r12;
    const double r23 = schlick(amplitude * amplitude, cosine2), r123 = std::sqrt(r12 * r23), rs = t121 * t121 * r23 / (1 - r12 * r23);
    const double way = std::min(2 * n2 * thickness_nm * cosine2, double{kMostFilmWay});
    const auto sensitivity = [&](int times) {
        double sum = 0;
        for (const FilmWave& wave : kFilmWaves)
            sum += double{wave.rgb[channel]} * std::cos(2 * kPi * double{wave.waves_per_nm} * times * way) *
                   std::exp2(-double{wave.fade_per_nm2} * std::pow(times * way, 2.0));
        return sum;
    };
    const double sign = std::clamp(amplitude * double{kFilmSignSlope}, -1.0, 1.0);  // -cos of the phase, 1 or -1 but about 0
    const double seen = r12 + rs - 2 * (rs - t121) * r123 * sign * sensitivity(1) + 2 * (rs - t121) * r123 * r123 * sensitivity(2);
    const double grazing = std::pow(1 - cosine, 5.0);
    return std::clamp((seen - grazing) / (1 - grazing), 0.0, 1.0);
}

/// Puts a thin film above a surface.
void add_film(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
              Surface& surface) {
    const Rgba white{1, 1, 1, 1};
    const double least = std::clamp(double{material.iridescence_thickness_min_nm}, 0.0, double{kMostFilmNm}),
                 most = std::clamp(double{material.iridescence_thickness_max_nm}, 0.0, double{kMostFilmNm});
    const double thickness =
        least +
        (most - least) * material_texture(frame, material.textures[TextureSlot::iridescence_thickness], available, block, lane, white).g;
    const double share = std::clamp(double{material.iridescence}, 0.0, 1.0) * std::clamp(thickness / double{kThinFilmNm}, 0.0, 1.0) *
                         material_texture(frame, material.textures[TextureSlot::iridescence], available, block, lane, white).r;
    const double ior = std::clamp(double{material.iridescence_ior}, 1.0, double{kMostFilmIor}),
                 n_dot_v = dot(surface.normal, surface.to_eye);
    const auto with_film = [&](double f0, int channel) { return f0 + share * (below_film(f0, ior, thickness, n_dot_v, channel) - f0); };
    const auto each = [&](Vec3d f0) { return Vec3d{with_film(f0.x, 0), with_film(f0.y, 1), with_film(f0.z, 2)}; };
    surface.dielectric = each(surface.dielectric);
    surface.f0 = scale(each(surface.base), surface.metallic) + scale(surface.dielectric, 1 - surface.metallic);
    surface.albedo = scale(surface.diffuse, 1 - surface.largest_dielectric());
}

/// Gives a surface its direction, and the two widths of its facets.
void brush(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane, Surface& surface) {
    const Rgba texel = material_texture(frame, material.textures[TextureSlot::anisotropy], available, block, lane, {1, 0.5, 1, 1});
    const double turn = double{material.anisotropy_rotation_rad}, x = 2 * texel.r - 1, y = 2 * texel.g - 1;
    const Vec3d normal = unit(row3(block, kNormalX, lane)), tangent = unit(row3(block, kTangentX, lane));
    const Vec3d bitangent = scale(cross(normal, tangent), block.lane[kTangentW][lane]);
    const Vec3d turned =
        scale(tangent, std::cos(turn) * x - std::sin(turn) * y) + scale(bitangent, std::sin(turn) * x + std::cos(turn) * y);
    const Vec3d flat = turned - scale(surface.normal, dot(turned, surface.normal));
    const double size = dot(flat, flat), strength = std::clamp(double{material.anisotropy_strength}, 0.0, 1.0) * texel.b *
                                                    std::min(1.0, double{kShortDirection} * size);
    surface.brushed = size > 1e-12;
    surface.along = unit(flat);
    surface.alpha_across = std::pow(std::max(surface.roughness, kHeldRoughness), 2.0);
    surface.alpha_along = surface.alpha_across + (1 - surface.alpha_across) * strength * strength;
    surface.roughness = std::pow(surface.alpha_along * surface.alpha_across, 0.25);
}

Surface surface_of(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane) {
    const Rgba white{1, 1, 1, 1}, base = base_color(frame, material, available, block, lane);
    const Rgba mr = material_texture(frame, material.textures[TextureSlot::metallic_roughness], available, block, lane, white);
    const Rgba occlusion = material_texture(frame, material.textures[TextureSlot::occlusion], available, block, lane, white);
    Surface surface{};
    surface.base = {base.r, base.g, base.b};
    const TextureUse& normals = material.textures[TextureSlot::normal];
    const float scale_of_normals = material.normal_scale * frame.options.normal_scale;
    surface.normal = mapped_normal(frame, material, normals, scale_of_normals, available, block, lane);
    surface.roughness = rougher(frame, normals, scale_of_normals, material.roughness * mr.g, available, block, lane);
    surface.occlusion = 1.0 + double{material.occlusion_strength} * (occlusion.r - 1.0);
    const Vec3d position = row3(block, kPosX, lane);
    surface.to_eye = frame.orthographic ? scale(to_double(frame.view_direction_ws), -1) : unit(to_double(frame.eye_ws) - position);
    const double scattered =
        (1.0 - transmitted(frame, material, available, block, lane)) * (1.0 - scattered_through(frame, material, available, block, lane));
    surface.albedo = scale(surface.base, scattered);
    if (frame.options.specular != SpecularModel::none) {
        const double dielectric = std::clamp(double{material.dielectric_reflectance}, 0.0, 1.0);
        surface.metallic = material.metallic * mr.b;
        surface.diffuse = scale(surface.base, (1 - surface.metallic) * scattered);
        const Rgba color = material_texture(frame, material.textures[TextureSlot::specular_color], available, block, lane, white);
        surface.weight = std::clamp(double{material.specular}, 0.0, 1.0) *
                         material_texture(frame, material.textures[TextureSlot::specular], available, block, lane, white).a;
        const auto channel = [&](float factor, double texture) {
            return std::min(1.0, dielectric * std::max(0.0, double{factor}) * texture) * surface.weight;
        };
        surface.dielectric = {channel(material.specular_color.x, color.r), channel(material.specular_color.y, color.g),
                              channel(material.specular_color.z, color.b)};
        surface.albedo = scale(surface.diffuse, 1 - surface.largest_dielectric());
        surface.f0 = scale(surface.base, surface.metallic) + scale(surface.dielectric, 1 - surface.metallic);
        if (material.is_anisotropic() && (available & 4u) != 0) brush(frame, material, available, block, lane, surface);
        if (material.is_iridescent()) add_film(frame, material, available, block, lane, surface);
    }
    return surface;
}

/// Light of the far side that a surface scatters to this one: what a surface turned around would scatter, of the far side's colour.
Vec3d light_through(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                    const Surface& surface, const Surroundings& around) {
    const Vec3f factor = material.diffuse_transmission_color;
    const Rgba texel =
        material_texture(frame, material.textures[TextureSlot::diffuse_transmission_color], available, block, lane, {1, 1, 1, 1});
    const double share = scattered_through(frame, material, available, block, lane) *
                         (1 - transmitted(frame, material, available, block, lane)) * (1 - surface.metallic);
    const auto channel = [&](float held, double texture) { return std::clamp(double{held}, 0.0, 1.0) * texture * share; };
    const Vec3d color{channel(factor.x, texel.r), channel(factor.y, texel.g), channel(factor.z, texel.b)};
    const bool specular = frame.options.specular != SpecularModel::none;
    double mirrored = specular ? surface.largest_dielectric() : 0.0, mirrored_sky = mirrored;
    if (specular && around.diffuse != nullptr) {
        const MirrorTable at(surface.roughness, dot(surface.normal, surface.to_eye));
        const double a = at(&ReflectionShape::a), b = at(&ReflectionShape::b);
        mirrored_sky = (a * mirrored + b * surface.weight) * (1 + mirrored * (1 / (a + b) - 1));
    }
    FrameInputs lights = frame, sky = frame;
    lights.options.specular = sky.options.specular = SpecularModel::none;
    lights.ambient = {}, sky.lights = {};
    Surroundings far = around, dark;
    far.hidden = dark.hidden = around.hidden_far, far.hidden_sky = around.hidden_sky_far;
    far.sky_terms = around.sky_terms_far;
    Surface turned = surface;
    turned.normal = scale(surface.normal, -1);
    const Vec3d position = row3(block, kPosX, lane);
    turned.albedo = scale(color, 1 - mirrored);
    const Vec3d of_lights = lit(lights, material, turned, position, dark);
    turned.albedo = scale(color, 1 - mirrored_sky);
    return of_lights + lit(sky, material, turned, position, far);
}

/// Sheen at a lane: light that it adds, and the share of the base's light that it leaves.
struct Fibres {
    Vec3d light;
    double left;
};
Fibres sheen_of(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                const Surface& surface, const Surroundings& around) {
    const Rgba white{1, 1, 1, 1},
        texture = material_texture(frame, material.textures[TextureSlot::sheen_color], available, block, lane, white);
    const auto held = [](float x) { return std::clamp(double{x}, 0.0, 1.0); };
    const Vec3d color{held(material.sheen_color.x) * texture.r, held(material.sheen_color.y) * texture.g,
                      held(material.sheen_color.z) * texture.b};
    const double roughness = std::max(
        kHeldRoughness, held(material.sheen_roughness) *
                            material_texture(frame, material.textures[TextureSlot::sheen_roughness], available, block, lane, white).a);
    const double a = roughness * roughness, signed_n_dot_v = dot(surface.normal, surface.to_eye),
                 n_dot_v = std::clamp(signed_n_dot_v, 0.0, 1.0);
    const TableCell at(roughness, n_dot_v);
    const auto shape = [&](float SheenShape::*member) { return at.value(kSheenShapes, member); };
    const double table_albedo = shape(&SheenShape::albedo), albedo = std::min(table_albedo, 1.0);
    Vec3d light{};
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const Arrival from = arrival(frame.lights[i], row3(block, kPosX, lane));
        const Vec3d both = from.direction + surface.to_eye, half = unit(both), sine = cross(surface.normal, half);
        const double n_dot_l = dot(surface.normal, from.direction);
        if (!(n_dot_l > 0) || !(dot(surface.normal, both) > double{kLeastHalfVector})) continue;
        const double d = (2 + 1 / a) * std::pow(std::min(length(sine), 1.0), 1 / a) / 2;  // times pi
        const double value = d / (4 * (n_dot_l + n_dot_v - n_dot_l * n_dot_v)) * n_dot_l / std::max(1.0, table_albedo);
        const double seen = around.hidden.empty() ? 1.0 : 1.0 - around.hidden[i].hard;
        light = light + scale(to_double(frame.lights[i].color_linear), value * from.attenuation * seen);
    }
    const Vec3d along = surface.to_eye - scale(surface.normal, signed_n_dot_v);
    const Vec3d side = scale(along, 1 / std::sqrt(dot(along, along) + double{kSheenSoftSide}));
    const double height = shape(&SheenShape::height), flat = std::sqrt(std::max(0.0, 1 - height * height));
    const double turn = shape(&SheenShape::turn), across = std::sqrt(std::max(0.0, 1 - turn * turn));
    const Vec3d up = scale(surface.normal, height), other = scale(cross(surface.normal, side), flat * across);
    const Vec3d towards[] = {up + scale(side, flat), up + scale(side, flat * turn) + other, up + scale(side, flat * turn) - other};
    Vec3d radiance{};
    for (const Vec3d d : towards)
        radiance = radiance + (around.diffuse != nullptr ? blurred(*around.reflections, d, shape(&SheenShape::level))
                                                         : hemisphere(frame.ambient, d.y));
    const Vec3d sky = sky_seen(frame, lobe_of(material, frame.options), surface, around).diffuse;
    const Vec3d seen{std::min(sky.x, surface.occlusion), std::min(sky.y, surface.occlusion), std::min(sky.z, surface.occlusion)};
    light = light + scale(radiance * seen, albedo / 3);
    return {light * color, 1 - std::max({color.x, color.y, color.z}) * albedo};
}

bool has_sheen(const FrameInputs& frame, const Material& material) {
    return material.has_sheen() && frame.options.specular != SpecularModel::none;
}

/// A coat at a lane: the share that is coated, and its surface, of F0 0.04.
struct Coat {
    double share;
    Surface surface;
};
Coat coat_of(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
             const Surface& below) {
    const Rgba white{1, 1, 1, 1};
    Coat out{std::clamp(double{material.clearcoat}, 0.0, 1.0) *
                 material_texture(frame, material.textures[TextureSlot::clearcoat], available, block, lane, white).r,
             below};
    const TextureUse& normals = material.textures[TextureSlot::clearcoat_normal];
    const float scale_of_normals = material.clearcoat_normal_scale * frame.options.normal_scale;
    out.surface.normal = mapped_normal(frame, material, normals, scale_of_normals, available, block, lane);
    const double roughness = std::clamp(double{material.clearcoat_roughness}, 0.0, 1.0) *
                             material_texture(frame, material.textures[TextureSlot::clearcoat_roughness], available, block, lane, white).g;
    out.surface.roughness = rougher(frame, normals, scale_of_normals, roughness, available, block, lane);
    out.surface.metallic = 0, out.surface.weight = 1, out.surface.brushed = false;
    out.surface.f0 = {0.04, 0.04, 0.04};
    return out;
}

bool has_coat(const FrameInputs& frame, const Material& material) {
    return material.is_coated() && frame.options.specular != SpecularModel::none;
}

/// Schlick's share of light that a coat's surface mirrors towards the viewer.
double coat_fresnel(const Coat& coat) {
    return 0.04 + 0.96 * std::pow(1.0 - std::clamp(dot(coat.surface.normal, coat.surface.to_eye), 0.0, 1.0), 5.0);
}

/// Light that a coat adds where it covers all.
Vec3d coat_light(const FrameInputs& frame, const Material& material, const Coat& coat, Vec3d position, const Surroundings& around) {
    const Surface& surface = coat.surface;
    const double fresnel = coat_fresnel(coat), n_dot_v = dot(surface.normal, surface.to_eye);
    const double roughness = std::max(surface.roughness, kHeldRoughness), s = 2.0 / std::pow(roughness, 4.0) - 2.0;
    Vec3d sum{};
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const Arrival at = arrival(frame.lights[i], position);
        const double seen = around.hidden.empty() ? 1.0 : 1.0 - around.hidden[i].hard, n_dot_l = dot(surface.normal, at.direction);
        Vec3d highlight{};
        if (frame.options.specular == SpecularModel::ggx) {
            highlight = ggx_highlight(surface, at.direction);
        } else if (n_dot_l > 0) {
            const bool phong = frame.options.specular == SpecularModel::phong;
            const Vec3d mirrored = scale(surface.normal, 2 * n_dot_l) - at.direction;
            const double cosine = phong ? dot(surface.to_eye, unit(mirrored)) : dot(surface.normal, unit(at.direction + surface.to_eye));
            const double factor = !frame.options.normalize_specular ? 1.0 : phong ? (s + 8) / 8 : (s * s + 10 * s + 32) / (8 * (s + 4));
            const double value = cosine > 0 ? fresnel * factor * std::pow(std::min(cosine, 1.0), phong ? s / 4 : s) * n_dot_l : 0.0;
            highlight = {value, value, value};
        }
        sum = sum + scale(to_double(frame.lights[i].color_linear) * highlight, at.attenuation * seen);
    }
    const double seen = std::min(sky_seen(frame, lobe_of(material, frame.options), surface, around).mirrored, surface.occlusion);
    if (around.diffuse != nullptr) {
        const Mirrored mirrored = mirrored_environment(*around.reflections, 1, surface);
        const double share = (mirrored.a * 0.04 + mirrored.b) * (1.0 + 0.04 * (1.0 / (mirrored.a + mirrored.b) - 1.0));
        return sum + scale(mirrored.radiance, share * seen);
    }
    const Vec3d reflection = scale(surface.normal, 2 * n_dot_v) - surface.to_eye;
    return sum + scale(hemisphere(frame.ambient, reflection.y), environment_share(0.04, 1.0, roughness, n_dot_v) * seen);
}

/// Share of the diffuse light, by luminance, that shadows hide.
double hidden_light(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                    const Surroundings& around) {
    FrameInputs without_gloss = frame;
    without_gloss.options.specular = SpecularModel::none;
    Material white;
    white.lobe = material.lobe;
    white.has_own_lobe = material.has_own_lobe;
    white.double_sided = material.double_sided;
    Surroundings open = around;
    open.hidden = {};
    open.sky = {};
    open.hidden_sky = {};
    const Surface surface = surface_of(without_gloss, white, available & kBaseSlots, block, lane);
    const auto luminance = [&](const Surroundings& light) {
        const Vec3d c = lit(without_gloss, white, surface, row3(block, kPosX, lane), light);
        return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    };
    const double all = luminance(open);
    return all > 0 ? std::clamp(1 - luminance(around) / all, 0.0, 1.0) : 0.0;
}

/// Shares of the light from behind that pass where the surface covers all, before it is blurred or bent.
Vec3d passed_shares(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                    const Surface& surface, double thickness, const Surroundings& around) {
    double mirrored = 0.0;
    if (frame.options.specular != SpecularModel::none) {
        const double n_dot_v = dot(surface.normal, surface.to_eye), f0 = surface.largest_dielectric();
        if (around.diffuse != nullptr) {
            const MirrorTable at(surface.roughness, n_dot_v);
            const double a = at(&ReflectionShape::a), b = at(&ReflectionShape::b);
            mirrored = (a * f0 + b * surface.weight) * (1.0 + f0 * (1.0 / (a + b) - 1.0));
        } else {
            mirrored = environment_share(f0, surface.weight, std::max(surface.roughness, kHeldRoughness), n_dot_v);
        }
    }
    const bool front = !material.double_sided || block.lane[kFacing][lane] > 0.0f;
    double share = transmitted(frame, material, available, block, lane) * (1 - mirrored) * (1 - surface.metallic);
    if (has_sheen(frame, material)) share *= sheen_of(frame, material, available, block, lane, surface, around).left;
    if (has_coat(frame, material)) {
        const Coat coat = coat_of(frame, material, available, block, lane, surface);
        share *= 1.0 - coat.share * coat_fresnel(coat);
    }
    const auto channel = [&](double base, float color) {
        const double passed = front && material.attenuation_distance > 0.0f && material.thickness > 0.0f
                                  ? std::pow(double{color}, thickness / double{material.attenuation_distance})
                                  : 1.0;
        return share * base * passed;
    };
    return {channel(surface.base.x, material.attenuation_color.x), channel(surface.base.y, material.attenuation_color.y),
            channel(surface.base.z, material.attenuation_color.z)};
}

/// x in [low, high]; NaN counts as low.
double held(double x, double low, double high) { return x > low ? std::min(x, high) : low; }

double thickness_of(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane) {
    return held(double{material.thickness}, 0.0, 1e18) *
           material_texture(frame, material.textures[TextureSlot::thickness], available, block, lane, {1, 1, 1, 1}).g;
}

/// A level of what lies behind about a point in pixels, by quadratic B-splines: light times coverage, and coverage.
Rgba behind_level(const BehindPlan& behind, int level, double x_px, double y_px) {
    const double x = x_px * double{behind.scale[level]}, y = y_px * double{behind.scale[level]};
    const double column = std::clamp(std::floor(x), 0.0, double{behind.columns[level]} - 1),
                 row = std::clamp(std::floor(y), 0.0, double{behind.rows[level]} - 1);
    const auto weights = [](double t) { return std::array<double, 3>{(1 - t) * (1 - t) / 2, 0.75 - (t - 0.5) * (t - 0.5), t * t / 2}; };
    const std::array<double, 3> across = weights(x - column), down = weights(y - row);
    double sum[4] = {};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            const auto texel = static_cast<std::ptrdiff_t>(behind.first[level]) +
                               (static_cast<std::ptrdiff_t>(row) + j) * behind.below[level] + static_cast<std::ptrdiff_t>(column) + i;
            for (int c = 0; c < 4; ++c)
                sum[c] += across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)] * double{behind.rgba[4 * texel + c]};
        }
    return {sum[0], sum[1], sum[2], sum[3]};
}

/// The light behind glass: its colour, and the share that is kept as it is.
struct Through {
    Vec3d light{0, 0, 0};
    double clear = 1;
};
/// By the index of refraction of one colour; index: that of the middle one.
Through look_through_at(double own_index, double index, const FrameInputs& frame, const Material& material, const FragmentBlock& block,
                        int lane, const Surface& surface, double thickness, const Surroundings& around) {
    const double wide = std::min(1.0, 2 * (index - 1));
    if (around.behind == nullptr || !material.transmits() || frame.options.specular == SpecularModel::none || !(wide > 0) ||
        !(material.roughness > kMinRoughness || material.thickness > 0.0f))
        return {};
    const BehindPlan& behind = *around.behind;
    const double roughness = std::max(surface.roughness, kHeldRoughness), blur = wide * (roughness - kHeldRoughness) / (1 - kHeldRoughness);
    const bool thick = thickness > 0 && (!material.double_sided || block.lane[kFacing][lane] > 0.0f);
    Vec3d bent = scale(surface.to_eye, -1);
    if (thick) {
        const double cosine = std::clamp(dot(surface.normal, surface.to_eye), 0.0, 1.0);
        bent = scale(bent, 1 / own_index) +
               scale(surface.normal, cosine / own_index - std::sqrt(1 - (1 - cosine * cosine) / (own_index * own_index)));
    }
    const Vec3d out_of = surface.to_eye - scale(bent, 2 * dot(bent, surface.to_eye));
    const Vec3d exit = row3(block, kPosX, lane) + scale(bent, thick ? thickness : 0.0);
    const auto along = [&](const float(&row)[4]) {
        return double{row[0]} * exit.x + double{row[1]} * exit.y + double{row[2]} * exit.z + double{row[3]};
    };
    const double w = held(along(behind.w), 1e-30, 1e300), x = held(along(behind.x) / w, 0.0, double{behind.width}),
                 y = held(along(behind.y) / w, 0.0, double{behind.height});
    const double level = held(blur * double{behind.last_level}, 0.0, behind.levels - 1.0);
    const int low = std::clamp(static_cast<int>(level), 0, std::max(behind.levels - 2, 0));
    const Rgba fine = behind_level(behind, low, x, y), coarse = behind_level(behind, std::min(low + 1, behind.levels - 1), x, y);
    const auto between = [&](double a, double b) { return a + (level - low) * (b - a); };
    const double open = 1 - std::clamp(between(fine.a, coarse.a), 0.0, 1.0),
                 share = thick ? 1.0 : std::min(1.0, blur * double{kBehindFade});
    const Vec3d surroundings =
        around.diffuse != nullptr
            ? blurred(*around.reflections, out_of, MirrorTable(std::max(roughness * wide, kHeldRoughness), 1.0)(&ReflectionShape::level0))
            : hemisphere(frame.ambient, out_of.y);
    const Vec3d surfaces{between(fine.r, coarse.r), between(fine.g, coarse.g), between(fine.b, coarse.b)};
    return {surfaces + scale(surroundings, open * share), open * (1 - share)};
}

Through look_through(const FrameInputs& frame, const Material& material, const FragmentBlock& block, int lane, const Surface& surface,
                     double thickness, const Surroundings& around) {
    const double root = std::sqrt(std::min(std::clamp(double{material.dielectric_reflectance}, 0.0, 1.0), 0.9));
    const double index = (1 + root) / (1 - root);
    const double half_spread = std::min(index - 1, (index - 1) * 0.025 * held(double{material.dispersion}, 0.0, 1e6));
    const auto through = [&](double own_index) {
        return look_through_at(own_index, index, frame, material, block, lane, surface, thickness, around);
    };
    Through out = through(index);
    if (half_spread > 0) out.light.x = through(index - half_spread).light.x, out.light.z = through(index + half_spread).light.z;
    return out;
}

}  // namespace

Rgba shade(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
           const Surroundings& around) {
    const Rgba base = base_color(frame, material, available, block, lane);
    const double alpha = alpha_of(material, base.a);
    if (material.unlit) return {base.r, base.g, base.b, alpha};
    if (material.shadow_catcher)
        return {0, 0, 0, hidden_light(frame, material, available, block, lane, around) * std::clamp(base.a, 0.0, 1.0)};
    const Surface surface = surface_of(frame, material, available, block, lane);
    const Rgba glow = material_texture(frame, material.textures[TextureSlot::emissive], available, block, lane, {1, 1, 1, 1});
    const Vec3d position = row3(block, kPosX, lane);
    Vec3d color = lit(frame, material, surface, position, around);
    if (material.diffuse_transmission > 0.0f) color = color + light_through(frame, material, available, block, lane, surface, around);
    if (has_sheen(frame, material)) {
        const Fibres sheen = sheen_of(frame, material, available, block, lane, surface, around);
        color = scale(color, sheen.left) + sheen.light;
    }
    color = color + to_double(material.emissive * frame.options.emission_scale) * Vec3d{glow.r, glow.g, glow.b};
    if (has_coat(frame, material)) {
        const Coat coat = coat_of(frame, material, available, block, lane, surface);
        color =
            scale(color, 1.0 - coat.share * coat_fresnel(coat)) + scale(coat_light(frame, material, coat, position, around), coat.share);
    }
    if (around.behind != nullptr && material.transmits()) {
        const double thickness = thickness_of(frame, material, available, block, lane);
        color = color + passed_shares(frame, material, available, block, lane, surface, thickness, around) *
                            look_through(frame, material, block, lane, surface, thickness, around).light;
    }
    return {color.x, color.y, color.z, alpha};
}

Vec3d kept(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
           const Surroundings& around) {
    const double alpha = alpha_of(material, base_color(frame, material, available, block, lane).a);
    const Surface surface = surface_of(frame, material, available, block, lane);
    const double thickness = thickness_of(frame, material, available, block, lane);
    const Vec3d passed = passed_shares(frame, material, available, block, lane, surface, thickness, around);
    const double clear = look_through(frame, material, block, lane, surface, thickness, around).clear;
    const auto channel = [&](double share) { return std::clamp(1 - alpha + alpha * share * clear, 0.0, 1.0); };
    return {channel(passed.x), channel(passed.y), channel(passed.z)};
}

double srgb_code(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return 255.0 * (x <= kSrgbLinearEnd ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

}  // namespace halflit::shading::reference
