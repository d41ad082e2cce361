// Clusters that culling leaves out have no triangle that would be drawn. Single clusters are tested, and their triangles are set up as in
// the renderer.
#include "raster/view/culling.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/view.hpp"
#include "sh/mat4.hpp"
#include "tests/raster/random_geometry.hpp"

#include "tests/support/catch.hpp"

#include <cstring>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

/// A mesh's vertices in a view's window.
struct Projected {
    std::vector<ScreenVertex> screen;
    std::vector<std::uint8_t> outcode;

    Projected(const Mesh& mesh, const Mat4& clip_from_object, const View& view)
        : screen(mesh.positions.size()), outcode(mesh.positions.size()) {
        TransformArgs args{};
        args.positions = &mesh.positions[0].x;
        args.end = static_cast<std::int64_t>(mesh.positions.size());
        std::memcpy(args.clip_from_object, clip_from_object.c, sizeof args.clip_from_object);
        args.viewport = view.viewport;
        args.screen = screen.data();
        args.outcodes = outcode.data();
        raster_kernels(*default_isa()).transform(args);
    }
};

enum class Fate { outside, back, drawn, clipped };

/// Fate of a triangle after the transform, by the rules of bin.cpp, written independently. clipped: the corners alone do not decide.
Fate fate_of(const Projected& p, const std::uint32_t* v, const View& view, bool mirrored) {
    const unsigned codes[3] = {p.outcode[v[0]], p.outcode[v[1]], p.outcode[v[2]]};
    if ((codes[0] & codes[1] & codes[2] & kRejectWhenAll) != 0) return Fate::outside;
    if (((codes[0] | codes[1] | codes[2]) & (kNear | kGuard | kNotFinite)) != 0) return Fate::clipped;
    const ScreenVertex &a = p.screen[v[0]], &b = p.screen[v[1]], &c = p.screen[v[2]];
    // Samples lie within half a pixel of the pixel's centre, which is at a multiple of 256.
    const Region& r = view.region;
    const std::int64_t left = 256 * r.x - 128, right = 256 * (r.x + r.width) - 128, top = 256 * r.y - 128,
                       bottom = 256 * (r.y + r.height) - 128;
    if (std::max({a.x, b.x, c.x}) < left || std::min({a.x, b.x, c.x}) > right || std::max({a.y, b.y, c.y}) < top ||
        std::min({a.y, b.y, c.y}) > bottom)
        return Fate::outside;
    const std::int64_t doubled = static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) - static_cast<std::int64_t>(c.x - a.x) * (b.y - a.y);
    return doubled == 0 || (doubled > 0) != mirrored ? Fate::back : Fate::drawn;  // y points down
}

struct Tally {
    int clusters = 0, outside = 0, away = 0;  ///< clusters, and the culler's verdicts on them
    int dropped = 0, clipped = 0, wrong = 0;  ///< triangles of the clusters that are left out
};

void check_clusters(const Scene& scene, const View& view, Tally& tally) {
    const auto prepared = PreparedData::make(scene, {1});
    REQUIRE(prepared);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Mat4 clip_from_object = multiply_in_double(view.clip_from_world, instance.world_from_object);
        const bool mirrored = determinant3(instance.world_from_object) < 0.0;
        const Culler culler(view, clip_from_object, mirrored, true);
        const PreparedMesh& clusters = prepared->mesh(instance.mesh);
        const Projected projected(mesh, clip_from_object, view);
        for (std::size_t c = 0; c < clusters.cluster_count(); ++c) {
            const Cluster& cluster = clusters.clusters[c];
            const bool outside = culler.box(cluster.min, cluster.max) == Culler::Verdict::outside, away = culler.faces_away(cluster);
            ++tally.clusters;
            tally.outside += outside;
            tally.away += away;
            const std::size_t first = 3 * c * kClusterTriangles,
                              end = std::min(first + std::size_t{3} * kClusterTriangles, mesh.indices.size());
            for (std::size_t i = first; (outside || away) && i < end; i += 3) {
                const Fate fate = fate_of(projected, &mesh.indices[i], view, mirrored);
                tally.clipped += fate == Fate::clipped;
                tally.wrong += fate == Fate::drawn || (outside && !away && fate == Fate::back);
                tally.dropped += fate == Fate::outside || fate == Fate::back;
            }
        }
    }
}

