// Animations: which one poses the scene, what its channels move, and the file at a time.
#pragma once

#include "apps/io/gltf/animation/track.hpp"
#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/file/accessor.hpp"
#include "apps/io/gltf/file/property.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// An animation with its key frames.
struct Animation {
    struct Move {
        Slot slot;
        Track track;
    };
    int index = -1;  ///< in the file
    std::vector<Move> moves;
    double end_s = 0;  ///< time of the last key
};

/// Decides which animations are used (LoadOptions::animation, keep_animations), and finds what their channels move: sets
/// Document::animations, warns of channels that move nothing that is drawn, and gives the file's elements the numbers that are to be
/// written. Throws LoadFailure for a name that the file does not have.
void find_animations(Document& document);

/// Key frames of the animations that are used. Throws LoadFailure.
std::vector<Animation> read_animations(Document& document, const std::vector<Accessor>& accessors);

/// Writes the animation's values at a time. What is not finite keeps the file's value, as do cameras that would be invalid.
void apply(const Animation& animation, double time_s, file::File& file);

/// Names and lengths of all animations of the file; `read` are those whose keys were read.
std::vector<AnimationInfo> describe_animations(const file::File& file, const std::vector<Animation>& read);

}  // namespace halflit::io::detail
