// KHR_draco_mesh_compression: streams of the library's encoder, compared with the meshes that they were made from.
#include "apps/io/files/optional_libraries.hpp"
#include "tests/io/gltf_builder.hpp"
#include "tests/io/picture_difference.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

#if HALFLIT_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#endif

using namespace halflit;
using namespace halflit::test;

#if HALFLIT_HAS_DRACO

namespace {

constexpr std::uint32_t kSide = 20, kVertices = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1);

/// A vertex of a bent sheet; texture coordinates tell which one it is.
struct Vertex {
    std::array<float, 3> position, normal;
    std::array<float, 2> uv;
    std::array<std::uint8_t, 4> color;
};

Vertex vertex(std::uint32_t number) {
    const double u = double(number % kSide) / (kSide - 1), v = double(number / kSide) / (kSide - 1), angle = 4 * u + v;
    const auto f = [](double x) { return static_cast<float>(x); };
    return {{f(std::cos(angle)), f(2 * v - 1), f(std::sin(angle))},
            {f(std::cos(angle)), 0, f(std::sin(angle))},
            {f(u), f(v)},
            {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(255 * u), static_cast<std::uint8_t>(255 * v), 255}};
}

std::vector<std::array<std::uint32_t, 3>> triangles() {
    std::vector<std::array<std::uint32_t, 3>> out;
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t a = y * kSide + x;
            out.push_back({a, a + 1, a + kSide});
            out.push_back({a + 1, a + kSide + 1, a + kSide});
        }
    return out;
}

struct Coding {
    draco::MeshEncoderMethod method = draco::MESH_EDGEBREAKER_ENCODING;
    int speed = 3;           ///< 0: smallest, 10: fastest
    int position_bits = 14;  ///< 0: floats as they are
    int normal_bits = 10, uv_bits = 12;
};

/// Attributes with the unique ids 0 (position), 1 (normal), 2 (texture coordinates), 3 (colours).
Bytes stream(const Coding& coding) {
    draco::Mesh mesh;
    mesh.set_num_points(kVertices);
    const auto add = [&](draco::GeometryAttribute::Type type, std::int8_t components, draco::DataType data, std::size_t size) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, components, data, data == draco::DT_UINT8, static_cast<std::int64_t>(size), 0);
        return mesh.AddAttribute(attribute, true, kVertices);
    };
    const int position = add(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, 12),
              normal = add(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32, 12),
              uv = add(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32, 8),
              color = add(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, 4);
    for (std::uint32_t i = 0; i < kVertices; ++i) {
        const Vertex v = vertex(i);
        const draco::AttributeValueIndex at(i);
        mesh.attribute(position)->SetAttributeValue(at, v.position.data());
        mesh.attribute(normal)->SetAttributeValue(at, v.normal.data());
        mesh.attribute(uv)->SetAttributeValue(at, v.uv.data());
        mesh.attribute(color)->SetAttributeValue(at, v.color.data());
    }
    for (const auto& [a, b, c] : triangles()) mesh.AddFace({draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(coding.method);
    encoder.SetSpeedOptions(coding.speed, coding.speed);
    if (coding.position_bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, coding.position_bits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, coding.normal_bits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, coding.uv_bits);
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    const auto* at = reinterpret_cast<const std::byte*>(buffer.data());
    return {at, at + buffer.size()};
}

std::string accessor_members(const char* type, int component, std::size_t count, const char* more = "") {
    return "\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) + ",\"type\":\"" + type + "\"" + more;
}

std::string accessor(const char* type, int component, std::size_t count, const char* more = "") {
    std::string text = accessor_members(type, component, count, more);
    return text.insert(0, 1, '{').append(1, '}');
}

constexpr const char* kExtension =
    R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3}}})";

std::string json_of(std::size_t bytes) {
    const std::string primitive =
        std::string(R"({"attributes":{"POSITION":1,"NORMAL":2,"TEXCOORD_0":3,"COLOR_0":4},"indices":0,)") + kExtension + "}";
    return one_mesh_json(R"("extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],)"
                         R"("bufferViews":[{"buffer":0,"byteLength":)" +
                             std::to_string(bytes) + "}],\"accessors\":[" + accessor("SCALAR", 5123, 3 * kTriangles) + "," +
                             accessor("VEC3", 5126, kVertices) + "," + accessor("VEC3", 5126, kVertices) + "," +
                             accessor("VEC2", 5126, kVertices) + "," + accessor("VEC4", 5121, kVertices, ",\"normalized\":true") +
                             R"(],"meshes":[{"primitives":[)" + primitive + "]}]",
                         bytes);
}

