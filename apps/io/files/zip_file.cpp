#include "apps/io/files/zip_file.hpp"

#include "apps/io/files/deflate.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>

namespace halflit::io::detail {
namespace {

constexpr std::uint64_t kMostEntries = 1'000'000;
constexpr unsigned kStored = 0, kDeflated = 8;
constexpr std::size_t kEndBytes = 22, kEntryBytes = 46, kHeaderBytes = 30, kLocatorBytes = 20, kEnd64Bytes = 56, kMostComment = 65535;
constexpr std::uint32_t kEndMark = 0x06054b50, kEntryMark = 0x02014b50, kHeaderMark = 0x04034b50, kLocatorMark = 0x07064b50,
                        kEnd64Mark = 0x06064b50;

[[noreturn]] void fail_whole(const char* what) { refuse("", fmt::format("the ZIP file cannot be read: {}", what)); }
[[noreturn]] void fail_entry(const ZipFile::Entry& entry, const std::string& what) {
    refuse(printable(entry.name, 120), "cannot be unpacked: " + what);
}

/// True if bytes [at, at + size) are there.
bool has(std::span<const std::byte> bytes, std::uint64_t at, std::uint64_t size) { return at <= bytes.size() && size <= bytes.size() - at; }

struct Directory {
    std::uint64_t first = 0, size = 0, entries = 0;
    std::uint64_t begin = 0;  ///< of the ZIP file; what stands before it is something else
};

std::optional<std::size_t> find_end(std::span<const std::byte> bytes) {
    if (bytes.size() < kEndBytes) return std::nullopt;
    const std::size_t last = bytes.size() - kEndBytes, first = last - std::min(last, kMostComment);
    for (std::size_t at = last + 1; at-- > first;)
        if (u32_at(bytes, at) == kEndMark && u16_at(bytes, at + 20) <= last - at) return at;
    return std::nullopt;
}

Directory find_directory(std::span<const std::byte> bytes) {
    const auto end = find_end(bytes);
    if (!end) fail_whole("it has no directory; it may be cut off");
    Directory out{u32_at(bytes, *end + 16), u32_at(bytes, *end + 12), u16_at(bytes, *end + 10)};
    std::uint64_t behind = *end;
    if (*end >= kLocatorBytes && u32_at(bytes, *end - kLocatorBytes) == kLocatorMark) {
        const auto is_end = [&](std::uint64_t at) { return has(bytes, at, kEnd64Bytes) && u32_at(bytes, at) == kEnd64Mark; };
        std::uint64_t at = u64_at(bytes, *end - kLocatorBytes + 8);
        // Behind other data its place is later than the locator says: mostly right before the locator.
        if (!is_end(at) && *end >= kLocatorBytes + kEnd64Bytes) at = *end - kLocatorBytes - kEnd64Bytes;
        if (!is_end(at)) fail_whole("its directory of 64 bits is missing");
        out = {u64_at(bytes, at + 48), u64_at(bytes, at + 40), u64_at(bytes, at + 32)};
        behind = at;
    }
    if (out.size > behind || out.first > behind - out.size) fail_whole("its directory is cut off");
    out.begin = behind - out.size - out.first;
    out.first += out.begin;
    return out;
}

/// Reads the sizes and the place that do not fit 32 bits from an entry's extra field.
void read_large(std::span<const std::byte> extra, ZipFile::Entry& entry) {
    constexpr std::uint32_t kElsewhere = 0xffffffff;
    for (std::size_t at = 0; has(extra, at, 4);) {
        const unsigned id = u16_at(extra, at), size = u16_at(extra, at + 2);
        at += 4;
        if (!has(extra, at, size)) return;
        if (id == 1) {
            std::size_t next = at;
            for (std::uint64_t* const value : {&entry.bytes, &entry.packed_bytes, &entry.header_at}) {
                if (*value != kElsewhere || next + 8 > at + size) continue;
                *value = u64_at(extra, next);
                next += 8;
            }
            return;
        }
        at += size;
    }
}

bool is_before(std::string_view a, std::string_view b) {
    const auto folded = [](char c) { return c == '\\' ? '/' : lower(c); };
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return folded(x) < folded(y); });
}

}  // namespace

