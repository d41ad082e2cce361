#include "halflit/mesh.hpp"

#include "raster/detail/view_math.hpp"
#include "sh/fp_environment.hpp"

#include <limits>

namespace halflit {

using namespace raster;

void Bounds::add(Vec3f p) {
    if (!finite(p)) return;
    if (empty) {
        min = max = p;
        empty = false;
        return;
    }
    min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
    max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
}

void Bounds::include(const Bounds& other) {
    if (other.empty) return;
    add(other.min);
    add(other.max);
}

Vec3f Bounds::center() const {
    const FpEnvironment environment_of_host;
    const Vec3d a{min.x, min.y, min.z}, b{max.x, max.y, max.z};
    const Vec3d c = (a + b) * 0.5;
    return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

float Bounds::radius() const {
    const FpEnvironment environment_of_host;
    const Vec3d a{min.x, min.y, min.z}, b{max.x, max.y, max.z};
    return static_cast<float>(clamped(0.5 * length(b - a), 0.0, std::numeric_limits<float>::max()));
}

}  // namespace halflit
