// Mutations of GLB containers.
#include "tests/fuzz/mutate.hpp"

#include <cstring>
#include <optional>

namespace halflit::fuzz {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

struct Chunk {
    std::uint32_t type = kJson;
    Bytes body;
};

std::uint32_t read_u32(const Bytes& file, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}

void append_u32(Bytes& file, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// None unless the lengths are right.
std::optional<std::vector<Chunk>> split(const Bytes& file) {
    if (file.size() < kHeaderBytes + kChunkHeaderBytes || read_u32(file, 0) != kMagic) return std::nullopt;
    std::vector<Chunk> chunks;
    for (std::size_t at = kHeaderBytes; at < file.size();) {
        if (file.size() - at < kChunkHeaderBytes) return std::nullopt;
        const std::size_t size = read_u32(file, at);
        const std::uint32_t type = read_u32(file, at + 4);
        at += kChunkHeaderBytes;
        if (size > file.size() - at) return std::nullopt;
        chunks.push_back(
            {type, Bytes(file.begin() + static_cast<std::ptrdiff_t>(at), file.begin() + static_cast<std::ptrdiff_t>(at + size))});
        at += size;
    }
    return chunks;
}

Bytes join(std::vector<Chunk> chunks) {
    Bytes file;
    for (const std::uint32_t value : {kMagic, 2u, 0u}) append_u32(file, value);
    for (Chunk& chunk : chunks) {
        while (chunk.body.size() % 4 != 0) chunk.body.push_back(chunk.type == kJson ? ' ' : 0);
        append_u32(file, static_cast<std::uint32_t>(chunk.body.size()));
        append_u32(file, chunk.type);
        file.insert(file.end(), chunk.body.begin(), chunk.body.end());
    }
    const auto size = static_cast<std::uint32_t>(file.size());
    std::memcpy(file.data() + 8, &size, sizeof size);
    return file;
}

/// Repeats, moves or removes a chunk, or gives it another type.
void mutate_list(std::vector<Chunk>& chunks, Random& random) {
    static constexpr std::uint32_t kTypes[] = {kJson, kBin, 0x12345678};
    const std::size_t at = random.below(chunks.size());
    switch (random.below(4)) {
        case 0:
            chunks.push_back(Chunk(chunks[at]));
            break;
        case 1:
            std::swap(chunks[at], chunks[random.below(chunks.size())]);
            break;
        case 2:
            chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        default:
            chunks[at].type = random.pick(kTypes);
    }
}

/// A length, the version or a type that is wrong.
void damage_header(Bytes& file, Random& random) {
    const std::size_t at = random.one_in(2) ? random.below(kHeaderBytes) : kHeaderBytes + random.below(kChunkHeaderBytes);
    if (at < file.size()) file[at] = static_cast<std::uint8_t>(file[at] + (random.one_in(2) ? 4 : random.next()));
}

}  // namespace

void mutate_glb(Bytes& file, std::size_t max_bytes, Random& random) {
    auto chunks = split(file);
    if (!chunks || chunks->empty()) return mutate_bytes(file, max_bytes);
    if (random.one_in(32)) {
        mutate_list(*chunks, random);
    } else {
        Chunk& chunk = (*chunks)[random.one_in(3) ? random.below(chunks->size()) : 0];
        if (chunk.type == kJson) {
            while (!chunk.body.empty() && chunk.body.back() == ' ') chunk.body.pop_back();
            mutate_gltf_json(chunk.body, max_bytes / 2, random);
        } else {
            mutate_values(chunk.body, random);
        }
    }
    Bytes out = join(std::move(*chunks));
    if (random.one_in(32)) damage_header(out, random);
    if (out.size() > max_bytes) return mutate_bytes(file, max_bytes);
    file = std::move(out);
}

}  // namespace halflit::fuzz
