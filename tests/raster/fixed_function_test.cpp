// Fixed-function pictures: against OpenGL's formulas in float64, against whole shadow maps, and against themselves.
#include "halflit/fixed_function.hpp"
#include "halflit/shapes.hpp"
#include "raster/detail/executor.hpp"
#include "raster/fixed/projection.hpp"
#include "raster/fixed/shadow_lookups.hpp"
#include "raster/passes/tile.hpp"
#include "sh/mat4.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

using namespace halflit;
using halflit::test::Random;

namespace {

constexpr int kSide = 64;

struct Drawn {
    std::vector<std::uint8_t> rgb;
    std::vector<float> depth;
    std::vector<std::uint32_t> ids;
    [[nodiscard]] int code(int x, int y, int c) const { return rgb[static_cast<std::size_t>(3 * (y * kSide + x) + c)]; }
    [[nodiscard]] std::uint32_t id(int x, int y) const { return ids[static_cast<std::size_t>(y * kSide + x)]; }
    friend bool operator==(const Drawn&, const Drawn&) = default;
};

Drawn draw(FixedFunctionRenderer& renderer, const FixedFrame& frame, const Execution& execution = {}, int samples = 1) {
    const std::size_t pixels = std::size_t{kSide} * kSide;
    Drawn out{std::vector<std::uint8_t>(3 * pixels), std::vector<float>(pixels), std::vector<std::uint32_t>(pixels)};
    FixedTarget target{kSide, kSide, samples};
    target.rgb = out.rgb.data(), target.depth = out.depth.data(), target.ids = out.ids.data();
    const auto ok = renderer.render(frame, target, execution);
    REQUIRE(ok);
    return out;
}

CodeTexture texture(Random& random, int width, int height, bool cube) {
    CodeTexture made{width, height, cube, false, {}};
    made.rgb.resize(std::size_t{3} * static_cast<std::size_t>(width * height) * (cube ? 6 : 1));
    for (std::uint8_t& code : made.rgb) code = static_cast<std::uint8_t>(random.real32(0.0f, 255.9f));
    return made;
}

Vec3f direction(Random& random) { return {random.real32(-1.0f, 1.0f), random.real32(-1.0f, 1.0f), random.real32(-1.0f, 1.0f)}; }

std::vector<Mesh> meshes() { return {make_sphere(1.0f, 12, 8), make_box({1, 1, 1})}; }

/// Spheres and boxes of all kinds in front of a camera, under some lights.
FixedFrame random_frame(Random& random, int textures) {
    FixedFrame frame;
    frame.camera = {{0, 0, 4}, {0, 0, -1}, {0, 1, 0}, false, -0.5f, 0.5f, -0.5f, 0.5f, 1.0f, 20.0f};
    frame.eye_ws = frame.camera.position_ws;
    for (std::uint32_t i = 0; i < 6; ++i) {
        FixedItem item;
        item.mesh = random.real32(0.0f, 1.0f) < 0.5f ? 0 : 1;
        const float size = random.real32(0.3f, 0.8f);
        item.world_from_object.c[0] = {size * random.real32(0.5f, 1.5f), 0, 0, 0};
        item.world_from_object.c[1] = {0, size * 0.8f, size * 0.6f, 0};
        item.world_from_object.c[2] = {0, -size * 0.6f, size * 0.8f, 0};
        const Vec3f at = direction(random) * 1.2f;
        item.world_from_object.c[3] = {at.x, at.y, at.z, 1};
        FixedMaterial& material = item.material;
        material.color = {random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 1};
        material.emission = {0.05f, 0, random.real32(0, 0.2f)};
        material.specular = random.real32(0, 1);
        material.shininess = random.real32(0, 128);
        material.texture = static_cast<int>(random.real32(0.0f, static_cast<float>(textures) + 0.99f)) - 1;
        material.generated = true;
        for (Vec4f& plane : material.planes)
            plane = {random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        item.id = i + 1;
        frame.items.push_back(item);
    }
    for (int i = 0; i < 3; ++i) {
        FixedLight light;
        light.directional = i == 0;
        light.position_ws = direction(random) * 4.0f;
        light.direction_ws = light.position_ws * -1.0f;
        light.ambient = {0.02f, 0.05f, 0};
        light.diffuse = {random.real32(0, 0.5f), random.real32(0, 0.5f), random.real32(0, 0.5f)};
        light.specular = {random.real32(0, 0.5f), 0.1f, 0};
        if (i == 2) light.cutoff_deg = 40, light.exponent = 3, light.attenuation[1] = 0.1f, light.attenuation[2] = 0.05f;
        frame.lights.push_back(light);
    }
    return frame;
}

// ---- the same in float64 ----------------------------------------------------------------------------------------------------------

Vec3d wide(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) {
    const double length = std::sqrt(dot(v, v));
    return length > 0 ? v * (1 / length) : v;
}
Vec3d placed(const Mat4& m, Vec3f p) { return axis(m, 0) * double{p.x} + axis(m, 1) * double{p.y} + axis(m, 2) * double{p.z} + axis(m, 3); }

Vec3d lit(const FixedFrame& frame, const FixedMaterial& material, Vec3d p, Vec3d n) {
    const Vec3d color{material.color.x, material.color.y, material.color.z}, to_eye = unit(wide(frame.eye_ws) - p);
    Vec3d sum = wide(material.emission) + color * double{frame.ambient};
    for (const FixedLight& light : frame.lights) {
        const Vec3d along = unit(wide(light.direction_ws));
        Vec3d to_light = along * -1.0;
        double strength = 1;
        if (!light.directional) {
            const Vec3d way = wide(light.position_ws) - p;
            const double d = std::sqrt(dot(way, way));
            to_light = way * (1 / d);
            strength = 1 / (light.attenuation[0] + light.attenuation[1] * d + light.attenuation[2] * d * d);
            const double cosine = -dot(to_light, along);
            if (light.cutoff_deg <= 90)
                strength *= cosine >= std::cos(light.cutoff_deg * 3.14159265358979 / 180) ? std::pow(cosine, light.exponent) : 0;
        }
        const double facing = dot(n, to_light), half = std::max(0.0, dot(n, unit(to_light + to_eye)));
        const double highlight = facing > 0 ? std::pow(half, material.shininess) * material.specular : 0;
        const auto add = [&](double& to, float ambient, float diffuse, float specular, double of) {
            to += strength * (ambient * of + std::max(0.0, facing) * diffuse * of + highlight * specular);
        };
        add(sum.x, light.ambient.x, light.diffuse.x, light.specular.x, color.x);
        add(sum.y, light.ambient.y, light.diffuse.y, light.specular.y, color.y);
        add(sum.z, light.ambient.z, light.diffuse.z, light.specular.z, color.z);
    }
    const auto held = [](double x) { return std::clamp(x, 0.0, 1.0); };
    return {held(sum.x), held(sum.y), held(sum.z)};
}

/// The nearest front face on a ray: light of its corners between them.
struct Hit {
    double distance = 1e300;
    const FixedItem* item = nullptr;
    Vec3d color;
};
Hit hit(const FixedFrame& frame, const std::vector<Mesh>& shapes, Vec3d ray) {
    Hit nearest;
    const Vec3d eye = wide(frame.camera.position_ws);
    for (const FixedItem& item : frame.items) {
        const Mesh& mesh = shapes[static_cast<std::size_t>(item.mesh)];
        const NormalMatrix normal = normal_matrix(item.world_from_object);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            Vec3d p[3];
            for (std::size_t k = 0; k < 3; ++k) p[k] = placed(item.world_from_object, mesh.positions[mesh.indices[i + k]]) - eye;
            const double volume = dot(ray, cross(p[1] - p[0], p[2] - p[0]));
            if (!(volume < 0)) continue;
            double weight[3], least = 1;
            for (std::size_t k = 0; k < 3; ++k) {
                weight[k] = dot(ray, cross(p[(k + 1) % 3], p[(k + 2) % 3])) / volume;
                least = std::min(least, weight[k]);
            }
            const double distance = dot(p[0], cross(p[1] - p[0], p[2] - p[0])) / volume;
            if (least < 0 || distance > nearest.distance) continue;
            nearest = {distance, &item, {}};
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f n = mesh.normals[mesh.indices[i + k]];
                const Vec3d turned = wide(normal.c[0]) * double{n.x} + wide(normal.c[1]) * double{n.y} + wide(normal.c[2]) * double{n.z};
                nearest.color = nearest.color + lit(frame, item.material, p[k] + eye, unit(turned)) * weight[k];
            }
        }
    }
    return nearest;
}

