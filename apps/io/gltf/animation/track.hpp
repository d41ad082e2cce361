// Key frames of one animated property, and its value at a time. From + - * / and sqrt alone, as it reaches pixels.
#pragma once

#include "apps/io/gltf/file/file.hpp"

#include <cstddef>
#include <vector>

namespace halflit::io::detail {

struct Track {
    file::Interpolation interpolation = file::Interpolation::linear;
    bool rotation = false;      ///< the values are quaternions
    std::size_t count = 1;      ///< numbers of a value
    std::vector<float> times;   ///< seconds, not falling, at least one
    std::vector<float> values;  ///< a value for each time; cubic: tangent towards it, value, tangent away from it
};

/// The value at a time: track.count numbers. Before the first key it is the first key's, after the last one the last key's. Of keys at one
/// time the last counts. False if it is not finite (within float's range).
[[nodiscard]] bool sample(const Track& track, double time_s, double* out);

/// The rotation between a and b, of any length > 0, on the shorter way; t in [0, 1]. The result has length 1. Within 1e-13 of the exact
/// one.
void slerp(const double a[4], const double b[4], double t, double out[4]);

}  // namespace halflit::io::detail
