// The caller's memory: formats, premultiplied alpha, strides and crops. Each picture is compared with the plain one, RGBA in one block.
#include "halflit/target.hpp"

#include "halflit/renderer.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

using namespace halflit;
using halflit::raster::test::NamedScene;
using halflit::test::available_isas;
using halflit::test::camera_flat;

namespace {

constexpr int kWidth = 97, kHeight = 61;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
constexpr float kInf = std::numeric_limits<float>::infinity();

using Bytes = std::vector<std::uint8_t>;

/// A small image of light, so that backgrounds differ from pixel to pixel.
std::shared_ptr<const Environment> environment() {
    EnvironmentImage image{16, 8, {}, false};
    for (int i = 0; i < 3 * 16 * 8; ++i) image.rgb.push_back(0.05f + 0.01f * static_cast<float>((i * 37) % 89));
    return make_environment(image, {.extract_suns = false, .keep_image = true}).value();
}

const std::vector<NamedScene>& scenes() {
    static const std::vector<NamedScene> made = [] {
        std::vector<NamedScene> list{raster::test::layers_scene(), raster::test::materials_scene()};
        for (NamedScene& s : list) s.scene.environment = environment();
        return list;
    }();
    return made;
}

struct Case {
    std::string name;
    const NamedScene* scene;
    Settings settings;
};

/// Every number of samples over a transparent, a half transparent and an opaque background, and an environment.
std::vector<Case> cases() {
    std::vector<Case> list;
    for (const NamedScene& s : scenes())
        for (const int samples : {1, 4, 8})
            for (int background = 0; background < 4; ++background) {
                Settings settings;
                settings.samples = samples;
                settings.shadow_size = 64;
                settings.background_linear = {0.7f, 0.2f, 0.05f, background == 0 ? 0.0f : background == 1 ? 0.4f : 1.0f};
                settings.background_environment = background == 3;
                list.push_back(
                    {s.name + ", samples " + std::to_string(samples) + ", background " + std::to_string(background), &s, settings});
            }
    return list;
}

struct Picture {
    Bytes codes;
    std::vector<float> linear;
};

Picture draw(const Case& c, Target target, const Execution& execution = {}) {
    Picture p{Bytes(4 * kPixels, 0xCD), std::vector<float>(4 * kPixels, -123.0f)};
    target.width = kWidth;
    target.height = kHeight;
    target.pixels = p.codes.data();
    target.linear = p.linear.data();
    const auto report = render(c.scene->scene, c.scene->camera, c.settings, target, execution);
    INFO((report ? std::string() : report.error().message));
    REQUIRE(report);
    return p;
}

Case first_case() { return cases()[1]; }

bool same_bytes(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }

/// Draws to the target of a small picture; the error's message, or "" if it is drawn.
std::string refusal(Target target, const Region& region = {}) {
    Settings settings;
    settings.region = region;
    target.width = target.width == 0 ? 8 : target.width;
    target.height = target.height == 0 ? 4 : target.height;
    const auto report = render(Scene{}, Camera{}, settings, target);
    if (report) return {};
    CHECK(report.error().code == ErrorCode::usage);
    CHECK(report.error().message.find('\n') == std::string::npos);
    CHECK(!report.error().message.empty());
    return report.error().message;
}

}  // namespace

TEST_CASE("target: BGRA is RGBA with red and blue exchanged", "[raster][target]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        const Picture rgba = draw(c, {}), bgra = draw(c, {.format = PixelFormat::bgra8});
        int differing = 0;
        for (std::size_t i = 0; i < 4 * kPixels; i += 4)
            differing += rgba.codes[i] != bgra.codes[i + 2] || rgba.codes[i + 1] != bgra.codes[i + 1] ||
                         rgba.codes[i + 2] != bgra.codes[i] || rgba.codes[i + 3] != bgra.codes[i + 3];
        CHECK(differing == 0);
        CHECK(same_bytes(rgba.linear.data(), bgra.linear.data(), 16 * kPixels));  // floats are RGBA in every format
    }
}

