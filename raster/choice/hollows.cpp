#include "raster/choice/hollows.hpp"

#include <algorithm>
#include <queue>
#include <utility>

namespace halflit::raster {
namespace {

constexpr int kCells = 64;             ///< on the longer side of what is seen from above
constexpr int kSide = kCells + 2;      ///< with a border that nothing covers
constexpr double kLeastDepth = 0.02;   ///< of a hollow, over the longest side of the box
constexpr double kUncovered = -1e300;  ///< height where nothing is
constexpr std::size_t kMostTriangles = 1 << 16;
constexpr std::uint64_t kMostLooks = std::uint64_t{1} << 24;  ///< most examined cells (.2 s), beyond which a triangle counts by its middle

int cell(double at) { return static_cast<int>(std::clamp(at, 0.0, kCells - 1.0)); }

}  // namespace

Hollows::Hollows(const Scene& scene, const FramedPart& part, const Bounds& box) {
    const Vec3d side = to_double(box.max) - to_double(box.min);
    const double longer = std::max(side.x, side.z), longest = std::max(longer, side.y);
    if (box.empty || !(longer > 0.0 && longest < 1e37)) return;
    std::size_t count = 0;
    for (const int i : part.instances)
        count += triangles_of(scene.meshes[static_cast<std::size_t>(scene.instances[static_cast<std::size_t>(i)].mesh)]);
    stride_ = count / kMostTriangles + 1;
    low_x_ = box.min.x, low_z_ = box.min.z, per_length_ = kCells / longer;
    large_ = longer * longer / (kCells * kCells);
    least_depth_ = kLeastDepth * longest;
    heights_.assign(static_cast<std::size_t>(kSide) * kSide, kUncovered);
}

void Hollows::draw(const std::array<Vec3d, 3>& at) {
    if (heights_.empty()) return;
    Vec3d p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = {(at[k].x - low_x_) * per_length_, at[k].y, (at[k].z - low_z_) * per_length_};
    const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [low_z, high_z] = std::minmax({p[0].z, p[1].z, p[2].z});
    const double twice_area = (p[1].x - p[0].x) * (p[2].z - p[0].z) - (p[2].x - p[0].x) * (p[1].z - p[0].z);
    bool any = false;
    if (twice_area != 0.0 && looks_ < kMostLooks) {
        looks_ += static_cast<std::uint64_t>(cell(high_z) - cell(low_z) + 1) * static_cast<std::uint64_t>(cell(high_x) - cell(low_x) + 1);
        for (int z = cell(low_z); z <= cell(high_z); ++z)
            for (int x = cell(low_x); x <= cell(high_x); ++x) {
                const double at_x = x + 0.5, at_z = z + 0.5;
                const auto share = [&](const Vec3d& a, const Vec3d& b) {
                    return ((b.x - a.x) * (at_z - a.z) - (at_x - a.x) * (b.z - a.z)) / twice_area;
                };
                const double w0 = share(p[1], p[2]), w1 = share(p[2], p[0]), w2 = share(p[0], p[1]);
                if (!(w0 >= 0.0 && w1 >= 0.0 && w2 >= 0.0)) continue;
                any = true;
                put(x, z, (w0 * p[0].y + w1 * p[1].y) + w2 * p[2].y);
            }
    }
    if (!any) put(cell((p[0].x + p[1].x + p[2].x) / 3.0), cell((p[0].z + p[1].z + p[2].z) / 3.0), (p[0].y + p[1].y + p[2].y) / 3.0);
}

/// Water that rises from the border fills each cell up to the lowest rim on its way there.
double Hollows::share() const {
    if (heights_.empty()) return 0.0;
    using Rim = std::pair<double, int>;  // height, cell
    const auto lowest_first = [](const Rim& a, const Rim& b) { return a.first > b.first; };
    std::priority_queue<Rim, std::vector<Rim>, decltype(lowest_first)> rims(lowest_first);
    std::vector<double> level(heights_.size(), kUncovered);
    std::vector<bool> reached(heights_.size(), false);
    reached[0] = true;
    rims.emplace(kUncovered, 0);
    while (!rims.empty()) {
        const auto [height, at] = rims.top();
        rims.pop();
        for (int dz = -1; dz <= 1; ++dz)
            for (int dx = -1; dx <= 1; ++dx) {
                const int x = at % kSide + dx, z = at / kSide + dz;
                if (x < 0 || x >= kSide || z < 0 || z >= kSide) continue;
                const auto next = static_cast<std::size_t>(z * kSide + x);
                if (reached[next]) continue;
                reached[next] = true;
                level[next] = std::max(heights_[next], height);
                rims.emplace(level[next], static_cast<int>(next));
            }
    }
    double covered = 0.0, hollow = 0.0;
    for (std::size_t i = 0; i < level.size(); ++i) {
        if (level[i] == kUncovered) continue;
        covered += 1.0;
        if (level[i] - heights_[i] > least_depth_) hollow += 1.0;
    }
    return covered > 0.0 ? hollow / covered : 0.0;
}

void Hollows::put(int x, int z, double height) {
    double& kept = heights_[static_cast<std::size_t>((z + 1) * kSide + x + 1)];
    kept = std::max(kept, height);
}

}  // namespace halflit::raster
