// Pictures of MuJoCo's scenes: planes against closed forms, and many pictures against one at a time.
#include "apps/engine/mujoco/drawer.hpp"
#include "tests/engine/raw_scene.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <random>

using namespace halflit;
using namespace halflit::engine::mujoco;
using halflit::test::RawScene;

namespace {

constexpr int kWidth = 33, kHeight = 25;
constexpr std::size_t kPixels = kWidth * kHeight, kMiddle = kPixels / 2;

/// The planes of one picture.
struct Planes {
    std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(3 * kPixels);
    std::vector<float> depth = std::vector<float>(kPixels);
    std::vector<std::int32_t> segid = std::vector<std::int32_t>(kPixels), object = std::vector<std::int32_t>(2 * kPixels);

    Picture picture(const Scene& scene) {
        Picture p;
        p.scene = &scene;
        p.rgb = rgb.data(), p.depth = depth.data(), p.segid = segid.data(), p.object = object.data();
        p.width = kWidth, p.height = kHeight;
        return p;
    }
    friend bool operator==(const Planes&, const Planes&) = default;
};

Drawer drawer(const Model& model = {}, int threads = 1) {
    Execution execution;
    execution.threads = threads;
    auto made = Drawer::make(model, *look_of("2.2.2"), execution);
    if (!made) FAIL(made.error().message);
    return std::move(*made);
}

void draw(Drawer& by, const Picture& picture) {
    const auto done = by.render({&picture, 1});
    if (!done) FAIL(done.error().message);
}

/// Of cameras at a distance of 3 from the near side of a box of the size 1.
RawScene box_scene() {
    RawScene raw;
    raw.look_from({0, -4, 0}, {0, 1, 0});
    raw.add(kBox, {0, 0, 0}, {1, 1, 1});
    raw.add_light({0, -4, 4}, {0, 1, -1}, true);
    return raw;
}

std::string error_of(const Picture& picture) {
    Drawer by = drawer();
    const auto done = by.render({&picture, 1});
    return done ? "" : done.error().message;
}

/// Planes that are drawn with colors, and the same without.
std::pair<Planes, Planes> with_and_without_rgb(const Scene& scene) {
    std::pair<Planes, Planes> drawn;
    Drawer by = drawer();
    draw(by, drawn.first.picture(scene));
    Picture alone = drawn.second.picture(scene);
    alone.rgb = nullptr;
    draw(by, alone);
    return drawn;
}

}  // namespace

TEST_CASE("mujoco drawer: depth, segids and objects of a box are those of its side", "[engine][mujoco]") {
    const Layout at;
    RawScene raw = box_scene();
    raw.set(0, at.geom_segid, 70000);
    const Scene scene = raw.scene();
    Planes got;
    Picture picture = got.picture(scene);
    Drawer by = drawer();
    picture.depth_is_distance = true;
    draw(by, picture);
    CHECK(got.depth[kMiddle] == Approx(3).epsilon(1e-5));
    CHECK(got.depth[0] == 50);  // nothing is there
    CHECK(got.segid[kMiddle] == 70000);
    CHECK(got.segid[0] == -1);
    CHECK(got.object[2 * kMiddle] == 100);
    CHECK(got.object[2 * kMiddle + 1] == 5);
    CHECK(got.object[0] == -1);
    picture.depth_is_distance = false;
    draw(by, picture);
    // (f + n) / (f - n) / 2 + 1/2 - f n / (f - n) / z
    CHECK(got.depth[kMiddle] == Approx(50 / 49.9 - 5 / 49.9 / 3).epsilon(1e-6));
    CHECK(got.depth[0] == 1);
}

