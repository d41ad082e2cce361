// EXT_meshopt_compression and KHR_meshopt_compression: files made by meshoptimizer's encoders, compared with their twins without
// compression.
#include "tests/io/meshopt_encoder.hpp"
#include "tests/io/picture_difference.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include <chrono>
#include <cmath>

#if HALFLIT_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

using namespace halflit;
using namespace halflit::test;

#if HALFLIT_HAS_MESHOPT

namespace {

/// One exponent for the components of a vector, which is what versions before 0.19 do.
void encode_exponents(void* to, std::size_t count, std::size_t stride, int bits, const float* from) {
#if MESHOPTIMIZER_VERSION >= 190
    meshopt_encodeFilterExp(to, count, stride, bits, from, meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(to, count, stride, bits, from);
#endif
}

/// A grid on a bent sheet: positions, normals, texture coordinates and triangles.
struct Grid {
    static constexpr std::uint32_t kSide = 24;
    std::vector<float> positions, normals, uv;  // 4 numbers a normal
    std::vector<std::uint32_t> indices;

    Grid() {
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const double u = double(x) / (kSide - 1), v = double(y) / (kSide - 1), angle = 4 * u + v;
                for (const double p : {std::cos(angle), 2 * v - 1, std::sin(angle)}) positions.push_back(static_cast<float>(p));
                for (const double n : {std::cos(angle), 0.0, std::sin(angle), 0.0}) normals.push_back(static_cast<float>(n));
                uv.push_back(static_cast<float>(u)), uv.push_back(static_cast<float>(v));
            }
        for (std::uint32_t y = 0; y + 1 < kSide; ++y)
            for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
                const std::uint32_t a = y * kSide + x;
                for (const std::uint32_t i : {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide}) indices.push_back(i);
            }
    }
    [[nodiscard]] std::size_t count() const { return positions.size() / 3; }
};

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    const auto* at = reinterpret_cast<const std::byte*>(values.data());
    return {at, at + values.size() * sizeof(T)};
}

Bytes encode_vertices(const Bytes& data, std::size_t stride) {
    Bytes out(meshopt_encodeVertexBufferBound(data.size() / stride, stride));
    out.resize(
        meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), data.data(), data.size() / stride, stride));
    REQUIRE(!out.empty());
    return out;
}

Bytes encode_triangles(const std::vector<std::uint32_t>& indices) {
    Bytes out(meshopt_encodeIndexBufferBound(indices.size(), 1 << 16));
    out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(), indices.size()));
    return out;
}

Bytes encode_sequence(const std::vector<std::uint32_t>& indices) {
    Bytes out(meshopt_encodeIndexSequenceBound(indices.size(), 1 << 16));
    out.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(), indices.size()));
    return out;
}

/// A file of one primitive whose bufferViews may be compressed. Buffer 1 is the place of the decoded data; it has no bytes.
struct MeshoptFile {
    std::string extension = "EXT_meshopt_compression";
    Bytes bin;
    std::size_t decoded_bytes = 0;
    int views = 0;
    std::string view_text, accessor_text, attributes, primitive, used = "\"KHR_mesh_quantization\"";
    std::string node;

