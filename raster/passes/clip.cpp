#include "raster/passes/clip.hpp"

namespace halflit::raster {
namespace {

/// Signed distance to a plane, >= 0 inside.
double distance(int plane, const double (&c)[4], const Viewport& v) {
    switch (plane) {
        case 0:
            return c[3] - c[2];
        case 1:
            return static_cast<double>(v.guard_x) * c[3] - c[0];
        case 2:
            return static_cast<double>(v.guard_x) * c[3] + c[0];
        case 3:
            return static_cast<double>(v.guard_y) * c[3] - c[1];
        default:
            return static_cast<double>(v.guard_y) * c[3] + c[1];
    }
}

PolygonVertex cross_point(const PolygonVertex& in, const PolygonVertex& out, double d_in, double d_out) {
    const double t = d_in / (d_in - d_out);
    PolygonVertex p;
    for (int i = 0; i < 4; ++i) p.clip[i] = in.clip[i] + (out.clip[i] - in.clip[i]) * t;
    for (int i = 0; i < 3; ++i) p.weight[i] = in.weight[i] + (out.weight[i] - in.weight[i]) * t;
    p.corner = -1;
    return p;
}

}  // namespace

int clip_triangle(const float (&clip)[3][4], unsigned codes, const Viewport& viewport, PolygonVertex (&polygon)[kMaxPolygon]) {
    int n = 3;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 4; ++i) polygon[k].clip[i] = clip[k][i];
        for (int i = 0; i < 3; ++i) polygon[k].weight[i] = i == k ? 1.0 : 0.0;
        polygon[k].corner = k;
    }
    const int first = (codes & kNear) ? 0 : 1, last = (codes & (kGuard | kNear)) ? 4 : 0;
    for (int plane = first; plane <= last && n > 0; ++plane) {
        double d[kMaxPolygon];
        bool any_out = false;
        for (int k = 0; k < n; ++k) {
            d[k] = distance(plane, polygon[k].clip, viewport);
            any_out |= !(d[k] >= 0.0);
        }
        if (!any_out) continue;
        PolygonVertex kept[kMaxPolygon];
        int m = 0;
        for (int k = 0; k < n; ++k) {
            const int next = (k + 1) % n;
            const bool in = d[k] >= 0.0, next_in = d[next] >= 0.0;
            if (in) kept[m++] = polygon[k];
            if (in && !next_in) kept[m++] = cross_point(polygon[k], polygon[next], d[k], d[next]);
            if (!in && next_in) kept[m++] = cross_point(polygon[next], polygon[k], d[next], d[k]);
        }
        for (int k = 0; k < m; ++k) polygon[k] = kept[k];
        n = m;
    }
    return n < 3 ? 0 : n;
}

ScreenVertex project(const double (&clip)[4], const Viewport& viewport) {
    const double inv_w = 1.0 / clip[3];
    const double x = clip[0] * inv_w * viewport.half_width + viewport.half_width;
    const double y = -(clip[1] * inv_w) * viewport.half_height + viewport.half_height;
    // Held to the guard band: where coordinates are around 1e16, rounding can put a cut corner far outside.
    const auto snapped = [](double window, double half) {
        const double place = (window - 0.5) * 256.0, least = (half - kGuardBandPx - 0.5) * 256.0,
                     most = (half + kGuardBandPx - 0.5) * 256.0;
        return static_cast<std::int32_t>(__builtin_lrint(place > least ? place < most ? place : most : least));
    };
    return {snapped(x, static_cast<double>(viewport.half_width)), snapped(y, static_cast<double>(viewport.half_height)),
            static_cast<float>(clip[2] * inv_w), static_cast<float>(inv_w < 3e38 ? inv_w : 3e38)};
}

}  // namespace halflit::raster
