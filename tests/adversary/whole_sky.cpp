#include "tests/adversary/whole_sky.hpp"

#include "sh/equirect.hpp"
#include "shading/reference/reference.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::adversary {
namespace {

struct Patch {
    Vec3d direction, light;  ///< radiance times solid angle over pi
};

Vec3d sum_of(const std::vector<Patch>& patches) {
    Vec3d sum{};
    for (const Patch& p : patches) sum = sum + p.light;
    return sum;
}

/// The image cut into patches: 2 degrees at most, and 0.3 degrees where one pixel has more than a hundredth of all light.
std::vector<Patch> patches_of(const EnvironmentImage& image, double turn_rad) {
    const double turn_sin = std::sin(turn_rad), turn_cos = std::cos(turn_rad);
    const auto cut = [&](int x, int y, int cuts, std::vector<Patch>& out) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
        const Vec3d radiance{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
        const double rows = image.height * cuts, columns = image.width * cuts;
        for (int j = y * cuts; j < (y + 1) * cuts; ++j) {
            const double solid = 2 * kPi / columns * (std::cos(kPi * j / rows) - std::cos(kPi * (j + 1) / rows));
            for (int i = x * cuts; i < (x + 1) * cuts; ++i) {
                const Vec3d d = sh::equirect_direction((i + 0.5) / columns, (j + 0.5) / rows);
                // Counter-clockwise about +y, seen from above.
                const Vec3d turned{turn_cos * d.x + turn_sin * d.z, d.y, turn_cos * d.z - turn_sin * d.x};
                out.push_back({turned, radiance * (solid / kPi)});
            }
        }
    };
    double total = 0;
    std::vector<Patch> whole;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) cut(x, y, 1, whole);
    for (const Patch& p : whole) total += sh::luminance(p.light);
    std::vector<Patch> out;
    const int cuts = std::max(1, 180 / image.width), fine = std::max(1, 1200 / image.width);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            cut(x, y, sh::luminance(whole[static_cast<std::size_t>(y * image.width + x)].light) > 0.01 * total ? fine : cuts, out);
    return out;
}

const Material& material_at(const Trial& trial, std::uint32_t instance) {
    const int mesh = trial.scene.instances[instance - 1].mesh;
    return trial.scene.materials[static_cast<std::size_t>(trial.scene.meshes[static_cast<std::size_t>(mesh)].material)];
}

double largest(Vec3d v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

bool whole_sky_applies(const Trial& trial) {
    if (trial.scene.environment == nullptr || trial.settings.shading.specular != SpecularModel::none || trial.settings.samples != 1) return false;
    if (trial.settings.shadows != ShadowMode::off) return false;
    for (const Mesh& mesh : trial.scene.meshes)
        if (!mesh.colors.empty()) return false;
    return std::all_of(trial.scene.materials.begin(), trial.scene.materials.end(), [](const Material& m) {
        return !m.base_color_texture.used() && !m.occlusion_texture.used() && !m.normal_texture.used() && !m.unlit && m.alpha_mode == AlphaMode::opaque;
    });
}

double add_whole_sky(const Trial& trial, const std::vector<std::uint32_t>& instance, const std::vector<float>& normal,
                     std::vector<float>& linear) {
    const std::vector<Patch> patches = patches_of(trial.sky, trial.sky_options.rotate_rad);
    const Lobe& lobe = trial.scene.materials[0].lobe;  // the same for all: see add_sky
    // f(x) from a table; linear interpolation is off by 3e-9 f''.
    constexpr int kSize = 1 << 14;
    std::vector<double> table(kSize + 2);
    for (int i = 0; i <= kSize + 1; ++i) table[static_cast<std::size_t>(i)] = shading::reference::lobe_value(lobe, std::min(1.0, 2.0 * i / kSize - 1));
    double most = 0;
    for (std::size_t k = 0; k < instance.size(); ++k) {
        if (instance[k] == 0) continue;
        const Vec3d n{normal[3 * k], normal[3 * k + 1], normal[3 * k + 2]};
        if (n == Vec3d{}) continue;  // no normal, no light
        Vec3d sum{};
        for (const Patch& p : patches) {
            const double u = (std::clamp(dot(n, p.direction), -1.0, 1.0) + 1) * (0.5 * kSize);
            const auto i = static_cast<std::size_t>(u);
            sum = sum + p.light * (table[i] + (u - static_cast<double>(i)) * (table[i + 1] - table[i]));
        }
        const Vec4f color = material_at(trial, instance[k]).base_color;
        const Vec3d light = sum * (double{trial.settings.exposure} * 1.0);
        most = std::max(most, largest(light));
        linear[4 * k] += static_cast<float>(light.x * double{color.x});
        linear[4 * k + 1] += static_cast<float>(light.y * double{color.y});
        linear[4 * k + 2] += static_cast<float>(light.z * double{color.z});
    }
    // The centres of patches stand for them: d^2/24 f'' of each, d their angle; below 5e-5 for patches of 2 degrees.
    return 1e-4 * most;
}

double reference_slack(const Trial& trial) {
    if (trial.scene.environment == nullptr) return 0;
    const double scale = std::max(1.0, double{trial.scene.materials[0].lobe.scale()});
    return 1e-5 * scale * double{trial.settings.exposure} * largest(sum_of(patches_of(trial.sky, 0)));
}

}  // namespace halflit::adversary
