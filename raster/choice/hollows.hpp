// Hollows that are open at the top: holes, pockets, the inside of a cup or of a room without a ceiling. They are seen from above alone.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/framed_part.hpp"

namespace halflit::raster {

/// Share of what the part covers as seen from straight above that lies in hollows: where rain would stay, or run through. box: around the
/// part. Of many triangles, some stand for all.
[[nodiscard]] double share_of_hollows(const Scene& scene, const FramedPart& part, const Bounds& box);

}  // namespace halflit::raster