Vec3d ray_of(const FixedCamera& camera, double x, double y) {
    const double u = (x + 0.5) / kSide, v = (y + 0.5) / kSide;
    return {camera.left + u * (camera.right - camera.left), camera.top + v * (camera.bottom - camera.top), -camera.near_z};
}

}  // namespace

TEST_CASE("fixed function: light at vertices is OpenGL's formula in float64", "[fixed]") {
    Random random(5);
    const std::vector<Mesh> shapes = meshes();
    auto renderer = FixedFunctionRenderer::make(shapes, {});
    REQUIRE(renderer);
    int compared = 0, apart = 0;
    for (int round = 0; round < 10; ++round) {
        const FixedFrame frame = random_frame(random, 0);
        const Drawn drawn = draw(*renderer, frame);
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Hit expected = hit(frame, shapes, ray_of(frame.camera, x, y));
                ++compared;
                if (drawn.id(x, y) != (expected.item == nullptr ? 0 : expected.item->id)) {
                    ++apart;  // the ray passes within 1/256 pixel of an edge
                    continue;
                }
                if (expected.item == nullptr) continue;
                const double codes[3] = {255 * expected.color.x, 255 * expected.color.y, 255 * expected.color.z};
                for (int c = 0; c < 3; ++c) {
                    CAPTURE(round, x, y, c);
                    CHECK(std::abs(drawn.code(x, y, c) - codes[c]) < 0.75);  // half a code, and corners on the window's grid
                }
                const double depth = (20 / (expected.distance * 1) - 1) / 19;  // the ray is 1 long along the view
                CHECK(std::abs(drawn.depth[static_cast<std::size_t>(y * kSide + x)] - depth) < 2e-3);
            }
    }
    CHECK(compared == 10 * kSide * kSide);
    CHECK(apart < compared / 500);
}

