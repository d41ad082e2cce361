#include "shading/sky_lights.hpp"

#include "sh/equirect.hpp"
#include "sh/rotate.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

Vec3d cell_direction(int rows, int y, int x) { return sh::equirect_direction((x + 0.5) / (2 * rows), (y + 0.5) / rows); }

/// Radiance times solid angle of the cells of a grid in the image's frame.
std::vector<Vec3d> cells_of_image(const sh::EquirectView& image, int rows) {
    std::vector<Vec3d> cells(static_cast<std::size_t>(2 * rows * rows));
    // A pixel goes to the cell of its centre; pixels larger than cells are cut up.
    const int cuts_y = (rows + image.height - 1) / image.height, cuts_x = (2 * rows + image.width - 1) / image.width;
    const int height = image.height * cuts_y, width = image.width * cuts_x;
    for (int y = 0; y < height; ++y) {
        check_time();
        const double solid_angle = sh::pixel_solid_angle(width, height, y);
        for (int x = 0; x < width; ++x) {
            Vec3d& cell = cells[static_cast<std::size_t>((y * rows / height) * 2 * rows + x * 2 * rows / width)];
            cell = cell + image.at(x / cuts_x, y / cuts_y) * solid_angle;
        }
    }
    return cells;
}

/// A Lambert lobe makes a + b y of the radiance a + 3/2 b y.
std::vector<Vec3d> cells_of_ambient(const Ambient& ambient, int rows) {
    const Vec3d sky = to_double(ambient.sky_linear), ground = to_double(ambient.ground_linear);
    const auto positive = [](double x) { return x > 0.0 ? x : 0.0; };
    std::vector<Vec3d> cells;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x) {
            const Vec3d l = (sky + ground) * 0.5 + (sky - ground) * (0.75 * cell_direction(rows, y, x).y);
            cells.push_back(Vec3d{positive(l.x), positive(l.y), positive(l.z)} * sh::pixel_solid_angle(2 * rows, rows, y));
        }
    return cells;
}

}  // namespace

std::vector<Vec3d> sky_directions(int n) {
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

std::vector<Light> sky_lights(int n, int rows, const Environment* environment, const Ambient& ambient, SkyCells& kept) {
    const std::vector<Vec3d> directions = sky_directions(n);
    sh::Rotation turn = sh::rotation_about_y(0.0);
    if (environment == nullptr) {
        kept = {nullptr, cells_of_ambient(ambient, rows)};
    } else {
        turn = sh::rotation_about_y(environment->rotate_rad);
        if (kept.light != environment->light || kept.cells.size() != static_cast<std::size_t>(2 * rows * rows))
            kept = {environment->light, cells_of_image(environment->light->image(), rows)};
    }
    std::vector<Vec3d> light(directions.size());
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x) {
            const Vec3d d = turn * cell_direction(rows, y, x);
            std::size_t nearest = 0;
            double most = -2.0;
            for (std::size_t i = 0; i < directions.size(); ++i) {
                const double cosine = dot(d, directions[i]);
                if (cosine > most) most = cosine, nearest = i;
            }
            light[nearest] = light[nearest] + kept.cells[static_cast<std::size_t>(y * 2 * rows + x)];
        }
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
