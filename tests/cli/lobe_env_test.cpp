#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit::test;
using nlohmann::json;

namespace {

json lobe(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "lobe");
    arguments.push_back("--json");
    const Outcome outcome = run(arguments);
    REQUIRE(outcome.code == 0);
    return json::parse(outcome.out);
}

}  // namespace

TEST_CASE("lobe: bands, boundary, norm and samples are the closed forms', wrap read in double", "[cli][lobe]") {
    const double a = 0.3;
    const json sloan = lobe({"sloan", "--wrap", "0.3"});
    CHECK(sloan["wrap"] == a);
    CHECK(sloan["power"] == 1 + a);
    CHECK(sloan["scale"] == 1.0);
    CHECK(sloan["boundary_cos"] == -a);
    CHECK(sloan["boundary_deg"].get<double>() == Approx(std::acos(-a) * 180 / std::acos(-1.0)).epsilon(1e-14));
    CHECK(sloan["normalization"].get<double>() == Approx((2 + a) / (2 * (1 + a))).epsilon(1e-15));
    CHECK(sloan["slope_at_boundary"] == 0.0);
    REQUIRE(sloan["bands"].size() == 10);
    CHECK(sloan["bands"][0].get<double>() == Approx(2 * (a + 1) / (a + 2)).epsilon(1e-14));
    CHECK(sloan["bands"][1].get<double>() == Approx(4 * (a + 1) / ((a + 2) * (a + 3))).epsilon(1e-14));
    const double band5 = -2 * (a - 1) * a * (a + 1) * (329 * a * a * a - 401 * a * a - 151 * a + 219) /
                         ((a + 2) * (a + 3) * (a + 4) * (a + 5) * (a + 6) * (a + 7));
    CHECK(sloan["bands"][5].get<double>() == Approx(band5).epsilon(1e-12));
    REQUIRE(sloan["samples"].size() == 201);
    for (int i = 0; i <= 200; ++i) {
        const double x = (i - 100) / 100.0;
        CHECK(sloan["samples"][static_cast<std::size_t>(i)]["cos"] == x);
        CHECK(sloan["samples"][static_cast<std::size_t>(i)]["f"].get<double>() ==
              Approx(x > -a ? std::pow((x + a) / (1 + a), 1 + a) : 0.0).margin(1e-15));
    }
}

TEST_CASE("lobe: names stand for their (w, n), --normalize scales curve and bands alike", "[cli][lobe]") {
    CHECK(lobe({"valve"})["power"] == 2.0);
    CHECK(lobe({"half-lambert"})["wrap"] == 1.0);
    CHECK(lobe({"green", "--wrap", "0.5"})["slope_at_boundary"].get<double>() == Approx(1 / 1.5));
    CHECK(lobe({"green", "--power", "0.5"})["slope_at_boundary"].is_null());
    CHECK(lobe({"mcauley", "--wrap", "0.2", "--power", "3"})["scale"].get<double>() == Approx(4 / 2.4));
    const json normalized = lobe({"sloan", "--normalize"});
    CHECK(normalized["bands"][0].get<double>() == Approx(1.0).epsilon(1e-15));
    CHECK(normalized["samples"][200]["f"].get<double>() == Approx(2.5 / 3).epsilon(1e-15));
    const json lambert = lobe({"lambert"});
    REQUIRE(lambert["orders"].size() == 10);
    CHECK(lambert["orders"][2]["order"] == 3);
    CHECK(lambert["orders"][2]["l2"].get<double>() == Approx(0.12791584).epsilon(1e-7));
    CHECK(lambert["orders"][2]["sup"].get<double>() == Approx(0.09375).epsilon(1e-9));
    CHECK(lambert["orders"][2]["min"].get<double>() == Approx(-19.0 / 480).epsilon(1e-9));
}

TEST_CASE("lobe: values out of range are refused with the reason, powers below 1 give a warning", "[cli][lobe]") {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{{"lobe", "sloan", "--wrap", "nan"},
                                                                                           {"lobe", "sloan", "--wrap", "1.01"},
                                                                                           {"lobe", "sloan", "--wrap", "-0.1"},
                                                                                           {"lobe", "sloan", "--power", "-1"},
                                                                                           {"lobe", "sloan", "--power", "inf"},
                                                                                           {"lobe", "sloan", "--wrap", "0,5"},
                                                                                           {"lobe", "phong"},
                                                                                           {"lobe"}}) {
        const Outcome outcome = run(arguments);
        INFO(arguments.back());
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
    }
    CHECK(run({"lobe", "sloan", "--wrap", "nan"}).err.find("not a number") != std::string::npos);
    const Outcome steep = run({"lobe", "green", "--power", "0.5"});
    CHECK(steep.code == 0);
    CHECK(steep.err.find("warning: power 0.5") != std::string::npos);
    CHECK(run({"lobe", "lambert"}).out.find("90.0000 degrees") != std::string::npos);
}

TEST_CASE("env: the built-in sky's coefficients, norms and suns agree with each other", "[cli][env]") {
    const Outcome outcome = run({"env", "sky", "--json"});
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.empty());
    const json sky = json::parse(outcome.out);
    CHECK(sky["width"] == 512);
    CHECK(sky["height"] == 256);
    REQUIRE(sky["coefficients"].size() == 100);
    REQUIRE(sky["band_norms"].size() == 10);
    REQUIRE(sky["bound_by_order"].size() == 10);
    const double pi = std::acos(-1.0);
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(sky["coefficients"][0][k].get<double>() == Approx(sky["mean_radiance"][k].get<double>() * std::sqrt(4 * pi)).epsilon(1e-12));
        for (std::size_t l = 0; l < 10; ++l) {
            double square = 0;
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) square += std::pow(sky["coefficients"][i][k].get<double>(), 2);
            CHECK(sky["band_norms"][l][k].get<double>() == Approx(std::sqrt(square)).epsilon(1e-12));
        }
        REQUIRE(sky["suns"].size() == 1);
        const double rest = sky["without_suns"]["mean_radiance"][k].get<double>() * 4 * pi;
        CHECK(rest + sky["suns"][0]["irradiance"][k].get<double>() == Approx(sky["mean_radiance"][k].get<double>() * 4 * pi).epsilon(1e-5));
    }
    for (std::size_t i = 1; i < 10; ++i) CHECK(sky["bound_by_order"][i].get<double>() <= sky["bound_by_order"][i - 1].get<double>());
    CHECK(sky["without_suns"]["bound_by_order"][4].get<double>() < 0.1 * sky["bound_by_order"][4].get<double>());
}

TEST_CASE("env: --bands limits the coefficients, the text shows the sun, and files that are no environment are refused", "[cli][env]") {
    const json three = json::parse(run({"env", "sky", "--bands", "3", "--json"}).out);
    CHECK(three["coefficients"].size() == 9);
    CHECK(three["band_norms"].size() == 3);
    CHECK(run({"env", "sky"}).out.find("sun towards") != std::string::npos);
    CHECK(run({"env", "sky", "--bands", "11"}).code == 2);
    CHECK(run({"env"}).code == 2);
    const TemporaryFolder folder;
    CHECK(run({"env", folder.file("missing.hdr")}).code == 4);
    write_contents(folder.file("text.hdr"), "not a picture");
    CHECK(run({"env", folder.file("text.hdr")}).code == 3);
    write_contents(folder.file("large.hdr"), "#?RADIANCE\n\n-Y 100000 +X 100000\n");
    CHECK(run({"env", folder.file("large.hdr")}).code == 5);
}
