// Cascades: finer shadow maps of a directional light for what a picture sees near its camera.
#pragma once

#include "raster/scene/prepared_data.hpp"
#include "raster/view/shadow_cut.hpp"

#include <functional>
#include <vector>

namespace halflit::raster {

/// Depth in the picture from which on it may see something: of the boxes of instances and clusters, cut to its view. 1e300: it sees none.
[[nodiscard]] double nearest_depth(const PreparedData& scene, const SeenVolume& seen);

/// Depths in the picture up to which the cascades before the last one reach, rising; none: one map is enough. view: the directional
/// light's, not cut. nearest: gives nearest_depth(); it is called only where cascades may be worth it.
[[nodiscard]] std::vector<double> cascade_depths(const FittedView& view, int size, const SeenVolume& seen,
                                                 const std::function<double()>& nearest);

/// The views of the cascades before the last one, from the finest on. last: that of the last one, cut from `view`. May be fewer than the
/// depths: those that show no shadow are left out, and those that are not finer than half the next one.
[[nodiscard]] std::vector<FittedView> cascade_views(const FittedView& view, const FittedView& last, int size, const SeenVolume& seen,
                                                    const std::vector<double>& depths, const Bounds& scene);

}  // namespace halflit::raster
