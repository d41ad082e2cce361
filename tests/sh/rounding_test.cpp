// Rounding to float and back, which a compiler must not leave out. GCC 12 does where it vectorises straight-line code.
#include "sh/vec3d.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;

namespace {

[[gnu::noinline]] Vec3d rounded_and_moved(Vec3d v, double factor, double by) {
    const auto x = static_cast<float>(v.x * factor), y = static_cast<float>(v.y * factor), z = static_cast<float>(v.z * factor);
    return {static_cast<double>(x) + by, static_cast<double>(y) + by, static_cast<double>(z) + by};
}

}  // namespace

TEST_CASE("rounding: three numbers side by side are rounded to float and back", "[sh]") {
    const Vec3d v{0.1, 0.2, 0.3}, moved = rounded_and_moved(v, 1.0, 1.0);
    const double in[] = {v.x, v.y, v.z}, out[] = {moved.x, moved.y, moved.z};
    for (int i = 0; i < 3; ++i) {
        const volatile float rounded = static_cast<float>(in[i]);
        CHECK(out[i] == static_cast<double>(rounded) + 1.0);
    }
}
