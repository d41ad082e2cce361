#include "raster/view/sky_grid.hpp"

#include "sh/vec3d.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::raster {
namespace {

static_assert(shading::kGridFade < kCoverMargin, "the scene's own shares would fade");

/// Factor on covers, as those along a way through a slanted wall may add up to a little less than 1.
constexpr float kTight = 1.1f;

/// Rows along one axis, which lie in layers: numbers of them, and steps in memory.
struct Rows {
    int length, rows, layers;
    std::ptrdiff_t row_step, layer_step;
};

/// The covers of a grid as rows of each of their numbers, with rows along x in layers of z, or along y in layers of x.
struct CoverRows {
    static constexpr std::size_t kParts = 7;

    Rows place;
    std::array<std::vector<float>, kParts> parts;
    std::vector<bool> filled;  ///< of each row: some cover is not 0

    CoverRows(const CoverGrid& grid, bool along_y) {
        const int(&size)[3] = grid.size;
        const std::ptrdiff_t step[3] = {1, size[0], std::ptrdiff_t{size[0]} * size[1]};
        const int along = along_y ? 1 : 0, across = along_y ? 2 : 1, layer = along_y ? 0 : 2;
        place = {size[along], size[across], size[layer], size[along], std::ptrdiff_t{size[along]} * size[across]};
        for (std::vector<float>& part : parts) part.resize(grid.covers.size());
        std::size_t out = 0;
        for (int k = 0; k < place.layers; ++k)
            for (int r = 0; r < place.rows; ++r) {
                bool any = false;
                if (along_y || grid.rows[grid.row(r, k)])
                    for (int i = 0; i < place.length; ++i) {
                        const Cover& cover = grid.covers[static_cast<std::size_t>(i * step[along] + r * step[across] + k * step[layer])];
                        const float numbers[kParts] = {cover.facing[0], cover.facing[1], cover.facing[2], cover.both[0],
                                                       cover.both[1],   cover.both[2],   cover.back};
                        for (std::size_t p = 0; p < kParts; ++p) {
                            parts[p][out + static_cast<std::size_t>(i)] = numbers[p];
                            any |= numbers[p] != 0.0f;
                        }
                    }
                filled.push_back(any);
                out += static_cast<std::size_t>(place.length);
            }
    }
};

/// Follows one direction through a grid.
class Sweep {
public:
    Sweep(const CoverRows& covers, const Rows& rows, const float (&direction)[3]) : covers_(covers), rows_(rows) {
        for (int k = 0; k < 3; ++k) towards_[k] = direction[k], size_[k] = std::abs(direction[k]);
    }

    /// along, across: how far the direction goes from a layer to the next, at most 1. Writes the share that is hidden at each point.
    void run(float along, float across, bool from_last, float* hidden) {
        const std::size_t stride = static_cast<std::size_t>(rows_.length) + 2, area = stride * (static_cast<std::size_t>(rows_.rows) + 2);
        std::vector<float> before(area), after(area), mixed(stride);
        const int first = along < 0.0f ? 0 : 1;  // of the two points that are mixed, in rows with a point before the first
        const float u = along < 0.0f ? along + 1.0f : along, v = across < 0.0f ? across + 1.0f : across;
        const std::size_t below = across < 0.0f ? 0 : 1;
        bool any = false;
        for (int k = 0; k < rows_.layers; ++k) {
            const int layer = from_last ? rows_.layers - 1 - k : k;
            for (int r = 0; r < rows_.rows; ++r) {
                const std::ptrdiff_t at = layer * rows_.layer_step + r * rows_.row_step;
                float* const out = hidden + at;
                float* const next = &after[(static_cast<std::size_t>(r) + 1) * stride + 1];
                if (any) {
                    const float* const lower = &before[(static_cast<std::size_t>(r) + below) * stride];
                    const float* const upper = lower + stride;
                    for (std::size_t i = 0; i < stride; ++i) mixed[i] = lower[i] + (upper[i] - lower[i]) * v;
                    const float* const from = &mixed[static_cast<std::size_t>(first)];
                    for (int i = 0; i < rows_.length; ++i) out[i] = from[i] + (from[i + 1] - from[i]) * u;
                } else {
                    std::fill_n(out, rows_.length, 0.0f);
                }
                if (covers_.filled[static_cast<std::size_t>(at / covers_.place.row_step)])
                    add_covers(at, out, next);
                else
                    std::copy_n(out, rows_.length, next);
            }
            any = true;
            before.swap(after);
        }
    }

private:
    void add_covers(std::ptrdiff_t at, const float* from, float* to) const {
        const float* part[CoverRows::kParts];
        for (std::size_t p = 0; p < CoverRows::kParts; ++p) part[p] = covers_.parts[p].data() + at;
        const float x = towards_[0], y = towards_[1], z = towards_[2], ax = size_[0], ay = size_[1], az = size_[2];
        for (int i = 0; i < rows_.length; ++i) {
            const float front = part[0][i] * x + part[1][i] * y + part[2][i] * z;
            const float rest = part[3][i] * ax + part[4][i] * ay + part[5][i] * az;
            const float sum = from[i] + (front > 0.0f ? front : -part[6][i] * front) + rest;
            to[i] = sum < 1.0f ? sum : 1.0f;
        }
    }

