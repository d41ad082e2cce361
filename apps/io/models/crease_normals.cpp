#include "apps/io/models/crease_normals.hpp"

#include "apps/io/files/in_parts.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace halflit::io::detail {

double angle_of(double sine, double cosine) {
    const double r = std::sqrt(sine * sine + cosine * cosine);
    if (!(r > 0)) return 0.0;
    const bool obtuse = cosine < 0;
    // Tangents of a half, a quarter and an eighth of the angle, which is at most pi/2.
    double t = sine / (r + (obtuse ? -cosine : cosine));
    t = t / (1.0 + std::sqrt(1.0 + t * t));
    t = t / (1.0 + std::sqrt(1.0 + t * t));
    const double s = t * t;  // at most 0.04: the first dropped term is below 1e-13
    double sum = 0.0;
    for (int k = 15; k >= 1; k -= 2) sum = 1.0 / k - s * sum;
    const double angle = 8.0 * t * sum;
    return obtuse ? kPi - angle : angle;
}

namespace {

/// Cosine of normals that count as equal, 0.08 degrees apart: the triangles of a flat polygon share a normal.
constexpr double kFlatCosine = 1.0 - 1e-6;

/// A file of so many triangles is a scan if its edges bend a little nearly everywhere: few are flat, and most bend by less than a crease.
/// Parts made by design have flat edges within their faces; knurls and other patterns have sharp ones everywhere.
constexpr std::size_t kManyTriangles = 10000, kProbedPlaces = 4096;
constexpr double kFlatBend = 1.0 * (kPi / 180), kUsualBend = 20.0 * (kPi / 180), kMostFlat = 0.2;
/// An edge of a scan is sharp if it stands out from the others at its ends, by their median.
constexpr double kStandsOut = 3.0, kMostWidened = 2.0;
constexpr std::size_t kFewEdges = 5;  // of a place, below which none stands out

/// Rounding of positions turns the edges of a prism of twelve sides, which are all as sharp as the usual crease, by less than this.
constexpr double kAngleSlack = 0.25 * (kPi / 180);

/// A triangle is a strip's if two of its corners are so much nearer to each other than to the third, its tip, and if the triangles beside
/// it have no tip there. A strip that fills a twisted face bends to and fro at its edges, as its triangles follow one boundary and the
/// other in turn. These bends are smooth up to kMostWidened times a crease if both of a triangle's are alike, and those of one beside it.
constexpr double kSlender = 0.25, kLeastAngleBeside = 0.5;  // rad
constexpr double kAlike = 0.5;

constexpr std::uint32_t following(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// Makes the normals of one place after the other. All edges that matter to a place begin or end there.
class NormalMaker {
public:
    /// normals: those that are made; the first one has the number `first`.
    /// to_and_fro: for each corner, not 0 where the edge from it to the next one is one of a strip that bends to and fro; or empty.
    NormalMaker(Soup& soup, double crease_deg, bool is_scan, std::span<const std::uint8_t> to_and_fro, std::vector<Vec3f>& normals,
                std::uint32_t first)
        : soup_(soup),
          to_and_fro_(to_and_fro),
          normals_(normals),
          first_(first),
          crease_rad_(crease_deg * (kPi / 180)),
          least_cosine_(sin_cos(crease_rad_ > 0 ? std::min(crease_rad_ + kAngleSlack, kPi) : 0.0).cos),
          is_scan_(is_scan) {}

    /// Adds the angles between the triangles of the edges of a place.
    void add_bends(std::span<const std::uint32_t> corners, std::vector<double>& bends) {
        gather(corners);
        each_bend([&](double sine, double cosine) { bends.push_back(angle_of(sine, cosine)); });
    }

    /// Marks tips at a place whose triangles bend to and fro.
    void mark_tips(std::span<const std::uint32_t> corners, std::vector<std::uint8_t>& tips) {
        gather(corners);
        find_beside(corners);
        for (std::uint32_t i = 0; i < wedges_.size(); ++i) {
            if (!is_tip(corners[i])) continue;
            const double first = bend_of_[2 * i], last = bend_of_[2 * i + 1];
            const double least = std::min(std::abs(first), std::abs(last)), most = std::max(std::abs(first), std::abs(last));
            if (!(first * last < 0.0) || least < kAlike * most || most > kMostWidened * crease_rad_) continue;
            if (wedges_[beside_[2 * i]].angle < kLeastAngleBeside || wedges_[beside_[2 * i + 1]].angle < kLeastAngleBeside) continue;
            tips[corners[i]] = 1;
        }
    }

    /// Marks the edges at such tips at a place, where a triangle beside has one too.
    void mark_strips(std::span<const std::uint32_t> corners, const std::vector<std::uint8_t>& tips, std::vector<std::uint8_t>& marks) {
        gather(corners);
        find_beside(corners);
        const auto has_tip = [&](std::uint32_t wedge) {
            const std::uint32_t corner = corners[wedge], next = following(corner);
            return (tips[corner] | tips[next] | tips[following(next)]) != 0;
        };
        for (std::uint32_t i = 0; i < wedges_.size(); ++i)
            if (tips[corners[i]] != 0 && (has_tip(beside_[2 * i]) || has_tip(beside_[2 * i + 1])))
                marks[corners[i]] = marks[following(following(corners[i]))] = 1;
    }

    /// Finds the bends at the two edges of each wedge of the gathered place, and the wedges across them.
    void find_beside(std::span<const std::uint32_t> corners) {
        bend_of_.assign(2 * wedges_.size(), 0.0);
        beside_.assign(2 * wedges_.size(), kNone);
        for (std::size_t i = 0; i < edges_.size(); i = end_of(i)) {
            const Edge &a = edges_[i], &b = edges_[end_of(i) - 1];
            if (end_of(i) != i + 2 || a.leaves == b.leaves) continue;
            const Vec3d &x = wedges_[a.wedge].normal, &y = wedges_[b.wedge].normal;
            const std::uint32_t corner = corners[a.wedge], other = a.leaves ? following(corner) : following(following(corner));
            const Vec3d turn = cross(x, y), along = (at(other) - at(corner)) * (a.leaves ? 1.0 : -1.0);
            const double bend = angle_of(length(turn), dot(x, y)) * (dot(turn, along) < 0.0 ? -1.0 : 1.0);
            for (const auto& [edge, neighbour] : {std::pair(a, b.wedge), std::pair(b, a.wedge)}) {
                const std::size_t side = 2 * std::size_t{edge.wedge} + (edge.leaves ? 0 : 1);
                bend_of_[side] = bend, beside_[side] = neighbour;
            }
        }
    }

    /// True if a corner is the tip of a slender triangle.
    [[nodiscard]] bool is_tip(std::uint32_t corner) const {
        const std::uint32_t next = following(corner), last = following(next);
        const Vec3d here = at(corner), a = at(next) - here, b = at(last) - here, across = at(last) - at(next);
        return dot(across, across) <= kSlender * kSlender * std::min(dot(a, a), dot(b, b));
    }

    void add_normals(std::span<const std::uint32_t> corners) {
        const auto has_normal = [&](std::uint32_t corner) { return soup_.normal_of[corner] != kNone; };
        if (std::all_of(corners.begin(), corners.end(), has_normal)) return;
        gather(corners);
        join_smooth_edges(corners);
        for (std::uint32_t i = 0; i < wedges_.size(); ++i) {
            if (!copies_.empty() && copies_[i].of != kNone) continue;
            Vec3d& of_set = wedges_[root(i)].sum;
            of_set = of_set + wedges_[i].normal * wedges_[i].angle;
        }
        for (std::uint32_t i = 0; i < wedges_.size(); ++i) {
            if (has_normal(corners[i])) continue;
            Wedge& set = wedges_[root(i)];
            if (set.number == kNone) {
                set.number = first_ + static_cast<std::uint32_t>(normals_.size());
                const double size = length(set.sum);
                Vec3d normal = size > 1e-9 ? set.sum * (1.0 / size) : set.normal;
                if (normal == Vec3d{}) normal = {0, 0, 1};
                normals_.push_back(to_float(normal));
            }
            soup_.normal_of[corners[i]] = set.number;
        }
    }

private:
    /// The part of a triangle at the place. The wedges that share a normal are a set; its root is its first one.
    struct Wedge {
        Vec3d normal;  ///< of the triangle; zero: it has no area
        double angle;
        Vec3d sum;             ///< of a root: of its set
        std::uint32_t parent;  ///< a wedge of the same set, nearer to its root; a root is its own
        std::uint32_t number;  ///< of a root: of its set's normal, when it is known
    };
    /// The relation of a wedge to the others at the place.
    struct Copy {
        std::uint32_t ends[2];       ///< places of the triangle's next corner and of the one after it
        std::uint32_t of = kNone;    ///< the first wedge with the same ends; kNone: it is the first
        std::uint32_t back = kNone;  ///< of a first one, the first with the same ends the other way round; kNone: there is none
    };
    struct Edge {
        std::uint32_t to;     ///< place at its other end
        std::uint32_t wedge;  ///< the triangle's
        bool leaves;          ///< the triangle goes along it from here to there
    };

    void gather(std::span<const std::uint32_t> corners) {
        wedges_.clear();
        edges_.clear();
        copies_.clear();
        for (const std::uint32_t corner : corners) {
            check_();
            const std::uint32_t next = following(corner), last = following(next), number = static_cast<std::uint32_t>(wedges_.size());
            const Vec3d here = at(corner), to_next = at(next) - here, to_last = at(last) - here;
            wedges_.push_back({normal_of(corner / 3), angle_of(length(cross(to_next, to_last)), dot(to_next, to_last)), {}, number, kNone});
            edges_.push_back({soup_.position_of[next], number, true});
            edges_.push_back({soup_.position_of[last], number, false});
        }
        std::sort(edges_.begin(), edges_.end(), [this](const Edge& a, const Edge& b) {
            check_();
            return std::tie(a.to, a.wedge) < std::tie(b.to, b.wedge);
        });
    }
    [[nodiscard]] std::size_t end_of(std::size_t edge) const {
        std::size_t end = edge + 1;
        while (end < edges_.size() && edges_[end].to == edges_[edge].to) ++end;
        return end;
    }
    /// Calls visit(sine, cosine) with the angle between the two triangles of each edge that has two.
    template <class Visit>
    void each_bend(const Visit& visit) const {
        for (std::size_t i = 0; i < edges_.size(); i = end_of(i)) {
            if (end_of(i) != i + 2 || edges_[i].leaves == edges_[i + 1].leaves) continue;
            const Vec3d &a = wedges_[edges_[i].wedge].normal, &b = wedges_[edges_[i + 1].wedge].normal;
            if (a != Vec3d{} && b != Vec3d{}) visit(length(cross(a, b)), dot(a, b));
        }
    }
    [[nodiscard]] Vec3d at(std::size_t corner) const { return to_double(soup_.points[soup_.position_of[corner]]); }
    [[nodiscard]] Vec3d normal_of(std::size_t triangle) const {
        const Vec3d a = at(3 * triangle), normal = cross(at(3 * triangle + 1) - a, at(3 * triangle + 2) - a);
        const double size = length(normal);
        return size > 0 ? normal * (1.0 / size) : Vec3d{};
    }
    [[nodiscard]] std::uint32_t smoothing(std::size_t triangle) const {
        return triangle < soup_.smoothing_of.size() ? soup_.smoothing_of[triangle] : Soup::kByCrease;
    }
    std::uint32_t root(std::uint32_t wedge) {
        while (wedges_[wedge].parent != wedge) wedge = wedges_[wedge].parent = wedges_[wedges_[wedge].parent].parent;
        return wedge;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t x = root(a), y = root(b);
        wedges_[std::max(x, y)].parent = std::min(x, y);
    }
    /// Finds triangles that are there more than once, or from both sides: an edge of theirs is as smooth as one of a single surface.
    void find_copies(std::span<const std::uint32_t> corners) {
        order_.clear();
        for (const std::uint32_t corner : corners) {
            const std::uint32_t next = following(corner);
            order_.push_back(static_cast<std::uint32_t>(copies_.size()));
            copies_.push_back({{soup_.position_of[next], soup_.position_of[following(next)]}});
        }
        const auto ends = [this](std::uint32_t wedge) {
            const auto& [next, last] = copies_[wedge].ends;
            return std::pair(std::min(next, last), std::max(next, last));
        };
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            check_();
            return std::pair(ends(a), a) < std::pair(ends(b), b);
        });
        std::uint32_t first[2] = {kNone, kNone};  // of the same two ends, in either order
        for (std::size_t i = 0; i < order_.size(); ++i) {
            Copy& wedge = copies_[order_[i]];
            if (i > 0 && ends(order_[i]) != ends(order_[i - 1])) first[0] = first[1] = kNone;
            const bool turned = wedge.ends[0] > wedge.ends[1];
            std::uint32_t &same = first[turned ? 1 : 0], other = first[turned ? 0 : 1];
            if (same != kNone) {
                wedge.of = same;
                join(order_[i], same);
                continue;
            }
            same = order_[i];
            if (other != kNone) wedge.back = other, copies_[other].back = same;
        }
    }
    void join_smooth_edges(std::span<const std::uint32_t> corners) {
        least_cosine_here_ = is_scan_ ? widened_cosine() : least_cosine_;
        const auto join_if_smooth = [&](const Edge& a, const Edge& b) {
            if (a.leaves != b.leaves && (is_smooth(a.wedge, corners[a.wedge] / 3, b.wedge, corners[b.wedge] / 3) ||
                                         is_to_and_fro(a, corners) || is_to_and_fro(b, corners)))
                join(a.wedge, b.wedge);
        };
        bool has_copies = false;
        for (std::size_t i = 0; i < edges_.size(); i = end_of(i)) {
            const std::size_t count = end_of(i) - i;
            has_copies |= count > 2 || (count == 2 && edges_[i].leaves == edges_[i + 1].leaves);
            if (count == 2) join_if_smooth(edges_[i], edges_[i + 1]);
        }
        if (!has_copies) return;
        find_copies(corners);
        for (std::size_t i = 0; i < edges_.size(); i = end_of(i)) join_without_copies(i, end_of(i), join_if_smooth);
    }
    /// Cosine of the angle up to which edges at the place are smooth.
    [[nodiscard]] double widened_cosine() {
        bends_.clear();
        each_bend([&](double sine, double cosine) { bends_.push_back(angle_of(sine, cosine)); });
        if (bends_.size() < kFewEdges) return least_cosine_;
        const auto middle = bends_.begin() + static_cast<std::ptrdiff_t>(bends_.size() / 2);
        std::nth_element(bends_.begin(), middle, bends_.end());
        return sin_cos(std::clamp(kStandsOut * *middle, crease_rad_, std::max(crease_rad_, std::min(kMostWidened * crease_rad_, kPi)))).cos;
    }
    /// Joins the triangles of one edge, edges_[begin] to edges_[end - 1], if without copies there are two, or two with their backs.
    template <class Join>
    void join_without_copies(std::size_t begin, std::size_t end, const Join& join_if_smooth) const {
        Edge single[5];
        std::size_t count = 0;
        for (std::size_t e = begin; e < end && count < 5; ++e)
            if (copies_[edges_[e].wedge].of == kNone) single[count++] = edges_[e];
        if (count == 2) join_if_smooth(single[0], single[1]);
        if (count != 4) return;
        const auto is_back = [&](std::size_t a, std::size_t b) { return copies_[single[a].wedge].back == single[b].wedge; };
        std::size_t back = 1;  // of the first one
        while (back < 4 && !is_back(0, back)) ++back;
        if (back == 4) return;
        const std::size_t other = back == 1 ? 2 : 1, last = 6 - back - other;
        if (!is_back(other, last)) return;
        join_if_smooth(single[0], single[single[0].leaves != single[other].leaves ? other : last]);
        join_if_smooth(single[back], single[single[back].leaves != single[other].leaves ? other : last]);
    }
    [[nodiscard]] bool is_to_and_fro(const Edge& edge, std::span<const std::uint32_t> corners) const {
        if (to_and_fro_.empty()) return false;
        const std::uint32_t corner = corners[edge.wedge];
        return smoothing(corner / 3) == Soup::kByCrease && to_and_fro_[edge.leaves ? corner : following(following(corner))] != 0;
    }
    [[nodiscard]] bool is_smooth(std::uint32_t a, std::size_t triangle_a, std::uint32_t b, std::size_t triangle_b) const {
        const std::uint32_t group = smoothing(triangle_a);
        if (group != smoothing(triangle_b)) return false;
        if (group != 0 && group != Soup::kByCrease) return true;
        const Vec3d &x = wedges_[a].normal, &y = wedges_[b].normal;
        return x != Vec3d{} && y != Vec3d{} && dot(x, y) >= (group == 0 ? kFlatCosine : least_cosine_here_);
    }

