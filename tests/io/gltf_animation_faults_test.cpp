// Animations of damaged files: refused or warned of, under all ways of loading.
#include "tests/io/animated_file.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using namespace halflit::test;

namespace {

struct Parts {
    std::vector<float> times{0, 1, 2};
    std::vector<float> values{0, 0, 0, 1, 1, 1, 2, 2, 2};
    std::string target = R"("node":0,"path":"translation")", interpolation = "LINEAR", type = "VEC3";
    std::string samplers{}, second{};
};

/// A triangle with one animation; accessor 0 is the triangle, 1 the times, 2 the values.
Bytes file_of(const Parts& parts) {
    FilePieces pieces;
    const std::size_t n = parts.type == "VEC3" ? 3 : parts.type == "VEC4" ? 4 : 1;
    pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    pieces.floats(parts.times, "SCALAR", 1, ",\"max\":[2]");
    pieces.floats(parts.values, parts.type, n);
    const std::string samplers =
        parts.samplers.empty() ? R"({"input":1,"output":2,"interpolation":")" + parts.interpolation + "\"}" : parts.samplers;
    return pieces.file(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0,"translation":[5,0,0]}],)"
                       R"("animations":[{"channels":[{"sampler":0,"target":{)" +
                       parts.target + R"(}}],"samplers":[)" + samplers + "]}" + parts.second + "]");
}

LoadOptions with(bool tolerant, bool keep, double time = 0.5) {
    LoadOptions options;
    options.strict = !tolerant;
    options.keep_animations = keep;
    options.time_s = time;
    return options;
}

}  // namespace

TEST_CASE("animation faults: what makes the pose a guess is left out, or refused by the strict rules", "[io]") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const std::vector<std::pair<Parts, std::string>> cases = {
        {{.times = {0, 2, 1}}, "samplers[0].input"},
        {{.times = {0, kNan, 2}}, "samplers[0].input"},
        {{.times = {0, 1, kInf}}, "samplers[0].input"},
        {{.times = {-kInf, 1, 2}}, "samplers[0].input"},
        {{.values = {0, 0, 0, 1, 1, 1}}, "samplers[0].output"},
        {{.values = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}}, "samplers[0].output"},
        {{.interpolation = "CUBICSPLINE"}, "samplers[0].output"},
        {{.values = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, .type = "VEC4"}, "samplers[0].output"},
        {{.target = R"("node":1,"path":"translation")"}, "target.node"},
        {{.samplers = R"({"input":3,"output":2})"}, "samplers[0].input"},
        {{.samplers = R"({"input":1,"output":99})"}, "samplers[0].output"},
        {{.samplers = R"({"input":2,"output":2})"}, "samplers[0].input"},
        {{.samplers = R"({"input":1})"}, "samplers[0]"},
        {{.samplers = " "}, "animations[0]"},
    };
    for (const auto& [parts, where] : cases) {
        INFO(where);
        const Bytes file = file_of(parts);
        for (const bool keep : {false, true}) {
            const auto refused = load(file, with(false, keep));
            REQUIRE(!refused);
            CHECK(refused.error().code == ErrorCode::bad_input);
            INFO(refused.error().message);
            CHECK(refused.error().message.find(where) != std::string::npos);
            const LoadedScene tolerant = load_ok(file, with(true, keep));
            CHECK(tolerant.scene.instances.at(0).world_from_object.c[3].x == 5.0f);
            CHECK(std::any_of(tolerant.warnings.begin(), tolerant.warnings.end(),
                              [](const std::string& w) { return w.find("the animation is left out") != std::string::npos; }));
        }
        // Nobody has to see the animation.
        LoadOptions none = with(false, false);
        none.animation = "none";
        CHECK(load_ok(file, none).scene.instances[0].world_from_object.c[3].x == 5.0f);
    }
}

TEST_CASE("animation faults: a fault of an animation that is not drawn refuses only what keeps it", "[io]") {
    const Bytes file =
        file_of({.second = R"(,{"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}],"samplers":[{"input":0,"output":1}]})"});
    CHECK(load_ok(file, with(false, false)).warnings.empty());
    const auto refused = load(file, with(false, true));
    REQUIRE(!refused);
    CHECK(refused.error().message.find("animations[1]") != std::string::npos);
    const LoadedScene tolerant = load_ok(file, with(true, true));
    Scene scene = tolerant.scene;
    REQUIRE(pose_at(*tolerant.motion, "1", 1.0, scene));
    CHECK(scene.instances[0].world_from_object.c[3].x == 5.0f);
    REQUIRE(pose_at(*tolerant.motion, "0", 1.0, scene));
    CHECK(scene.instances[0].world_from_object.c[3].x == 1.0f);
}

TEST_CASE("animation faults: equal and negative times are read, numbers that are not finite give the file's value", "[io]") {
    const LoadedScene equal = load_ok(file_of({.times = {-1, 1, 1}}), with(false, false, 1.0));
    CHECK(equal.warnings.size() == 3);  // equal, negative, max
    CHECK(equal.scene.instances[0].world_from_object.c[3].x == 2.0f);
    const Parts bad{.values = {0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 1, 1, 2, 2, 2}};
    CHECK(!load(file_of(bad), with(false, false, 0.0)));
    CHECK(load_ok(file_of(bad), with(true, false, 0.0)).scene.instances[0].world_from_object.c[3].x == 0.0f);
    CHECK(load_ok(file_of(bad), with(true, false, 0.5)).scene.instances[0].world_from_object.c[3].x == 5.0f);
    CHECK(load_ok(file_of(bad), with(true, false, 2.5)).scene.instances[0].world_from_object.c[3].x == 2.0f);
    CHECK(load_ok(file_of(bad)).warnings.size() == 1);
    // Cubic values whose tangents overflow.
    constexpr float kMost = std::numeric_limits<float>::max();
    Parts huge{.interpolation = "CUBICSPLINE"};
    huge.values.assign(27, kMost);
    CHECK(load_ok(file_of(huge), with(false, false, 0.5)).scene.instances[0].world_from_object.c[3].x == 5.0f);
}

TEST_CASE("animation faults: counts without data hit the limits", "[io]") {
    FilePieces pieces;
    pieces.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    pieces.accessors += R"(,{"componentType":5126,"type":"SCALAR","count":4000000000,"max":[0]},)"
                        R"({"componentType":5126,"type":"VEC3","count":4000000000})";
    const Bytes file =
        pieces.file(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"animations":[{"channels":)"
                    R"([{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":1,"output":2}]}])");
    for (const bool tolerant : {false, true}) {
        const auto refused = load(file, with(tolerant, false));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::limit);
    }
}
