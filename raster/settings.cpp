#include "halflit/settings.hpp"

#include "raster/check_execution.hpp"

#include "raster/kernels/raster_kernels.hpp"
#include "raster/settings_table.hpp"
#include "sh/fp_environment.hpp"
#include "shading/planner.hpp"

#include <algorithm>
#include <string>

namespace halflit {
Result<void> check_settings(const Settings& settings, int width, int height) {
    const FpEnvironment environment_of_host;
    if (width < 1 || height < 1) return fail(ErrorCode::usage, "the picture has no pixels");
    if (width > 2 * raster::kGuardBandPx || height > 2 * raster::kGuardBandPx)
        return fail(ErrorCode::limit, "picture size: " + std::to_string(width) + " x " + std::to_string(height) +
                                          " pixels, expected at most " + std::to_string(2 * raster::kGuardBandPx) + " on a side");
    for (const raster::Setting& setting : raster::kSettings) {
        const double value = setting.get(settings);
        if (setting.values.contains(value)) continue;
        return fail(ErrorCode::usage, std::string(setting.name) + ": expected " + setting.values.expected() + ", found '" +
                                          raster::number_text(value / setting.values.unit) + "'");
    }
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
