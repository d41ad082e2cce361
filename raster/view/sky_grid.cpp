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

/// Memory for one direction.
struct Swept {
    std::vector<float> shares, turned, work;
};

/// Sets the share that is hidden at each point in a direction.
void sweep(const CoverGrid& grid, Vec3d direction, const RasterKernels& kernels, Swept& swept) {
    const CoverLayout &by_z = grid.along_x.layout, &by_x = grid.along_y.layout;
    const CoverLayout by_y{by_z.layers, by_z.rows, by_z.layer_step, by_z.row_step};
    swept.shares.resize(grid.along_x.parts[0].size()), swept.turned.resize(grid.along_y.parts[0].size());
    const Vec3d size = absolute(direction);
    const double most = std::max({size.x, size.y, size.z});
    const Vec3d towards = direction * (1.0 / most);
    const bool is_x = most == size.x, is_y = !is_x && most == size.y;
    CoverSweep sweep = sweep_of(is_x ? grid.along_y : grid.along_x, is_x ? by_x : is_y ? by_y : by_z, towards, swept.work);
    sweep.along = static_cast<float>(is_x ? towards.y : towards.x);
    sweep.across = static_cast<float>(is_x || is_y ? towards.z : towards.y);
    sweep.from_last = (is_x ? towards.x : is_y ? towards.y : towards.z) > 0.0;
    sweep.hidden = is_x ? swept.turned.data() : swept.shares.data();
    kernels.sweep_covers(sweep);
    for (int z = 0; is_x && z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y) {
            float* const out = swept.shares.data() + (z * by_z.layer_step + y * by_z.row_step);
            const float* const from = swept.turned.data() + (z * by_x.row_step + y);
            for (int x = 0; x < grid.size[0]; ++x) out[x] = from[x * by_x.layer_step];
        }
}

/// Terms of the light that is hidden at each point. lights: of each direction.
std::vector<float> hidden_terms(const CoverGrid& grid, std::span<const float> lights, const RasterKernels& kernels,
                                const shading::ForEachRow& for_each) {
    if (grid.empty()) return {};
    constexpr int kTerms = shading::kGridTerms, kPointsATask = 64 * kCoverPitch;
    const std::vector<Vec3d> directions = shading::sky_directions(shading::kGridDirections);
    const auto count = static_cast<std::int64_t>(grid.along_x.parts[0].size());
    std::vector<float> sums(static_cast<std::size_t>(count * kTerms));
    std::vector<Swept> swept(kSweptAtOnce);
    for (std::size_t first = 0; first < directions.size(); first += kSweptAtOnce) {
        GridTermSums all{};
        all.directions = std::min(kSweptAtOnce, static_cast<int>(directions.size() - first));
        for_each(all.directions, [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            const Vec3d d = directions[first + k];
            sweep(grid, d, kernels, swept[k]);
            const double towards[3] = {d.x, d.y, d.z};
            double terms[kTerms] = {};
            shading::add_grid_light(double{lights[first + k]}, towards, terms);
            std::copy(std::begin(terms), std::end(terms), all.factors[i]);
            all.shares[i] = swept[k].shares.data();
        });
        all.points = count, all.sums = sums.data();
        for_each(static_cast<int>((count + kPointsATask - 1) / kPointsATask), [&](int task) {
            GridTermSums part = all;
            part.first = std::int64_t{task} * kPointsATask, part.end = std::min(part.first + kPointsATask, count);
            kernels.add_grid_terms(part);
        });
    }
    std::vector<float> out(sums.size());
    const float* from = sums.data();
    for (float* to = out.data(); from != sums.data() + count; ++from, to += kTerms)
        for (int k = 0; k < kTerms; ++k) to[k] = from[k * count];
    return out;
}

}  // namespace

shading::SkyGridPlan make_sky_grid(const CoverGrid& covers, std::span<const shading::LightPlan> lights, const RasterKernels& kernels,
                                   const shading::ForEachRow& for_each, SkyGrid& grid) {
    std::vector<float> brightness(shading::kGridDirections, 0.0f);  // black ones are left out of the list
    for (const shading::LightPlan& light : lights) brightness[static_cast<std::size_t>(light.source)] = light.brightness;
    if (grid.revision != covers.revision || brightness != grid.lights) {
        grid.terms = hidden_terms(covers, brightness, kernels, for_each);
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
