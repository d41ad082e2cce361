// The public entry: a scene and a camera in, pixels out.
#pragma once

#include "raster/view/camera.hpp"
#include "raster/framebuffer.hpp"
#include "raster/scene/scene.hpp"
#include "raster/work_counts.hpp"
#include "shading/kernels/isa.hpp"
#include "shading/plan/plan.hpp"
#include "shading/result.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace halflit::raster {

/// The part of the picture to draw, in pixels; width 0 means all of it. Pixels outside are not touched.
struct Region {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Runs body(i) for every i in [0, count), in any order, on any threads, and returns when all are done.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

struct Settings {
    Region region{};
    int samples = 1;                       ///< a pixel: 1, 4 or 8
    int tile_size = 64;                    ///< 16, 32 or 64; changes speed, never a pixel
    int threads = 0;                       ///< 0: one a core; changes speed, never a pixel
    Result<shading::Isa> isa = shading::default_isa();  ///< changes speed, never a pixel
    Vec4f background_linear{0, 0, 0, 0};   ///< linear colour, not premultiplied; w = 0 is transparent
    bool background_environment = false;   ///< the scene's environment instead, where it kept its image
    float exposure = 1.0f;                 ///< factor on all light, > 0
    shading::PlanOptions shading{};
    shading::ShadowMode shadows = shading::ShadowMode::soft_split;
    int shadow_size = 2048;    ///< texels on a side of a shadow map, a power of two from 64 to 4096; a cube's faces have half
    std::size_t shadow_memory_limit = std::size_t{256} << 20;  ///< bytes; shadow maps are halved in size until all fit
    float shadow_fade = 0.0f;  ///< soft_split: blocker distance where wrapped light is gone, world units; 0: from object size and wrap
    bool shadow_terminator_offset = false;  ///< coarse meshes look shadows up where their normals' surface would be
    ParallelFor parallel_for{};            ///< the hook for a host's own threads; empty: oneTBB
    const std::function<bool()>* cancelled = nullptr;  ///< asked at tile borders; true stops the frame with an error
};

/// How the frame's materials of one lobe take the light of the scene's environment.
struct EnvironmentUse {
    int bands = 0;          ///< of spherical harmonics, 1..10
    double bound = 0;       ///< no normal's light is off by more, white surface, worst channel, before exposure
    bool within = true;     ///< whether that times the exposure is within the tolerance
    bool specular = false;  ///< what surfaces reflect like mirrors, which may be off by twice the tolerance; otherwise diffuse light
};

/// What a frame did. Times in milliseconds of wall clock.
struct RenderReport {
    struct StageTimes {
        double plan = 0, shadows = 0, transform = 0, bin = 0, tiles = 0;
    } ms;
    double total_ms = 0;
    int threads = 1;
    shading::Isa isa = shading::Isa::scalar;
    std::uint64_t triangles_submitted = 0, triangles_drawn = 0;   ///< drawn: those that reached a tile's list
    std::uint64_t triangles_not_finite = 0;                       ///< dropped for a NaN or infinite vertex
    std::uint64_t pixels_visible = 0, fragments_shaded = 0;
    std::uint64_t nan_pixels = 0;                                 ///< written as 0
    WorkCounts work;                                              ///< of fragments_shaded, stage by stage
    std::vector<EnvironmentUse> environment;                      ///< of the materials that are drawn, each lobe once
    shading::ErrorBound error;                                    ///< with a budget: what was promised
    std::vector<std::string> warnings;
};

/// Keeps working memory between frames; one frame at a time for each Renderer, any number of Renderers at once.
class Renderer {
public:
    Renderer();
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One picture, with its own Renderer.
Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

}  // namespace halflit::raster
