#include "tests/cli/program.hpp"
#include "tests/cli/small_models.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

/// Two models in files, and their comparison.
struct Pair {
    TemporaryFolder folder;
    std::string a = folder.file("a.stl"), b = folder.file("b.stl");

    Pair(const std::vector<Corners>& first, const std::vector<Corners>& second) {
        write_contents(a, stl_of(first));
        write_contents(b, stl_of(second));
    }
    [[nodiscard]] Json compare(int code, std::vector<std::string> flags = {}) const {
        std::vector<std::string> words{"compare", a, b, "--size", "160x120", "--json", "-"};
        words.insert(words.end(), flags.begin(), flags.end());
        const Outcome outcome = run(words);
        INFO(outcome.err);
        CHECK(outcome.code == code);
        Json json = Json::parse(outcome.out, nullptr, false);
        REQUIRE(!json.is_discarded());
        CHECK(json["differs"] == (code == 1));
        return json;
    }
};

/// Sum over the views of pixels with this change.
std::uint64_t pixels(const Json& json, const char* change) {
    std::uint64_t sum = 0;
    for (const Json& view : json["views"]) sum += view["pixels"][change].get<std::uint64_t>();
    return sum;
}

std::uint64_t changed(const Json& json) {
    std::uint64_t sum = 0;
    for (const Json& view : json["views"]) sum += view["changed"].get<std::uint64_t>();
    return sum;
}

void check_distance(const Json& json, double expected) {
    const double low = json["distance"]["at_least"], high = json["distance"]["at_most"];
    INFO(json["distance"].dump());
    CHECK(low <= expected * (1 + 1e-5));
    CHECK(high >= expected * (1 - 1e-5));
    CHECK(high - low <= 1.01e-4 * 4);  // the promised accuracy: 1e-4 of the diagonal
}

std::vector<Corners> shifted(std::vector<Corners> triangles, const Corner& by) {
    for (Corners& triangle : triangles)
        for (Corner& p : triangle)
            for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
    return triangles;
}

