// Files of 3D Gaussians.
#pragma once

#include "apps/io/gltf/codecs/splat_cloud.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/ply_header.hpp"

#include <optional>

namespace halflit::io::detail {

class ModelBuilder;

/// Adds and places them, by their axes.
[[nodiscard]] LoadedScene finish_splats(ModelBuilder& builder, SplatCloud&& cloud);

/// Reads the splats of a PLY file, compressed ones too; nothing: it has none.
[[nodiscard]] std::optional<SplatCloud> read_ply_splats(const PlyHeader& header, Document& document);

/// These throw LoadFailure; nothing: the file has another format.
[[nodiscard]] std::optional<LoadedScene> read_splat_file(const ModelFile& file, const LoadOptions& options);
[[nodiscard]] std::optional<LoadedScene> read_spz_file(const ModelFile& file, const LoadOptions& options);
[[nodiscard]] std::optional<LoadedScene> read_sog_file(const ModelFile& file, const LoadOptions& options);

}  // namespace halflit::io::detail
