#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::test;

namespace {

using Indices = std::vector<std::uint32_t>;

/// Five vertices (i, 2i, 3i), with indices and mode as given.
Indices triangles_of(int mode, const Bytes& indices, int component, std::size_t count) {
    TriangleFile file;
    file.bin.clear();
    for (int i = 0; i < 5; ++i) append<float>(file.bin, {float(i), float(2 * i), float(3 * i)});
    file.views = R"({"buffer":0,"byteLength":60})";
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})";
    file.primitive = ",\"mode\":" + std::to_string(mode);
    Bytes normals;
    for (int i = 0; i < 5; ++i) append<float>(normals, {0, 0, 1});
    file.attributes += ",\"NORMAL\":" + std::to_string(file.add(normals, R"("componentType":5126,"count":5,"type":"VEC3")"));
    if (component != 0) {
        const int accessor = file.add(
            indices, "\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) + R"(,"type":"SCALAR")");
        file.primitive += ",\"indices\":" + std::to_string(accessor);
    }
    const LoadedScene loaded = load_ok(file.file());
    if (loaded.scene.meshes.empty()) return {};
    const Mesh& mesh = loaded.scene.meshes[0];
    Indices by_position;  // the vertex number is in x
    for (const std::uint32_t i : mesh.indices) by_position.push_back(static_cast<std::uint32_t>(mesh.positions[i].x));
    return by_position;
}

const std::string kScalar3 = R"("componentType":5126,"count":3,"type":"VEC3")";

}  // namespace

TEST_CASE("gltf: lists, strips and fans become the triangles of the specification", "[io]") {
    Bytes bytes, shorts, words;
    append<std::uint8_t>(bytes, {0, 1, 2, 2, 1, 4});
    append<std::uint16_t>(shorts, {4, 3, 2, 1, 0});
    append<std::uint32_t>(words, {0, 2, 4, 3});
    CHECK(triangles_of(4, bytes, 5121, 6) == Indices{0, 1, 2, 2, 1, 4});
    CHECK(triangles_of(5, shorts, 5123, 5) == Indices{4, 3, 2, 3, 1, 2, 2, 1, 0});
    CHECK(triangles_of(6, words, 5125, 4) == Indices{2, 4, 0, 4, 3, 0});
    CHECK(triangles_of(5, {}, 0, 0) == Indices{0, 1, 2, 1, 3, 2, 2, 3, 4});
    CHECK(triangles_of(6, {}, 0, 0) == Indices{1, 2, 0, 2, 3, 0, 3, 4, 0});
    CHECK(triangles_of(5, bytes, 5121, 2).empty());
}

TEST_CASE("gltf: points, and lists, strips and loops of lines become those of the specification", "[io]") {
    Bytes bytes;
    append<std::uint8_t>(bytes, {4, 0, 1, 2});
    CHECK(triangles_of(0, bytes, 5121, 4) == Indices{4, 0, 1, 2});
    CHECK(triangles_of(1, bytes, 5121, 4) == Indices{4, 0, 1, 2});
    CHECK(triangles_of(2, bytes, 5121, 4) == Indices{4, 0, 0, 1, 1, 2, 2, 4});
    CHECK(triangles_of(3, bytes, 5121, 4) == Indices{4, 0, 0, 1, 1, 2});
    CHECK(triangles_of(0, {}, 0, 0) == Indices{0, 1, 2, 3, 4});
    CHECK(triangles_of(3, {}, 0, 0) == Indices{0, 1, 1, 2, 2, 3, 3, 4});
    CHECK(triangles_of(3, bytes, 5121, 1).empty());
}

TEST_CASE("gltf: points and lines without normals are not lit, and leave other users of their material lit", "[io]") {
    TriangleFile file;
    file.primitive = R"(,"mode":0},{"attributes":{"POSITION":0},"mode":3},{"attributes":{"POSITION":0})";
    const LoadedScene loaded = load_ok(file.file());
    REQUIRE(loaded.scene.meshes.size() == 3);
    CHECK(loaded.info.point_and_line_primitives == 2);
    CHECK(loaded.info.triangles_drawn == 1);
    CHECK(loaded.warnings.empty());
    const Topology expected[] = {Topology::points, Topology::lines, Topology::triangles};
    for (std::size_t m = 0; m < 3; ++m) {
        const Mesh& mesh = loaded.scene.meshes[m];
        CHECK(mesh.topology == expected[m]);
        const bool unlit = mesh.material >= 0 && loaded.scene.materials.at(static_cast<std::size_t>(mesh.material)).unlit;
        CHECK(unlit == (m < 2));
    }
}