    int add(const Bytes& data, std::size_t count, std::size_t stride, const char* mode, const char* filter, const std::string& accessor,
            bool indices = false) {
        while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
        while (decoded_bytes % 4 != 0) ++decoded_bytes;
        const std::string comma = views == 0 ? "" : ",", step = std::to_string(stride);
        view_text += comma + R"({"buffer":1,"byteOffset":)" + std::to_string(decoded_bytes) +
                     ",\"byteLength\":" + std::to_string(count * stride) + (indices ? "" : ",\"byteStride\":" + step) +
                     ",\"extensions\":{\"" + extension + R"(":{"buffer":0,"byteOffset":)" + std::to_string(bin.size()) +
                     ",\"byteLength\":" + std::to_string(data.size()) + ",\"byteStride\":" + step + ",\"count\":" + std::to_string(count) +
                     ",\"mode\":\"" + mode + "\",\"filter\":\"" + filter + "\"}}}";
        accessor_text += comma + "{\"bufferView\":" + std::to_string(views) + ",\"count\":" + std::to_string(count) + "," + accessor + "}";
        bin.insert(bin.end(), data.begin(), data.end());
        decoded_bytes += count * stride;
        return views++;
    }
    void attribute(const char* name, int accessor) {
        attributes += (attributes.empty() ? "\"" : ",\"") + std::string(name) + "\":" + std::to_string(accessor);
    }
    [[nodiscard]] std::string json() const {
        return std::string("{") + kAsset + ",\"extensionsUsed\":[\"" + extension + "\"," + used + "],\"extensionsRequired\":[\"" +
               extension + "\"," + used + R"(],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
               R"(}],"buffers":[{"byteLength":)" + std::to_string(bin.size()) + "},{\"byteLength\":" + std::to_string(decoded_bytes) +
               ",\"extensions\":{\"" + extension + R"(":{"fallback":true}}}],"bufferViews":[)" + view_text + "],\"accessors\":[" +
               accessor_text + R"(],"meshes":[{"primitives":[{"attributes":{)" + attributes + "}" + primitive + "}]}]}";
    }
    [[nodiscard]] Bytes file() const { return glb(json(), bin); }
};

constexpr const char* kFloat3 = R"("componentType":5126,"type":"VEC3")";
constexpr const char* kU16 = R"("componentType":5123,"type":"SCALAR")";
constexpr const char* kU32 = R"("componentType":5125,"type":"SCALAR")";

/// Triangles as the encoder keeps them: it turns each so that another corner may be the first.
std::vector<std::uint32_t> turned(std::vector<std::uint32_t> indices) {
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const auto first = indices.begin() + static_cast<std::ptrdiff_t>(i);
        std::rotate(first, std::min_element(first, first + 3), first + 3);
    }
    return indices;
}

MeshoptFile plain_grid(const Grid& grid) {
    MeshoptFile file;
    file.attribute("POSITION", file.add(encode_vertices(bytes_of(grid.positions), 12), grid.count(), 12, "ATTRIBUTES", "NONE", kFloat3));
    file.primitive =
        ",\"indices\":" + std::to_string(file.add(encode_triangles(grid.indices), grid.indices.size(), 2, "TRIANGLES", "NONE", kU16, true));
    return file;
}

}  // namespace

TEST_CASE("meshopt: floats and triangles come back bit for bit, by both names of the extension", "[io]") {
    const Grid grid;
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        for (const int size : {2, 4}) {
            MeshoptFile file;
            file.extension = name;
            file.attribute("POSITION",
                           file.add(encode_vertices(bytes_of(grid.positions), 12), grid.count(), 12, "ATTRIBUTES", "NONE", kFloat3));
            file.primitive = ",\"indices\":" +
                             std::to_string(file.add(encode_triangles(grid.indices), grid.indices.size(), static_cast<std::size_t>(size),
                                                     "TRIANGLES", "NONE", size == 2 ? kU16 : kU32, true));
            const LoadedScene loaded = load_ok(file.file());
            CHECK(loaded.warnings.empty());
            const Mesh& mesh = loaded.scene.meshes.at(0);
            REQUIRE(mesh.indices.size() == grid.indices.size());
            // The mesh has flat normals, so each corner is a vertex of its own.
            const std::vector<std::uint32_t> order = turned(grid.indices);
            std::size_t wrong = 0;
            for (std::size_t t = 0; t < order.size(); t += 3) {
                bool found = false;
                for (std::size_t turn = 0; turn < 3; ++turn) {
                    bool same = true;
                    for (std::size_t c = 0; c < 3; ++c) {
                        const Vec3f p = mesh.positions[mesh.indices[t + c]];
                        const float* q = &grid.positions[3 * order[t + (c + turn) % 3]];
                        same = same && p.x == q[0] && p.y == q[1] && p.z == q[2];
                    }
                    found = found || same;
                }
                wrong += !found;
            }
            CHECK(wrong == 0);
        }
}

