#include "peer_scenes.hpp"

#include "raster/view/projection.hpp"
#include "sh/trig.hpp"

#include <random>

namespace halflit::peer {

namespace {

constexpr float kPictureAspect = static_cast<float>(kWidth) / static_cast<float>(kHeight);

struct Point {
    double x, y;  // share of the picture, (0, 0) to (1, 1)
};

/// Collects triangles given in shares of the picture; places them in front of the camera, one behind the other.
class Builder {
public:
    Builder(std::string name, bool crosses_frame, bool perspective, unsigned seed) : random_(seed) {
        scene_.name = std::move(name);
        scene_.crosses_frame = crosses_frame;
        scene_.camera.orthographic = !perspective;
        scene_.camera.near_z = perspective ? 0.5f : 0.0f;
        scene_.camera.far_z = perspective ? 0.0f : 1.0f;
    }

    double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0); }

    void triangle(Point a, Point b, Point c) { points_.insert(points_.end(), {a, b, c}); }

    /// A triangle with its corners on a circle of `radius_px` pixels, moved into the frame unless the scene may cross it.
    void random_triangle(double radius_px, double thinness) {
        const double margin = scene_.crosses_frame ? -0.1 : 0.0;
        Point p[3];
        const double turn = uniform(0, 2 * kPi);
        const Point middle{uniform(margin, 1 - margin), uniform(margin, 1 - margin)};
        for (int i = 0; i < 3; ++i) {
            const SinCos on_circle = sin_cos(uniform(0, 2 * kPi)), axis = sin_cos(turn);
            const double u = radius_px * on_circle.cos, v = radius_px * on_circle.sin * thinness;
            p[i] = {middle.x + (u * axis.cos - v * axis.sin) / kWidth, middle.y + (u * axis.sin + v * axis.cos) / kHeight};
            if (!scene_.crosses_frame) p[i] = {inside(p[i].x), inside(p[i].y)};
        }
        triangle(p[0], p[1], p[2]);
    }

    PeerScene finish() {
        Mesh mesh;
        const std::size_t triangles = points_.size() / 3;
        const bool perspective = !scene_.camera.orthographic;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            // Orthographic: depths (2t + 1) / 2^17, exact in float. Perspective: layers of distance that do not overlap, a layer's three
            // corners at different distances, so that w differs along every edge.
            const auto t = static_cast<double>(i / 3);
            const double layer = static_cast<double>(triangles) - t;
            const double distance = perspective ? 1.0 + layer * 0.01 + uniform(0.0, 0.005) : 1.0 - (2.0 * t + 1.0) / 131072.0;
            const double reach = perspective ? distance * half_tangent_ : 1.0;
            mesh.positions.push_back({static_cast<float>((2 * points_[i].x - 1) * reach * kPictureAspect),
                                      static_cast<float>((1 - 2 * points_[i].y) * reach), static_cast<float>(-distance)});
            mesh.indices.push_back(static_cast<std::uint32_t>(i));
        }
        mesh.material = 0;
        const Mat4 clip_from_world = raster::clip_from_world(scene_.camera, kPictureAspect);
        for (const Vec3f& p : mesh.positions) scene_.clip_positions.push_back(clip_from_world * Vec4f{p.x, p.y, p.z, 1.0f});
        Material material;
        material.unlit = true;
        material.double_sided = true;
        scene_.scene.materials.push_back(material);
        scene_.scene.meshes.push_back(std::move(mesh));
        scene_.scene.instances.push_back({0, {}});
        return std::move(scene_);
    }

private:
    /// Clamps a share to the frame, a quarter of a pixel away from the border, so that float rounding stays inside.
    static double inside(double share) {
        const double low = 0.25 / kHeight, high = 1.0 - low;
        return share < low ? low : share > high ? high : share;
    }

    PeerScene scene_;
    std::mt19937 random_;  // its sequence is defined by the standard; its distributions are not
    std::vector<Point> points_;
    double half_tangent_ = sin_cos(0.392699081).sin / sin_cos(0.392699081).cos;  // half the camera's default field of view
};

PeerScene random_scene(std::string name, bool crosses, bool perspective, int count, double radius_low, double radius_high, double thinness,
                       unsigned seed) {
    Builder b(std::move(name), crosses, perspective, seed);
    for (int i = 0; i < count; ++i) b.random_triangle(b.uniform(radius_low, radius_high), thinness);
    return b.finish();
}

/// Fans around random centres: many edges share an end point, and every inner edge is shared by two triangles.
PeerScene fans(unsigned seed) {
    Builder b("fans with shared edges", false, false, seed);
    for (int fan = 0; fan < 150; ++fan) {
        const Point middle{b.uniform(0.1, 0.9), b.uniform(0.1, 0.9)};
        const double radius = b.uniform(5, 100);
        const int blades = 5 + fan % 40;
        Point rim[48];
        for (int i = 0; i < blades; ++i) {
            const SinCos a = sin_cos(2 * kPi * i / blades);
            rim[i] = {middle.x + radius * a.cos / kWidth, middle.y + radius * a.sin / kHeight};
        }
        for (int i = 0; i < blades; ++i) b.triangle(middle, rim[i], rim[(i + 1) % blades]);
    }
    return b.finish();
}

/// Corners at multiples of half a pixel: edges run through pixel centres, where the fill rule alone decides.
PeerScene half_pixel_grid(unsigned seed) {
    Builder b("corners on half pixels", false, false, seed);
    const auto snapped = [&](double limit) { return static_cast<double>(static_cast<int>(b.uniform(1, 2 * limit - 1))) * 0.5 / limit; };
    for (int i = 0; i < 3000; ++i) {
        const Point p{snapped(kWidth), snapped(kHeight)};
        const auto near = [&](double share, double limit) {
            const double moved = share + static_cast<double>(static_cast<int>(b.uniform(-80, 81))) * 0.5 / limit;
            return moved < 0.5 / limit ? 0.5 / limit : moved > 1 - 0.5 / limit ? 1 - 0.5 / limit : moved;
        };
        const Point q{near(p.x, kWidth), near(p.y, kHeight)}, r{near(p.x, kWidth), near(p.y, kHeight)};
        b.triangle(p, q, r);
    }
    return b.finish();
}

}  // namespace

std::vector<PeerScene> peer_scenes() {
    std::vector<PeerScene> scenes;
    scenes.push_back(random_scene("large", false, false, 300, 100, 600, 1.0, 1));
    scenes.push_back(random_scene("small", false, false, 40000, 1, 8, 1.0, 2));
    scenes.push_back(random_scene("slivers", false, false, 2000, 20, 600, 0.004, 3));
    scenes.push_back(fans(4));
    scenes.push_back(half_pixel_grid(5));
    scenes.push_back(random_scene("perspective", false, true, 3000, 2, 150, 1.0, 6));
    scenes.push_back(random_scene("large across the border", true, false, 300, 100, 1500, 1.0, 7));
    scenes.push_back(random_scene("small across the border", true, false, 40000, 1, 12, 1.0, 8));
    scenes.push_back(random_scene("far outside the guard band", true, false, 60, 17000, 30000, 0.002, 9));
    scenes.push_back(random_scene("perspective across the border", true, true, 2000, 2, 800, 1.0, 10));
    return scenes;
}

}  // namespace halflit::peer
