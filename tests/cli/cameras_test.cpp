// Cameras of other programs, against projections in double, and cameras of reports, which are read back.
#include "tests/cli/program.hpp"
#include "tests/support/random.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

using namespace halflit::test;

namespace {

using Json = nlohmann::ordered_json;
using Strings = std::vector<std::string>;
using Numbers3 = std::array<double, 3>;
using Rows = std::array<Numbers3, 3>;

constexpr double kPi = 3.14159265358979323846;

/// A box of this half size around a point, as an OBJ file.
std::string box_at(const Numbers3& p, double half) {
    std::string text;
    for (int i = 0; i < 8; ++i)
        text += fmt::format("v {} {} {}\n", p[0] + (i & 1 ? half : -half), p[1] + (i & 2 ? half : -half), p[2] + (i & 4 ? half : -half));
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// R of a unit quaternion, by the images of the axes under q v q*.
Rows rotation_of(double w, double x, double y, double z) {
    Rows r{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Numbers3 v{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
        const Numbers3 u{x, y, z};
        const Numbers3 c{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const Numbers3 d{u[1] * c[2] - u[2] * c[1], u[2] * c[0] - u[0] * c[2], u[0] * c[1] - u[1] * c[0]};
        for (std::size_t row = 0; row < 3; ++row) r[row][axis] = v[row] + 2 * (w * c[row] + d[row]);
    }
    return r;
}

/// A camera of computer vision: R X + t, with K whose pixels have their corners at whole numbers.
struct Vision {
    Rows r;
    Numbers3 t;
    double fx, fy, cx, cy;
    int width, height;

    [[nodiscard]] Numbers3 in_camera(const Numbers3& p) const {
        Numbers3 out{};
        for (std::size_t i = 0; i < 3; ++i) out[i] = r[i][0] * p[0] + r[i][1] * p[1] + r[i][2] * p[2] + t[i];
        return out;
    }
    [[nodiscard]] std::array<double, 2> pixel_of(const Numbers3& p) const {
        const Numbers3 c = in_camera(p);
        return {fx * c[0] / c[2] + cx, fy * c[1] / c[2] + cy};
    }
    /// The point that is seen at a pixel, at this depth.
    [[nodiscard]] Numbers3 point_at(double u, double v, double depth) const {
        const Numbers3 c{(u - cx) / fx * depth - t[0], (v - cy) / fy * depth - t[1], depth - t[2]};
        return {r[0][0] * c[0] + r[1][0] * c[1] + r[2][0] * c[2], r[0][1] * c[0] + r[1][1] * c[1] + r[2][1] * c[2],
                r[0][2] * c[0] + r[1][2] * c[1] + r[2][2] * c[2]};
    }
    /// The matrix of OpenGL, in four rows: its columns are right, up, back and the eye.
    [[nodiscard]] std::array<std::array<double, 4>, 4> world_from_camera() const {
        std::array<std::array<double, 4>, 4> m{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double eye = -(r[0][i] * t[0] + r[1][i] * t[1] + r[2][i] * t[2]);
            m[i] = {r[0][i], -r[1][i], -r[2][i], eye};
        }
        m[3] = {0, 0, 0, 1};
        return m;
    }
};

/// The quaternion, and a camera that has it.
constexpr std::array<double, 4> kTurn{0.7, -0.1, 0.5, 0.5};  // 0.49 + 0.01 + 0.25 + 0.25 = 1
Vision some_camera() { return {rotation_of(kTurn[0], kTurn[1], kTurn[2], kTurn[3]), {0.3, -0.2, 4}, 210, 190, 75, 50, 160, 120}; }

Json reported(const Outcome& outcome) {
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out);
}

Json drawn(const std::string& scene, const std::string& output, const Strings& flags) {
    Strings arguments{"render", scene, "-o", output, "--report", "-", "--quiet", "--samples", "4"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return reported(run(arguments));
}

/// Where the covered pixels' centre lies.
std::array<double, 2> centre_of(const std::string& file) {
    const Picture picture = read_picture(contents(file));
    double sum = 0, x = 0, y = 0;
    for (int j = 0; j < picture.height; ++j)
        for (int i = 0; i < picture.width; ++i) {
            const double alpha = picture.pixel(i, j)[3];
            sum += alpha, x += alpha * (i + 0.5), y += alpha * (j + 0.5);
        }
    REQUIRE(sum > 0);
    return {x / sum, y / sum};
}

/// Draws small boxes at points that `camera` sees at known pixels, and checks where they are.
void check_places(const TemporaryFolder& folder, const Vision& camera, const Strings& flags) {
    for (const auto& [u, v, depth] : {std::array{20.0, 15.0, 3.0}, std::array{140.5, 30.25, 5.0}, std::array{75.0, 110.0, 9.0}}) {
        const Numbers3 p = camera.point_at(u, v, depth);
        const std::string scene = folder.file("box.obj"), picture = folder.file("picture.png");
        write_contents(scene, box_at(p, 0.006 * depth));  // two or three pixels wide
        Strings all = flags;
        all.insert(all.end(), {"--background", "transparent"});
        const Json report = drawn(scene, picture, all);
        CHECK(report["size"] == Json{camera.width, camera.height});
        const auto [x, y] = centre_of(picture);
        CHECK(std::abs(x - u) < 0.5);
        CHECK(std::abs(y - v) < 0.5);
        // The report's R, t and K give the same pixel.
        const Json& told = report["camera"];
        Vision read{{}, told["t"].get<Numbers3>(), told["k"][0][0], told["k"][1][1], told["k"][0][2], told["k"][1][2], 0, 0};
        for (std::size_t i = 0; i < 3; ++i) read.r[i] = told["r"][i].get<Numbers3>();
        CHECK(std::abs(read.pixel_of(p)[0] - u) < 0.01);
        CHECK(std::abs(read.pixel_of(p)[1] - v) < 0.01);
    }
}

Json own_json(const Vision& camera) {
    return {{"k", {{camera.fx, 0, camera.cx}, {0, camera.fy, camera.cy}, {0, 0, 1}}},
            {"r", camera.r},
            {"t", camera.t},
            {"width", camera.width},
            {"height", camera.height}};
}

Json flat(const std::array<std::array<double, 4>, 4>& rows) {
    Json out = Json::array();
    for (const auto& row : rows)
        for (const double x : row) out.push_back(x);
    return out;
}

}  // namespace

TEST_CASE("camera file: K, R and t put points where they are projected", "[cli][cameras]") {
    const TemporaryFolder folder;
    const Vision camera = some_camera();
    write_contents(folder.file("c.json"), own_json(camera).dump());
    check_places(folder, camera, {"--camera-file", folder.file("c.json")});
}

TEST_CASE("camera file: a matrix of OpenGL puts points where they are projected", "[cli][cameras]") {
    const TemporaryFolder folder;
    Vision camera = some_camera();
    camera.fx = camera.fy = 170, camera.cx = 80, camera.cy = 60;
    const Json json{{"name", "one"},
                    {"world_from_camera", flat(camera.world_from_camera())},
                    {"fov_y_deg", 2 * std::atan(60.0 / 170) * 180 / kPi},
                    {"width", 160},
                    {"height", 120}};
    write_contents(
        folder.file("c.json"),
        Json::array(
            {{{"name", "zero"}, {"fov_y_deg", 50}, {"world_from_camera", flat({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}})}},
             json})
            .dump());
    for (const char* wanted : {"one", "1"}) check_places(folder, camera, {"--camera-file", folder.file("c.json"), "--camera", wanted});
}

TEST_CASE("camera file: transforms.json of NeRF puts points where they are projected", "[cli][cameras]") {
    const TemporaryFolder folder;
    Vision camera = some_camera();
    Json json{{"fl_x", camera.fx}, {"fl_y", camera.fy}, {"cx", camera.cx}, {"cy", camera.cy}, {"w", 160}, {"h", 120}};
    json["frames"] = {{{"file_path", "./images/left.png"}, {"transform_matrix", camera.world_from_camera()}}};
    write_contents(folder.file("transforms.json"), json.dump());
    check_places(folder, camera, {"--camera-file", folder.file("transforms.json")});
    // An angle in place of focal lengths.
    camera.fx = camera.fy = 80 / std::tan(0.4), camera.cx = 80, camera.cy = 60;
    json.erase("fl_x"), json.erase("fl_y"), json.erase("cx"), json.erase("cy");
    json["camera_angle_x"] = 0.8;
    write_contents(folder.file("transforms.json"), json.dump());
    check_places(folder, camera, {"--camera-file", folder.file("transforms.json")});
    // Without a size the picture is square.
    json.erase("w"), json.erase("h");
    write_contents(folder.file("transforms.json"), json.dump());
    camera.fx = camera.fy = 60 / std::tan(0.4), camera.cx = camera.cy = 60, camera.width = camera.height = 120;
    write_contents(folder.file("box.obj"), box_at(camera.point_at(30, 40, 4), 0.02));
    CHECK(drawn(folder.file("box.obj"), folder.file("p.png"), {"--camera-file", folder.file("transforms.json")})["size"] == Json{720, 720});
}

TEST_CASE("camera file: COLMAP's quaternion and lens put points where they are projected", "[cli][cameras]") {
    const TemporaryFolder folder;
    const Vision camera = some_camera();
    write_contents(folder.file("cameras.txt"),
                   "# Camera list\n7 PINHOLE 160 120 210 190 75 50\n8 OPENCV 160 120 210 190 75 50 0.1 0 0 0\n");
    // The second picture has no points: an empty line.
    constexpr const char* kImages =
        "# Image list\n1 0.7 -0.1 0.5 0.5 0.3 -0.2 4 7 dir/a b.jpg\n10 20 -1 30.5 40 2\n2 1.4 -0.2 1 1 0.3 -0.2 4 {} second.jpg\n\n";
    write_contents(folder.file("images.txt"), fmt::format(kImages, 7));
    check_places(folder, camera, {"--camera-file", folder.file("images.txt")});
    check_places(folder, camera, {"--camera-file", folder.path(), "--camera", "dir/a b.jpg"});
    check_places(folder, camera, {"--camera-file", folder.file("images.txt"), "--camera", "second.jpg"});
    write_contents(folder.file("images.txt"), fmt::format(kImages, 8));
    write_contents(folder.file("box.obj"), box_at(camera.point_at(30, 40, 4), 0.02));
    const Json report = drawn(folder.file("box.obj"), folder.file("p.png"), {"--camera-file", folder.file("images.txt")});
    REQUIRE(report["warnings"].size() == 1);
    CHECK(report["warnings"][0].get<std::string>().find("distortion") != std::string::npos);
}

TEST_CASE("camera file: the cameras of a glTF file are drawn for another model", "[cli][cameras]") {
    const TemporaryFolder folder;
    Vision camera = some_camera();
    camera.fx = camera.fy = 60 / std::tan(0.35), camera.cx = 80, camera.cy = 60;
    const auto rows = camera.world_from_camera();
    Json matrix = Json::array();
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row) matrix.push_back(rows[row][column]);
    const Json gltf{{"asset", {{"version", "2.0"}}},
                    {"scenes", {{{"nodes", {0}}}}},
                    {"nodes", {{{"camera", 0}, {"matrix", matrix}}}},
                    {"cameras", {{{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}}}}};
    write_contents(folder.file("cameras.gltf"), gltf.dump());
    check_places(folder, camera, {"--camera-file", folder.file("cameras.gltf"), "--camera", "eye", "--size", "160x120"});
}

TEST_CASE("camera file: a model that is turned upright gets its cameras turned likewise", "[cli][cameras]") {
    const TemporaryFolder folder;
    const Vision camera = some_camera();
    write_contents(folder.file("c.json"), own_json(camera).dump());
    for (const char* up : {"x", "z", "-y"}) check_places(folder, camera, {"--camera-file", folder.file("c.json"), "--up", up});
}

TEST_CASE("camera of a report: read back it draws the same pixels", "[cli][cameras]") {
    const TemporaryFolder folder;
    Random random(20);
    const auto between = [&](double low, double high) { return random.real(low, high); };
    write_contents(folder.file("far.obj"), box_at({1e6, -2e6, 3e5}, 0.7));
    std::size_t pictures = 0;
    for (int i = 0; i < 20; ++i) {
        INFO(i);
        // Perspective by an angle, by K; orthographic by a height, by K. Every other one is of a model that is drawn elsewhere.
        const bool is_far = i % 2 == 1;
        double q[4], length = 0;
        for (double& x : q) x = between(-1, 1), length += x * x;
        for (double& x : q) x /= std::sqrt(length);
        Vision camera{rotation_of(q[0], q[1], q[2], q[3]),
                      {between(-0.3, 0.3), between(-0.3, 0.3), between(3, 6)},
                      between(40, 80),
                      between(40, 80),
                      between(20, 50),
                      between(10, 40),
                      72,
                      52};
        if (is_far)
            for (std::size_t row = 0; row < 3; ++row)
                camera.t[row] -= camera.r[row][0] * 1e6 + camera.r[row][1] * -2e6 + camera.r[row][2] * 3e5;
        Json json = own_json(camera);
        json["orthographic"] = i % 4 >= 2;
        if (i % 4 >= 2) json["k"] = {{12 + i, 0, 31.7}, {0, 17 - 0.3 * i, 22.1}, {0, 0, 1}};
        if (i % 3 == 0) json[i % 4 >= 2 ? "half_height" : "fov_y_deg"] = i % 4 >= 2 ? 1.3 + 0.01 * i : 40.0 + i;
        if (i % 5 == 0) json["near"] = 0.5, json["far"] = 50.25;
        write_contents(folder.file("given.json"), json.dump());
        const Strings scene_flags = is_far ? Strings{"--up", "z"} : Strings{};
        const std::string scene = is_far ? folder.file("far.obj") : "demo";
        Strings flags = scene_flags;
        flags.insert(flags.end(), {"--camera-file", folder.file("given.json")});
        const Json first = drawn(scene, folder.file("a.png"), flags);
        write_contents(folder.file("told.json"), first["camera"].dump());
        flags.back() = folder.file("told.json");
        const Json again = drawn(scene, folder.file("b.png"), flags);
        CHECK(again["pixel_hash"] == first["pixel_hash"]);
        CHECK(again["camera"] == first["camera"]);
        pictures += first["pixels_visible"].get<std::int64_t>() > 20 ? 1 : 0;
    }
    CHECK(pictures == 20);
    // Cameras that the program chooses.
    for (const Strings& flags :
         {Strings{}, Strings{"--view", "iso", "--ortho", "--shadows", "hard"}, Strings{"--camera-position", "3,2,4", "--fov", "30"}}) {
        Strings all = flags;
        all.insert(all.end(), {"--size", "72x52"});
        const Json first = drawn("demo", folder.file("a.png"), all);
        write_contents(folder.file("told.json"), first["camera"].dump());
        Strings again{"--camera-file", folder.file("told.json")};
        if (!flags.empty() && flags.back() == "hard")
            again.insert(again.end(), flags.end() - 2, flags.end());  // without --ortho there are shadows by default
        CHECK(drawn("demo", folder.file("b.png"), again)["pixel_hash"] == first["pixel_hash"]);
    }
}

TEST_CASE("camera orbit: the eye is where model-viewer has it, and looks at the target", "[cli][cameras]") {
    const TemporaryFolder folder;
    for (const auto& [text, theta, phi, radius] :
         {std::tuple{"30deg 60deg 5m", 30.0, 60.0, 5.0}, std::tuple{"-1rad 1.2rad 700cm", -180 / kPi, 216 / kPi, 7.0},
          std::tuple{"200 170 6500mm", 200.0, 170.0, 6.5}, std::tuple{"0 0 4", 0.0, 0.0, 4.0}}) {
        INFO(text);
        const Json m = drawn("demo", folder.file("a.png"),
                             {"--size", "32x24", "--camera-orbit", text, "--camera-target", "0.1,0.2,-0.3"})["camera"]["world_from_camera"];
        const double t = theta * kPi / 180, p = phi * kPi / 180;
        const Numbers3 back{std::sin(p) * std::sin(t), std::cos(p), std::sin(p) * std::cos(t)}, target{0.1, 0.2, -0.3};
        const Numbers3 right{std::cos(t), 0, -std::sin(t)};
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(std::abs(m[4 * i].get<double>() - right[i]) < 1e-6);
            CHECK(std::abs(m[4 * i + 2].get<double>() - back[i]) < 1e-6);
            CHECK(std::abs(m[4 * i + 3].get<double>() - (target[i] + radius * back[i])) < 1e-5);
        }
    }
}

