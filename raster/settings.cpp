#include "halflit/settings.hpp"

#include "raster/check_execution.hpp"

#include "raster/kernels/raster_kernels.hpp"
#include "sh/fp_environment.hpp"
#include "shading/planner.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <string>

namespace halflit {

Result<void> check_settings(const Settings& settings, int width, int height) {
    const FpEnvironment environment_of_host;
    if (width < 1 || height < 1) return fail(ErrorCode::usage, "the picture has no pixels");
    if (width > 2 * raster::kGuardBandPx || height > 2 * raster::kGuardBandPx)
        return fail(ErrorCode::limit, "picture size: " + std::to_string(width) + " x " + std::to_string(height) +
                                          " pixels, expected at most " + std::to_string(2 * raster::kGuardBandPx) + " on a side");
    if (settings.samples != 1 && settings.samples != 4 && settings.samples != 8 && settings.samples != 16)
        return fail(ErrorCode::usage, "samples: " + std::to_string(settings.samples) + ", expected 1, 4, 8 or 16");
    if (!(settings.exposure > 0.0f && settings.exposure < 3e38f)) return fail(ErrorCode::usage, "the exposure is not a positive number");
    const auto in_range = [](float pixels) { return pixels >= 0.0625f && pixels <= 256.0f; };
    if (!in_range(settings.point_size)) return fail(ErrorCode::usage, "point size: expected 1/16 to 256 pixels");
    if (!in_range(settings.line_width)) return fail(ErrorCode::usage, "line width: expected 1/16 to 256 pixels");
    const int side = settings.shadow_size;
    if (side < 64 || side > 4096 || (side & (side - 1)) != 0)
        return fail(ErrorCode::usage, "shadow size: " + std::to_string(side) + ", expected a power of two from 64 to 4096");
    if (!(settings.shadow_fade >= 0.0f && settings.shadow_fade < 3e38f))
        return fail(ErrorCode::usage, "shadow fade: expected a distance, or 0");
    if (settings.soft_shadow_maps < 4 || settings.soft_shadow_maps > 64)
        return fail(ErrorCode::usage, "soft shadow maps: " + std::to_string(settings.soft_shadow_maps) + ", expected 4 to 64");
    if (settings.sky_shadows != 0 &&
        (settings.sky_shadows < shading::kLeastSkyDirections || settings.sky_shadows > shading::kMostSkyDirections))
        return fail(ErrorCode::usage, "sky shadows: " + std::to_string(settings.sky_shadows) + ", expected 0, or 16 to 1024 directions");
    if (settings.tone_curve > ToneCurve::neutral) return fail(ErrorCode::usage, "tone curve: found a value that no name stands for");
    if (settings.shadows > ShadowMode::soft_split) return fail(ErrorCode::usage, "shadows: found a value that no name stands for");
    if (auto ok = shading::check_options(settings.shading); !ok) return ok;
    const Region& r = settings.region;
    if (r.width != 0 && (r.x < 0 || r.y < 0 || r.width < 1 || r.height < 1 || r.width > width - r.x || r.height > height - r.y))
        return fail(ErrorCode::usage, "the region is not inside the picture");
    return {};
}

}  // namespace halflit

namespace halflit::raster {

Result<Isa> check_execution(const Execution& execution) {
    if (execution.tile_size != 16 && execution.tile_size != 32 && execution.tile_size != 64)
        return fail(ErrorCode::usage, "tile size: " + std::to_string(execution.tile_size) + ", expected 16, 32 or 64");
    if (!(execution.time_limit_s >= 0.0)) return fail(ErrorCode::usage, "time limit: expected seconds, or 0 for none");
    if (!execution.isa) return default_isa();
    if (!isa_available(*execution.isa))
        return fail(ErrorCode::usage, "this CPU does not run the instruction set " + std::string(isa_name(*execution.isa)));
    return *execution.isa;
}

Execution with_time_left(Execution execution, double spent_s) {
    constexpr double kOverdue = 1e-9;  // 0 would be no limit
    if (execution.time_limit_s > 0.0) execution.time_limit_s = std::max(execution.time_limit_s - spent_s, kOverdue);
    return execution;
}

}  // namespace halflit::raster
