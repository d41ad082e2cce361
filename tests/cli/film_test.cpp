// Moving pictures: frames as files and in one file, read back by other code than wrote them.
#include "apps/engine/film/gif_palette.hpp"
#include "tests/cli/program.hpp"
#include "tests/io/animated_file.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#if HALFLIT_HAS_GIF
#include <gif_lib.h>
#endif
#if HALFLIT_HAS_WEBP_FILMS
#include <webp/demux.h>
#endif

using namespace halflit::test;

namespace {

using Strings = std::vector<std::string>;

Outcome draw(const std::string& scene, const Strings& flags) {
    Strings arguments{"render", scene, "--size", "48x40", "--samples", "1"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Outcome outcome = run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome;
}

std::string arm_file(const TemporaryFolder& folder) {
    const Bytes file = Arm(1, Keys::linear).file;
    std::string path = folder.file("arm.glb");
    write_contents(path, std::string(reinterpret_cast<const char*>(file.data()), file.size()));
    return path;
}

/// A cube that rises by its height in a second.
std::string rising_cube_file(const TemporaryFolder& folder) {
    std::string path = folder.file("cube.gltf");
    write_contents(path, R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes)"
                         R"(":{"POSITION":0},"indices":1}]}],"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translatio)"
                         R"(n"}}],"samplers":[{"input":2,"output":3}]}],"buffers":[{"byteLength":164,"uri":"data:application/octet-stream;)"
                         R"(base64,AAAAvwAAAAAAAAC/AAAAvwAAAAAAAAA/AAAAvwAAgD8AAAC/AAAAvwAAgD8AAAA/AAAAPwAAAAAAAAC/AAAAPwAAAAAAAAA/AAAAPwA)"
                         R"(AgD8AAAC/AAAAPwAAgD8AAAA/AAEDAAMCBAYHBAcFAAQFAAUBAgMHAgcGAAIGAAYEAQUHAQcDAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAACAP)"
                         R"(wAAAAA="}],"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":36},{"buffer":)"
                         R"(0,"byteOffset":132,"byteLength":8},{"buffer":0,"byteOffset":140,"byteLength":24}],"accessors":[{"bufferView":0)"
                         R"(,"componentType":5126,"count":8,"type":"VEC3","min":[-0.5,0,-0.5],"max":[0.5,1,0.5]},{"bufferView":1,"componen)"
                         R"(tType":5121,"count":36,"type":"SCALAR"},{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[)"
                         R"(0],"max":[1]},{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}]})");
    return path;
}

struct ShownFrame {
    std::vector<unsigned char> rgba8;
    double seconds = 0;
};

std::uint32_t number_at(const std::string& file, std::size_t at, int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | static_cast<unsigned char>(file.at(at + static_cast<std::size_t>(i)));
    return value;
}

std::string big_endian(std::uint32_t value) {
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255u);
    return out;
}

/// The checksum of PNG, bit by bit.
std::uint32_t crc_of(const std::string& bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return ~crc;
}

/// Each frame's data as a PNG of its own, decoded.
std::vector<ShownFrame> apng_frames(const std::string& file) {
    std::string head, data;
    std::vector<ShownFrame> frames;
    std::uint32_t sequence = 0, count = 0;
    const auto chunk = [](const std::string& type, const std::string& content) {
        return big_endian(static_cast<std::uint32_t>(content.size())) + type + content + big_endian(crc_of(type + content));
    };
    const auto end_frame = [&] {
        if (data.empty()) return;
        frames.back().rgba8 = read_picture(file.substr(0, 8) + chunk("IHDR", head) + chunk("IDAT", data) + chunk("IEND", "")).rgba8;
        data.clear();
    };
    for (std::size_t at = 8; at < file.size();) {
        const std::uint32_t size = number_at(file, at, 4);
        const std::string type = file.substr(at + 4, 4), content = file.substr(at + 8, size);
        CHECK(number_at(file, at + 8 + size, 4) == crc_of(type + content));
        at += 12 + size;
        if (type == "IHDR") head = content;
        if (type == "acTL") count = number_at(content, 0, 4);
        if (type == "fcTL") {
            end_frame();
            CHECK(number_at(content, 0, 4) == sequence++);
            CHECK(content.substr(4, 8) == head.substr(0, 8));
            frames.push_back({{}, static_cast<double>(number_at(content, 20, 2)) / number_at(content, 22, 2)});
        }
        if (type == "IDAT") data += content;
        if (type == "fdAT") {
            CHECK(number_at(content, 0, 4) == sequence++);
            data += content.substr(4);
        }
    }
    end_frame();
    CHECK(count == frames.size());
    CHECK(read_picture(file).rgba8 == frames.at(0).rgba8);  // as readers without APNG show it
    return frames;
}

