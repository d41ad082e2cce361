// The ZIP file of a 3MF model: its parts, unpacked under limits.
#pragma once

#include "apps/io/files/zip_file.hpp"
#include "apps/io/gltf/file/document.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

class ThreeMfPackage {
public:
    /// Throws LoadFailure. `bytes` must outlive the package.
    ThreeMfPackage(std::span<const std::byte> bytes, Document& document);

    /// A part's bytes; nothing if there is no such part. `name` may be a URI from the package's root, with or without a slash. Each part
    /// has at most LoadLimits::max_file_bytes, all of them max_total_bytes, and no more than 64 MB and 200 bytes for each byte of the
    /// package: text of meshes is packed 4 to 30 times. Throws LoadFailure above a limit, and for a part that cannot be unpacked.
    [[nodiscard]] std::optional<std::vector<std::byte>> read(const std::string& name);
    [[nodiscard]] bool has(const std::string& name) const { return find(name) != nullptr; }
    /// Names of the files with such an ending, in the order of the package, at most so many.
    [[nodiscard]] std::vector<std::string> names_ending(std::string_view ending, std::size_t most) const;

private:
    [[nodiscard]] const ZipFile::Entry* find(std::string_view name) const;

    Document& document_;
    ZipFile zip_;
    Budget unpacked_;
};

}  // namespace halflit::io::detail
