#include "apps/halflit/picture_diff.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace halflit::test;

namespace {

using Codes = std::vector<unsigned char>;

/// 2 x 2, mid grey; the second has one pixel with red + 3 and alpha - 4.
const Codes kGrey = {100, 100, 100, 255, 100, 100, 100, 255, 100, 100, 100, 255, 100, 100, 100, 255};
const Codes kChanged = {100, 100, 100, 255, 103, 100, 100, 251, 100, 100, 100, 255, 100, 100, 100, 255};

}  // namespace

TEST_CASE("diff: one pixel off by 3 and 4 has max 4, mean 7/16, count 1 and the closed form's PSNR", "[cli][diff]") {
    const TemporaryFolder folder;
    write_contents(folder.file("a.png"), png_of(2, 2, kGrey));
    write_contents(folder.file("b.png"), png_of(2, 2, kChanged));
    const Outcome outcome = run({"diff", folder.file("a.png"), folder.file("b.png"), "--json"});
    CHECK(outcome.code == 1);
    const auto json = nlohmann::json::parse(outcome.out);
    CHECK(json["max"] == 4);
    CHECK(json["mean"] == 7.0 / 16.0);
    CHECK(json["count"] == 1);
    CHECK(json["psnr"].get<double>() == Approx(10.0 * std::log10(255.0 * 255.0 / (25.0 / 16.0))).epsilon(1e-12));
}

TEST_CASE("diff: the exit code is 0 up to --max, 1 above", "[cli][diff]") {
    const TemporaryFolder folder;
    const std::string a = folder.file("a.png"), b = folder.file("b.png");
    write_contents(a, png_of(2, 2, kGrey));
    write_contents(b, png_of(2, 2, kChanged));
    CHECK(run({"diff", a, a}).code == 0);
    CHECK(run({"diff", a, b}).code == 1);
    CHECK(run({"diff", a, b, "--max", "3"}).code == 1);
    CHECK(run({"diff", b, a, "--max", "4"}).code == 0);
    CHECK(nlohmann::json::parse(run({"diff", a, a, "--json"}).out)["psnr"].is_null());
    CHECK(run({"diff", a, a}).out.find("infinite") != std::string::npos);
}

TEST_CASE("diff: other sizes, no picture and no file end with 3 and 4", "[cli][diff]") {
    const TemporaryFolder folder;
    const std::string a = folder.file("a.png"), wide = folder.file("wide.png"), text = folder.file("text.png");
    write_contents(a, png_of(2, 2, kGrey));
    write_contents(wide, png_of(4, 1, kGrey));
    write_contents(text, "not a picture");
    const Outcome sizes = run({"diff", a, wide});
    CHECK(sizes.code == 3);
    CHECK(sizes.err.find("4x1, expected 2x2") != std::string::npos);
    CHECK(run({"diff", a, text}).code == 3);
    CHECK(run({"diff", a, folder.file("missing.png")}).code == 4);
}

TEST_CASE("diff: the difference image is stretched and opaque, alpha shown in all channels", "[cli][diff]") {
    const TemporaryFolder folder;
    const std::string a = folder.file("a.png"), b = folder.file("b.png"), d = folder.file("d.png");
    write_contents(a, png_of(2, 2, kGrey));
    write_contents(b, png_of(2, 2, kChanged));
    CHECK(run({"diff", a, b, "-o", d}).code == 1);
    const Picture image = read_picture(contents(d));
    CHECK(image.pixel(0, 0) == std::vector<int>{0, 0, 0, 255});
    CHECK(image.pixel(1, 0) == std::vector<int>{255, 146, 146, 255});  // 3 + 4, 4, 4 of at most 7
}

TEST_CASE("diff: a JPEG of a flat colour is within a code of it", "[cli][diff]") {
    const TemporaryFolder folder;
    // The region lies beside the sphere, so it shows only background.
    const std::vector<std::string> flat = {"render",    "sphere:500",   "--size",  "160x64", "--region",
                                           "0,0,16,16", "--background", "#4080c0", "-o"};
    auto as_png = flat, as_jpg = flat;
    as_png.push_back(folder.file("a.png"));
    as_jpg.push_back(folder.file("a.jpg"));
    CHECK(run(as_png).code == 0);
    CHECK(run(as_jpg).code == 0);
    CHECK(run({"diff", folder.file("a.png"), folder.file("a.jpg"), "--max", "2"}).code == 0);
}