TEST_CASE("camera orbit: auto and shares are of the distance that shows all sides", "[cli][cameras]") {
    const TemporaryFolder folder;
    const auto matrix = [&](const Strings& flags) {
        Strings all = flags;
        all.insert(all.end(), {"--size", "32x24"});
        return drawn("demo", folder.file("a.png"), all)["camera"]["world_from_camera"].get<std::array<double, 16>>();
    };
    const auto front = matrix({"--view", "front"}), same = matrix({"--camera-orbit", "auto 90deg auto"});
    for (std::size_t i = 0; i < 16; ++i) CHECK(std::abs(front[i] - same[i]) < 1e-5);
    // 200 % is twice as far from the target, which is half way between the eyes of front and back.
    const auto back = matrix({"--view", "back"}), far = matrix({"--camera-orbit", "0 90 200%"});
    CHECK(std::abs(far[11] - (front[11] + 0.5 * (front[11] - back[11]))) < 1e-5);
}

TEST_CASE("camera file: all cameras are drawn, in files whose names stay in the folder", "[cli][cameras]") {
    const TemporaryFolder folder;
    const Vision camera = some_camera();
    Json cameras = Json::array();
    for (const char* name : {"../../outside", "left/a.png", "a", "", "..", "w\x1b[2J"}) {
        cameras.push_back(own_json(camera));
        cameras.back()["name"] = name;
    }
    write_contents(folder.file("c.json"), cameras.dump());
    const Outcome outcome = run({"render", "demo", "--camera-file", folder.file("c.json"), "--camera", "all", "-o",
                                 folder.file("{view}.png"), "--quiet", "--samples", "1", "--report", folder.file("r.json")});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(folder.names() == Strings{"a.png", "a_2.png", "c.json", "camera_3.png", "camera_4.png", "outside.png", "r.json", "w__2J.png"});
    cameras[1]["width"] = 161;
    write_contents(folder.file("c.json"), cameras.dump());
    const Outcome sizes =
        run({"render", "demo", "--camera-file", folder.file("c.json"), "--camera", "all", "-o", folder.file("{view}.png")});
    CHECK(sizes.code == 2);
    CHECK(sizes.err.find("different sizes") != std::string::npos);
}