TEST_CASE("meshopt: version 1 of the vertex codec is read from a file", "[io]") {
    const Grid grid;
    Engine random(11);
    MeshoptFile file;
    file.extension = "KHR_meshopt_compression";
    file.attribute("POSITION",
                   file.add(encode_vertices_1(bytes_of(grid.positions), 12, random), grid.count(), 12, "ATTRIBUTES", "NONE", kFloat3));
    file.primitive =
        ",\"indices\":" + std::to_string(file.add(encode_sequence(grid.indices), grid.indices.size(), 4, "INDICES", "NONE", kU32, true));
    const LoadedScene loaded = load_ok(file.file());
    const Mesh& mesh = loaded.scene.meshes.at(0);
    REQUIRE(mesh.indices.size() == grid.indices.size());
    for (std::size_t i = 0; i < grid.indices.size(); ++i) {
        const Vec3f p = mesh.positions[mesh.indices[i]];
        const float* q = &grid.positions[3 * grid.indices[i]];
        if (p.x != q[0] || p.y != q[1] || p.z != q[2]) FAIL("corner " << i);
    }
}

TEST_CASE("meshopt: quantised vertices and filtered normals are within the quantisation of their twins", "[io]") {
    const Grid grid;
    for (const int bits : {8, 16}) {
        MeshoptFile file;
        // Positions as 16-bit integers, as KHR_mesh_quantization allows; the node undoes the scale.
        std::vector<std::uint16_t> quantised;
        for (std::size_t i = 0; i < grid.count(); ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                quantised.push_back(static_cast<std::uint16_t>(std::lround((grid.positions[3 * i + c] + 1) / 2 * 16383)));
            quantised.push_back(0);
        }
        const auto stride = static_cast<std::size_t>(bits / 2);
        Bytes normals(grid.count() * stride);
        meshopt_encodeFilterOct(normals.data(), grid.count(), stride, bits, grid.normals.data());
        Bytes uv(grid.count() * 8);
        encode_exponents(uv.data(), grid.count(), 8, 15, grid.uv.data());
        file.attribute("POSITION", file.add(encode_vertices(bytes_of(quantised), 8), grid.count(), 8, "ATTRIBUTES", "NONE",
                                            R"("componentType":5123,"type":"VEC3")"));
        file.attribute("NORMAL",
                       file.add(encode_vertices(normals, stride), grid.count(), stride, "ATTRIBUTES", "OCTAHEDRAL",
                                R"("type":"VEC3","normalized":true,"componentType":)" + std::string(bits == 8 ? "5120" : "5122")));
        file.attribute("TEXCOORD_0", file.add(encode_vertices(uv, 8), grid.count(), 8, "ATTRIBUTES", "EXPONENTIAL",
                                              R"("componentType":5126,"type":"VEC2")"));
        file.primitive = ",\"indices\":" +
                         std::to_string(file.add(encode_triangles(grid.indices), grid.indices.size(), 2, "TRIANGLES", "NONE", kU16, true));
        const LoadedScene loaded = load_ok(file.file());
        CHECK(loaded.warnings.empty());
        const Mesh& mesh = loaded.scene.meshes.at(0);
        REQUIRE(mesh.positions.size() == grid.count());
        double position_error = 0, normal_error = 0, uv_error = 0;
        for (std::size_t i = 0; i < grid.count(); ++i) {
            const float p[] = {mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z};
            const float n[] = {mesh.normals[i].x, mesh.normals[i].y, mesh.normals[i].z};
            const float t[] = {mesh.uv0[i].x, mesh.uv0[i].y};
            for (std::size_t c = 0; c < 3; ++c) {
                position_error = std::max<double>(position_error, std::abs(p[c] / 16383 * 2 - 1 - grid.positions[3 * i + c]));
                normal_error = std::max<double>(normal_error, std::abs(n[c] - grid.normals[4 * i + c]));
            }
            for (std::size_t c = 0; c < 2; ++c) uv_error = std::max<double>(uv_error, std::abs(t[c] - grid.uv[2 * i + c]));
        }
        CHECK(position_error < 1.01 / 16383);  // half a step of 2 / 16383, and float32
        // Half a step of the octahedron's coordinates, which the projection stretches up to 1.7 times, and half a step of the integers.
        CHECK(normal_error < (bits == 8 ? 0.018 : 0.00008));
        CHECK(uv_error < 1.0 / (1 << 14));
    }
}