#if HALFLIT_HAS_WEBP_FILMS
std::vector<ShownFrame> webp_frames(const std::string& file) {
    WebPAnimDecoderOptions options;
    REQUIRE(WebPAnimDecoderOptionsInit(&options));
    options.color_mode = MODE_RGBA;
    const WebPData data{reinterpret_cast<const std::uint8_t*>(file.data()), file.size()};
    WebPAnimDecoder* const decoder = WebPAnimDecoderNew(&data, &options);
    REQUIRE(decoder != nullptr);
    WebPAnimInfo info;
    REQUIRE(WebPAnimDecoderGetInfo(decoder, &info));
    std::vector<ShownFrame> frames;
    for (int before = 0; WebPAnimDecoderHasMoreFrames(decoder);) {
        std::uint8_t* pixels = nullptr;
        int end_ms = 0;
        REQUIRE(WebPAnimDecoderGetNext(decoder, &pixels, &end_ms));
        frames.push_back({{pixels, pixels + std::size_t{4} * info.canvas_width * info.canvas_height}, (end_ms - before) / 1000.0});
        before = end_ms;
    }
    WebPAnimDecoderDelete(decoder);
    return frames;
}
#endif

#if HALFLIT_HAS_GIF
struct GifText {
    const std::string* file;
    std::size_t at = 0;
};

std::vector<ShownFrame> gif_frames(const std::string& file) {
    GifText text{&file};
    const auto read = [](GifFileType* gif, GifByteType* bytes, int size) {
        auto& from = *static_cast<GifText*>(gif->UserData);
        const std::size_t count = std::min(static_cast<std::size_t>(size), from.file->size() - from.at);
        std::copy_n(from.file->data() + from.at, count, bytes);
        from.at += count;
        return static_cast<int>(count);
    };
    int error = 0;
    GifFileType* const gif = DGifOpen(&text, read, &error);
    REQUIRE(gif != nullptr);
    REQUIRE(DGifSlurp(gif) == GIF_OK);
    std::vector<ShownFrame> frames;
    for (int i = 0; i < gif->ImageCount; ++i) {
        GraphicsControlBlock control{};
        REQUIRE(DGifSavedExtensionToGCB(gif, i, &control) == GIF_OK);
        const SavedImage& image = gif->SavedImages[i];
        CHECK(image.ImageDesc.Width == gif->SWidth);
        CHECK(image.ImageDesc.Height == gif->SHeight);
        ShownFrame& frame = frames.emplace_back();
        frame.seconds = control.DelayTime / 100.0;
        for (int p = 0; p < gif->SWidth * gif->SHeight; ++p) {
            const int index = image.RasterBits[p];
            const GifColorType color = image.ImageDesc.ColorMap->Colors[index];
            const bool clear = index == control.TransparentColor;
            for (const int value : {int{color.Red}, int{color.Green}, int{color.Blue}, clear ? 0 : 255})
                frame.rgba8.push_back(static_cast<unsigned char>(value));
        }
    }
    DGifCloseFile(gif, &error);
    return frames;
}
#endif

