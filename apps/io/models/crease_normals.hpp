// Normals of surfaces that have none: smooth, except across sharp edges.
#pragma once

#include "apps/io/models/soup.hpp"

namespace halflit::io::detail {

/// Gives a normal to each corner of `soup` that has none. position_of: equal positions have equal numbers; `corners`: those at each of
/// them. Two triangles are smooth across an edge if they are its only ones, turn the same way, and their normals differ by at most
/// `crease_deg`, up to twice that in scans and in strips that bend to and fro, or their smoothing groups say so. Copies of a triangle count
/// once, and where each of two triangles has a back, both sides are smooth. Around a place, triangles that hang together by such edges
/// share a normal: the mean of theirs, weighted by their angles there. threads: as LoadOptions::threads; the result does not depend on it.
void add_crease_normals(Soup& soup, const CornersOfPlaces& corners, double crease_deg, int threads);

/// The angle between two directions, in radians, from its sine and cosine times any positive number. sine >= 0. Made of + - * / and sqrt
/// alone; error below 1e-12.
[[nodiscard]] double angle_of(double sine, double cosine);

}  // namespace halflit::io::detail
