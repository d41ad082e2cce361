// Poses by animations, against an evaluation of the same key frames in float64 by the formulas of glTF 2.0, appendix C, and the C library.
#include "apps/io/gltf/animation/track.hpp"
#include "tests/io/animated_file.hpp"
#include "tests/io/gltf_builder.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::test;

namespace {

using Numbers = std::vector<double>;

Numbers unit(Numbers q) {
    double length2 = 0;
    for (const double x : q) length2 += x * x;
    for (double& x : q) x /= std::sqrt(length2);
    return q;
}

/// Value of a track. Rotations: by sines of angles between the quaternions.
Numbers value_at(const TestTrack& track, double time, bool rotation) {
    const std::size_t n = track.count, stride = track.keys == Keys::cubic ? 3 * n : n;
    const auto part = [&](std::size_t key, std::size_t which) {
        Numbers out;
        for (std::size_t i = 0; i < n; ++i) out.push_back(static_cast<double>(track.values[key * stride + which * n + i]));
        return out;
    };
    const std::size_t value = track.keys == Keys::cubic ? 1 : 0, last = track.times.size() - 1;
    if (time <= static_cast<double>(track.times[0])) return part(0, value);
    if (time >= static_cast<double>(track.times[last])) return part(last, value);
    std::size_t k = 0;
    while (static_cast<double>(track.times[k + 1]) <= time) ++k;
    if (track.keys == Keys::step) return part(k, 0);
    const double step = static_cast<double>(track.times[k + 1]) - static_cast<double>(track.times[k]);
    const double t = (time - static_cast<double>(track.times[k])) / step;
    Numbers out(n);
    if (track.keys == Keys::cubic) {
        const Numbers v0 = part(k, 1), b0 = part(k, 2), a1 = part(k + 1, 0), v1 = part(k + 1, 1);
        for (std::size_t i = 0; i < n; ++i)
            out[i] = (2 * t * t * t - 3 * t * t + 1) * v0[i] + step * (t * t * t - 2 * t * t + t) * b0[i] +
                     (-2 * t * t * t + 3 * t * t) * v1[i] + step * (t * t * t - t * t) * a1[i];
        return rotation ? unit(out) : out;
    }
    const Numbers a = rotation ? unit(part(k, 0)) : part(k, 0), b = rotation ? unit(part(k + 1, 0)) : part(k + 1, 0);
    double first = 1 - t, second = t;
    if (rotation) {
        double d = 0;
        for (std::size_t i = 0; i < 4; ++i) d += a[i] * b[i];
        const double angle = std::acos(std::abs(d));
        first = std::sin(angle * (1 - t)) / std::sin(angle);
        second = (d < 0 ? -1 : 1) * std::sin(angle * t) / std::sin(angle);
    }
    for (std::size_t i = 0; i < n; ++i) out[i] = first * a[i] + second * b[i];
    return out;
}

/// 3 x 4, by rows.
using Matrix = std::array<std::array<double, 4>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) {
            for (std::size_t k = 0; k < 3; ++k) out[r][c] += a[r][k] * b[k][c];
            if (c == 3) out[r][c] += a[r][3];
        }
    return out;
}

Matrix local(const Numbers& t, const Numbers& rotation, const Numbers& s) {
    const Numbers q = unit(rotation);
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    Matrix m{{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y), t[0]},
              {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x), t[1]},
              {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z, t[2]}}};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) m[r][c] *= s[c];
    return m;
}

std::array<Matrix, 3> worlds(const Arm& arm, double time) {
    std::array<Matrix, 3> out;
    for (std::size_t n = 0; n < 3; ++n) {
        const Matrix own =
            local(value_at(arm.translation[n], time, false), value_at(arm.rotation[n], time, true), value_at(arm.scale[n], time, false));
        out[n] = n == 0 ? own : product(out[n - 1], own);
    }
    return out;
}

void check_near(double found, double wanted, double size) {
    if (std::abs(found - wanted) > 1e-6 * size) CHECK(found == Approx(wanted).margin(1e-6 * size));
}

double largest(const Matrix& m) {
    double most = 0;
    for (const auto& row : m)
        for (const double x : row) most = std::max(most, std::abs(x));
    return most;
}

