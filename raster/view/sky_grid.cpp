#include "raster/view/sky_grid.hpp"

#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>

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

std::vector<float> hidden_shares(const CoverGrid& grid, const RasterKernels& kernels) {
    if (grid.empty()) return {};
    const CoverLayout &by_z = grid.along_x.layout, &by_x = grid.along_y.layout;
    const CoverLayout by_y{by_z.layers, by_z.rows, by_z.layer_step, by_z.row_step};
    const std::size_t count = grid.along_x.parts[0].size();
    std::vector<float> shares(count * shading::kGridDirections), turned(grid.along_y.parts[0].size()), work;
    float* out = shares.data();
    for (const Vec3d& d : shading::sky_directions(shading::kGridDirections)) {
        const Vec3d size = absolute(d);
        const double most = std::max({size.x, size.y, size.z});
        const Vec3d towards = d * (1.0 / most);
        const bool is_x = most == size.x, is_y = !is_x && most == size.y;
        CoverSweep sweep = sweep_of(is_x ? grid.along_y : grid.along_x, is_x ? by_x : is_y ? by_y : by_z, towards, work);
        sweep.along = static_cast<float>(is_x ? towards.y : towards.x);
        sweep.across = static_cast<float>(is_x || is_y ? towards.z : towards.y);
        sweep.from_last = (is_x ? towards.x : is_y ? towards.y : towards.z) > 0.0;
        sweep.hidden = is_x ? turned.data() : out;
        kernels.sweep_covers(sweep);
        for (int z = 0; is_x && z < grid.size[2]; ++z)
            for (int y = 0; y < grid.size[1]; ++y)
                for (int x = 0; x < grid.size[0]; ++x)
                    out[z * by_z.layer_step + y * by_z.row_step + x] =
                        turned[static_cast<std::size_t>(x * by_x.layer_step + z * by_x.row_step + y)];
        out += count;
    }
    return shares;
}

/// Terms of the light that is hidden, from the hidden shares of each direction.
std::vector<float> hidden_terms(const std::vector<float>& shares, std::span<const float> lights, const RasterKernels& kernels) {
    const std::vector<Vec3d> directions = shading::sky_directions(shading::kGridDirections);
    std::vector<float> factors;
    for (std::size_t d = 0; d < directions.size(); ++d) {
        const double towards[3] = {directions[d].x, directions[d].y, directions[d].z};
        double terms[shading::kGridTerms] = {};
        shading::add_grid_light(double{lights[d]}, towards, terms);
        for (const double term : terms) factors.push_back(static_cast<float>(term));
    }
    const std::size_t points = shares.size() / directions.size();
    std::vector<float> out(points * shading::kGridTerms);
    kernels.sum_grid_terms({shares.data(), factors.data(), shading::kGridDirections, static_cast<std::int64_t>(points), out.data()});
    return out;
}

}  // namespace

shading::SkyGridPlan make_sky_grid(const CoverGrid& covers, std::span<const shading::LightPlan> lights, const RasterKernels& kernels,
                                   SkyGrid& grid) {
    if (grid.revision != covers.revision) grid = {covers.revision, hidden_shares(covers, kernels), {}, {}};
    if (grid.hidden_shares.empty()) return {};
    std::vector<float> brightness(shading::kGridDirections, 0.0f);  // black ones are left out of the list
    for (const shading::LightPlan& light : lights) brightness[static_cast<std::size_t>(light.source)] = light.brightness;
    if (brightness != grid.lights) {
        grid.terms = hidden_terms(grid.hidden_shares, brightness, kernels);
        grid.lights = std::move(brightness);
    }
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