double total(const std::vector<ShownFrame>& frames) {
    double sum = 0;
    for (const ShownFrame& frame : frames) sum += frame.seconds;
    return sum;
}

/// Largest difference of colour codes where the pixel is opaque, and the root of the mean square.
std::pair<int, double> difference(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b) {
    REQUIRE(a.size() == b.size());
    int most = 0;
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int d = a[i] - b[i];
        most = std::max(most, std::abs(d));
        squares += d * d;
    }
    return {most, std::sqrt(squares / static_cast<double>(a.size()))};
}

}  // namespace

TEST_CASE("frames: two halves of a turntable, drawn by two processes, are the files of the whole", "[cli][film]") {
    const TemporaryFolder folder;
    const std::string arm = arm_file(folder);
    for (const std::string& scene : {std::string("demo"), arm}) {
        draw(scene, {"--turntable", "36", "-o", folder.file("whole/f_{:03}.png")});
        draw(scene, {"--turntable", "36", "--frames", "0-17", "--threads", "1", "-o", folder.file("parts/f_{:03}.png")});
        draw(scene, {"--turntable", "36", "--frames", "18-35", "--tile", "16", "-o", folder.file("parts/f_{:03}.png")});
        std::set<std::string> different;
        for (int n = 0; n < 36; ++n) {
            const std::string name = fmt::format("f_{:03}.png", n), whole = contents(folder.file("whole/" + name));
            CHECK(whole == contents(folder.file("parts/" + name)));
            different.insert(whole);
        }
        // The arm is a triangle that is not seen from behind.
        CHECK(different.size() >= (scene == arm ? 18u : 36u));
    }
}

TEST_CASE("frames: an animation that turns on a turntable has the same frames from any first one on", "[cli][film]") {
    const TemporaryFolder folder;
    const std::string arm = arm_file(folder);
    const Strings look{"--fps", "5", "--turntable", "10", "--ground", "--up", "z"};
    const auto frames = [&](const std::string& range, const std::string& name) {
        Strings flags = look;
        flags.insert(flags.end(), {"--frames", range, "-o", folder.file(name + "_{}.png")});
        draw(arm, flags);
    };
    frames("0-9", "all");
    frames("7-9:2", "late");
    frames("4", "one");
    CHECK(contents(folder.file("all_7.png")) == contents(folder.file("late_7.png")));
    CHECK(contents(folder.file("all_9.png")) == contents(folder.file("late_9.png")));
    CHECK(contents(folder.file("all_4.png")) == contents(folder.file("one_4.png")));
    CHECK(contents(folder.file("all_4.png")) != contents(folder.file("all_9.png")));
}

TEST_CASE("frames: an animation's frames are the pictures of --time, at N / fps seconds", "[cli][film]") {
    const TemporaryFolder folder;
    const std::string arm = arm_file(folder);
    // A camera and an exposure that do not depend on the scene, and no shadow, which lies on the ground of the whole film.
    const Strings look{"--camera-position", "9,7,12", "--camera-target", "0,0,0", "--exposure", "1", "--no-scene-lights", "--env", "sky",
                       "--contact-shadow",  "0"};
    Strings film = look;
    film.insert(film.end(), {"--frames", "0-20:10", "--fps", "12.5", "-o", folder.file("n_{frame:02}.png"), "--report", "-"});
    const auto report = json_lines(draw(arm, film).out);
    REQUIRE(report.size() == 3);
    std::set<std::string> hashes;
    for (std::size_t i = 0; i < 3; ++i) {
        const int number = static_cast<int>(i) * 10;
        CHECK(report[i]["frame"] == number);
        CHECK(report[i]["pose"]["time_s"] == number / 12.5);
        Strings still = look;
        still.insert(still.end(), {"--time", fmt::format("{}", number / 12.5), "-o", folder.file("still.png"), "--report", "-"});
        const auto one = nlohmann::json::parse(draw(arm, still).out);
        CHECK(one["pixel_hash"] == report[i]["pixel_hash"]);
        CHECK(contents(folder.file("still.png")) == contents(folder.file(fmt::format("n_{:02}.png", number))));
        hashes.insert(one["pixel_hash"]);
    }
    CHECK(hashes.size() == 3);
}