Bytes file_of(const Bytes& data) { return glb(json_of(data.size()), data); }

/// The number of the vertex that a decoded one was.
std::uint32_t number_of(const Mesh& mesh, std::size_t v) {
    return static_cast<std::uint32_t>(std::lround(mesh.uv0[v].x * (kSide - 1)) + std::lround(mesh.uv0[v].y * (kSide - 1)) * kSide);
}

std::array<std::uint32_t, 3> turned(std::array<std::uint32_t, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

struct Errors {
    double position = 0, normal = 0, uv = 0;
};

/// Checks the triangles and the colours, which are kept; returns the largest errors of the others.
Errors compare(const Mesh& mesh) {
    REQUIRE(mesh.positions.size() == kVertices);
    REQUIRE(mesh.indices.size() == 3 * kTriangles);
    Errors errors;
    std::vector<std::uint32_t> numbers;
    std::size_t wrong_colors = 0;
    const auto worse = [](double& most, float a, float b) { most = std::max<double>(most, std::abs(a - b)); };
    for (std::size_t i = 0; i < kVertices; ++i) {
        const Vertex v = vertex(numbers.emplace_back(number_of(mesh, i)));
        const Vec3f p = mesh.positions[i], n = mesh.normals[i];
        worse(errors.position, p.x, v.position[0]), worse(errors.position, p.y, v.position[1]), worse(errors.position, p.z, v.position[2]);
        worse(errors.normal, n.x, v.normal[0]), worse(errors.normal, n.y, v.normal[1]), worse(errors.normal, n.z, v.normal[2]);
        worse(errors.uv, mesh.uv0[i].x, v.uv[0]), worse(errors.uv, mesh.uv0[i].y, v.uv[1]);
        const Vec4f c = mesh.colors[i];
        const float color[] = {c.x, c.y, c.z, c.w};
        for (std::size_t k = 0; k < 4; ++k) wrong_colors += color[k] != static_cast<float>(v.color[k]) / 255.0f;
    }
    CHECK(wrong_colors == 0);
    std::set<std::array<std::uint32_t, 3>> expected, found;
    for (const auto& t : triangles()) expected.insert(turned(t));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        found.insert(turned({numbers[mesh.indices[i]], numbers[mesh.indices[i + 1]], numbers[mesh.indices[i + 2]]}));
    CHECK(found == expected);
    return errors;
}

}  // namespace

TEST_CASE("draco: a mesh comes back within its quantisation, by each method and speed", "[io]") {
    for (const auto method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING})
        for (const int speed : {0, 3, 5, 7, 10}) {
            INFO("method " << method << ", speed " << speed);
            const LoadedScene loaded = load_ok(file_of(stream({.method = method, .speed = speed})));
            CHECK(loaded.warnings.empty());
            REQUIRE(loaded.scene.meshes.size() == 1);
            const Errors errors = compare(loaded.scene.meshes[0]);
            // Half a step of range / (2^bits - 1), and float32. The range of all three axes is 2.
            CHECK(errors.position < 1.001 / 16383 + 1e-6);
            CHECK(errors.uv < 0.5005 / 4095 + 1e-6);
            // Half a step of 2 / 1022 in both coordinates of the octahedron, which the projection stretches up to 1.7 times.
            CHECK(errors.normal < 1.7 * 2 / 1022);
        }
}

TEST_CASE("draco: the picture is that of the mesh without compression within one code, but for some edges", "[io]") {
    TriangleFile plain;
    plain.bin.clear();
    Bytes normals, indices;
    for (std::uint32_t i = 0; i < kVertices; ++i) {
        const Vertex v = vertex(i);
        append<float>(plain.bin, {v.position[0], v.position[1], v.position[2]});
        append<float>(normals, {v.normal[0], v.normal[1], v.normal[2]});
    }
    for (const auto& [a, b, c] : triangles()) append<std::uint32_t>(indices, {a, b, c});
    plain.views = R"({"buffer":0,"byteLength":)" + std::to_string(plain.bin.size()) + "}";
    plain.accessors = "{\"bufferView\":0," + accessor("VEC3", 5126, kVertices).substr(1);
    plain.attributes += ",\"NORMAL\":" + std::to_string(plain.add(normals, accessor_members("VEC3", 5126, kVertices)));
    plain.primitive = ",\"indices\":" + std::to_string(plain.add(indices, accessor_members("SCALAR", 5125, 3 * kTriangles)));
    const Bytes data = stream({.position_bits = 16, .normal_bits = 14});
    std::string json = replaced(json_of(data.size()), ",\"COLOR_0\":4}", "}");  // the twin has none
    const LoadedScene twin = load_ok(plain.file()), loaded = load_ok(glb(json, data));
    const PictureDifference difference = compare_pictures(twin.scene, loaded.scene);
    CHECK(difference.drawn > 3000);
    // A vertex moves by 2 / 65535 of the model, 0.003 pixels, so few samples at edges change sides.
    CHECK(difference.above_one < difference.drawn / 200);
}

