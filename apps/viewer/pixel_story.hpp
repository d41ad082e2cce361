// What made a pixel: the triangle that its first sample shows, the light of each source, and the error of the result.
#pragma once

#include "apps/halflit/render/render_job.hpp"
#include "halflit/lobe.hpp"
#include "halflit/renderer.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace halflit::viewer {

/// Linear light after exposure, red, green and blue.
using Rgb3 = std::array<double, 3>;

/// One of the scene's lights at the pixel.
struct LightShare {
    std::size_t index = 0;  ///< into Scene::lights
    LightType type = LightType::directional;
    double distance = 0;             ///< from the surface, world units; 0 for directional lights
    double cosine = 0;               ///< N.L
    double lobe = 0, lambert = 0;    ///< the material's lobe there, and max(0, N.L)
    Rgb3 linear{};                   ///< in the pixel
    std::optional<double> unhidden;  ///< its light over that without shadows, in [0, 1]; none: it has no light here anyway
};

struct PixelStory {
    int x = 0, y = 0;
    std::array<int, 4> codes{};  ///< red, green, blue, alpha, 0 to 255
    bool hit = false;  ///< a surface that is not blended covers the first sample; otherwise nothing from here to `shares` is known
    std::size_t instance = 0, mesh = 0, triangle = 0;  ///< the triangle, line or point is numbered in its mesh
    Topology topology = Topology::triangles;
    std::string mesh_name, material;
    Lobe lobe;
    std::vector<Vec3d> corners;  ///< world space
    Vec3d position{}, normal{};  ///< world space; the normal that light falls on
    Rgb3 albedo{};
    double depth = 0, coverage = 0;

    std::vector<LightShare> shares;   ///< the brightest first
    std::size_t lights_left_out = 0;  ///< lights that were not looked at, beyond kMostShares
    Rgb3 around{};                    ///< ambient light or environment
    Rgb3 emitted{};                   ///< emission, unlit colour and transparent layers without light
    Rgb3 sum{};                       ///< of the pixel, before the tone curve

    std::string no_reference;  ///< why the error is not known; empty: it is
    Rgb3 reference_codes{};    ///< not rounded, by --accuracy reference
    Rgb3 error_codes{};        ///< distance of the picture's codes from them, before rounding
    double bound_codes = 0;    ///< the frame's promise; 0: none, as there is no error budget
};

/// Lights that are drawn alone to tell their share. The nearest to be bright come first.
inline constexpr std::size_t kMostShares = 32;

/// Draws the pixel by itself, some times for each light. The job's lights are changed meanwhile, and put back. Requires: (x, y) in the
/// picture.
[[nodiscard]] Result<PixelStory> tell_pixel(cli::RenderJob& job, Renderer& renderer, int x, int y);

/// Lines for people.
[[nodiscard]] std::string story_text(const PixelStory& story);

}  // namespace halflit::viewer
