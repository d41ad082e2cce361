// Environment light for the float64 reference.
#pragma once

#include "halflit/lobe.hpp"
#include "shading/environment.hpp"
#include "shading/reference/reference.hpp"

#include <vector>

namespace halflit::shading::reference {

/// Largest power of lobes that DirectIrradiance resolves.
inline constexpr float kSharpestIntegrated = 32.0f;

/// (1/pi) integral of L f by direct summation in double, over some 512 x 256 patches of the image, at the nodes of six square grids, with
/// cubic interpolation between the nodes. Error: about 1e-5 of the light's largest value for lobes up to the power kSharpestIntegrated.
/// Sharper lobes become narrower than the patches: under a uniform sky one of power 8192 is off by a third near the poles of the image.
/// Takes 2 to 3 s.
class DirectIrradiance final : public Irradiance {
public:
    /// Requires: the environment was made with keep_light.
    DirectIrradiance(const Environment& environment, const Lobe& lobe);
    [[nodiscard]] Vec3d at(Vec3d normal) const override;

private:
    static constexpr int kCells = 32, kNodes = kCells + 3;  ///< on a side of a face; one ring of nodes lies beyond each edge
    Vec3d at_zero_normal_{};                                ///< N.L is 0 for all light
    std::vector<Vec3d> nodes_ = std::vector<Vec3d>(std::size_t{6} * kNodes * kNodes);
};

}  // namespace halflit::shading::reference
