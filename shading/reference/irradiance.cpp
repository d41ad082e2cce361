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

/// A part of the image: its middle weighted by solid angle, and radiance times solid angle over pi.
struct Patch {
    Vec3d direction, light;
};

/// Cuts large pixels and merges small ones into about 512 x 256 patches. A pixel is a patch of constant radiance.
std::vector<Patch> patches(const Environment& environment) {
    constexpr int kWidth = 512;  // columns; 256 for images that are no wider, whose patches are cut from constant pixels
    const sh::EquirectView image = environment.light->image();
    const int width = image.width, height = image.height;
    const int step = std::max(1, width / kWidth), cuts = std::max(1, kWidth / 2 / width);
    const sh::Rotation turn = sh::rotation_about_y(environment.rotate_rad);
    const double columns = static_cast<double>(width) * cuts, rows = static_cast<double>(height) * cuts;
    std::vector<Patch> out;
    // x and y count cuts of pixels. A patch is `step` of them along each axis where pixels are merged, and one where they are cut.
    for (int y = 0; y < height * cuts; y += step) {
        check_time();
        for (int x = 0; x < width * cuts; x += step) {
            Patch patch{};
            Vec3d middle{};
            for (int j = y; j < std::min(y + step, height * cuts); ++j) {
                const double solid_angle = 2.0 * kPi / columns * (std::cos(kPi * j / rows) - std::cos(kPi * (j + 1) / rows));
                for (int i = x; i < std::min(x + step, width * cuts); ++i) {
                    patch.light = patch.light + image.at(i / cuts, j / cuts) * (solid_angle / kPi);
                    middle = middle + sh::equirect_direction((i + 0.5) / columns, (j + 0.5) / rows) * solid_angle;
                }
            }
            patch.direction = turn * (middle * (1.0 / std::sqrt(dot(middle, middle))));
            out.push_back(patch);
        }
    }
    return out;
}

/// f(x) with x in [-1, 1], from a table: pow for every pixel and node would take minutes.
class LobeTable {
public:
    explicit LobeTable(const Lobe& lobe) {
        for (int i = 0; i <= kSize + 1; ++i) values_[static_cast<std::size_t>(i)] = lobe_value(lobe, std::min(1.0, 2.0 * i / kSize - 1.0));
    }
    [[nodiscard]] double at(double x) const {
        const double u = (std::clamp(x, -1.0, 1.0) + 1.0) * (0.5 * kSize);
        const auto i = static_cast<std::size_t>(u);
        return values_[i] + (u - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
    }

private:
    static constexpr int kSize = 1 << 16;
    std::vector<double> values_ = std::vector<double>(kSize + 2);
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
        for (const Patch& patch : patches_) total = total + patch.light * table_->at(dot(patch.direction, normal));
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