std::vector<Corners> joined(std::vector<Corners> a, const std::vector<Corners>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace

TEST_CASE("compare: a file and itself differ in nothing", "[cli][compare]") {
    const Pair pair(sphere_with_spike(1.5), sphere_with_spike(1.5));
    const Json json = pair.compare(0);
    CHECK(changed(json) == 0);
    CHECK(json["distance"]["at_least"] == 0);
    CHECK(json["distance"]["at_most"] == 0);
    CHECK(json["parts"].empty());
    for (const Json& view : json["views"]) CHECK(view["iou"] == 1);
}

TEST_CASE("compare: a spike is marked where it is, and is as far away as it was pulled", "[cli][compare]") {
    const Pair pair(sphere_with_spike(1), sphere_with_spike(1.6));
    const Json json = pair.compare(1, {"--shadows", "off"});
    check_distance(json, 0.6);
    CHECK(json["distance"]["from_b"]["point"][0].get<double>() == Approx(1.6));
    CHECK(pixels(json, "removed") == 0);
    CHECK(pixels(json, "added") > 0);
    for (const Json& view : json["views"]) {
        INFO(view.dump());
        CHECK(view["changed_share"].get<double>() < 0.03);
        if (view["name"] != "front") continue;
        // Seen from the front, the spike points to the right. Its base reaches to the neighbours of its vertex: cos(7.5 deg) = 0.991.
        const double left = view["box"][0].get<double>() - 1, right = left + 2 + view["box"][2].get<double>();
        const double middle = 80 - 0.3 / view["pixel"].get<double>();  // of the sphere: the picture's middle is that of both boxes
        CHECK(left > middle + 0.9 / view["pixel"].get<double>());
        CHECK(right < middle + 1.6 / view["pixel"].get<double>() + 4);  // lines of edges are two pixels wide
    }
}

TEST_CASE("compare: the distance is that of brute force over dense points", "[cli][compare]") {
    // Boxes inside each other: the farthest point is a corner, by the closed form.
    const Pair pair(box({0, 0, 0}, {1, 1, 1}), box({0.1, 0.2, 0.15}, {0.9, 0.7, 0.8}));
    const Json json = pair.compare(1);
    // From A's corner (1, 1, 1) to B's (0.9, 0.7, 0.8): sqrt(0.01 + 0.09 + 0.04); every other corner is nearer.
    check_distance(json, std::sqrt(0.14));
    // From B, the farthest point of its surface from A's lies inside of the side z = 0.8 or y = 0.7, where the distance to the nearest
    // sides of A is largest.
    double farthest = 0;
    constexpr int kSteps = 200;
    for (int side = 0; side < 6; ++side)
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j) {
                const std::array<double, 3> low{0.1, 0.2, 0.15}, high{0.9, 0.7, 0.8};
                std::array<double, 3> p{};
                const auto axis = static_cast<std::size_t>(side / 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
                p[axis] = side % 2 == 0 ? low[axis] : high[axis];
                p[u] = low[u] + (high[u] - low[u]) * i / kSteps, p[v] = low[v] + (high[v] - low[v]) * j / kSteps;
                double nearest = 1;  // inside of A the distance to its surface is that to the nearest side
                for (const double x : p) nearest = std::min({nearest, x, 1 - x});
                farthest = std::max(farthest, nearest);
            }
    CHECK(json["distance"]["from_b"]["at_least"].get<double>() <= farthest + 0.005);
    CHECK(json["distance"]["from_b"]["at_most"].get<double>() >= farthest - 1e-6);
}

TEST_CASE("compare: a hole is told by pixels, edges and the surface's distance", "[cli][compare]") {
    std::vector<Corners> open = box({0, 0, 0}, {2, 1, 1});
    open.erase(open.begin() + 4, open.begin() + 6);  // the side -y, to the front of a model with z up
    const Pair pair(box({0, 0, 0}, {2, 1, 1}), open);
    const Json json = pair.compare(1);
    CHECK(json["models"]["a"]["watertight"] == true);
    CHECK(json["models"]["b"]["watertight"] == false);
    CHECK(json["models"]["b"]["open_edges"] == 4);
    CHECK(json["models"]["b"]["volume"].is_null());
    check_distance(json, 0.5);  // the middle of the side that lacks, from its border
    CHECK(json["parts"][0]["change"] == "geometry");
    CHECK(changed(json) > 0);
}

TEST_CASE("compare: a change that the usual sides hide is shown from another side", "[cli][compare]") {
    const std::vector<Corners> whole = box({0, 0, 0}, {2, 1, 1});
    struct Dent {
        std::size_t axis;  // of the side at 0 that is pressed in
        Corner ring[4], deepest;
        const char* from;
    };
    for (const Dent& dent : {Dent{0, {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}, {0.3, 0.5, 0.5}, "left"},
                             Dent{2, {{0, 0, 0}, {0, 1, 0}, {2, 1, 0}, {2, 0, 0}}, {1, 0.5, 0.3}, "bottom"}}) {
        std::vector<Corners> dented;
        for (const Corners& triangle : whole)
            if (std::any_of(triangle.begin(), triangle.end(), [&](const Corner& p) { return p[dent.axis] > 0; }))
                dented.push_back(triangle);
        for (std::size_t i = 0; i < 4; ++i) dented.push_back({dent.ring[i], dent.ring[(i + 1) % 4], dent.deepest});
        const Pair pair(whole, dented);
        INFO(dent.from);
        CHECK(changed(pair.compare(1, {"--view", "front,right,top,iso"})) == 0);
        const Json json = pair.compare(1);
        REQUIRE(json["views"].size() == 5);
        CHECK(json["views"][4]["name"] == dent.from);
        CHECK(json["views"][4]["changed"].get<std::uint64_t>() > 100);
    }
}

TEST_CASE("compare: a part that moved by a thousandth is found, and its shift is measured", "[cli][compare]") {
    const auto still = box({0, 0, 0}, {100, 60, 40}), small = box({20, 20, 40}, {40, 40, 50});
    const Pair pair(joined(still, small), joined(still, shifted(small, {0.1, 0, 0})));
    const Json json = pair.compare(1);
    const double low = json["distance"]["at_least"], high = json["distance"]["at_most"];
    CHECK(low == Approx(0.1).epsilon(1e-4));
    CHECK(high < 0.1 + 1.01e-4 * 130);
    CHECK(json["models"]["a"]["volume"].get<double>() == Approx(100.0 * 60 * 40 + 20 * 20 * 10));
    // Less than a pixel: 100 mm over 160 pixels. The report says that outlines may shift so far without a mark.
    CHECK(json["unseen"]["pixel"].get<double>() > 0.1);
    CHECK(json["unseen"]["text"].get<std::string>().find("A triangle counts as seen if ") == 0);
}

TEST_CASE("compare: a flipped face changes edges but not the distance", "[cli][compare]") {
    std::vector<Corners> flipped = box({0, 0, 0}, {2, 1, 1});
    std::swap(flipped[4][1], flipped[4][2]);
    const Pair pair(box({0, 0, 0}, {2, 1, 1}), flipped);
    const Json json = pair.compare(1);
    CHECK(json["distance"]["at_most"] == 0);
    CHECK(json["models"]["a"]["flipped_edges"] == 0);
    CHECK(json["models"]["b"]["flipped_edges"] == 3);
    CHECK(changed(json) == 0);  // surfaces of STL are drawn from both sides
}

TEST_CASE("compare: one surface in two formats, with other axes and vertices that are split, does not differ", "[cli][compare]") {
    const auto triangles = sphere_with_spike(1.4);
    const TemporaryFolder folder;
    write_contents(folder.file("a.stl"), stl_of(triangles));
    // STL has z up, OFF y: the same model is turned.
    std::vector<Corners> turned = triangles;
    for (Corners& triangle : turned)
        for (Corner& p : triangle) p = {p[0], p[2], -p[1]};
    std::reverse(turned.begin(), turned.end());
    write_contents(folder.file("b.off"), off_of(turned));
    const Outcome outcome =
        run({"compare", folder.file("a.stl"), folder.file("b.off"), "--size", "160x120", "--crease", "0", "--json", "-"});
    INFO(outcome.err);
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    const Json json = Json::parse(outcome.out, nullptr, false);
    REQUIRE(!json.is_discarded());
    CHECK(json["distance"]["at_most"] == 0);
    CHECK(changed(json) == 0);
}

TEST_CASE("compare: a colour alone is a change of pixels, and of nothing else", "[cli][compare]") {
    const TemporaryFolder folder;
    const auto quad = [](const char* red) {
        const std::string color = std::string(" ") + red + " 128 128\n";
        return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
               "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0" +
               color + "1 0 0" + color + "1 1 0" + color + "0 1 0" + color + "4 0 1 2 3\n";
    };
    write_contents(folder.file("a.ply"), quad("128"));
    write_contents(folder.file("b.ply"), quad("200"));
    const Outcome outcome = run({"compare", folder.file("a.ply"), folder.file("b.ply"), "--size", "64x48", "--json", "-"});
    CHECK(outcome.code == 1);
    const Json json = Json::parse(outcome.out, nullptr, false);
    REQUIRE(!json.is_discarded());
    CHECK(pixels(json, "recolored") == changed(json));
    CHECK(changed(json) > 0);
    CHECK(json["distance"]["at_most"] == 0);
    CHECK(run({"compare", folder.file("a.ply"), folder.file("b.ply"), "--size", "64x48", "--max", "255"}).code == 0);
}

TEST_CASE("compare: the comment for a pull request refers to the sheet beside it, and the page holds its pictures", "[cli][compare]") {
    const Pair pair(sphere_with_spike(1), sphere_with_spike(1.6));
    const TemporaryFolder& folder = pair.folder;
    const Outcome outcome = run({"compare", pair.a, pair.b, "--size", "160x120", "-o", folder.file("out"), "--markdown",
                                 folder.file("comment.md"), "--json", folder.file("out.json")});
    INFO(outcome.err);
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("Differs: ") == 0);
    const std::string comment = contents(folder.file("comment.md"));
    CHECK(comment.find("**Differs: ") == 0);
    CHECK(comment.find("](out/compare.png)\n") != std::string::npos);
    CHECK(comment.find("| front | ") != std::string::npos);
    const Picture sheet = read_picture(contents(folder.file("out/compare.png")));
    CHECK(sheet.width >= 3 * 160);
    CHECK(sheet.height >= 4 * 120);
    const std::string page = contents(folder.file("out/index.html"));
    CHECK(page.find("http") == std::string::npos);
    CHECK(page.find("href") == std::string::npos);
    std::size_t pictures = 0;
    for (std::size_t at = page.find("<img "); at != std::string::npos; at = page.find("<img ", at + 1)) {
        ++pictures;
        CHECK(page.find("src=\"data:image/png;base64,", at) < page.find('>', at));
    }
    CHECK(pictures == 12);
    CHECK(!Json::parse(contents(folder.file("out.json")), nullptr, false).is_discarded());
}

TEST_CASE("compare: pictures have the lines of edges, unless flags say otherwise", "[cli][compare]") {
    const Pair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
    const auto sheet = [&](const char* edges) {
        const std::string folder = pair.folder.file(std::string("sheet") + edges);
        std::vector<std::string> words{"compare", pair.a, pair.b, "--size", "96x72", "--view", "iso", "-o", folder};
        if (*edges != 0) words.insert(words.end(), {"--edges", edges});
        CHECK(run(words).code == 0);
        return read_picture(contents(folder + "/compare.png")).rgba8;
    };
    const auto usual = sheet("");
    CHECK(usual == sheet("feature"));
    CHECK(usual != sheet("none"));
}

TEST_CASE("compare: models are not overwritten, and wrong flags fail", "[cli][compare]") {
    const Pair pair(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
    CHECK(run({"compare", pair.a, pair.b, "--json", pair.a}).code == 4);
    CHECK(run({"compare", pair.a}).code == 2);
    CHECK(run({"compare", pair.a, pair.b, "--json", "-", "--markdown", "-"}).code == 2);
    CHECK(run({"compare", pair.a, pair.folder.file("lost.stl")}).code == 4);
}