TEST_CASE("target: premultiplied colours are code times alpha and light times alpha", "[raster][target]") {
    std::size_t between = 0;  // codes with an alpha that is neither 0 nor 255
    for (const Case& c : cases()) {
        INFO(c.name);
        const Picture straight = draw(c, {}), premultiplied = draw(c, {.premultiplied = true});
        int wrong = 0;
        for (std::size_t i = 0; i < 4 * kPixels; i += 4) {
            const double alpha = straight.codes[i + 3];
            between += alpha > 0 && alpha < 255;
            for (std::size_t k = 0; k < 3; ++k) {
                const double product = straight.codes[i + k] * alpha, code = premultiplied.codes[i + k];
                wrong += code != std::floor((product + 127.0) / 255.0);
                wrong += !(std::fabs(code - product / 255.0) <= 0.5);  // so it is rounded
                wrong += !(code <= alpha);
                // One product, rounded once to float.
                wrong += double{premultiplied.linear[i + k]} !=
                         double{static_cast<float>(double{straight.linear[i + k]} * double{straight.linear[i + 3]})};
            }
            wrong += premultiplied.codes[i + 3] != straight.codes[i + 3] || premultiplied.linear[i + 3] != straight.linear[i + 3];
        }
        CHECK(wrong == 0);
    }
    CHECK(between > 10000);
}

TEST_CASE("target: premultiplied BGRA is both at once", "[raster][target]") {
    const Case c = first_case();
    const Picture rgba = draw(c, {.premultiplied = true}), bgra = draw(c, {.format = PixelFormat::bgra8, .premultiplied = true});
    int differing = 0;
    for (std::size_t i = 0; i < 4 * kPixels; ++i) differing += rgba.codes[i] != bgra.codes[i % 4 < 3 ? i + 2 - 2 * (i % 4) : i];
    CHECK(differing == 0);
}

TEST_CASE("target: infinite light under an alpha of 0 is 0 when premultiplied", "[raster][target]") {
    for (const int samples : {1, 4}) {
        Settings settings;
        settings.samples = samples;
        settings.background_linear = {kInf, 1, kInf, 0};
        std::vector<float> linear(4 * 16, -1.0f);
        Bytes codes(4 * 16, 0xCD);
        REQUIRE(render(Scene{}, Camera{}, settings,
                       {.width = 4, .height = 4, .pixels = codes.data(), .linear = linear.data(), .premultiplied = true}));
        CHECK(linear == std::vector<float>(4 * 16, 0.0f));
        CHECK(codes == Bytes(4 * 16, 0));
    }
}