TEST_CASE("frames: a model that rises leaves its contact shadow behind, and one that is turned keeps it", "[cli][film]") {
    const TemporaryFolder folder;
    const auto shadow_pixels = [&](const std::string& name) {
        const Picture picture = read_picture(contents(folder.file(name)));
        int count = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) count += picture.pixel(x, y)[3] > 8 && picture.pixel(x, y)[3] < 200;
        return count;
    };
    const std::string cube = rising_cube_file(folder);
    const std::vector<std::string> flags{"--background", "transparent", "--fps", "10", "-o", folder.file("{}.png")};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), flags.begin(), flags.end());
        return more;
    };
    draw(cube, with({"--frames", "0-10", "--camera", "frame"}));
    CHECK(shadow_pixels("0.png") > 50);
    CHECK(shadow_pixels("1.png") == 0);
    CHECK(shadow_pixels("10.png") == 0);
    draw(cube, {"--turntable", "3", "--background", "transparent", "-o", folder.file("turned_{}.png")});
    for (const std::string name : {"turned_0.png", "turned_1.png", "turned_2.png"}) CHECK(shadow_pixels(name) > 50);
}

TEST_CASE("frames: nothing of a turntable or of an animation touches the picture's edge", "[cli][film]") {
    const TemporaryFolder folder;
    const std::string arm = arm_file(folder);
    draw(arm, {"--turntable", "8", "--background", "transparent", "-o", folder.file("t_{}.png")});
    draw(arm, {"--frames", "0-15", "--fps", "8", "--camera", "frame", "--background", "transparent", "-o", folder.file("a_{}.png")});
    for (const std::string name : {"t_0", "t_1", "t_7", "a_0", "a_7", "a_10", "a_15"}) {
        const Picture picture = read_picture(contents(folder.file(name + ".png")));
        int seen = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                const bool edge = x == 0 || y == 0 || x == picture.width - 1 || y == picture.height - 1;
                const int alpha = picture.pixel(x, y)[3];
                seen += alpha > 0;
                if (edge) CHECK(alpha == 0);
            }
        INFO(name);
        CHECK(seen > 0);
    }
}

TEST_CASE("frames: an APNG holds the frames, and its delays have the exact sum", "[cli][film]") {
    const TemporaryFolder folder;
    for (const std::string background : {"#123456", "transparent"}) {
        const Strings look{"--turntable", "5", "--fps", "30000/1001", "--background", background};
        Strings files = look, film = look;
        files.insert(files.end(), {"-o", folder.file("f_{}.png")});
        film.insert(film.end(), {"-o", folder.file("f.apng")});
        draw("demo", files);
        draw("demo", film);
        const auto frames = apng_frames(contents(folder.file("f.apng")));
        REQUIRE(frames.size() == 5);
        for (int n = 0; n < 5; ++n)
            CHECK(frames[static_cast<std::size_t>(n)].rgba8 == read_picture(contents(folder.file(fmt::format("f_{}.png", n)))).rgba8);
        CHECK(std::abs(total(frames) - 5 * 1001.0 / 30000.0) < 1e-12);
    }
}

