#include "bench/shading_rows.hpp"

#include "shading/environment.hpp"
#include "shading/planner.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

namespace halflit::bench {
namespace {

using shading::LobePath;

/// Deterministic numbers in [-1, 1): a linear congruential generator's upper bits.
class Numbers {
public:
    float next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state_ >> 40) * 0x1p-23f - 1.0f;
    }
    Vec3f unit() {
        const Vec3f v{next(), next(), next() + 1.5f};
        const float inverse = 1.0f / std::sqrt(dot(v, v));
        return {v.x * inverse, v.y * inverse, v.z * inverse};
    }

private:
    std::uint64_t state_ = 1;
};

struct NamedLobe {
    const char* name;
    Lobe lobe;
};
const NamedLobe kLobes[] = {{"lambert", Lobe::lambert()},
                            {"green 0.5", Lobe::green(0.5f)},
                            {"valve", Lobe::valve()},
                            {"sloan 0.5", Lobe::sloan(0.5f)},
                            {"mcauley n=3", Lobe::mcauley(0.5f, 3)},
                            {"mcauley n=4", Lobe::mcauley(0.5f, 4)},
                            {"mcauley n=5", Lobe::mcauley(0.5f, 5)},
                            {"sloan 0.3", Lobe::sloan(0.3f)}};
constexpr std::pair<const char*, LightType> kTypes[] = {
    {"directional", LightType::directional}, {"point", LightType::point}, {"spot", LightType::spot}};

// ---- operations, counted in the kernels' source --------------------------------------------------------------------

constexpr int kDot = 5, kCross = 9, kVector = 3;

/// t^n by log2 and exp2 (power_of_unit): polynomials of degree 8 and 6, and the steps before, between and after them.
constexpr int kPowerOfUnit = 1 + (2 * 8 + 1) + 5 + 2 + 2 + 2 * 6 + 2 + 1;
/// The same for cosines (power_of_cosine): degrees 7 and 5.
constexpr int kPowerOfCosine = 1 + 1 + (2 * 7 + 2) + 1 + 2 + 1 + 2 * 5 + 2;

Operations lobe_operations(const shading::LobePlan& lobe) {
    const int t = 2;  // wrap and scale; the clamps are comparisons
    switch (lobe.path) {
        case LobePath::square:
            return {t + 1};
        case LobePath::sqrt_product:
            return {t + 1, 0, 1};
        case LobePath::integer:
            return {t + (lobe.integer_power == 5 ? 3 : 2)};
        case LobePath::general:
            return {t + kPowerOfUnit};
        default:
            return {t};
    }
}

Operations light_operations(LightType type) {
    const int n_dot_l = kDot, colour = 2 * kVector;  // colour times the lobe, added to the sum
    if (type == LightType::directional) return {n_dot_l + colour};
    // Offset, its squared length, unit direction; range window and inverse square; attenuation times the lobe.
    const int local = kVector + kDot + kVector + 3 + 1;
    const int cone = type == LightType::spot ? kVector + kDot + 1 + 2 + 2 : 0;  // versine from |L - A|^2, ramp, its square
    return {n_dot_l + colour + local + cone, 2, 1};
}

Operations specular_operations(LightType type) {
    const int terms = kVector + kDot + kCross + 2 * kDot;  // H, N.H, N x H, both squares
    const int strength = type == LightType::directional ? 0 : 1;
    return {terms + 3 + kPowerOfCosine + 1 + 2 * kVector + strength, 1, 0};
}

// ---- rows ----------------------------------------------------------------------------------------------------------

std::vector<Light> some_lights(LightType type, int count) {
    Numbers numbers;
    std::vector<Light> lights;
    for (int i = 0; i < count; ++i) {
        Light light;
        light.type = type;
        light.color_linear = {1.0f, 0.9f, 0.8f};
        const Vec3f from = numbers.unit();
        light.position_ws = from * 4.0f;
        light.direction_ws = from * -1.0f;
        light.range = 30.0f;
        light.inner_cone_rad = 0.1f;
        lights.push_back(light);
    }
    return lights;
}

const Environment& some_environment() {
    static const Environment environment = [] {
        Numbers numbers;
        std::vector<float> rgb(std::size_t{32} * 16 * 3);
        for (float& x : rgb) x = 1.0f + numbers.next();
        return shading::make_environment({32, 16, rgb}, {false, 0.0, false});
    }();
    return environment;
}

shading::ShadingPlan plan(const Material& material, const std::vector<Light>& lights, bool specular, int order = 0,
                          std::span<const Texture> textures = {}) {
    const shading::SlotMask all = ((1u << shading::kSlotCount) - 1u) & ~(1u << 3);  // all slots except the vertex colour
    const shading::SlotMask slots[] = {all, all};
    ShadingSettings options;
    options.specular = specular ? SpecularModel::blinn : SpecularModel::none;
    options.environment_bands = order;
    shading::ShadingPlan frame = shading::plan_shading({{&material, 1},
                                                        textures,
                                                        slots,
                                                        shading::plan_lights(lights),
                                                        {},
                                                        options,
                                                        order > 0 ? shading::borrowed(some_environment()) : nullptr});
    frame.eye_ws = {0.2f, 0.3f, 6.0f};
    return frame;
}

