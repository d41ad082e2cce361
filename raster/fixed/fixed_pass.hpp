// A view of a fixed-function frame: what its samples show, as codes.
//     shade: visibility, light and textures of each tile  ->  find_shadows  ->  compose: the samples of each tile
#pragma once

#include "raster/fixed/code_levels.hpp"
#include "raster/fixed/light_terms.hpp"
#include "raster/fixed/shadow_lookups.hpp"
#include "raster/passes/tile.hpp"

#include <deque>
#include <memory>
#include <span>
#include <vector>

namespace halflit::raster {

/// Codes of the samples of a part of the picture: red | green << 8 | blue << 16.
struct SampleImage {
    Region region{};
    int samples = 1;
    std::vector<std::uint32_t> codes;  ///< those of a pixel together
    MemoryShare memory;
    [[nodiscard]] std::size_t index(int x, int y) const {
        return (static_cast<std::size_t>(y - region.y) * static_cast<std::size_t>(region.width) + static_cast<std::size_t>(x - region.x)) *
               static_cast<std::size_t>(samples);
    }
};

/// What all views of a frame share.
struct FixedContext {
    const FixedFrame& frame;
    const PreparedData& scene;
    std::span<const std::shared_ptr<const CodeLevelsData>> textures;
    const RasterKernels& kernels;
    Executor& executor;
    Pool<TileScratch>& scratch;
};

/// Draws depth and ids of the visible items alone.
Result<void> draw_planes(const FixedContext& context, const View& view, ViewGeometry& geometry, const FixedTarget& target);

class FixedPass {
public:
    /// Finds what each tile shows, and its light but for shadows. maps: of the lights that have some; planes: where depth and ids go, or
    /// null.
    Result<void> shade(const FixedContext& context, const View& view, const VertexLight& light, std::span<const LightMap> maps,
                       const FixedTarget* planes);
    /// Pixels that show what mirrors; empty if none does.
    [[nodiscard]] const Region& mirror_region() const { return mirror_region_; }
    /// Draws the shadows of light number `in_turn` of those that have some.
    Result<void> find_shadows(const FixedContext& context, Executor& executor, const ShadowRule& rule, int in_turn, const LightMap& map,
                              LightOcclusion& occlusion);
    /// Adds everything up. in_mirror: null: nothing is seen in mirrors.
    void compose(const FixedContext& context, const SampleImage* in_mirror, SampleImage& out);

private:
    struct Fragment {
        std::uint32_t code;
        std::uint16_t at, samples;  ///< pixel of the tile; bit s: sample s shows it
        bool mirrors;
    };
    struct Layer {
        std::uint32_t code;  ///< with alpha
        std::uint16_t at, samples;
        std::uint32_t item;
    };
    struct Tile {
        std::vector<Fragment> fragments;
        std::vector<Layer> layers;
        std::vector<std::vector<ShadowLookup>> lit;  ///< of each light, where its light is not 0
        int x0, y0, x1, y1;                          ///< pixels that mirror
        MemoryShare memory;
        /// Counts the lists as the call's memory.
        void count_memory(StopSignal& stop);
    };
    class Shader;

    View view_;
    ViewGeometry geometry_;
    VertexRecords surface_;
    std::vector<std::unique_ptr<VertexRecords>> lights_;  ///< kLightsARecord lights each
    std::deque<Tile> tiles_;
    Region mirror_region_{};
};

}  // namespace halflit::raster