TEST_CASE("frames: a WebP holds the frames exactly, and its delays lose less than a millisecond", "[cli][film]") {
#if HALFLIT_HAS_WEBP_FILMS
    const TemporaryFolder folder;
    for (const std::string background : {"#123456", "transparent"}) {
        const Strings look{"--turntable", "7", "--fps", "24", "--background", background};
        Strings files = look, film = look;
        files.insert(files.end(), {"-o", folder.file("f_{}.png")});
        film.insert(film.end(), {"-o", folder.file("f.webp")});
        draw("demo", files);
        draw("demo", film);
        const auto frames = webp_frames(contents(folder.file("f.webp")));
        REQUIRE(frames.size() == 7);
        for (int n = 0; n < 7; ++n) {
            std::vector<unsigned char> shown = frames[static_cast<std::size_t>(n)].rgba8,
                                       drawn = read_picture(contents(folder.file(fmt::format("f_{}.png", n)))).rgba8;
            // A transparent pixel of the decoder's canvas has no colour.
            for (std::vector<unsigned char>* pixels : {&shown, &drawn})
                for (std::size_t i = 0; i < pixels->size(); i += 4)
                    if ((*pixels)[i + 3] == 0)
                        std::fill_n(pixels->begin() + static_cast<std::ptrdiff_t>(i), 3, static_cast<unsigned char>(0));
            CHECK(shown == drawn);
        }
        CHECK(std::abs(total(frames) - 7 / 24.0) <= 0.0005);
    }
#else
    HALFLIT_SKIP("built without libwebpmux");
#endif
}

TEST_CASE("frames: a GIF is near the frames, and its delays lose less than a hundredth of a second in all", "[cli][film]") {
#if HALFLIT_HAS_GIF
    const TemporaryFolder folder;
    for (const std::string background : {"#123456", "transparent"})
        for (const bool dither : {false, true}) {
            const Strings look{"--turntable", "31", "--fps", "24", "--background", background, "--contact-shadow", "0"};
            Strings files = look, film = look;
            files.insert(files.end(), {"-o", folder.file("f_{}.png")});
            film.insert(film.end(), {"-o", folder.file("f.gif")});
            if (dither) film.push_back("--dither");
            draw("demo", files);
            draw("demo", film);
            const auto frames = gif_frames(contents(folder.file("f.gif")));
            REQUIRE(frames.size() == 31);
            CHECK(std::abs(total(frames) - 31 / 24.0) <= 0.005);
            for (const ShownFrame& frame : frames) CHECK((frame.seconds == 0.04 || frame.seconds == 0.05));
            for (const int n : {0, 13, 30}) {
                const ShownFrame& frame = frames[static_cast<std::size_t>(n)];
                std::vector<unsigned char> drawn = read_picture(contents(folder.file(fmt::format("f_{}.png", n)))).rgba8,
                                           shown = frame.rgba8;
                for (std::size_t i = 0; i < drawn.size(); i += 4) {
                    CHECK((shown[i + 3] == 255) == (drawn[i + 3] >= 128));
                    drawn[i + 3] = shown[i + 3];
                    if (shown[i + 3] == 0) std::fill_n(drawn.begin() + static_cast<std::ptrdiff_t>(i), 3, static_cast<unsigned char>(0));
                }
                const auto [most, rms] = difference(shown, drawn);
                INFO(most << " " << rms);
                CHECK(most <= 40);  // a colour that few pixels have
                CHECK(rms <= (dither ? 5.0 : 3.0));
            }
        }
#else
    HALFLIT_SKIP("built without giflib");
#endif
}

