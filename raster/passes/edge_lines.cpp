#include "raster/passes/edge_lines.hpp"

#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kSkin = 1e-5;    ///< of the model's size: a surface so near before a line does not hide it
constexpr double kEdgeOn = 1e-7;  ///< sine of the angle to the viewer's ray below which a triangle is a line: it covers and faces nothing

/// A point in clip space, z from 0 at the far plane to w at the near plane, and in the world.
struct EdgePoint {
    double x, y, z, w;
    Vec3d at;
};

EdgePoint between(const EdgePoint& a, const EdgePoint& b, double t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, a.w + (b.w - a.w) * t, a.at + (b.at - a.at) * t};
}

/// Cuts the segment to where distance >= 0. False: nothing is left.
template <class Distance>
bool cut(EdgePoint& a, EdgePoint& b, const Distance& distance) {
    const double of_a = distance(a), of_b = distance(b);
    if (!(of_a >= 0.0 || of_b >= 0.0) || of_a != of_a || of_b != of_b) return false;
    const EdgePoint from = a, to = b;
    if (of_a < 0.0) a = between(from, to, of_a / (of_a - of_b));
    if (of_b < 0.0) b = between(from, to, of_a / (of_a - of_b));
    return true;
}

class EdgeView {
public:
    EdgeView(const ModelEdges& edges, const Camera& camera, const PixelTriangles& seen)
        : edges_(edges), seen_(seen), orthographic_(camera.orthographic) {
        clip_from_world_ = clip_from_world(camera, static_cast<float>(seen.width) / static_cast<float>(seen.height));
        back_ = axis(camera.world_from_camera, 2);
        eye_ = axis(camera.world_from_camera, 3);
        depth_ = depth_map(camera, static_cast<float>(seen.width) / static_cast<float>(seen.height));
        Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
        for (const Vec3d& p : edges.places()) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        size_ = edges.places().empty() ? 1.0 : length(high - low);
        skin_ = kSkin * size_;
    }

    /// 1: the triangle's front is seen, -1: its back, 0: its edge.
    [[nodiscard]] int facing(std::uint32_t face) const {
        const std::uint32_t* const c = edges_.corners(face);
        const Vec3d a = edges_.places()[c[0]], n = cross(edges_.places()[c[1]] - a, edges_.places()[c[2]] - a);
        const Vec3d to_eye = orthographic_ ? back_ : eye_ - a;
        const double along = dot(n, to_eye);
        if (is_edge_on(along, n, to_eye)) return 0;
        return along > 0.0 ? 1 : -1;
    }
    /// The edge is a line of the drawing, seen or hidden.
    [[nodiscard]] bool is_line(const ModelEdge& edge, EdgeChoice choice) const {
        if (choice == EdgeChoice::all || edge.kind == EdgeKind::border) return true;
        if (choice == EdgeChoice::feature && edge.kind == EdgeKind::crease) return true;
        const bool differ = (facing(edge.face[0]) > 0) != (facing(edge.face[1]) > 0);
        // Where one triangle is turned, one side of a surface that is drawn from one side ends here.
        return edge.turned ? !differ || edges_.single_sided(edge.face[0]) || edges_.single_sided(edge.face[1]) : differ;
    }
    /// All its triangles turn a side to the viewer that is not drawn.
    [[nodiscard]] bool turned_away(const ModelEdge& edge) const {
        const auto away = [&](std::uint32_t face) { return edges_.single_sided(face) && facing(face) < 0; };
        return away(edge.face[0]) && away(edge.face[1]);
    }
    /// The part of the edge between the near and the far plane and near the picture. False: there is none.
    [[nodiscard]] bool place(const ModelEdge& edge, EdgePoint& a, EdgePoint& b) const {
        a = point(edges_.places()[edge.from]), b = point(edges_.places()[edge.to]);
        constexpr double kBeside = 1.1;  // of the picture's half sides: lines have a width
        return cut(a, b, [](const EdgePoint& p) { return p.w - p.z; }) && cut(a, b, [](const EdgePoint& p) { return p.z; }) &&
               cut(a, b, [](const EdgePoint& p) { return kBeside * p.w - p.x; }) &&
               cut(a, b, [](const EdgePoint& p) { return kBeside * p.w + p.x; }) &&
               cut(a, b, [](const EdgePoint& p) { return kBeside * p.w - p.y; }) &&
               cut(a, b, [](const EdgePoint& p) { return kBeside * p.w + p.y; });
    }
    [[nodiscard]] double window_x(const EdgePoint& p) const { return (p.x / p.w * 0.5 + 0.5) * seen_.width; }
    [[nodiscard]] double window_y(const EdgePoint& p) const { return (0.5 - p.y / p.w * 0.5) * seen_.height; }

