#include "raster/settings.hpp"

#include <tuple>

namespace halflit::raster {

bool same_plan(const Settings& a, const Settings& b) {
    const auto planned = [](const Settings& s) {
        const Vec4f& back = s.background_linear;
        return std::tuple(s.region.x, s.region.y, s.region.width, s.region.height, s.samples, s.tile_size, back.x, back.y, back.z, back.w,
                          s.background_environment, s.exposure, s.shadows, s.shadow_size, s.shadow_memory_limit, s.shadow_fade,
                          s.shadow_terminator_offset);
    };
    return planned(a) == planned(b) && a.shading == b.shading;
}

}  // namespace halflit::raster
