// Changes in one view of two models, pixel by pixel.
#pragma once

#include "apps/engine/look/view_shot.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace halflit::engine {

/// The first of these that holds for a pixel.
enum class PixelChange : std::uint8_t {
    none,
    added,     ///< only B has a surface there
    removed,   ///< only A has
    moved,     ///< the surfaces' depths differ by more than depth_step() of the pixel
    turned,    ///< their normals differ by more than kMostTurnDeg
    recolored  ///< a channel of the colours differs by more than the codes that are allowed
};
inline constexpr std::size_t kPixelChanges = 6;
inline constexpr std::array<const char*, kPixelChanges> kPixelChangeNames{"unchanged", "added", "removed", "moved", "turned", "recolored"};
inline constexpr double kMostTurnDeg = 2.0;

struct ChangedBox {
    int x = 0, y = 0, width = 0, height = 0;  ///< pixels; width 0: nothing changed
};

struct ViewChange {
    std::string name;
    Image a, b, marked;  ///< marked: B in grey, with what changed in the colours of kPixelChangeColors and a box around it
    std::array<std::uint64_t, kPixelChanges> pixels{};  ///< by PixelChange
    double iou = 1.0;       ///< of the masks: pixels that both models cover over those that one covers; 1 where none does
    double depth = 0.0;     ///< largest difference in depth of moved pixels, units of the drawn world
    double turn_deg = 0.0;  ///< largest angle between normals, over the pixels that both cover
    double pixel = 0.0;     ///< width of a pixel in the drawn world, at the middle of the scene
    ChangedBox box;
    [[nodiscard]] std::uint64_t changed() const;
    [[nodiscard]] double share() const;  ///< of all pixels
};

/// sRGB codes for each PixelChange.
inline constexpr std::uint8_t kPixelChangeColors[kPixelChanges][3] = {{0, 0, 0},      {64, 190, 90},   {225, 60, 60},
                                                                      {240, 165, 40}, {170, 110, 225}, {70, 140, 235}};

/// Difference in depth that is not a mark: what the snapping of vertices to 1/256 pixel and float32 allow. A 64th of a pixel, times 1 plus
/// the tangent of the steeper surface's slope to the view (at most 20), and 2^-20 of the depth.
[[nodiscard]] double depth_step(double pixel, double steepest_cosine, double depth);

/// Requires: two shots of one size by one camera, with pictures, depths and normals. distance: from the camera to the scene's middle.
[[nodiscard]] ViewChange compare_shots(ViewShot a, ViewShot b, int max_codes, double distance);

}  // namespace halflit::engine
