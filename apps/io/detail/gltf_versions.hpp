// Check of a file's glTF version, and of the extensions that it requires.
#pragma once

#include "apps/io/detail/gltf_document.hpp"

#include <string_view>

namespace halflit::io::detail {

/// True for an extension that this build draws.
[[nodiscard]] bool is_supported(std::string_view extension);

/// Throws LoadFailure for another major version, a minimum above 2.0, or a required extension that is not supported.
/// A later minor version without a minimum loads: by the specification a 2.0 reader can draw it.
void check_versions(const file::File& file);

/// Warns of what a file loses: extensions that it uses and that are not drawn, and animations. Warns of required extensions that the file
/// does not list as used.
void check_extensions(Document& document);

/// Of what an extension and the file itself hold, chooses what this build reads: the pictures of EXT_texture_webp and the compressed views
/// of EXT_meshopt_compression where the libraries are there, otherwise the file's other pictures and its views without compression.
void choose_forms(file::File& file);

}  // namespace halflit::io::detail