    Soup& soup_;
    std::span<const std::uint8_t> to_and_fro_;
    std::vector<Vec3f>& normals_;
    std::uint32_t first_;
    double crease_rad_, least_cosine_;
    bool is_scan_;
    double least_cosine_here_ = 0;
    std::vector<double> bends_;
    std::vector<double> bend_of_;        ///< of the two edges of each wedge, above 0 where the surface is convex; 0: not known
    std::vector<std::uint32_t> beside_;  ///< the wedges across them
    std::vector<Wedge> wedges_;
    std::vector<Edge> edges_;
    std::vector<Copy> copies_;  ///< of the place's wedges; empty where no edge has copies
    std::vector<std::uint32_t> order_;
    TimeCheck check_;
};

bool is_scan(Soup& soup, const CornersOfPlaces& corners) {
    if (soup.position_of.size() < 3 * kManyTriangles) return false;
    std::vector<Vec3f> none;
    NormalMaker probe(soup, 0.0, false, {}, none, 0);
    std::vector<double> bends;
    const std::size_t step = corners.places() / kProbedPlaces + 1;
    for (std::size_t place = 0; place < corners.places(); place += step)
        probe.add_bends(corners.at(static_cast<std::uint32_t>(place)), bends);
    if (bends.empty()) return false;
    const auto flat = std::count_if(bends.begin(), bends.end(), [](double bend) { return bend < kFlatBend; });
    const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
    std::nth_element(bends.begin(), middle, bends.end());
    return static_cast<double>(flat) <= kMostFlat * static_cast<double>(bends.size()) && *middle < kUsualBend;
}

