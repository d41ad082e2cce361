#include "apps/engine/look/look_sheet.hpp"
#include "apps/engine/pictures/lettering.hpp"
#include "tests/look/scene_job.hpp"
#include "tests/support/solids.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

constexpr Color kPaper{0xec, 0xee, 0xf1}, kInk{0x2b, 0x33, 0x3d}, kPage{0x1f, 0x22, 0x27};

/// Places at which a text stands in a picture, pixel by pixel.
int places_of(const Image& picture, const std::string& text, double size, Color color, Color background) {
    const int width = static_cast<int>(width_of_text(text, size)) + 1, height = static_cast<int>(cap_height(size)) + 1;
    Canvas canvas(width, height, background);
    draw_text(canvas, {0, static_cast<double>(height) - 1}, text, {size, color});
    const Image& pattern = canvas.image();
    int places = 0;
    const auto row = [](const Image& image, int x, int y) { return image.rgba8.begin() + 4 * (std::ptrdiff_t{y} * image.width + x); };
    for (int y = 0; y + height <= picture.height; ++y)
        for (int x = 0; x + width <= picture.width; ++x) {
            bool same = true;
            for (int j = 0; same && j < height; ++j) {
                const auto from = row(pattern, 0, j);
                same = std::equal(from, from + 4 * width, row(picture, x, y + j));
            }
            places += same ? 1 : 0;
        }
    return places;
}

struct Sheet {
    RenderJob job;
    std::vector<ViewShot> shots;
    std::vector<ViewContent> contents;
};

/// Views of the scene, by one scale.
Sheet sheet_of(Scene scene, int width = 480, int height = 400) {
    Sheet out{scene_job(std::move(scene), width, height), {}, {}};
    Settings& settings = out.job.settings;
    settings.background_linear = {1, 1, 1, 1};
    Renderer renderer;
    std::vector<ViewSettings> sides;
    std::vector<std::string> names;
    for (const NamedView& view : kNamedViews) {
        if (view.name != "front" && view.name != "right" && view.name != "top" && view.name != "iso") continue;
        sides.push_back({.azimuth_deg = view.azimuth_deg, .elevation_deg = view.elevation_deg, .orthographic = true});
        sides.back().margin_x = sides.back().margin_y = 0.3;
        names.emplace_back(view.name);
    }
    const auto cameras = frame_views(out.job.scene(), out.job.film.bounds, static_cast<float>(width) / static_cast<float>(height), sides);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        auto shot = draw_shot(out.job, renderer, names[i], cameras[i], {});
        REQUIRE(shot);
        out.shots.push_back(std::move(*shot));
    }
    auto contents = count_parts(out.job, renderer, out.shots, 24);
    REQUIRE(contents);
    out.contents = std::move(*contents);
    return out;
}

Scene box_scene(Vec3d size) {
    Scene scene;
    scene.meshes = {box_mesh({0, 0, 0}, size)};
    scene.instances.resize(1);
    return scene;
}

}  // namespace

TEST_CASE("sheet: each view has the lengths of the box's sides that it shows, in the unit that people read", "[look]") {
    struct Case {
        Vec3d size;
        double unit_m;  // of the file
        const char *x, *y, *z;
    };
    for (const Case& one :
         {Case{{37, 21, 12.5}, 0, "37", "21", "12.5"}, Case{{0.37, 0.21, 0.125}, 1, "370 mm", "210 mm", "125 mm"},
          Case{{3.75, 2.5, 1.25}, 1, "3.75 m", "2.5 m", "1.25 m"}, Case{{1500, 1250, 1125}, 0.001, "1500 mm", "1250 mm", "1125 mm"}}) {
        Sheet sheet = sheet_of(box_scene(one.size));
        sheet.job.source.file.emplace().unit_m = one.unit_m;
        const auto page = look_sheet(sheet.job, sheet.shots, sheet.contents, Projection::third_angle, "");
        REQUIRE(page);
        // Front shows x and y, right z and y, top x and z; iso none.
        for (const char* text : {one.x, one.y, one.z}) {
            INFO(text);
            CHECK(places_of(*page, text, kSmallTextSize, kInk, kPaper) == 2);
        }
        for (const char* name : {"front", "right", "top", "iso"}) CHECK(places_of(*page, name, kTextSize, LetterStyle{}.color, kPage) == 1);
    }
}

TEST_CASE("sheet: third angle has the top above the front and the right on its right, first angle the opposite", "[look]") {
    Sheet sheet = sheet_of(box_scene({3, 2, 1}), 160, 120);
    // A colour for each view, in place of its picture: front red, right green, top blue, iso white.
    const std::array<std::array<std::uint8_t, 3>, 4> colors{{{200, 0, 0}, {0, 200, 0}, {0, 0, 200}, {200, 200, 200}}};
    for (ViewShot& shot : sheet.shots) {
        const std::size_t number = shot.name == "front" ? 0 : shot.name == "right" ? 1 : shot.name == "top" ? 2 : 3;
        for (std::size_t i = 0; i < shot.picture.rgba8.size(); ++i) shot.picture.rgba8[i] = i % 4 == 3 ? 255 : colors[number][i % 4];
    }
    const auto middle_of = [&](const Image& page, std::size_t number) {
        double x = 0, y = 0, count = 0;
        for (int row = 0; row < page.height; ++row)
            for (int column = 0; column < page.width; ++column) {
                const auto* p = &page.rgba8[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(page.width) +
                                                 static_cast<std::size_t>(column))];
                if (!std::equal(colors[number].begin(), colors[number].end(), p)) continue;
                x += column, y += row, count += 1;
            }
        REQUIRE(count > 1000);
        return Point{x / count, y / count};
    };
    for (const Projection projection : {Projection::third_angle, Projection::first_angle}) {
        const auto page = look_sheet(sheet.job, sheet.shots, sheet.contents, projection, "");
        REQUIRE(page);
        const Point front = middle_of(*page, 0), right = middle_of(*page, 1), top = middle_of(*page, 2);
        const double sign = projection == Projection::third_angle ? 1 : -1;
        CHECK(sign * (front.y - top.y) > 60);
        CHECK(std::abs(front.x - top.x) < 20);
        CHECK(sign * (right.x - front.x) > 80);
        CHECK(std::abs(right.y - front.y) < 20);
    }
}

