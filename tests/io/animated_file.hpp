// A model whose numbers a test has too: an arm of three nodes, a mesh that morphs and is moved by two sets of joints, one that hangs on the
// arm, a camera, lights and materials; all of it is animated.
#pragma once

#include "tests/io/gltf_builder.hpp"
#include "tests/support/random.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace halflit::test {

/// JSON and BIN of a file that is written piece by piece.
struct FilePieces {
    Bytes bin;
    std::string views, accessors;
    int count = 0;

    /// Adds a bufferView with data; returns its index, which is also the accessor's if each view gets one.
    int view(const Bytes& data) {
        while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
        views += std::string(count > 0 ? "," : "") + R"({"buffer":0,"byteOffset":)" + std::to_string(bin.size()) +
                 ",\"byteLength\":" + std::to_string(data.size()) + "}";
        bin.insert(bin.end(), data.begin(), data.end());
        return count++;
    }
    int accessor(const Bytes& data, const std::string& members) {
        const int index = view(data);
        accessors += std::string(index > 0 ? "," : "") + "{\"bufferView\":" + std::to_string(index) + "," + members + "}";
        return index;
    }
    int floats(const std::vector<float>& values, const std::string& type, std::size_t components, const std::string& more = "") {
        Bytes data;
        for (const float v : values) append<float>(data, {v});
        return accessor(data,
                        R"("componentType":5126,"type":")" + type + "\",\"count\":" + std::to_string(values.size() / components) + more);
    }
    int times(const std::vector<float>& values) {
        return floats(values, "SCALAR", 1, ",\"min\":[" + std::to_string(values.front()) + "],\"max\":[" + number(values.back()) + "]");
    }
    static std::string number(float value) {
        char text[40];
        std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
        return text;
    }
    [[nodiscard]] Bytes file(const std::string& rest) const {
        return glb(std::string("{") + kAsset + ",\"buffers\":[{\"byteLength\":" + std::to_string(bin.size()) + "}],\"bufferViews\":[" +
                       views + "],\"accessors\":[" + accessors + "]," + rest + "}",
                   bin);
    }
};

enum class Keys { linear, step, cubic };
inline const char* name_of(Keys keys) { return keys == Keys::linear ? "LINEAR" : keys == Keys::step ? "STEP" : "CUBICSPLINE"; }

/// Key frames as a test keeps them.
struct TestTrack {
    Keys keys = Keys::linear;
    std::size_t count = 1;
    std::vector<float> times, values;
};

inline TestTrack random_track(Random& random, Keys keys, std::size_t count, double low, double high, std::size_t frames = 5) {
    TestTrack track{keys, count, {}, {}};
    float time = random.real32(0.0, 0.5);
    for (std::size_t k = 0; k < frames; ++k) {
        track.times.push_back(time);
        time += random.real32(0.1, 0.8);
    }
    const bool cubic = keys == Keys::cubic;
    for (std::size_t k = 0; k < frames; ++k)
        for (int part = 0; part < (cubic ? 3 : 1); ++part) {
            const bool tangent = cubic && part != 1;
            const std::size_t at = track.values.size();
            for (std::size_t i = 0; i < count; ++i) track.values.push_back(tangent ? random.real32(-1, 1) : random.real32(low, high));
            if (count != 4 || tangent || low != -1.0) continue;
            double length2 = 0;  // a rotation
            for (std::size_t i = 0; i < 4; ++i)
                length2 += static_cast<double>(track.values[at + i]) * static_cast<double>(track.values[at + i]);
            for (std::size_t i = 0; i < 4; ++i) track.values[at + i] = static_cast<float>(track.values[at + i] / std::sqrt(length2));
        }
    return track;
}

/// Adds a track as a sampler; returns the sampler's JSON.
inline std::string sampler_of(FilePieces& pieces, const TestTrack& track, const std::string& type, std::size_t components) {
    const int input = pieces.times(track.times), output = pieces.floats(track.values, type, components);
    return "{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(output) + ",\"interpolation\":\"" + name_of(track.keys) +
           "\"}";
}

/// The animations of a file, channel by channel.
struct AnimationText {
    std::string samplers, channels;
    int count = 0;
    void add(const std::string& sampler, const std::string& target) {
        samplers += (count > 0 ? "," : "") + sampler;
        channels += std::string(count > 0 ? "," : "") + "{\"sampler\":" + std::to_string(count) + ",\"target\":{" + target + "}}";
        ++count;
    }
    void add_node(const std::string& sampler, int node, const std::string& path) {
        add(sampler, "\"node\":" + std::to_string(node) + ",\"path\":\"" + path + "\"");
    }
    void add_pointer(const std::string& sampler, const std::string& pointer) {
        add(sampler, R"("path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" + pointer + "\"}}");
    }
    [[nodiscard]] std::string json(const std::string& name) const {
        return "{\"name\":\"" + name + "\",\"samplers\":[" + samplers + "],\"channels\":[" + channels + "]}";
    }
};

/// The arm: nodes 0 -> 1 -> 2. Node 3 has the morphing skin; node 2 has the plain triangle (mesh 1).
struct Arm {
    static constexpr std::size_t kVertices = 6, kTargets = 3;
    std::array<TestTrack, 3> translation, rotation, scale;
    TestTrack weights;
    std::vector<float> positions, bind;               // bind: three matrices, column by column
    std::array<std::vector<float>, kTargets> deltas;  // the last one is sparse
    std::array<std::vector<std::uint8_t>, 2> joints;  // by set
    std::array<std::vector<float>, 2> joint_weights;
    Bytes file;