TEST_CASE("draco: floats that are not quantised come back bit for bit", "[io]") {
    const LoadedScene loaded = load_ok(file_of(stream({.position_bits = 0})));
    CHECK(compare(loaded.scene.meshes.at(0)).position == 0);
}

TEST_CASE("draco: primitives that share a stream have the same mesh, and an attribute may stay outside of it", "[io]") {
    Bytes data = stream({});
    const std::size_t bytes = data.size();
    while (data.size() % 4 != 0) data.push_back(std::byte{0});
    const std::size_t outside = data.size();
    for (std::uint32_t i = 0; i < kVertices; ++i) append<float>(data, {static_cast<float>(i), 0});
    std::string json = json_of(bytes);
    json = replaced(json, "}],\"accessors\":[",
                    "},{\"buffer\":0,\"byteOffset\":" + std::to_string(outside) + ",\"byteLength\":" + std::to_string(8 * kVertices) +
                        "}],\"accessors\":[");
    json = replaced(json, "],\"meshes\":[{\"primitives\":[",
                    R"(,{"bufferView":1,"componentType":5126,"count":)" + std::to_string(kVertices) +
                        R"(,"type":"VEC2"}],"meshes":[{"primitives":[{"attributes":{"POSITION":1,"TEXCOORD_1":5},"indices":0,)" +
                        kExtension + "},");
    json = replaced(json, "\"buffers\":[{\"byteLength\":" + std::to_string(bytes),
                    "\"buffers\":[{\"byteLength\":" + std::to_string(data.size()));
    const LoadedScene loaded = load_ok(glb(json, data));
    REQUIRE(loaded.scene.meshes.size() == 2);
    const Mesh &first = loaded.scene.meshes[0], &second = loaded.scene.meshes[1];
    compare(second);
    // The first has flat normals: each corner is a vertex.
    REQUIRE(first.indices.size() == second.indices.size());
    for (std::size_t i = 0; i < first.indices.size(); ++i) {
        const Vec3f a = first.positions[first.indices[i]], b = second.positions[second.indices[i]];
        if (a.x != b.x || a.y != b.y || a.z != b.z) FAIL("corner " << i);
        CHECK(first.uv1[first.indices[i]].x == static_cast<float>(second.indices[i]));
    }
}

TEST_CASE("draco: the data without compression are not read where the stream is", "[io]") {
    const Bytes data = stream({});
    // The fallback's buffer is not there.
    std::string json = replaced(json_of(data.size()), "}],\"accessors\"", R"(},{"buffer":1,"byteLength":4800}],"accessors")");
    json = replaced(json, "}],\"extensionsUsed\"", R"(},{"uri":"missing.bin","byteLength":4800}],"extensionsUsed")");
    json = replaced(json, accessor("VEC3", 5126, kVertices), replaced(accessor("VEC3", 5126, kVertices), "{", "{\"bufferView\":1,"));
    compare(load_ok(glb(json, data)).scene.meshes.at(0));
}

