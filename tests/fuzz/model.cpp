// Bytes as an STL, PLY, OBJ, OFF or 3MF file. Bytes that begin with '<' are the model's text inside a 3MF package, as the package's
// checksums would refuse every change of it.
#include "tests/fuzz/loading.hpp"

#include "halflit/model.hpp"

#include <array>

namespace halflit::fuzz {
namespace {

void put(Bytes& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

/// CRC-32 of ZIP files.
std::uint32_t checksum(View bytes) {
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}

/// A ZIP file with one file in it, which is stored as it is.
Bytes package(View text) {
    static constexpr char kName[] = "3D/3dmodel.model";
    constexpr std::size_t kLength = sizeof kName - 1;
    Bytes out;
    const auto fields = [&] {
        put(out, 20, 2), put(out, 0, 2), put(out, 0, 2), put(out, 0x210000, 4), put(out, checksum(text), 4);
        put(out, text.size(), 4), put(out, text.size(), 4), put(out, kLength, 2), put(out, 0, 2);
    };
    put(out, 0x04034b50, 4);
    fields();
    out.insert(out.end(), kName, kName + kLength);
    out.insert(out.end(), text.begin(), text.end());
    const std::size_t directory = out.size();
    put(out, 0x02014b50, 4), put(out, 20, 2);
    fields();
    put(out, 0, 6), put(out, 0, 8);
    out.insert(out.end(), kName, kName + kLength);
    const std::size_t end = out.size();
    put(out, 0x06054b50, 4), put(out, 0, 4), put(out, 0x00010001, 4), put(out, end - directory, 4), put(out, directory, 4), put(out, 0, 2);
    return out;
}

void run(View input) {
    const bool is_xml = !input.empty() && input[0] == '<' && has_three_mf();
    const Bytes packed = is_xml ? package(input) : Bytes();
    const auto bytes = as_bytes(is_xml ? View(packed) : input);
    const auto format = find_model_format(bytes);
    if (format == ModelFormat::gltf || format == ModelFormat::glb) return;  // targets of their own
    if (format == ModelFormat::three_mf && !has_three_mf()) return;
    const bool strict = input.size() % 2 == 0;
    const auto loaded = load_model_bytes(bytes, "fuzz.model", "", small_limits(strict));
    if (loaded)
        check_loaded(*loaded);
    else
        check_error(loaded.error());
}

}  // namespace

const FuzzTarget kModel{"model", 32768, run};

}  // namespace halflit::fuzz
