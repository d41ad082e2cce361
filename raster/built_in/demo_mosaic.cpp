#include "raster/built_in/demo_parts.hpp"

#include <algorithm>

namespace halflit::raster::detail {

namespace {

constexpr int kTile = 64;       // texels
constexpr double kJoint = 2.5;  // texels from the tile's border to its glaze
constexpr double kBevel = 9.0;  // texels over which the glaze bends down to the joint

struct Glaze {
    std::uint8_t red, green, blue;  // sRGB
    std::uint8_t roughness, metal;  // 255 is 1
    int weight;                     // share of the tiles, in 1/32
};
constexpr Glaze kGlazes[] = {
    {18, 84, 96, 70, 0, 9},      // petrol
    {40, 138, 142, 60, 0, 7},    // turquoise
    {22, 48, 84, 64, 0, 6},      // night blue
    {150, 196, 186, 80, 0, 4},   // celadon
    {226, 214, 188, 90, 0, 3},   // ivory
    {222, 160, 66, 84, 140, 3},  // gilt: half metal, because there is nothing here for metal to mirror
};

/// Hash of the tile's number: the finaliser of MurmurHash3.
std::uint32_t scramble(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
    x = (x ^ (x >> 13)) * 0xC2B2AE35u;
    return x ^ (x >> 16);
}

const Glaze& pick_glaze(std::uint32_t number) {
    int left = static_cast<int>(number % 32u);
    for (const Glaze& glaze : kGlazes)
        if ((left -= glaze.weight) < 0) return glaze;
    return kGlazes[0];
}

/// Slope of the tile's surface `place` texels from its left or upper edge: up over the bevel, level on top, down again.
double slope(double place) {
    const double edge = std::min(place, kTile - place) - kJoint;
    if (edge <= 0.0 || edge >= kBevel) return 0.0;
    const double t = 1.0 - edge / kBevel;
    return (place < 0.5 * kTile ? 1.0 : -1.0) * 1.1 * t;
}

std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5); }

}  // namespace

Mosaic make_mosaic(int columns, int rows) {
    Mosaic mosaic;
    mosaic.width = columns * kTile;
    mosaic.height = rows * kTile;
    const std::size_t bytes = 4 * static_cast<std::size_t>(mosaic.width) * static_cast<std::size_t>(mosaic.height);
    mosaic.color_srgb.reserve(bytes);
    mosaic.normal.reserve(bytes);
    mosaic.roughness_metal.reserve(bytes);
    for (int y = 0; y < mosaic.height; ++y)
        for (int x = 0; x < mosaic.width; ++x) {
            const std::uint32_t number = scramble(static_cast<std::uint32_t>((y / kTile) * columns + x / kTile) + 97u);
            const Glaze& glaze = pick_glaze(number);
            const double u = x % kTile + 0.5, v = y % kTile + 0.5;
            const bool joint = std::min({u, v, kTile - u, kTile - v}) < kJoint;
            // Variation as in handmade tiles: the colour varies by a tenth, the tilt by up to 3 degrees about each axis.
            const double tone = 0.9 + 0.1 * static_cast<double>((number >> 8) & 255u) / 255.0;
            const double tilt_x = 0.10 * (static_cast<double>((number >> 16) & 15u) / 15.0 - 0.5);
            const double tilt_y = 0.10 * (static_cast<double>((number >> 20) & 15u) / 15.0 - 0.5);
            // The height rises by slope(u) to the right and slope(v) downwards; the normal tilts the other way. Its y points up in the
            // texture.
            const double nx = joint ? 0.0 : tilt_x - slope(u), ny = joint ? 0.0 : tilt_y + slope(v);
            const double scale = 1.0 / __builtin_sqrt(nx * nx + ny * ny + 1.0);
            const auto color = [&](std::uint8_t c) { return joint ? to_byte(0.2) : to_byte(tone * c / 255.0); };
            mosaic.color_srgb.insert(mosaic.color_srgb.end(), {color(glaze.red), color(glaze.green), color(glaze.blue), 255});
            mosaic.normal.insert(mosaic.normal.end(),
                                 {to_byte(0.5 + 0.5 * nx * scale), to_byte(0.5 + 0.5 * ny * scale), to_byte(0.5 + 0.5 * scale), 255});
            mosaic.roughness_metal.insert(mosaic.roughness_metal.end(),
                                          {0, joint ? std::uint8_t{230} : glaze.roughness, joint ? std::uint8_t{0} : glaze.metal, 255});
        }
    return mosaic;
}

}  // namespace halflit::raster::detail