TEST_CASE("gltf: missing normals are flat and vertices are no longer shared", "[io]") {
    TriangleFile file;  // two triangles of one quad, folded along x = y
    append<float>(file.bin, {1, 1, 1});
    file.views = R"({"buffer":0,"byteLength":48})";
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
    Bytes indices;
    append<std::uint16_t>(indices, {0, 1, 2, 2, 1, 3});
    file.primitive = ",\"indices\":" + std::to_string(file.add(indices, R"("componentType":5123,"count":6,"type":"SCALAR")"));
    const Mesh mesh = load_ok(file.file()).scene.meshes.at(0);
    REQUIRE(mesh.positions.size() == 6);
    REQUIRE(mesh.normals.size() == 6);
    CHECK(mesh.indices == Indices{0, 1, 2, 3, 4, 5});
    CHECK(mesh.normals[0] == Vec3f{0, 0, 1});
    const float s = 1.0f / std::sqrt(3.0f);  // (1,0,0)-(0,1,0) x (1,1,1)-(0,1,0) = (-1,-1,1)
    CHECK(mesh.normals[3].x == Approx(-s));
    CHECK(mesh.normals[3].y == Approx(-s));
    CHECK(mesh.normals[3].z == Approx(s));
    CHECK(mesh.positions[5] == Vec3f{1, 1, 1});
}

TEST_CASE("gltf: normalised integers become the fractions of the specification", "[io]") {
    TriangleFile file;
    Bytes uv8, uv16, color8, color16;
    append<std::uint8_t>(uv8, {0, 255, 0, 0, 51, 128, 0, 0, 255, 1, 0, 0});  // rows of four bytes
    append<std::uint16_t>(uv16, {0, 65535, 13107, 1, 65534, 32768});
    append<std::uint8_t>(color8, {255, 0, 51, 0, 102, 1, 254, 0, 0, 0, 0, 0});
    file.views += R"(,{"buffer":0,"byteOffset":36,"byteLength":12,"byteStride":4})";
    file.bin.insert(file.bin.end(), uv8.begin(), uv8.end());
    ++file.count;
    file.accessors += R"(,{"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC2"})";
    const int second = file.add(uv16, R"("componentType":5123,"normalized":true,"count":3,"type":"VEC2")");
    file.views += R"(,{"buffer":0,"byteOffset":)" + std::to_string(file.bin.size()) + R"(,"byteLength":12,"byteStride":4})";
    file.bin.insert(file.bin.end(), color8.begin(), color8.end());
    ++file.count;
    file.accessors +=
        ",{\"bufferView\":" + std::to_string(file.count) + R"(,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"})";
    file.attributes += ",\"TEXCOORD_0\":1,\"TEXCOORD_1\":" + std::to_string(second) + ",\"COLOR_0\":" + std::to_string(file.count);
    const Mesh mesh = load_ok(file.file()).scene.meshes.at(0);
    CHECK(mesh.uv0 == std::vector<Vec2f>{{0, 1}, {51 / 255.0f, 128 / 255.0f}, {1, 1 / 255.0f}});
    CHECK(mesh.uv1 == std::vector<Vec2f>{{0, 1}, {13107 / 65535.0f, 1 / 65535.0f}, {65534 / 65535.0f, 32768 / 65535.0f}});
    CHECK(mesh.colors == std::vector<Vec4f>{{1, 0, 0.2f, 1}, {102 / 255.0f, 1 / 255.0f, 254 / 255.0f, 1}, {0, 0, 0, 1}});
}

TEST_CASE("gltf: quantised positions and normals need their extension", "[io]") {
    TriangleFile file;
    Bytes positions, normals;
    append<std::int16_t>(positions, {-32768, -32767, 32767, 0, 1, 2, 3, 4, 5, 0});
    append<std::int8_t>(normals, {0, 0, 127, 0, -128, 0, 0, 0, 0, -127, 0, 0});
    positions.resize(18);
    const int plain = file.add(positions, R"("componentType":5122,"count":3,"type":"VEC3")");
    file.views += R"(,{"buffer":0,"byteOffset":)" + std::to_string(file.bin.size() + 2) + R"(,"byteLength":12,"byteStride":4})";
    file.bin.resize(file.bin.size() + 2);
    file.bin.insert(file.bin.end(), normals.begin(), normals.end());
    file.accessors +=
        ",{\"bufferView\":" + std::to_string(++file.count) + R"(,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"})";
    file.attributes = "\"POSITION\":" + std::to_string(plain) + ",\"NORMAL\":" + std::to_string(file.count);
    const auto refused = load(file.file());
    REQUIRE(!refused);
    CHECK(refused.error().code == ErrorCode::bad_input);
    CHECK(refused.error().message.find("KHR_mesh_quantization") != std::string::npos);
    file.rest = R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
    const Mesh mesh = load_ok(file.file()).scene.meshes.at(0);
    CHECK(mesh.positions == std::vector<Vec3f>{{-32768, -32767, 32767}, {0, 1, 2}, {3, 4, 5}});
    CHECK(mesh.normals == std::vector<Vec3f>{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}});
    std::string json = file.json();
    json = replaced(json, R"("componentType":5122)", R"("componentType":5122,"normalized":true)");
    CHECK(load_ok(glb(json, file.bin)).scene.meshes.at(0).positions[0] == Vec3f{-1, -1, 1});
}