TEST_CASE("draco: counts, types and attributes that differ from the accessors' are refused by their place", "[io]") {
    const Bytes data = stream({});
    const auto refusal = [&](std::string_view from, std::string_view to) {
        const auto loaded = load(glb(replaced(json_of(data.size()), from, to), data));
        if (loaded) FAIL("accepted: " << to);
        CHECK(loaded.error().code == ErrorCode::bad_input);
        return loaded.error().message;
    };
    const auto has = [](const std::string& message, std::string_view part) {
        INFO(message);
        CHECK(message.find(part) != std::string::npos);
    };
    has(refusal("\"count\":2166", "\"count\":2163"), "accessors[0].count is 2163, but the Draco stream has 2166");
    has(refusal("\"count\":400", "\"count\":399"), "meshes[0].primitives[0].attributes.POSITION");
    has(refusal("\"NORMAL\":1,", "\"NORMAL\":9,"), "attribute 9 is not in the stream");
    has(refusal("\"componentType\":5126,\"count\":400,\"type\":\"VEC3\"", "\"componentType\":5122,\"count\":400,\"type\":\"VEC3\""),
        "5122");
    has(refusal("\"VEC2\"", "\"VEC3\""), "has 2 components, expected 3");
    has(refusal("\"bufferView\":0", "\"bufferView\":3"), "bufferView");
}

TEST_CASE("draco: floats become the integers of the accessor, or are refused by the strict rules", "[io]") {
    const Bytes data = stream({});
    const std::string json =
        replaced(json_of(data.size()), accessor("VEC2", 5126, kVertices), accessor("VEC2", 5123, kVertices, ",\"normalized\":true"));
    const LoadedScene loaded = load_ok(glb(json, data));
    CHECK(loaded.warnings.size() == 1);
    CHECK(compare(loaded.scene.meshes.at(0)).uv < 1.0 / 4096 + 1.0 / 65535);
    CHECK(!load(glb(json, data)));
}

TEST_CASE("draco: counts that the stream claims are held against the limit before memory is taken", "[io]") {
    Bytes data = stream({});
    // Sequential streams say how many triangles and vertices they have behind the header of 11 bytes, edgebreaker streams one byte later.
    for (std::size_t at = 11; at < 20; ++at) {
        Bytes claims = data;
        for (std::size_t k = 0; k < 4; ++k) claims[at + k] = std::byte{0xff};
        claims[at + 4] = std::byte{0x03};
        CHECK(!load(file_of(claims)));
    }
    LoadOptions options;
    options.limits.max_geometry_bytes = 100'000;
    const auto limited = load(file_of(data), options);
    REQUIRE(!limited);
    CHECK(limited.error().code == ErrorCode::limit);
}

TEST_CASE("draco: three thousand damaged streams end with a scene or an error, in little time", "[io]") {
    std::mt19937 random(23);
    const Bytes sound[] = {stream({}), stream({.speed = 10}), stream({.method = draco::MESH_SEQUENTIAL_ENCODING, .speed = 0}),
                           stream({.speed = 0, .position_bits = 0})};
    LoadOptions options;
    options.limits.max_geometry_bytes = 4 << 20;
    int refused = 0;
    const auto start = std::chrono::steady_clock::now();
    for (unsigned i = 0; i < 3000; ++i) {
        Bytes data = sound[i % 4];
        for (unsigned k = 0; k < 1 + random() % 3; ++k)
            data[random() % (random() % 2 == 0 ? 64 : data.size())] = static_cast<std::byte>(random());
        if (i % 16 == 0) data.resize(1 + random() % data.size());
        refused += !load(file_of(data), options);
    }
    CHECK(refused > 300);
    CHECK(refused < 3000);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("draco: the sample box is the box that it was made from", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    const auto packed = load_gltf((*assets / "models" / "BoxDraco" / "Box_Draco.glb").string());
    if (!packed) FAIL(packed.error().message);
    const auto plain = load_gltf((*assets / "models" / "Box" / "Box.glb").string());
    REQUIRE(plain);
    CHECK(packed->info.triangles_drawn == plain->info.triangles_drawn);
    const auto corners = [](const LoadedScene& loaded) {
        std::multiset<std::array<double, 6>> out;
        const Mesh& mesh = loaded.scene.meshes.at(0);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const auto round = [](float v) { return std::round(v * 1000) / 1000 + 0.0; };
            const Vec3f p = mesh.positions[i], n = mesh.normals[i];
            out.insert({round(p.x), round(p.y), round(p.z), round(n.x), round(n.y), round(n.z)});
        }
        return out;
    };
    CHECK(corners(*packed) == corners(*plain));
}

#else

TEST_CASE("draco: a build without Draco refuses a file that requires it by name", "[io]") {
    if (io::has_draco()) HALFLIT_SKIP("built with Draco's decoder, without its encoder");
    TriangleFile file;
    file.rest = R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])";
    const auto loaded = load(file.file());
    REQUIRE(!loaded);
    CHECK(loaded.error().message.find("library Draco") != std::string::npos);
}

#endif
