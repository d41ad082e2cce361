// Fixed-function pictures: light at vertices, textures in codes, and the codes of fragments.
#pragma once

#include "raster/kernels/fixed_function_args.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/simd_records.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE F row4(const float (&row)[4], const V3& p) { return ((F(row[0]) * p.x + F(row[1]) * p.y) + F(row[2]) * p.z) + F(row[3]); }
HALFLIT_INLINE F hold_unit(F x) { return clamp(x, F(0.0f), F(1.0f)); }

/// t^n for t from 0 on to about 1, n >= 0; 0^0 is 1. The relative error is about n times 2^-22.
HALFLIT_INLINE F fixed_power(F t, F n) {
    const Log2 log = log2_parts(kLog2Degree7, t);
    return exp2_floored(kExp2Degree5, n * log.exponent + n * log.fraction);
}

/// Adds a light at vertices p with normals n; v: the way to the eye.
HALFLIT_INLINE void add_light(const FixedLightTerms& light, float shininess, const V3& p, const V3& n, const V3& v, F (&sum)[3]) {
    V3 to_light = broadcast(light.place);
    F strength(1.0f);
    if (!light.directional) {
        const V3 way = to_light - p;
        const F squared = dot(way, way), distance = vsqrt(squared);
        to_light = way * sel(squared > F(0.0f), vdiv(F(1.0f), distance), F(0.0f));
        strength = vdiv(F(1.0f), (F(light.attenuation[0]) + F(light.attenuation[1]) * distance) + F(light.attenuation[2]) * squared);
        if (light.cos_cutoff >= -1.0f) {
            const F along = vneg(dot(to_light, broadcast(light.axis)));
            const F cone = light.exponent == 0.0f ? F(1.0f) : fixed_power(vmax(along, F(0.0f)), F(light.exponent));
            strength = sel(along >= F(light.cos_cutoff), strength * cone, F(0.0f));
        }
    }
    const F facing = dot(n, to_light), diffuse = vmax(facing, F(0.0f));
    F highlight(0.0f);
    if ((light.specular[0] > 0.0f) | (light.specular[1] > 0.0f) | (light.specular[2] > 0.0f)) {
        const V3 half = normalize_any(to_light + v);
        highlight = sel(facing > F(0.0f), fixed_power(vmax(dot(n, half), F(0.0f)), F(shininess)), F(0.0f));
    }
    for (int k = 0; k < 3; ++k)
        sum[k] = sum[k] + strength * ((F(light.ambient[k]) + diffuse * F(light.diffuse[k])) + highlight * F(light.specular[k]));
}

HALFLIT_INLINE void fixed_vertices_at(const FixedVertexArgs& args, int first) {
    const float* at[kWidth];
    const auto read = [&](int offset, F& a, F& b, F& c, F& d) __attribute__((always_inline)) {
        for (int l = 0; l < kWidth; ++l) at[l] = args.raw + (first + l) * args.raw_stride + offset;
        load4(at, a, b, c, d);
    };
    V3 p, n;
    F u, v;
    read(0, p.x, p.y, p.z, n.x);
    read(4, n.y, n.z, u, v);
    n = normalize_any(n);
    const V3 view = normalize_any(broadcast(args.eye) - p);
    float* out = args.out + first * args.stride;
    if (args.separate) {
        for (int i = 0; i < args.light_count; ++i, out += 4) {
            F sum[3] = {F(args.color[0]), F(args.color[1]), F(args.color[2])};
            add_light(args.lights[i], args.shininess, p, n, view, sum);
            store4(out, args.stride, hold_unit(sum[0]), hold_unit(sum[1]), hold_unit(sum[2]), F(0.0f));
        }
        return;
    }
    F sum[3] = {F(args.color[0]), F(args.color[1]), F(args.color[2])}, alpha(args.color[3]);
    if (args.unlit) {
        F color[4];
        read(8, color[0], color[1], color[2], color[3]);
        for (int k = 0; k < 3; ++k) sum[k] = sum[k] * color[k];
        alpha = alpha * color[3];
    }
    for (int i = 0; i < args.light_count; ++i) add_light(args.lights[i], args.shininess, p, n, view, sum);
    F third(0.0f);
    u = u * F(args.uv_scale[0]), v = v * F(args.uv_scale[1]);
    if (args.generated) {
        u = row4(args.planes[0], p);
        v = row4(args.planes[1], p);
        third = row4(args.planes[2], p);
    }
    store4(out, args.stride, p.x, p.y, p.z, row4(args.depth, p));
    store4(out + 4, args.stride, F(0.0f), F(0.0f), u, v);
    store4(out + 8, args.stride, hold_unit(sum[0]), hold_unit(sum[1]), hold_unit(sum[2]), hold_unit(alpha));
    if (args.textured) store4(out + 12, args.stride, third, row4(args.clip_w, p), F(0.0f), F(0.0f));
}