    const CoverRows& covers_;
    Rows rows_;
    float towards_[3], size_[3];
};

std::vector<float> hidden_shares(const CoverGrid& grid) {
    const std::size_t count = grid.covers.size();
    if (count == 0) return {};
    const CoverRows along_x(grid, false), along_y(grid, true);
    const Rows &by_z = along_x.place, &by_x = along_y.place;
    const Rows by_y{by_z.length, by_z.layers, by_z.rows, by_z.layer_step, by_z.row_step};
    std::vector<float> shares(count * shading::kGridDirections), turned(count);
    float* out = shares.data();
    for (const Vec3d& d : shading::sky_directions(shading::kGridDirections)) {
        const double ax = absolute(d.x), ay = absolute(d.y), az = absolute(d.z), most = std::max({ax, ay, az});
        const float x = static_cast<float>(d.x / most), y = static_cast<float>(d.y / most), z = static_cast<float>(d.z / most);
        const float direction[3] = {x * kTight, y * kTight, z * kTight};
        if (most == az) {
            Sweep(along_x, by_z, direction).run(x, y, z > 0.0f, out);
        } else if (most == ay) {
            Sweep(along_x, by_y, direction).run(x, z, y > 0.0f, out);
        } else {
            Sweep(along_y, by_x, direction).run(y, z, x > 0.0f, turned.data());
            const float* from = turned.data();
            const std::ptrdiff_t row = grid.size[0], layer = row * grid.size[1];
            for (int i = 0; i < by_x.layers; ++i)
                for (int k = 0; k < by_x.rows; ++k)
                    for (int j = 0; j < by_x.length; ++j) out[k * layer + j * row + i] = *from++;
        }
        out += count;
    }
    return shares;
}

/// Terms of the light that is hidden, from the hidden shares of each direction.
std::vector<float> hidden_terms(const std::vector<float>& shares, std::span<const float> lights) {
    constexpr std::size_t kTerms = shading::kGridTerms, kTogether = 32;
    const std::vector<Vec3d> directions = shading::sky_directions(shading::kGridDirections);
    std::array<std::array<float, kTerms>, shading::kGridDirections> factors{};
    for (std::size_t d = 0; d < directions.size(); ++d) {
        const double towards[3] = {directions[d].x, directions[d].y, directions[d].z};
        double terms[kTerms] = {};
        shading::add_grid_light(double{lights[d]}, towards, terms);
        for (std::size_t k = 0; k < kTerms; ++k) factors[d][k] = static_cast<float>(terms[k]);
    }
    const std::size_t count = shares.size() / directions.size();
    std::vector<float> out(count * kTerms);
    for (std::size_t first = 0; first < count; first += kTogether) {
        const std::size_t end = std::min(kTogether, count - first);
        float sums[kTerms][kTogether] = {};
        bool any = false;
        for (std::size_t d = 0; d < directions.size(); ++d) {
            const float* const from = &shares[d * count + first];
            float most = 0.0f;
            for (std::size_t i = 0; i < end; ++i) most = most > from[i] ? most : from[i];
            if (!(most > 0.0f) || lights[d] == 0.0f) continue;
            any = true;
            for (std::size_t k = 0; k < kTerms; ++k) {
                const float factor = factors[d][k];
                for (std::size_t i = 0; i < end; ++i) sums[k][i] += from[i] * factor;
            }
        }
        if (!any) continue;
        for (std::size_t i = 0; i < end; ++i)
            for (std::size_t k = 0; k < kTerms; ++k) out[(first + i) * kTerms + k] = sums[k][i];
    }
    return out;
}

}  // namespace

shading::SkyGridPlan make_sky_grid(const CoverGrid& covers, std::span<const shading::LightPlan> lights, SkyGrid& grid) {
    if (grid.revision != covers.revision) {
        grid = {covers.revision, hidden_shares(covers), {}, {}};
    }
    if (grid.hidden_shares.empty()) return {};
    std::vector<float> brightness(shading::kGridDirections, 0.0f);  // black ones are left out of the list
    for (const shading::LightPlan& light : lights) brightness[static_cast<std::size_t>(light.source)] = light.brightness;
    if (brightness != grid.lights) {
        grid.terms = hidden_terms(grid.hidden_shares, brightness);
        grid.lights = std::move(brightness);
    }
    shading::SkyGridPlan plan;
    plan.hidden = grid.terms.data();
    for (int axis = 0; axis < 3; ++axis) {
        plan.size[axis] = covers.size[axis];
        plan.origin[axis] = static_cast<float>(covers.origin[axis]);
    }
    plan.per_length = static_cast<float>(covers.per_length);
    return plan;
}

}  // namespace halflit::raster
