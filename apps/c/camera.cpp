// Functions of halflit.h about cameras and settings.
#include "apps/c/convert_parts.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/versioned.hpp"

#include <halflit/auto_setup.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::c;

namespace {

/// The camera without a name: it has no scene that keeps one.
halflit_camera nameless(const CallersCamera& from) {
    halflit_camera camera = to_c(from);
    camera.name = nullptr;
    return camera;
}

Result<void> check_aspect(float aspect) {
    if (aspect > 0.0f && aspect < 1e6f) return {};
    return fail(ErrorCode::usage, "aspect is not a positive number");
}

/// Views of an array, whose structs have the size of the first.
Result<std::vector<ViewSettings>> views_of(const halflit_view* first, std::int32_t count) {
    constexpr std::int32_t kMostViews = 65536;
    if (count < 1 || count > kMostViews)
        return fail(ErrorCode::usage, "count is " + std::to_string(count) + ", expected 1 to " + std::to_string(kMostViews));
    std::vector<ViewSettings> views;
    for (std::int32_t i = 0; i < count; ++i) {
        const halflit_view* const one = at(first, i);
        if (one->size != first->size) return fail(ErrorCode::usage, "halflit_view: the members size of views[] differ");
        const auto read = view(one);
        if (!read) return tl::unexpected<Error>(read.error());
        views.push_back(*read);
    }
    return views;
}

}  // namespace

int32_t halflit_camera_init(halflit_camera* camera, size_t size) {
    return guarded(__func__, {{camera, "camera"}}, [&] { return write_struct(nameless({}), size, camera, "halflit_camera"); });
}

int32_t halflit_camera_look_at(const float eye[3], const float target[3], const float up[3], halflit_camera* to) {
    return guarded(__func__, {{eye, "eye"}, {target, "target"}, {to, "camera"}}, [&]() -> Result<void> {
        auto made = camera(to);
        if (!made) return tl::unexpected<Error>(made.error());
        made->camera.world_from_camera = look_at(vec3(eye), vec3(target), up != nullptr ? vec3(up) : Vec3f{0, 1, 0});
        made->rest = {};
        return write_struct(nameless(*made), to, "halflit_camera");
    });
}

int32_t halflit_camera_from_intrinsics(const double k[9], int32_t width, int32_t height, const double rotation[9],
                                       const double translation[3], double first_pixel, halflit_camera* to) {
    return guarded(__func__, {{k, "k"}, {rotation, "rotation"}, {translation, "translation"}, {to, "camera"}}, [&]() -> Result<void> {
        const auto before = camera(to);
        if (!before) return tl::unexpected<Error>(before.error());
        if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
            return fail(ErrorCode::usage, "k: expected fx, 0, cx, 0, fy, cy, 0, 0, 1");
        const Intrinsics lens{k[0], k[4], k[2], k[5], width, height, first_pixel};
        std::array<double, 9> turn{};
        std::copy_n(rotation, 9, turn.begin());
        auto made = Camera::from_intrinsics(lens, turn, {translation[0], translation[1], translation[2]});
        if (!made) return tl::unexpected<Error>(made.error());
        made->near_z = before->camera.near_z, made->far_z = before->camera.far_z;
        return write_struct(nameless({*made, {}}), to, "halflit_camera");
    });
}

int32_t halflit_camera_frame(const halflit_scene* scene, float aspect, float azimuth_deg, float elevation_deg, float zoom,
                             halflit_camera* to) {
    return reading(__func__, scene, {{to, "camera"}}, [&]() -> Result<void> {
        if (!(aspect > 0.0f && aspect < 1e6f)) return fail(ErrorCode::usage, "halflit_camera_frame: aspect is not a positive number");
        Members members("halflit_camera_frame");
        members.finite("azimuth_deg", azimuth_deg);
        members.elevation(elevation_deg);
        members.positive("zoom", zoom, 1000000000);
        if (!members.result()) return members.result();
        ViewSettings view;
        view.azimuth_deg = azimuth_deg;
        view.elevation_deg = elevation_deg;
        view.zoom = zoom;
        return write_struct(nameless(scene->world.out(frame_scene(scene->scene, aspect, view))), to, "halflit_camera");
    });
}

int32_t halflit_view_init(halflit_view* view, size_t size) {
    return guarded(__func__, {{view, "view"}}, [&] { return write_struct(default_view(), size, view, "halflit_view"); });
}

int32_t halflit_view_by_name(const halflit_scene* scene, const char* name, halflit_view* to) {
    return reading(__func__, scene, {{name, "name"}, {to, "view"}}, [&]() -> Result<void> {
        auto given = read_struct(to, default_view(), "halflit_view");
        if (!given) return tl::unexpected<Error>(given.error());
        std::string names;
        for (const NamedView& named : kNamedViews) {
            if (named.name == name) {
                given->azimuth_deg = named.azimuth_deg + front_azimuth_deg(scene->scene);
                given->elevation_deg = named.elevation_deg;
                return write_struct(*given, to, "halflit_view");
            }
            names += (names.empty() ? "" : ", ") + std::string(named.name);
        }
        return fail(ErrorCode::usage, "view: expected one of " + names + ", found '" + std::string(name) + "'");
    });
}

