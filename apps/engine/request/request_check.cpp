#include "apps/engine/request/request_check.hpp"

#include "apps/engine/request/lobe_model.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::engine {
namespace {

/// The lobe that the flags choose for materials without one of their own; empty if they choose none.
Result<std::optional<Lobe>> chosen_lobe(const SettingsRequest& o) {
    if (o.lobe_name) {
        auto lobe = io::lobe_from_name(*o.lobe_name, o.lobe);
        if (!lobe)  // the message begins with the parameter's name, which is the flag's
            return fail(ErrorCode::usage, "--" + lobe.error().message + did_you_mean_lobe(*o.lobe_name));
        return *lobe;
    }
    if (o.lobe.wrap || o.lobe.power) return Lobe{o.lobe.wrap.value_or(0.0f), o.lobe.power.value_or(1.0f), o.lobe.normalize.has_value()};
    if (o.lobe.normalize) return fail(ErrorCode::usage, "--normalize: expected together with --lobe, --wrap or --power");
    return std::nullopt;
}

}  // namespace

Result<void> check_request(const RenderOptions& options) {
    if (const auto settings = checked_settings(options); !settings) return tl::unexpected(settings.error());
    return check_view(options, options.film.views, options.settings.region);
}

Result<void> check_view(const ViewRequest& request, const std::vector<GivenView>& views, const Region& region) {
    const bool placed_by_flags = request.camera_position || request.camera_orbit;
    if (placed_by_flags && (request.camera || request.whole_scene || (request.camera_position && request.camera_orbit)))
        return fail(
            ErrorCode::usage,
            fmt::format("{}: cannot be combined with {}--camera, --view, --fit, --ortho, --azimuth, --elevation or --zoom",
                        request.camera_orbit ? "--camera-orbit" : "--camera-position", request.camera_orbit ? "--camera-position, " : ""));
    if (request.camera_target && !placed_by_flags)
        return fail(ErrorCode::usage, "--camera-target: expected together with --camera-position or --camera-orbit");
    const ViewSettings usual_view;
    const bool own_side = request.view.azimuth_deg != usual_view.azimuth_deg || request.view.elevation_deg != usual_view.elevation_deg;
    if (own_side && !request.camera && !views.empty())
        return fail(ErrorCode::usage, "--azimuth, --elevation: cannot be combined with --view, which takes both as AZ,EL");
    if (request.camera && request.own_view())
        return fail(
            ErrorCode::usage,
            "--camera: cannot be combined with --view, --fit, --azimuth, --elevation, --zoom or --fov, which make a camera of their own");
    if (request.fit_px) {
        const PictureSize size = request.picture_size();
        const double most = 0.45 * std::min(size.width, size.height);  // ViewSettings::margin_x ends there
        const int margin = std::max(request.fit_px->width, request.fit_px->height);
        if (margin > most)
            return fail(ErrorCode::usage, fmt::format("--fit: expected at most {} pixels, 45 % of the picture's shorter side, found {}",
                                                      static_cast<int>(most), margin));
    }
    if (request.size)
        if (const auto checked = check_size(*request.size, region); !checked) return checked;
    return {};
}

Result<void> check_size(PictureSize size, const Region& region) {
    const bool whole = region.width == 0;
    if (const PictureSize drawn = whole ? size : PictureSize{region.width, region.height};
        std::int64_t{drawn.width} * drawn.height > kMaxImagePixels)
        return fail(ErrorCode::limit, fmt::format("{}: {}x{} is more than 2^28 pixels{}", whole ? "--size" : "--region", drawn.width,
                                                  drawn.height, whole ? "; --region draws a part" : ""));
    if (std::int64_t{region.x} + region.width > size.width || std::int64_t{region.y} + region.height > size.height)
        return fail(ErrorCode::usage, fmt::format("--region: expected a part of the {}x{} picture, found {},{},{},{}", size.width,
                                                  size.height, region.x, region.y, region.width, region.height));
    return {};
}

Result<Settings> checked_settings(const SettingsRequest& request) {
    Settings settings = request.settings;
    const auto lobe = chosen_lobe(request);
    if (!lobe) return tl::unexpected(lobe.error());
    settings.shading.lobe = *lobe;
    // The size is not known yet.
    Settings anywhere = settings;
    anywhere.region = {};
    if (const auto checked = check_settings(anywhere, 1, 1); !checked) return fail(checked.error().code, "--" + checked.error().message);
    return settings;
}

}  // namespace halflit::engine
