#include "shading/reference/irradiance.hpp"

#include "sh/equirect.hpp"
#include "sh/time_limit.hpp"
#include "sh/zonal.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <optional>
#include <vector>

namespace halflit::shading::reference {
namespace irradiance {  // named, as a class of the header has members of these types

/// A part of the image: radiance times solid angle over pi, the mean direction that it comes from, which is shorter than 1, and half its
/// width along two directions across that.
struct Patch {
    Vec3d direction, light, along, across;
};

/// Cuts large pixels and merges small ones into some 512 x 256 patches, 256 x 128 for images that are no larger. A pixel is a patch of
/// constant radiance.
std::vector<Patch> patches(const Environment& environment) {
    constexpr int kWidth = 512, kHeight = 256;
    const sh::EquirectView image = environment.light->image();
    const int step_x = std::max(1, image.width / kWidth), cuts_x = std::max(1, kWidth / 2 / image.width);
    const int step_y = std::max(1, image.height / kHeight), cuts_y = std::max(1, kHeight / 2 / image.height);
    const int columns = image.width * cuts_x, rows = image.height * cuts_y;
    const sh::Rotation turn = sh::rotation_about_y(environment.rotate_rad);
    const double width_rad = 2.0 * kPi / columns;
    std::vector<Patch> out;
    // x and y count cuts of pixels. A patch is a step of them along each axis where pixels are merged, and one where they are cut.
    for (int y = 0; y < rows; y += step_y) {
        check_time();
        const int end_y = std::min(y + step_y, rows);
        for (int x = 0; x < columns; x += step_x) {
            const int end_x = std::min(x + step_x, columns);
            Vec3d light{}, direction{};
            double weight = 0.0;
            for (int j = y; j < end_y; ++j) {
                // Integrals over the cut of a row: of the solid angle, and of the direction's part along y and across it.
                const double top = kPi * j / rows, bottom = kPi * (j + 1) / rows, middle = 0.5 * (top + bottom);
                const double solid_angle = width_rad * (2.0 * std::sin(middle) * std::sin(0.5 * (bottom - top)));
                const double up = std::cos(middle) * std::cos(0.5 * (bottom - top));
                const double flat = (0.5 * (bottom - top) - 0.25 * (std::sin(2.0 * bottom) - std::sin(2.0 * top))) *
                                    (2.0 * std::sin(0.5 * width_rad)) / solid_angle;
                for (int i = x; i < end_x; ++i) {
                    const Vec3d color = image.at(i / cuts_x, j / cuts_y), level = sh::equirect_direction((i + 0.5) / columns, 0.5);
                    const Vec3d mean{level.x * flat, up, level.z * flat};
                    const double share = solid_angle * ((color.x + color.y) + color.z);
                    light = light + color * (solid_angle / kPi);
                    direction = direction + mean * share, weight += share;
                }
            }
            if (!(weight > 0.0)) continue;  // black
            const double middle = kPi * (0.5 * (y + end_y)) / rows, half_width = 0.5 * width_rad * (end_x - x) * std::sin(middle);
            const Vec3d level = sh::equirect_direction(0.5 * (x + end_x) / columns, 0.5);
            const Vec3d down{level.x * std::cos(middle), -std::sin(middle), level.z * std::cos(middle)}, side{-level.z, 0.0, level.x};
            out.push_back(
                {turn * (direction * (1.0 / weight)), light, turn * (down * (0.5 * kPi * (end_y - y) / rows)), turn * (side * half_width)});
        }
    }
    return out;
}

/// f(x) with x in [-1, 1], and its means over intervals, from a table of its integral: pow for every pixel and node would take minutes.
class LobeTable {
public:
    explicit LobeTable(const Lobe& lobe) {
        const auto value = [&](int i) { return lobe_value(lobe, std::clamp(2.0 * i / kSize - 1.0, -1.0, 1.0)); };
        for (int i = 0; i <= kSize; ++i)  // from -1 on; trapezes
            integral_[static_cast<std::size_t>(i + 1)] = integral_[static_cast<std::size_t>(i)] + (value(i) + value(i + 1)) / kSize;
    }
    /// Mean over [x - half, x + half], which may leave [-1, 1].
    [[nodiscard]] double mean(double x, double half) const {
        constexpr double kLeast = 2.0 / kSize;
        half = std::max(half, kLeast);
        const double low = std::max(x - half, -1.0), high = std::min(x + half, 1.0);
        return high > low ? (integral(high) - integral(low)) / (high - low) : 0.0;
    }

private:
    [[nodiscard]] double integral(double x) const {
        const double u = (x + 1.0) * (0.5 * kSize);
        const auto i = std::min(static_cast<std::size_t>(u), static_cast<std::size_t>(kSize - 1));
        return integral_[i] + (u - static_cast<double>(i)) * (integral_[i + 1] - integral_[i]);
    }
    static constexpr int kSize = 1 << 16;
    std::vector<double> integral_ = std::vector<double>(kSize + 2);
};

/// Face 2 axis + (negative ? 1 : 0) lies along that axis; u and v run along the two axes that follow it.
Vec3d direction_of(int face, double u, double v) {
    const double side = (face & 1) != 0 ? -1.0 : 1.0;
    const int axis = face >> 1;
    double d[3];
    d[axis] = side;
    d[(axis + 1) % 3] = u;
    d[(axis + 2) % 3] = v;
    const Vec3d out{d[0], d[1], d[2]};
    return out * (1.0 / std::sqrt(dot(out, out)));
}

/// Weights of the nodes -1, 0, 1, 2 for a point t in [0, 1]: the cubic through all four.
std::array<double, 4> cubic(double t) {
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
}

}  // namespace irradiance

using namespace irradiance;

/// The sums at the nodes, each made once.
class DirectIrradiance::Nodes {
public:
    Nodes(const Environment& environment, const Lobe& lobe) : environment_(environment), lobe_(lobe) {}

