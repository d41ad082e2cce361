#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/target.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

using namespace halflit;
using namespace halflit::raster;

namespace {

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& i : scene.instances) count += scene.meshes[static_cast<std::size_t>(i.mesh)].indices.size() / 3;
    return count;
}

std::uint64_t hash_of_floats(const std::vector<Vec3f>& v) {
    return pixel_hash({reinterpret_cast<const std::uint8_t*>(v.data()), v.size() * sizeof(Vec3f)});
}

}  // namespace

TEST_CASE("demo scene: every index, array and reference is valid", "[raster][demo]") {
    const Scene scene = demo_scene();
    REQUIRE(!scene.instances.empty());
    const auto refers = [](int index, std::size_t size) { return index >= 0 && static_cast<std::size_t>(index) < size; };
    for (const Instance& instance : scene.instances) CHECK(refers(instance.mesh, scene.meshes.size()));
    for (const Mesh& mesh : scene.meshes) {
        INFO(mesh.name);
        const std::size_t n = mesh.positions.size();
        CHECK(refers(mesh.material, scene.materials.size()));
        CHECK(mesh.normals.size() == n);
        for (const std::size_t other : {mesh.tangents.size(), mesh.uv0.size(), mesh.colors.size()}) CHECK((other == 0 || other == n));
        CHECK(mesh.indices.size() % 3 == 0);
        CHECK(std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i < n; }));
        CHECK(std::all_of(mesh.normals.begin(), mesh.normals.end(), [](Vec3f v) { return std::abs(length(v) - 1.0f) < 1e-6f; }));
    }
    for (const Material& m : scene.materials)
        for (const TextureUse& use :
             {m.textures[TextureSlot::base_color], m.textures[TextureSlot::normal], m.textures[TextureSlot::metallic_roughness]})
            CHECK((!use.used() || refers(use.texture, scene.textures.size())));
    for (const Light& light : scene.lights) CHECK(length(light.direction_ws) == Approx(1.0f).epsilon(1e-6));
    CHECK(scene.textures.size() == 3);
    CHECK(scene.cameras.size() == 1);
}

TEST_CASE("demo scene: triangles face the way their normals do", "[raster][demo]") {
    for (const Mesh& mesh : demo_scene().meshes) {
        int against = 0;
        for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            const std::uint32_t* i = &mesh.indices[t];
            const Vec3f face = cross(mesh.positions[i[1]] - mesh.positions[i[0]], mesh.positions[i[2]] - mesh.positions[i[0]]);
            for (int k = 0; k < 3; ++k) against += dot(face, mesh.normals[i[k]]) < 0.0f;
        }
        INFO(mesh.name);
        CHECK(against == 0);
    }
}

TEST_CASE("demo scene: balls and trefoil are closed", "[raster][demo]") {
    int closed = 0;
    for (const Mesh& mesh : demo_scene().meshes) {
        if (mesh.name != "sphere" && mesh.name != "trefoil") continue;
        // Edges are compared by position, not by index: seams have two vertices at one position.
        using Place = std::tuple<float, float, float>;
        std::map<std::pair<Place, Place>, int> edges;
        const auto place = [&](std::uint32_t i) { return Place{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z}; };
        for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
            for (std::size_t k = 0; k < 3; ++k) ++edges[{place(mesh.indices[t + k]), place(mesh.indices[t + (k + 1) % 3])}];
        int open = 0;
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            open += count != 1 || back == edges.end() || back->second != 1;
        }
        INFO(mesh.name);
        CHECK(open == 0);
        ++closed;
    }
    CHECK(closed == 5 + 3 + 1);  // balls, bulbs, trefoil
}

TEST_CASE("demo scene: tangents lie in the surface and follow u", "[raster][demo]") {
    int tangents = 0;
    for (const Mesh& mesh : demo_scene().meshes) {
        if (mesh.tangents.empty()) continue;
        for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
            const Vec3f t{mesh.tangents[i].x, mesh.tangents[i].y, mesh.tangents[i].z};
            CHECK(std::abs(dot(t, mesh.normals[i])) < 1e-6f);
            // The bitangent goes up the texture, against v.
            CHECK((cross(mesh.normals[i], t) * mesh.tangents[i].w).y == Approx(1.0f).epsilon(1e-6));
        }
        for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            const std::uint32_t *i = &mesh.indices[t], a = i[0], b = mesh.uv0[i[1]].x != mesh.uv0[a].x ? i[1] : i[2];
            const Vec3f along = mesh.positions[b] - mesh.positions[a], tangent{mesh.tangents[a].x, mesh.tangents[a].y, mesh.tangents[a].z};
            CHECK(dot(along, tangent) * (mesh.uv0[b].x - mesh.uv0[a].x) > 0.0f);
            ++tangents;
        }
    }
    CHECK(tangents > 0);
}

