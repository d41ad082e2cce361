// Splats (halflit/splats.hpp): projected in double, and blended over the finished picture, row by row of its squares, by distance.
#pragma once

#include "raster/detail/executor.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/output.hpp"
#include "raster/scene/prepared_data.hpp"

#include <span>
#include <vector>

namespace halflit::raster {

class SplatPicture {
public:
    /// Makes room for the depths of a plan's picture. False if the scene has no splats.
    [[nodiscard]] bool begin(const PreparedData& scene, const FramePlan& plan, Executor& executor);
    /// Keeps the depths of a tile that has triangles.
    void keep(const TileRect& tile, const TileBuffers& buffers);
    struct Drawn {
        double left_out = 0, rounding = 0;  ///< largest errors of a pixel: by splats that were left out, and by the roundings of float32
        std::uint64_t pixels = 0;           ///< in which splats are seen, and no surface
        void add(const Drawn& part);        ///< another part of the picture
    };
    /// Blends the splats over the pixels that are written, before what lies behind them; width, height: of the whole picture. Errors are in
    /// codes.
    Drawn draw(const PreparedData& scene, const FramePlan& plan, const Output& output, const RasterKernels& kernels, int width, int height,
               Executor& executor);

private:
    static constexpr int kMostPlanes = 4;  ///< samples of a pixel whose depths are kept

    void project(const PreparedData& scene, const FramePlan& plan, const RasterKernels& kernels, int width, int height, bool numbered,
                 Executor& executor);
    /// Lists for each row of squares the records that may show there.
    void list_rows(const Region& part, Executor& executor);
    void draw_row(const FramePlan& plan, const Output& output, const RasterKernels& kernels, int row, Executor& executor);
    /// Errors are those of a colour.
    Drawn draw_square(const FramePlan& plan, const Output& output, const RasterKernels& kernels, int x_px, int y_px,
                      std::span<const SplatRecord> records, std::span<const std::uint32_t> list, std::span<const std::uint32_t> of_row,
                      float largest, Executor& executor) const;
    /// Sets the distances from which on splats are hidden at a sample of the square's pixels. False: at none.
    [[nodiscard]] bool set_limits(const FramePlan& plan, int plane, int x_px, int y_px, SplatTile& tile) const;
    /// Distance code of a pixel; 0: no surface.
    [[nodiscard]] float depth_at(int plane, int x, int y) const;
    /// Returns Drawn::pixels.
    std::uint64_t write(const FramePlan& plan, const Output& output, const SplatTile& tile, int x_px, int y_px) const;
    /// Where splats hide half of what is behind them. of_row: numbers of the row's records.
    void write_planes(const FramePlan& plan, const Output& output, const SplatTile& tile, int x_px, int y_px,
                      std::span<const std::uint32_t> of_row) const;

    RawBuffer<float> depth_;        ///< [plane][row][column] of the region; 0: nothing
    int planes_ = 0, samples_ = 1;  ///< planes_: of depth_; 0: the scene has no surfaces
    Region region_{};
    bool linear_light_ = false;
    double background_[4]{}, background_codes_[4]{};  ///< codes / 255 of the plain background, and its alpha; the same rounded

    /// Largest errors of a colour by leaving out splats of each kind.
    struct Budget {
        double reach = 0;   ///< out of reach
        double faint = 0;   ///< faint in a square
        double drawn = 0;   ///< faint in a block, or hidden there
        double passed = 0;  ///< behind nearly opaque ones
    };
    Budget budget_;
    float least_log2_ = 0;  ///< alpha of less than 2^this is out of reach

    struct Rows {
        std::int16_t first, end;  ///< rows of squares that a splat may show in
    };
    RawBuffer<SplatRecord> records_;
    RawBuffer<double> distances_;       ///< in the order of records
    RawBuffer<std::uint32_t> numbers_;  ///< in the scene, in the order of records; only for planes of numbers
    std::vector<std::pair<std::uint32_t, std::uint32_t>> first_of_instance_;  ///< number of its first splat, and the instance
    RawBuffer<Rows> rows_;
    std::vector<Drawn> row_drawn_;  ///< of each row of squares
    std::size_t count_ = 0;
    std::vector<std::size_t> row_first_;  ///< places in row_list_, of each row of squares, and the end
    RawBuffer<std::uint32_t> row_list_;   ///< numbers of records: in their order, then by distance
    /// Of a row of squares while it is drawn.
    struct RowScratch {
        RawBuffer<SplatRecord> records;
        RawBuffer<std::uint64_t> order;  ///< of sort_by_distance()
        RawBuffer<std::uint32_t> list;
        RawBuffer<std::uint8_t> depths;
        RawBuffer<std::uint16_t> spans;  ///< first and last square of each record
    };
    Pool<RowScratch> scratch_;
};

}  // namespace halflit::raster