TEST_CASE("meshopt: filtered floats give the picture of their twin within one code, but for some edges", "[io]") {
    const Grid grid;
    const auto file_with = [&](bool filtered) {
        MeshoptFile file;
        Bytes positions = bytes_of(grid.positions), normals(grid.count() * 8);
        if (filtered) encode_exponents(positions.data(), grid.count(), 12, 18, grid.positions.data());
        file.attribute("POSITION", file.add(encode_vertices(positions, 12), grid.count(), 12, "ATTRIBUTES",
                                            filtered ? "EXPONENTIAL" : "NONE", kFloat3));
        if (filtered) {
            meshopt_encodeFilterOct(normals.data(), grid.count(), 8, 16, grid.normals.data());
            file.attribute("NORMAL", file.add(encode_vertices(normals, 8), grid.count(), 8, "ATTRIBUTES", "OCTAHEDRAL",
                                              R"("type":"VEC3","normalized":true,"componentType":5122)"));
        } else {
            file.attribute("NORMAL",
                           file.add(encode_vertices(bytes_of(grid.normals), 16), grid.count(), 16, "ATTRIBUTES", "NONE", kFloat3));
        }
        file.primitive = ",\"indices\":" +
                         std::to_string(file.add(encode_triangles(grid.indices), grid.indices.size(), 2, "TRIANGLES", "NONE", kU16, true));
        return load_ok(file.file());
    };
    const PictureDifference difference = compare_pictures(file_with(false).scene, file_with(true).scene);
    CHECK(difference.drawn > 3000);
    CHECK(difference.above_one < difference.drawn / 200);
}

TEST_CASE("meshopt: wrong sizes and modes are refused by their place", "[io]") {
    const MeshoptFile file = plain_grid(Grid());
    const auto refusal = [&](std::string_view from, std::string_view to) {
        const auto loaded = load(glb(replaced(file.json(), from, to), file.bin));
        if (loaded) FAIL("accepted: " << to);
        return loaded.error();
    };
    const auto has = [](const Error& error, std::string_view part) { return error.message.find(part) != std::string::npos; };
    CHECK(has(refusal("\"byteStride\":12,\"count\"", "\"byteStride\":10,\"count\""), "byteStride"));
    CHECK(has(refusal("\"byteStride\":12,\"count\"", "\"byteStride\":260,\"count\""), "byteStride"));
    CHECK(has(refusal("\"byteStride\":12,\"count\"", "\"byteStride\":16,\"count\""), "byteStride"));
    CHECK(has(refusal("\"count\":576,\"mode\"", "\"count\":575,\"mode\""), "575 elements of 12 bytes are 6900 bytes, but"));
    CHECK(has(refusal("ATTRIBUTES", "POINTS"), "expected ATTRIBUTES, TRIANGLES or INDICES"));
    CHECK(has(refusal("\"NONE\"", "\"ZSTD\""), "expected NONE, OCTAHEDRAL"));
    CHECK(has(refusal("\"NONE\"", "\"QUATERNION\""), "filter"));
    CHECK(has(refusal("\"buffer\":0,\"byteOffset\":0", "\"buffer\":7,\"byteOffset\":0"), "buffer"));
    CHECK(has(refusal("\"buffer\":0,\"byteOffset\":0", "\"buffer\":0,\"byteOffset\":9007199254740992"), "end at"));
    CHECK(has(refusal("\"count\":576,\"mode\"", "\"count\":9007199254740992,\"mode\""), "bytes"));
    // A view that claims much more than its bytes can hold, with a fallback buffer to match.
    std::string json = replaced(file.json(), "\"count\":576,\"mode\"", "\"count\":576000000,\"mode\"");
    json = replaced(json, "\"byteLength\":6912,", "\"byteLength\":6912000000,");
    json = replaced(json, "{\"byteLength\":" + std::to_string(file.decoded_bytes), "{\"byteLength\":7000000000");
    const auto huge = load(glb(json, file.bin));
    REQUIRE(!huge);
    CHECK(has(huge.error(), "cannot hold"));
}

