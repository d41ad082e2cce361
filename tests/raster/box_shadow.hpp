// Shadows of boxes, against rays.
#pragma once

#include "sh/vec3d.hpp"
#include "tests/raster/shadow_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace halflit::test {

struct Box {
    Vec3d low, high;
};

/// True if the segment meets the box.
inline bool meets(Vec3d from, Vec3d to, const Box& box) {
    double enter = 0.0, leave = 1.0;
    for (const auto& [a, b, l, h] :
         {std::array{from.x, to.x, box.low.x, box.high.x}, {from.y, to.y, box.low.y, box.high.y}, {from.z, to.z, box.low.z, box.high.z}}) {
        const double d = b - a;
        if (d == 0.0) {
            if (a < l || a > h) return false;
            continue;
        }
        enter = std::max(enter, std::min((l - a) / d, (h - a) / d));
        leave = std::min(leave, std::max((l - a) / d, (h - a) / d));
    }
    return enter < leave;
}

inline bool meets_any(Vec3d from, Vec3d to, const std::vector<Box>& boxes) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return meets(from, to, box); });
}

/// A box of one metre that stands on the floor y = 0.
inline Box metre_box(Vec3d foot) { return {foot + Vec3d{-0.5, 0, -0.5}, foot + Vec3d{0.5, 1, 0.5}}; }
inline void add_metre_box(ShadowSetup& setup, Vec3d foot) {
    setup.add(make_box({0.5f, 0.5f, 0.5f}), translation(to_float(foot + Vec3d{0, 0.5, 0})));
}

inline constexpr int kSide = 400;
inline constexpr double kHalfView = 3.0;

struct ShadowArea {
    int hidden = 0;  ///< pixels of the floor that the light does not reach
    int drawn = 0;   ///< pixels that are dark
    int wrong = 0;   ///< pixels that are hidden by the map and not by rays, or the other way round
};

/// Camera that looks straight down at the floor around `foot`, without perspective: +z to the right, +x up.
inline Camera camera_above(Vec3d foot) {
    Camera camera = camera_at(to_float(foot + Vec3d{0, 5, 0}), to_float(foot));
    camera.orthographic = true;
    camera.half_height = static_cast<float>(kHalfView);
    camera.near_z = 1.0f;
    camera.far_z = 100.0f;
    return camera;
}

/// The floor at pixel (i, j) of such a camera.
inline Vec3d floor_at(Vec3d foot, int i, int j) {
    return foot + Vec3d{(1 - (j + 0.5) / kSide * 2) * kHalfView, 0, ((i + 0.5) / kSide * 2 - 1) * kHalfView};
}

/// Counts of the floor around a box of one metre, seen from above. distance: of the light from `foot`; 0: directional light.
inline ShadowArea shadow_area(ShadowSetup& setup, Vec3d foot, const std::vector<Box>& boxes, Vec3d to_light, double distance) {
    setup.camera = camera_above(foot);
    setup.settings.shadows = ShadowMode::off;
    const std::vector<float> lit = setup.draw(kSide, kSide);
    setup.settings.shadows = ShadowMode::hard;
    const std::vector<float> with = setup.draw(kSide, kSide);
    ShadowArea area;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            const Vec3d p = floor_at(foot, i, j), from_foot = p - foot;
            if (std::max(std::abs(from_foot.x), std::abs(from_foot.z)) < 0.51) continue;  // the box
            const bool hidden = meets_any(p, distance > 0 ? foot + to_light * distance : p + to_light * 100.0, boxes);
            const auto at = static_cast<std::size_t>(4 * (j * kSide + i));
            const bool dark = with[at] < 0.5f * lit[at];
            area.hidden += hidden;
            area.wrong += dark != hidden;
            area.drawn += dark;
        }
    return area;
}

/// The area of a shadow is right within 2 %, its outline within 4 %.
inline void check_area(const ShadowArea& area) {
    INFO(area.hidden << " pixels by rays, " << area.drawn << " drawn, " << area.wrong << " differ");
    CHECK(area.hidden > 1000);
    CHECK(std::abs(area.drawn - area.hidden) <= 0.02 * area.hidden);
    CHECK(area.wrong <= 0.04 * area.hidden);
}

}  // namespace halflit::test
