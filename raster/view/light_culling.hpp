// Selection of the lights that a block of fragments needs. A light is left out only if its range, cutoff radius or cone makes it exactly
// zero at every fragment of the block. So the sums of light have the same bits however fragments are packed into blocks.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster {

/// Memory of a selected list.
struct LightSelection {
    std::vector<std::uint32_t> index;
    std::vector<shading::LightPlan> lights;
};

/// A box in world space.
struct PositionBox {
    double low[3], high[3];
};

class LightCuller {
public:
    LightCuller() = default;
    /// Sorts the lights that have a range or cutoff radius into groups of neighbours.
    explicit LightCuller(std::span<const shading::LightPlan> lights);

    /// Lights that the first `count` fragments of the block need, by their world positions. lights: those of the constructor. `scratch`
    /// holds the result if it is not the whole list.
    [[nodiscard]] shading::LightList select(std::span<const shading::LightPlan> lights, const shading::FragmentBlock& block, int count,
                                            LightSelection& scratch) const;

    /// The same for all points of a finite box.
    [[nodiscard]] shading::LightList select(std::span<const shading::LightPlan> lights, const PositionBox& box,
                                            LightSelection& scratch) const;

private:
    struct Box {
        float min[3], max[3];
    };
    struct Group {
        Box extent;  ///< box around the reach of its lights
        std::size_t first, end;
    };

    std::size_t light_count_ = 0;
    std::vector<std::uint32_t> ranged_;  ///< lights with a range or cutoff radius, in groups
    std::vector<Group> groups_;
    std::vector<std::uint32_t> always_;  ///< all other lights, in list order
    bool any_spot_ = false;              ///< one of always_ is a spot
};

}  // namespace halflit::raster
