// Eye-dome lighting: shading of a finished picture by its depths alone, for surfaces without normals.
//
// A surface is darker where its neighbours in the picture are nearer to the viewer: the more, the steeper the rise, as a rise over the
// distance between the two in space. So the result does not depend on the size of the picture, the field of view or the unit of length.
// A flat surface that faces the viewer is not changed, and one before a gap darkens what is behind it. After Boucheny, "Visualisation
// scientifique de grands volumes de données" (2009), whose differences of logarithms are ratios here.
#pragma once

#include "raster/detail/executor.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/output.hpp"
#include "raster/passes/view_geometry.hpp"

#include <span>

namespace halflit::raster {

/// The depths of a picture, and around it as far as they are read. Up to four samples of a pixel have one each.
class EyeDome {
public:
    static constexpr int kMostPlanes = 4;
    /// Where a depth is read beside a pixel: x and y in pixels; run: the way there.
    struct Neighbour {
        int x, y;
        float run;
    };

    /// Makes room for the depths of a plan's picture.
    void begin(const FramePlan& plan, Executor& executor);
    /// Keeps the depths of a tile. buffers: null for a tile without triangles.
    void keep(const TileRect& tile, const TileBuffers* buffers, const ViewGeometry& geometry);
    /// Darkens the pixels that are written, in all outputs of colours.
    void shade(const FramePlan& plan, const Output& output, Executor& executor) const;

private:
    void shade_block(const EyeDomePlan& dome, std::span<const Neighbour> neighbours, const Output& output, int x_px, int y_px,
                     int count) const;
    [[nodiscard]] float* at(int plane, int x_px, int y_px) {
        return depth_.data() + (static_cast<std::ptrdiff_t>(plane) * rows_ + (y_px - y0_)) * stride_ + (x_px - x0_);
    }
    [[nodiscard]] const float* at(int plane, int x_px, int y_px) const {
        return depth_.data() + (static_cast<std::ptrdiff_t>(plane) * rows_ + (y_px - y0_)) * stride_ + (x_px - x0_);
    }

    RawBuffer<float> depth_;  ///< as TileBuffers has it; negative on surfaces that are not shaded but darken others; 0: nothing
    int planes_ = 1, x0_ = 0, y0_ = 0, stride_ = 0, rows_ = 0, samples_ = 1;
    bool all_ = false;  ///< surfaces of triangles are shaded too
};

}  // namespace halflit::raster
