// Surfaces of different materials in one plane: decals, logos and coats of paint on the vertices of what they lie on.
#include "halflit/shapes.hpp"
#include "raster/scene/prepared_data.hpp"
#include "tests/raster/metamorphic_scene.hpp"
#include "tests/raster/visibility_reference.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::camera_at;
using halflit::test::camera_flat;

namespace {

Material unlit(Vec4f color, AlphaMode mode = AlphaMode::opaque) {
    Material material;
    material.unlit = true;
    material.base_color = color;
    material.alpha_mode = mode;
    return material;
}

constexpr Vec4f kBlue{0, 0, 1, 1}, kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1};

/// A plane in space: points of it are rounded to float32 as those of a file are.
struct Frame {
    Vec3f origin, u, v;
    [[nodiscard]] Vec3f at(float x, float y) const { return origin + u * x + v * y; }
};

Frame random_frame(Random& random) {
    const Mat4 turn = random_rotation(random);
    return {random_point(random, 0.8), transform_vector(turn, {1, 0, 0}), transform_vector(turn, {0, 1, 0})};
}

void add_quad(Mesh& mesh, const std::array<Vec3f, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
}

/// A rectangle of cells x cells quads, turned in its plane.
Mesh rectangle(const Frame& frame, Vec2f middle, float half, float turn_rad, int cells, int material) {
    Mesh mesh;
    mesh.material = material;
    const float c = std::cos(turn_rad), s = std::sin(turn_rad);
    const auto at = [&](int i, int j) {
        const float x = half * (2.0f * static_cast<float>(i) / static_cast<float>(cells) - 1.0f),
                    y = half * (2.0f * static_cast<float>(j) / static_cast<float>(cells) - 1.0f);
        return frame.at(middle.x + c * x - s * y, middle.y + s * x + c * y);
    };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) add_quad(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

void place(Scene& scene, Mesh mesh) {
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), {}});
    scene.meshes.push_back(std::move(mesh));
}

std::array<float, 4> linear_at(const Pixels& pixels, int x, int y) {
    std::array<float, 4> out{};
    std::copy_n(pixels.linear.begin() + 4 * (y * kViewWidth + x), 4, out.begin());
    return out;
}

/// Numbers of pixels by their colour, without those at the border of a shape.
int count(const Pixels& pixels, Vec3f color) {
    int n = 0;
    for (std::size_t i = 0; i < pixels.depth.size(); ++i)
        n += std::abs(pixels.linear[4 * i] - color.x) < 1e-5f && std::abs(pixels.linear[4 * i + 1] - color.y) < 1e-5f &&
             std::abs(pixels.linear[4 * i + 2] - color.z) < 1e-5f;
    return n;
}

Settings plain(int samples = 1) {
    Settings settings;
    settings.samples = samples;
    settings.background_linear = {0, 0, 0, 1};
    settings.shadows = ShadowMode::off;
    return settings;
}

PreparedData prepared(const Scene& scene) {
    auto data = PreparedData::make(scene);
    REQUIRE(data);
    return std::move(*data);
}

/// A wall in a random plane with a decal of another tessellation, or of its own vertices, for each mode.
Shot decals(Random& random) {
    Shot shot;
    Scene& scene = shot.scene;
    scene.textures = {random_texture(random, ColorSpace::srgb)};
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend, AlphaMode::blend}) {
        const Vec4f color{random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 0.6f};
        Material& material = scene.materials.emplace_back(unlit(color, mode));
        material.double_sided = true;
        if (mode == AlphaMode::mask) material.textures[TextureSlot::base_color].texture = 0, material.alpha_cutoff = 0.3f;
    }
    for (int plane = 0; plane < 3; ++plane) {
        const Frame frame = random_frame(random);
        for (int m = 0; m < 5; ++m)
            place(scene, rectangle(frame, {random.real32(-0.3, 0.3), random.real32(-0.3, 0.3)}, random.real32(0.3, 0.9),
                                   random.real32(0, 3), random.index(6) + 1, m));
    }
    for (Mesh& mesh : scene.meshes)
        for (const Vec3f p : mesh.positions) mesh.uv0.push_back({p.x + p.z, p.y - p.z}), mesh.normals.push_back({0, 1, 0});
    shot.camera = camera_at(normalize_or(random_point(random, 1), {0, 0, 1}) * 4.0f, {0, 0, 0}, 0.8f);
    return shot;
}

}  // namespace

