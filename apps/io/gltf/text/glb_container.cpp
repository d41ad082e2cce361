#include "apps/io/gltf/text/glb_container.hpp"

#include <fmt/format.h>

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

}  // namespace

bool is_glb(std::span<const std::byte> file) { return file.size() >= 4 && read_u32(file, 0) == kMagic; }

Result<GlbParts> split_glb(std::span<const std::byte> file) {
    const auto refuse = [](std::string what) { return fail(ErrorCode::bad_input, fmt::format("GLB: {}", what)); };
    if (!is_glb(file)) return refuse("expected the bytes \"glTF\" at the start");
    if (file.size() < kHeaderBytes) return refuse(fmt::format("header: expected 12 bytes, found {}", file.size()));
    if (const std::uint32_t version = read_u32(file, 4); version != 2)
        return refuse(fmt::format("header: expected container version 2, found {}", version));
    const std::size_t length = read_u32(file, 8);
    if (length > file.size()) return refuse(fmt::format("header: length is {}, but the file has {} bytes", length, file.size()));

    GlbParts parts;
    if (length < file.size())
        parts.warnings.push_back(fmt::format("GLB: {} bytes after the length that the header gives, ignored", file.size() - length));
    std::size_t at = kHeaderBytes;
    for (int index = 0; at < length; ++index) {
        if (length - at < kChunkHeaderBytes)
            return refuse(fmt::format("chunk {}: expected an 8-byte header, found {} bytes", index, length - at));
        const std::size_t size = read_u32(file, at);
        const std::uint32_t type = read_u32(file, at + 4);
        at += kChunkHeaderBytes;
        if (size > length - at) return refuse(fmt::format("chunk {}: length is {}, but only {} bytes are left", index, size, length - at));
        if (size % 4 != 0) return refuse(fmt::format("chunk {}: length must be a multiple of 4, found {}", index, size));
        const std::span<const std::byte> body = file.subspan(at, size);
        at += size;
        if (index == 0) {
            if (type != kJson) return refuse(fmt::format("chunk 0: expected JSON, found type 0x{:08x}", type));
            parts.json = body;
        } else if (type == kJson) {
            return refuse(fmt::format("chunk {}: a second JSON chunk", index));
        } else if (type == kBin) {
            if (parts.has_bin) return refuse(fmt::format("chunk {}: a second BIN chunk", index));
            if (index != 1) return refuse(fmt::format("chunk {}: BIN must be the second chunk", index));
            parts.bin = body;
            parts.has_bin = true;
        } else {
            parts.warnings.push_back(fmt::format("GLB chunk {} of unknown type 0x{:08x} skipped", index, type));
        }
    }
    if (parts.json.empty()) return refuse("expected a JSON chunk, found none");
    return parts;
}

}  // namespace halflit::io::detail
