// Check of a file's glTF version, and of the extensions that it requires.
#pragma once

#include "apps/io/detail/gltf_file.hpp"

namespace halflit::io::detail {

/// Throws LoadFailure for another major version, a minimum above 2.0, or a required extension that is not supported.
/// A later minor version without a minimum loads: by the specification a 2.0 reader can draw it.
void check_versions(const file::File& file);

}  // namespace halflit::io::detail
