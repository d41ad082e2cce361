// Framing that a large ground, or a few vertices far away, do not spoil; and that keeps to all of the scene otherwise.
#include "raster/scene/framed_part.hpp"
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace halflit;

namespace {

Scene car() {
    Scene scene;
    scene.meshes.push_back(make_box({1.5f, 0.6f, 0.7f}));
    scene.meshes.push_back(make_sphere(0.3f, 24, 16));
    scene.instances.push_back({0, translation({0, 0.9f, 0})});
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-0.7f, 0.7f}) scene.instances.push_back({1, translation({x, 0.3f, z})});
    return scene;
}

Camera framed(const Scene& scene) { return frame_scene(scene, 1.5f, ViewSettings{}); }

void add(Scene& scene, Mesh mesh, const Mat4& place) {
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), place});
    scene.meshes.push_back(std::move(mesh));
}

bool same(const Camera& a, const Camera& b) {
    bool same = a.fov_y_rad == b.fov_y_rad && a.near_z == b.near_z && a.far_z == b.far_z;
    for (int k = 0; k < 4; ++k) same &= a.world_from_camera.c[k] == b.world_from_camera.c[k];
    return same;
}

/// Adds an instance with a material of its own, whose texture has an alpha for each of the 16 x 16 texels.
void add_card(Scene& scene, Mesh mesh, AlphaMode mode, const std::function<int(int x, int y)>& alpha) {
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (const int value : {255, 255, 255, alpha(x, y)}) texels.push_back(static_cast<std::uint8_t>(value));
    const auto texture = Texture::from_rgba8(texels, 16, 16, ColorSpace::srgb, MipRule::alpha);
    REQUIRE(texture);
    Material material;
    material.alpha_mode = mode;
    material.textures[TextureSlot::base_color].texture = static_cast<int>(scene.textures.size());
    material.textures[TextureSlot::base_color].sampler.wrap_u = material.textures[TextureSlot::base_color].sampler.wrap_v =
        TextureWrap::clamp;
    mesh.material = static_cast<int>(scene.materials.size());
    scene.textures.push_back(*texture);
    scene.materials.push_back(material);
    add(scene, std::move(mesh), {});
}

/// An upright square around the origin, seen from +z.
Mesh card(float half) {
    Mesh mesh;
    mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

Mesh inside_out(Mesh mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    return mesh;
}

void append(Mesh& mesh, const Mesh& other, Vec3f at) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f p : other.positions) mesh.positions.push_back(p + at);
    for (const std::uint32_t index : other.indices) mesh.indices.push_back(first + index);
}

Mesh positions_of(const Mesh& mesh) {
    Mesh out;
    append(out, mesh, {0, 0, 0});
    return out;
}

double distance_of(const Camera& camera) {
    const Vec4f eye = camera.world_from_camera.c[3];
    return std::sqrt(double{eye.x} * double{eye.x} + double{eye.y} * double{eye.y} + double{eye.z} * double{eye.z});
}

}  // namespace

TEST_CASE("framing: a ground that is much wider than what stands on it is left out", "[raster][framing]") {
    const Camera alone = framed(car());
    for (const float half : {500.0f, 5000.0f, 1e6f}) {
        Scene scene = car();
        add(scene, make_plane(half, 1), translation({0, 0, 0}));
        CHECK(same(framed(scene), alone));
        add(scene, make_plane(20 * half, 1), translation({0, -1, 0}));
        CHECK(same(framed(scene), alone));
    }
}

TEST_CASE("framing: a few vertices far away are left out", "[raster][framing]") {
    const Camera alone = framed(car());
    for (const double far : {100.0, 1e5, 1e12}) {
        INFO("at " << far);
        Scene corner = car();  // a corner of three triangles
        Mesh& sphere = corner.meshes[1];
        const auto stray = static_cast<std::uint32_t>(sphere.positions.size());
        sphere.positions.push_back({static_cast<float>(far), 0, static_cast<float>(-far)});
        sphere.normals.push_back({0, 1, 0});
        if (!sphere.uv0.empty()) sphere.uv0.push_back({0, 0});
        if (!sphere.tangents.empty()) sphere.tangents.push_back({1, 0, 0, 1});
        sphere.indices.insert(sphere.indices.end(), {0, 1, stray, 1, 2, stray, 2, 0, stray});
        CHECK(same(framed(corner), alone));
        Scene alone_13, with_stray;  // thirteen triangles in one mesh, and a fourteenth far away
        Mesh small;
        for (int i = 0; i < 13; ++i)
            for (const Vec3f at : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}})
                small.positions.push_back(at + Vec3f{static_cast<float>(i % 4), static_cast<float>(i / 4), 0});
        const auto number = [](Mesh& mesh) {
            for (auto i = static_cast<std::uint32_t>(mesh.indices.size()); i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
        };
        number(small);
        add(alone_13, small, {});
        for (const Vec3f at : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}})
            small.positions.push_back(at + Vec3f{static_cast<float>(far), 0, 0});
        number(small);
        add(with_stray, small, {});
        CHECK(same(framed(with_stray), framed(alone_13)));
        Scene triangle = car();
        Mesh one;
        one.positions = {{static_cast<float>(far), 0, 0}, {static_cast<float>(far), 1, 0}, {static_cast<float>(far), 0, 1}};
        one.indices = {0, 1, 2};
        add(triangle, one, {});
        CHECK(same(framed(triangle), alone));
    }
}