View random_view(Random& random, const Camera& camera) {
    static constexpr int kSides[] = {1, 2, 16, 100, 640, 4096};
    const int width = kSides[random.index(6)], height = kSides[random.index(6)];
    const Region region = random.chance(0.3) ? random_region(random, width, height) : Region{};
    return make_view(camera, width, height, region, 64, 1);
}

/// Mesh in which each triangle has its own vertices, moved by `height` up or down in y.
Mesh lifted_apart(Random& random, const Mesh& mesh, float height) {
    Mesh out;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (i % 3 == 0) height = random.chance(0.5) ? height : -height;
        out.positions.push_back(mesh.positions[mesh.indices[i]] + Vec3f{0, height, 0});
        out.indices.push_back(static_cast<std::uint32_t>(i));
    }
    return out;
}

/// Scene of one cluster: a small patch around `at`, slightly bent or in two layers, whose outside points along `normal`. `origin`: largest
/// distance of the mesh's own origin, so that large numbers cancel. `layers`: half the distance of the layers, as a fraction of `size`.
Scene patch_at(Random& random, Vec3f at, Vec3f normal, float size, float origin, float layers = 0) {
    Mesh mesh = make_plane(1, static_cast<int>(random.integer(1, 8)));
    if (layers > 0) mesh = lifted_apart(random, mesh, layers);
    const float bend = random.chance(0.5) ? 0.0f : random_decades(random, 1e-4, 0.3);
    const float squeeze = random.chance(0.5) ? 1.0f : random_decades(random, 1e-3, 1);
    const Vec3f side = normalize_or(cross(normal, random_point(random, 1)), {1, 0, 0}), other = cross(side, normal);
    const Vec3f shift = random_point(random, static_cast<double>(origin));
    for (Vec3f& p : mesh.positions) {
        const float height = p.y - bend * (p.x * p.x + p.z * p.z);
        p = (shift + at) + (side * (p.x * size) + normal * (height * size) + other * (p.z * size * squeeze));
    }
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, translation(shift * -1.0f)});
    if (random.chance(0.3)) {  // inside out, mirrored back
        for (Vec3f& p : scene.meshes[0].positions) p.x = -p.x;
        scene.instances[0].world_from_object = scene.instances[0].world_from_object * scaling({-1, 1, 1});
    }
    return scene;
}

}  // namespace

