// Framing that a large ground, or a few vertices far away, do not spoil; and that keeps to all of the scene otherwise.
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <random>

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
