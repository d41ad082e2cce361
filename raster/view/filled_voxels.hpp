// The voxels, at most 64 on a side, that a scene's opaque triangles pass through, a bit each.
//
// They depend on the geometry alone, so pictures of a scene that stands still share them. Voxels lie at multiples of their size, and sizes
// are steps: where parts of a scene move, most frames have one grid of voxels.
#pragma once

#include "raster/scene/prepared_data.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace halflit::raster {

/// Bits in rows along one axis, which lie in layers.
struct BitGrid {
    using Word = std::uint64_t;

    int layers = 0, rows = 0;
    std::vector<Word> words;

    BitGrid() = default;
    BitGrid(int layer_count, int row_count)
        : layers(layer_count), rows(row_count), words(static_cast<std::size_t>(layer_count) * static_cast<std::size_t>(row_count)) {}
    [[nodiscard]] Word* layer(int at) { return &words[index(at, 0)]; }
    [[nodiscard]] const Word* layer(int at) const { return &words[index(at, 0)]; }
    [[nodiscard]] Word& row(int layer, int at) { return words[index(layer, at)]; }
    [[nodiscard]] Word row(int layer, int at) const { return words[index(layer, at)]; }

private:
    [[nodiscard]] std::size_t index(int layer, int at) const { return static_cast<std::size_t>(layer * rows + at); }
};

/// Voxels free of triangles at each side: where the outermost surfaces look.
inline constexpr int kFreeVoxels = 4;

/// Rows along x, in layers of z.
struct FilledVoxels {
    std::optional<SceneRevision> revision;  ///< of the scene, without that of its lights; none: nothing is made yet
    BitGrid bits;                           ///< empty: the scene has no size, or one that voxels cannot have
    int size[3] = {0, 0, 0};
    double origin[3] = {0, 0, 0};  ///< a corner of the first voxel, world space
    double per_length = 0;         ///< voxels in a world unit
    double lowest = 0;             ///< the scene's least y, world space
};

/// Marks the voxels unless they are this scene's already.
void fill_voxels(const PreparedData& scene, FilledVoxels& voxels);

}  // namespace halflit::raster
