// Which lights can be other than zero in a block of fragments. A light is left out only where its range window or its cone gives
// exactly zero at every fragment, so the sums keep their bits whatever the blocks are.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster {

/// What a selected list lives in.
struct LightSelection {
    std::vector<std::uint32_t> index;
    std::vector<shading::LightPlan> lights;
};

class LightCuller {
public:
    LightCuller() = default;
    /// Sorts the lights that have a range into groups of neighbours.
    explicit LightCuller(std::span<const shading::LightPlan> lights);

    /// Those of the same lights that `count` fragments need, from their world positions; `scratch` holds the list where it is not the
    /// whole.
    [[nodiscard]] shading::LightList select(std::span<const shading::LightPlan> lights, const shading::FragmentBlock& block, int count,
                                            LightSelection& scratch) const;

private:
    struct Box {
        float min[3], max[3];
    };
    struct Group {
        Box extent;  ///< of all its lights
        std::size_t first, end;
    };

    std::vector<std::uint32_t> ranged_;  ///< lights with a range, in groups
    std::vector<Group> groups_;
    std::vector<std::uint32_t> always_;  ///< the lights without a range, in list order
    bool any_spot_ = false;              ///< among these
};

}  // namespace halflit::raster
