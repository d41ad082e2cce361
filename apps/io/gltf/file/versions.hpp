// Check of a file's glTF version, and of the extensions that it requires.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <string_view>

namespace halflit::io::detail {

/// True for an extension that this build draws.
[[nodiscard]] bool is_supported(std::string_view extension);

/// Throws LoadFailure for another major version, a minimum above 2.0, or a required extension that is not supported; unless `strict`, of
/// these only for one without whose library shapes cannot be read, and not for a version that is not there.
/// A later minor version without a minimum loads: by the specification a 2.0 reader can draw it.
void check_versions(const file::File& file, bool strict);

/// Warns of what a file loses: extensions that it uses and that are not drawn, and animations. Warns of required extensions that the file
/// does not list as used.
void check_extensions(Document& document);

/// Chooses between the two forms of a picture or a buffer view that a file may hold: WebP (EXT_texture_webp), KTX2
/// (KHR_texture_basisu) and meshopt
/// (EXT_meshopt_compression) where this build has the library, otherwise the file's other picture or uncompressed view.
void choose_forms(file::File& file);

}  // namespace halflit::io::detail