void add_light_rows(std::vector<Row>& rows, Work work) {
    for (const bool specular : {false, true})
        for (const auto& [type_name, type] : kTypes)
            for (const NamedLobe& lobe : kLobes) {
                Material material;
                material.lobe = lobe.lobe;
                material.roughness = 0.4f;
                Row row;
                row.name = std::string(type_name) + ", " + lobe.name + (specular ? ", Blinn" : "");
                row.work = work;
                row.specular = specular;
                for (const int count : {1, 4, 16}) {
                    row.lights.push_back(count);
                    row.frames.push_back(plan(material, some_lights(type, count), specular));
                }
                const shading::LobePlan& planned = row.frames[0].materials[0].lobe;
                // A highlight adds the same work to every lobe, so rows for three lobes are enough.
                if (specular && planned.path != LobePath::linear && planned.path != LobePath::square && planned.path != LobePath::general)
                    continue;
                if (specular && planned.path == LobePath::linear && planned.wrap > 0.0f) continue;
                if (work == Work::sum) {
                    row.operations = light_operations(type) + lobe_operations(planned);
                    if (specular) row.operations = row.operations + specular_operations(type);
                }
                row.largest_price = specular || planned.path == LobePath::general ? 0.35 : 0.12;
                row.least_gain = 7.0;
                rows.push_back(std::move(row));
            }
}

void add_environment_rows(std::vector<Row>& rows) {
    for (int order = 1; order <= sh::kMaxBands; ++order) {
        Row row;
        row.name = "environment, order " + std::to_string(order);
        row.work = Work::environment;
        row.lights = {0};
        row.frames = {plan({}, {}, false, order)};
        // A multiplication and an addition per channel for each coefficient except the leading one; z - node; powers of x + iy.
        row.operations = {6 * (order * order - 1) + (order - 1) + (order > 2 ? 6 * (order - 2) : 0)};
        row.largest_price = 0.12;
        rows.push_back(std::move(row));
    }
}

/// A whole pixel: normal map, four point lights with a general power and highlights, an environment of three bands, sRGB codes.
Row pixel_row() {
    Numbers numbers;
    std::vector<std::uint8_t> rgba8(std::size_t{64} * 64 * 4);
    for (std::uint8_t& byte : rgba8) byte = static_cast<std::uint8_t>(128.0f + 60.0f * numbers.next());
    static const Texture normals[] = {Texture::from_rgba8(rgba8, 64, 64, ColorSpace::linear).value()};
    Material material;
    material.lobe = Lobe::sloan(0.3f);
    material.roughness = 0.4f;
    material.textures[TextureSlot::normal].texture = 0;
    material.textures[TextureSlot::normal].sampler.mip = MipFilter::none;
    Row row;
    row.name = "whole pixel";
    row.work = Work::pixel;
    row.lights = {0};
    row.frames = {plan(material, some_lights(LightType::point, 4), true, 3, normals)};
    row.largest_price = 0.35;
    return row;
}

}  // namespace

std::vector<Row> shading_rows() {
    std::vector<Row> rows;
    add_light_rows(rows, Work::sum);
    add_light_rows(rows, Work::shade);
    add_environment_rows(rows);
    for (Row& row : rows) row.name = (row.work == Work::shade ? "shade: " : "") + row.name;
    Row encode;
    encode.name = "sRGB codes";
    encode.work = Work::encode;
    encode.lights = {0};
    encode.frames.emplace_back();
    // Three channels: exposure, two roots, a polynomial of degree 6, the curve's linear part, the code. Then alpha's code.
    encode.operations = {3 * (1 + 2 * 6 + 1 + 1) + 1, 0, 6};
    rows.push_back(std::move(encode));
    rows.push_back(pixel_row());
    Row peak;
    peak.name = "peak";
    peak.work = Work::peak;
    peak.lights = {0};
    peak.frames.emplace_back();
    peak.operations = {kPeakFlops};
    rows.push_back(std::move(peak));
    return rows;
}

shading::FragmentBlock filled_block() {
    Numbers numbers;
    shading::FragmentBlock block{};
    for (auto& row : block.lane)
        for (float& x : row) x = numbers.next();
    const auto set3 = [&](int row, int lane, Vec3f v) {
        block.lane[row][lane] = v.x, block.lane[row + 1][lane] = v.y, block.lane[row + 2][lane] = v.z;
    };
    for (int lane = 0; lane < shading::kBlockSize; ++lane) {
        set3(shading::kNormalX, lane, numbers.unit());
        set3(shading::kTangentX, lane, numbers.unit());
        block.lane[shading::kTangentW][lane] = 1.0f;
        block.red[lane] = block.green[lane] = block.blue[lane] = block.alpha[lane] = 0.5f + 0.5f * numbers.next();
    }
    return block;
}

}  // namespace halflit::bench