int32_t halflit_camera_view(const halflit_scene* scene, float aspect, const halflit_view* given, halflit_camera* to) {
    return reading(__func__, scene, {{given, "view"}, {to, "camera"}}, [&]() -> Result<void> {
        if (auto ok = check_aspect(aspect); !ok) return ok;
        const auto side = view(given);
        if (!side) return tl::unexpected<Error>(side.error());
        return write_struct(nameless(scene->world.out(frame_scene(scene->scene, aspect, *side))), to, "halflit_camera");
    });
}

int32_t halflit_camera_views(const halflit_scene* scene, float aspect, const halflit_view* given, int32_t count, halflit_camera* to) {
    return reading(__func__, scene, {{given, "views"}, {to, "cameras"}}, [&]() -> Result<void> {
        if (auto ok = check_aspect(aspect); !ok) return ok;
        const auto sides = views_of(given, count);
        if (!sides) return tl::unexpected<Error>(sides.error());
        if (auto ok = check_size(to->size, sizeof(halflit_camera), "halflit_camera"); !ok) return ok;
        for (std::int32_t i = 0; i < count; ++i)
            if (at(to, i)->size != to->size) return fail(ErrorCode::usage, "halflit_camera: the members size of cameras[] differ");
        const std::vector<Camera> cameras = frame_views(scene->scene, scene_bounds(scene->scene), aspect, *sides);
        for (std::int32_t i = 0; i < count; ++i)
            (void)write_struct(nameless(scene->world.out(cameras[static_cast<std::size_t>(i)])), at(to, i), "halflit_camera");
        return {};
    });
}

int32_t halflit_camera_orbit(const double target[3], double azimuth_deg, double elevation_deg, double distance, int32_t up,
                             halflit_camera* to) {
    return guarded(__func__, {{target, "target"}, {to, "camera"}}, [&]() -> Result<void> {
        auto made = camera(to);
        if (!made) return tl::unexpected<Error>(made.error());
        Members members("halflit_camera_orbit");
        for (int i = 0; i < 3; ++i) members.finite("target", target[i]);
        members.finite("azimuth_deg, elevation_deg or distance", azimuth_deg, elevation_deg, distance);
        if (!(distance > 0.0)) members.wrong("distance", "is not above 0");
        if (up < HALFLIT_UP_X || up > HALFLIT_UP_MINUS_Z) members.wrong("up", "is " + std::to_string(up) + ", expected 1 to 6");
        if (!members.result()) return members.result();
        const auto axis = static_cast<UpAxis>(up - 1);
        made->camera.world_from_camera = turned_back(orbit(turned_upright(vec3(target), axis), azimuth_deg, elevation_deg, distance), axis);
        made->rest = {};
        return write_struct(nameless(*made), to, "halflit_camera");
    });
}

int32_t halflit_settings_init(halflit_settings* settings, size_t size) {
    return guarded(__func__, {{settings, "settings"}}, [&] { return write_struct(to_c(Settings{}), size, settings, "halflit_settings"); });
}

int32_t halflit_picture_request_init(halflit_picture_request* request, size_t size) {
    return guarded(__func__, {{request, "request"}},
                   [&] { return write_struct(default_picture_request(), size, request, "halflit_picture_request"); });
}

int32_t halflit_choose_picture(const halflit_scene* scene, const halflit_picture_request* given, int32_t size[2], halflit_camera* to_camera,
                               halflit_settings* to_settings, halflit_lighting** to_lighting) {
    return reading(__func__, scene, {{to_camera, "camera"}, {to_settings, "settings"}}, [&]() -> Result<void> {
        const auto request = picture_request(given, scene->world);
        if (!request) return tl::unexpected<Error>(request.error());
        if (auto ok = check_size(to_camera->size, sizeof(halflit_camera), "halflit_camera"); !ok) return ok;
        if (auto ok = check_size(to_settings->size, sizeof(halflit_settings), "halflit_settings"); !ok) return ok;
        auto choice = choose_picture(scene->scene, *request);
        if (!choice) return tl::unexpected<Error>(choice.error());
        if (to_lighting != nullptr) *to_lighting = new halflit_lighting{std::move(choice->light), scene->scene.lights.size()};
        if (size != nullptr) size[0] = choice->size.width, size[1] = choice->size.height;
        (void)write_struct(nameless(scene->world.out(choice->camera)), to_camera, "halflit_camera");  // the sizes were checked before
        return write_struct(to_c(scene->world.out(choice->settings)), to_settings, "halflit_settings");
    });
}

void halflit_lighting_destroy(halflit_lighting* lighting) { delete lighting; }
