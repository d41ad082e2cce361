#include "apps/engine/pictures/picture_diff.hpp"
#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
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

TEST_CASE("diff: every format that render writes can be compared", "[cli][diff]") {
    const TemporaryFolder folder;
    for (const char* extension : {"png", "bmp", "tga", "hdr", "jpg"})
        REQUIRE(run({"render", "demo", "--size", "64x36", "--tonemap", "none", "-o", folder.file(std::string("a.") + extension)}).code ==
                0);
    CHECK(run({"diff", folder.file("a.png"), folder.file("a.bmp")}).code == 0);
    CHECK(run({"diff", folder.file("a.png"), folder.file("a.tga")}).code == 0);
    CHECK(run({"diff", folder.file("a.jpg"), folder.file("a.jpg")}).code == 0);
    // RGBE has 8 bits of mantissa for the brightest channel, fewer for the others.
    CHECK(run({"diff", folder.file("a.png"), folder.file("a.hdr"), "--max", "4"}).code == 0);
    write_contents(folder.file("cut.hdr"), contents(folder.file("a.hdr")).substr(0, 200));
    const Outcome cut = run({"diff", folder.file("a.hdr"), folder.file("cut.hdr")});
    CHECK(cut.code == 3);
    CHECK(cut.err.find("cut.hdr: ") != std::string::npos);
    CHECK(std::count(cut.err.begin(), cut.err.end(), '\n') == 1);
}

TEST_CASE("diff: --max-share allows that share of the pixels to differ by more than --max", "[cli][diff]") {
    const TemporaryFolder folder;
    const std::string a = folder.file("a.png"), b = folder.file("b.png");
    write_contents(a, png_of(2, 2, kGrey));
    write_contents(b, png_of(2, 2, kChanged));  // one pixel of four differs, by 4
    CHECK(run({"diff", a, b, "--max-share", "25%"}).code == 0);
    CHECK(run({"diff", a, b, "--max-share", "0.25"}).code == 0);
    CHECK(run({"diff", a, b, "--max-share", "24.9%"}).code == 1);
    CHECK(run({"diff", a, b, "--max-share", "0", "--max", "4"}).code == 0);
    for (const char* wrong : {"", "%", "101%", "1.5", "-1", "nan", "5 %"}) {
        INFO(wrong);
        const Outcome outcome = run({"diff", a, b, "--max-share", wrong});
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("--max-share") != std::string::npos);
    }
    const auto json = nlohmann::json::parse(run({"diff", a, b, "--max", "3", "--json"}).out);
    CHECK(json["count_above"] == 1);
    CHECK(json["share_above"] == 0.25);
    CHECK(json["passed"] == false);
    CHECK(json["tolerance"] == nlohmann::json{{"max_codes", 3}, {"max_share", 0.0}});
}

TEST_CASE("diff: folders are compared file by file, sorted, and a file in one of them alone is a difference", "[cli][diff]") {
    const TemporaryFolder a, b, pictures;
    for (const TemporaryFolder* folder : {&a, &b}) {
        std::filesystem::create_directory(folder->file("sub"));
        write_contents(folder->file("sub/same.png"), png_of(2, 2, kGrey));
        write_contents(folder->file("notes.txt"), folder->path());  // not a picture
    }
    CHECK(run({"diff", a.path(), b.path()}).code == 0);
    write_contents(a.file("changed.png"), png_of(2, 2, kGrey));
    write_contents(b.file("changed.png"), png_of(2, 2, kChanged));
    CHECK(run({"diff", a.path(), b.path()}).code == 1);
    CHECK(run({"diff", a.path(), b.path(), "--max", "4"}).code == 0);
    CHECK(run({"diff", a.path(), b.path(), "--max-share", "25%"}).code == 0);
    write_contents(a.file("sub/wide.png"), png_of(4, 1, kGrey));
    write_contents(b.file("sub/wide.png"), png_of(2, 2, kGrey));
    write_contents(a.file("only-a.png"), png_of(2, 2, kGrey));
    write_contents(b.file("only-b.png"), png_of(2, 2, kGrey));
    const Outcome outcome = run({"diff", a.path(), b.path(), "--json", "-o", pictures.path()});
    CHECK(outcome.code == 1);
    const auto json = nlohmann::json::parse(outcome.out);
    std::vector<std::pair<std::string, std::string>> found;
    for (const auto& file : json["files"]) found.emplace_back(file["path"], file["status"]);
    CHECK(found == std::vector<std::pair<std::string, std::string>>{{"changed.png", "differs"},
                                                                    {"only-a.png", "missing"},
                                                                    {"only-b.png", "extra"},
                                                                    {"sub/same.png", "equal"},
                                                                    {"sub/wide.png", "size"}});
    CHECK(json["sums"]["equal"] == 1);
    CHECK(pictures.names() == std::vector<std::string>{"changed.png.png"});
    const Outcome text = run({"diff", a.path(), b.path()});
    CHECK(text.out.find("5 files: 1 equal, 1 differs, 1 size, 1 missing, 1 extra\n") != std::string::npos);

    write_contents(b.file("changed.png"), "not a picture");
    const Outcome broken = run({"diff", a.path(), b.path()});
    CHECK(broken.code == 3);
    CHECK(broken.out.find("failed    changed.png") != std::string::npos);
    CHECK(run({"diff", a.path(), b.file("only-b.png")}).code == 2);
}