TEST_CASE("coplanar: in random planes the later material is seen, as in the float64 reference", "[raster][coplanar]") {
    Comparison sum;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        Scene scene;
        for (int m = 0; m < 5; ++m) scene.materials.push_back(unlit(kRed)), scene.materials.back().double_sided = true;
        for (int plane = 0; plane < 3; ++plane) {
            const Frame frame = random_frame(random);
            const int first = random.index(5), step = 1 + random.index(4);
            for (int m = 0; m < 4; ++m)
                place(scene, rectangle(frame, {random.real32(-0.4, 0.4), random.real32(-0.4, 0.4)}, random.real32(0.3, 0.9),
                                       random.real32(0, 3), random.index(5) + 1, (first + step * m) % 5));
        }
        const Camera camera = camera_at(normalize_or(random_point(random, 1), {0, 0, 1}) * 4.0f, {0, 0, 0}, 0.8f);
        const auto view = visibility(scene, camera, {}, kViewWidth, kViewHeight);
        REQUIRE(view);
        const Comparison one =
            compare_visibility(*view, {0, 0, kViewWidth, kViewHeight}, reference_triangles(scene, camera, kViewWidth, kViewHeight));
        INFO("seed " << seed);
        CHECK(one.wrong == 0);
        CHECK(one.wrong_depth == 0);
        sum.pixels += one.pixels, sum.covered += one.covered, sum.undecided += one.undecided, sum.coplanar += one.coplanar;
    }
    INFO("compared " << sum.pixels << ", covered " << sum.covered << ", coplanar " << sum.coplanar << ", undecided " << sum.undecided);
    CHECK(sum.coplanar > sum.covered / 4);
    CHECK(sum.undecided_share() < 0.1);  // pixels at edges
}

TEST_CASE("coplanar: a layer with the vertices of a surface is blended over it, whichever is listed first", "[raster][coplanar]") {
    for (const int samples : {1, 4}) {
        for (const bool layer_first : {false, true}) {
            Shot shot;
            shot.settings = plain(samples);
            shot.scene.materials = {unlit(kBlue), unlit({1, 0, 0, 0.5f}, AlphaMode::blend)};
            shot.scene.meshes = {make_sphere_of(1.0f, 900)};
            for (const int material : {layer_first ? 1 : 0, layer_first ? 0 : 1}) {
                shot.scene.instances.push_back({0, {}});
                shot.scene.instances.back().material = material;
            }
            shot.camera = camera_at({0.3f, 0.5f, 4.0f}, {0, 0, 0}, 0.6f);
            const Pixels both = draw(shot);
            CHECK(count(both, {0.5f, 0, 0.5f}) > 2000);
            CHECK(count(both, {0, 0, 1}) == 0);
        }
    }
}

TEST_CASE("coplanar: of opaque surfaces with equal vertices the material that is used last is drawn", "[raster][coplanar]") {
    for (const bool red_first : {false, true}) {
        Shot shot;
        shot.settings = plain();
        shot.scene.materials = {unlit(kBlue), unlit(kRed)};
        shot.scene.meshes = {make_sphere_of(1.0f, 900)};
        // The first material comes once more, at the end: its first use counts.
        for (const int turn : {0, 1, 0}) {
            shot.scene.instances.push_back({0, {}});
            shot.scene.instances.back().material = turn ^ (red_first ? 1 : 0);
        }
        shot.camera = camera_at({0.3f, 0.5f, 4.0f}, {0, 0, 0}, 0.6f);
        const Pixels pixels = draw(shot);
        CHECK(count(pixels, red_first ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0}) > 2000);
        CHECK(count(pixels, red_first ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1}) == 0);
    }
}

