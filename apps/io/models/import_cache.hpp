// What importers made, kept in a folder: the GLB of a file, by the file's bytes and the importer's words.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace halflit::io::detail {

class ImportCache {
public:
    /// folder: is made if it is missing; empty, or one that cannot be written: nothing is kept. program: words[0] is its path, and the
    /// program's own size and time count.
    ImportCache(const std::string& folder, const std::vector<std::string>& words, std::span<const std::byte> input);

    /// Nothing: it is not there, or it was changed there.
    [[nodiscard]] std::optional<std::vector<std::byte>> find() const;
    /// Removes those that were used least recently where all take more than 256 MiB.
    void keep(std::span<const std::byte> glb) const;

private:
    [[nodiscard]] std::string seal_of(std::span<const std::byte> glb) const;

    std::string folder_, path_;  ///< path_ is empty where nothing is kept
    std::vector<std::byte> key_;
};

/// A folder of the user's for programs: what the environment's variable says, or else `usual` in the home. Empty: there is none.
[[nodiscard]] std::string user_folder(const char* variable, const char* usual);

/// halflit/import in XDG_CACHE_HOME, or in ~/.cache; empty: there is no such place.
[[nodiscard]] std::string user_import_cache();

}  // namespace halflit::io::detail
