// Splats that a pixel shows.
#pragma once

#include "halflit/explain.hpp"
#include "raster/scene/prepared_data.hpp"

namespace halflit::raster {

/// Sets PixelStory::splats and what belongs to it: of splats in front of a depth, by the sizes and the place of the story's pixel.
void tell_splats(const PreparedData& data, const Camera& camera, double most_depth, PixelStory& story);

}  // namespace halflit::raster