TEST_CASE("target: an alpha of the background beyond 0 to 1 counts as the next of them", "[raster][target]") {
    for (const float alpha : {kInf, 3.0f, -kInf, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        Settings settings;
        settings.background_linear = {0.5f, 0.25f, 1, alpha};
        std::vector<float> linear(4 * 16, -1.0f);
        REQUIRE(render(Scene{}, Camera{}, settings, {.width = 4, .height = 4, .linear = linear.data(), .premultiplied = true}));
        const float a = alpha > 0 ? 1.0f : 0.0f;
        CHECK(std::vector<float>(linear.begin(), linear.begin() + 4) == std::vector<float>{0.5f * a, 0.25f * a, a, a});
    }
}

TEST_CASE("target: rows lie a stride apart, and nothing else is written", "[raster][target]") {
    constexpr std::size_t kGuard = 256;
    int drawn = 0;
    for (const Case& c : cases()) {
        if (c.scene != &scenes()[0]) continue;
        for (const std::size_t padding : {std::size_t{4}, std::size_t{252}, std::size_t{17}}) {
            INFO(c.name << ", padding " << padding);
            const Picture plain = draw(c, {});
            const std::size_t row = 4 * kWidth + padding, linear_row = 16 * kWidth + (padding + 3) / 4 * 4;
            Bytes codes(2 * kGuard + kHeight * row, 0xA5), linear(2 * kGuard + kHeight * linear_row, 0xA5);
            Target target{
                .width = kWidth, .height = kHeight, .pixels = codes.data() + kGuard, .row_bytes = row, .linear_row_bytes = linear_row};
            target.linear = reinterpret_cast<float*>(linear.data() + kGuard);
            REQUIRE(render(c.scene->scene, c.scene->camera, c.settings, target));
            const auto check = [&](const Bytes& memory, std::size_t stride, std::size_t pixel, const void* expected) {
                int wrong = 0;
                Bytes rest = memory;
                for (std::size_t y = 0; y < kHeight; ++y) {
                    const std::size_t at = kGuard + y * stride;
                    wrong += !same_bytes(&memory[at], static_cast<const std::uint8_t*>(expected) + y * pixel * kWidth, pixel * kWidth);
                    std::memset(&rest[at], 0xA5, pixel * kWidth);
                }
                CHECK(wrong == 0);
                CHECK(rest == Bytes(memory.size(), 0xA5));
            };
            check(codes, row, 4, plain.codes.data());
            check(linear, linear_row, 16, plain.linear.data());
            ++drawn;
        }
    }
    CHECK(drawn == 36);
}

TEST_CASE("target: pixels may begin at any byte", "[raster][target]") {
    const Case c = first_case();
    const Picture plain = draw(c, {});
    for (const std::size_t shift : {1, 2, 3}) {
        Bytes memory(4 * kPixels + 8 + kHeight, 0xA5);
        REQUIRE(render(c.scene->scene, c.scene->camera, c.settings,
                       {.width = kWidth, .height = kHeight, .pixels = memory.data() + shift, .row_bytes = 4 * kWidth + 1}));
        int wrong = 0;
        for (std::size_t y = 0; y < kHeight; ++y) {
            const std::size_t at = shift + y * (4 * kWidth + 1);
            wrong += !same_bytes(&memory[at], &plain.codes[y * 4 * kWidth], 4 * kWidth) || memory[at + 4 * kWidth] != 0xA5;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("target: a region alone holds the region's pixels of the whole picture", "[raster][target]") {
    constexpr std::size_t kGuard = 64;
    for (const Case& c : cases()) {
        const Picture whole = draw(c, {});
        for (const Region r :
             {Region{0, 0, 1, 1}, Region{96, 60, 1, 1}, Region{11, 7, 50, 33}, Region{0, 30, kWidth, 2}, Region{0, 0, 0, 0}})
            for (const std::size_t padding : {std::size_t{0}, std::size_t{8}}) {
                INFO(c.name << ", region " << r.x << "," << r.y << "," << r.width << "," << r.height << ", padding " << padding);
                Case part = c;
                part.settings.region = r;
                const Region full = r.width == 0 ? Region{0, 0, kWidth, kHeight} : r;
                const auto width = static_cast<std::size_t>(full.width), height = static_cast<std::size_t>(full.height);
                const std::size_t row = 4 * width + padding, linear_row = 16 * width + padding;
                Bytes codes(row * height + kGuard, 0xA5), linear(linear_row * height + kGuard, 0xA5);
                Target target{.width = kWidth, .height = kHeight, .pixels = codes.data(), .region_alone = true};
                target.linear = reinterpret_cast<float*>(linear.data());
                target.row_bytes = padding == 0 ? 0 : row;
                target.linear_row_bytes = padding == 0 ? 0 : linear_row;
                REQUIRE(render(c.scene->scene, c.scene->camera, part.settings, target));
                int wrong = 0;
                for (std::size_t y = 0; y < height; ++y) {
                    const std::size_t from = (static_cast<std::size_t>(full.y) + y) * kWidth + static_cast<std::size_t>(full.x);
                    wrong += !same_bytes(&codes[y * row], &whole.codes[4 * from], 4 * width);
                    wrong += !same_bytes(&linear[y * linear_row], &whole.linear[4 * from], 16 * width);
                    std::memset(&codes[y * row], 0xA5, 4 * width);
                    std::memset(&linear[y * linear_row], 0xA5, 16 * width);
                }
                CHECK(wrong == 0);
                CHECK(codes == Bytes(codes.size(), 0xA5));
                CHECK(linear == Bytes(linear.size(), 0xA5));
            }
    }
}

TEST_CASE("target: a crop without the transparent surfaces of the picture has its very bits", "[raster][target]") {
    // The left half shows a glass pane, the right half a wall of the colour -0, and the lower half nothing.
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].unlit = scene.materials[1].unlit = true;
    scene.materials[0].base_color = {1, 0, 0, 0.5f};
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[1].base_color = {-0.0f, -1e-40f, -2, 1};
    for (const int i : {0, 1}) {
        Mesh m;
        const float x = i == 0 ? -1.0f : 0.5f;
        m.positions = {{x, 0, 0}, {x + 0.5f, 0, 0}, {x + 0.5f, 1, 0}, {x, 1, 0}};
        m.indices = {0, 1, 2, 0, 2, 3};
        m.material = i;
        scene.meshes.push_back(m);
        scene.instances.push_back({i, {}});
    }
    for (const Vec4f background :
         {Vec4f{0.3f, 0.7f, 0.9f, 0.3f}, Vec4f{1, 2, 3, 0}, Vec4f{-0.0f, -0.0f, 0.1f, 1}, Vec4f{kInf, -1, 0.1f, 1e-3f}}) {
        Settings settings;
        settings.background_linear = background;
        std::vector<float> whole(4 * 64 * 64), part(4 * 20 * 64);
        Bytes codes(4 * 64 * 64), part_codes(4 * 20 * 64);
        REQUIRE(render(scene, camera_flat(), settings, {.width = 64, .height = 64, .pixels = codes.data(), .linear = whole.data()}));
        settings.region = {44, 0, 20, 64};
        REQUIRE(render(scene, camera_flat(), settings,
                       {.width = 64, .height = 64, .pixels = part_codes.data(), .linear = part.data(), .region_alone = true}));
        int wrong = 0;
        for (std::size_t y = 0; y < 64; ++y)
            wrong += !same_bytes(&whole[4 * (64 * y + 44)], &part[4 * 20 * y], 4 * 20 * sizeof(float)) ||
                     !same_bytes(&codes[4 * (64 * y + 44)], &part_codes[4 * 20 * y], 4 * 20);
        CHECK(wrong == 0);
    }
}

TEST_CASE("target: each output may be left out, and the others stay as they are", "[raster][target]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        const Picture both = draw(c, {});
        Bytes codes(4 * kPixels, 0xCD);
        std::vector<float> linear(4 * kPixels, -123.0f);
        REQUIRE(render(c.scene->scene, c.scene->camera, c.settings, {.width = kWidth, .height = kHeight, .pixels = codes.data()}));
        REQUIRE(render(c.scene->scene, c.scene->camera, c.settings, {.width = kWidth, .height = kHeight, .linear = linear.data()}));
        CHECK(codes == both.codes);
        CHECK(same_bytes(linear.data(), both.linear.data(), 16 * kPixels));
    }
    // A stride without memory is not looked at.
    CHECK(refusal({.row_bytes = 1, .linear_row_bytes = 3, .depth_row_bytes = 1}).empty());
}

TEST_CASE("target: memory that is not aligned is refused", "[raster][target]") {
    alignas(16) static std::uint8_t memory[4096];
    for (const std::size_t shift : {1, 2, 3}) {
        void* at = memory + shift;
        CHECK(refusal({.linear = static_cast<float*>(at)}).find("linear") != std::string::npos);
        CHECK(refusal({.depth = static_cast<float*>(at)}).find("depth") != std::string::npos);
        CHECK(refusal({.normal = static_cast<float*>(at)}).find("normal") != std::string::npos);
        CHECK(refusal({.instance = static_cast<std::uint32_t*>(at)}).find("instance") != std::string::npos);
        CHECK(refusal({.triangle = static_cast<std::uint32_t*>(at)}).find("triangle") != std::string::npos);
    }
    void* at = memory + 4;
    CHECK(refusal({.linear = static_cast<float*>(at)}).empty());
    CHECK(refusal({.normal = static_cast<float*>(at)}).empty());
}

TEST_CASE("target: strides that are not aligned, or smaller than a row, are refused", "[raster][target]") {
    alignas(16) static float floats[4096];
    static std::uint32_t numbers[4096];
    auto* bytes = reinterpret_cast<std::uint8_t*>(floats);
    // A picture of 8 pixels a row.
    for (const std::size_t row : {1, 4, 31}) CHECK(refusal({.pixels = bytes, .row_bytes = row}).find("pixels") != std::string::npos);
    for (const std::size_t row : {4, 124, 129, 130})
        CHECK(refusal({.linear = floats, .linear_row_bytes = row}).find("linear") != std::string::npos);
    for (const std::size_t row : {4, 28, 33}) CHECK(refusal({.depth = floats, .depth_row_bytes = row}).find("depth") != std::string::npos);
    for (const std::size_t row : {4, 92, 98})
        CHECK(refusal({.normal = floats, .normal_row_bytes = row}).find("normal") != std::string::npos);
    for (const std::size_t row : {4, 28, 35}) {
        CHECK(refusal({.instance = numbers, .instance_row_bytes = row}).find("instance") != std::string::npos);
        CHECK(refusal({.triangle = numbers, .triangle_row_bytes = row}).find("triangle") != std::string::npos);
    }
    CHECK(refusal({.pixels = bytes, .row_bytes = 32}).empty());
    CHECK(refusal({.pixels = bytes, .row_bytes = 33}).empty());
    CHECK(refusal({.linear = floats, .linear_row_bytes = 132}).empty());
    CHECK(refusal({.normal = floats, .normal_row_bytes = 96}).empty());
    // A region alone needs its own width only; without that flag the whole picture's.
    CHECK(refusal({.pixels = bytes, .region_alone = true, .row_bytes = 12}, {1, 1, 3, 2}).empty());
    CHECK(!refusal({.pixels = bytes, .region_alone = true, .row_bytes = 11}, {1, 1, 3, 2}).empty());
    CHECK(!refusal({.pixels = bytes, .row_bytes = 12}, {1, 1, 3, 2}).empty());
    CHECK(!refusal({.pixels = bytes, .region_alone = true, .row_bytes = 12}).empty());
}

TEST_CASE("target: a pixel format that does not exist is refused", "[raster][target]") {
    std::uint8_t pixels[4 * 32] = {};
    CHECK(!refusal({.pixels = pixels, .format = static_cast<PixelFormat>(7)}).empty());
}

TEST_CASE("target: every format has the same bytes by every instruction set, tile size and number of threads", "[raster][target]") {
    for (const Case& c : cases()) {
        if (c.scene != &scenes()[0] || c.settings.samples == 8) continue;
        const Target target{.format = PixelFormat::bgra8, .premultiplied = true};
        const Picture first = draw(c, target, {.threads = 1, .tile_size = 64, .isa = Isa::scalar});
        int tile = 16, threads = 1;
        for (const Isa isa : available_isas())
            for (int i = 0; i < 2; ++i) {
                INFO(c.name << ", " << isa_name(isa) << ", tile " << tile << ", threads " << threads);
                const Picture p = draw(c, target, {.threads = threads, .tile_size = tile, .isa = isa});
                CHECK(p.codes == first.codes);
                CHECK(same_bytes(p.linear.data(), first.linear.data(), 16 * kPixels));
                tile = tile == 64 ? 16 : 2 * tile;
                threads = threads % 3 + 1;
            }
    }
}

TEST_CASE("target: a stride that a negative number became is refused", "[raster][target]") {
    const Scene scene = demo_scene();
    std::vector<std::uint8_t> pixels(std::size_t{4} * 8 * 8);
    Target target{8, 8, pixels.data()};
    for (const long stride : {-1L, -32L, -4096L}) {
        target.row_bytes = static_cast<std::size_t>(stride);
        const auto report = render(scene, scene.cameras[0], {}, target);
        REQUIRE_FALSE(report);
        CHECK(report.error().code == ErrorCode::usage);
    }
}

TEST_CASE("target: a picture makes its own memory, and gives what is not empty of it", "[raster][target]") {
    Image image = Image::make(7, 5);
    CHECK(image.rgba8 == std::vector<std::uint8_t>(7 * 5 * 4, 0));
    CHECK(image.target().width == 7);
    CHECK(image.target().height == 5);
    CHECK(image.target().pixels == image.rgba8.data());
    CHECK(image.target().linear == nullptr);
    image.rgba_linear.resize(image.rgba8.size());
    image.rgba8.clear();
    CHECK(image.target().pixels == nullptr);
    CHECK(image.target().linear == image.rgba_linear.data());
    for (const int side : {0, -1, -2147483647 - 1}) CHECK(Image::make(side, 4).rgba8.empty());
}