TEST_CASE("coplanar: decals are whole: a pixel shows one if it is seen without its wall", "[raster][coplanar]") {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Random random(seed);
        Shot shot;
        shot.settings = plain(seed % 2 == 0 ? 1 : 4);
        const AlphaMode mode = seed % 4 < 2 ? AlphaMode::opaque : seed % 8 < 4 ? AlphaMode::mask : AlphaMode::blend;
        shot.scene.materials = {unlit(kBlue), unlit(kRed, mode)};
        for (Material& material : shot.scene.materials) material.double_sided = true;
        // Turned by matrices of their own, which are rounded.
        Frame flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        place(shot.scene, rectangle(flat, {0, 0}, 1.0f, 0.0f, random.index(7) + 1, 0));
        place(shot.scene, rectangle(flat, {0.1f, 0.05f}, 0.45f, random.real32(0, 3), random.index(4) + 1, 1));
        const Mat4 turn = random_rotation(random), move = translation(random_point(random, 3));
        for (Instance& instance : shot.scene.instances) instance.world_from_object = move * turn;
        const Vec3f middle{move.c[3].x, move.c[3].y, move.c[3].z};
        shot.camera = camera_at(middle + normalize_or(random_point(random, 1), {0, 0, 1}) * 3.0f, middle, 0.8f);
        const Pixels both = draw(shot);
        shot.scene.instances.erase(shot.scene.instances.begin());
        const Pixels alone = draw(shot);
        INFO("seed " << seed);
        int wrong = 0;
        for (int y = 0; y < kViewHeight; ++y)
            for (int x = 0; x < kViewWidth; ++x)
                if (linear_at(alone, x, y)[0] == 1.0f) ++compared, wrong += linear_at(both, x, y)[0] != 1.0f ? 1 : 0;
        CHECK(wrong == 0);
    }
    CHECK(compared > 10'000);
}

TEST_CASE("coplanar: layers in one plane lie over each other in the order of submission", "[raster][coplanar]") {
    for (const bool on_wall : {false, true}) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            Random random(seed);
            Shot shot;
            shot.settings = plain(4);
            shot.scene.materials = {unlit(kBlue), unlit({1, 0, 0, 0.5f}, AlphaMode::blend), unlit({0, 1, 0, 0.5f}, AlphaMode::blend)};
            for (Material& material : shot.scene.materials) material.double_sided = true;
            const Frame frame = random_frame(random);
            place(shot.scene, rectangle(frame, {0, 0}, 0.6f, 0.3f, 5, 1));
            place(shot.scene, rectangle(frame, {0, 0}, 0.6f, 0.3f, 3, 2));
            if (on_wall) place(shot.scene, rectangle(frame, {0, 0}, 0.9f, 0.1f, 4, 0));
            const Vec3f across = cross(frame.u, frame.v);
            shot.camera = camera_at(frame.origin + (across + frame.u * 0.4f) * 2.0f, frame.origin, 0.8f);
            const Pixels pixels = draw(shot);
            INFO("seed " << seed);
            CHECK(count(pixels, {0.25f, 0.5f, on_wall ? 0.25f : 0.0f}) > 500);
            CHECK(count(pixels, {0.5f, 0.25f, on_wall ? 0.25f : 0.0f}) == 0);
        }
    }
}

TEST_CASE("coplanar: the holes of a mask show the wall", "[raster][coplanar]") {
    Shot shot;
    shot.settings = plain();
    shot.scene.materials = {unlit(kBlue), unlit(kRed, AlphaMode::mask)};
    const Frame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    place(shot.scene, rectangle(frame, {0, 0}, 1.0f, 0.0f, 3, 0));
    place(shot.scene, rectangle(frame, {0, 0}, 0.5f, 0.0f, 2, 1));
    for (const Vec3f p : shot.scene.meshes[1].positions) shot.scene.meshes[1].colors.push_back({1, 1, 1, p.x < 0.1f ? 0.0f : 1.0f});
    shot.camera = camera_flat(1.0f);
    const Pixels pixels = draw(shot);
    const float center = 0.5f * kViewWidth, scale = 0.5f * kViewHeight;  // pixels for each unit
    const auto color_at = [&](float x, float y) {
        return linear_at(pixels, static_cast<int>(center + scale * x), static_cast<int>(scale - scale * y));
    };
    CHECK(color_at(-0.25f, 0.2f)[2] == 1.0f);
    CHECK(color_at(0.4f, 0.2f)[0] == 1.0f);
    CHECK(color_at(0.4f, -0.3f)[0] == 1.0f);
    CHECK(color_at(0.7f, 0.2f)[2] == 1.0f);
}