TEST_CASE("framing: points far from a cloud are left out, also at very different distances", "[raster][framing]") {
    std::mt19937 random(1);
    const auto unit = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1.0f; };
    Mesh cloud;
    cloud.topology = Topology::points;
    for (int i = 0; i < 20000; ++i) cloud.positions.push_back({unit(), unit(), unit()});
    const auto number = [&] {
        cloud.indices.resize(cloud.positions.size());
        for (std::uint32_t i = 0; i < cloud.indices.size(); ++i) cloud.indices[i] = i;
    };
    number();
    Scene scene;
    add(scene, cloud, {});
    const Camera alone = framed(scene);
    float far = 60;
    for (int i = 0; i < 8; ++i, far *= 30) cloud.positions.push_back({far * unit(), far, far * unit()});
    number();
    Scene strayed;
    add(strayed, cloud, {});
    CHECK(same(framed(strayed), alone));
}

TEST_CASE("framing: a matrix that is not finite places nothing", "[raster][framing]") {
    const float inf = std::numeric_limits<float>::infinity();
    for (const bool with_ground : {false, true})
        for (const float x : {inf, -inf, std::numeric_limits<float>::quiet_NaN()})
            for (const int column : {0, 3}) {
                INFO("x = " << x << " in column " << column << (with_ground ? ", with a wide ground" : ""));
                Scene scene = car();
                if (with_ground) add(scene, make_plane(5000, 1), {});
                const Camera alone = framed(scene);
                Mat4 place;
                place.c[column].x = x;
                scene.instances.push_back({1, place});
                CHECK(same(framed(scene), alone));
            }
}

TEST_CASE("framing: what is no ground and no stray is framed", "[raster][framing]") {
    const double alone = distance_of(framed(car()));
    Scene upright = car();  // a wall
    Mesh wall = make_box({300, 200, 0.01f});
    add(upright, wall, {});
    CHECK(distance_of(framed(upright)) > 50 * alone);
    Scene ceiling = car();
    add(ceiling, make_plane(300, 1), translation({0, 10, 0}));
    CHECK(distance_of(framed(ceiling)) > 50 * alone);
    Scene terrain = car();  // more triangles than all that stands on it
    add(terrain, make_plane(300, 100), {});
    CHECK(distance_of(framed(terrain)) > 50 * alone);
    Scene room = car();  // not so much wider
    add(room, make_plane(20, 1), {});
    CHECK(distance_of(framed(room)) > 5 * alone);
    Scene pair = car();  // two things far from each other
    add(pair, make_box({1, 1, 1}), translation({200, 0, 0}));
    CHECK(distance_of(framed(pair)) > 20 * alone);
    Scene ground;  // nothing stands on it
    add(ground, make_plane(300, 1), {});
    CHECK(distance_of(framed(ground)) > 300);
}

TEST_CASE("framed part: a backdrop is left out of the view of the whole, unless there is nothing else", "[raster][camera]") {
    const Scene bare = car();
    Scene staged = car();
    add(staged, make_box({5, 2, 0.1f}), translation({0, 2, -3}));
    CHECK(!same(framed(staged), framed(bare)));
    staged.instances.back().backdrop = true;
    CHECK(same(framed(staged), framed(bare)));
    Scene alone;
    add(alone, make_box({5, 2, 0.1f}), translation({0, 2, -3}));
    const Camera wanted = framed(alone);
    alone.instances.back().backdrop = true;
    CHECK(same(framed(alone), wanted));
}

TEST_CASE("framing: what has no size, or is hidden by alpha, is not framed", "[raster][framing]") {
    const Camera alone = framed(car());
    Scene flat = car();
    Mat4 nowhere = translation({100, 0, 0});
    for (int k = 0; k < 3; ++k) nowhere.c[k] = {0, 0, 0, 0};
    flat.instances.push_back({0, nowhere});
    CHECK(same(framed(flat), alone));
    for (const AlphaMode mode : {AlphaMode::blend, AlphaMode::mask}) {
        Scene clear = car();
        Material material;
        material.alpha_mode = mode;
        material.base_color.w = 0.0f;
        clear.materials.push_back(material);
        add(clear, make_box({30, 30, 30}), {});
        clear.meshes.back().material = 0;
        CHECK(same(framed(clear), alone));
        clear.materials[0].transmission = 1.0f;  // glass is seen, whatever its alpha
        CHECK(distance_of(framed(clear)) > 5 * distance_of(alone));

        Scene hidden = car();
        add_card(hidden, card(30), mode, [](int, int) { return 0; });
        CHECK(same(framed(hidden), alone));

        Scene faint = car();  // by the alpha of vertices
        Mesh by_vertices = card(30);
        by_vertices.uv0.clear();
        by_vertices.colors.assign(4, {1, 1, 1, 0});
        faint.materials.push_back(material);
        faint.materials[0].base_color.w = 1.0f;
        by_vertices.material = 0;
        add(faint, by_vertices, {});
        CHECK(same(framed(faint), alone));
    }
}

