#include "raster/passes/edge_lines.hpp"

#include "raster/view/projection.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kSkin = 1e-5;  ///< of the model's size: a surface so near before a line does not hide it

/// A point in clip space without its depth, and in the world.
struct EdgePoint {
    double x, y, w;
    Vec3d at;
};

EdgePoint between(const EdgePoint& a, const EdgePoint& b, double t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.w + (b.w - a.w) * t, a.at + (b.at - a.at) * t};
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
    EdgeView(const ModelEdges& edges, const Camera& camera, const SeenTriangles& seen)
        : edges_(edges), seen_(seen), orthographic_(camera.orthographic) {
        const Mat4 m = clip_from_world(camera, static_cast<float>(seen.width) / static_cast<float>(seen.height));
        for (std::size_t i = 0; i < 4; ++i) columns_[i] = {m.c[i].x, m.c[i].y, m.c[i].w};
        const Vec4f &back = camera.world_from_camera.c[2], &eye = camera.world_from_camera.c[3];
        back_ = {back.x, back.y, back.z};
        eye_ = {eye.x, eye.y, eye.z};
        near_w_ = camera.orthographic ? 0.0 : larger_near(camera.near_z);
        Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
        for (const Vec3d& p : edges.places()) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        size_ = edges.places().empty() ? 1.0 : length(high - low);
        skin_ = kSkin * size_;
    }

    [[nodiscard]] bool faces_viewer(std::uint32_t face) const {
        const std::uint32_t* const c = edges_.corners(face);
        const Vec3d a = edges_.places()[c[0]], n = cross(edges_.places()[c[1]] - a, edges_.places()[c[2]] - a);
        return dot(n, orthographic_ ? back_ : eye_ - a) > 0.0;
    }
    /// The edge is a line of the drawing, seen or hidden.
    [[nodiscard]] bool is_line(const ModelEdge& edge, EdgeChoice choice) const {
        if (choice == EdgeChoice::all || edge.kind == EdgeKind::border) return true;
        if (choice == EdgeChoice::feature && edge.kind == EdgeKind::crease) return true;
        return faces_viewer(edge.face[0]) != faces_viewer(edge.face[1]);
    }
    /// All its triangles turn a side to the viewer that is not drawn.
    [[nodiscard]] bool turned_away(const ModelEdge& edge) const {
        const auto away = [&](std::uint32_t face) { return edges_.single_sided(face) && !faces_viewer(face); };
        return away(edge.face[0]) && away(edge.face[1]);
    }
    /// The part of the edge before the viewer and near the picture. False: there is none.
    [[nodiscard]] bool place(const ModelEdge& edge, EdgePoint& a, EdgePoint& b) const {
        a = point(edges_.places()[edge.from]), b = point(edges_.places()[edge.to]);
        constexpr double kBeside = 1.1;  // of the picture's half sides: lines have a width
        return cut(a, b, [&](const EdgePoint& p) { return p.w - near_w_; }) &&
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
        const int px = static_cast<int>(std::floor(window_x(p))), py = static_cast<int>(std::floor(window_y(p)));
        std::array<std::uint32_t, 9> looked_at;
        std::size_t count = 0;
        for (int y = std::max(py - 1, 0); y <= std::min(py + 1, seen_.height - 1); ++y)
            for (int x = std::max(px - 1, 0); x <= std::min(px + 1, seen_.width - 1); ++x) {
                const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(seen_.width) + static_cast<std::size_t>(x);
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
    static double larger_near(float near_z) { return near_z > 0.0f && near_z < 1e30f ? near_z : 1e-6; }

    [[nodiscard]] EdgePoint point(Vec3d p) const {
        const Vec3d clip = ((columns_[0] * p.x + columns_[1] * p.y) + columns_[2] * p.z) + columns_[3];
        return {clip.x, clip.y, clip.z, p};
    }

    /// Where a ray meets a triangle's plane [MT97].
    struct Meeting {
        double t = -1.0;  ///< share of the ray's length
        int beyond = 0;   ///< the corner k at which the edge begins beyond which it is; -1: within the triangle
        int side = 0;     ///< of the triangle that it meets; 0: it has none
    };
    [[nodiscard]] Meeting meet(std::uint32_t face, Vec3d eye, Vec3d ray) const {
        constexpr double kRim = -1e-9;
        const std::uint32_t* const c = edges_.corners(face);
        const Vec3d &a = edges_.places()[c[0]], e1 = edges_.places()[c[1]] - a, e2 = edges_.places()[c[2]] - a;
        const Vec3d from = eye - a, h = cross(ray, e2), q = cross(from, e1);
        const double scale = dot(e1, h);
        if (scale == 0.0) return {};
        const double u = dot(from, h) / scale, v = dot(ray, q) / scale, w = (1.0 - u) - v;  // of corners 1, 2 and 0
        const int side = scale > 0.0 ? 1 : -1;
        const double t = dot(e2, q) / scale;
        if (w >= kRim && u >= kRim && v >= kRim) return {t, -1, side};
        return {t, w <= u && w <= v ? 1 : u <= v ? 2 : 0, side};
    }

    /// The surface around a triangle lies before the point, as far as it is seen from one side.
    [[nodiscard]] bool hides(std::uint32_t face, const ModelEdge& edge, Vec3d eye, Vec3d ray, double before) const {
        constexpr int kMostSteps = 16;
        int side = 0;
        for (int step = 0; step < kMostSteps && face != ModelEdges::kNone; ++step) {
            const Meeting met = meet(face, eye, ray);
            if (met.side == 0 || (step > 0 && met.side != side)) return false;
            side = met.side;
            if (met.beyond < 0) return face != edge.face[0] && face != edge.face[1] && met.t > 0.0 && met.t < before;
            face = edges_.neighbour(face, met.beyond);
        }
        return false;
    }

    const ModelEdges& edges_;
    SeenTriangles seen_;
    bool orthographic_;
    Vec3d columns_[4];  // rows x, y and w of clip_from_world
    Vec3d back_, eye_;
    double near_w_ = 0.0, size_ = 1.0, skin_ = 0.0;
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
    EdgeSplitter(const EdgeView& view, const ModelEdges& edges, bool hidden_too) : view_(view), edges_(edges), hidden_too_(hidden_too) {}

    void split(const PlacedEdge& placed, std::vector<EdgeLine>& lines) const {
        const ModelEdge& edge = edges_.edges()[placed.edge];
        if (view_.turned_away(edge)) {
            add(placed, 0.0, 1.0, true, lines);
            return;
        }
        constexpr double kStep = 1.0;  // pixels
        const int steps = std::max(1, static_cast<int>(std::min(placed.length_px / kStep, 1e5)));
        const auto hidden_at = [&](double t) { return view_.is_hidden(at(placed, t), edge); };
        double begin = 0.0, before = 0.5 / steps;
        bool hidden = hidden_at(before);
        for (int i = 1; i < steps; ++i) {
            const double t = (i + 0.5) / steps;
            if (hidden_at(t) != hidden) {
                double low = before, high = t;
                for (int halving = 0; halving < 4; ++halving) {
                    const double middle = 0.5 * (low + high);
                    (hidden_at(middle) == hidden ? low : high) = middle;
                }
                const double end = 0.5 * (low + high);
                add(placed, begin, end, hidden, lines);
                begin = end;
                hidden = !hidden;
            }
            before = t;
        }
        add(placed, begin, 1.0, hidden, lines);
    }

private:
    /// The point at a share of the edge's length in the picture.
    [[nodiscard]] static EdgePoint at(const PlacedEdge& e, double t) {
        const double along = t * e.a.w / (e.b.w + (e.a.w - e.b.w) * t);
        return between(e.a, e.b, along);
    }
    void add(const PlacedEdge& e, double t0, double t1, bool hidden, std::vector<EdgeLine>& lines) const {
        if (hidden && !hidden_too_) return;
        const double x0 = view_.window_x(e.a), y0 = view_.window_y(e.a), dx = view_.window_x(e.b) - x0, dy = view_.window_y(e.b) - y0;
        EdgeLine line{x0 + dx * t0, y0 + dy * t0, x0 + dx * t1, y0 + dy * t1, e.begin_px + t0 * e.length_px, hidden};
        if (e.backward) {
            std::swap(line.x0, line.x1), std::swap(line.y0, line.y1);
            line.begin_px = e.begin_px + (1.0 - t1) * e.length_px;
        }
        lines.push_back(line);
    }

    const EdgeView& view_;
    const ModelEdges& edges_;
    bool hidden_too_;
};

/// Joins edges that meet in pairs to polylines, so that dashes go on from one to the next.
void join_edges(const ModelEdges& edges, std::vector<PlacedEdge>& placed) {
    constexpr std::uint32_t kNone = ~0u;
    struct Ends {
        std::uint32_t count = 0, edge[2] = {kNone, kNone};
    };
    std::vector<Ends> ends(edges.places().size());
    const auto place_of = [&](std::uint32_t i, bool last) {
        const ModelEdge& edge = edges.edges()[placed[i].edge];
        return last ? edge.to : edge.from;
    };
    for (std::uint32_t i = 0; i < placed.size(); ++i)
        for (const bool last : {false, true}) {
            Ends& e = ends[place_of(i, last)];
            if (e.count < 2) e.edge[e.count] = i;
            ++e.count;
        }
    std::vector<bool> done(placed.size(), false);
    const auto follow = [&](std::uint32_t i, bool backward) {
        for (double length = 0.0; i != kNone && !done[i];) {
            done[i] = true;
            placed[i].begin_px = length;
            placed[i].backward = backward;
            length += placed[i].length_px;
            const std::uint32_t place = place_of(i, !backward);
            const Ends& e = ends[place];
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

}  // namespace

std::vector<EdgeLine> edge_lines(const ModelEdges& edges, const Camera& camera, const SeenTriangles& seen, EdgeChoice choice,
                                 bool hidden_too, Executor& executor) {
    const EdgeView view(edges, camera, seen);
    constexpr std::size_t kChunk = 2048;
    const auto chunked = [&](std::size_t count, const auto& body) {
        executor.run(static_cast<int>((count + kChunk - 1) / kChunk), [&](int chunk) {
            const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
            body(static_cast<std::size_t>(chunk), begin, std::min(count, begin + kChunk));
        });
    };
    std::vector<std::vector<PlacedEdge>> found((edges.edges().size() + kChunk - 1) / kChunk);
    chunked(edges.edges().size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ModelEdge& edge = edges.edges()[i];
            PlacedEdge placed{static_cast<std::uint32_t>(i), {}, {}, 0.0};
            if (!view.is_line(edge, choice) || (!hidden_too && view.turned_away(edge)) || !view.place(edge, placed.a, placed.b)) continue;
            const double dx = view.window_x(placed.b) - view.window_x(placed.a), dy = view.window_y(placed.b) - view.window_y(placed.a);
            placed.length_px = std::sqrt(dx * dx + dy * dy);
            found[chunk].push_back(placed);
        }
    });
    std::vector<PlacedEdge> placed;
    for (const auto& some : found) placed.insert(placed.end(), some.begin(), some.end());
    if (hidden_too) join_edges(edges, placed);

    const EdgeSplitter splitter(view, edges, hidden_too);
    std::vector<std::vector<EdgeLine>> split((placed.size() + kChunk - 1) / kChunk);
    chunked(placed.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) splitter.split(placed[i], split[chunk]);
    });
    std::vector<EdgeLine> lines;
    for (const auto& some : split) lines.insert(lines.end(), some.begin(), some.end());
    return lines;
}

}  // namespace halflit::raster