TEST_CASE("fixed function: all instruction sets, numbers of threads and rows from below give the same pixels", "[fixed]") {
    Random random(7);
    std::vector<CodeTexture> textures;
    textures.push_back(texture(random, 32, 16, false));
    textures.push_back(texture(random, 16, 16, true));
    textures.push_back(texture(random, 7, 5, false));
    auto renderer = FixedFunctionRenderer::make(meshes(), textures);
    REQUIRE(renderer);
    for (int round = 0; round < 6; ++round) {
        FixedFrame frame = random_frame(random, 3);
        for (std::size_t i = 0; i < 3; ++i) frame.lights[i].shadow_size = i == 1 ? 0 : 512, frame.lights[i].shadow_half_width = 3;
        frame.items[4].stage = frame.items[5].stage = FixedStage::transparent;
        frame.items[4].material.color.w = frame.items[5].material.color.w = 0.4f;
        frame.items[0].mirrors = true;
        frame.has_mirror = true;
        frame.mirror = {{0, -0.2f, 0}, {0, 1, 0}, 0.5f};
        frame.fog_start = 2, frame.fog_end = 9, frame.fog_color = {0.4f, 0.5f, 0.6f};
        for (const int samples : {1, 4}) {
            Execution alone;
            alone.threads = 1;
            alone.isa = Isa::scalar;
            const Drawn expected = draw(*renderer, frame, alone, samples);
            for (const Isa isa : test::available_isas())
                for (const int threads : {1, 3}) {
                    Execution execution;
                    execution.isa = isa, execution.threads = threads;
                    CHECK((draw(*renderer, frame, execution, samples) == expected));
                }
            auto other = renderer->copy();
            REQUIRE(other);
            CHECK((draw(*other, frame, {}, samples) == expected));
        }
    }
}