TEST_CASE("culling: all triangles of a cluster that is left out are outside or face away", "[raster][culling]") {
    Random random(1);
    Tally tally;
    for (int round = 0; round < 300; ++round) {
        Scene scene;
        scene.meshes.push_back(random_mesh(random, 20'000));
        for (int i = 0; i < 3; ++i) scene.instances.push_back({0, random_place(random, 5, random_decades(random, 1e-2, 10))});
        check_clusters(scene, random_view(random, random_camera(random)), tally);
    }
    INFO(tally.clusters << " clusters, outside " << tally.outside << ", away " << tally.away << ", clipped " << tally.clipped);
    CHECK(tally.wrong == 0);
    CHECK(tally.outside > 2000);
    CHECK(tally.away > 200);
    CHECK(tally.dropped > 100'000);
}

TEST_CASE("culling: patches seen nearly edge on lose no visible triangle, down to a thousandth of a pixel", "[raster][culling]") {
    Random random(2);
    Tally tally;
    for (int round = 0; round < 60'000; ++round) {
        const Camera camera = random_camera(random);
        const Vec4f* axis = camera.world_from_camera.c;
        const Vec3f eye{axis[3].x, axis[3].y, axis[3].z}, back{axis[2].x, axis[2].y, axis[2].z};
        const float distance = random_decades(random, 0.5, 100);
        const Vec3f at = eye + back * -distance + random_point(random, 0.1) * distance;
        const Vec3f towards = camera.orthographic ? back : normalize_or(eye - at, back);
        const Vec3f edge_on = normalize_or(cross(towards, random_point(random, 1)), {0, 1, 0});
        const bool between = random.chance(0.2);  // the eye is between two layers, or not far above both
        const float angle = between ? random.real32(0.02, 0.5) : random_decades(random, 1e-5, 1);
        const float size = distance * (between ? random.real32(0.1, 0.9) : random_decades(random, 1e-5, 0.5));
        const Vec3f normal = normalize_or(edge_on + towards * (random.chance(0.6) ? -angle : angle), {0, 1, 0});
        const float origin = random.chance(0.5) ? 0.0f : random_decades(random, 1, 1e5);
        check_clusters(patch_at(random, at, normal, size, origin, between ? random.real32(0.05, 1) : 0), random_view(random, camera),
                       tally);
    }
    INFO(tally.clusters << " clusters, outside " << tally.outside << ", away " << tally.away << ", clipped " << tally.clipped);
    CHECK(tally.wrong == 0);
    CHECK(tally.away > 1000);
    CHECK(tally.dropped > 20'000);
}

TEST_CASE("culling: patches at the sides of the view lose no visible triangle", "[raster][culling]") {
    Random random(3);
    Tally tally;
    for (int round = 0; round < 20'000; ++round) {
        const Camera camera = random_camera(random);
        const View view = random_view(random, camera);
        // A point on a side of the window or the region, or on the near or far plane, or off it by a little.
        const float off = random_decades(random, 1e-8, 0.1) * (random.chance(0.5) ? 1.0f : -1.0f);
        const Vec4f* axis = camera.world_from_camera.c;
        const auto point = [&](float x, float y, float z) {
            const Vec4f p = ((axis[0] * x + axis[1] * y) + axis[2] * z) + axis[3];
            return Vec3f{p.x, p.y, p.z};
        };
        Vec3f at{};
        const Region& r = view.region;
        const float tangent = camera.orthographic ? camera.half_height : std::tan(0.5f * camera.fov_y_rad);
        const float aspect = view.viewport.half_width / view.viewport.half_height;
        const float depth = random.chance(0.3)                       ? -camera.near_z * (1.0f + off)
                            : camera.far_z > 0 && random.chance(0.3) ? -camera.far_z * (1.0f + off)
                                                                     : -random_decades(random, 0.1, 10);
        const float reach = camera.orthographic ? tangent : -tangent * depth;
        const bool on_x = random.chance(0.5);
        const float ndc_x =
            on_x ? static_cast<float>(r.x + (random.chance(0.5) ? r.width : 0)) / view.viewport.half_width - 1.0f : random.real32(-1, 1);
        const float ndc_y =
            on_x ? random.real32(-1, 1) : 1.0f - static_cast<float>(r.y + (random.chance(0.5) ? r.height : 0)) / view.viewport.half_height;
        at = point(reach * aspect * (ndc_x + off), reach * (ndc_y + off), depth);
        const float size = -depth * random_decades(random, 1e-7, 0.3), origin = random.chance(0.5) ? 0.0f : random_decades(random, 1, 1e5);
        check_clusters(patch_at(random, at, normalize_or(random_point(random, 1), {0, 0, 1}), size, origin), view, tally);
    }
    INFO(tally.clusters << " clusters, outside " << tally.outside << ", away " << tally.away << ", clipped " << tally.clipped);
    CHECK(tally.wrong == 0);
    CHECK(tally.outside > 2000);
    CHECK(tally.dropped > 50'000);
}

TEST_CASE("culling: nearly half of a finely divided sphere is left out, and all that is behind the camera", "[raster][culling]") {
    // Seen from a distance of 6.1 radii 58 % of a sphere faces away. A cluster of 128 triangles spans some 10 by 1 degrees of this one.
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1, 400'000));
    scene.instances.push_back({0, {}});
    const View view = make_view(halflit::test::camera_at({0, 1, 6}, {0, 0, 0}), 640, 480, {}, 64, 1);
    for (const float side : {1.0f, -1.0f}) {  // mirrored too
        scene.instances[0].world_from_object = scaling({side, 1, 1});
        Tally tally;
        check_clusters(scene, view, tally);
        CHECK(tally.wrong == 0);
        CHECK(tally.outside == 0);
        CHECK(tally.away > 0.3 * tally.clusters);
        CHECK(tally.away < 0.59 * tally.clusters);
    }
    scene.instances[0].world_from_object = translation({0, 2, 20});
    Tally behind;
    check_clusters(scene, view, behind);
    CHECK(behind.wrong == 0);
    CHECK(behind.outside == behind.clusters);

    const auto prepared = PreparedData::make(scene);
    REQUIRE(prepared);
    const Culler two_sided(view, view.clip_from_world, false, false);
    int left_out = 0;
    for (std::size_t c = 0; c < prepared->mesh(0).cluster_count(); ++c) left_out += two_sided.faces_away(prepared->mesh(0).clusters[c]);
    CHECK(left_out == 0);
}
