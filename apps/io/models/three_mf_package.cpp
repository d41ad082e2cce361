#include "apps/io/models/three_mf_package.hpp"

#include "apps/io/files/text.hpp"
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

std::optional<std::vector<std::byte>> ThreeMfPackage::read(const std::string& name) {
    check_time();
    const ZipFile::Entry* const entry = zip_.find(name.starts_with('/') ? std::string_view(name).substr(1) : name);
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