TEST_CASE("fixed function: what a light's map hides is what the whole map shows", "[fixed]") {
    using namespace halflit::raster;
    Random random(11);
    const RasterKernels& kernels = raster_kernels(test::available_isas().back());
    for (int round = 0; round < 8; ++round) {
        Scene scene;
        scene.meshes = meshes();
        scene.materials.resize(1);
        const FixedFrame frame = random_frame(random, 0);
        for (const FixedItem& item : frame.items) scene.instances.push_back({item.mesh, item.world_from_object, 0});
        const auto prepared = PreparedData::make_for_geometry(scene);
        REQUIRE(prepared);
        FixedLight light = frame.lights[round % 2 == 0 ? 0 : 2];
        light.shadow_size = 200;
        light.shadow_half_width = 2.5f;
        light.shadow_fov_deg = 70;
        light.shadow_near = 0.5f, light.shadow_far = 12;
        const ShadowRule rule{round < 4, 0, 0};
        const LightMap map(light);
        Executor executor;
        executor.configure({});
        std::vector<ShadowLookup> asked;
        for (int i = 0; i < 3000; ++i)
            asked.push_back(
                {0, 0, {static_cast<int>(random.real32(0, 199.9f)), static_cast<int>(random.real32(0, 199.9f)), random.real32(0, 1), 0}});
        const std::span<ShadowLookup> groups[] = {std::span(asked).first(1000), std::span(asked).subspan(1000)};
        LightOcclusion occlusion;
        REQUIRE(occlusion.find(*prepared, map, rule, groups, kernels, executor));

        View view = map.view();
        view.mirrored = rule.back_faces_alone;
        ViewGeometry whole;
        REQUIRE(whole.make(*prepared, view, kernels, executor));
        std::vector<float> depth(200 * 200);
        const auto scratch = std::make_unique<TileScratch>();
        for (int tile = 0; tile < view.tile_count(); ++tile) {
            draw_opaque(whole, kernels, executor.stop(), tile, *scratch);
            const TileRect rect = view.tile_rect(tile);
            for (int y = 0; y < rect.height; ++y)
                for (int x = 0; x < rect.width; ++x)
                    depth[static_cast<std::size_t>((rect.y + y) * 200 + rect.x + x)] = scratch->buffers.depth[0][y * kTileStride + x];
        }
        int hidden = 0;
        for (const auto& [fragment, code, at] : asked) {
            const bool expected = depth[static_cast<std::size_t>(at.y * 200 + at.x)] > at.z;
            CHECK((at.hidden != 0) == expected);
            hidden += expected ? 1 : 0;
        }
        CHECK(hidden > 25);
        CHECK(hidden < 2975);
    }
}

