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
            F sum[3] = {F(0.0f), F(0.0f), F(0.0f)};
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
    if (args.generated) {
        u = row4(args.planes[0], p);
        v = row4(args.planes[1], p);
        third = row4(args.planes[2], p);
    }
    store4(out, args.stride, p.x, p.y, p.z, row4(args.depth, p));
    store4(out + 4, args.stride, F(0.0f), F(0.0f), u, v);
    store4(out + 8, args.stride, hold_unit(sum[0]), hold_unit(sum[1]), hold_unit(sum[2]), hold_unit(alpha));
    if (args.third) store4(out + 12, args.stride, third, F(0.0f), F(0.0f), F(0.0f));
}

inline void fixed_vertices(const FixedVertexArgs& args) {
    for (int i = 0; i < args.count; i += kWidth) fixed_vertices_at(args, i);
}

/// A texture's colour at (s, t) of a level, in texels from the first texel's middle on. row: texels from a row to the next.
struct BilinearTexels {
    I index[4];
    F along, down;
};

HALFLIT_INLINE void bilinear(const CodeLevels& levels, const BilinearTexels& of, F (&rgb)[3]) {
    I texel[4];
    for (int k = 0; k < 4; ++k) texel[k] = gather(levels.texels, of.index[k]);
    const I byte(0xff);
    for (int c = 0; c < 3; ++c) {
        F value[4];
        for (int k = 0; k < 4; ++k) {
            const I code = c == 0 ? texel[k] & byte : c == 1 ? shr<8>(texel[k]) & byte : shr<16>(texel[k]) & byte;
            value[k] = gather(levels.decoded, code);
        }
        const F top = mad(of.along, value[1] - value[0], value[0]), low = mad(of.along, value[3] - value[2], value[2]);
        rgb[c] = mad(of.down, low - top, top);
    }
}

/// Texel x of a row that repeats: a whole number, as a float; size: of the row.
HALFLIT_INLINE F wrapped(F x, F size) {
    const F turns = vfloor(vdiv(x, size));
    const F in_row = x - turns * size;
    return vmin(vmax(in_row, F(0.0f)), size - F(1.0f));
}

/// Coordinates of a lane at all levels: u and v of the texture, or of a cube's face.
struct CodePlace {
    F u, v;
    I face;
};

HALFLIT_INLINE void level_color(const CodeLevels& levels, const CodePlace& place, I level, F (&rgb)[3]) {
    const I width = gather(levels.width, level), height = gather(levels.height, level), first = gather(levels.first, level);
    const F w = to_float(width), h = to_float(height);
    BilinearTexels of;
    if (levels.cube) {
        const F s = place.u * w + F(0.5f), t = place.v * h + F(0.5f);  // in texels of the face with its border
        const F left = clamp(vfloor(s), F(0.0f), w), top = clamp(vfloor(t), F(0.0f), h);
        of.along = s - left;
        of.down = t - top;
        const I pitch = width + I(2);
        of.index[0] = first + (place.face * pitch + round_to_int(top)) * pitch + round_to_int(left);
        of.index[1] = of.index[0] + I(1);
        of.index[2] = of.index[0] + pitch;
        of.index[3] = of.index[2] + I(1);
    } else {
        const F s = place.u * w - F(0.5f), t = place.v * h - F(0.5f);
        const F left = vfloor(s), top = vfloor(t);
        of.along = s - left;
        of.down = t - top;
        const I x[2] = {round_to_int(wrapped(left, w)), round_to_int(wrapped(left + F(1.0f), w))};
        const I y[2] = {round_to_int(wrapped(top, h)), round_to_int(wrapped(top + F(1.0f), h))};
        for (int k = 0; k < 4; ++k) of.index[k] = first + y[k >> 1] * width + x[k & 1];
    }
    bilinear(levels, of, rgb);
}

/// A direction's face, and the place on it with its changes per pixel.
HALFLIT_INLINE CodePlace cube_place(const V3& d, const V3 (&step)[2], F (&du)[2], F (&dv)[2]) {
    const F ax = vabs(d.x), ay = vabs(d.y), az = vabs(d.z);
    const M is_x = (ax >= ay) & (ax >= az), is_y = (ay >= az);
    const F none(0.0f);
    const auto choose = [&](F x, F y, F z) __attribute__((always_inline)) { return sel(is_x, x, sel(is_y, y, z)); };
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
    const I base = sel(is_x, I(0), sel(is_y, I(2), I(4)));
    return {s * F(0.5f) + F(0.5f), t * F(0.5f) + F(0.5f), base + sel(low, I(1), I(0))};
}

/// Colours at fragments, whose coordinates and their changes are in the rows for both sets: u, v, and the third coordinate as kU1.
inline void code_texels(const CodeLevels& levels, const shading::FragmentBlock& block, int count, TexelRows& out) {
    using namespace shading;
    const float most = static_cast<float>(levels.count - 1);
    for (int at = 0; at < count; at += kWidth) {
        F du[2] = {row(block, kDu0Dx, at), row(block, kDu0Dy, at)}, dv[2] = {row(block, kDv0Dx, at), row(block, kDv0Dy, at)};
        CodePlace place{row(block, kU0, at), row(block, kV0, at), I(0)};
        if (levels.cube) {
            const V3 step[2] = {{du[0], dv[0], row(block, kDu1Dx, at)}, {du[1], dv[1], row(block, kDu1Dy, at)}};
            place = cube_place({place.u, place.v, row(block, kU1, at)}, step, du, dv);
        }
        const F w(static_cast<float>(levels.width[0])), h(static_cast<float>(levels.height[0]));
        F squared[2];
        for (int k = 0; k < 2; ++k) {
            const F x = du[k] * w, y = dv[k] * h;
            squared[k] = x * x + y * y;
        }
        // From 2^-126 on: the logarithm of less is not used.
        const F rho = clamp(vmax(squared[0], squared[1]), F(1e-30f), F(1e30f));
        const Log2 log = log2_parts(kLog2Degree5, rho);
        const F lod = clamp((log.exponent + log.fraction) * F(0.5f), F(0.0f), F(most));
        const F fine = vfloor(lod), part = lod - fine;
        // Coordinates so large that a float has no fraction show some texel.
        place.u = clamp(place.u, F(-4e6f), F(4e6f));
        place.v = clamp(place.v, F(-4e6f), F(4e6f));
        F rgb[3], next[3];
        level_color(levels, place, round_to_int(fine), rgb);
        if (any(part > F(0.0f))) {
            level_color(levels, place, round_to_int(vmin(fine + F(1.0f), F(most))), next);
            for (int c = 0; c < 3; ++c) rgb[c] = mad(part, next[c] - rgb[c], rgb[c]);
        }
        for (int c = 0; c < 3; ++c) store(out.rgb[c] + at, rgb[c]);
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