TEST_CASE("palette: a picture of 256 colours keeps them, and one of more has each colour within its neighbours", "[cli][film]") {
    halflit::Image few{32, 16, {}, {}};
    for (int i = 0; i < 512; ++i)
        for (const int value : {i & 255, 255 - (i & 255), (i * 7) & 255, 255}) few.rgba8.push_back(static_cast<std::uint8_t>(value));
    for (const bool dither : {false, true}) {
        const auto kept = halflit::film::with_palette(few, dither);
        REQUIRE(kept.colors.size() == 256);
        CHECK(kept.transparent == -1);
        for (std::size_t i = 0; i < 512; ++i)
            for (std::size_t c = 0; c < 3; ++c) CHECK(kept.colors[kept.pixels[i]][c] == few.rgba8[4 * i + c]);
    }
    few.rgba8[3] = 127;  // a transparent pixel takes one of the 256
    const auto reduced = halflit::film::with_palette(few, false);
    REQUIRE(reduced.colors.size() <= 256);
    CHECK(reduced.transparent == reduced.pixels[0]);
    for (std::size_t i = 1; i < 512; ++i) {
        CHECK(reduced.pixels[i] != reduced.transparent);
        // By search over all colours.
        int least = 1 << 30, got = 0;
        for (std::size_t k = 0; k < reduced.colors.size(); ++k) {
            if (static_cast<int>(k) == reduced.transparent) continue;
            int d = 0;
            for (std::size_t c = 0; c < 3; ++c)
                d += (reduced.colors[k][c] - few.rgba8[4 * i + c]) * (reduced.colors[k][c] - few.rgba8[4 * i + c]);
            least = std::min(least, d);
            if (k == reduced.pixels[i]) got = d;
        }
        CHECK(got == least);
    }
}

TEST_CASE("frames: a film's quality is measured once, whichever frames are drawn", "[cli][film]") {
    const TemporaryFolder folder;
    const auto frames = [&](const std::string& name, const Strings& more) {
        Strings flags{"render", "demo", "--size", "160x120", "--turntable", "18", "--quality", "draft", "-v", "-o", folder.file(name)};
        flags.insert(flags.end(), more.begin(), more.end());
        Outcome outcome = run(flags);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        return outcome.err;
    };
    const std::string said = frames("all_{}.bmp", {});
    (void)frames("some_{}.bmp", {"--frames", "4-7:3"});
    for (const std::string n : {"4", "7"}) CHECK(contents(folder.file("all_" + n + ".bmp")) == contents(folder.file("some_" + n + ".bmp")));
    // The settings that are told draw the same.
    const std::size_t at = said.find("probes: ");
    REQUIRE(at != std::string::npos);
    std::istringstream told(said.substr(at + 8, said.find('\n', at) - at - 8));
    Strings flags{"render", "demo", "--size", "160x120", "--turntable", "18", "--frames", "7", "-o", folder.file("told_{}.bmp")};
    for (std::string word; told >> word;) flags.push_back(word);
    REQUIRE(flags.size() == 16);
    const Outcome outcome = run(flags);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(contents(folder.file("told_7.bmp")) == contents(folder.file("all_7.bmp")));
    // A budget of one's own, and the report.
    const Outcome shared = run({"render", "demo", "--size", "160x120", "--turntable", "18", "--max-error", "8", "--share", "95%", "-o",
                                folder.file("shared_{}.bmp"), "--report", folder.file("shared.json")});
    REQUIRE(shared.code == 0);
    CHECK(contents(folder.file("shared_7.bmp")) == contents(folder.file("all_7.bmp")));
    const auto told_quality = json_lines(contents(folder.file("shared.json"))).at(0)["quality"];
    CHECK(told_quality["asked_percent"] == 95.0);
    CHECK(told_quality["percent"] >= 95.0);
    for (const Strings& wrong : {Strings{"--share", "95"},
                                 {"--share", "95", "--max-error", "2", "--quality", "fast"},
                                 {"--share", "100"},
                                 {"--quality", "best"},
                                 {"--quality", "fast", "--max-error", "2"}}) {
        Strings words{"render", "demo", "--size", "64", "--turntable", "3", "-o", folder.file("w_{}.bmp")};
        words.insert(words.end(), wrong.begin(), wrong.end());
        CHECK(run(words).code == 2);
    }
    // One picture alone has full quality.
    for (const Strings& more : {Strings{}, Strings{"--quality", "draft"}}) {
        Strings one{"render", "demo", "--size", "64", "-o", folder.file(more.empty() ? "a.bmp" : "b.bmp")};
        one.insert(one.end(), more.begin(), more.end());
        const Outcome drawn = run(one);
        REQUIRE(drawn.code == 0);
        CHECK((drawn.err.find("quality: full, as") != std::string::npos) == !more.empty());
    }
    CHECK(contents(folder.file("a.bmp")) == contents(folder.file("b.bmp")));
    // A short film is not measured, and says so.
    for (const Strings& more :
         {Strings{"--turntable", "3", "--quality", "draft"}, Strings{"--turntable", "100", "--frames", "0-1", "--quality", "fast"}}) {
        Strings few{"render", "demo", "--size", "64", "-o", folder.file("few_{}.bmp")};
        few.insert(few.end(), more.begin(), more.end());
        const Outcome drawn = run(few);
        REQUIRE(drawn.code == 0);
        CHECK(drawn.err.find("frames does not repay measuring") != std::string::npos);
    }
}

