#include "apps/engine/compare/view_change.hpp"

#include "apps/engine/pictures/canvas.hpp"
#include "sh/arc.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace halflit::engine {
namespace {

constexpr int kBoxRoom = 3;  // pixels between a change and the line around it

Vec3d normal_at(const ViewShot& shot, std::size_t pixel) {
    return {shot.normal[3 * pixel], shot.normal[3 * pixel + 1], shot.normal[3 * pixel + 2]};
}

/// The angle between two vectors of unit length, by its half's tangent.
double angle_deg(Vec3d a, Vec3d b) {
    const Vec3d apart = a - b, together = a + b;
    return 2.0 * angle_of(std::sqrt(dot(apart, apart)), std::sqrt(dot(together, together))) * (180.0 / kPi);
}

/// Finds the change of each pixel, and the largest numbers.
class PixelComparison {
public:
    PixelComparison(const ViewShot& a, const ViewShot& b, int max_codes, ViewChange& change)
        : a_(a), b_(b), max_codes_(max_codes), change_(change) {
        const Vec4f back = a.camera.world_from_camera.c[2];
        back_ = {back.x, back.y, back.z};
    }

    PixelChange of(std::size_t pixel) {
        const bool in_a = a_.instance[pixel] > 0, in_b = b_.instance[pixel] > 0;
        if (in_a != in_b) return in_b ? PixelChange::added : PixelChange::removed;
        if (in_a && moved(pixel)) return PixelChange::moved;
        if (in_a && turned(pixel)) return PixelChange::turned;
        for (std::size_t c = 4 * pixel; c < 4 * pixel + 4; ++c)
            if (std::abs(a_.picture.rgba8[c] - b_.picture.rgba8[c]) > max_codes_) return PixelChange::recolored;
        return PixelChange::none;
    }

private:
    bool moved(std::size_t pixel) {
        const double a = a_.depth[pixel], b = b_.depth[pixel], difference = absolute(a - b);
        const Vec3d na = normal_at(a_, pixel), nb = normal_at(b_, pixel);
        const double cosine = std::min(absolute(dot(na, back_)), absolute(dot(nb, back_)));
        if (!(difference > depth_step(change_.pixel, cosine, std::max(absolute(a), absolute(b))))) return false;
        change_.depth = std::max(change_.depth, difference);
        return true;
    }
    bool turned(std::size_t pixel) {
        const Vec3d na = normal_at(a_, pixel), nb = normal_at(b_, pixel);
        if (na == Vec3d{} || nb == Vec3d{}) return na != nb;
        const double angle = angle_deg(na, nb);
        change_.turn_deg = std::max(change_.turn_deg, angle);
        return angle > kMostTurnDeg;
    }

    const ViewShot &a_, &b_;
    int max_codes_;
    ViewChange& change_;
    Vec3d back_;
};

/// B in grey, darker than it is, and the changes over it.
Image marked_picture(const Image& b, const std::vector<PixelChange>& changes, const ChangedBox& box) {
    Image marked{b.width, b.height, {}, {}};
    marked.rgba8.reserve(b.rgba8.size());
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const std::uint8_t* const p = &b.rgba8[4 * i];
        const int grey = (54 * p[0] + 183 * p[1] + 19 * p[2]) / 256 * 5 / 8;
        const std::uint8_t* const color = kPixelChangeColors[static_cast<std::size_t>(changes[i])];
        for (std::size_t c = 0; c < 3; ++c)
            marked.rgba8.push_back(static_cast<std::uint8_t>(changes[i] == PixelChange::none ? grey : (grey + 3 * color[c]) / 4));
        marked.rgba8.push_back(255);
    }
    if (box.width == 0) return marked;
    Canvas canvas(std::move(marked));
    const double x0 = box.x - kBoxRoom - 0.5, y0 = box.y - kBoxRoom - 0.5;
    const double x1 = box.x + box.width + kBoxRoom + 0.5, y1 = box.y + box.height + kBoxRoom + 0.5;
    constexpr Color kLine{0xf2, 0xf2, 0xf2};
    canvas.line({x0 - 0.5, y0}, {x1 + 0.5, y0}, 1, kLine), canvas.line({x0 - 0.5, y1}, {x1 + 0.5, y1}, 1, kLine);
    canvas.line({x0, y0}, {x0, y1}, 1, kLine), canvas.line({x1, y0}, {x1, y1}, 1, kLine);
    return canvas.take();
}

}  // namespace

std::uint64_t ViewChange::changed() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < kPixelChanges; ++i) sum += pixels[i];
    return sum;
}

double ViewChange::share() const { return static_cast<double>(changed()) / static_cast<double>(changed() + pixels[0]); }

double depth_step(double pixel, double steepest_cosine, double depth) {
    constexpr double kSteepest = 20.0;
    const double c = std::min(steepest_cosine, 1.0);
    const double slope = c > 1.0 / 32 ? std::min(std::sqrt(1.0 - c * c) / c, kSteepest) : kSteepest;
    return pixel / 64 * (1.0 + slope) + depth / (1 << 20);
}

ViewChange compare_shots(ViewShot a, ViewShot b, int max_codes, double distance) {
    ViewChange change;
    change.name = a.name;
    change.pixel = pixel_size(a.camera, a.width(), a.height(), distance);
    PixelComparison comparison(a, b, max_codes, change);
    std::vector<PixelChange> changes(a.instance.size());
    std::uint64_t both = 0, any = 0;
    int low_x = a.width(), low_y = a.height(), high_x = -1, high_y = -1;
    for (std::size_t i = 0; i < changes.size(); ++i) {
        changes[i] = comparison.of(i);
        ++change.pixels[static_cast<std::size_t>(changes[i])];
        both += a.instance[i] > 0 && b.instance[i] > 0, any += a.instance[i] > 0 || b.instance[i] > 0;
        if (changes[i] == PixelChange::none) continue;
        const int x = static_cast<int>(i % static_cast<std::size_t>(a.width())),
                  y = static_cast<int>(i / static_cast<std::size_t>(a.width()));
        low_x = std::min(low_x, x), high_x = std::max(high_x, x), low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    }
    if (any > 0) change.iou = static_cast<double>(both) / static_cast<double>(any);
    if (high_x >= 0) change.box = {low_x, low_y, high_x - low_x + 1, high_y - low_y + 1};
    change.marked = marked_picture(b.picture, changes, change.box);
    change.a = std::move(a.picture), change.b = std::move(b.picture);
    return change;
}

}  // namespace halflit::engine
