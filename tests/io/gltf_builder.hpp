// Small glTF files made in memory: binary data by appending values, JSON by hand, GLB or .gltf around them.
#pragma once

#include "halflit/gltf.hpp"
#include "tests/support/base64.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::test {

using Bytes = std::vector<std::byte>;

inline Bytes to_bytes(std::string_view text) {
    Bytes out(text.size());
    std::transform(text.begin(), text.end(), out.begin(), [](char c) { return static_cast<std::byte>(c); });
    return out;
}

/// Writes a value at a place of a file: the lowest byte first, as glTF has them, on every machine.
template <class T>
void put(Bytes& out, std::size_t at, T value) {
    std::memcpy(out.data() + at, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(out.data() + at, out.data() + at + sizeof value);
}

/// The same for appending.
template <class T>
void append(Bytes& out, std::initializer_list<T> values) {
    for (const T value : values) {
        out.resize(out.size() + sizeof value);
        put(out, out.size() - sizeof value, value);
    }
}

/// The number at a place of a file.
inline std::uint32_t u32_of(const Bytes& file, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(file.at(at + i)) << (8 * i);
    return value;
}

inline void append_u32(Bytes& out, std::uint32_t value) { append<std::uint32_t>(out, {value}); }

inline std::string base64(const Bytes& bytes) { return encode_base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}); }

/// A GLB of a JSON chunk and, unless `bin` is empty, a BIN chunk.
inline Bytes glb(std::string json, Bytes bin = {}) {
    while (json.size() % 4 != 0) json += ' ';
    while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
    Bytes out = to_bytes("glTF");
    append_u32(out, 2);
    append_u32(out, static_cast<std::uint32_t>(12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size())));
    append_u32(out, static_cast<std::uint32_t>(json.size()));
    const Bytes type = to_bytes("JSON"), text = to_bytes(json);
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), text.begin(), text.end());
    if (bin.empty()) return out;
    append_u32(out, static_cast<std::uint32_t>(bin.size()));
    append_u32(out, 0x004E4942);
    out.insert(out.end(), bin.begin(), bin.end());
    return out;
}

/// `text` with the first `from` replaced; `from` must occur.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) FAIL("no " << from << " in " << text.substr(0, 200));
    return text.replace(at, from.size(), to);
}

inline constexpr const char* kAsset = R"("asset":{"version":"2.0"})";

/// A file whose scene is one node with mesh 0. `parts`: accessors, bufferViews, meshes and whatever else, without the outer braces.
inline std::string one_mesh_json(const std::string& parts, std::size_t bin_size) {
    return std::string("{") + kAsset + R"(,"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"buffers":[{"byteLength":)" +
           std::to_string(bin_size) + "}]," + parts + "}";
}

/// Options with which damage refuses a file.
inline LoadOptions strictly() {
    LoadOptions options;
    options.strict = true;
    return options;
}

inline Result<LoadedScene> load(const Bytes& bytes, const LoadOptions& options = strictly(), const std::string& base_dir = "") {
    return load_gltf_bytes(bytes, "test.glb", base_dir, options);
}

/// Loads a file that must be accepted.
inline LoadedScene load_ok(const Bytes& bytes, const LoadOptions& options = {}, const std::string& base_dir = "") {
    auto loaded = load(bytes, options, base_dir);
    if (!loaded) FAIL("refused: " << loaded.error().message);
    return *std::move(loaded);
}

/// Three float positions, (0,0,0) (1,0,0) (0,1,0), as bufferView 0 and accessor 0, and a mesh with one primitive of it.
struct TriangleFile {
    Bytes bin;
    std::string views = R"({"buffer":0,"byteLength":36})";
    std::string accessors = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";
    std::string attributes = R"("POSITION":0)";
    std::string primitive;  ///< further members, beginning with a comma
    std::string rest;       ///< further members of the root, beginning with a comma

    TriangleFile() { append<float>(bin, {0, 0, 0, 1, 0, 0, 0, 1, 0}); }
    [[nodiscard]] std::string json() const {
        return one_mesh_json("\"bufferViews\":[" + views + "],\"accessors\":[" + accessors +
                                 R"(],"meshes":[{"primitives":[{"attributes":{)" + attributes + "}" + primitive + "}]}]" + rest,
                             bin.size());
    }
    [[nodiscard]] Bytes file() const { return glb(json(), bin); }
    /// A view of `data` (4-byte aligned) and an accessor over it; returns the accessor's index.
    int add(const Bytes& data, const std::string& accessor_members) {
        while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
        views += ",{\"buffer\":0,\"byteOffset\":" + std::to_string(bin.size()) + ",\"byteLength\":" + std::to_string(data.size()) + "}";
        bin.insert(bin.end(), data.begin(), data.end());
        ++count;
        accessors += ",{\"bufferView\":" + std::to_string(count) + "," + accessor_members + "}";
        return count;
    }
    int count = 0;
};

/// A triangle with a material, and two sets of texture coordinates over all of a picture's corner.
inline TriangleFile triangle_with_material() {
    TriangleFile file;
    Bytes uv;
    append<float>(uv, {0, 0, 1, 0, 0, 1});
    const int a = file.add(uv, R"("componentType":5126,"count":3,"type":"VEC2")");
    file.attributes += ",\"TEXCOORD_0\":" + std::to_string(a) + ",\"TEXCOORD_1\":" + std::to_string(a);
    file.primitive = ",\"material\":0";
    return file;
}

/// A triangle whose base colour has a texture; `texture` are the texture's members, images[0] is `image`, and `images` are further ones,
/// beginning with a comma.
inline Bytes textured(const Bytes& image, const std::string& type, const std::string& texture, const std::string& rest = "",
                      const std::string& images = "") {
    TriangleFile file = triangle_with_material();
    file.rest = R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{)" + texture +
                R"(}],"images":[{"uri":"data:)" + type + ";base64," + base64(image) + "\"}" + images + "]" + rest;
    return file.file();
}

/// Checks how a damaged file is refused: with a fault or a limit, in one line.
inline void check_refusal(const Error& error) {
    if (error.code != ErrorCode::bad_input && error.code != ErrorCode::limit)
        FAIL("code " << static_cast<int>(error.code) << ": " << error.message);
    for (const char c : error.message)
        if (static_cast<unsigned char>(c) < 0x20) FAIL("a control character in: " << error.message);
}

}  // namespace halflit::test