    Arm(std::uint64_t seed, Keys keys) {
        Random random(seed);
        FilePieces pieces;
        AnimationText animation;
        const auto real = [&](double low, double high) { return random.real32(low, high); };
        for (std::size_t n = 0; n < 3; ++n) {
            translation[n] = random_track(random, keys, 3, -2, 2.5);
            rotation[n] = random_track(random, keys, 4, -1, 1);
            scale[n] = random_track(random, keys, 3, 0.5, 1.5);
            animation.add_node(sampler_of(pieces, translation[n], "VEC3", 3), static_cast<int>(n), "translation");
            animation.add_node(sampler_of(pieces, rotation[n], "VEC4", 4), static_cast<int>(n), "rotation");
            animation.add_node(sampler_of(pieces, scale[n], "VEC3", 3), static_cast<int>(n), "scale");
        }
        weights = random_track(random, keys, kTargets, -0.5, 1.5);
        animation.add_node(sampler_of(pieces, weights, "SCALAR", 1), 3, "weights");

        for (std::size_t i = 0; i < 3 * kVertices; ++i) positions.push_back(real(-1, 1));
        const int position = pieces.floats(positions, "VEC3", 3);
        std::string targets;
        for (std::size_t t = 0; t + 1 < kTargets; ++t) {
            for (std::size_t i = 0; i < 3 * kVertices; ++i) deltas[t].push_back(real(-1, 1));
            targets += "{\"POSITION\":" + std::to_string(pieces.floats(deltas[t], "VEC3", 3)) + "},";
        }
        Bytes at;
        append<std::uint16_t>(at, {1, 4});
        std::vector<float> moved;
        for (int i = 0; i < 6; ++i) moved.push_back(real(-1, 1));
        Bytes moved_bytes;
        for (const float v : moved) append<float>(moved_bytes, {v});
        deltas[2].assign(3 * kVertices, 0.0f);
        for (std::size_t i = 0; i < 3; ++i) deltas[2][3 + i] = moved[i], deltas[2][12 + i] = moved[3 + i];
        const int where = pieces.accessor(at, R"("componentType":5123,"type":"SCALAR","count":2)");
        const int values = pieces.accessor(moved_bytes, R"("componentType":5126,"type":"VEC3","count":2)");
        // An accessor of its own, over the view of the values; views and accessors have the same numbers, so it gets a view too.
        const int sparse = pieces.accessor(moved_bytes, R"("componentType":5126,"type":"VEC3","count":2)");
        pieces.accessors =
            replaced(pieces.accessors, "{\"bufferView\":" + std::to_string(sparse) + R"(,"componentType":5126,"type":"VEC3","count":2})",
                     R"({"componentType":5126,"type":"VEC3","count":6,"sparse":{"count":2,"indices":{"bufferView":)" +
                         std::to_string(where) + R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}}");
        targets += "{\"POSITION\":" + std::to_string(sparse) + "}";
        std::string skin_attributes;
        for (std::size_t v = 0; v < kVertices; ++v) {
            float raw[8], sum = 0;
            for (float& w : raw) sum += w = real(0.01, 1);
            for (std::size_t k = 0; k < 8; ++k) joint_weights[k / 4].push_back(raw[k] / sum);
        }
        for (std::size_t set = 0; set < 2; ++set) {
            Bytes numbers;
            for (std::size_t i = 0; i < 4 * kVertices; ++i) {
                joints[set].push_back(static_cast<std::uint8_t>(random.index(3)));
                append<std::uint8_t>(numbers, {joints[set].back()});
            }
            skin_attributes += ",\"JOINTS_" + std::to_string(set) +
                               "\":" + std::to_string(pieces.accessor(numbers, R"("componentType":5121,"type":"VEC4","count":6)")) +
                               ",\"WEIGHTS_" + std::to_string(set) + "\":" + std::to_string(pieces.floats(joint_weights[set], "VEC4", 4));
        }
        for (int j = 0; j < 3; ++j)
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) bind.push_back(r == 3 ? (c == 3 ? 1.0f : 0.0f) : real(-1, 1));
        const int matrices = pieces.floats(bind, "MAT4", 16);
        const int triangle = pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
        file =
            pieces.file(R"("scene":0,"scenes":[{"nodes":[0,3]}],"nodes":[{"children":[1]},{"children":[2]},{"mesh":1},)"
                        R"({"mesh":0,"skin":0,"translation":[7,8,9]}],"skins":[{"joints":[0,1,2],"inverseBindMatrices":)" +
                        std::to_string(matrices) + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(position) +
                        skin_attributes + "},\"targets\":[" + targets + R"(]}]},{"primitives":[{"attributes":{"POSITION":)" +
                        std::to_string(triangle) + "}}]}],\"animations\":[" + animation.json("wave") + "]");
    }
};

inline LoadOptions at(double time, const std::string& animation = "", bool keep = false) {
    LoadOptions options;
    options.animation = animation;
    options.time_s = time;
    options.keep_animations = keep;
    return options;
}

}  // namespace halflit::test