ZipFile::ZipFile(std::span<const std::byte> bytes) : bytes_(bytes) {
    const Directory directory = find_directory(bytes);
    const std::span<const std::byte> list = bytes.subspan(directory.first, directory.size);
    if (directory.entries > kMostEntries)
        refuse("", fmt::format("the ZIP file has {} entries, the limit is {}", directory.entries, kMostEntries), ErrorCode::limit);
    TimeCheck check;
    for (std::size_t at = 0; entries_.size() < directory.entries;) {
        check();
        if (!has(list, at, kEntryBytes) || u32_at(list, at) != kEntryMark) fail_whole("its directory is damaged");
        const std::size_t name = u16_at(list, at + 28), extra = u16_at(list, at + 30), comment = u16_at(list, at + 32);
        if (!has(list, at + kEntryBytes, name + extra + comment)) fail_whole("its directory is damaged");
        Entry& entry = entries_.emplace_back();
        entry.name = {reinterpret_cast<const char*>(list.data()) + at + kEntryBytes, name};
        if (entry.name.starts_with('/')) entry.name.remove_prefix(1);
        entry.encrypted = (u16_at(list, at + 8) & 1u) != 0;
        entry.method = u16_at(list, at + 10);
        entry.crc = u32_at(list, at + 16);
        entry.packed_bytes = u32_at(list, at + 20), entry.bytes = u32_at(list, at + 24), entry.header_at = u32_at(list, at + 42);
        read_large(list.subspan(at + kEntryBytes + name, extra), entry);
        if (entry.header_at > bytes.size()) fail_whole("its directory is damaged");
        entry.header_at += directory.begin;
        at += kEntryBytes + name + extra + comment;
    }
    by_name_.resize(entries_.size());
    std::iota(by_name_.begin(), by_name_.end(), 0u);
    std::sort(by_name_.begin(), by_name_.end(), timed_less([&](std::uint32_t a, std::uint32_t b) {
                  return is_before(entries_[a].name, entries_[b].name) || (!is_before(entries_[b].name, entries_[a].name) && a < b);
              }));
}

const ZipFile::Entry* ZipFile::find(std::string_view name) const {
    const auto found = std::lower_bound(by_name_.begin(), by_name_.end(), name, [&](std::uint32_t entry, std::string_view wanted) {
        return is_before(entries_[entry].name, wanted);
    });
    return found == by_name_.end() || is_before(name, entries_[*found].name) ? nullptr : &entries_[*found];
}

std::span<const std::byte> ZipFile::packed(const Entry& entry) const {
    if (entry.encrypted) fail_entry(entry, "it is encrypted");
    if (entry.method != kStored && entry.method != kDeflated)
        fail_entry(entry, fmt::format("it is packed by method {}, expected 0 (stored) or 8 (deflated)", entry.method));
    if (!has(bytes_, entry.header_at, kHeaderBytes) || u32_at(bytes_, entry.header_at) != kHeaderMark)
        fail_entry(entry, "its header is missing");
    const std::uint64_t first =
        entry.header_at + kHeaderBytes + u16_at(bytes_, entry.header_at + 26) + u16_at(bytes_, entry.header_at + 28);
    if (!has(bytes_, first, entry.packed_bytes)) fail_entry(entry, "it is cut off");
    return bytes_.subspan(first, entry.packed_bytes);
}

void ZipFile::check_size(const Entry& entry) const {
    constexpr std::uint64_t kMostByDeflate = 1032;
    const std::uint64_t from = packed(entry).size();
    if (entry.method == kStored ? entry.bytes != from : entry.bytes / kMostByDeflate > from)
        fail_entry(entry, fmt::format("{} bytes cannot come of {}", entry.bytes, from));
}

void ZipFile::unpack(const Entry& entry, std::span<std::byte> to) const {
    const std::span<const std::byte> from = packed(entry);
    if (entry.method == kStored) {
        if (from.size() != to.size()) fail_entry(entry, "its size is wrong");
        if (!to.empty()) std::memcpy(to.data(), from.data(), to.size());
    } else {
        const Decompressor decompressor = make_decompressor();
        std::byte nothing{};  // where nothing is unpacked, there is no memory either
        if (libdeflate_deflate_decompress(decompressor.get(), from.data(), from.size(), to.empty() ? &nothing : to.data(), to.size(),
                                          nullptr) != LIBDEFLATE_SUCCESS)
            fail_entry(entry, "its data are damaged");
    }
    if (libdeflate_crc32(0, to.data(), to.size()) != entry.crc) fail_entry(entry, "its checksum is wrong");
}

}  // namespace halflit::io::detail