    /// A surface that is seen lies before this point of the edge. Triangles may be smaller than pixels, so that the one before the point is
    /// not among those that pixels' middles show: it is looked for from these, over the surface.
    [[nodiscard]] bool is_hidden(const EdgePoint& p, const ModelEdge& edge) const {
        const Vec3d eye = orthographic_ ? p.at + back_ * (2.0 * size_ + length(eye_ - p.at)) : eye_, ray = p.at - eye;
        const double before = 1.0 - skin_ / length(ray);
        // Beside the picture, the pixel at its rim.
        const int px = pixel(window_x(p), seen_.width), py = pixel(window_y(p), seen_.height);
        const Region& part = seen_.region;
        std::array<std::uint32_t, 9> looked_at;
        std::size_t count = 0;
        for (int y = std::max(py - 1, part.y); y <= std::min(py + 1, part.y + part.height - 1); ++y)
            for (int x = std::max(px - 1, part.x); x <= std::min(px + 1, part.x + part.width - 1); ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y - part.y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x - part.x);
                if (seen_.instance[at] == 0) continue;
                const std::uint32_t face = edges_.face(seen_.instance[at] - 1, seen_.triangle[at] - 1);
                if (face == ModelEdges::kNone || std::find(looked_at.begin(), looked_at.begin() + count, face) != looked_at.begin() + count)
                    continue;
                looked_at[count++] = face;
                if (hides(face, edge, eye, ray, before)) return true;
            }
        return false;
    }

private:
    [[nodiscard]] EdgePoint point(Vec3d p) const {
        const ClipPlace clip = clip_place(clip_from_world_, p);
        return {clip.x, clip.y, depth_.z_scale * dot(back_, p - eye_) + depth_.z_offset, clip.w, p};
    }
    static int pixel(double window, int size) { return static_cast<int>(window > 0.0 ? window < size ? window : size - 1 : 0.0); }
    /// along: the dot product of a triangle's normal and a ray, both of any length.
    static bool is_edge_on(double along, Vec3d normal, Vec3d ray) {
        return along * along <= kEdgeOn * kEdgeOn * (dot(normal, normal) * dot(ray, ray));
    }
    /// Beyond the near plane.
    [[nodiscard]] bool is_drawn(Vec3d p) const {
        const double z = dot(back_, p - eye_);
        return depth_.z_scale * z + depth_.z_offset <= (orthographic_ ? 1.0 : -z);
    }

    /// Where a ray meets a triangle's plane [MT97].
    struct Meeting {
        double t = -1.0;  ///< share of the ray's length
        int beyond = 0;   ///< the corner k at which the edge begins beyond which it is; -1: within the triangle
        int side = 0;     ///< of the triangle that it meets; 0: the edge
        int rim = -1;     ///< the corner k at which the edge begins that it passes outside of, nearer than rounding
    };
    [[nodiscard]] Meeting meet(std::uint32_t face, Vec3d eye, Vec3d ray) const {
        constexpr double kRim = -1e-9;
        const std::uint32_t* const c = edges_.corners(face);
        const Vec3d &a = edges_.places()[c[0]], e1 = edges_.places()[c[1]] - a, e2 = edges_.places()[c[2]] - a;
        const Vec3d from = eye - a, h = cross(ray, e2), q = cross(from, e1);
        const double scale = dot(e1, h);
        if (is_edge_on(scale, cross(e1, e2), ray)) return {};
        const double u = dot(from, h) / scale, v = dot(ray, q) / scale, w = (1.0 - u) - v;  // of corners 1, 2 and 0
        const int side = scale > 0.0 ? 1 : -1;
        const double t = dot(e2, q) / scale;
        const int nearest = w <= u && w <= v ? 1 : u <= v ? 2 : 0;
        if (w >= kRim && u >= kRim && v >= kRim) return {t, -1, side, w >= 0.0 && u >= 0.0 && v >= 0.0 ? -1 : nearest};
        return {t, nearest, side};
    }

    /// The surface around a triangle lies before the point, as far as it is seen from one side.
    [[nodiscard]] bool hides(std::uint32_t face, const ModelEdge& edge, Vec3d eye, Vec3d ray, double before) const {
        constexpr int kMostSteps = 16;
        int side = 0;
        for (int step = 0; step < kMostSteps && face != ModelEdges::kNone; ++step) {
            const Meeting met = meet(face, eye, ray);
            if (met.side == 0 || (step > 0 && met.side != side)) return false;
            side = met.side;
            if (met.rim >= 0) {
                // Where the surface goes on, the triangle beyond that edge has the point, or rounding has lost it. An outline has none.
                const std::uint32_t next = edges_.neighbour(face, met.rim);
                const Meeting beyond = next == ModelEdges::kNone ? Meeting{} : meet(next, eye, ray);
                if (beyond.side != side) return false;
                if (beyond.beyond < 0 && beyond.rim < 0) {
                    face = next;
                    continue;
                }
            }
            if (met.beyond < 0)
                return face != edge.face[0] && face != edge.face[1] && met.t > 0.0 && met.t < before && is_drawn(eye + ray * met.t);
            face = edges_.neighbour(face, met.beyond);
        }
        return false;
    }

    const ModelEdges& edges_;
    PixelTriangles seen_;
    bool orthographic_;
    Mat4 clip_from_world_;
    Vec3d back_, eye_;
    DepthMap depth_{};
    double size_ = 1.0, skin_ = 0.0;
};

