#include "apps/io/models/three_mf_package.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {
namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{64} << 20, kBytesPerByte = 200;

}  // namespace

ThreeMfPackage::ThreeMfPackage(std::span<const std::byte> bytes, Document& document)
    : document_(document),
      zip_(bytes),
      unpacked_("its unpacked parts",
                std::min<std::uint64_t>(document.options.limits.max_total_bytes, kFreeBytes + kBytesPerByte * bytes.size())) {}

const ZipFile::Entry* ThreeMfPackage::find(std::string_view name) const {
    while (name.starts_with('/') || name.starts_with('\\') || name.starts_with("./") || name.starts_with("../"))
        name.remove_prefix(name.find_first_of("/\\") + 1);
    const ZipFile::Entry* const entry = zip_.find(name);
    if (entry != nullptr) return entry;
    const auto decoded = decode_file_uri(name);
    return decoded ? zip_.find(*decoded) : nullptr;
}

std::vector<std::string> ThreeMfPackage::names_ending(std::string_view ending, std::size_t most) const {
    std::vector<std::string> names;
    for (const ZipFile::Entry& entry : zip_.entries())
        if (names.size() < most && entry.name.size() > ending.size() &&
            same_word(entry.name.substr(entry.name.size() - ending.size()), ending))
            names.emplace_back(entry.name);
    return names;
}

std::optional<std::vector<std::byte>> ThreeMfPackage::read(const std::string& name) {
    check_time();
    const ZipFile::Entry* const entry = find(name);
    if (entry == nullptr) return std::nullopt;
    if (const std::uint64_t most = document_.options.limits.max_file_bytes; entry->bytes > most)
        refuse(printable(entry->name, 120), fmt::format("has more than {} bytes, which is max_file_bytes", most), ErrorCode::limit);
    zip_.check_size(*entry);
    unpacked_.take(entry->bytes);
    std::vector<std::byte> bytes(entry->bytes);
    zip_.unpack(*entry, bytes);
    check_time();
    return bytes;
}

}  // namespace halflit::io::detail
