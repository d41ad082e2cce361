// `halflit look` as its users run it: faults of views, exit codes, and the sheet.
#include "sh/vec3d.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/solids.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

using namespace halflit;
using namespace halflit::test;

namespace {

using Json = nlohmann::json;

void write_obj(const std::string& path, const Mesh& mesh) {
    std::ostringstream text;
    text.precision(9);
    for (const Vec3f& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        text << "f " << mesh.indices[i] + 1 << ' ' << mesh.indices[i + 1] + 1 << ' ' << mesh.indices[i + 2] + 1 << '\n';
    write_contents(path, text.str());
}

std::string text_of(Vec3d p) {
    std::ostringstream text;
    text.precision(9);
    text << p.x << ',' << p.y << ',' << p.z;
    return text.str();
}

/// Words of all views. The exit code must agree with them.
std::vector<std::string> faults(const std::string& model, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"look", model, "--json", "-", "--size", "160x120"});
    const Outcome outcome = run(flags);
    const Json report = Json::parse(outcome.out, nullptr, false);
    INFO(outcome.err);
    REQUIRE(report.is_object());
    std::vector<std::string> words;
    for (const Json& view : report["views"])
        for (const Json& word : view["faults"]) words.push_back(word.get<std::string>());
    CHECK(outcome.code == (words.empty() ? 0 : 1));
    CHECK(report["good"] == words.empty());
    return words;
}

struct Sphere {
    Vec3d middle;
    double radius;
};

/// Around the box of a mesh, and so around the mesh.
Sphere sphere_around(const Mesh& mesh) {
    Bounds bounds;
    for (const Vec3f& p : mesh.positions) bounds.add(p);
    const Vec3d low = to_double(bounds.min), high = to_double(bounds.max);
    return {(low + high) * 0.5, 0.5 * length(high - low)};
}