TEST_CASE("camera file: every camera of a report of look, of render and of several pictures is a view", "[cli][cameras]") {
    const TemporaryFolder folder;
    const auto all_by = [&](const std::string& report, const std::string& prefix) {
        const Outcome outcome = run({"render", "demo", "--samples", "1", "--camera-file", folder.file(report), "--camera", "all", "-o",
                                     folder.file(prefix + "{view}.png"), "--report", "-", "--quiet"});
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        std::vector<Json> lines;
        std::istringstream text(outcome.out);
        for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
        return lines;
    };
    const auto same_place = [](Json a, Json b) {
        a.erase("name"), b.erase("name");
        return a == b;
    };
    (void)run({"look", "demo", "--size", "64x48", "--json", folder.file("look.json")});
    const Json look = Json::parse(contents(folder.file("look.json")));
    const auto views = all_by("look.json", "look_");
    REQUIRE(views.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(views[i]["output"] == folder.file("look_" + look["views"][i]["name"].get<std::string>() + ".png"));
        CHECK(same_place(views[i]["camera"], look["views"][i]["camera"]));
    }
    // By the name of the view.
    const Json top = drawn("demo", folder.file("top.png"), {"--camera-file", folder.file("look.json"), "--camera", "top"});
    CHECK(same_place(top["camera"], look["views"][2]["camera"]));
    // One picture, and several, one a line.
    write_contents(folder.file("one.json"), drawn("demo", folder.file("one.png"), {"--view", "iso", "--size", "40x30"}).dump(2));
    CHECK(all_by("one.json", "one_").size() == 1);
    REQUIRE(run({"render", "demo", "--size", "40x30", "--turntable", "5", "-o", folder.file("f_{}.png"), "--report",
                 folder.file("film.json"), "--quiet"})
                .code == 0);
    const auto frames = all_by("film.json", "again_");
    REQUIRE(frames.size() == 5);
    std::istringstream film(contents(folder.file("film.json")));
    for (const Json& frame : frames) {
        std::string line;
        std::getline(film, line);
        CHECK(same_place(frame["camera"], Json::parse(line)["camera"]));
    }
    for (const std::string text :
         {R"({"schema": "halflit.look/1", "views": []})", R"({"schema": "halflit.look/1", "views": [{"camera": 3}]})",
          R"({"schema": "halflit.report/1", "camera": {}})", R"({"schema": "x"})", "{\"schema\":\"halflit.report/1\"}\n{\"schema\": 4"}) {
        write_contents(folder.file("wrong.json"), text);
        const Outcome wrong =
            run({"render", "demo", "--size", "8", "--camera-file", folder.file("wrong.json"), "-o", folder.file("w.png")});
        INFO(text << wrong.err);
        CHECK(wrong.code == 3);
        CHECK(std::count(wrong.err.begin(), wrong.err.end(), '\n') == 1);
    }
}