    [[nodiscard]] const Vec3d& at(int face, int j, int i) {
        const auto index = static_cast<std::size_t>((face * kNodes + j) * kNodes + i);
        if (!ready_[index].load(std::memory_order_acquire)) {
            const std::lock_guard lock(mutexes_[index % std::size(mutexes_)]);
            if (!ready_[index].load(std::memory_order_relaxed)) {
                sums_[index] = sum(face, j, i);
                ready_[index].store(true, std::memory_order_release);
            }
        }
        return sums_[index];
    }

    [[nodiscard]] const Vec3d& at_zero_normal() {
        prepare();
        return at_zero_normal_;
    }

private:
    void prepare() {
        const std::lock_guard lock(preparing_);
        if (table_) return;
        patches_ = patches(environment_);
        for (const Patch& patch : patches_) at_zero_normal_ = at_zero_normal_ + patch.light * lobe_value(lobe_, 0.0);
        table_.emplace(lobe_);
    }

    [[nodiscard]] Vec3d sum(int face, int j, int i) {
        prepare();
        // Nodes are at equal angles, so that the grid is about as fine in the corners as in the middle.
        const Vec3d normal =
            direction_of(face, std::tan(kPi / 4 * (2.0 * (i - 1) / kCells - 1.0)), std::tan(kPi / 4 * (2.0 * (j - 1) / kCells - 1.0)));
        Vec3d total{};
        for (const Patch& patch : patches_) {
            // If the light is even, directions within the patch are spread evenly along the normal, as nearly as their variance tells.
            const double along = dot(patch.along, normal), across = dot(patch.across, normal);
            total = total + patch.light * table_->mean(dot(patch.direction, normal), std::sqrt(along * along + across * across));
        }
        return total;
    }

    const Environment& environment_;
    const Lobe lobe_;
    std::mutex preparing_;
    std::vector<Patch> patches_;
    std::optional<LobeTable> table_;
    Vec3d at_zero_normal_{};  ///< N.L is 0 for all light
    std::mutex mutexes_[16];  ///< of the nodes, by their index
    std::vector<Vec3d> sums_ = std::vector<Vec3d>(std::size_t{6} * kNodes * kNodes);
    std::vector<std::atomic<bool>> ready_ = std::vector<std::atomic<bool>>(std::size_t{6} * kNodes * kNodes);
};

DirectIrradiance::DirectIrradiance(const Environment& environment, const Lobe& lobe) : nodes_(std::make_unique<Nodes>(environment, lobe)) {}

DirectIrradiance::~DirectIrradiance() = default;

Vec3d DirectIrradiance::at(Vec3d normal) const {
    const double d[3] = {normal.x, normal.y, normal.z};
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(d[k]) > std::fabs(d[axis])) axis = k;
    if (!(std::fabs(d[axis]) > 0)) return nodes_->at_zero_normal();
    const int face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    const auto place = [&](double tangent) { return (std::atan(tangent / std::fabs(d[axis])) * (4.0 / kPi) + 1.0) * (0.5 * kCells); };
    const double u = place(d[(axis + 1) % 3]), v = place(d[(axis + 2) % 3]);
    const int i = std::clamp(static_cast<int>(u), 0, kCells - 1), j = std::clamp(static_cast<int>(v), 0, kCells - 1);
    const std::array<double, 4> wu = cubic(u - i), wv = cubic(v - j);
    Vec3d sum{};
    for (int b = 0; b < 4; ++b)
        for (int a = 0; a < 4; ++a)
            sum = sum + nodes_->at(face, j + b, i + a) * (wu[static_cast<std::size_t>(a)] * wv[static_cast<std::size_t>(b)]);
    return sum;
}

}  // namespace halflit::shading::reference