TEST_CASE("mujoco drawer: colors of segids are their digits, or numbers that are far apart", "[engine][mujoco]") {
    const Layout at;
    RawScene raw = box_scene();
    const Scene scene = raw.scene();
    Planes got;
    Picture picture = got.picture(scene);
    std::uint8_t flags[kFlagCount] = {};
    std::copy_n(kDefaultFlags, kFlagCount, flags);
    flags[kSegment] = 1;
    picture.flags = flags;
    Drawer by = drawer();
    draw(by, picture);
    // 10 is 1010 by twos, 101 by threes and 20 by fives: 0.0101, 0.101 and 0.02 in these bases.
    const double fractions[3] = {0.25 + 0.0625, 1 / 3.0 + 1 / 27.0, 2 / 25.0};
    for (std::size_t k = 0; k < 3; ++k) CHECK(got.rgb[3 * kMiddle + k] == std::lround(255 * (0.1 + 0.8 * fractions[k])));
    CHECK(got.rgb[0] == 0);
    flags[kIdColor] = 1;
    raw.set(0, at.geom_segid, 0x030201);
    draw(by, picture);
    for (std::size_t k = 0; k < 3; ++k) CHECK(got.rgb[3 * kMiddle + k] == k + 1 + (k == 0));
    raw.set(0, at.geom_segid, 0x7fffffff);  // beyond an int with the 10 that is added
    flags[kIdColor] = 0;
    draw(by, picture);
    CHECK(got.segid[kMiddle] == 0x7fffffff);
    raw.set(0, at.geom_segid, -1);
    draw(by, picture);
    CHECK(got.rgb[3 * kMiddle] == 0);
    CHECK(got.segid[kMiddle] == -1);
}

TEST_CASE("mujoco drawer: depth of the color pass is that of opaque geoms and of the sky", "[engine][mujoco]") {
    const std::int32_t type[1] = {2}, side[1] = {1};
    const std::int64_t address[1] = {0};
    const std::uint8_t texel[3] = {10, 20, 30};
    Model model;
    model.ntex = 1, model.ntexdata = 3;
    model.tex_type = type, model.tex_width = model.tex_height = side, model.tex_adr = address, model.tex_data = texel;
    RawScene raw = box_scene();
    raw.add(kBox, {0, -2, 0}, {0.5f, 0.1f, 0.5f}, {1, 1, 1, 0.5f});
    const Scene scene = raw.scene();
    Drawer by = drawer(model);
    Planes with_rgb, alone;
    Picture picture = with_rgb.picture(scene);
    picture.depth_is_distance = picture.depth_of_color_pass = true;
    draw(by, picture);
    CHECK(with_rgb.depth[kMiddle] == Approx(3).epsilon(1e-5));
    CHECK(with_rgb.segid[kMiddle] == 1);
    CHECK(with_rgb.rgb[0] == 10);
    // The sky is a cylinder around the eye, whose radius is 0.7 of the far plane's distance. In the picture's plane a corner is 0.512 away
    // from the middle across, which makes the ray longer.
    CHECK(with_rgb.depth[0] == Approx(35 / std::hypot(1.0, 0.512)).epsilon(0.007));
    for (const int samples : {1, 4}) {
        picture = alone.picture(scene);
        if (samples == 1) picture.rgb = nullptr;
        picture.samples = samples;
        picture.depth_is_distance = picture.depth_of_color_pass = true;
        draw(by, picture);
        CHECK(alone.depth == with_rgb.depth);
        CHECK(alone.segid == with_rgb.segid);
    }
}

TEST_CASE("mujoco drawer: of two geoms in one plane the later one is seen", "[engine][mujoco]") {
    for (const bool swapped : {false, true}) {
        RawScene raw;
        raw.look_from({0, -4, 0}, {0, 1, 0});
        for (const bool wide : {swapped, !swapped}) raw.add(kBox, {0, 0, 0}, {wide ? 1.0f : 0.5f, 1, wide ? 1.0f : 0.5f});
        const Scene scene = raw.scene();
        const auto [got, alone] = with_and_without_rgb(scene);
        CHECK(got.segid[kMiddle] == 1);
        CHECK(alone.segid == got.segid);
    }
}

TEST_CASE("mujoco drawer: pictures from the bottom up are the same, turned", "[engine][mujoco]") {
    RawScene raw = box_scene();
    raw.look_from({0.3f, -4, 1}, {0, 1, -0.1f});
    const Scene scene = raw.scene();
    Planes down, up;
    Drawer by = drawer();
    draw(by, down.picture(scene));
    Picture picture = up.picture(scene);
    picture.bottom_up = true;
    draw(by, picture);
    CHECK(up.rgb != down.rgb);
    for (std::size_t y = 0; y < kHeight; ++y) {
        const std::size_t other = kHeight - 1 - y;
        CHECK(std::equal(&up.rgb[3 * kWidth * y], &up.rgb[3 * kWidth * y] + 3 * kWidth, &down.rgb[3 * kWidth * other]));
        CHECK(std::equal(&up.depth[kWidth * y], &up.depth[kWidth * y] + kWidth, &down.depth[kWidth * other]));
        CHECK(std::equal(&up.object[2 * kWidth * y], &up.object[2 * kWidth * y] + 2 * kWidth, &down.object[2 * kWidth * other]));
    }
}