TEST_CASE("fixed function: a mirror adds the picture of the mirrored scene", "[fixed]") {
    Random random(13);
    std::vector<Mesh> shapes = meshes();
    shapes.push_back(make_plane(8.0f, 8));
    auto renderer = FixedFunctionRenderer::make(shapes, {});
    REQUIRE(renderer);
    FixedFrame frame = random_frame(random, 0);
    for (FixedItem& item : frame.items) item.world_from_object.c[3].y += 1.6f;
    frame.camera.position_ws = frame.eye_ws = {0, 1.5f, 5};
    FixedItem floor;
    floor.mesh = 2;
    floor.id = 100;
    floor.mirrors = true;
    floor.material.color = {0.3f, 0.2f, 0.1f, 1};
    frame.items.push_back(floor);
    frame.has_mirror = true;
    frame.mirror = {{0, 0, 0}, {0, 1, 0}, 0.6f};
    const Drawn with = draw(*renderer, frame);

    FixedFrame without = frame;
    without.has_mirror = false;
    const Drawn plain = draw(*renderer, without);
    FixedFrame below = without;
    below.items.pop_back();
    const auto reflect = [](Vec3f v) { return Vec3f{v.x, -v.y, v.z}; };
    for (FixedItem& item : below.items) {
        for (Vec4f& column : item.world_from_object.c) column.y = -column.y;
        item.material.color = {item.material.color.x * 0.6f, item.material.color.y * 0.6f, item.material.color.z * 0.6f, 1};
        item.material.emission = item.material.emission * 0.6f;
    }
    for (FixedLight& light : below.lights) light.position_ws = reflect(light.position_ws), light.direction_ws = reflect(light.direction_ws);
    const Drawn reflected = draw(*renderer, below);
    int seen = 0, apart = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const bool on_floor = plain.id(x, y) == 100;
            seen += on_floor && reflected.id(x, y) != 0 ? 1 : 0;
            for (int c = 0; c < 3; ++c) {
                const int expected = std::min(255, plain.code(x, y, c) + (on_floor ? reflected.code(x, y, c) : 0));
                apart += std::abs(with.code(x, y, c) - expected) > 1 ? 1 : 0;
            }
        }
    CHECK(seen > 300);
    CHECK(apart <= 3 * 4);  // corners are rounded to the window's grid from other matrices
}

TEST_CASE("fixed function: transparent items are blended from front to back, and once more from back to front", "[fixed]") {
    auto renderer = FixedFunctionRenderer::make({make_plane(4.0f, 1)}, {});
    REQUIRE(renderer);
    FixedFrame frame;
    frame.camera = {{0, 5, 0}, {0, -1, 0}, {0, 0, -1}, false, -0.1f, 0.1f, -0.1f, 0.1f, 1.0f, 20.0f};
    frame.ambient = 1;
    const auto pane = [&](float height, Vec4f color, std::uint32_t id, FixedStage stage) {
        FixedItem item;
        item.world_from_object.c[3] = {0, height, 0, 1};
        item.material.color = color;
        item.id = id;
        item.stage = stage;
        frame.items.push_back(item);
    };
    pane(0, {0.2f, 0.4f, 0.6f, 1}, 1, FixedStage::solid);
    pane(2, {1, 0, 0, 0.25f}, 2, FixedStage::transparent);
    pane(1, {0, 1, 0, 0.5f}, 3, FixedStage::transparent);
    const Drawn drawn = draw(*renderer, frame);
    double expected[3] = {0.2, 0.4, 0.6};
    for (const int pass : {2, 3, 3, 2}) {
        const double alpha = pass == 2 ? 0.25 : 0.5;
        for (int c = 0; c < 3; ++c) expected[c] = (c == pass - 2 ? alpha : 0) + expected[c] * (1 - alpha);
    }
    for (int c = 0; c < 3; ++c) CHECK(std::abs(drawn.code(32, 32, c) - 255 * expected[c]) < 2.5);
    CHECK(drawn.id(32, 32) == 2);
}

