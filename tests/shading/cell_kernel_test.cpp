// Light in cells: the fitted light of a cell is within its tolerance of the light that the pixels compute by themselves, at every pixel,
// and every instruction set fits the same bits.
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace halflit;
using namespace halflit::shading;
using halflit::test::Random;

namespace {

Vec3f some_vector(Random& random) {
    for (;;) {
        const Vec3f v{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        const float squared = dot(v, v);
        if (squared > 0.01f && squared <= 1.0f) return v;
    }
}
Vec3f some_direction(Random& random) { return normalize_or(some_vector(random), {0, 0, 1}); }

/// A surface of a few pixels under some lights.
struct CellCase {
    ShadingPlan plan;
    FragmentBlock block{};
    int count = kBlockSize;
};

Light some_light(Random& random, Vec3f normal) {
    Light light;
    light.type = static_cast<LightType>(random.index(3));
    const Vec3f towards = normalize_or(normal + some_direction(random) * random.real32(0.2, 3), normal);
    const float distance = static_cast<float>(std::pow(10.0, random.real(-0.5, 1.5)));
    light.position_ws = towards * distance;
    light.direction_ws = towards * -1.0f;
    if (light.type == LightType::spot) {
        light.outer_cone_rad = random.real32(0.1, 1.5);
        light.inner_cone_rad = light.outer_cone_rad * random.real32(0, 0.99);
        light.cone_power = random.chance(0.2) ? 2.0f : 0.0f;
        light.direction_ws = normalize_or(light.direction_ws + some_direction(random) * random.real32(0, 0.5), {0, 0, -1});
    }
    if (random.chance(0.3)) light.range = distance * random.real32(0.9, 4);
    if (random.chance(0.2)) light.source_radius = distance * random.real32(0.1, 1.1);
    const float level = light.type == LightType::directional ? 1.0f : distance * distance;
    light.color_linear = {level * random.real32(0, 1), level * random.real32(0.1, 1), level * random.real32(0.1, 1)};
    return light;
}

/// Normals and positions anywhere within two radii, so that bounds hold for any surface.
void fill_block(Random& random, Vec3f normal, Vec3f center, CellCase& c) {
    const auto radius = [&] { return random.chance(0.15) ? 0.0f : static_cast<float>(std::pow(10.0, random.real(-3, -0.8))); };
    const float turn = radius(), size = radius();
    c.count = 1 + random.index(kBlockSize);
    for (int l = 0; l < kBlockSize; ++l) {
        const bool copy = l >= c.count;
        const Vec3f n = normalize_or(normal + some_vector(random) * turn, normal), p = center + some_vector(random) * size;
        const float values[] = {p.x, p.y, p.z, n.x, n.y, n.z};
        for (int i = 0; i < 6; ++i) c.block.lane[kPosX + i][l] = copy ? c.block.lane[kPosX + i][c.count - 1] : values[i];
    }
}

CellCase some_case(Random& random, const Lobe& lobe, bool highlights) {
    Material material;
    material.lobe = lobe;
    material.metallic = 0.0f;
    const int kind = random.index(10);
    material.roughness = kind == 0 ? 1.0f : kind < 3 ? random.real32(0.93, 1) : random.real32(kind < 6 ? 0.05 : 0.3, 1);
    material.base_color = highlights ? Vec4f{0, 0, 0, 1} : Vec4f{1, 1, 1, 1};
    const Vec3f normal = some_direction(random);
    std::vector<Light> lights;
    for (int i = 0, count = 1 + random.index(6); i < count; ++i) lights.push_back(some_light(random, normal));
    const SlotMask slots[] = {kBaseSlots, kBaseSlots};
    ShadingSettings options;
    options.specular = highlights ? SpecularModel::blinn : SpecularModel::none;
    CellCase c;
    PlanInputs inputs{.materials = std::span(&material, 1),
                      .textures = {},
                      .available_slots = slots,
                      .lights = plan_lights(lights),
                      .ambient = {},
                      .options = options};
    inputs.viewer.eye_ws = normalize_or(normal + some_direction(random) * 1.2f, normal) * random.real32(2, 20);
    inputs.viewer.orthographic = random.chance(0.2);
    inputs.viewer.view_direction_ws = normalize_or(inputs.viewer.eye_ws * -1.0f, {0, 0, -1});
    c.plan = plan_shading(inputs);
    fill_block(random, normal, {0, 0, 0}, c);
    return c;
}

struct Fit {
    CellBatch batch;
    std::vector<std::uint16_t> exact;
};

/// A batch without cells.
CellBatch no_cells() {
    CellBatch batch{};
    for (int i = 0; i < kCellLanes; ++i) {
        batch.normal[2][i] = 1.0f;
        batch.normal_radius[i] = batch.position_radius[i] = kNoCell;
    }
    return batch;
}

Fit fit(const CellCase& c, Isa isa) {
    Fit f{no_cells(), {}};
    f.batch.count = 1;
    f.exact.assign(c.plan.lights.size(), 0);
    shade_kernels(isa).measure_cell(c.plan.materials[0], c.block, c.count, f.batch, 0);
    shade_kernels(isa).fit_cells(c.plan, c.plan.materials[0], all_lights(c.plan), f.batch, f.exact.data());
    return f;
}

LightCell first_cell(const CellBatch& batch) {
    LightCell cell{};
    for (int i = 0; i < 3; ++i) cell.normal[i] = batch.normal[i][0], cell.position[i] = batch.position[i][0];
    cell.inv_position_radius = batch.position_radius[0] > 1e-30f ? 1.0f / batch.position_radius[0] : 0.0f;
    cell.flat = batch.normal_radius[0] == 0.0f;
    cell.shines = (batch.shining & 1) != 0;
    for (int t = 0; t < kCellTerms; ++t)
        for (int k = 0; k < 3; ++k) {
            cell.term[t][k] = batch.term[t][k][0];
            cell.highlight[t][k] = cell.shines ? batch.highlight[t][k][0] : 0.0f;
        }
    return cell;
}

struct Tally {
    double worst = 0;  ///< error / tolerance
    int fitted = 0, lights = 0;
};

/// Compares fitted with exact light at the pixels of random cells.
Tally compare(std::uint64_t first_seed, int cases, bool highlights, float tolerance) {
    Tally tally;
    for (int k = 0; k < cases; ++k) {
        Random random(first_seed + static_cast<std::uint64_t>(k));
        constexpr float kPowers[] = {1.0f, 1.5f, 2.0f, 3.0f};
        const float power = random.chance(0.4) ? random.real32(1, 3) : kPowers[random.index(4)];
        const Lobe lobe{random.chance(0.3) ? static_cast<float>(random.index(2)) : random.real32(0, 1), power, false};
        CellCase c = some_case(random, lobe, highlights);
        CellTolerance& cells = c.plan.materials[0].cells;
        // Highlights over black: their own tolerance is absolute, and the lobe's light does not show.
        cells.relative = highlights ? 1e6f : tolerance;
        cells.absolute = highlights ? 1e6f : 1e-3f * tolerance;
        cells.absolute_specular = highlights ? tolerance : 3e38f;
        const float rough = std::max(0.07f, c.plan.materials[0].roughness), alpha = rough * rough;
        cells.half_exponent = 1.0f / (alpha * alpha) - 1.0f;
        cells.peak = 1.001f * ((cells.half_exponent + 3.0f) * 0.25f + 0.5f / (cells.half_exponent + 2.0f));
        const Fit f = fit(c, Isa::scalar);
        const LightCell cell = first_cell(f.batch);
        std::vector<LightPlan> left;
        for (std::size_t i = 0; i < f.exact.size(); ++i)
            if (f.exact[i] & 1) left.push_back(c.plan.lights[i]);
        tally.lights += static_cast<int>(f.exact.size());
        tally.fitted += static_cast<int>(f.exact.size() - left.size());
        FragmentBlock drawn = c.block, truth = c.block;
        const ShadeKernels& kernels = shade_kernels(Isa::scalar);
        kernels.shade(c.plan, c.plan.materials[0], {left.data(), static_cast<int>(left.size()), &cell}, drawn, c.count);
        kernels.shade(c.plan, c.plan.materials[0], all_lights(c.plan), truth, c.count);
        // Error of the light that the pixels compute: a highlight's logarithm is off by the error of its angle times sqrt(2 s).
        const double own_rounding = 2e-6 + (highlights ? 1e-6 * std::sqrt(2.0 * cells.half_exponent) : 0.0);
        double brightest = 0;
        for (const LightPlan& light : c.plan.lights) brightest += light.brightness;
        for (int l = 0; l < c.count; ++l)
            for (const auto& [a, b] :
                 {std::pair{drawn.red[l], truth.red[l]}, {drawn.green[l], truth.green[l]}, {drawn.blue[l], truth.blue[l]}}) {
                const double allowed = highlights ? 0.04 * tolerance : tolerance * double{b} + 1e-3 * tolerance;
                const double error = std::fabs(double{a} - double{b}), rounding = own_rounding * double{b} + 1e-9 * brightest;
                const double ratio = (error - rounding) / allowed;
                if (ratio > tally.worst) tally.worst = ratio;
                INFO("seed " << first_seed + static_cast<std::uint64_t>(k) << ", lane " << l << ", drawn " << a << ", true " << b
                             << ", power " << power << ", wrap " << lobe.wrap << ", lights " << f.exact.size() << ", left " << left.size());
                if (!(ratio <= 1.0)) FAIL_CHECK("error above the tolerance: " << error << " > " << allowed);
            }
    }
    return tally;
}

/// The same for lobe and highlight together, whose error is a share of the lobe's light.
Tally compare_both(std::uint64_t first_seed, int cases, float tolerance) {
    Tally tally;
    for (int k = 0; k < cases; ++k) {
        Random random(first_seed + static_cast<std::uint64_t>(k));
        CellCase c = some_case(random, Lobe{random.real32(0, 1), random.chance(0.5) ? 1.0f : random.real32(1, 3), false}, true);
        MaterialPlan& material = c.plan.materials[0];
        const float color = random.real32(0.05, 1), metallic = random.chance(0.5) ? 0.0f : random.real32(0, 0.99);
        for (int i = 0; i < 3; ++i) material.base_color[i] = color;
        material.metallic = metallic;
        material.dielectric = random.chance(0.5) ? 0.04f : random.real32(0, 0.9);
        material.refracted = 1.0f - material.dielectric;
        const double plain = material.dielectric, albedo = (1.0 - plain) * (1.0 - metallic) * color;
        const double f0 = plain + metallic * (color - plain);
        const float rough = std::max(0.07f, material.roughness), alpha = rough * rough, half_exponent = 1.0f / (alpha * alpha) - 1.0f;
        material.cells = {tolerance, 1e-3f * tolerance, static_cast<float>(1.001 * f0 / albedo),
                          3e38f,     half_exponent,     1.001f * ((half_exponent + 3.0f) * 0.25f + 0.5f / (half_exponent + 2.0f))};
        const Fit f = fit(c, Isa::scalar);
        const LightCell cell = first_cell(f.batch);
        std::vector<LightPlan> left;
        for (std::size_t i = 0; i < f.exact.size(); ++i)
            if (f.exact[i] & 1) left.push_back(c.plan.lights[i]);
        tally.lights += static_cast<int>(f.exact.size());
        tally.fitted += static_cast<int>(f.exact.size() - left.size());
        FragmentBlock drawn = c.block, truth = c.block, matt = c.block;
        const ShadeKernels& kernels = shade_kernels(Isa::scalar);
        kernels.shade(c.plan, material, {left.data(), static_cast<int>(left.size()), &cell}, drawn, c.count);
        kernels.shade(c.plan, material, all_lights(c.plan), truth, c.count);
        material.stages &= ~static_cast<std::uint32_t>(kStageSpecular);
        kernels.shade(c.plan, material, all_lights(c.plan), matt, c.count);
        for (int l = 0; l < c.count; ++l) {
            const double light = double{matt.red[l]} / color, error = std::fabs(double{drawn.red[l]} - double{truth.red[l]});
            const double allowed = albedo * (tolerance * light + 1e-3 * tolerance);
            const double rounding = (2e-6 + 1e-6 * std::sqrt(2.0 * half_exponent)) * double{truth.red[l]} + 1e-8;
            tally.worst = std::max(tally.worst, (error - rounding) / allowed);
            INFO("seed " << first_seed + static_cast<std::uint64_t>(k) << ", lane " << l << ", drawn " << drawn.red[l] << ", true "
                         << truth.red[l] << ", roughness " << material.roughness << ", metallic " << metallic << ", color " << color
                         << ", lights " << f.exact.size() << ", left " << left.size());
            if (!(error - rounding <= allowed)) FAIL_CHECK("error above the tolerance: " << error << " > " << allowed);
        }
    }
    return tally;
}

}  // namespace

TEST_CASE("cells: fitted light through lobe and highlight is within its tolerance at every pixel", "[cells]") {
    for (const float tolerance : {0.1f, 0.01f, 1e-3f}) {
        const Tally tally = compare_both(20001, 2000, tolerance);
        INFO("tolerance " << tolerance << ": worst " << tally.worst << ", fitted " << tally.fitted << " of " << tally.lights);
        CHECK(tally.worst > 0.02);
        CHECK(tally.fitted * 20 > tally.lights);
    }
}

TEST_CASE("cells: fitted light through the lobe is within its tolerance at every pixel", "[cells]") {
    for (const float tolerance : {0.1f, 0.01f, 1e-3f, 1e-4f}) {
        const Tally tally = compare(1, 2000, false, tolerance);
        INFO("tolerance " << tolerance << ": worst " << tally.worst << ", fitted " << tally.fitted << " of " << tally.lights);
        CHECK(tally.worst > 0.02);  // the bound is not idle
        CHECK(tally.fitted * 8 > tally.lights);
    }
}

TEST_CASE("cells: fitted highlights are within their tolerance at every pixel", "[cells]") {
    for (const float tolerance : {0.1f, 0.01f, 1e-3f, 1e-4f}) {
        const Tally tally = compare(10001, 2000, true, tolerance);
        INFO("tolerance " << tolerance << ": worst " << tally.worst << ", fitted " << tally.fitted << " of " << tally.lights);
        CHECK(tally.worst > 0.02);
        CHECK(tally.fitted * 20 > tally.lights);
    }
}

TEST_CASE("cells: every instruction set fits the same bits", "[cells]") {
    const auto isas = halflit::test::available_isas();
    for (std::uint64_t seed = 30001; seed <= 30400; ++seed) {
        Random random(seed);
        CellCase c =
            some_case(random, Lobe{random.real32(0, 1), random.chance(0.5) ? 1.5f : random.real32(1, 3), false}, random.chance(0.5));
        c.plan.materials[0].cells = {0.01f, 1e-4f, random.chance(0.5) ? 0.05f : 0.0f, 0.01f, 5.0f, 2.1f};
        const Fit want = fit(c, Isa::scalar);
        for (const Isa isa : isas) {
            const Fit got = fit(c, isa);
            INFO("seed " << seed << ", " << isa_name(isa));
            bool same_lights = true;  // bits of other cells have no meaning
            for (std::size_t i = 0; i < want.exact.size(); ++i) same_lights &= (want.exact[i] & 1) == (got.exact[i] & 1);
            CHECK(same_lights);
            CHECK((want.batch.shining & 1) == (got.batch.shining & 1));
            const LightCell a = first_cell(want.batch), b = first_cell(got.batch);
            bool same = std::memcmp(&a.normal, &b.normal, sizeof a.normal + sizeof a.position + sizeof a.inv_position_radius) == 0;
            for (int t = 0; t < kCellTerms; ++t)
                for (int k = 0; k < 3; ++k) same &= a.term[t][k] == b.term[t][k] && a.highlight[t][k] == b.highlight[t][k];
            CHECK(same);
        }
    }
}

TEST_CASE("cells: a cell among others is fitted as it is alone, bit for bit", "[cells]") {
    for (std::uint64_t seed = 40001; seed <= 40060; ++seed) {
        Random random(seed);
        CellCase c =
            some_case(random, Lobe{random.real32(0, 1), random.chance(0.5) ? 1.0f : random.real32(1, 3), false}, random.chance(0.7));
        c.plan.materials[0].cells = {0.01f, 1e-4f, random.chance(0.5) ? 0.05f : 0.0f, 0.01f, 5.0f, 2.1f};
        // Near and far cells, flat and curved ones, with any normals; one without a cell, one far beyond the squares of float32.
        std::vector<CellCase> cells(kCellLanes, c);
        for (int i = 0; i < kCellLanes; ++i)
            fill_block(random, some_direction(random), some_vector(random) * (i == 5 ? 2e19f : static_cast<float>(i)),
                       cells[static_cast<std::size_t>(i)]);
        for (const Isa isa : halflit::test::available_isas()) {
            const ShadeKernels& kernels = shade_kernels(isa);
            CellBatch batch = no_cells();
            batch.count = kCellLanes - 1;
            for (int i = 0; i < batch.count; ++i)
                kernels.measure_cell(c.plan.materials[0], cells[static_cast<std::size_t>(i)].block,
                                     cells[static_cast<std::size_t>(i)].count, batch, i);
            std::vector<std::uint16_t> exact(c.plan.lights.size(), 0);
            kernels.fit_cells(c.plan, c.plan.materials[0], all_lights(c.plan), batch, exact.data());
            for (int i = 0; i < batch.count; ++i) {
                const Fit alone = fit(cells[static_cast<std::size_t>(i)], isa);
                INFO("seed " << seed << ", cell " << i << ", " << isa_name(isa));
                bool same = (batch.shining >> i & 1) == (alone.batch.shining & 1);
                for (std::size_t k = 0; k < exact.size(); ++k) same &= (exact[k] >> i & 1) == (alone.exact[k] & 1);
                for (int t = 0; t < kCellTerms; ++t) {
                    // Pixels of a flat cell do not read the terms with n.
                    const bool with_n = (t >= kTermN && t < kTermP) || (t >= kTermNN && t < kTermPP);
                    if (with_n && batch.normal_radius[i] == 0.0f) continue;
                    for (int k = 0; k < 3; ++k) {
                        same &= batch.term[t][k][i] == alone.batch.term[t][k][0];
                        if ((batch.shining >> i & 1) != 0) same &= batch.highlight[t][k][i] == alone.batch.highlight[t][k][0];
                    }
                }
                CHECK(same);
            }
        }
    }
}
