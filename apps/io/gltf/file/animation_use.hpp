// The animations of a file that pose its scene, and what they move.
#pragma once

#include "apps/io/gltf/file/property.hpp"

#include <cstddef>
#include <vector>

namespace halflit::io::detail {

struct AnimationUse {
    struct Channel {
        Slot slot;
        std::size_t channel = 0;  ///< of the file's animation
    };
    struct Used {
        int animation = -1;  ///< of the file
        std::vector<Channel> channels;
    };
    int drawn = -1;          ///< the animation that poses the scene; -1: none
    std::vector<Used> used;  ///< it, or all of them if they are kept
    /// By node: its morph weights are animated, its own or its mesh's; it, or a node above it, is shown and hidden. Empty: none.
    std::vector<bool> morphs, hides;

    [[nodiscard]] bool morphs_node(std::size_t node) const { return node < morphs.size() && morphs[node]; }
    [[nodiscard]] bool hides_node(std::size_t node) const { return node < hides.size() && hides[node]; }
};

}  // namespace halflit::io::detail
