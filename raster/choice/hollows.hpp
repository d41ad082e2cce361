// Hollows that are open at the top: holes, pockets, the inside of a cup or of a room without a ceiling. They are seen from above alone.
#pragma once

#include "halflit/scene.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/scene/framed_part.hpp"
#include "sh/vec3d.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// The heights of a part of a scene as seen from straight above.
class Hollows {
public:
    /// box: around the part.
    Hollows(const Scene& scene, const FramedPart& part, const Bounds& box);
    /// Takes a triangle as each_triangle() gives it. Of many, some stand for all.
    void add(const std::array<Vec3d, 3>& at, bool both_sides) {
        const double normal_y = (at[1].z - at[0].z) * (at[2].x - at[0].x) - (at[1].x - at[0].x) * (at[2].z - at[0].z);
        if (!(magnitude(normal_y) < 1e300)) return;
        if (both_sides ? !(magnitude(normal_y) > 0.0) : !(normal_y > 0.0)) return;
        if (magnitude(normal_y) < large_ && small_++ % stride_ != 0) return;
        draw(at);
    }
    /// Share of what is covered that lies in hollows: where rain would stay, or run through.
    [[nodiscard]] double share() const;

private:
    void draw(const std::array<Vec3d, 3>& at);
    void put(int x, int z, double height);

    double low_x_ = 0, low_z_ = 0, per_length_ = 0, least_depth_ = 0;
    double large_ = 0;                    ///< twice the area of a triangle that covers half a cell
    std::size_t stride_ = 1, small_ = 0;  ///< one in so many triangles that are not large counts; number of those so far
    std::uint64_t looks_ = 0;             ///< examined cells
    std::vector<double> heights_;         ///< of cells; empty: the box is of no use
};

}  // namespace halflit::raster