inline void fixed_vertices(const FixedVertexArgs& args) {
    for (int i = 0; i < args.count; i += kWidth) fixed_vertices_at(args, i);
}

template <int kChannel>
HALFLIT_INLINE I channel_of(I texel) {
    return shr<8 * kChannel>(texel) & I(0xff);
}

/// a + (b - a) w / 256, rounded as Mesa's filter of codes does.
HALFLIT_INLINE I lerp_codes(I a, I b, I w) { return a + shr<8>(w * (b - a) + I(128)); }

template <int kChannel>
HALFLIT_INLINE I bilinear_codes(const I (&texel)[4], I along, I down) {
    const auto code = [&](int k) __attribute__((always_inline)) { return channel_of<kChannel>(texel[k]); };
    return lerp_codes(lerp_codes(code(0), code(1), along), lerp_codes(code(2), code(3), along), down);
}

template <int kChannel>
HALFLIT_INLINE F bilinear_numbers(const CodeLevels& levels, const I (&texel)[4], F along, F down) {
    const auto number = [&](int k) __attribute__((always_inline)) { return gather(levels.decoded, channel_of<kChannel>(texel[k])); };
    const F top = mad(along, number(1) - number(0), number(0)), low = mad(along, number(3) - number(2), number(2));
    return mad(down, low - top, top);
}

/// Place along one side of a level, in 1/256 texel from the middle of the first one, and the two texels around it in a row that repeats.
struct CodeAxis {
    I first, second, part;
};
HALFLIT_INLINE CodeAxis code_axis(F coordinate, I size, bool power_of_two) {
    const F scale = to_float(size) * F(256.0f);
    CodeAxis axis;
    if (power_of_two) {
        const I place = round_even(clamp(coordinate * scale, F(-1e9f), F(1e9f))) - I(128);
        axis.part = place & I(255);
        axis.first = shr<8>(place) & (size - I(1));
        axis.second = (axis.first + I(1)) & (size - I(1));
        return axis;
    }
    const I place = round_even(clamp((coordinate - vfloor(coordinate)) * scale, F(0.0f), scale)) - I(128);
    axis.part = place & I(255);
    axis.first = shr<8>(place);
    axis.second = axis.first + I(1);
    axis.first = sel(less(axis.first, I(0)), size - I(1), vmin(axis.first, size - I(1)));
    axis.second = sel(less(axis.second, size), axis.second, I(0));
    return axis;
}

/// Coordinates of a lane at all levels: u and v of the texture, or of a cube's face.
struct CodePlace {
    F u, v;
    I face;
};