TEST_CASE("mujoco drawer: many pictures at once are those of one at a time", "[engine][mujoco]") {
    // A skin of one triangle, which is elsewhere in each scene.
    const std::int32_t zero[1] = {0}, three[1] = {3}, one[1] = {1}, none[1] = {-1}, face[3] = {0, 1, 2};
    Model model;
    model.nskin = model.nskinface = 1, model.nskinvert = 3;
    model.skin_vertadr = model.skin_faceadr = zero, model.skin_vertnum = three, model.skin_facenum = one;
    model.skin_texcoordadr = none, model.skin_face = face;
    constexpr std::size_t kCount = 12;
    std::vector<RawScene> raws;
    std::vector<std::vector<float>> vertices(kCount);
    const std::vector<float> normals = {0, -1, 0, 0, -1, 0, 0, -1, 0};
    std::vector<Scene> scenes;
    const Layout at;
    for (std::size_t i = 0; i < kCount; ++i) {
        const float shift = 0.1f * static_cast<float>(i);
        RawScene raw = box_scene();
        raw.look_from({shift, -4, 1}, {0, 1, -0.2f});
        raw.set(raw.add(104, {0, 0, 0}, {1, 1, 1}, {1, 0, 0, 1}), at.geom_objid, 0);
        raw.add(kPlane, {0, 0, -1}, {3, 3, 1}, {0.3f, 0.5f, 0.7f, 1});
        vertices[i] = {shift, -2, 0, 1, -2, 0, shift, -2, 1};
        raws.push_back(std::move(raw));
    }
    for (std::size_t i = 0; i < kCount; ++i) {
        scenes.push_back(raws[i].scene());
        scenes[i].skinvert = vertices[i].data(), scenes[i].skinnormal = normals.data();
    }
    std::vector<Planes> single(kCount);
    Drawer by = drawer(model);
    for (std::size_t i = 0; i < kCount; ++i) draw(by, single[i].picture(scenes[i]));
    CHECK(std::count(single[0].segid.begin(), single[0].segid.end(), 1) > 5);
    CHECK(!(single[0] == single[1]));
    for (const int threads : {1, 2, 5, 40}) {
        INFO(threads << " threads");
        std::vector<Planes> many(kCount);
        std::vector<Picture> pictures;
        for (std::size_t i = 0; i < kCount; ++i) pictures.push_back(many[i].picture(scenes[i]));
        Drawer parallel = drawer(model, threads);
        for (int again = 0; again < 2; ++again) {
            REQUIRE(parallel.render(pictures));
            CHECK(many == single);
        }
        pictures[3].width = 0;
        pictures[7].height = -1;
        CHECK(parallel.render(pictures).error().message == "picture: 0 x 25 pixels, expected 1 to 16384 on a side");
    }
}

TEST_CASE("mujoco drawer: a host's loop that leaves pictures out is an error, and its numbers do not matter", "[engine][mujoco]") {
    RawScene raw = box_scene();
    const Scene scene = raw.scene();
    Execution execution;
    execution.threads = 2;
    std::vector<Planes> many(3);
    std::vector<Picture> pictures;
    for (Planes& planes : many) pictures.push_back(planes.picture(scene));
    struct Row {
        std::vector<int> calls;
        const char* message;
    };
    for (const Row& row :
         {Row{{0, 1}, ""}, Row{{7, -1, 7}, ""}, Row{{1}, ""}, Row{{}, "parallel_for returned before every item was done"}}) {
        execution.parallel_for = [&](int, const std::function<void(int)>& body) {
            for (const int i : row.calls) body(i);
        };
        auto by = Drawer::make({}, *look_of("2.2.2"), Execution{});
        REQUIRE(by);
        by->set_execution(execution);
        const auto done = by->render(pictures);
        CHECK((done ? "" : done.error().message) == row.message);
        if (done) CHECK(many[2].segid[kMiddle] == 0);
    }
}