TEST_CASE("meshopt: four thousand damaged files end with a scene or an error, in little time and memory", "[io]") {
    Engine random(17);
    const Grid grid;
    MeshoptFile file = plain_grid(grid);
    Bytes normals(grid.count() * 4);
    meshopt_encodeFilterOct(normals.data(), grid.count(), 4, 8, grid.normals.data());
    file.attribute("NORMAL", file.add(encode_vertices_1(normals, 4, random), grid.count(), 4, "ATTRIBUTES", "OCTAHEDRAL",
                                      R"("componentType":5120,"type":"VEC3","normalized":true)"));
    const std::string json = file.json();
    CHECK(load(glb(json, file.bin)));
    LoadOptions options;
    options.limits.max_geometry_bytes = 4 << 20;
    int refused = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 4000; ++i) {
        Bytes bin = file.bin;
        for (unsigned k = 0; k < 1 + random() % 3; ++k) bin[random() % bin.size()] = static_cast<std::byte>(random());
        if (i % 8 == 0) bin.resize(random() % bin.size());
        std::string text = json;
        if (i % 4 == 0) {  // another digit
            const std::size_t at = random() % text.size();
            if (text[at] >= '0' && text[at] <= '9') text[at] = static_cast<char>('0' + random() % 10);
        }
        refused += !load(glb(text, bin), options);
    }
    CHECK(refused > 100);
    CHECK(refused < 3900);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("meshopt: the box that gltfpack compressed is the box that it was made from", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    const auto packed = load_gltf((*assets / "models" / "BoxMeshopt" / "BoxMeshopt.glb").string());
    if (!packed) FAIL(packed.error().message);
    const auto plain = load_gltf((*assets / "models" / "Box" / "Box.glb").string());
    REQUIRE(plain);
    CHECK(packed->info.triangles_drawn == plain->info.triangles_drawn);
    const auto corners = [](const Scene& scene) {
        std::vector<std::array<double, 3>> out;
        for (const Instance& instance : scene.instances)
            for (const Vec3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
                const Vec4f q = instance.world_from_object * Vec4f{p.x, p.y, p.z, 1};
                // The box is turned between the two files, which does not show in whole corners.
                out.push_back({std::round(q.x * 1000) / 1000, std::round(q.y * 1000) / 1000, std::round(q.z * 1000) / 1000});
            }
        for (auto& corner : out)
            for (double& v : corner) v += 0.0;  // no -0
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    };
    CHECK(corners(packed->scene).size() == 8);
    CHECK(corners(packed->scene) == corners(plain->scene));
}

#else

TEST_CASE("meshopt: a build without meshoptimizer refuses a file that requires it by name", "[io]") {
    TriangleFile file;
    file.rest = R"(,"extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"])";
    const auto loaded = load(file.file());
    REQUIRE(!loaded);
    CHECK(loaded.error().message.find("meshoptimizer") != std::string::npos);
}

#endif
