// A glTF file while it is loaded: its parsed JSON, its buffers, and the warnings.
#pragma once

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/file/animation_use.hpp"
#include "apps/io/gltf/file/file.hpp"
#include "apps/io/gltf/file/notes.hpp"
#include "apps/io/gltf/file/used.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "halflit/gltf.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

struct Document {
    const LoadOptions& options;
    ModelFolder folder;
    std::string mended;     ///< the JSON text, where it is not the file's
    std::string_view text;  ///< the JSON text
    Notes notes;            ///< what read_gltf_json found
    GlbParts glb;
    file::File file;
    AnimationUse animations;                          ///< set by find_animations()
    Used used;                                        ///< what the drawn nodes use; empty until settle() has run
    std::vector<std::span<const std::byte>> buffers;  ///< their bytes; those that nothing drawn uses are empty
    std::vector<std::vector<std::byte>> owned_buffers;
    std::vector<std::vector<std::byte>> decoded;  ///< bytes of the bufferViews that were compressed
    std::vector<std::string> warnings;
    std::size_t warnings_left_out = 0;
    SceneInfo info;
    /// Materials behind those of the file, without light, for points and lines without normals: copies of these, -1 being the default one.
    std::vector<int> unlit_copies;
    std::uint64_t file_bytes = 0;   ///< of the model's own file
    std::uint64_t named_bytes = 0;  ///< of files that it names, as far as they were read
    Budget geometry{"the geometry", 0}, encoded_images;
    std::optional<Error> first_failure;  ///< of what is left out

    Document(const LoadOptions& load_options, const std::string& base_dir)
        : options(load_options), folder(base_dir, load_options.allow_external) {}

    /// The bytes of a URI: of a data: URI, or of the file that it names. Throws LoadFailure.
    [[nodiscard]] std::vector<std::byte> read_uri(std::string_view uri, const std::string& where);
    /// The file of a name that the model gives, at most max_file_bytes; unless strict, of one like it (ModelFolder::read_like), with a
    /// warning, or with its name in `found`.
    [[nodiscard]] Result<std::vector<std::byte>> read_named(std::string_view name, std::string* found = nullptr);
    /// Work that files of this size may take; see LoadLimits::max_work.
    [[nodiscard]] std::uint64_t allowed_work() const { return detail::allowed_work(options.limits, file_bytes + named_bytes); }
    /// Adds a warning; the first hundred different ones are kept.
    void warn(std::string what);
    /// The warnings, the last of which counts those that are left out.
    [[nodiscard]] std::vector<std::string> take_warnings();
    [[nodiscard]] bool warnings_are_full() const { return warnings_left_out > 0; }
    /// Goes on without an element: warns of its failure and of what is done instead. Throws the failure by the strict rules, and that of a
    /// limit.
    void go_on_without(const LoadFailure& failure, std::string_view instead);
    /// The bytes of a view that are there: by the strict rules, all. Throws LoadFailure for a view whose buffer is not read.
    [[nodiscard]] std::span<const std::byte> view_data(int buffer_view) const;
};

/// Words of a warning of a fault that does not touch the picture.
inline constexpr const char* kNothingUsesIt = "nothing that is drawn uses it";

}  // namespace halflit::io::detail