TEST_CASE("framing: of a card, the texels that are seen are framed", "[raster][framing]") {
    for (const AlphaMode mode : {AlphaMode::blend, AlphaMode::mask}) {
        Scene whole, inner, quarter;
        add(whole, card(8), {});
        add_card(inner, card(8), mode, [](int x, int y) { return x >= 4 && x < 12 && y >= 4 && y < 12 ? 255 : 0; });
        const double ratio = distance_of(framed(inner)) / distance_of(framed(whole));
        CHECK(ratio > 0.5);  // half of each side, and the texel around it that a filter reads
        CHECK(ratio < 0.66);
        add_card(quarter, card(8), mode, [](int x, int y) { return x < 8 && y < 8 ? 255 : 0; });
        const Camera camera = frame_scene(quarter, 1.0f, {.azimuth_deg = 0, .elevation_deg = 0});
        CHECK(std::abs(camera.world_from_camera.c[3].x + 4) < 0.6f);  // the upper left quarter
        CHECK(std::abs(camera.world_from_camera.c[3].y - 4) < 0.6f);
    }
}

TEST_CASE("framing: a little of the surface that lies far from all else is left out", "[raster][framing]") {
    const Mesh ball = make_sphere(1.0f, 48, 24);
    Scene alone;
    add(alone, positions_of(ball), {});
    const Camera wanted = framed(alone);
    Mat4 small = translation({2000, 0, 0});
    for (int k = 0; k < 3; ++k) small.c[k] = {k == 0 ? 0.05f : 0.0f, k == 1 ? 0.05f : 0.0f, k == 2 ? 0.05f : 0.0f, 0};
    Scene pair = alone;  // as many vertices, a 400th of the surface
    pair.instances.push_back({0, small});
    CHECK(same(framed(pair), wanted));
    for (const float far : {60.0f, 2000.0f}) {
        Scene cube = alone;
        add(cube, make_box({0.05f, 0.05f, 0.05f}), translation({far, 0, 0}));
        CHECK(same(framed(cube), wanted));
        Scene one_mesh;
        Mesh both = positions_of(ball);
        append(both, make_box({0.05f, 0.05f, 0.05f}), {far, 0, 0});
        add(one_mesh, both, {});
        CHECK(same(framed(one_mesh), wanted));
        Scene houses;  // of like size
        add(houses, make_box({1, 1, 1}), {});
        add(houses, make_box({0.5f, 0.5f, 0.5f}), translation({far, 0, 0}));
        CHECK(distance_of(framed(houses)) > far / 2);
    }
    // A thin rod that is joined to the ball belongs to it, in one mesh or as a thing of its own.
    Mesh rod = make_box({30, 0.001f, 0.001f});
    Scene joined;
    Mesh both = positions_of(ball);
    append(both, rod, {30.5f, 0, 0});
    add(joined, both, {});
    CHECK(distance_of(framed(joined)) > 5 * distance_of(wanted));
    Scene beside = alone;
    add(beside, rod, translation({30.5f, 0, 0}));
    CHECK(distance_of(framed(beside)) > 5 * distance_of(wanted));
}

TEST_CASE("framing: a shell around all else is left out if it is seen from inside", "[raster][framing]") {
    const Camera alone = framed(car());
    const auto with_shell = [&](Mesh shell, Vec3f at, bool both_sides, bool unlit) {
        Scene scene = car();
        Material material;
        material.double_sided = both_sides, material.unlit = unlit;
        scene.materials.push_back(material);
        shell.material = 0;
        add(scene, std::move(shell), translation(at));
        return scene;
    };
    const Mesh dome = make_sphere(100, 32, 16);
    CHECK(same(framed(with_shell(inside_out(dome), {0, 0, 0}, false, false)), alone));
    CHECK(same(framed(with_shell(inside_out(make_box({100, 100, 100})), {3, 20, 5}, true, false)), alone));
    CHECK(same(framed(with_shell(dome, {0, 0, 0}, true, true)), alone));
    Scene with_ground = with_shell(inside_out(dome), {0, 0, 0}, false, false);
    add(with_ground, make_plane(90, 1), {});
    CHECK(same(framed(with_ground), alone));
    // A body that encloses the rest, a room that is not much larger, and a shell beside all else.
    CHECK(distance_of(framed(with_shell(dome, {0, 0, 0}, false, false))) > 20 * distance_of(alone));
    CHECK(distance_of(framed(with_shell(inside_out(make_box({15, 15, 15})), {0, 0, 0}, false, false))) > 3 * distance_of(alone));
    CHECK(distance_of(framed(with_shell(inside_out(dome), {150, 0, 0}, false, false))) > 20 * distance_of(alone));
}