void check_arm(const Arm& arm, const Scene& scene, double time) {
    INFO("time " << time);
    const std::array<Matrix, 3> world = worlds(arm, time);
    REQUIRE(scene.instances.size() == 2);
    const Mat4& hand = scene.instances[0].world_from_object;
    for (std::size_t c = 0; c < 4; ++c) {
        const float found[3] = {hand.c[c].x, hand.c[c].y, hand.c[c].z};
        for (std::size_t r = 0; r < 3; ++r) check_near(static_cast<double>(found[r]), world[2][r][c], largest(world[2]));
    }
    // The node of a skinned mesh does not move it.
    CHECK(scene.instances[1].world_from_object == Mat4{});
    const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(scene.instances[1].mesh));
    const Numbers weights = value_at(arm.weights, time, false);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {  // flat normals: vertex i is index i
        REQUIRE(mesh.indices[i] == i);
        double p[3], moved[3] = {}, sum = 0, size = 0;
        for (std::size_t r = 0; r < 3; ++r) {
            p[r] = static_cast<double>(arm.positions[3 * i + r]);
            for (std::size_t t = 0; t < Arm::kTargets; ++t) p[r] += weights[t] * static_cast<double>(arm.deltas[t][3 * i + r]);
        }
        for (std::size_t k = 0; k < 8; ++k) {
            const std::size_t set = k / 4, at = 4 * i + k % 4;
            const std::size_t joint = arm.joints[set][at];
            const double weight = static_cast<double>(arm.joint_weights[set][at]);
            Matrix bind{};
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t c = 0; c < 4; ++c) bind[r][c] = static_cast<double>(arm.bind[16 * joint + 4 * c + r]);
            const Matrix m = product(world[joint], bind);
            for (std::size_t r = 0; r < 3; ++r) moved[r] += weight * (m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3]);
            sum += weight;
        }
        for (double& x : moved) size = std::max(size, std::abs(x /= sum));
        const float found[3] = {mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z};
        for (std::size_t r = 0; r < 3; ++r) check_near(static_cast<double>(found[r]), moved[r], size);
    }
}

/// One triangle at node 0, moved by one channel of three keys at 1, 2 and 4 s.
Bytes sliding(const std::string& more = "") {
    FilePieces pieces;
    AnimationText slide, lift;
    const int triangle = pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    slide.add_node(sampler_of(pieces, {Keys::linear, 3, {1, 2, 4}, {1, 0, 0, 3, 0, 0, 4, 0, 0}}, "VEC3", 3), 0, "translation");
    lift.add_node(sampler_of(pieces, {Keys::linear, 3, {0, 1}, {0, 0, 0, 0, 8, 0}}, "VEC3", 3), 0, "translation");
    return pieces.file(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(triangle) +
                       R"(}}]}],"nodes":[{"mesh":0,"translation":[0,0,5]}],"animations":[)" + slide.json("slide") + "," +
                       lift.json("lift") + "]" + more);
}

Vec3f place_of(const LoadedScene& loaded) {
    const Vec4f& c = loaded.scene.instances.at(0).world_from_object.c[3];
    return {c.x, c.y, c.z};
}

}  // namespace

TEST_CASE("slerp: within 1e-13 of sines of the angle in long double", "[io]") {
    Random random(3);
    for (int trial = 0; trial < 20'000; ++trial) {
        double a[4], b[4], out[4];
        const double apart = std::pow(10.0, random.real(-9, 1));  // from nearly equal to unrelated
        for (int i = 0; i < 4; ++i) {
            a[i] = random.real(-1, 1);
            b[i] = (trial % 2 == 0 ? 1 : -1) * (a[i] + apart * random.real(-1, 1));
        }
        const double t = random.real(0, 1);
        io::detail::slerp(a, b, t, out);
        long double la = 0, lb = 0, d = 0, minus = 0, plus = 0, p[4], q[4];
        for (int i = 0; i < 4; ++i) la += static_cast<long double>(a[i]) * a[i], lb += static_cast<long double>(b[i]) * b[i];
        for (int i = 0; i < 4; ++i) p[i] = a[i] / std::sqrt(la), q[i] = b[i] / std::sqrt(lb), d += p[i] * q[i];
        for (int i = 0; i < 4; ++i) {
            if (d < 0) q[i] = -q[i];
            minus += (p[i] - q[i]) * (p[i] - q[i]), plus += (p[i] + q[i]) * (p[i] + q[i]);
        }
        const long double angle = 2 * std::atan2(std::sqrt(minus), std::sqrt(plus));
        for (int i = 0; i < 4; ++i) {
            const long double wanted = (p[i] * std::sin((1 - t) * angle) + q[i] * std::sin(t * angle)) / std::sin(angle);
            if (!(std::abs(wanted - out[i]) <= 1e-13L)) CHECK(out[i] == Approx(static_cast<double>(wanted)).margin(1e-13));
        }
    }
    const double a[4] = {0, 0.6, 0, 0.8};
    double out[4];
    io::detail::slerp(a, a, 0.3, out);
    for (int i = 0; i < 4; ++i) CHECK(out[i] == Approx(a[i]).margin(1e-15));
}