TEST_CASE("demo scene: five balls differ in their lobe alone, wrap 0 to 1 from left to right, all in view", "[raster][demo]") {
    const Scene scene = demo_scene();
    const Mat4 clip = clip_from_world(scene.cameras[0], 16.0f / 9.0f);
    std::vector<std::pair<float, const Material*>> balls;
    for (const Instance& instance : scene.instances) {
        const Material& m = scene.materials[static_cast<std::size_t>(scene.meshes[static_cast<std::size_t>(instance.mesh)].material)];
        if (m.name.rfind("wrap ", 0) != 0) continue;
        balls.push_back({instance.world_from_object.c[3].x, &m});
        for (const Vec3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
            const Vec3f at = transform_point(instance.world_from_object, p);
            const Vec4f c = clip * Vec4f{at.x, at.y, at.z, 1};
            if (!(std::abs(c.x) < 0.95f * c.w && std::abs(c.y) < 0.95f * c.w)) FAIL("a ball leaves the picture");
        }
    }
    REQUIRE(balls.size() == 5);
    std::sort(balls.begin(), balls.end());
    for (std::size_t i = 0; i < 5; ++i) {
        const float a = 0.25f * static_cast<float>(i);
        CHECK(balls[i].second->lobe == Lobe{a, 1.0f + a, false});
        CHECK(balls[i].second->has_own_lobe);
        CHECK(balls[i].second->base_color == balls[0].second->base_color);
        CHECK(balls[i].second->roughness == balls[0].second->roughness);
    }
}

TEST_CASE("demo scene: two calls give the same data, of less than 250000 triangles", "[raster][demo]") {
    const Scene a = demo_scene(), b = demo_scene();
    REQUIRE(a.meshes.size() == b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        CHECK(hash_of_floats(a.meshes[i].positions) == hash_of_floats(b.meshes[i].positions));
        CHECK(hash_of_floats(a.meshes[i].normals) == hash_of_floats(b.meshes[i].normals));
    }
    CHECK(triangle_count(a) < 250000);
}

TEST_CASE("scene: bounds cover placed vertices that triangles use, and finite ones only", "[raster][scene]") {
    Scene scene;
    CHECK(scene_bounds(scene).empty);
    Mesh mesh;
    const float infinity = std::numeric_limits<float>::infinity();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {infinity, 0, 0}, {100, 100, 100}};
    mesh.indices = {0, 1, 2, 0, 3, 2, 0, 1, 77};  // vertex 4 is not used, 77 does not exist
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, translation({10, 0, 0})});
    scene.instances.push_back({0, scaling({-1, 1, 1})});
    scene.instances.push_back({5, {}});
    const Bounds bounds = scene_bounds(scene);
    CHECK(bounds.min == Vec3f{-1, 0, 0});
    CHECK(bounds.max == Vec3f{11, 2, 0});
}

TEST_CASE("scene: the default key light comes from over the viewer's left shoulder", "[raster][scene]") {
    for (const float azimuth : {0.0f, 90.0f, 200.0f}) {
        Scene scene;
        const Camera camera = frame_bounds({}, 1.0f, {azimuth, 20.0f, 1.0f, 35.0f});
        add_default_lights(scene, camera);
        REQUIRE(scene.lights.size() == 1);
        const Light& key = scene.lights[0];
        CHECK(key.type == LightType::directional);
        CHECK(length(key.direction_ws) == Approx(1.0f).epsilon(1e-6));
        const Mat4& m = camera.world_from_camera;
        CHECK(dot(key.direction_ws, {m.c[0].x, m.c[0].y, m.c[0].z}) > 0.2f);   // to the right: from the left
        CHECK(dot(key.direction_ws, {m.c[1].x, m.c[1].y, m.c[1].z}) < -0.2f);  // down
        CHECK(dot(key.direction_ws, {m.c[2].x, m.c[2].y, m.c[2].z}) < -0.2f);  // away from the viewer
        // A white surface that faces the key stays within the display's range, ambient included.
        const float up = -key.direction_ws.y;
        const float blue = key.color_linear.z + scene.ambient.ground_linear.z +
                           (scene.ambient.sky_linear.z - scene.ambient.ground_linear.z) * 0.5f * (1 + up);
        CHECK(key.color_linear.x > 0.8f);
        CHECK(blue < 1.05f);
    }
}
