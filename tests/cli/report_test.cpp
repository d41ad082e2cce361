#include "halflit/target.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/small_models.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

using namespace halflit::test;

namespace {

nlohmann::json json_of(const std::string& text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    REQUIRE(!json.is_discarded());
    return json;
}

std::string hash_text(const Picture& picture) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(halflit::pixel_hash(picture.rgba8)));
    return text;
}

}  // namespace

TEST_CASE("report: it counts what was drawn and names the pixels by their hash", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome =
        run({"render", "sphere:500", "--size", "64x48", "-o", "-", "--report", folder.file("r.json"), "--isa", "scalar", "--threads", "1"});
    REQUIRE(outcome.code == 0);
    const auto report = json_of(contents(folder.file("r.json")));
    CHECK(report["status"] == "ok");
    CHECK(report["size"] == nlohmann::json{64, 48});
    CHECK(report["isa"] == "scalar");
    CHECK(report["threads"] == 1);
    CHECK(report["pixel_hash"] == hash_text(read_picture(outcome.out)));
    CHECK(report["triangles_submitted"].get<int>() > 450);
    CHECK(report["triangles_drawn"].get<int>() <= report["triangles_submitted"].get<int>());
    // The sphere touches the upper and lower edge, so it is a disc with a radius of half the height.
    CHECK(report["pixels_visible"].get<double>() == Approx(3.14159 * 24 * 24).epsilon(0.06));
    CHECK(report["warnings"].empty());
    CHECK(report["peak_memory_bytes"].get<double>() > 1e6);
    for (const char* time : {"load_ms", "render_ms", "encode_ms"}) CHECK(report[time].get<double>() >= 0.0);
    for (const char* stage : {"plan", "transform", "bin", "tiles"}) CHECK(report["stages"][stage].get<double>() >= 0.0);
}

TEST_CASE("report: a warning names what a view of the whole leaves out", "[cli]") {
    const TemporaryFolder folder;
    std::vector<Corners> triangles = sphere_with_spike(1.0);
    for (const Corners& triangle : box({2000, 0, 0}, {2000.1, 0.1, 0.1})) triangles.push_back(triangle);
    const std::string model = folder.file("far.stl");
    folder.write("far.stl", stl_of(triangles));
    const auto warnings = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> words = {"render", model, "--size", "20x20", "-o", folder.file("a.png"), "--report", "-"};
        words.insert(words.end(), flags.begin(), flags.end());
        return json_of(run(words).out)["warnings"];
    };
    for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--view", "top"}, {"--azimuth", "70"}}) {
        const auto told = warnings(flags);
        REQUIRE(told.size() == 1);
        CHECK(told[0].get<std::string>().find("far from all else") != std::string::npos);
    }
    CHECK(warnings({"--camera-position", "0,0,9", "--camera-target", "0,0,0"}).empty());
}

TEST_CASE("report: - is standard output, the picture goes to its file", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "sphere:500", "--size", "20x20", "-o", folder.file("a.png"), "--report", "-"});
    CHECK(outcome.code == 0);
    CHECK(json_of(outcome.out)["pixel_hash"] == hash_text(read_picture(contents(folder.file("a.png")))));
}

TEST_CASE("report: the documented example has the program's hash", "[cli]") {
    const TemporaryFolder folder;
    const std::string text = contents(HALFLIT_SOURCE_DIR "/docs/report.md"), key = "\"pixel_hash\": \"";
    REQUIRE(text.find("$ halflit render demo --size 640x360 -o demo.png --report -") != std::string::npos);
    const auto start = text.find(key);
    REQUIRE(start != std::string::npos);
    const Outcome outcome = run({"render", "demo", "--size", "640x360", "-o", folder.file("demo.png"), "--report", "-"});
    CHECK(json_of(outcome.out)["pixel_hash"] == text.substr(start + key.size(), 16));
}

TEST_CASE("report: a failed run has a report too", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::vector<std::string>, int>> cases = {
        {{"render", "missing.glb"}, 4},
        {{"render", "--size", "99999x99999"}, 5},
        {{"render", "--camera", "7"}, 2},
        {{"render", "-o", folder.file("no/where.png"), "--size", "8x8"}, 4}};
    for (auto [arguments, code] : cases) {
        arguments.insert(arguments.end(), {"--report", folder.file("r.json")});
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        INFO(outcome.err);
        CHECK(outcome.code == code);
        const auto report = json_of(contents(folder.file("r.json")));
        CHECK(report["status"] == "error");
        CHECK(report["error"]["code"] == code);
        CHECK("halflit: error: " + report["error"]["message"].get<std::string>() + "\n" == outcome.err);
        CHECK(folder.names() == std::vector<std::string>{"r.json"});
    }
}