/// An edge in the picture.
struct PlacedEdge {
    std::uint32_t edge;  ///< index into ModelEdges::edges()
    EdgePoint a, b;
    double length_px;
    double begin_px = 0.0;
    bool backward = false;  ///< its polyline runs from b to a
};

/// Parts of an edge that are seen, and hidden ones.
class EdgeSplitter {
public:
    /// drawn: pixels that the lines are for.
    EdgeSplitter(const EdgeView& view, const ModelEdges& edges, const Region& drawn, const Settings& settings)
        : view_(view),
          edges_(edges),
          drawn_(drawn),
          beside_(beside(settings.edge_width)),
          hidden_too_(settings.hidden_edges == HiddenEdges::dashed) {}

    /// Pixels beside those that are drawn in which a line is followed: half of its width, and a step at each end of a part.
    static double beside(double edge_width) { return 0.5 * (edge_width > 1.0 ? edge_width : 1.0) + 3.5; }

    void split(const PlacedEdge& placed, std::vector<EdgeLine>& lines) const {
        const ModelEdge& edge = edges_.edges()[placed.edge];
        const double x0 = view_.window_x(placed.a), y0 = view_.window_y(placed.a);
        const double x1 = view_.window_x(placed.b), y1 = view_.window_y(placed.b);
        double first = 0.0, last = 1.0;
        if (!narrow(x0 - drawn_.x, x1 - x0, drawn_.width, first, last) || !narrow(y0 - drawn_.y, y1 - y0, drawn_.height, first, last))
            return;
        const bool light = edges_.is_dark(edge);
        const auto add = [&](double t0, double t1, bool hidden) {
            if (hidden && !hidden_too_) return;
            if (placed.backward)
                lines.push_back({x1, y1, x0, y0, 1.0 - t1, 1.0 - t0, placed.begin_px, hidden, light});
            else
                lines.push_back({x0, y0, x1, y1, t0, t1, placed.begin_px, hidden, light});
        };
        if (view_.turned_away(edge)) {
            add(0.0, 1.0, true);
            return;
        }
        const int steps = std::max(1, static_cast<int>(std::min(placed.length_px, 1e5)));  // of a pixel
        const auto step_at = [&](double t) { return std::clamp(static_cast<int>(t * steps - 0.5), 0, steps - 1); };
        const auto hidden_at = [&](double t) { return view_.is_hidden(at(placed, t), edge); };
        const int begin_step = step_at(first), end_step = std::min(step_at(last) + 1, steps - 1);
        double begin = 0.0, before = (begin_step + 0.5) / steps;
        bool hidden = hidden_at(before);
        for (int i = begin_step + 1; i <= end_step; ++i) {
            const double t = (i + 0.5) / steps;
            if (hidden_at(t) != hidden) {
                double low = before, high = t;
                for (int halving = 0; halving < 4; ++halving) {
                    const double middle = 0.5 * (low + high);
                    (hidden_at(middle) == hidden ? low : high) = middle;
                }
                const double end = 0.5 * (low + high);
                add(begin, end, hidden);
                begin = end;
                hidden = !hidden;
            }
            before = t;
        }
        add(begin, 1.0, hidden);
    }

private:
    /// The point at a share of the edge's length in the picture.
    [[nodiscard]] static EdgePoint at(const PlacedEdge& e, double t) {
        const double along = t * e.a.w / (e.b.w + (e.a.w - e.b.w) * t);
        return between(e.a, e.b, along);
    }
    /// Cuts shares of a line's length to where from + share * run lies within [0, size], or little beside. False: nothing is left.
    [[nodiscard]] bool narrow(double from, double run, int size, double& first, double& last) const {
        const double low = -beside_ - from, high = size + beside_ - from;
        if (run == 0.0) return low <= 0.0 && high >= 0.0;
        first = std::max(first, (run > 0.0 ? low : high) / run);
        last = std::min(last, (run > 0.0 ? high : low) / run);
        return first <= last;
    }

    const EdgeView& view_;
    const ModelEdges& edges_;
    Region drawn_;
    double beside_;
    bool hidden_too_;
};

/// Edges that end at a place.
struct PlaceEnds {
    static constexpr std::uint32_t kNone = ~0u;
    std::uint32_t count = 0, edge[2] = {kNone, kNone};  ///< the first two, by their numbers in the picture
};

