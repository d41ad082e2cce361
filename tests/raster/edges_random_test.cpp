// Which parts of edges are seen in random scenes, compared with a ray to each point against every triangle.
#include "halflit/shapes.hpp"
#include "raster/detail/executor.hpp"
#include "raster/passes/edge_lines.hpp"
#include "sh/mat4.hpp"
#include "tests/raster/edge_reference.hpp"
#include "tests/support/random.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::Random;

namespace {

constexpr int kWidth = 320, kHeight = 240;

Mat4 random_place(Random& random) {
    Mat4 m = Mat4::identity();
    for (int k = 0; k < 3; ++k) m.c[k] = {random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1), 0};
    const Vec3f x{m.c[0].x, m.c[0].y, m.c[0].z}, y{m.c[1].x, m.c[1].y, m.c[1].z}, z{m.c[2].x, m.c[2].y, m.c[2].z};
    if (dot(cross(x, y), z) < 0) m.c[2] = {-z.x, -z.y, -z.z, 0};
    m.c[3] = {random.real32(-2, 2), random.real32(-2, 2), random.real32(-2, 2), 1};
    return m;
}

Mesh random_mesh(Random& random) {
    switch (random.index(4)) {
        case 0:
            return make_box({random.real32(0.2, 1), random.real32(0.2, 1), random.real32(0.2, 1)});
        case 1:
            return make_sphere(random.real32(0.3, 1), 6 + random.index(18), 4 + random.index(12));
        case 2:
            return make_torus(1, random.real32(0.1, 0.5), 5 + random.index(20), 4 + random.index(10));
        default: {
            Mesh soup;
            for (std::uint32_t i = 0; i < 36; ++i) {
                soup.positions.push_back({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
                soup.indices.push_back(i);
            }
            return soup;
        }
    }
}

Scene random_scene(Random& random) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].double_sided = true;
    for (int i = 2 + random.index(4); i > 0; --i) {
        Mesh mesh = random_mesh(random);
        mesh.material = mesh.indices.size() == 36 && mesh.positions.size() == 36 ? 1 : random.index(2);
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), random_place(random)});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

struct Shares {
    double length = 0, missing = 0, wrong = 0;  ///< pixels: of all lines, seen but left out, hidden but drawn
};

Shares compare_lines(const Scene& scene, const Camera& camera, const Settings& settings, Executor& executor) {
    std::vector<std::uint32_t> instance(std::size_t{kWidth} * kHeight), triangle(instance.size());
    Target target{kWidth, kHeight};
    target.instance = instance.data(), target.triangle = triangle.data();
    REQUIRE(render(scene, camera, {}, target));
    ModelEdges edges;
    edges.find(scene, double{settings.edge_angle_deg});
    const Region all{0, 0, kWidth, kHeight};
    MemoryShare memory;
    const auto lines = edge_lines(edges, camera, {kWidth, kHeight, all, instance.data(), triangle.data()}, all, settings, executor, memory);

    Shares shares;
    const EdgeReference reference(scene);
    const WindowOf window(camera, kWidth, kHeight);
    for (const EdgeReference::Edge& edge : reference.edges()) {
        if (!reference.is_line(edge, settings.edges, double{settings.edge_angle_deg}, window)) continue;
        const Segment2 whole{window.point(edge.a), window.point(edge.b)};
        std::vector<EdgeLine> of_edge;  // its parts: their ends lie on it
        for (const EdgeLine& line : lines)
            if ((std::hypot(line.x0 - whole.a.x, line.y0 - whole.a.y) < 1e-2 &&
                 std::hypot(line.x1 - whole.b.x, line.y1 - whole.b.y) < 1e-2) ||
                (std::hypot(line.x0 - whole.b.x, line.y0 - whole.b.y) < 1e-2 &&
                 std::hypot(line.x1 - whole.a.x, line.y1 - whole.a.y) < 1e-2))
                of_edge.push_back(line);
        const int steps = 1 + static_cast<int>(4.0 * whole.length());
        for (int i = 0; i < steps; ++i) {
            const Vec3d p = edge.a + (edge.b - edge.a) * ((i + 0.5) / steps);
            const Point2 at = window.point(p);
            if (!(at.x > 1 && at.x < kWidth - 1 && at.y > 1 && at.y < kHeight - 1)) continue;
            const bool seen = reference.is_seen(edge, p, window);
            const bool drawn = std::any_of(of_edge.begin(), of_edge.end(), [&](const EdgeLine& line) {
                const double dx = line.x1 - line.x0, dy = line.y1 - line.y0;
                const double t = ((at.x - line.x0) * dx + (at.y - line.y0) * dy) / (dx * dx + dy * dy);
                return t >= line.t0 && t <= line.t1;
            });
            const double step = whole.length() / steps;
            shares.length += step;
            shares.missing += seen && !drawn ? step : 0;
            shares.wrong += drawn && !seen ? step : 0;
        }
    }
    return shares;
}

}  // namespace

TEST_CASE("edges: in random scenes less than 0.2 % of the lines' length differ from rays against every triangle", "[edges]") {
    Random random(20);
    Executor executor;
    executor.configure({});
    for (const EdgeChoice choice : {EdgeChoice::feature, EdgeChoice::all}) {
        Shares sum;
        double worst = 0;
        for (int trial = 0; trial < (choice == EdgeChoice::all ? 15 : 40); ++trial) {
            const Scene scene = random_scene(random);
            ViewSettings view;
            view.azimuth_deg = random.real32(-180, 180), view.elevation_deg = random.real32(-80, 80);
            view.orthographic = random.chance(0.5);
            Settings settings;
            settings.edges = choice;
            const Camera camera = frame_scene(scene, 1.0f * kWidth / kHeight, view);
            const Shares shares = compare_lines(scene, camera, settings, executor);
            sum.length += shares.length, sum.missing += shares.missing, sum.wrong += shares.wrong;
            if (shares.length > 0) worst = std::max(worst, (shares.missing + shares.wrong) / shares.length);
        }
        CAPTURE(sum.length, sum.missing / sum.length, sum.wrong / sum.length, worst);
        CHECK(sum.length > 1e5);
        // 0.10 % of feature lines and 0.06 % of all, 0.46 % in the worst scene: most of it at surfaces that are seen nearly edge on.
        CHECK(sum.missing + sum.wrong < 0.002 * sum.length);
        CHECK(worst < 0.01);
    }
}
