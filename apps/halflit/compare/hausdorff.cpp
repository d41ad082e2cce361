#include "apps/halflit/compare/hausdorff.hpp"

#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <queue>
#include <vector>

namespace halflit::cli {
namespace {

/// A part of the surface, and the upper bound on the distance of its points. `number` makes the order of equal bounds definite.
struct Piece {
    double at_most = 0;
    std::uint64_t number = 0;
    Triangle triangle;
    friend bool operator<(const Piece& a, const Piece& b) {
        return a.at_most < b.at_most || (a.at_most == b.at_most && a.number > b.number);
    }
};

class FarthestSearch {
public:
    FarthestSearch(const Surface& to, double accuracy) : to_(to), accuracy_(accuracy) {}

    void add(const Triangle& piece, double at_most) {
        check_time();
        const Vec3d middle = (((piece.a + piece.b) + piece.c)) * (1.0 / 3.0);
        const Surface::Nearest found = measure(middle);
        const double reach = std::max({length(piece.a - middle), length(piece.b - middle), length(piece.c - middle)});
        keep({std::min({at_most, found.distance + reach, bound(piece, found.triangle)}), 0, piece});
    }

    /// False: what is left is within the accuracy.
    bool divide_farthest() {
        if (pieces_.empty() || pieces_.top().at_most <= found_.at_least + accuracy_) return false;
        Piece piece = pieces_.top();
        pieces_.pop();
        const Triangle& t = piece.triangle;
        for (const Vec3d corner : {t.a, t.b, t.c}) piece.at_most = std::min(piece.at_most, bound(t, measure(corner).triangle));
        if (piece.at_most <= found_.at_least + accuracy_) {
            keep(piece);
            return true;
        }
        const Vec3d ab = (t.a + t.b) * 0.5, bc = (t.b + t.c) * 0.5, ca = (t.c + t.a) * 0.5;
        for (const Triangle& part : {Triangle{t.a, ab, ca}, Triangle{ab, t.b, bc}, Triangle{ca, bc, t.c}, Triangle{ab, bc, ca}})
            add(part, piece.at_most);
        return true;
    }

    [[nodiscard]] FarthestPoint result() const {
        FarthestPoint found = found_;
        found.at_most = std::max({found.at_least, left_, pieces_.empty() ? 0.0 : pieces_.top().at_most});
        return found;
    }
    [[nodiscard]] std::uint64_t points() const { return found_.points; }

private:
    Surface::Nearest measure(Vec3d point) {
        const Surface::Nearest nearest = to_.nearest(point);
        if (++found_.points == 1 || nearest.distance > found_.at_least) found_.at_least = nearest.distance, found_.point = point;
        return nearest;
    }
    /// Upper bound by one triangle of the other surface.
    [[nodiscard]] double bound(const Triangle& piece, std::uint32_t triangle) const {
        const Triangle& other = to_.triangles()[triangle];
        return std::max({distance_to(other, piece.a), distance_to(other, piece.b), distance_to(other, piece.c)});
    }
    void keep(Piece piece) {
        if (piece.at_most <= found_.at_least + accuracy_) {
            left_ = std::max(left_, piece.at_most);
            return;
        }
        piece.number = numbers_++;
        pieces_.push(piece);
    }

    const Surface& to_;
    double accuracy_;
    FarthestPoint found_;
    double left_ = 0;  ///< largest bound of the pieces that were left
    std::uint64_t numbers_ = 0;
    std::priority_queue<Piece> pieces_;
};

}  // namespace

FarthestPoint farthest_point(const Surface& from, const Surface& to, double accuracy) {
    FarthestSearch search(to, accuracy);
    for (const Triangle& triangle : from.triangles()) search.add(triangle, 1e300);
    const std::uint64_t most = search.points() + kMostDistancePoints;
    while (search.points() < most && search.divide_farthest()) check_time();
    return search.result();
}

}  // namespace halflit::cli