TEST_CASE("fixed function: textures are filtered between texels and levels, and cubes have no seams", "[fixed]") {
    // A cube whose texels are a linear function of direction: between faces it stays smooth.
    CodeTexture cube{32, 32, true, false, {}};
    const auto face_direction = [](int face, double s, double t) -> Vec3d {
        const Vec3d of[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
        return unit(of[face]);
    };
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                const Vec3d d = face_direction(face, (x + 0.5) / 16 - 1, (y + 0.5) / 16 - 1);
                for (const double v : {d.x, d.y, d.z}) cube.rgb.push_back(static_cast<std::uint8_t>(std::lround(127.5 + 127 * v)));
            }
    auto renderer = FixedFunctionRenderer::make({make_sphere(1.0f, 160, 120)}, {cube});
    REQUIRE(renderer);
    FixedFrame frame;
    frame.camera = {{1.6f, 1.8f, 2.0f}, {-1.6f, -1.8f, -2.0f}, {0, 1, 0}, false, -0.35f, 0.35f, -0.35f, 0.35f, 1.0f, 20.0f};
    frame.ambient = 1;
    FixedItem item;
    item.id = 1;
    item.material.color = {1, 1, 1, 1};
    item.material.texture = 0;
    item.material.generated = true;
    item.material.planes[0] = {1, 0, 0, 0}, item.material.planes[1] = {0, 1, 0, 0}, item.material.planes[2] = {0, 0, 1, 0};
    frame.items.push_back(item);
    const Drawn drawn = draw(*renderer, frame);
    int compared = 0;
    const Vec3d eye = wide(frame.camera.position_ws), ahead = unit(wide(frame.camera.forward_ws)),
                right = unit(cross(ahead, Vec3d{0, 1, 0})), up = cross(right, ahead);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double u = -0.35 + 0.7 * (x + 0.5) / kSide, v = 0.35 - 0.7 * (y + 0.5) / kSide;
            const Vec3d ray = ahead + right * u + up * v;
            const double a = dot(ray, ray), b = dot(eye, ray), root = b * b - a * (dot(eye, eye) - 1);
            if (root < 0.05 || drawn.id(x, y) == 0) continue;
            const Vec3d p = unit(eye + ray * ((-b - std::sqrt(root)) / a));
            ++compared;
            const double expected[3] = {127.5 + 127 * p.x, 127.5 + 127 * p.y, 127.5 + 127 * p.z};
            for (int c = 0; c < 3; ++c) CHECK(std::abs(drawn.code(x, y, c) - expected[c]) < 2.0);
        }
    CHECK(compared > 800);
}

TEST_CASE("fixed function: what is out of range is refused", "[fixed]") {
    CHECK_FALSE(FixedFunctionRenderer::make(meshes(), {{4, 4, false, false, {1, 2, 3}}}));
    CHECK_FALSE(FixedFunctionRenderer::make(meshes(), {{4, 2, true, false, std::vector<std::uint8_t>(144)}}));
    Mesh broken = make_box({1, 1, 1});
    broken.indices[3] = 1000;
    CHECK_FALSE(FixedFunctionRenderer::make({broken}, {}));
    auto renderer = FixedFunctionRenderer::make(meshes(), {});
    REQUIRE(renderer);
    Random random(1);
    const FixedFrame good = random_frame(random, 0);
    std::vector<std::uint8_t> rgb(3 * kSide * kSide);
    FixedTarget target{kSide, kSide};
    target.rgb = rgb.data();
    const auto refused = [&](const auto& change) {
        FixedFrame frame = good;
        FixedTarget to = target;
        change(frame, to);
        return !renderer->render(frame, to);
    };
    CHECK_FALSE(refused([](FixedFrame&, FixedTarget&) {}));
    CHECK(refused([](FixedFrame& frame, FixedTarget&) { frame.items[0].mesh = 2; }));
    CHECK(refused([](FixedFrame& frame, FixedTarget&) { frame.items[0].material.texture = 0; }));
    CHECK(refused([](FixedFrame& frame, FixedTarget&) { frame.lights[0].shadow_size = 1 << 20; }));
    CHECK(refused([](FixedFrame& frame, FixedTarget&) { frame.camera.near_z = std::nanf(""); }));
    CHECK(refused([](FixedFrame&, FixedTarget& to) { to.samples = 3; }));
    CHECK(refused([](FixedFrame&, FixedTarget& to) { to.width = 0; }));
    CHECK_FALSE(renderer->set_vertices(0, {}, {}));
    // Numbers that are not finite are drawn as nothing.
    CHECK_FALSE(refused([](FixedFrame& frame, FixedTarget&) {
        frame.items[0].world_from_object.c[3].x = std::nanf("");
        frame.lights[0].position_ws.x = frame.lights[1].direction_ws.y = INFINITY;
        frame.lights[2].shadow_size = 64;
        frame.lights[2].direction_ws = {0, 0, 0};
    }));
}