TEST_CASE("coplanar: what lies apart from a plane by more than rounding is decided by depth", "[raster][coplanar]") {
    for (const float scale : {1e-3f, 1.0f, 1e4f}) {
        for (const float off : {1e-4f, -1e-4f}) {
            Shot shot;
            shot.settings = plain();
            // The one that is used last lies behind, or in front.
            shot.scene.materials = {unlit(kBlue), unlit(kRed)};
            const Frame wall{{0, 0, 0}, {scale, 0, 0}, {0, scale, 0}}, decal{{0, 0, off * scale}, wall.u, wall.v};
            place(shot.scene, rectangle(wall, {0, 0}, 1.0f, 0.2f, 1, 0));
            place(shot.scene, rectangle(decal, {0, 0}, 0.5f, 0.4f, 1, 1));
            CHECK(prepared(shot.scene).coplanar().empty());
            shot.camera = camera_at({0, 0, 3 * scale}, {0, 0, 0}, 0.8f, scale);
            const Pixels pixels = draw(shot);
            CHECK((count(pixels, {1, 0, 0}) > 300) == (off > 0));
        }
    }
}

TEST_CASE("coplanar: surfaces beside each other, of one material or seen from two sides form no groups", "[raster][coplanar]") {
    const Frame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const auto pairs_of = [](const Scene& scene) { return find_coplanar_pairs(prepared(scene)).size(); };
    Scene scene;
    scene.materials = {unlit(kBlue), unlit(kRed), unlit(kGreen)};
    scene.materials[2].shadow_catcher = true;
    SECTION("beside each other, with other vertices on the common edge") {
        for (std::uint64_t seed = 0; seed < 50; ++seed) {
            Random random(seed);
            Scene panels = scene;
            const Frame turned = random_frame(random);
            const float turn = random.real32(0, 3);
            const Vec2f step{std::cos(turn), std::sin(turn)};
            place(panels, rectangle(turned, {0.5f * step.x, 0.5f * step.y}, 0.5f, turn, random.index(7) + 1, 0));
            place(panels, rectangle(turned, {-0.5f * step.x, -0.5f * step.y}, 0.5f, turn, random.index(7) + 1, 1));
            CHECK(pairs_of(panels) == 0);
        }
    }
    SECTION("one material") {
        for (int i = 0; i < 2; ++i) place(scene, rectangle(frame, {0, 0}, 0.5f, static_cast<float>(i), 2, 0));
        place(scene, rectangle({{5, 5, 5}, frame.u, frame.v}, {0, 0}, 0.5f, 0, 1, 1));
        CHECK(pairs_of(scene) == 0);
    }
    SECTION("seen from two sides") {
        place(scene, rectangle(frame, {0, 0}, 0.5f, 0, 1, 0));
        place(scene, rectangle({{0, 0, 0}, frame.v, frame.u}, {0, 0}, 0.5f, 0, 1, 1));
        CHECK(pairs_of(scene) == 0);
        scene.materials[1].double_sided = true;
        CHECK(pairs_of(scene) > 0);
    }
    SECTION("a shadow catcher") {
        place(scene, rectangle(frame, {0, 0}, 0.5f, 0, 1, 0));
        place(scene, rectangle(frame, {0, 0}, 0.7f, 0, 1, 2));
        CHECK(pairs_of(scene) == 0);
    }
    SECTION("not seen") {
        place(scene, rectangle(frame, {0, 0}, 0.5f, 0, 1, 0));
        place(scene, rectangle(frame, {0, 0}, 0.7f, 0, 1, 1));
        CHECK(pairs_of(scene) > 0);
        scene.instances[1].visible = false;
        CHECK(pairs_of(scene) == 0);
    }
}

