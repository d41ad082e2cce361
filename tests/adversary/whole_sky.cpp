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

/// Directions that stand for the image: each pixel is cut into squares, and each square has the four points of Gauss's rule, of the fourth
/// order. Squares are at most 2.8 degrees wide, and 0.5 where one pixel has more than a hundredth of all light; twice that if `coarse`.
std::vector<Patch> patches_of(const EnvironmentImage& image, double turn_rad, bool coarse) {
    const double turn_sin = std::sin(turn_rad), turn_cos = std::cos(turn_rad);
    std::vector<Patch> out;
    const auto cut = [&](int x, int y, int cuts) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
        const Vec3d radiance{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
        const double rows = image.height * cuts, columns = image.width * cuts;
        const double near = 0.5 - 0.28867513459481287, points[] = {near, 1 - near};  // 1 / (2 sqrt(3))
        for (int j = y * cuts; j < (y + 1) * cuts; ++j)
            for (int i = x * cuts; i < (x + 1) * cuts; ++i)
                for (const double v : points)
                    for (const double u : points) {
                        const double weight = 0.25 * (2 * kPi / columns) * (kPi / rows) * std::sin(kPi * (j + v) / rows);
                        const Vec3d d = sh::equirect_direction((i + u) / columns, (j + v) / rows);
                        // Counter-clockwise about +y, seen from above.
                        const Vec3d turned{turn_cos * d.x + turn_sin * d.z, d.y, turn_cos * d.z - turn_sin * d.x};
                        out.push_back({turned, radiance * (weight / kPi)});
                    }
    };
    std::vector<double> levels;
    double total = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
            levels.push_back(sh::luminance({image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]}) *
                             std::sin(kPi * (y + 0.5) / image.height));
            total += levels.back();
        }
    const int step = coarse ? 2 : 1, cuts = std::max(1, 128 / (image.width * step)), fine = std::max(1, 800 / (image.width * step));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (const double level = levels[static_cast<std::size_t>(y * image.width + x)]; level > 0)
                cut(x, y, level > 0.01 * total ? fine : cuts);
    return out;
}

/// f(x) from a table. Linear interpolation is off by 2e-9 f''.
class LobeTable {
public:
    explicit LobeTable(const Lobe& lobe) {
        for (int i = 0; i <= kSize + 1; ++i)
            values_[static_cast<std::size_t>(i)] = shading::reference::lobe_value(lobe, std::min(1.0, 2.0 * i / kSize - 1));
    }
    [[nodiscard]] Vec3d light(const std::vector<Patch>& patches, Vec3d n) const {
        Vec3d sum{};
        for (const Patch& p : patches) {
            const double u = (std::clamp(dot(n, p.direction), -1.0, 1.0) + 1) * (0.5 * kSize);
            const auto i = static_cast<std::size_t>(u);
            sum = sum + p.light * (values_[i] + (u - static_cast<double>(i)) * (values_[i + 1] - values_[i]));
        }
        return sum;
    }

private:
    static constexpr int kSize = 1 << 14;
    std::vector<double> values_ = std::vector<double>(kSize + 2);
};

const Material& material_at(const Trial& trial, std::uint32_t instance) {
    const int mesh = trial.scene.instances[instance - 1].mesh;
    return trial.scene.materials[static_cast<std::size_t>(trial.scene.meshes[static_cast<std::size_t>(mesh)].material)];
}

double largest(Vec3d v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

bool whole_sky_applies(const Trial& trial) {
    if (trial.scene.environment == nullptr || trial.settings.shading.specular != SpecularModel::none || trial.settings.samples != 1)
        return false;
    if (trial.settings.shadows != ShadowMode::off) return false;
    for (const Mesh& mesh : trial.scene.meshes)
        if (!mesh.colors.empty()) return false;
    return std::all_of(trial.scene.materials.begin(), trial.scene.materials.end(), [](const Material& m) {
        return !m.textures[TextureSlot::base_color].used() && !m.textures[TextureSlot::occlusion].used() &&
               !m.textures[TextureSlot::normal].used() && !m.unlit && !m.is_layer();
    });
}

double add_whole_sky(const Trial& trial, const std::vector<std::uint32_t>& instance, const std::vector<float>& normal,
                     std::vector<float>& linear) {
    const double turn = trial.sky_options.rotate_rad, exposure = trial.settings.exposure;
    const std::vector<Patch> patches = patches_of(trial.sky, turn, false), coarse = patches_of(trial.sky, turn, true);
    const LobeTable lobe(trial.scene.materials[0].lobe);  // the same for all: see add_sky
    double most = 0, changed = 0;
    for (std::size_t k = 0; k < instance.size(); ++k) {
        if (instance[k] == 0) continue;
        const Vec3d n{normal[3 * k], normal[3 * k + 1], normal[3 * k + 2]};
        const Vec3d light = lobe.light(patches, n) * exposure;  // a zero normal has N.L = 0 for every direction
        most = std::max(most, largest(light));
        if (k % 8 == 0) {
            const Vec3d off = lobe.light(coarse, n) * exposure - light;
            changed = std::max({changed, std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)});
        }
        const Vec4f color = material_at(trial, instance[k]).base_color, own = trial.scene.instances[instance[k] - 1].color;
        linear[4 * k] += static_cast<float>(light.x * double{color.x * own.x});
        linear[4 * k + 1] += static_cast<float>(light.y * double{color.y * own.y});
        linear[4 * k + 2] += static_cast<float>(light.z * double{color.z * own.z});
    }
    // Squares of half the width have at most a fourth of the error, also where a lobe has a kink: the error is a third of the change.
    return 2 * changed + 1e-6 * most;
}

double reference_slack(const Trial& trial) {
    if (trial.scene.environment == nullptr) return 0;
    const double scale = std::max(1.0, double{trial.scene.materials[0].lobe.scale()});
    return 1e-5 * scale * double{trial.settings.exposure} * largest(sum_of(patches_of(trial.sky, 0, true)));
}

}  // namespace halflit::adversary