/// A level's colour at a place: in codes, as whole numbers, or in numbers. Two calls in line would be 10 kB of code.
[[gnu::noinline]] static void level_color(const CodeLevels& levels, const CodePlace& place, I level, I (&codes)[3], F (&numbers)[3]) {
    const I width = gather(levels.width, level), height = gather(levels.height, level), first = gather(levels.first, level);
    I texel[4];
    F along, down;
    if (levels.cube) {
        const F size = to_float(width), s = place.u * size + F(0.5f),
                t = place.v * size + F(0.5f);  // in texels of the face with its border
        const F left = clamp(vfloor(s), F(0.0f), size), top = clamp(vfloor(t), F(0.0f), size);
        along = s - left, down = t - top;
        const I pitch = width + I(2), at = first + (place.face * pitch + round_to_int(top)) * pitch + round_to_int(left);
        const I index[4] = {at, at + I(1), at + pitch, at + pitch + I(1)};
        for (int k = 0; k < 4; ++k) texel[k] = gather(levels.texels, index[k]);
    } else {
        const auto is_power = [](std::int32_t size) { return (size & (size - 1)) == 0; };
        const CodeAxis x = code_axis(place.u, width, is_power(levels.width[0])), y = code_axis(place.v, height, is_power(levels.height[0]));
        const I index[4] = {first + y.first * width + x.first, first + y.first * width + x.second, first + y.second * width + x.first,
                            first + y.second * width + x.second};
        for (int k = 0; k < 4; ++k) texel[k] = gather(levels.texels, index[k]);
        if (levels.in_codes) {
            codes[0] = bilinear_codes<0>(texel, x.part, y.part);
            codes[1] = bilinear_codes<1>(texel, x.part, y.part);
            codes[2] = bilinear_codes<2>(texel, x.part, y.part);
            return;
        }
        along = to_float(x.part) * F(1.0f / 256.0f), down = to_float(y.part) * F(1.0f / 256.0f);
    }
    numbers[0] = bilinear_numbers<0>(levels, texel, along, down);
    numbers[1] = bilinear_numbers<1>(levels, texel, along, down);
    numbers[2] = bilinear_numbers<2>(levels, texel, along, down);
}

/// A direction's face, and the place on it with its changes.
HALFLIT_INLINE CodePlace cube_place(const V3& d, const V3 (&step)[2], F (&du)[2], F (&dv)[2]) {
    const F ax = vabs(d.x), ay = vabs(d.y), az = vabs(d.z);
    const M is_z = az >= vmax(ax, ay), is_x = ax > ay;
    const F none(0.0f);
    const auto choose = [&](F x, F y, F z) __attribute__((always_inline)) { return sel(is_z, z, sel(is_x, x, y)); };
    const F major = choose(d.x, d.y, d.z);
    const M low = major < none;
    const auto flip = [&](F x) __attribute__((always_inline)) { return sel(low, none - x, x); };
    // OpenGL's table of faces: s and t over the magnitude of the largest coordinate.
    const auto across = [&](const V3& of) __attribute__((always_inline)) { return choose(none - flip(of.z), of.x, flip(of.x)); };
    const auto down = [&](const V3& of) __attribute__((always_inline)) { return choose(none - of.y, flip(of.z), none - of.y); };
    const F size = vmax(vabs(major), F(1e-30f)), inv = vdiv(F(1.0f), size);
    const F s = across(d) * inv, t = down(d) * inv;
    for (int k = 0; k < 2; ++k) {
        const F along = flip(choose(step[k].x, step[k].y, step[k].z));
        du[k] = ((across(step[k]) - s * along) * inv) * F(0.5f);
        dv[k] = ((down(step[k]) - t * along) * inv) * F(0.5f);
    }
    const I base = sel(is_z, I(4), sel(is_x, I(0), I(2)));
    return {s * F(0.5f) + F(0.5f), t * F(0.5f) + F(0.5f), base + sel(low, I(1), I(0))};
}

/// A coordinate about a pixel: it and 1 / w are linear in the window after a division by w.
struct Around {
    F value, right, down;  ///< it, and the changes of it over w, times w
    F w_right, w_down;     ///< of 1 / w, times w
    [[nodiscard]] HALFLIT_INLINE F at(F x, F y) const { return vdiv(value + (x * right + y * down), F(1.0f) + (x * w_right + y * w_down)); }
};

