#include "apps/engine/compare/hausdorff.hpp"

#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace halflit::engine {
namespace {

/// A part of the surface whose middle was measured.
struct Piece {
    double at_most = 0;      ///< upper bound on the distance of its points
    std::uint32_t near = 0;  ///< a triangle of the other surface that is near
    Triangle triangle;
};

class FarthestSearch {
public:
    FarthestSearch(const Surface& to, double accuracy, std::uint64_t most_steps) : to_(to), accuracy_(accuracy), steps_left_(most_steps) {}

    /// Measures one point, for the triangles around it. near: a triangle of the other surface; returns the nearest one.
    std::uint32_t begin_at(Vec3d point, std::uint32_t near) { return steps_left_ == 0 ? near : measure(point, near).triangle; }

    /// near: a triangle of the other surface. The nearer it is, the less is left to measure. at_most: a bound that is known.
    void add(const Triangle& t, std::uint32_t near, double at_most = 1e300) {
        check_time();
        at_most = std::min(at_most, bound(t, near));
        if (at_most <= found_.at_least) return;  // changes neither result
        if (steps_left_ == 0) return leave({at_most, near, t});
        const Vec3d middle = ((t.a + t.b) + t.c) * (1.0 / 3.0);
        const double reach = std::max({length(t.a - middle), length(t.b - middle), length(t.c - middle)});
        const Surface::Nearest found = measure(middle, near, found_.at_least - reach);
        keep({std::min({at_most, found.distance + reach, bound(t, found.triangle)}), found.triangle, t});
    }

    /// Cuts all pieces that are not within the accuracy into four, and measures these. False: there are none, or the last points were used.
    bool divide(std::uint64_t most_points) {
        std::vector<Piece> pieces;
        for (const Piece& piece : std::exchange(pieces_, {}))
            if (is_open(piece))
                pieces.push_back(piece);
            else
                keep(piece);
        const std::uint64_t most = (most_points - std::min(most_points, found_.points)) / 4;
        const bool is_last = pieces.size() > most || steps_left_ == 0;
        if (is_last)
            std::stable_sort(pieces.begin(), pieces.end(),
                             timed_less([](const Piece& a, const Piece& b) { return a.at_most > b.at_most; }));
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& piece = pieces[i];
            if (i >= most || !is_open(piece)) {
                leave(piece);
                continue;
            }
            const Triangle& t = piece.triangle;
            const Vec3d ab = (t.a + t.b) * 0.5, bc = (t.b + t.c) * 0.5, ca = (t.c + t.a) * 0.5;
            for (const Triangle& part : {Triangle{t.a, ab, ca}, Triangle{ab, t.b, bc}, Triangle{ca, bc, t.c}, Triangle{ab, bc, ca}})
                add(part, piece.near, piece.at_most);
        }
        return !pieces_.empty() && !is_last;
    }

    [[nodiscard]] FarthestPoint result() {
        for (const Piece& piece : std::exchange(pieces_, {})) leave(piece);
        // The farthest point is mostly a corner of the piece with the largest bound.
        for (const Vec3d corner : {left_.triangle.a, left_.triangle.b, left_.triangle.c})
            if (left_.at_most > found_.at_least) measure(corner, left_.near);
        found_.at_most = std::max(found_.at_least, left_.at_most);
        return found_;
    }

private:
    [[nodiscard]] bool is_open(const Piece& piece) const { return piece.at_most > found_.at_least + accuracy_; }
    void keep(const Piece& piece) {
        if (is_open(piece))
            pieces_.push_back(piece);
        else
            leave(piece);
    }
    void leave(const Piece& piece) {
        if (piece.at_most > left_.at_most) left_ = piece;
    }
    /// The search may end at a triangle within `enough`, at most found_.at_least.
    Surface::Nearest measure(Vec3d point, std::uint32_t near, double enough = 0.0) {
        const Surface::Nearest nearest = to_.nearest(point, near, enough);
        steps_left_ -= std::min(steps_left_, nearest.steps);
        if (++found_.points == 1 || nearest.distance > found_.at_least) found_.at_least = nearest.distance, found_.point = point;
        return nearest;
    }
    /// Upper bound by one triangle of the other surface.
    [[nodiscard]] double bound(const Triangle& piece, std::uint32_t triangle) const {
        const Triangle& other = to_.triangles()[triangle];
        return std::max({distance_to(other, piece.a), distance_to(other, piece.b), distance_to(other, piece.c)});
    }

    const Surface& to_;
    double accuracy_;
    std::uint64_t steps_left_;  ///< of all searches for a nearest triangle; 0: bounds stay as they are
    FarthestPoint found_;
    std::vector<Piece> pieces_;  ///< to divide
    Piece left_;                 ///< the one with the largest bound of those that were left
};

}  // namespace

FarthestPoint farthest_point(const Surface& from, const Surface& to, double accuracy) {
    FarthestSearch search(to, accuracy, kMostDistanceSteps + kStepsATriangle * (from.triangles().size() + to.triangles().size()));
    // A few points first: the larger the distance that is known, the more triangles are left at once.
    constexpr std::size_t kAround = 8;  // triangles that follow each other lie beside each other
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < from.triangles().size(); i += kAround)
        near.push_back(search.begin_at(from.triangles()[i].a, near.empty() ? 0 : near.back()));
    for (std::size_t i = 0; i < from.triangles().size(); ++i) search.add(from.triangles()[i], near[i / kAround]);
    while (search.divide(from.triangles().size() + kMostDistancePoints)) check_time();
    return search.result();
}

}  // namespace halflit::engine