/// The edges of strips that bend to and fro, as NormalMaker takes them; empty: there are none.
std::vector<std::uint8_t> find_strips(Soup& soup, const CornersOfPlaces& corners, double crease_deg, int threads) {
    const std::size_t parts = parts_of(corners.places(), kPlacesAThread, threads);
    const auto each_place = [&](const auto& is_wanted, const auto& visit) {
        std::vector<std::uint8_t> some(parts);
        in_parts(corners.places(), parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
            std::vector<Vec3f> none;
            NormalMaker maker(soup, crease_deg, false, {}, none, 0);
            TimeCheck check;
            for (std::size_t place = begin; place < end; ++place) {
                check();
                const auto here = corners.at(static_cast<std::uint32_t>(place));
                if (std::none_of(here.begin(), here.end(), [&](std::uint32_t corner) { return is_wanted(maker, corner); })) continue;
                visit(maker, here);
                some[part] = 1;
            }
        });
        return std::count(some.begin(), some.end(), 1) > 0;
    };
    std::vector<std::uint8_t> tips(soup.position_of.size()), marks;
    if (!each_place([](const NormalMaker& maker, std::uint32_t corner) { return maker.is_tip(corner); },
                    [&](NormalMaker& maker, std::span<const std::uint32_t> here) { maker.mark_tips(here, tips); }))
        return marks;
    marks.resize(tips.size());
    if (!each_place([&](const NormalMaker&, std::uint32_t corner) { return tips[corner] != 0; },
                    [&](NormalMaker& maker, std::span<const std::uint32_t> here) { maker.mark_strips(here, tips, marks); }))
        marks.clear();
    return marks;
}

}  // namespace