TEST_CASE("sheet: views with a front make a drawing, of two as of seven", "[look]") {
    Sheet sheet = sheet_of(box_scene({3, 2, 1}), 160, 120);
    using Names = std::vector<std::string>;
    // Left to right and top to bottom; a dot has no view.
    struct Case {
        Names names, third, first;
        int columns;
    };
    const Case cases[] = {{{"front", "right"}, {"front", "right"}, {"right", "front"}, 2},
                          {{"top", "front"}, {"top", "front"}, {"front", "top"}, 1},
                          {{"front", "right", "top"}, {"top", ".", "front", "right"}, {"right", "front", ".", "top"}, 2},
                          {{"front", "back", "left", "bottom"},
                           {"left", "front", "back", ".", "bottom", "."},
                           {"bottom", ".", ".", "front", "left", "back"},
                           3},
                          {{"front", "right", "top", "iso", "left", "bottom", "back"},
                           {".", "top", "iso", ".", "left", "front", "right", "back", ".", "bottom", ".", "."},
                           {".", "bottom", ".", ".", "right", "front", "left", "back", "iso", "top", ".", "."},
                           4}};
    for (const Case& one : cases) {
        std::vector<ViewShot> shots;
        for (const std::string& name : one.names) {
            ViewShot& shot = shots.emplace_back(sheet.shots[0]);
            shot.name = name;
            const auto grey = static_cast<std::uint8_t>(100 + 10 * shots.size());
            for (std::size_t i = 0; i < shot.picture.rgba8.size(); ++i) shot.picture.rgba8[i] = i % 4 == 3 ? 255 : i % 4 == 1 ? 0 : grey;
        }
        const std::vector<ViewContent> contents(shots.size(), sheet.contents[0]);
        CHECK(make_drawing(one.names));
        for (const bool third : {true, false}) {
            const auto page = look_sheet(sheet.job, shots, contents, third ? Projection::third_angle : Projection::first_angle, "");
            REQUIRE(page);
            const Names& expected = third ? one.third : one.first;
            const int rows = static_cast<int>(expected.size()) / one.columns;
            CHECK(page->width == 8 + one.columns * 168);
            Names found;
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < one.columns; ++column) {
                    // A pixel of the picture's upper left part: no marks are there.
                    const int x = 8 + column * 168 + 20, y = 8 + row * ((page->height - 8) / rows) + 30;
                    const auto* p = &page->rgba8[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(page->width) +
                                                      static_cast<std::size_t>(x))];
                    found.push_back(p[1] == 0 ? one.names[static_cast<std::size_t>(p[0] - 110) / 10] : ".");
                }
            CHECK(found == expected);
        }
    }
    for (const Names& names : {Names{}, Names{"front"}, Names{"right", "top"}, Names{"front", "front"}, Names{"front", "30,20"}})
        CHECK_FALSE(make_drawing(names));
}

TEST_CASE("sheet: dimensions and axes leave the pixels of the model as they are", "[look]") {
    for (const Vec3d size : {Vec3d{3, 2, 1}, {1, 50, 1}, {50, 1, 1}, {20, 20, 0.01}, {1, 1, 50}})
        for (const int width : {200, 480}) {
            const Sheet sheet = sheet_of(box_scene(size), width, width * 5 / 6);
            for (std::size_t i = 0; i < sheet.shots.size(); ++i) {
                const ViewShot& shot = sheet.shots[i];
                const auto page = look_sheet(sheet.job, {&shot, 1}, {&sheet.contents[i], 1}, Projection::third_angle, "");
                REQUIRE(page);
                // The only cell: its picture lies where the page has room for it.
                const int left = (page->width - shot.width()) / 2, above = page->height - 8 - shot.height();
                int changed = 0;
                for (int y = 0; y < shot.height(); ++y)
                    for (int x = 0; x < shot.width(); ++x) {
                        const std::size_t at =
                            static_cast<std::size_t>(y) * static_cast<std::size_t>(shot.width()) + static_cast<std::size_t>(x);
                        if (shot.instance[at] == 0) continue;
                        const auto* drawn = &page->rgba8[4 * (static_cast<std::size_t>(y + above) * static_cast<std::size_t>(page->width) +
                                                              static_cast<std::size_t>(x + left))];
                        changed += std::equal(drawn, drawn + 4, &shot.picture.rgba8[4 * at]) ? 0 : 1;
                    }
                INFO(shot.name << " of " << size.x << " x " << size.y << " x " << size.z << ", " << width << " pixels");
                CHECK(changed == 0);
            }
        }
}