TEST_CASE("camera file: frames of different sizes are refused with both, unless --size sets one", "[cli][cameras]") {
    const TemporaryFolder folder;
    Json cameras{{"camera_angle_x", 0.8}, {"frames", Json::array()}};
    for (const int width : {40, 40, 64}) {
        Json frame{{"file_path", "p" + std::to_string(cameras["frames"].size())}, {"w", width}, {"h", 30}};
        frame["transform_matrix"] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 4}, {0, 0, 0, 1}};
        cameras["frames"].push_back(std::move(frame));
    }
    write_contents(folder.file("transforms.json"), cameras.dump());
    const auto draw = [&](const Strings& more) {
        Strings words{"render", "demo", "--camera-file", folder.file("transforms.json"), "-o", folder.file("{view}.png")};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    const Outcome mixed = draw({"--camera", "all"});
    CHECK(mixed.code == 2);
    CHECK(mixed.err.find("different sizes, 40x30 and 64x30; --size sets one") != std::string::npos);
    const Outcome sized = draw({"--camera", "all", "--size", "40x30"});
    CHECK(sized.code == 0);
    CHECK(sized.err.find("made for 64x30 pixels; --size 40x30 stretches it") != std::string::npos);
    // Each alone has its own size.
    CHECK(drawn("demo", folder.file("a.png"), {"--camera-file", folder.file("transforms.json"), "--camera", "p2"})["size"] == Json{64, 30});
    CHECK(drawn("demo", folder.file("a.png"), {"--camera-file", folder.file("transforms.json"), "--camera", "p1"})["size"] == Json{40, 30});
}