TEST_CASE("frames: wrong flags are told with what was expected", "[cli][film]") {
    const TemporaryFolder folder;
    const auto message = [&](const Strings& flags) {
        Strings arguments{"render", "demo", "--size", "8"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        INFO(outcome.err);
        CHECK(outcome.code == 2);
        CHECK(folder.names().empty());
        return outcome.err;
    };
    for (const std::string range : {"x", "-1", "5-2", "1-", "0-5:0", "0-5:", "3:2", "0-5:1:2", "1-2-3", "0-10000000"})
        CHECK(message({"--frames", range, "-o", "a_{}.png"}).find("--frames: expected A-B or A-B:STEP") != std::string::npos);
    for (const std::string fps : {"0", "-1", "x", "24.", "1.2345", "1/0", "24/x", "1001", "1/2000"})
        CHECK(message({"--frames", "0-1", "--fps", fps, "-o", "a_{}.png"}).find("--fps: expected frames a second") != std::string::npos);
    CHECK(message({"--frames", "0-1", "-o", "a.png"}).find("a place for the frame's number") != std::string::npos);
    CHECK(message({"--frames", "0-1", "-o", "a_{x}.png"}).find("found {x}") != std::string::npos);
    CHECK(message({"--frames", "0-1", "-o", "-"}).find("need a file name") != std::string::npos);
    CHECK(message({"--frames", "0-1", "--time", "3", "-o", "a_{}.png"}).find("--time: cannot be combined with --frames") !=
          std::string::npos);
    CHECK(message({"--fps", "24", "-o", "a.png"}).find("--fps: expected together with") != std::string::npos);
    CHECK(message({"-o", "a.gif"}).find("expected --frames or --turntable") != std::string::npos);
    CHECK(message({"--turntable", "4", "--aov", "depth", "-o", "a.apng"}).find("--aov: expected a file for each frame") !=
          std::string::npos);
    CHECK(message({"--turntable", "0", "-o", "a_{}.png"}).find("--turntable") != std::string::npos);
    CHECK(message({"--turntable", "4", "--dither", "-o", "a_{}.png"}).find("--dither: expected a .gif") != std::string::npos);
}

#if HALFLIT_HAS_WEBP_FILMS
TEST_CASE("frames: .webp is one picture, many in one file, or by a pattern a file of each frame", "[cli][film]") {
    const TemporaryFolder folder;
    const std::string one = folder.file("one.webp"), film = folder.file("film.webp");
    draw("demo", {"-o", one});
    draw("demo", {"--turntable", "4", "-o", film});
    draw("demo", {"--turntable", "4", "-o", folder.file("frame_{}.webp")});
    CHECK(contents(one).starts_with("RIFF"));
    CHECK(contents(one).find("ANIM") == std::string::npos);
    CHECK(contents(film).find("ANIM") != std::string::npos);
    for (int n = 0; n < 4; ++n) CHECK(contents(folder.file(fmt::format("frame_{}.webp", n))).starts_with("RIFF"));
}
#endif
