// The light of an environment as its image gives it: no bands, no suns taken out. Independent of halflit's reference.
#pragma once

#include "tests/adversary/trial.hpp"

#include <cstdint>
#include <vector>

namespace halflit::adversary {

/// True if the diffuse light of the environment can be added to a picture without it: no highlights (reflections are ten bands by
/// definition), no shadows (suns cast some, the image casts none), no textures or vertex colours, which the planes do not tell.
[[nodiscard]] bool whole_sky_applies(const Trial& trial);

/// Adds albedo times the light of the whole image to the pixels of `linear` (RGBA) that show an instance. Returns the linear error of the
/// sum itself.
double add_whole_sky(const Trial& trial, const std::vector<std::uint32_t>& instance, const std::vector<float>& normal,
                     std::vector<float>& linear);

/// Linear error of Accuracy::reference for an environment: 1e-5 of the light's largest value (shading/reference/irradiance.hpp). 0 without
/// an environment.
[[nodiscard]] double reference_slack(const Trial& trial);

}  // namespace halflit::adversary
