// Readers of the formats that are not glTF. Their rows are in formats.cpp.
#pragma once

#include "halflit/gltf.hpp"
#include "halflit/model.hpp"

#include <cstddef>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// A model's file.
struct ModelFile {
    std::span<const std::byte> bytes;
    std::string folder;  ///< for the files that it refers to; empty: none
    std::string name;    ///< without its folder; empty: not known
};

/// True if the length is exactly what the number of triangles of a binary STL file takes.
[[nodiscard]] bool fits_binary_stl(std::span<const std::byte> bytes);
/// A binary STL file that was cut off, or has more behind its triangles: a number of triangles, and a first triangle, that may be meant.
[[nodiscard]] bool looks_like_binary_stl(std::span<const std::byte> bytes);

/// True for the first word of an OFF file.
[[nodiscard]] bool is_off_header(std::string_view word);

/// These throw LoadFailure.
[[nodiscard]] LoadedScene read_off(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);
[[nodiscard]] LoadedScene read_stl(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);
[[nodiscard]] LoadedScene read_ply(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);
[[nodiscard]] LoadedScene read_obj(const ModelFile& file, const LoadOptions& options);
/// The largest picture in a file of G-code, as a scene; nothing: it has none.
[[nodiscard]] std::optional<LoadedScene> read_gcode_picture(const ModelFile& file, const LoadOptions& options);
/// Paths of all files that the model names, whether or not they exist.
[[nodiscard]] std::vector<std::string> files_of_obj(const ModelFile& file, const LoadOptions& options);
[[nodiscard]] std::vector<std::string> files_of_ply(std::span<const std::byte> bytes, const std::string& base_dir,
                                                    const LoadOptions& options);
/// Fails (usage) where the library was built without expat.
[[nodiscard]] LoadedScene read_three_mf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);

}  // namespace halflit::io::detail
