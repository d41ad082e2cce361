#include "raster/passes/quads.hpp"

#include "raster/passes/clip.hpp"

#include <array>

namespace halflit::raster {
namespace {

struct Offset {
    std::int32_t x, y;
};

/// From the middle of a line to its side, half its width away, rounded to the window's grid; 0 if the line has no length.
Offset side_offset(const ScreenVertex& a, const ScreenVertex& b, int width) {
    const double x = static_cast<double>(b.x) - a.x, y = static_cast<double>(b.y) - a.y, squared = x * x + y * y;
    if (!(squared > 0.0)) return {0, 0};
    const double scale = 0.5 * width / __builtin_sqrt(squared);
    return {static_cast<std::int32_t>(__builtin_lrint(-y * scale)), static_cast<std::int32_t>(__builtin_lrint(x * scale))};
}

ScreenVertex moved(const ScreenVertex& v, std::int32_t x, std::int32_t y) { return {v.x + x, v.y + y, v.z, v.inv_w}; }

/// The vertex nearer to the viewer, so that the line lies before the surfaces that it lies on.
ScreenVertex lifted(ScreenVertex v, const View& view) {
    v.z = v.z * view.line_depth_scale + view.line_depth_offset;
    return v;
}

void expand_line(const ScreenVertex& first, const ScreenVertex& second, const View& view, ScreenVertex* out) {
    const ScreenVertex a = lifted(first, view), b = lifted(second, view);
    const Offset side = side_offset(a, b, view.line_width);
    out[0] = moved(a, side.x, side.y);
    out[1] = moved(a, -side.x, -side.y);
    out[2] = moved(b, -side.x, -side.y);
    out[3] = moved(b, side.x, side.y);
}

void expand_point(const ScreenVertex& v, int size, ScreenVertex* out) {
    const std::int32_t low = -(size / 2), high = low + size;
    out[0] = moved(v, low, low);
    out[1] = moved(v, high, low);
    out[2] = moved(v, high, high);
    out[3] = moved(v, low, high);
}

constexpr auto kQuadIndices = [] {
    std::array<std::uint32_t, 6 * kQuadsAtOnce> index{};
    constexpr std::uint32_t kCorners[6] = {0, 2, 1, 0, 3, 2};
    for (std::uint32_t i = 0; i < index.size(); ++i) index[i] = 4 * (i / 6) + kCorners[i % 6];
    return index;
}();

}  // namespace

const std::uint32_t* quad_indices() { return kQuadIndices.data(); }

void transform_quads(const RasterKernels& kernels, const TransformArgs& args, const Draw& draw, const View& view) {
    // Outcodes of the middle that hold for the whole quad: those of the planes of depth, and those of vertices that cannot be drawn.
    constexpr std::uint8_t kKept = kBeyondFar | kNear | kGuard | kNotFinite;
    ScreenVertex screen[kVertexGroup];
    std::uint8_t codes[kVertexGroup];
    for (std::int64_t first = args.begin; first < args.end; first += kVertexGroup) {
        TransformArgs group = args;
        const std::int64_t left = args.end - first, count = left < kVertexGroup ? left : kVertexGroup;
        group.positions = args.positions + 3 * first;
        group.begin = 0;
        group.end = count;
        group.screen = screen;
        group.outcodes = codes;
        kernels.transform(group);
        ScreenVertex* out = args.screen + (first << draw.vertex_shift());
        std::uint8_t* out_codes = args.outcodes + (first << draw.vertex_shift());
        if (draw.topology == Topology::points) {
            for (std::int64_t i = 0; i < count; ++i) {
                expand_point(screen[i], view.point_sizes.empty() ? view.point_size : view.point_sizes.at(screen[i].x, screen[i].y),
                             out + 4 * i);
                for (int k = 0; k < 4; ++k) out_codes[4 * i + k] = codes[i] & kKept;
            }
            continue;
        }
        for (std::int64_t i = 0; i + 1 < count; i += 2) {
            const std::uint8_t a = codes[i] & kKept, b = codes[i + 1] & kKept;
            if (((a | b) & (kNear | kGuard | kNotFinite)) == 0)
                expand_line(screen[i], screen[i + 1], view, out + 2 * i);
            else
                for (int k = 0; k < 4; ++k) out[2 * i + k] = {};
            for (int k = 0; k < 4; ++k) out_codes[2 * i + k] = k < 2 ? a : b;
        }
    }
}

bool clip_line(const double (&clip)[2][4], const View& view, ClippedLine& out) {
    const Viewport& v = view.viewport;
    double from = 0.0, to = 1.0;
    const auto plane = [&](auto distance) {
        const double a = distance(clip[0]), b = distance(clip[1]);
        if (!(a >= 0.0) && !(b >= 0.0)) to = -1.0;
        if ((a >= 0.0) == (b >= 0.0)) return;
        const double t = a / (a - b);
        if (a >= 0.0)
            to = t < to ? t : to;
        else
            from = t > from ? t : from;
    };
    plane([](const double(&c)[4]) { return c[3] - c[2]; });
    plane([](const double(&c)[4]) { return c[3] - 1e-300; });
    plane([&](const double(&c)[4]) { return static_cast<double>(v.guard_x) * c[3] - c[0]; });
    plane([&](const double(&c)[4]) { return static_cast<double>(v.guard_x) * c[3] + c[0]; });
    plane([&](const double(&c)[4]) { return static_cast<double>(v.guard_y) * c[3] - c[1]; });
    plane([&](const double(&c)[4]) { return static_cast<double>(v.guard_y) * c[3] + c[1]; });
    if (!(from < to)) return false;
    ScreenVertex end[2];
    out.weight[0] = from;
    out.weight[1] = to;
    for (int k = 0; k < 2; ++k) {
        double at[4];
        for (int i = 0; i < 4; ++i) at[i] = clip[0][i] + (clip[1][i] - clip[0][i]) * out.weight[k];
        if (!(at[3] > 0.0)) return false;
        end[k] = project(at, v);
        // A rounding may leave a cut end just outside.
        const auto limit = [](std::int32_t x, float half) {
            const auto middle = static_cast<std::int32_t>(half * 256.0f), most = middle + 256 * kGuardBandPx,
                       least = middle - 256 * kGuardBandPx;
            return x < least ? least : x > most ? most : x;
        };
        end[k].x = limit(end[k].x, v.half_width);
        end[k].y = limit(end[k].y, v.half_height);
    }
    expand_line(end[0], end[1], view, out.corner);
    return true;
}

}  // namespace halflit::raster
