#include "apps/io/models/crease_normals.hpp"

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

/// Sets of corners, as a forest. The root of a set is its lowest corner.
class CornerSets {
public:
    explicit CornerSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t corner) {
        while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t x = root(a), y = root(b);
        parent_[std::max(x, y)] = std::min(x, y);
    }

private:
    std::vector<std::uint32_t> parent_;
};

struct HalfEdge {
    std::uint32_t low, high;  ///< places at its ends
    std::uint32_t corner;     ///< at its start
    std::uint32_t is_upward;  ///< from low to high
};

/// Of normals that count as equal: the triangles of a flat polygon share a normal. An angle of 0.08 degrees.
constexpr double kFlatCosine = 1.0 - 1e-6;

constexpr std::uint32_t following(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

class NormalMaker {
public:
    NormalMaker(Soup& soup, const std::vector<std::uint32_t>& place_of, double crease_deg)
        : soup_(soup), place_of_(place_of), least_cosine_(sin_cos(crease_deg * (kPi / 180)).cos), sets_(place_of.size()) {
        TimeCheck check;
        for (std::size_t t = 0; t < soup.triangles(); ++t) {
            check();
            const Vec3d a = at(3 * t);
            const Vec3d normal = cross(at(3 * t + 1) - a, at(3 * t + 2) - a);
            const double size = length(normal);
            unit_.push_back(size > 0 ? normal * (1.0 / size) : Vec3d{});
        }
    }

    void join_smooth_edges() {
        std::vector<HalfEdge> edges;
        edges.reserve(place_of_.size());
        for (std::uint32_t corner = 0; corner < place_of_.size(); ++corner) {
            const std::uint32_t a = place_of_[corner], b = place_of_[following(corner)];
            edges.push_back({std::min(a, b), std::max(a, b), corner, a < b ? 1u : 0u});
        }
        std::sort(edges.begin(), edges.end(), timed_less([](const HalfEdge& x, const HalfEdge& y) {
                      return std::tie(x.low, x.high, x.corner) < std::tie(y.low, y.high, y.corner);
                  }));
        for (std::size_t i = 0; i < edges.size();) {
            std::size_t end = i + 1;
            while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
            if (end - i == 2 && edges[i].is_upward != edges[i + 1].is_upward) join(edges[i].corner, edges[i + 1].corner);
            i = end;
        }
    }

    void add_normals() {
        std::vector<Vec3d> sum(place_of_.size());
        TimeCheck check;
        for (std::uint32_t corner = 0; corner < place_of_.size(); ++corner) {
            check();
            const Vec3d here = at(corner), next = at(following(corner)) - here, last = at(following(following(corner))) - here;
            Vec3d& of_set = sum[sets_.root(corner)];
            of_set = of_set + unit_[corner / 3] * angle_of(length(cross(next, last)), dot(next, last));
        }
        soup_.normal_of.resize(place_of_.size(), kNone);
        std::vector<std::uint32_t> number(place_of_.size(), kNone);
        for (std::uint32_t corner = 0; corner < place_of_.size(); ++corner) {
            if (soup_.normal_of[corner] != kNone) continue;
            const std::uint32_t root = sets_.root(corner);
            if (number[root] == kNone) {
                number[root] = static_cast<std::uint32_t>(soup_.normals.size());
                const double size = length(sum[root]);
                Vec3d normal = size > 1e-9 ? sum[root] * (1.0 / size) : unit_[root / 3];
                if (normal == Vec3d{}) normal = {0, 0, 1};
                soup_.normals.push_back(to_float(normal));
            }
            soup_.normal_of[corner] = number[root];
        }
    }

private:
    [[nodiscard]] Vec3d at(std::size_t corner) const { return to_double(soup_.points[soup_.position_of[corner]]); }
    [[nodiscard]] std::uint32_t smoothing(std::size_t triangle) const {
        return triangle < soup_.smoothing_of.size() ? soup_.smoothing_of[triangle] : Soup::kByCrease;
    }
    /// Two corners at which half-edges of the same edge start.
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t group = smoothing(a / 3);
        if (group != smoothing(b / 3)) return;
        const Vec3d &x = unit_[a / 3], &y = unit_[b / 3];
        const double least = group == 0 ? kFlatCosine : least_cosine_;
        if ((group == 0 || group == Soup::kByCrease) && !(x != Vec3d{} && y != Vec3d{} && dot(x, y) >= least)) return;
        sets_.join(a, following(b));
        sets_.join(following(a), b);
    }

    Soup& soup_;
    const std::vector<std::uint32_t>& place_of_;
    double least_cosine_;
    CornerSets sets_;
    std::vector<Vec3d> unit_;  ///< normals of the triangles; zero: has no area
};

}  // namespace

void add_crease_normals(Soup& soup, const std::vector<std::uint32_t>& place_of, double crease_deg) {
    if (soup.normal_of.size() == soup.position_of.size() &&
        std::find(soup.normal_of.begin(), soup.normal_of.end(), kNone) == soup.normal_of.end())
        return;
    check_time();
    NormalMaker maker(soup, place_of, crease_deg);
    maker.join_smooth_edges();
    check_time();
    maker.add_normals();
}

}  // namespace halflit::io::detail