TEST_CASE("animation: nodes, two sets of joints and sparse morph targets are those of float64", "[io]") {
    Random random(11);
    for (const Keys keys : {Keys::linear, Keys::step, Keys::cubic}) {
        INFO(name_of(keys));
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            INFO("seed " << seed);
            const Arm arm(seed, keys);
            const LoadedScene kept = load_ok(arm.file, at(0, "", true));
            for (const std::string& warning : kept.warnings) FAIL_CHECK(warning);
            Scene scene = kept.scene;
            for (int trial = 0; trial < 6; ++trial) {
                const double time = random.real(-0.5, 4.5);
                check_arm(arm, load_ok(arm.file, at(time)).scene, time);
                REQUIRE(pose_at(*kept.motion, "", time, scene));
                check_arm(arm, scene, time);
            }
            check_arm(arm, load_ok(arm.file).scene, 0.0);
        }
    }
}

TEST_CASE("animation: one is chosen by name or index, the first without either, and none leaves the nodes", "[io]") {
    const Bytes file = sliding();
    CHECK(place_of(load_ok(file)) == Vec3f{1, 0, 0});
    CHECK(place_of(load_ok(file, at(1.5))) == Vec3f{2, 0, 0});
    CHECK(place_of(load_ok(file, at(0.5, "lift"))) == Vec3f{0, 4, 0});
    CHECK(place_of(load_ok(file, at(0.25, "1"))) == Vec3f{0, 2, 0});
    CHECK(place_of(load_ok(file, at(2, "0"))) == Vec3f{3, 0, 0});
    CHECK(place_of(load_ok(file, at(2, "none"))) == Vec3f{0, 0, 5});
    const LoadedScene loaded = load_ok(file, at(2, "lift"));
    REQUIRE(loaded.animations.size() == 2);
    CHECK(loaded.animation == 1);
    CHECK(loaded.animations[0].name == "slide");
    CHECK(loaded.animations[0].end_s == 4.0);  // that of an animation that is not read is the accessor's max
    CHECK(loaded.animations[1].end_s == 1.0);
    CHECK(loaded.animations[1].channels == 1);
    CHECK(loaded.motion == nullptr);
    CHECK(loaded.nodes[0].parent_from_node.origin == Vec3d{0, 8, 0});
    CHECK(load_ok(file, at(0, "none")).animation == -1);
    for (const char* wrong : {"2", "-1", "Slide", "0x0", "1 "}) {
        const auto refused = load(file, at(0, wrong));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::usage);
        CHECK(refused.error().message.find("animation") != std::string::npos);
    }
    const auto refused = load(TriangleFile().file(), at(0, "0"));
    REQUIRE(!refused);
    CHECK(refused.error().code == ErrorCode::usage);
    CHECK(load_ok(TriangleFile().file(), at(3)).animation == -1);
}

TEST_CASE("animation: before the first key and after the last one these count, at any distance", "[io]") {
    const Bytes file = sliding();
    for (const double time : {-1e300, -1.0, 0.0, 1.0}) CHECK(place_of(load_ok(file, at(time))) == Vec3f{1, 0, 0});
    for (const double time : {4.0, 4.5, 1e300}) CHECK(place_of(load_ok(file, at(time))) == Vec3f{4, 0, 0});
    for (const double time : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto refused = load(file, at(time));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::usage);
    }
}