TEST_CASE("report: a report that cannot be written ends the run with 4", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run({"render", "sphere:500", "--size", "20x20", "-o", "-", "--report", folder.file("no/r.json")}).code == 4);
}

TEST_CASE("bench: the least time is not above the median, and the pixels are those of render", "[cli]") {
    const Outcome bench = run({"bench", "sphere:500", "--frames", "4", "--json", "--size", "60x40", "--encode"});
    REQUIRE(bench.code == 0);
    const auto report = json_of(bench.out);
    CHECK(report["frames"] == 4);
    CHECK(report["min_ms"].get<double>() > 0.0);
    CHECK(report["min_ms"].get<double>() <= report["median_ms"].get<double>());
    double stages_ms = 0;
    for (const auto& ms : report["stages"]) stages_ms += ms.get<double>();
    CHECK(stages_ms > 0.0);
    CHECK(stages_ms <= report["min_ms"].get<double>());  // they are those of the fastest frame
    CHECK(report["load_ms"].get<double>() >= 0.0);
    CHECK(report["encode_ms"].get<double>() > 0.0);
    CHECK(report["pixel_hash"] == hash_text(read_picture(run({"render", "sphere:500", "--size", "60x40", "-o", "-"}).out)));
}

TEST_CASE("bench: the rates are those of the median frame", "[cli]") {
    const std::string text = run({"bench", "sphere:500", "--frames", "3", "--size", "1000x1000"}).out;
    const std::size_t at = text.find("  median");
    REQUIRE(at != std::string::npos);
    double ms = 0, frames = 0, pixels = 0, triangles = 0;
    REQUIRE(std::sscanf(text.c_str() + at, "  median %lf ms: %lf frames, %lf million pixels, %lf million triangles a second", &ms, &frames,
                        &pixels, &triangles) == 4);
    CHECK(std::abs(frames - 1e3 / ms) <= 0.05 + 1e-3 * frames);        // printed with one digit behind the point
    CHECK(std::abs(pixels - 1e3 / ms) <= 0.05 + 1e-3 * pixels);        // a million pixels a frame
    CHECK(std::abs(triangles - 0.5 / ms) <= 0.05 + 0.05 * triangles);  // about 500 a frame
}

TEST_CASE("bench: nothing is encoded unless asked for", "[cli]") {
    CHECK_FALSE(json_of(run({"bench", "sphere:500", "--frames", "1", "--json", "--size", "60x40"}).out).contains("encode_ms"));
    CHECK(run({"bench", "sphere:500", "--frames", "1", "--size", "60x40"}).out.find("PNG") == std::string::npos);
    CHECK(run({"bench", "sphere:500", "--frames", "1", "--size", "60x40", "--encode"}).out.find("ms (PNG)") != std::string::npos);
}

TEST_CASE("info: its lights are those that are drawn, of the scene, of flags and of the studio", "[cli]") {
    const auto described = [](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"info", "sphere:500", "--json"});
        const Outcome outcome = run(flags);
        REQUIRE(outcome.code == 0);
        return json_of(outcome.out);
    };
    const auto own = described({});
    const std::size_t count = own["lights"].size();
    REQUIRE(count > 0);
    CHECK(described({"--light", "point:pos=0,5,0"})["lights"].size() == count + 1);
    CHECK(described({"--no-scene-lights"})["lights"].size() == 1);  // the studio's key light
    const auto around = described({"--no-scene-lights", "--ambient", "0.5,0.5,0.5"});
    CHECK(around["lights"].empty());
    CHECK(around["ambient"]["sky"][0] == 0.5);
}

TEST_CASE("info: it counts the built-in sphere and plans its one material", "[cli]") {
    const auto info = json_of(run({"info", "sphere:1000000", "--json"}).out);
    CHECK(info["drawn"]["triangles_drawn"] == 1000000);
    CHECK(info["drawn"]["lights"] == 2);
    CHECK(info["bounds"]["max"][1] == 1.0);
    CHECK(info["bounds"]["max"][0].get<double>() == Approx(1.0).epsilon(1e-5));  // no ring of vertices lies on the equator
    REQUIRE(info["materials"].size() == 1);
    const auto& material = info["materials"][0];
    CHECK(material["lobe"]["computed_as"] == "t*sqrt(t)");  // sloan 0.5: n = 1.5
    CHECK(material["requires"].dump().find("lights") != std::string::npos);
    CHECK(material["does_without"].dump().find("normal map") != std::string::npos);
    for (const auto& stage : material["requires"]) {
        const auto& others = material["does_without"];
        CHECK(std::find(others.begin(), others.end(), stage) == others.end());
    }
    const auto flat = json_of(run({"info", "sphere:1000", "--json", "--specular", "none"}).out);
    CHECK(flat["materials"][0]["does_without"].dump().find("specular") != std::string::npos);
}