/// Joins edges that meet in pairs to polylines, so that dashes go on from one to the next.
void join_edges(const ModelEdges& edges, std::vector<PlacedEdge>& placed) {
    std::vector<PlaceEnds> ends(edges.places().size());
    const auto place_of = [&](std::uint32_t i, bool last) {
        const ModelEdge& edge = edges.edges()[placed[i].edge];
        return last ? edge.to : edge.from;
    };
    for (std::uint32_t i = 0; i < placed.size(); ++i)
        for (const bool last : {false, true}) {
            PlaceEnds& e = ends[place_of(i, last)];
            if (e.count < 2) e.edge[e.count] = i;
            ++e.count;
        }
    std::vector<bool> done(placed.size(), false);
    const auto follow = [&](std::uint32_t i, bool backward) {
        for (double length = 0.0; i != PlaceEnds::kNone && !done[i];) {
            done[i] = true;
            placed[i].begin_px = length;
            placed[i].backward = backward;
            length += placed[i].length_px;
            const std::uint32_t place = place_of(i, !backward);
            const PlaceEnds& e = ends[place];
            if (e.count != 2) return;
            i = e.edge[0] == i ? e.edge[1] : e.edge[0];
            backward = place_of(i, false) != place;
        }
    };
    for (std::uint32_t i = 0; i < placed.size(); ++i)
        for (const bool last : {false, true})
            if (!done[i] && ends[place_of(i, last)].count != 2) follow(i, last);
    for (std::uint32_t i = 0; i < placed.size(); ++i) follow(i, false);  // rings
}

/// Calls body(i, found) for each i below count, on all threads. Returns what was found, in the order of i; `memory` holds it.
template <class T, std::size_t kChunk, class Body>
std::vector<T> each_chunk(std::size_t count, Executor& executor, MemoryShare& memory, const Body& body) {
    struct Found {
        std::vector<T> items;
        MemoryShare memory;
    };
    std::vector<Found> found((count + kChunk - 1) / kChunk);
    executor.run(static_cast<int>(found.size()), [&](int chunk) {
        Found& of = found[static_cast<std::size_t>(chunk)];
        const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
        for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i) body(i, of.items);
        of.memory.hold(executor.stop(), of.items.capacity() * sizeof(T));
    });
    std::size_t sum = 0;
    for (const Found& some : found) sum += some.items.size();
    memory.hold(executor.stop(), sum * sizeof(T));
    std::vector<T> all;
    all.reserve(sum);
    for (Found& some : found) {
        all.insert(all.end(), some.items.begin(), some.items.end());
        some.items = {};
        some.memory.hold(executor.stop(), 0);
    }
    return all;
}

}  // namespace

Region seen_region(const Region& drawn, double edge_width, int width, int height) {
    const int beside = static_cast<int>(EdgeSplitter::beside(edge_width)) + 2;  // and the pixels around a point
    const int x = std::max(drawn.x - beside, 0), y = std::max(drawn.y - beside, 0);
    return {x, y, std::min(drawn.x + drawn.width + beside, width) - x, std::min(drawn.y + drawn.height + beside, height) - y};
}

std::vector<EdgeLine> edge_lines(const ModelEdges& edges, const Camera& camera, const PixelTriangles& seen, const Region& drawn,
                                 const Settings& settings, Executor& executor, MemoryShare& memory) {
    const EdgeView view(edges, camera, seen);
    const bool hidden_too = settings.hidden_edges == HiddenEdges::dashed;
    MemoryShare of_placed;
    auto placed = each_chunk<PlacedEdge, 2048>(edges.edges().size(), executor, of_placed, [&](std::size_t i, auto& found) {
        const ModelEdge& edge = edges.edges()[i];
        PlacedEdge at{static_cast<std::uint32_t>(i), {}, {}, 0.0};
        if (!view.is_line(edge, settings.edges) || (!hidden_too && view.turned_away(edge)) || !view.place(edge, at.a, at.b)) return;
        const double dx = view.window_x(at.b) - view.window_x(at.a), dy = view.window_y(at.b) - view.window_y(at.a);
        at.length_px = std::sqrt(dx * dx + dy * dy);
        if (at.length_px < 1e6) found.push_back(at);  // NaN where coordinates overflow, or meet the eye
    });
    if (hidden_too) {
        MemoryShare of_ends;
        of_ends.hold(executor.stop(), edges.places().size() * sizeof(PlaceEnds) + placed.size() / 8);
        join_edges(edges, placed);
    }

    const EdgeSplitter splitter(view, edges, drawn, settings);
    return each_chunk<EdgeLine, 64>(placed.size(), executor, memory,
                                    [&](std::size_t i, std::vector<EdgeLine>& split) { splitter.split(placed[i], split); });
}

}  // namespace halflit::raster
