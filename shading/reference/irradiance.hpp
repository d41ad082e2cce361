// Environment light for the float64 reference.
#pragma once

#include "halflit/lobe.hpp"
#include "shading/environment.hpp"
#include "shading/reference/reference.hpp"

#include <memory>

namespace halflit::shading::reference {

/// Largest power of lobes that DirectIrradiance resolves.
inline constexpr float kSharpestIntegrated = 32.0f;

/// (1/pi) integral of L f in double, over some 512 x 256 patches of the image, at the nodes of six square grids, with cubic interpolation
/// between the nodes. The lobe is averaged over each patch. Error: 1e-6 of the image's largest value for smooth lobes, 1e-5 up to the power
/// kSharpestIntegrated. A node is summed where it is first asked for, in about 1 ms; all of them take 5 s.
class DirectIrradiance final : public Irradiance {
public:
    /// Requires: the environment was made with keep_light, and outlives this.
    DirectIrradiance(const Environment& environment, const Lobe& lobe);
    ~DirectIrradiance() override;
    /// Any number of threads may call it.
    [[nodiscard]] Vec3d at(Vec3d normal) const override;

private:
    static constexpr int kCells = 32, kNodes = kCells + 3;  ///< on a side of a face; one ring of nodes lies beyond each edge
    class Nodes;
    std::unique_ptr<Nodes> nodes_;
};

}  // namespace halflit::shading::reference