TEST_CASE("gltf: sparse values replace elements, of a view or of zeros", "[io]") {
    TriangleFile file;
    Bytes sparse;
    append<std::uint16_t>(sparse, {0, 2});
    append<float>(sparse, {7, 8, 9, -1, -2, -3});
    const std::string offset = std::to_string(file.bin.size());
    file.views += R"(,{"buffer":0,"byteOffset":)" + offset + R"(,"byteLength":28})";
    file.bin.insert(file.bin.end(), sparse.begin(), sparse.end());
    const std::string members =
        R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":1,"componentType":5123},)"
        R"("values":{"bufferView":1,"byteOffset":4}})";
    file.accessors = R"({"bufferView":0,)" + members + "},{" + members + "}";
    file.attributes = R"("POSITION":0,"NORMAL":1)";
    const Mesh mesh = load_ok(file.file(), strictly()).scene.meshes.at(0);
    CHECK(mesh.positions == std::vector<Vec3f>{{7, 8, 9}, {1, 0, 0}, {-1, -2, -3}});
    CHECK(mesh.normals == std::vector<Vec3f>{{7, 8, 9}, {0, 0, 0}, {-1, -2, -3}});
}

TEST_CASE("gltf: primitives that share a long list of vertices take their own part of it", "[io]") {
    TriangleFile file;
    file.bin.clear();
    for (int i = 0; i < 100; ++i) append<float>(file.bin, {float(i), 0, 0});
    file.views = R"({"buffer":0,"byteLength":1200})";
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":100,"type":"VEC3"})";
    Bytes normals, indices;
    for (int i = 0; i < 100; ++i) append<float>(normals, {0, float(i), 1});
    file.attributes += ",\"NORMAL\":" + std::to_string(file.add(normals, R"("componentType":5126,"count":100,"type":"VEC3")"));
    append<std::uint8_t>(indices, {90, 3, 3, 3, 50, 90});
    file.primitive = ",\"indices\":" + std::to_string(file.add(indices, R"("componentType":5121,"count":6,"type":"SCALAR")"));
    const Mesh mesh = load_ok(file.file()).scene.meshes.at(0);
    CHECK(mesh.positions == std::vector<Vec3f>{{90, 0, 0}, {3, 0, 0}, {50, 0, 0}});
    CHECK(mesh.normals == std::vector<Vec3f>{{0, 90, 1}, {0, 3, 1}, {0, 50, 1}});
    CHECK(mesh.indices == Indices{0, 1, 1, 1, 2, 0});
}

TEST_CASE("gltf: morph targets are applied with the node's weights, or else with the mesh's", "[io]") {
    TriangleFile file;
    Bytes delta, other;
    append<float>(delta, {0, 0, 1, 0, 0, 2, 0, 0, 3});
    append<float>(other, {10, 0, 0, 10, 0, 0, 10, 0, 0});
    const int a = file.add(delta, kScalar3), b = file.add(other, kScalar3);
    file.primitive = ",\"targets\":[{\"POSITION\":" + std::to_string(a) + "},{\"POSITION\":" + std::to_string(b) +
                     "}]}],\"weights\":[0.5,0],\"x\":[{\"y\":0";
    CHECK(load_ok(file.file()).scene.meshes.at(0).positions == std::vector<Vec3f>{{0, 0, 0.5f}, {1, 0, 1}, {0, 1, 1.5f}});
    std::string json = file.json();
    json = replaced(json, "\"nodes\":[{\"mesh\":0}]", "\"nodes\":[{\"mesh\":0,\"weights\":[1,-0.5]}]");
    CHECK(load_ok(glb(json, file.bin)).scene.meshes.at(0).positions == std::vector<Vec3f>{{-5, 0, 1}, {-4, 0, 2}, {-5, 1, 3}});
}

TEST_CASE("gltf: positions that are not numbers are kept for the renderer to drop", "[io]") {
    TriangleFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    put(file.bin, 0, nan);
    put(file.bin, 12, inf);
    const Mesh mesh = load_ok(file.file()).scene.meshes.at(0);
    CHECK(mesh.positions[0].x != mesh.positions[0].x);
    CHECK(mesh.positions[1].x == inf);
    CHECK(mesh.normals[0] == Vec3f{0, 0, 1});
}