TEST_CASE("camera file: what is damaged is refused in one line", "[cli][cameras]") {
    const TemporaryFolder folder;
    const std::string good = own_json(some_camera()).dump();
    const auto with = [&](const char* key, const Json& value) {
        Json json = Json::parse(good);
        if (value.is_null())
            json.erase(key);
        else
            json[key] = value;
        return json.dump();
    };
    const Json mirror{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, scaled{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    const Strings texts{"",
                        "{",
                        "[]",
                        "{}",
                        "[1]",
                        "null",
                        "\x89PNG",
                        std::string(5000, '['),
                        std::string(40, '[') + std::string(40, ']'),
                        good.substr(0, good.size() / 2),
                        with("t", nullptr),
                        with("t", {1, 2}),
                        with("t", {1, 2, "x"}),
                        with("t", {1e300, 0, 0}),
                        with("r", mirror),
                        with("r", scaled),
                        with("r", {1, 2, 3}),
                        with("k", nullptr),
                        with("k", {{0, 0, 1}, {0, 1, 1}, {0, 0, 1}}),
                        with("k", {{100, 5, 1}, {0, 100, 1}, {0, 0, 1}}),
                        with("width", 0),
                        with("width", 1.5),
                        with("width", 1e9),
                        with("width", "wide"),
                        with("height", 30000000),
                        with("fov_y_deg", 180),
                        with("near", -1),
                        with("name", 3),
                        with("orthographic", 1),
                        "{\"frames\": 1}",
                        "{\"frames\": []}",
                        "{\"frames\": [{}]}",
                        "{\"camera_angle_x\": 0.5, \"frames\": [{\"transform_matrix\": [[1,0,0,0],[0,1,0,0]]}]}",
                        "{\"k\": 1e999}",
                        "# COLMAP\n1 0 0 0 0 1 2 3 1 a\n\n",
                        "1 1 0 0 0 0 0 nan 1 a\n",
                        "1 1 0 0 0 0 0 0 9 a\n",
                        "1 1 0 0\n"};
    write_contents(folder.file("cameras.txt"), "1 PINHOLE 16 12 20 20 8 6\n");
    for (const std::string& text : texts) {
        INFO(text.substr(0, 200));
        write_contents(folder.file("c.json"), text);
        const Outcome outcome =
            run({"render", "demo", "--size", "16x12", "--camera-file", folder.file("c.json"), "-o", folder.file("p.png")});
        CHECK((outcome.code == 3 || outcome.code == 5));
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        CHECK(outcome.err.find("c.json") != std::string::npos);
    }
    write_contents(folder.file("c.json"), good);
    for (const char* lens :
         {"1 PINHOLE 16 12 20 20 8\n", "1 PINHOLE 16 12 20 20 8 inf\n", "1 PINHOLE 0 12 20 20 8 6\n", "1 EYE 16 12 20 20 8 6\n", ""}) {
        INFO(lens);
        write_contents(folder.file("cameras.txt"), lens);
        write_contents(folder.file("images.txt"), "1 1 0 0 0 0 0 0 1 a\n\n");
        CHECK(run({"render", "demo", "--camera-file", folder.file("images.txt"), "-o", folder.file("p.png")}).code == 3);
    }
}

TEST_CASE("camera flags: contradictions are refused", "[cli][cameras]") {
    const TemporaryFolder folder;
    write_contents(folder.file("c.json"), own_json(some_camera()).dump());
    const std::string file = folder.file("c.json");
    for (const Strings& flags :
         {Strings{"--camera", "all"}, Strings{"--camera-file", file, "--camera", "5"}, Strings{"--camera-file", file, "--view", "front"},
          Strings{"--camera-file", file, "--fov", "30"}, Strings{"--camera-file", file, "--camera-orbit", "0 90 5"},
          Strings{"--camera-orbit", "0 90 5", "--camera-position", "1,2,3"}, Strings{"--camera-orbit", "0 90 5", "--ortho"},
          Strings{"--camera-orbit", "0 90"}, Strings{"--camera-orbit", "0 190 5"}, Strings{"--camera-orbit", "0 90 -5"},
          Strings{"--camera-orbit", "0 90 nan"}, Strings{"--camera-orbit", "0 90 5km"}, Strings{"--camera-target", "1,2,3"}}) {
        INFO(fmt::format("{}", fmt::join(flags, " ")));
        Strings arguments{"render", "demo", "-o", folder.file("p.png")};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        CHECK(run(arguments).code == 2);
    }
}
