#include "apps/io/gltf/text/glb_container.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;

std::uint32_t read_u32(std::span<const std::byte> file, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(file[at + i]) << (8 * i);
    return value;
}

/// True if a chunk of a known type begins at `at`.
bool is_chunk(std::span<const std::byte> file, std::size_t at, std::size_t length) {
    if (at > length || length - at < kChunkHeaderBytes) return false;
    const std::uint32_t type = read_u32(file, at + 4);
    return type == kJson || type == kBin;
}

/// True if the chunks reach beyond `length`, and the last one ends where the file ends.
bool ends_with_chunk(std::span<const std::byte> file, std::size_t length) {
    std::size_t at = kHeaderBytes;
    while (is_chunk(file, at, file.size())) {
        const std::size_t size = read_u32(file, at);
        at += kChunkHeaderBytes;
        if (size > file.size() - at) return false;
        at += size;
    }
    return at > length && at == file.size();
}

}  // namespace

bool is_glb(std::span<const std::byte> file) { return file.size() >= 4 && read_u32(file, 0) == kMagic; }

std::size_t missing_bytes(std::span<const std::byte> file) {
    if (!is_glb(file) || file.size() < kHeaderBytes) return 0;
    const std::size_t length = read_u32(file, 8);
    return length > file.size() ? length - file.size() : 0;
}

Result<GlbParts> split_glb(std::span<const std::byte> file, bool strict) {
    const auto refuse = [](std::string what) { return fail(ErrorCode::bad_input, fmt::format("GLB: {}", what)); };
    if (!is_glb(file)) return refuse("expected the bytes \"glTF\" at the start");
    if (file.size() < kHeaderBytes) return refuse(fmt::format("header: expected 12 bytes, found {}", file.size()));
    if (const std::uint32_t version = read_u32(file, 4); version != 2)
        return refuse(version == 1 ? std::string(kIsFirstVersion) : fmt::format("header: expected container version 2, found {}", version));
    std::size_t length = read_u32(file, 8);
    GlbParts parts;
    constexpr std::size_t kMostWarnings = 100;
    const auto warn = [&](const std::string& what) {
        if (parts.warnings.size() < kMostWarnings) parts.warnings.push_back(fmt::format("GLB: {}", what));
    };
    if (length > file.size()) {
        std::string what = fmt::format("header: length is {}, but the file has {} bytes", length, file.size());
        if (strict) return refuse(std::move(what));
        warn(what + "; what is there is read");
        length = file.size();
    } else if (length < file.size()) {
        // Some writers forget a part of what they write: the chunks then reach beyond the length, and end where the file ends.
        const bool whole = !strict && ends_with_chunk(file, length);
        warn(fmt::format("{} bytes after the length that the header gives, {}", file.size() - length, whole ? "read" : "ignored"));
        if (whole) length = file.size();
    }
    std::size_t at = kHeaderBytes;
    for (int index = 0; at < length; ++index) {
        if (length - at < kChunkHeaderBytes) {
            std::string what = fmt::format("chunk {}: expected an 8-byte header, found {} bytes", index, length - at);
            if (strict || parts.json.empty()) return refuse(std::move(what));
            warn(what + ", ignored");
            break;
        }
        std::size_t size = read_u32(file, at);
        const std::uint32_t type = read_u32(file, at + 4);
        at += kChunkHeaderBytes;
        if (size > length - at) {
            std::string what = fmt::format("chunk {}: length is {}, but only {} bytes are left", index, size, length - at);
            if (strict) return refuse(std::move(what));
            warn(what + "; what is there is read");
            size = length - at;
        }
        const std::span<const std::byte> body = file.subspan(at, size);
        at += size;
        if (size % 4 != 0) {
            std::string what = fmt::format("chunk {}: length must be a multiple of 4, found {}", index, size);
            if (strict) return refuse(std::move(what));
            warn(what + ", read as it is");
            // The next chunk begins behind this one, or at the next multiple of 4.
            const std::size_t padded = at + (4 - size % 4);
            if (!is_chunk(file, at, length) && (is_chunk(file, padded, length) || padded >= length)) at = std::min(padded, length);
        }
        if (index == 0) {
            if (type != kJson) return refuse(fmt::format("chunk 0: expected JSON, found type 0x{:08x}", type));
            parts.json = body;
        } else if (type == kJson) {
            if (strict) return refuse(fmt::format("chunk {}: a second JSON chunk", index));
            warn(fmt::format("chunk {}: a second JSON chunk, ignored", index));
        } else if (type == kBin) {
            const char* const fault = parts.has_bin ? "a second BIN chunk" : index != 1 ? "BIN must be the second chunk" : nullptr;
            if (fault != nullptr && strict) return refuse(fmt::format("chunk {}: {}", index, fault));
            if (fault != nullptr) warn(fmt::format("chunk {}: {}, {}", index, fault, parts.has_bin ? "ignored" : "read as it is"));
            if (parts.has_bin) continue;
            parts.bin = body;
            parts.has_bin = true;
        } else {
            warn(fmt::format("chunk {} of unknown type 0x{:08x} skipped", index, type));
        }
    }
    if (parts.json.empty()) return refuse("expected a JSON chunk, found none");
    return parts;
}

}  // namespace halflit::io::detail
