// Loader of models of any format that halflit reads, which it finds by the file's content: glTF, GLB, STL, PLY, OBJ with MTL, 3MF.
// What <halflit/gltf.hpp> says of limits and of files that are not trusted holds for all of them.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/gltf.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace halflit {

/// Formats of models. Scenes of all of them have y up; see LoadOptions::turn_upright.
enum class ModelFormat : std::uint8_t {
    gltf,     ///< glTF 2.0 as text
    glb,      ///< glTF 2.0 as GLB
    stl,      ///< ASCII or binary; z up; no unit: as it is
    ply,      ///< ASCII or binary; y up; no unit
    obj,      ///< with the materials of .mtl files; y up; no unit
    three_mf  ///< z up; in metres, by the file's unit. Needs libzip and expat
};

/// "glTF", "GLB", "STL", "PLY", "OBJ" or "3MF".
[[nodiscard]] HALFLIT_API std::string_view model_format_name(ModelFormat format);

/// The format of a file by its content, as load_model finds it; nothing if it is none of these.
[[nodiscard]] HALFLIT_API std::optional<ModelFormat> find_model_format(std::span<const std::byte> bytes);

/// True if the library was built with libzip and expat. Without them, 3MF files are refused by name.
[[nodiscard]] HALFLIT_API bool has_three_mf();

/// Loads the model at `path`; files that it refers to are read from its folder. Error messages begin with `path`. Thread-safe.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_model(const std::string& path, const LoadOptions& options = {});

/// Loads a model from memory, e.g. from standard input. `name` is for messages; an empty `base_dir` means that no other file is read.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_model_bytes(std::span<const std::byte> bytes, const std::string& name,
                                                               const std::string& base_dir, const LoadOptions& options = {});

}  // namespace halflit
