// The files in a ZIP file that is in memory, by its directory at the end: stored or deflated, not encrypted; sizes of 64 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

class ZipFile {
public:
    struct Entry {
        std::string_view name;
        std::uint64_t bytes = 0;  ///< unpacked
        std::uint64_t packed_bytes = 0;
        std::uint64_t header_at = 0;  ///< in the ZIP file
        std::uint32_t crc = 0;
        unsigned method = 0;
        bool encrypted = false;
    };

    /// Throws LoadFailure if there is no directory, a part of it is missing, or it has more than a million entries. `bytes` must outlive
    /// the object.
    explicit ZipFile(std::span<const std::byte> bytes);

    /// In the order of the directory.
    [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
    /// The first entry of that name, the case of ASCII letters and the way that slashes lean aside; null: there is none.
    [[nodiscard]] const Entry* find(std::string_view name) const;
    /// Writes an entry's bytes to `to`, which has as many. Throws LoadFailure for an entry that cannot be unpacked.
    void unpack(const Entry& entry, std::span<std::byte> to) const;
    /// Throws LoadFailure if so many bytes cannot come of what the entry has packed, before memory is taken for them.
    void check_size(const Entry& entry) const;

private:
    [[nodiscard]] std::span<const std::byte> packed(const Entry& entry) const;

    std::span<const std::byte> bytes_;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> by_name_;  ///< indices of entries in the order of find()
};

}  // namespace halflit::io::detail
