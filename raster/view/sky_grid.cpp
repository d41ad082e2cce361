#include "raster/view/sky_grid.hpp"

#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <iterator>

namespace halflit::raster {
namespace {

static_assert(shading::kGridFade < kCoverMargin, "the scene's own shares would fade");

/// Factor on covers, as those along a way through a slanted wall may add up to a little less than 1.
constexpr float kTight = 1.1f;

CoverSweep sweep_of(const LatticeCovers& covers, const CoverLayout& layout, Vec3d towards, std::vector<float>& work) {
    CoverSweep sweep{};
    for (std::size_t k = 0; k < kCoverParts; ++k) sweep.parts[k] = covers.parts[k].data();
    sweep.filled = covers.filled.data();
    sweep.layout = layout;
    const double d[3] = {towards.x, towards.y, towards.z};
    for (int k = 0; k < 3; ++k) {
        sweep.towards[k] = kTight * static_cast<float>(d[k]);
        sweep.size[k] = kTight * static_cast<float>(absolute(d[k]));
    }
    work.assign(2 * static_cast<std::size_t>(layout.rows + 2) * kSweepPitch, 0.0f);
    sweep.work = work.data();
    return sweep;
}

/// Terms of the light that is hidden at each point. lights: of each direction.
std::vector<float> hidden_terms(const CoverGrid& grid, std::span<const float> lights, const RasterKernels& kernels) {
    if (grid.empty()) return {};
    const CoverLayout &by_z = grid.along_x.layout, &by_x = grid.along_y.layout;
    const CoverLayout by_y{by_z.layers, by_z.rows, by_z.layer_step, by_z.row_step};
    const std::size_t count = grid.along_x.parts[0].size();
    std::vector<float> shares(count), turned(grid.along_y.parts[0].size()), work, sums(count * shading::kGridTerms);
    const float* light = lights.data();
    for (const Vec3d& d : shading::sky_directions(shading::kGridDirections)) {
        const Vec3d size = absolute(d);
        const double most = std::max({size.x, size.y, size.z});
        const Vec3d towards = d * (1.0 / most);
        const bool is_x = most == size.x, is_y = !is_x && most == size.y;
        CoverSweep sweep = sweep_of(is_x ? grid.along_y : grid.along_x, is_x ? by_x : is_y ? by_y : by_z, towards, work);
        sweep.along = static_cast<float>(is_x ? towards.y : towards.x);
        sweep.across = static_cast<float>(is_x || is_y ? towards.z : towards.y);
        sweep.from_last = (is_x ? towards.x : is_y ? towards.y : towards.z) > 0.0;
        sweep.hidden = is_x ? turned.data() : shares.data();
        kernels.sweep_covers(sweep);
        for (int z = 0; is_x && z < grid.size[2]; ++z)
            for (int y = 0; y < grid.size[1]; ++y)
                for (int x = 0; x < grid.size[0]; ++x)
                    shares[static_cast<std::size_t>(z * by_z.layer_step + y * by_z.row_step + x)] =
                        turned[static_cast<std::size_t>(x * by_x.layer_step + z * by_x.row_step + y)];
        const double direction[3] = {d.x, d.y, d.z};
        double terms[shading::kGridTerms] = {};
        shading::add_grid_light(double{*light++}, direction, terms);
        float factors[shading::kGridTerms];
        std::copy(std::begin(terms), std::end(terms), factors);
        kernels.add_grid_terms(shares.data(), factors, static_cast<std::int64_t>(count), sums.data());
    }
    std::vector<float> out(sums.size());
    for (std::size_t p = 0; p < count; ++p)
        for (std::size_t k = 0; k < shading::kGridTerms; ++k) out[p * shading::kGridTerms + k] = sums[k * count + p];
    return out;
}

}  // namespace

shading::SkyGridPlan make_sky_grid(const CoverGrid& covers, std::span<const shading::LightPlan> lights, const RasterKernels& kernels,
                                   SkyGrid& grid) {
    std::vector<float> brightness(shading::kGridDirections, 0.0f);  // black ones are left out of the list
    for (const shading::LightPlan& light : lights) brightness[static_cast<std::size_t>(light.source)] = light.brightness;
    if (grid.revision != covers.revision || brightness != grid.lights) {
        grid.terms = hidden_terms(covers, brightness, kernels);
        grid.lights = std::move(brightness);
        grid.revision = covers.revision;
    }
    if (grid.terms.empty()) return {};
    shading::SkyGridPlan plan;
    plan.hidden = grid.terms.data();
    for (int axis = 0; axis < 3; ++axis) {
        plan.size[axis] = covers.size[axis];
        plan.origin[axis] = static_cast<float>(covers.origin[axis]);
    }
    plan.row = static_cast<std::int32_t>(covers.along_x.layout.row_step);
    plan.layer = static_cast<std::int32_t>(covers.along_x.layout.layer_step);
    plan.per_length = static_cast<float>(covers.per_length);
    return plan;
}

}  // namespace halflit::raster
