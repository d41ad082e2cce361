#include "shading/sky_lights.hpp"

#include "sh/equirect.hpp"
#include "sh/rotate.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

constexpr int kGridRows = 96;  ///< of the grid whose cells are given to the directions, twice as many columns

/// Radiance times solid angle of the cells of a grid in the image's frame.
class LightGrid {
public:
    LightGrid() : cells_(static_cast<std::size_t>(2 * kGridRows * kGridRows)) {}

    void add_image(const sh::EquirectView& image) {
        // A pixel goes to the cell of its centre; pixels larger than cells are cut up.
        const int cuts_y = (kGridRows + image.height - 1) / image.height, cuts_x = (2 * kGridRows + image.width - 1) / image.width;
        const int height = image.height * cuts_y, width = image.width * cuts_x;
        for (int y = 0; y < height; ++y) {
            check_time();
            const double solid_angle = sh::pixel_solid_angle(width, height, y);
            for (int x = 0; x < width; ++x)
                cell(y * kGridRows / height, x * 2 * kGridRows / width) += image.at(x / cuts_x, y / cuts_y) * solid_angle;
        }
    }
    template <class Radiance>
    void add_function(const Radiance& radiance) {
        for (int y = 0; y < kGridRows; ++y)
            for (int x = 0; x < 2 * kGridRows; ++x)
                cell(y, x) += radiance(direction(y, x)) * sh::pixel_solid_angle(2 * kGridRows, kGridRows, y);
    }
    /// f(direction, light) for each cell.
    template <class Fn>
    void each(const Fn& f) const {
        for (int y = 0; y < kGridRows; ++y)
            for (int x = 0; x < 2 * kGridRows; ++x) f(direction(y, x), cells_[static_cast<std::size_t>(y * 2 * kGridRows + x)].sum);
    }

private:
    struct Cell {
        Vec3d sum;
        void operator+=(Vec3d more) { sum = sum + more; }
    };
    [[nodiscard]] static Vec3d direction(int y, int x) {
        return sh::equirect_direction((x + 0.5) / (2 * kGridRows), (y + 0.5) / kGridRows);
    }
    Cell& cell(int y, int x) { return cells_[static_cast<std::size_t>(y * 2 * kGridRows + x)]; }

    std::vector<Cell> cells_;
};

}  // namespace

std::vector<Vec3d> sky_directions(int n) {
    constexpr double kGoldenTurn = 0.61803398874989485;  // of a whole turn, (sqrt(5) - 1) / 2
    std::vector<Vec3d> directions;
    double turn = 0.0;
    for (int i = 0; i < n; ++i) {
        const double up = 1.0 - (2 * i + 1.0) / n, across = __builtin_sqrt(1.0 - up * up);
        const SinCos around = sin_cos(2.0 * kPi * turn);
        directions.push_back({across * around.sin, up, across * around.cos});
        turn += kGoldenTurn;
        if (turn >= 1.0) turn -= 1.0;
    }
    return directions;
}

std::vector<Light> sky_lights(int n, const Environment* environment, const Ambient& ambient) {
    const std::vector<Vec3d> directions = sky_directions(n);
    LightGrid grid;
    sh::Rotation turn = sh::rotation_about_y(0.0);
    if (environment != nullptr) {
        turn = sh::rotation_about_y(environment->rotate_rad);
        grid.add_image(environment->light->image());
    } else {
        // A Lambert lobe makes a + b y of the radiance a + 3/2 b y.
        const Vec3d sky = to_double(ambient.sky_linear), ground = to_double(ambient.ground_linear);
        const auto positive = [](double x) { return x > 0.0 ? x : 0.0; };
        grid.add_function([&](Vec3d d) {
            const Vec3d l = (sky + ground) * 0.5 + (sky - ground) * (0.75 * d.y);
            return Vec3d{positive(l.x), positive(l.y), positive(l.z)};
        });
    }
    std::vector<Vec3d> light(directions.size());
    grid.each([&](Vec3d in_image, Vec3d part) {
        const Vec3d d = turn * in_image;
        std::size_t nearest = 0;
        double most = -2.0;
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const double cosine = dot(d, directions[i]);
            if (cosine > most) most = cosine, nearest = i;
        }
        light[nearest] = light[nearest] + part;
    });
    std::vector<Light> lights;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3d color = light[i] * (1.0 / kPi);
        Light& out = lights.emplace_back();
        out.color_linear = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
        out.direction_ws = {static_cast<float>(-directions[i].x), static_cast<float>(-directions[i].y),
                            static_cast<float>(-directions[i].z)};
    }
    return lights;
}

}  // namespace halflit::shading