TEST_CASE("mujoco drawer: ids are the same with colors and without, in mirrors and behind glass", "[engine][mujoco]") {
    const Layout at;
    for (const auto& [mirrors, special] : {std::pair{true, 0}, {true, 1}, {false, 0}, {false, 1}}) {
        INFO("mirrors " << mirrors << ", geom " << special);
        RawScene raw = box_scene();
        raw.add(kBox, {0, 0, 0}, {1, 1, 1});
        // One of two that are in one plane is a mirror or transparent, which the colors' pass draws later.
        if (mirrors) raw.set(special, at.geom_reflectance, 0.5f);
        if (!mirrors) raw.set(special, at.geom_rgba, Vec4f{1, 1, 1, 0.5f});
        const Scene scene = raw.scene();
        const auto [with_rgb, alone] = with_and_without_rgb(scene);
        CHECK(alone.segid[kMiddle] == 1);
        CHECK(with_rgb.segid == alone.segid);
        CHECK(with_rgb.object == alone.object);
        CHECK(with_rgb.depth == alone.depth);
    }
}

TEST_CASE("mujoco drawer: a time limit that is over before a picture begins ends the call", "[engine][mujoco]") {
    RawScene raw = box_scene();
    const Scene scene = raw.scene();
    Execution execution;
    execution.time_limit_s = 1e-7;
    Drawer by = drawer();
    by.set_execution(execution);
    std::vector<Planes> many(3);
    std::vector<Picture> pictures;
    for (Planes& planes : many) pictures.push_back(planes.picture(scene));
    const auto done = by.render(pictures);
    REQUIRE(!done);
    CHECK(done.error().code == ErrorCode::limit);
}

TEST_CASE("mujoco drawer: what a picture must not say is one line of error", "[engine][mujoco]") {
    RawScene raw = box_scene();
    const Scene scene = raw.scene();
    Planes got;
    Picture picture = got.picture(scene);
    picture.samples = 3;
    CHECK(error_of(picture) == "picture: samples is 3, expected 1 or 4");
    Scene without = scene;
    without.camera = nullptr;
    CHECK(error_of(got.picture(without)) == "picture: the camera is null");
    without = scene, without.geoms = nullptr;
    CHECK(error_of(got.picture(without)) == "scene: 1 geoms and 1 lights, an array is null");
    without = scene, without.nlight = -1;
    CHECK(error_of(got.picture(without)).find("scene: ") == 0);
    CHECK(drawer().render({}));
    Picture nothing;
    nothing.scene = &scene, nothing.width = nothing.height = 8;
    CHECK(error_of(nothing).empty());
}

TEST_CASE("mujoco drawer: scenes of random bytes are drawn or refused", "[engine][mujoco]") {
    std::mt19937 random(66);
    const Layout at;
    Drawer by = drawer();
    int drawn = 0;
    for (int scene_number = 0; scene_number < 400; ++scene_number) {
        INFO("scene " << scene_number);
        RawScene raw = box_scene();
        // Bits of any number; those of small ones more often.
        const auto number = [&] {
            const auto bits = static_cast<std::uint32_t>(random());
            return random() % 8 != 0 ? static_cast<float>(bits % 2000) * 0.01f - 10.0f : std::bit_cast<float>(bits);
        };
        for (int i = 1; i < 6; ++i) {
            constexpr std::int32_t kTypes[] = {0, 2, 3, 4, 5, 6, 100, 101, 102, 103, 105, -7};
            raw.add(kTypes[random() % std::size(kTypes)], {number(), number(), number()}, {number(), number(), number()},
                    {number(), number(), number(), number()});
            for (int k = 0; k < 9; ++k) raw.set(i, at.geom_mat + 4 * k, number() * 0.1f);
            for (const int place : {at.geom_emission, at.geom_specular, at.geom_shininess, at.geom_reflectance, at.geom_modelrbound})
                raw.set(i, place, number());
            raw.set(i, at.geom_segid, static_cast<std::int32_t>(random()));
        }
        for (int i = 1; i < 3; ++i) {
            raw.add_light({number(), number(), number()}, {number(), number(), number()}, true);
            for (const int place : {at.light_cutoff, at.light_exponent, at.light_attenuation, at.light_diffuse})
                raw.set_light(i, place, number());
            raw.set_light(i, at.light_directional, static_cast<std::uint8_t>(random() % 2));
        }
        const Scene scene = raw.scene();
        Planes got;
        const Picture picture = got.picture(scene);
        const auto done = by.render({&picture, 1});
        drawn += done.has_value();
        if (!done) CHECK(done.error().message.find('\n') == std::string::npos);
    }
    CHECK(drawn > 40);
    CHECK(drawn < 400);
}
