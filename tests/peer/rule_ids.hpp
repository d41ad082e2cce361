// Independent form of the coverage rules, by brute force and without clipping. It explains differences between two rasterizers.
#pragma once

#include "halflit/math.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::peer {

/// Rounding of window = ndc * half + half: after each operation, or once (as Mesa does on processors with fused multiply-add).
enum class Viewport { unfused, fused };

/// Painter's order over triangles in clip coordinates, w > 0. 1 + triangle number, 0 where nothing is drawn. Integer edge functions
/// over 24.8 fixed-point corners of any size; top-left rule; no clipping at all, so no rounding by it.
[[nodiscard]] std::vector<std::uint32_t> rule_ids(int width, int height, std::span<const Vec4f> clip_positions, Viewport viewport);

/// True when some corner of the triangle lies outside |x| <= limit_x * w, |y| <= limit_y * w: a clipper there would cut it.
[[nodiscard]] bool reaches_beyond(std::span<const Vec4f, 3> corners, float limit_x, float limit_y);

}  // namespace halflit::peer