Vec3d random_direction(Random& random) {
    for (;;) {
        const Vec3d p{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        if (const double size = length(p); size > 0.1 && size < 1.0) return p * (1.0 / size);
    }
}

/// True if a view of 160 x 120 pixels, 35 degrees high, from the eye towards the target lacks a vertex.
bool shows_less(const Mesh& mesh, Vec3d eye, Vec3d target) {
    const auto unit = [](Vec3d p) { return p * (1.0 / length(p)); };
    const Vec3d ahead = unit(target - eye), right = unit(cross(ahead, {0, 1, 0})), up = cross(right, ahead);
    const double tangent = std::tan(0.5 * 35.0 * std::numbers::pi / 180.0);
    return std::any_of(mesh.positions.begin(), mesh.positions.end(), [&](const Vec3f& vertex) {
        const Vec3d p = to_double(vertex) - eye;
        const double z = dot(p, ahead) * tangent * 1.001;  // by more than rounding
        return std::abs(dot(p, up)) > z || std::abs(dot(p, right)) > z * 160 / 120;
    });
}

void check_bad_views(int of_each) {
    const TemporaryFolder folder;
    const std::string model = folder.file("model.obj");
    constexpr const char* kWords[] = {"blank", "cropped", "cut", "inside", "tiny"};
    int right = 0;
    for (int kind = 0; kind < 5; ++kind)
        for (int i = 0; i < of_each; ++i) {
            Random random(static_cast<std::uint64_t>(100 * kind + i));
            const Mesh mesh = random_closed_solid(random);
            write_obj(model, mesh);
            const auto [middle, radius] = sphere_around(mesh);
            const Vec3d away = random_direction(random);
            Vec3d eye = middle + away * (4.5 * radius), target = middle;
            if (kind == 0) target = eye + away;  // the model is behind
            if (kind == 1) {                     // the view turns away until a vertex is out of it
                const Vec3d side = cross(away, random_direction(random));
                while (!shows_less(mesh, eye, target)) target = target + side * (0.02 * radius);
            }
            if (kind == 2) {  // beside the model, looking along it: part of it is behind
                eye = middle + away * (1.02 * radius);
                const Vec3d across = cross(away, std::abs(away.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
                target = eye + across * (1.0 / length(across));
            }
            if (kind == 3) eye = middle + away * (1e-3 * radius), target = eye + away;
            if (kind == 4) eye = middle + away * (60 * radius);
            const auto words = faults(model, {"--camera-position=" + text_of(eye), "--camera-target=" + text_of(target)});
            INFO(kWords[kind] << ", model " << i << ": eye " << text_of(eye) << " target " << text_of(target));
            const bool found = std::find(words.begin(), words.end(), kWords[kind]) != words.end();
            CHECK(found);
            right += found ? 1 : 0;
            if (kind == 4) CHECK(words.size() == 1);
        }
    CHECK(right == 5 * of_each);
}

void check_good_views(int of_each) {
    const TemporaryFolder folder;
    const std::string model = folder.file("model.obj");
    for (int kind = 0; kind < 4; ++kind)
        for (int i = 0; i < of_each; ++i) {
            Random random(static_cast<std::uint64_t>(1000 + 100 * kind + i));
            const Mesh mesh = random_closed_solid(random);
            write_obj(model, mesh);
            const auto [middle, radius] = sphere_around(mesh);
            std::vector<std::string> flags;
            if (kind == 1) flags = {"--view=" + std::to_string(random.integer(-180, 180)) + "," + std::to_string(random.integer(-80, 80))};
            if (kind == 2) flags = {"--view", "front,iso,back,bottom", "--perspective"};
            if (kind == 3) {
                // At 3.6 radii the sphere spans 32 of the view's 35 degrees.
                const Vec3d eye = middle + random_direction(random) * (3.6 * radius);
                flags = {"--camera-position=" + text_of(eye), "--camera-target=" + text_of(middle)};
            }
            INFO("kind " << kind << ", model " << i);
            CHECK(faults(model, flags).empty());
        }
}

}  // namespace

TEST_CASE("look: bad views are flagged by their word", "[cli][look]") { check_bad_views(2); }
TEST_CASE("look: good views are not flagged", "[cli][look]") { check_good_views(2); }
TEST_CASE("look: a hundred bad views are flagged by their word", "[cli][look][slow]") { check_bad_views(20); }
TEST_CASE("look: a hundred good views are not flagged", "[cli][look][slow]") { check_good_views(25); }

TEST_CASE("look: a camera of the file that shows all is good, and one whose near plane cuts the model is not", "[cli][look]") {
    const TemporaryFolder folder;
    const auto file = [&](double near_z) {
        // A triangle in the plane z = 0 with corners (-1, -1), (1, -1), (0, 1), seen from z = 4.
        std::ostringstream text;
        text
            << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"camera":0,"translation":[0,0,4]}],)"
            << R"("cameras":[{"type":"perspective","perspective":{"yfov":0.8,"aspectRatio":1.3333333,"znear":)" << near_z << "}}],"
            << R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
            << R"("type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,)"
            << R"("uri":"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";
        write_contents(folder.file("a.gltf"), text.str());
        return folder.file("a.gltf");
    };
    CHECK(faults(file(0.1), {"--camera", "0"}).empty());
    const auto words = faults(file(4.5), {"--camera", "0"});
    CHECK(std::find(words.begin(), words.end(), "cut") != words.end());
    CHECK(std::find(words.begin(), words.end(), "blank") != words.end());
}