TEST_CASE("animation: values may be normalised integers and sparse", "[io]") {
    struct Case {
        int type;
        double unit;
        std::size_t bytes;
    };
    for (const Case& c : {Case{5120, 127, 1}, {5121, 255, 1}, {5122, 32767, 2}, {5123, 65535, 2}}) {
        INFO("component type " << c.type);
        const auto stored = [&](double value) { return static_cast<std::int64_t>(std::floor(value * c.unit + 0.5)); };
        FilePieces pieces;
        AnimationText animation;
        const int triangle = pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
        const int delta = pieces.floats({2, 0, 0, 0, 4, 0, 0, 0, 8}, "VEC3", 3);
        const int input = pieces.times({0, 1});
        const auto output = [&](const std::vector<double>& values, const std::string& type, int count) {
            Bytes data;
            for (const double v : values)
                for (std::size_t b = 0; b < c.bytes; ++b) data.push_back(static_cast<std::byte>(stored(v) >> (8 * b) & 255));
            return pieces.accessor(data, "\"componentType\":" + std::to_string(c.type) + ",\"normalized\":true,\"type\":\"" + type +
                                             "\",\"count\":" + std::to_string(count));
        };
        const int turn = output({0, 0, 0, 1, 0, 0, 0.6, 0.8}, "VEC4", 2), weigh = output({0, 1}, "SCALAR", 2);
        const auto sampler = [&](int values) {
            return "{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(values) + "}";
        };
        animation.add_node(sampler(turn), 0, "rotation");
        animation.add_node(sampler(weigh), 0, "weights");
        const Bytes file = pieces.file(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(triangle) +
                                       R"(},"targets":[{"POSITION":)" + std::to_string(delta) +
                                       R"(}]}]}],"nodes":[{"mesh":0}],"animations":[)" + animation.json("a") + "]");
        const LoadedScene loaded = load_ok(file, at(0.5));
        CHECK(loaded.warnings.empty());
        const double s = static_cast<double>(stored(0.6)), w = static_cast<double>(stored(0.8));
        const double angle = std::atan2(s, w);  // half of it is drawn, the quaternion has half the rotation's angle
        CHECK(static_cast<double>(loaded.scene.instances[0].world_from_object.c[0].x) == Approx(std::cos(angle)).epsilon(1e-6));
        CHECK(static_cast<double>(loaded.scene.instances[0].world_from_object.c[0].y) == Approx(std::sin(angle)).epsilon(1e-6));
        CHECK(loaded.scene.meshes[0].positions[0] == Vec3f{1, 0, 0});
        CHECK(loaded.scene.meshes[0].positions[1] == Vec3f{1, 2, 0});
        CHECK(loaded.scene.meshes[0].positions[2] == Vec3f{0, 1, 4});
    }
    // The output's second element comes from the sparse values.
    FilePieces pieces;
    const int triangle = pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    const int input = pieces.times({0, 1});
    Bytes one;
    append<std::uint16_t>(one, {1});
    const int where = pieces.accessor(one, R"("componentType":5123,"type":"SCALAR","count":1)");
    const int values =
        pieces.floats({6, 7, 8}, "VEC3", 3,
                      R"(},{"componentType":5126,"type":"VEC3","count":2,"sparse":{"count":1,"indices":{"bufferView":)" +
                          std::to_string(where) + R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(where + 1) + "}}");
    AnimationText animation;
    animation.add_node("{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(values + 1) + "}", 0, "translation");
    const Bytes file = pieces.file(R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(triangle) +
                                   R"(}}]}],"nodes":[{"mesh":0}],"animations":[)" + animation.json("a") + "]");
    CHECK(place_of(load_ok(file, at(0.5))) == Vec3f{3, 3.5f, 4});
}

TEST_CASE("animation: targets move normals, tangents, texture coordinates and colours too", "[io]") {
    FilePieces pieces;
    const auto add = [&](const std::vector<float>& values, const char* type, std::size_t n) {
        return std::to_string(pieces.floats(values, type, n));
    };
    const std::string p = add({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3), n = add({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3),
                      tangent = add({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4", 4), uv = add({0, 0, 1, 0, 0, 1}, "VEC2", 2),
                      color = add({0.5f, 0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 1}, "VEC4", 4),
                      d3 = add({1, 2, 3, 1, 2, 3, 1, 2, 3}, "VEC3", 3), d2 = add({4, 5, 4, 5, 4, 5}, "VEC2", 2),
                      d4 = add({1, -4, 0.5f, -1, 1, -4, 0.5f, -1, 1, -4, 0.5f, -1}, "VEC4", 4);
    const Bytes file = pieces.file(
        R"("meshes":[{"weights":[0.25],"primitives":[{"attributes":{"POSITION":)" + p + ",\"NORMAL\":" + n + ",\"TANGENT\":" + tangent +
        ",\"TEXCOORD_0\":" + uv + ",\"COLOR_0\":" + color + "},\"targets\":[{\"POSITION\":" + d3 + ",\"NORMAL\":" + d3 +
        ",\"TANGENT\":" + d3 + ",\"TEXCOORD_0\":" + d2 + ",\"TEXCOORD_1\":" + d2 + ",\"COLOR_0\":" + d4 + R"(}]}]}],"nodes":[{"mesh":0}])");
    const Mesh mesh = load_ok(file).scene.meshes.at(0);
    CHECK(mesh.positions[1] == Vec3f{1.25f, 0.5f, 0.75f});
    CHECK(mesh.normals[0] == Vec3f{0.25f, 0.5f, 1.75f});
    CHECK(mesh.tangents[0] == Vec4f{1.25f, 0.5f, 0.75f, -1});
    CHECK(mesh.uv0[1] == Vec2f{2, 1.25f});
    CHECK(mesh.uv1.empty());  // the mesh itself has none
    CHECK(mesh.colors[0] == Vec4f{0.75f, 0, 0.625f, 0.75f});
}

TEST_CASE("animation: a node with a matrix is drawn by that, with a warning", "[io]") {
    const std::string json = R"("translation":[0,0,5])";
    Bytes file = sliding();
    std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    text = replaced(text, json, R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1])");
    // The chunk grew: made anew from its parts.
    const std::size_t begin = text.find("{\"asset"), end = text.find("BIN") - 4;
    const LoadedScene loaded = load_ok(glb(text.substr(begin, end - begin), to_bytes(text.substr(end + 8))));
    CHECK(place_of(loaded) == Vec3f{0, 0, 5});
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0].find("matrix") != std::string::npos);
}