TEST_CASE("coplanar: threads, tiles, regions and instruction sets do not show", "[raster][coplanar]") {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        Random random(seed);
        Shot shot = decals(random);
        shot.settings = plain(seed % 3 == 0 ? 1 : seed % 3 == 1 ? 4 : 16);
        REQUIRE_FALSE(prepared(shot.scene).coplanar().empty());
        const Pixels expected = draw(shot, {.threads = 1, .tile_size = 64, .isa = Isa::scalar});
        for (const Isa isa : halflit::test::available_isas())
            for (const int tile : {16, 32, 64})
                for (const int threads : {1, 2})
                    CHECK(differing(expected, draw(shot, {.threads = threads, .tile_size = tile, .isa = isa})) == 0);
        shot.settings.region = {random.index(40), random.index(30), 30 + random.index(20), 20 + random.index(20)};
        const Region& region = shot.settings.region;
        const Pixels part = draw(shot);
        int wrong = 0;
        for (int y = region.y; y < region.y + region.height; ++y)
            for (int x = region.x; x < region.x + region.width; ++x) wrong += linear_at(part, x, y) != linear_at(expected, x, y) ? 1 : 0;
        CHECK(wrong == 0);
    }
}

TEST_CASE("coplanar: numbers and depths are those of the surface that is seen", "[raster][coplanar]") {
    Random random(3);
    Shot shot;
    shot.scene.materials = {unlit(kBlue), unlit(kRed)};
    for (Material& material : shot.scene.materials) material.double_sided = true;
    const Frame frame = random_frame(random);
    place(shot.scene, rectangle(frame, {0, 0}, 0.9f, 0.0f, 4, 0));
    place(shot.scene, rectangle(frame, {0, 0}, 0.5f, 0.7f, 3, 1));
    shot.settings = plain();
    shot.camera = camera_at(frame.origin + cross(frame.u, frame.v) * 3.0f, frame.origin, 0.8f);
    const Pixels pixels = draw(shot);
    std::vector<std::uint32_t> instance(pixels.depth.size()), triangle(pixels.depth.size());
    const PreparedScene scene = PreparedScene::make(shot.scene).value();
    REQUIRE(Renderer().render(scene, shot.camera, shot.settings,
                              {.width = kViewWidth, .height = kViewHeight, .instance = instance.data(), .triangle = triangle.data()}));
    int wrong = 0, decal = 0;
    for (std::size_t i = 0; i < instance.size(); ++i) {
        const bool red = pixels.linear[4 * i] == 1.0f, blue = pixels.linear[4 * i + 2] == 1.0f;
        decal += red ? 1 : 0;
        wrong += instance[i] != (red ? 2u : blue ? 1u : 0u) || triangle[i] > (red ? 18u : 32u) ? 1 : 0;
    }
    CHECK(wrong == 0);
    CHECK(decal > 300);
}

TEST_CASE("coplanar: a scene that changes has the groups of one that is prepared anew", "[raster][coplanar]") {
    Random random(8);
    Shot shot = decals(random);
    auto data = prepared(shot.scene);
    bool with = false;
    for (int step = 0; step < 30; ++step) {
        SceneChanges changes;
        const auto which = static_cast<std::size_t>(random.index(static_cast<int>(shot.scene.instances.size())));
        Instance& instance = shot.scene.instances[which];
        switch (step % 4) {
            case 0:
                instance.world_from_object = translation({random.chance(0.5) ? 0.0f : 0.25f, 0, 0});
                changes.changed_instances = {which};
                break;
            case 1:
                instance.visible = !instance.visible;
                changes.changed_instances = {which};
                break;
            case 2:
                for (Vec3f& p : shot.scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) p = p * 0.75f;
                changes.deformed_meshes = {static_cast<std::size_t>(instance.mesh)};
                break;
            default:
                shot.scene.materials[static_cast<std::size_t>(random.index(5))].double_sided ^= true;
                changes.materials = true;
        }
        REQUIRE(data.update(changes));
        const PreparedData fresh = prepared(shot.scene);
        REQUIRE(data.coplanar().empty() == fresh.coplanar().empty());
        if (fresh.coplanar().empty()) continue;
        with = true;
        int wrong = 0;
        for (std::size_t i = 0; i < shot.scene.instances.size(); ++i)
            for (std::size_t t = 0; t < triangles_of(shot.scene.meshes[i]); ++t)
                wrong += data.coplanar().of(i, t) != fresh.coplanar().of(i, t) ? 1 : 0;
        CHECK(wrong == 0);
    }
    CHECK(with);
}