void add_crease_normals(Soup& soup, const CornersOfPlaces& corners, double crease_deg, int threads) {
    soup.normal_of.resize(soup.position_of.size(), kNone);
    const std::size_t parts = parts_of(corners.places(), kPlacesAThread, threads);
    const auto first = static_cast<std::uint32_t>(soup.normals.size());
    std::vector<std::vector<Vec3f>> made(parts);
    const bool scan = crease_deg > 0 && is_scan(soup, corners);
    std::vector<std::uint8_t> to_and_fro;
    if (crease_deg > 0) to_and_fro = find_strips(soup, corners, crease_deg, threads);
    in_parts(corners.places(), parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
        NormalMaker maker(soup, crease_deg, scan, to_and_fro, made[part], first);
        for (std::size_t place = begin; place < end; ++place) maker.add_normals(corners.at(static_cast<std::uint32_t>(place)));
    });
    // One list of all, in the order of the places.
    std::vector<std::uint32_t> before{0};
    for (const std::vector<Vec3f>& normals : made) before.push_back(before.back() + static_cast<std::uint32_t>(normals.size()));
    if (first == 0) soup.normals = std::move(made[0]);
    soup.normals.reserve(first + before.back());
    for (std::vector<Vec3f>& normals : made) soup.normals.insert(soup.normals.end(), normals.begin(), normals.end()), normals = {};
    if (parts == 1) return;
    in_parts(corners.places(), parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place)
            for (const std::uint32_t corner : corners.at(static_cast<std::uint32_t>(place)))
                if (soup.normal_of[corner] >= first) soup.normal_of[corner] += before[part];
    });
}

}  // namespace halflit::io::detail
