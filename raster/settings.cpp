#include "raster/settings.hpp"

#include "raster/kernels/raster_kernels.hpp"
#include "shading/planner.hpp"

#include <string>
#include <tuple>

namespace halflit::raster {

Result<void> check_settings(const Settings& settings, int width, int height) {
    if (width < 1 || height < 1) return fail(ErrorCode::usage, "the picture has no pixels");
    if (width > 2 * kGuardBandPx || height > 2 * kGuardBandPx)
        return fail(ErrorCode::limit, "picture size: " + std::to_string(width) + " x " + std::to_string(height) +
                                          " pixels, expected at most " + std::to_string(2 * kGuardBandPx) + " on a side");
    if (settings.samples != 1 && settings.samples != 4 && settings.samples != 8)
        return fail(ErrorCode::usage, "samples: " + std::to_string(settings.samples) + ", expected 1, 4 or 8");
    if (settings.tile_size != 16 && settings.tile_size != 32 && settings.tile_size != 64)
        return fail(ErrorCode::usage, "tile size: " + std::to_string(settings.tile_size) + ", expected 16, 32 or 64");
    if (!(settings.exposure > 0.0f && settings.exposure < 3e38f)) return fail(ErrorCode::usage, "the exposure is not a positive number");
    if (auto ok = shading::check_options(settings.shading); !ok) return ok;
    const Region& r = settings.region;
    if (r.width != 0 && (r.x < 0 || r.y < 0 || r.width < 1 || r.height < 1 || r.width > width - r.x || r.height > height - r.y))
        return fail(ErrorCode::usage, "the region is not inside the picture");
    if (!settings.isa) return tl::unexpected<Error>(settings.isa.error());
    if (!shading::isa_available(*settings.isa))
        return fail(ErrorCode::usage, "this CPU does not run the instruction set " + std::string(shading::isa_name(*settings.isa)));
    return {};
}

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
