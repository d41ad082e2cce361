// Mutations of PNG and JPEG files.
#include "tests/fuzz/mutate.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace halflit::fuzz {
namespace {

constexpr std::array<std::uint8_t, 8> kPngStart{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkFrame = 12;  ///< length, type and checksum

using Type = std::array<char, 4>;
constexpr Type kTypes[] = {{'I', 'H', 'D', 'R'}, {'P', 'L', 'T', 'E'}, {'I', 'D', 'A', 'T'}, {'I', 'E', 'N', 'D'}, {'t', 'R', 'N', 'S'},
                           {'g', 'A', 'M', 'A'}, {'c', 'H', 'R', 'M'}, {'s', 'R', 'G', 'B'}, {'i', 'C', 'C', 'P'}, {'t', 'E', 'X', 't'},
                           {'z', 'T', 'X', 't'}, {'i', 'T', 'X', 't'}, {'b', 'K', 'G', 'D'}, {'p', 'H', 'Y', 's'}, {'s', 'B', 'I', 'T'},
                           {'h', 'I', 'S', 'T'}, {'s', 'P', 'L', 'T'}, {'t', 'I', 'M', 'E'}, {'e', 'X', 'I', 'f'}, {'A', 'b', 'C', 'd'}};

struct Chunk {
    Type type{};
    Bytes body;
    [[nodiscard]] bool is(const char* name) const { return std::memcmp(type.data(), name, type.size()) == 0; }
};

std::uint32_t read_big(const Bytes& file, std::size_t at) {
    return static_cast<std::uint32_t>(file[at]) << 24 | static_cast<std::uint32_t>(file[at + 1]) << 16 |
           static_cast<std::uint32_t>(file[at + 2]) << 8 | file[at + 3];
}

void append_big(Bytes& file, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t checksum(View bytes) {  // CRC-32
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const std::uint8_t b : bytes) {
        crc ^= b;
        for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

/// None unless the file is a sequence of whole chunks.
std::optional<std::vector<Chunk>> split_png(const Bytes& file) {
    if (file.size() < kPngStart.size() || !std::equal(kPngStart.begin(), kPngStart.end(), file.begin())) return std::nullopt;
    std::vector<Chunk> chunks;
    for (std::size_t at = kPngStart.size(); at < file.size();) {
        if (file.size() - at < kChunkFrame) return std::nullopt;
        const std::size_t size = read_big(file, at);
        if (size > file.size() - at - kChunkFrame) return std::nullopt;
        Chunk chunk;
        std::memcpy(chunk.type.data(), file.data() + at + 4, 4);
        const auto from = file.begin() + static_cast<std::ptrdiff_t>(at + 8);
        chunk.body.assign(from, from + static_cast<std::ptrdiff_t>(size));
        chunks.push_back(std::move(chunk));
        at += size + kChunkFrame;
    }
    return chunks;
}

Bytes join_png(const std::vector<Chunk>& chunks) {
    Bytes file(kPngStart.begin(), kPngStart.end());
    for (const Chunk& chunk : chunks) {
        append_big(file, static_cast<std::uint32_t>(chunk.body.size()));
        const std::size_t from = file.size();
        file.insert(file.end(), chunk.type.begin(), chunk.type.end());
        file.insert(file.end(), chunk.body.begin(), chunk.body.end());
        append_big(file, checksum(View(file).subspan(from)));
    }
    return file;
}

/// Corrects the checksum (Adler-32) of a zlib stream whose blocks are stored, not compressed: the filters behind it are reached.
void mend_stored(Bytes& stream) {
    std::uint32_t a = 1, b = 0;
    for (std::size_t at = 2; at + 5 <= stream.size();) {
        const std::uint8_t head = stream[at];
        const std::size_t size = stream[at + 1] | static_cast<std::size_t>(stream[at + 2]) << 8;
        if (head > 1 || size > stream.size() - at - 5) return;
        for (std::size_t i = at + 5; i < at + 5 + size; ++i) {
            a = (a + stream[i]) % 65521;
            b = (b + a) % 65521;
        }
        at += 5 + size;
        if (head == 0) continue;
        stream.resize(at);
        append_big(stream, b << 16 | a);
        return;
    }
}

void mutate_header(Bytes& header, Random& random) {
    static constexpr std::uint8_t kBits[] = {1, 2, 4, 8, 16, 3, 0}, kColors[] = {0, 2, 3, 4, 6, 1, 7};
    if (header.size() != 13) return;
    switch (random.below(4)) {
        case 0:
            header[random.one_in(2) ? 3 : 7] = static_cast<std::uint8_t>(random.below(40));
            break;
        case 1:
            header[8] = random.pick(kBits);
            break;
        case 2:
            header[9] = random.pick(kColors);
            break;
        default:
            header[random.below(13)] = static_cast<std::uint8_t>(random.below(4));
    }
}

void mutate_chunks(std::vector<Chunk>& chunks, std::size_t max_bytes, Random& random) {
    const std::size_t at = random.below(chunks.size());
    const auto place = chunks.begin() + static_cast<std::ptrdiff_t>(at);
    Chunk& chunk = *place;
    switch (random.below(12)) {
        case 0:
            chunks.erase(place);
            return;
        case 1:
            chunks.push_back(Chunk(chunk));
            return;
        case 2:
            std::swap(chunk, chunks[random.below(chunks.size())]);
            return;
        case 3:
            chunk.type = random.pick(kTypes);
            return;
        case 4: {
            Chunk added{random.pick(kTypes), Bytes(random.below(random.one_in(8) ? 800 : 24))};
            for (std::uint8_t& b : added.body) b = static_cast<std::uint8_t>(random.next());
            chunks.insert(place, std::move(added));
            return;
        }
        default:
            if (chunk.is("IHDR") && !random.one_in(8)) return mutate_header(chunk.body, random);
            mutate_bytes(chunk.body, std::min(max_bytes, chunk.body.size() + 64));
            if (chunk.is("IDAT")) mend_stored(chunk.body);
    }
}

/// The body of a segment before the pixels, or the pixels.
void mutate_jpeg(Bytes& file, std::size_t max_bytes, Random& random) {
    struct Segment {
        std::size_t begin, end;
    };
    std::vector<Segment> segments;
    std::size_t at = 2;
    while (at + 4 <= file.size() && file[at] == 0xFF) {
        const std::size_t size = static_cast<std::size_t>(file[at + 2]) << 8 | file[at + 3];
        if (size < 2 || size > file.size() - at - 2) break;
        segments.push_back({at + 4, at + 2 + size});
        at += 2 + size;
    }
    segments.push_back({at, file.size()});
    const Segment segment = random.pick(segments);
    if (random.one_in(4) || segment.begin >= segment.end) return mutate_bytes(file, max_bytes);
    Bytes body(file.begin() + static_cast<std::ptrdiff_t>(segment.begin), file.begin() + static_cast<std::ptrdiff_t>(segment.end));
    mutate_values(body, random);
    std::copy(body.begin(), body.end(), file.begin() + static_cast<std::ptrdiff_t>(segment.begin));
}

}  // namespace

void mutate_picture(Bytes& file, std::size_t max_bytes, Random& random) {
    if (file.size() > 4 && file[0] == 0xFF && file[1] == 0xD8) return mutate_jpeg(file, max_bytes, random);
    auto chunks = split_png(file);
    if (!chunks || chunks->empty()) return mutate_bytes(file, max_bytes);
    mutate_chunks(*chunks, max_bytes, random);
    Bytes out = join_png(*chunks);
    if (out.size() > max_bytes) return mutate_bytes(file, max_bytes);
    file = std::move(out);
}

void mutate_payload(Bytes& bytes, std::size_t max_bytes, Random& random) {
    const bool picture = bytes.size() > 8 && (bytes[0] == 0x89 || (bytes[0] == 0xFF && bytes[1] == 0xD8));
    if (picture && !random.one_in(8))
        mutate_picture(bytes, max_bytes, random);
    else
        mutate_values(bytes, random);
}

}  // namespace halflit::fuzz
