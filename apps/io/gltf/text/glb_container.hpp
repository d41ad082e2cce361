// The GLB container: a 12-byte header, a JSON chunk, and at most one BIN chunk.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::io::detail {

struct GlbParts {
    std::span<const std::byte> json;
    std::span<const std::byte> bin;  ///< its padding included
    bool has_bin = false;
    std::vector<std::string> warnings;
};

/// Said of files of the format's first version.
inline constexpr const char* kIsFirstVersion =
    "is glTF 1.0, expected 2.0; convert it with gltf-pipeline: `npx gltf-pipeline -i OLD.gltf -o NEW.glb`";

[[nodiscard]] bool is_glb(std::span<const std::byte> file);
/// Bytes that the header of a GLB file promises and the file lacks; 0 for other files.
[[nodiscard]] std::size_t missing_bytes(std::span<const std::byte> file);

/// Checks every length before use. Chunks of unknown types are skipped. Unless `strict`, wrong lengths and a wrong order are warned of, and
/// what is there is read. The message has no file prefix.
Result<GlbParts> split_glb(std::span<const std::byte> file, bool strict = true);

}  // namespace halflit::io::detail
