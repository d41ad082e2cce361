#include "apps/engine/job/view_choice.hpp"

#include "apps/engine/job/film_view.hpp"
#include "apps/engine/job/job_steps.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::engine {
namespace {

float aspect_of(const ViewRequest& request) {
    const PictureSize size = request.picture_size();
    return static_cast<float>(size.width) / static_cast<float>(size.height);
}

/// The margin of --fit is in pixels of the picture.
ViewSettings with_margins(const ViewRequest& request) {
    ViewSettings view = request.view;
    if (!request.fit_px) return view;
    const PictureSize size = request.picture_size();
    view.margin_x = 2.0 * request.fit_px->width / size.width;
    view.margin_y = 2.0 * request.fit_px->height / size.height;
    return view;
}

/// The cameras of --camera-file that are drawn: one, or all. The picture has the size of the first, unless --size says another.
Result<void> use_given_cameras(RenderJob& job, const ViewRequest& request, PictureRequest& picture) {
    const CameraFile& file = *request.cameras;
    const PictureSize usual = request.picture_size();
    const auto place = [&](GivenCamera camera) {
        if (camera.horizontal_fov && request.size) {
            const SinCos half = sin_cos(0.5 * static_cast<double>(camera.lens.fov_y_rad));
            const double across = half.sin / half.cos, up = across * usual.height / usual.width;
            camera.lens.sides =
                ViewSides{static_cast<float>(-across), static_cast<float>(across), static_cast<float>(-up), static_cast<float>(up)};
        }
        return placed(camera, job.source.placement, job.film.bounds);
    };
    bool stretched = false;
    const auto warn_of_stretch = [&](const GivenCamera& camera) {
        if (!request.size || !camera.size || stretched) return;
        const PictureSize made = *camera.size;
        stretched = std::int64_t{request.size->width} * made.height != std::int64_t{request.size->height} * made.width;
        if (stretched)
            job.warnings.push_back(fmt::format("{}: made for {}x{} pixels; --size {}x{} stretches it", file.path, made.width, made.height,
                                               request.size->width, request.size->height));
    };
    std::size_t first = 0;
    if (request.camera != kAllCameras) {
        const auto found = find_camera(file, request.camera.value_or(""));
        if (!found) return tl::unexpected(found.error());
        first = *found;
    } else {
        const auto size_text = [](const GivenCamera& camera) {
            return camera.size ? fmt::format("{}x{}", camera.size->width, camera.size->height) : std::string("none");
        };
        for (const GivenCamera& camera : file.cameras) {
            if (!request.size && size_text(camera) != size_text(file.cameras[0]))
                return fail(ErrorCode::usage,
                            fmt::format("{}: its cameras have pictures of different sizes, {} and {}; --size sets one for all", file.path,
                                        size_text(file.cameras[0]), size_text(camera)));
            warn_of_stretch(camera);
            job.film.views.push_back(place(camera));
        }
    }
    warn_of_stretch(file.cameras[first]);
    picture.camera = place(file.cameras[first]);
    if (!picture.size) picture.size = file.cameras[first].size;
    return {};
}

/// The camera of --camera-orbit. Its distance may be a share of the one that shows all sides of the scene.
Camera orbit_camera(const RenderJob& job, const ViewRequest& request) {
    const CameraOrbit& given = *request.camera_orbit;
    ViewSettings side = with_margins(request);
    side.azimuth_deg = 0, side.elevation_deg = 0, side.any_side = true;
    ViewSettings opposite = side;
    opposite.azimuth_deg = 180;
    const std::vector<Camera> both = frame_views(job.scene(), job.film.bounds, aspect_of(request), std::array{side, opposite});
    const auto eye = [&](std::size_t i) {
        const Vec4f& at = both[i].world_from_camera.c[3];
        return Vec3d{at.x, at.y, at.z};
    };
    const Vec3d centre = (eye(0) + eye(1)) * 0.5;
    const double distance = given.share ? *given.share * 0.5 * length(eye(0) - eye(1)) : given.distance * job.source.placement.scale;
    const Vec3d target = request.camera_target ? drawn_at(*request.camera_target, job.source.placement) : centre;
    return placed_camera(orbit(target, given.theta_deg, 90.0 - given.phi_deg, std::min(distance, 1e36)), request.view.fov_y_deg,
                         job.film.bounds);
}

/// One view for all frames, where they move.
std::optional<Camera> view_of_frames(RenderJob& job, const ViewRequest& request, const FilmOptions& film) {
    const Bounds& bounds = job.film.bounds;
    if (!film.moves() || bounds.empty) return std::nullopt;
    FramedView framed{front_view(job.scene(), with_margins(request)), {}};
    if (!request.own_view()) framed = choose_view(job.scene(), bounds, aspect_of(request), with_margins(request));
    tell_view(job, framed.view, framed.reason);
    return film_camera(job.scene(), bounds, film, aspect_of(request), framed.view);
}

}  // namespace

Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds) {
    Camera camera;
    camera.world_from_camera = world_from_camera;
    camera.fov_y_rad = static_cast<float>(static_cast<double>(fov_y_deg) * (kPi / 180.0));
    return completed(camera, bounds);
}