TEST_CASE("report: it names the tone curve, and by how much the curve may enlarge errors", "[cli]") {
    const auto info = [](const std::vector<std::string>& flags) {
        std::vector<std::string> all = {"info", "sphere:500", "--json", "--max-error", "2"};
        all.insert(all.end(), flags.begin(), flags.end());
        return json_of(run(all).out);
    };
    const auto none = info({"--tonemap", "none"}), neutral = info({"--tonemap", "neutral"});
    CHECK(none["tone_curve"] == "none");
    for (const char* const kind : {"absolute", "relative", "other"}) CHECK(none["error_bound"]["tone_growth"][kind] == 1.0);
    CHECK(neutral["tone_curve"] == "neutral");
    for (const char* const kind : {"absolute", "relative", "other"}) CHECK(neutral["error_bound"]["tone_growth"][kind].get<double>() > 1.0);
    CHECK(neutral["error_bound"]["budget_codes"] == 2.0);
    CHECK(neutral["error_bound"]["bound_codes"].get<double>() <= 2.0);
    const TemporaryFolder folder;
    const std::string file = folder.file("r.json");
    REQUIRE(run({"render", "sphere:500", "--size", "8x8", "--tonemap", "aces", "-o", folder.file("a.png"), "--report", file}).code == 0);
    CHECK(json_of(contents(file))["tone_curve"] == "aces");
}

