// Mutations that know formats. What is not of the format is given to libFuzzer's own.
#pragma once

#include "tests/fuzz/target.hpp"

#include <string>

namespace halflit::fuzz {

/// JSON of a glTF file: its nodes. Bytes in data URIs are mutated as what they hold.
void mutate_gltf_json(Bytes& text, std::size_t max_bytes, Random& random);

/// A GLB container: one of its chunks, with lengths that are right again, mostly.
void mutate_glb(Bytes& file, std::size_t max_bytes, Random& random);

/// A PNG: its chunks, with checksums that are right again. A JPEG: the bodies of its segments.
void mutate_picture(Bytes& file, std::size_t max_bytes, Random& random);

/// Vertices, indices and the like: replaces some values by others of 1, 2 or 4 bytes, floats that are seldom tried among them. The size
/// stays.
void mutate_values(Bytes& values, Random& random);

/// A picture, or else values.
void mutate_payload(Bytes& bytes, std::size_t max_bytes, Random& random);

}  // namespace halflit::fuzz
