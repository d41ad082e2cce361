// Meshes of 3D Gaussians, and the positions to which views of them are fitted.
#include "halflit/mesh.hpp"

#include "raster/scene/keep_splats.hpp"
#include "sh/fp_environment.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace halflit {
namespace {

constexpr float kHides = 0.1f;  // least opacity of splats that views look at, if there are such
constexpr std::size_t kMostFramed = 65536, kFewSplats = 4096;

double square_of(Vec4f q) { return double{q.x} * q.x + double{q.y} * q.y + double{q.z} * q.z + double{q.w} * q.w; }

/// Leaves out those with a number that is not finite.
void leave_out_odd(std::vector<Vec3f>& positions, Splats& s) {
    const std::size_t coefficients = harmonics_per_splat(s.degree);
    raster::keep_splats(positions, s, [&](std::size_t i) {
        const auto harmonics = s.harmonics.begin() + static_cast<std::ptrdiff_t>(coefficients * i);
        return shading::finite(positions[i]) && shading::finite(s.scales[i]) && shading::finite(s.opacities[i]) &&
               std::all_of(harmonics, harmonics + static_cast<std::ptrdiff_t>(coefficients), [](float c) { return shading::finite(c); });
    });
}

/// Ends of the axes around a position, at two standard deviations.
void add_ends(Vec3f p, Vec4f rotation, Vec3f scale, std::vector<Vec3f>& out) {
    const auto f = static_cast<float>(1.0 / std::sqrt(square_of(rotation)));
    const Vec4f q{rotation.x * f, rotation.y * f, rotation.z * f, rotation.w * f};
    const float rows[3][3] = {{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y)},
                              {2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x)},
                              {2 * (q.x * q.z + q.w * q.y), 2 * (q.y * q.z - q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
    const float size[3] = {2 * scale.x, 2 * scale.y, 2 * scale.z};
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const float s = side * size[axis];
            const Vec3f end{p.x + s * rows[axis][0], p.y + s * rows[axis][1], p.z + s * rows[axis][2]};
            if (shading::finite(end)) out.push_back(end);
        }
}

}  // namespace

Mesh make_splat_mesh(std::vector<Vec3f> positions, Splats splats) {
    const FpEnvironment environment_of_host;
    leave_out_odd(positions, splats);
    for (Vec4f& q : splats.rotations)
        if (const double square = square_of(q); !(square > 1e-30 && square < 1e30)) q = {0, 0, 0, 1};
    Mesh mesh;
    mesh.topology = Topology::points;
    mesh.positions = std::move(positions);
    std::vector<std::uint32_t>& framed = mesh.indices;
    const std::size_t count = splats.opacities.size(), step = count / kMostFramed + 1;
    for (const float least : {kHides, 0.0f}) {
        for (std::size_t i = 0; i < count; i += step)
            if (splats.opacities[i] > least) framed.push_back(static_cast<std::uint32_t>(i));
        if (!framed.empty()) break;
    }
    // The outermost hundredth on each side of each axis is often a far background, or floats about.
    std::array<float, 3> low{}, high{};
    const auto at = [&](std::uint32_t i, std::size_t axis) {
        const Vec3f& p = mesh.positions[i];
        return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    };
    const std::size_t cut = framed.size() / 100;
    for (std::size_t axis = 0; axis < 3 && !framed.empty(); ++axis) {
        std::vector<float> places;
        for (const std::uint32_t i : framed) places.push_back(at(i, axis));
        std::sort(places.begin(), places.end());
        low[axis] = places[cut], high[axis] = places[places.size() - 1 - cut];
    }
    std::erase_if(framed, [&](std::uint32_t i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (at(i, axis) < low[axis] || at(i, axis) > high[axis]) return true;
        return false;
    });
    if (framed.size() <= kFewSplats) {
        std::vector<Vec3f> ends;
        for (const std::uint32_t i : framed) add_ends(mesh.positions[i], splats.rotations[i], splats.scales[i], ends);
        for (const Vec3f end : ends) {
            framed.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(end);
        }
    }
    mesh.splats = std::make_shared<const Splats>(std::move(splats));
    return mesh;
}

}  // namespace halflit