std::vector<ViewSettings> given_sides(const SceneSource& source, const ViewRequest& request, const std::vector<GivenView>& views) {
    constexpr double kDegrees = 180.0 / kPi;
    std::vector<ViewSettings> sides;
    for (const GivenView& given : views) {
        ViewSettings& side = sides.emplace_back(with_margins(request));
        side.azimuth_deg = given.azimuth_deg + (given.named ? front_azimuth_deg(*source.scene) : 0.0f);
        side.elevation_deg = given.elevation_deg;
        if (given.facing) {
            const Vec3d n = turned_upright(*given.facing, source.placement.up);
            side.azimuth_deg = static_cast<float>(angle_of(n.x, n.z) * kDegrees);
            side.elevation_deg = static_cast<float>(angle_of(n.y, std::sqrt(n.x * n.x + n.z * n.z)) * kDegrees);
        }
        side.any_side = !request.fit_px;
    }
    return sides;
}

void tell_view(RenderJob& job, const ViewSettings& drawn, ViewReason reason) {
    job.film.view = drawn, job.film.reason = reason;
    if (reason != ViewReason::backs) return;
    job.warnings.push_back(fmt::format("from the usual side only backs are seen, which are not drawn; seen from {:g},{:g}",
                                       drawn.azimuth_deg, drawn.elevation_deg));
}

Result<PictureRequest> picture_request(RenderJob& job, const ViewRequest& request, const FilmOptions& film, bool frame) {
    PictureRequest picture;
    static_cast<AutoOptions&>(picture) = job.film.choice;
    picture.view = with_margins(request);
    picture.size = request.size;
    picture.usual_size = request.usual_size;
    const Placement& placement = job.source.placement;
    Bounds& bounds = job.film.bounds;
    job.film.views.clear();
    job.film.framed = !request.cameras && (request.kept_view || !film.views.empty());
    if (request.cameras) {
        if (const auto used = use_given_cameras(job, request, picture); !used) return tl::unexpected(used.error());
    } else if (request.kept_view) {
        picture.camera = camera_of(*request.kept_view, placement, job.prepared->bounds());
        bounds = bounds_of(*request.kept_view, placement);
    } else if (!film.views.empty()) {
        job.film.views = frame_views(job.scene(), bounds, aspect_of(request), given_sides(job.source, request, film.views));
        picture.camera = job.film.views.front();
    } else if (request.camera_orbit) {
        picture.camera = orbit_camera(job, request);
    } else if (request.camera_position) {
        const Vec3d target = request.camera_target ? drawn_at(*request.camera_target, placement)
                             : bounds.empty        ? Vec3d{}
                                                   : to_double(bounds.center());
        const Mat4 place = look_at(to_float(drawn_at(*request.camera_position, placement)), to_float(target));
        picture.camera = placed_camera(place, request.view.fov_y_deg, bounds);
    } else {
        picture.scene_camera = request.camera;
        picture.frame = frame;
        if (frame || (!request.camera && choose_camera(job.scene(), bounds) == nullptr))
            picture.camera = view_of_frames(job, request, film);
    }
    return picture;
}

}  // namespace halflit::engine