/// Levels are chosen from changes between pixels of squares of 2 x 2, as Mesa does: in pictures once a square, in cubes once a row and
/// column of it. Squares are counted from the lower left corner of the picture.
inline void code_texels(const TexelArgs& args, TexelRows& out) {
    using namespace shading;
    const CodeLevels& levels = *args.levels;
    const FragmentBlock& block = *args.block;
    const float most = static_cast<float>(levels.count - 1);
    for (int at = 0; at < args.count; at += kWidth) {
        const F inv_w = vdiv(F(1.0f), row(block, kV1, at));
        const F w_right = vneg(row(block, kDv1Dx, at) * inv_w), w_down = vneg(row(block, kDv1Dy, at) * inv_w);
        const auto around = [&](int of, int dx, int dy) __attribute__((always_inline)) {
            const F value = row(block, of, at);
            return Around{value, row(block, dx, at) + value * w_right, row(block, dy, at) + value * w_down, w_right, w_down};
        };
        const Around u = around(kU0, kDu0Dx, kDu0Dy), v = around(kV0, kDv0Dx, kDv0Dy);
        // From the pixel to the lower left one of its square.
        const I px = load(args.x_px + at), py = I(args.height - 1) - load(args.y_px + at);
        const F left = to_float(I(0) - (px & I(1))), low = to_float(py & I(1)), one(1.0f), none(0.0f);
        F du[2], dv[2];
        CodePlace place{u.value, v.value, I(0)};
        if (levels.cube) {
            const Around r = around(kU1, kDu1Dx, kDu1Dy);
            const auto step_x = [&](const Around& of) __attribute__((always_inline)) {
                return of.at(left + one, none) - of.at(left, none);
            };
            const auto step_y = [&](const Around& of) __attribute__((always_inline)) { return of.at(none, low - one) - of.at(none, low); };
            const V3 step[2] = {{step_x(u), step_x(v), step_x(r)}, {step_y(u), step_y(v), step_y(r)}};
            place = cube_place({u.value, v.value, r.value}, step, du, dv);
        } else {
            const F u0 = u.at(left, low), v0 = v.at(left, low);
            du[0] = u.at(left + one, low) - u0, dv[0] = v.at(left + one, low) - v0;
            du[1] = u.at(left, low - one) - u0, dv[1] = v.at(left, low - one) - v0;
        }
        const F w(static_cast<float>(levels.width[0])), h(static_cast<float>(levels.height[0]));
        F squared[2];
        for (int k = 0; k < 2; ++k) {
            const F x = du[k] * w, y = dv[k] * h;
            squared[k] = x * x + y * y;
        }
        // Half of the logarithm, as a straight line from a power of two to the next.
        const I rho = bits(clamp(vmax(squared[0], squared[1]), F(1e-30f), F(1e30f)));
        const F exponent = to_float(shr<23>(rho) - I(127)), mantissa = from_bits((rho & I(0x7fffff)) | I(0x3f800000));
        const F lod = clamp((exponent + (mantissa - one)) * F(0.5f), none, F(most));
        const F fine = vfloor(lod), part = lod - fine;
        I codes[3] = {I(0), I(0), I(0)}, next_codes[3] = {I(0), I(0), I(0)};
        F rgb[3] = {none, none, none}, next[3] = {none, none, none};
        level_color(levels, place, round_to_int(fine), codes, rgb);
        const bool between = any(part > none);
        if (between) level_color(levels, place, round_to_int(vmin(fine + one, F(most))), next_codes, next);
        const I share = round_to_int(vfloor(part * F(256.0f)));
        for (int c = 0; c < 3; ++c) {
            if (levels.in_codes)
                rgb[c] = gather(levels.decoded, between ? lerp_codes(codes[c], next_codes[c], share) : codes[c]);
            else if (between)
                rgb[c] = mad(part, next[c] - rgb[c], rgb[c]);
            store(out.rgb[c] + at, rgb[c]);
        }
    }
}

inline void fixed_codes(const CodeArgs& args) {
    for (int at = 0; at < args.count; at += kWidth) {
        const auto code = [](F x) __attribute__((always_inline)) { return round_to_int(hold_unit(x) * F(255.0f)); };
        F share(1.0f);
        if (args.depth != nullptr) share = hold_unit((F(args.fog_end) - load(args.depth + at)) * F(args.fog_scale));
        I packed = args.light[3] != nullptr ? shl<24>(code(load(args.light[3] + at))) : I(0);
        for (int c = 0; c < 3; ++c) {
            F x = load(args.light[c] + at);
            if (args.texels != nullptr) x = x * load(args.texels->rgb[c] + at);
            if (args.depth != nullptr) x = mad(share, x - F(args.fog_color[c]), F(args.fog_color[c]));
            const I value = code(x);
            packed = packed | (c == 0 ? value : c == 1 ? shl<8>(value) : shl<16>(value));
        }
        store(reinterpret_cast<std::int32_t*>(args.codes) + at, packed);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