TEST_CASE("look: sheets are written for small sizes, points, lines, one triangle and nothing", "[cli][look]") {
    const TemporaryFolder folder;
    write_contents(folder.file("points.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 1\np 1 2 3\n");
    write_contents(folder.file("lines.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 1\nl 1 2 3 1\n");
    write_contents(folder.file("triangle.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    write_obj(folder.file("needle.obj"), box_mesh({0, 0, 0}, {1000, 1, 1}));
    for (const char* name : {"points.obj", "lines.obj", "triangle.obj", "empty.gltf", "needle.obj"})
        for (const char* size : {"16", "200", "480x400"}) {
            const Outcome outcome = run({"look", folder.file(name), "-o", folder.file("a.png"), "--size", size});
            INFO(name << " " << size << ": " << outcome.err);
            CHECK((outcome.code == 0 || outcome.code == 1));
            CHECK(read_picture(contents(folder.file("a.png"))).width > 2 * 16);
        }
}

TEST_CASE("look: a flat model seen along its plane is no fault", "[cli][look]") {
    const TemporaryFolder folder;
    write_contents(folder.file("square.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const Outcome outcome = run({"look", folder.file("square.obj"), "--json", "-", "--size", "200", "--view", "front,right,top,back"});
    const auto views = nlohmann::json::parse(outcome.out)["views"];
    REQUIRE(views.size() == 4);
    for (const std::size_t edge_on : {1, 2}) {
        CHECK(views[edge_on]["edge_on"] == true);
        CHECK(views[edge_on]["faults"].empty());
    }
    CHECK(views[0]["edge_on"] == false);
    CHECK(views[0]["share_of_picture"].get<double>() > 0.1);
}

TEST_CASE("look: a view faces each section", "[cli][look][section]") {
    const std::pair<const char*, std::array<double, 3>> planes[] = {
        {"x=0.2", {1, 0, 0}}, {"y=0.1", {0, 1, 0}}, {"z=-0.3", {0, 0, 1}}, {"1,1,0,0.5", {std::sqrt(0.5), std::sqrt(0.5), 0}}};
    for (const auto& [plane, normal] : planes) {
        INFO(plane);
        const auto report = nlohmann::json::parse(run({"look", "sphere:500", "--size", "64", "--json", "-", "--section", plane}).out);
        REQUIRE(report["views"].size() == 5);
        CHECK(report["views"][4]["name"] == "section");
        for (std::size_t k = 0; k < 3; ++k) CHECK(report["views"][4]["camera"]["r"][2][k].get<double>() == Approx(-normal[k]).margin(1e-6));
    }
}

TEST_CASE("look: --projection is refused for views that make no drawing", "[cli][look]") {
    const auto look = [](const std::string& views) {
        return run({"look", "sphere:100", "--size", "64", "--json", "-", "--projection", "first", "--view", views});
    };
    CHECK(look("front,top").code == 0);
    CHECK(look("left,front,right").code == 0);
    for (const std::string views : {"front", "right,top", "front,30,20"}) {
        const Outcome refused = look(views);
        CHECK(refused.code == 2);
        CHECK(refused.err.find("--projection: expected views of a drawing") != std::string::npos);
    }
    CHECK(run({"look", "sphere:100", "--size", "64", "--json", "-", "--projection", "third"}).code == 0);
}

TEST_CASE("look: a folder gets a picture of each view, which the report names", "[cli][look]") {
    const TemporaryFolder folder;
    write_obj(folder.file("box.obj"), box_mesh({0, 0, 0}, {3, 2, 1}));
    const std::string out = folder.file("views");
    // A name that ends in "/" makes the folder; one that is there is filled.
    for (const std::string& name : {out + "/", out}) {
        const Outcome outcome = run({"look", folder.file("box.obj"), "-o", name, "--json", folder.file("a.json"), "--certify", "4",
                                     "--size", "160x120", "--view", "front,30,20"});
        INFO(outcome.err);
        CHECK(outcome.code == 0);
        const Json report = Json::parse(contents(folder.file("a.json")), nullptr, false);
        REQUIRE(report.is_object());
        REQUIRE(report["views"].size() > 2);  // the box has six sides
        CHECK(report["views"][0]["file"] == out + "/01_front.png");
        CHECK(report["views"][1]["file"] == out + "/02_30,20.png");
        for (const Json& view : report["views"]) {
            const Picture picture = read_picture(contents(view["file"].get<std::string>()));
            CHECK(picture.width == 160);
            CHECK(picture.height == 120);
        }
        std::size_t files = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(out)) ++files;
        CHECK(files == report["views"].size());
    }
    // A sheet is one file, which no view has of its own.
    CHECK(run({"look", folder.file("box.obj"), "-o", folder.file("a.png"), "--json", folder.file("b.json"), "--size", "160x120"}).code ==
          0);
    CHECK(!Json::parse(contents(folder.file("b.json")), nullptr, false)["views"][0].contains("file"));
    CHECK(run({"look", folder.file("box.obj"), "-o", folder.file("box.obj") + "/"}).code == 4);
}