TEST_CASE("report: the orders and bounds of an environment are those of info", "[cli][env]") {
    const auto environment_of = [](const std::vector<std::string>& flags) {
        std::vector<std::string> arguments{"render", "sphere:500", "--size", "16x16", "-o", "", "--env", "sky"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const TemporaryFolder folder;
        arguments[5] = folder.file("a.png");
        arguments.insert(arguments.end(), {"--report", folder.file("r.json")});
        REQUIRE(run(arguments).code == 0);
        return json_of(contents(folder.file("r.json")))["environment"];
    };
    const auto with_sun = environment_of({"--lobe", "valve", "--specular", "none"});
    REQUIRE(with_sun.size() == 1);
    CHECK(with_sun[0]["bound_linear"].get<double>() > 0.0);  // a directional light has no size

    const auto valve = environment_of({"--lobe", "valve", "--specular", "none", "--env-sun", "off"});
    REQUIRE(valve.size() == 1);
    CHECK(valve[0]["light"] == "diffuse");
    CHECK(valve[0]["order"] == 3);  // its bands 3 and up are zero
    CHECK(valve[0]["bound_linear"] == 0.0);
    CHECK(valve[0]["within"] == true);

    const auto one_band = environment_of({"--lobe", "lambert", "--specular", "none", "--sh-order", "1", "--exposure", "1"});
    REQUIRE(one_band.size() == 1);
    CHECK(one_band[0]["order"] == 1);
    CHECK(one_band[0]["within"] == false);
    CHECK(one_band[0]["bound_of_white"].get<double>() == Approx(2.0 * one_band[0]["bound_linear"].get<double>()));  // exposure 2^1
    CHECK(one_band[0]["tolerance_of_white"].get<double>() == Approx(1.0 / 510.0));

    const auto both = environment_of({});
    const auto info = json_of(run({"info", "sphere:500", "--env", "sky", "--json"}).out)["materials"][0];
    REQUIRE(both.size() == 1);
    CHECK(info["environment"]["order"] == both[0]["order"]);
    CHECK(info["environment"]["bound_linear"] == both[0]["bound_linear"]);
    CHECK(info["reflection_lobes"] == 1);
    CHECK(info["requires"].dump().find("environment") != std::string::npos);
    CHECK(json_of(run({"info", "sphere:500", "--json"}).out)["materials"][0].count("environment") == 0);
}

TEST_CASE("report: lanes say which stages ran for how many fragments, and info which do not run at all", "[cli][work]") {
    const auto report_of = [](std::vector<std::string> flags) {
        const TemporaryFolder folder;
        std::vector<std::string> arguments{"render", "sphere:500", "--size", "64x48", "-o", folder.file("a.png"), "--report", "-"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        REQUIRE(outcome.code == 0);
        return json_of(outcome.out);
    };
    const std::vector<std::string> flags{"--no-scene-lights", "--light",    "directional:dir=0,-1,-1", "--light", "point:pos=2,2,2",
                                         "--shadows",         "soft-split", "--shadow-size",           "64"};
    const auto report = report_of(flags);
    const std::uint64_t fragments = report["fragments_shaded"];
    CHECK(fragments > 1000);
    const auto& lanes = report["lanes"];
    CHECK(lanes["stages"]["lights"] == fragments);
    CHECK(lanes["stages"]["specular"] == fragments);
    CHECK(lanes["lights"]["directional"] == fragments);
    CHECK(lanes["lights"]["point"] == fragments);
    CHECK(lanes["lights"]["spot"] == 0);
    CHECK(lanes["shadow_look_ups"] == 2 * fragments);
    CHECK(lanes["alpha_test"] == 0);

    // Stages that the plan does without have no lanes; all others have all.
    std::vector<std::string> arguments{"info", "sphere:500", "--json", "--size", "64x48"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const auto info = json_of(run(arguments).out);
    REQUIRE(info["materials"].size() == 1);
    const auto& required = info["materials"][0]["requires"];
    const auto& others = info["materials"][0]["does_without"];
    CHECK(required.size() + others.size() == lanes["stages"].size());
    for (const auto& stage : required) CHECK(lanes["stages"][stage.get<std::string>()] == fragments);
    for (const auto& stage : others) CHECK(lanes["stages"][stage.get<std::string>()] == 0);
    CHECK(info["lights_computed"] == nlohmann::json{{"directional", 1}, {"point", 1}, {"spot", 0}});
    CHECK(info["shadows"]["mode"] == "soft-split");
    CHECK(info["shadows"]["maps"].size() == 2);

    CHECK(report_of({"--shadows", "off"})["lanes"]["shadow_look_ups"] == 0);
    CHECK(report_of({"--specular", "none"})["lanes"]["stages"]["specular"] == 0);
    const auto gouraud = report_of({"--shading", "gouraud"});
    CHECK(gouraud["lanes"]["stages"]["light at vertices or triangles"] == gouraud["fragments_shaded"]);
    CHECK(gouraud["lanes"]["stages"]["lights"].get<int>() > 0);
    CHECK(gouraud["lanes"]["stages"]["lights"].get<int>() <= 500);  // a sphere of 500 triangles has about 250 vertices
}

TEST_CASE("render: a lobe out of range is refused with the reason, a power below 1 gives a warning", "[cli][lobe]") {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
        {{"--wrap", "-0.5"}, "from 0 to 1"},
        {{"--wrap", "nan"}, "from 0 to 1"},
        {{"--power", "-2"}, "from 0 to 10000"},
        {{"--lobe", "mcauley", "--power", "nan"}, "from 0 to 10000"},
        {{"--lobe", "green", "--wrap", "1.25"}, "from 0 to 1"}};
    for (const auto& [flags, reason] : refused) {
        std::vector<std::string> arguments{"render", "sphere:500", "--size", "8x8", "-o", folder.file("a.png")};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        INFO(outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(flags[flags.size() - 2]) != std::string::npos);
        CHECK(outcome.err.find(reason) != std::string::npos);
    }
    const Outcome warned = run({"render", "sphere:500", "--size", "8x8", "-o", folder.file("a.png"), "--power", "0.5"});
    CHECK(warned.code == 0);
    CHECK(warned.err.find("warning: power 0.5: below 1 the curve has an infinite slope at its boundary") != std::string::npos);
}

TEST_CASE("report: what a name's characters do to a terminal is escaped in JSON, and the name stays the same", "[cli][report]") {
    const TemporaryFolder folder;
    const std::string model = folder.file("named.gltf");
    const std::string name =
        "a\xE2\x80\xAE"
        "b\xC2\x9B"
        "c\xF3\xA0\x81\x81"
        "d\x7F\xC3\xA9";  // U+202E, U+009B, U+E0041, DEL, e acute
    std::ofstream(model, std::ios::binary)
        << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],"cameras":[{"name":")" << name
        << R"(","type":"perspective","perspective":{"yfov":1,"znear":0.1}}]})";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", model, "--json"}, {model, "--size", "16", "-o", folder.file("a.png"), "--report", "-"}}) {
        const Outcome outcome = run(arguments);
        INFO(outcome.out << outcome.err);
        CHECK(outcome.code == 0);
        for (const char* raw : {"\xE2\x80\xAE", "\xC2\x9B", "\xF3\xA0", "\x7F"}) CHECK(outcome.out.find(raw) == std::string::npos);
        if (arguments[0] == "info") CHECK(nlohmann::json::parse(outcome.out)["cameras"][0] == name);
    }
}
