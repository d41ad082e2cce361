// Functions of halflit.h about light.
#include "apps/c/convert_parts.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/versioned.hpp"

#include <halflit/image.hpp>

#include <algorithm>
#include <utility>

using namespace halflit;
using namespace halflit::c;

namespace {

bool is_dark(const Scene& scene) {
    const auto is_black = [](const Light& light) { return light.color_linear == Vec3f{}; };  // as a removed one
    return std::all_of(scene.lights.begin(), scene.lights.end(), is_black) && scene.environment == nullptr &&
           scene.ambient.sky_linear == Vec3f{} && scene.ambient.ground_linear == Vec3f{};
}

/// Lights the scene by the image, in the place of an earlier environment.
Result<void> light_by(halflit_scene& scene, EnvironmentImage image, const EnvironmentOptions& options) {
    auto made = make_environment(std::move(image), options);
    if (!made) return tl::unexpected<Error>(made.error());
    scene.scene.ambient = {};
    scene.scene.environment = std::move(*made);
    return {};
}

}  // namespace

int32_t halflit_light_init(halflit_light* light, size_t size) {
    return guarded(__func__, {{light, "light"}}, [&] { return write_struct(to_c(CallersLight{}), size, light, "halflit_light"); });
}

int32_t halflit_scene_add_light(halflit_scene* scene, const halflit_light* given, int32_t* index) {
    return changing(__func__, scene, {{given, "light"}}, [&]() -> Result<void> {
        const auto made = light(given);
        if (!made) return tl::unexpected<Error>(made.error());
        const std::size_t at = scene->free_lights.next(scene->scene.lights.size());
        if (at == scene->scene.lights.size()) scene->scene.lights.emplace_back();
        scene->scene.lights[at] = scene->world.into(*made);
        scene->free_lights.fill(at);
        tell(at, index);
        return {};
    });
}

int32_t halflit_scene_set_light(halflit_scene* scene, int32_t index, const halflit_light* given) {
    return changing(__func__, scene, {{given, "light"}}, [&]() -> Result<void> {
        const auto made = light(given);
        if (!made) return tl::unexpected<Error>(made.error());
        const auto at = check_index(index, scene->scene.lights.size(), scene->free_lights, "light");
        if (!at) return tl::unexpected<Error>(at.error());
        scene->scene.lights[*at] = scene->world.into(*made);
        return {};
    });
}

int32_t halflit_scene_remove_light(halflit_scene* scene, int32_t index) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.lights.size(), scene->free_lights, "light");
        if (!at) return tl::unexpected<Error>(at.error());
        scene->scene.lights[*at] = {.color_linear = {}};  // black lights cost nothing
        scene->free_lights.add(*at);
        return {};
    });
}

int32_t halflit_scene_set_ambient(halflit_scene* scene, const float sky[3], const float ground[3]) {
    return changing(__func__, scene, {{sky, "sky"}, {ground, "ground"}}, [&]() -> Result<void> {
        Members members("halflit_scene_set_ambient");
        members.finite("sky", sky[0], sky[1], sky[2]);
        members.finite("ground", ground[0], ground[1], ground[2]);
        if (!members.result()) return members.result();
        scene->scene.ambient = {vec3(sky), vec3(ground)};
        return {};
    });
}

int32_t halflit_scene_add_default_lights(halflit_scene* scene, const halflit_camera* given) {
    return changing(__func__, scene, {{given, "camera"}}, [&]() -> Result<void> {
        const auto made = camera(given);
        if (!made) return tl::unexpected<Error>(made.error());
        if (!is_dark(scene->scene)) return {};
        add_default_lights(scene->scene, scene->world.into(*made));
        return {};
    });
}

int32_t halflit_scene_add_studio(halflit_scene* scene, const halflit_camera* given) {
    return changing(__func__, scene, {{given, "camera"}}, [&]() -> Result<void> {
        const auto made = camera(given);
        if (!made) return tl::unexpected<Error>(made.error());
        if (!is_dark(scene->scene)) return {};
        add_studio(scene->scene, scene->world.into(*made));
        return {};
    });
}

int32_t halflit_scene_clear_lights(halflit_scene* scene) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        static_cast<Lighting&>(scene->scene) = {};  // what is added from now on is made for exposure 1
        scene->free_lights = {};
        return {};
    });
}

int32_t halflit_environment_options_init(halflit_environment_options* options, size_t size) {
    return guarded(__func__, {{options, "options"}},
                   [&] { return write_struct(default_environment_options(), size, options, "halflit_environment_options"); });
}

int32_t halflit_scene_set_environment(halflit_scene* scene, const float* rgb, int32_t width, int32_t height,
                                      const halflit_environment_options* options) {
    return changing(__func__, scene, {{rgb, "rgb"}}, [&]() -> Result<void> {
        const auto request = environment_request(options);
        if (!request) return tl::unexpected<Error>(request.error());
        const EnvironmentLimits limits;
        if (width < 1 || height < 1 || width > limits.max_width || height > limits.max_height)
            return fail(ErrorCode::usage, "the environment has " + std::to_string(width) + " x " + std::to_string(height) +
                                              " pixels, expected 1 x 1 to " + std::to_string(limits.max_width) + " x " +
                                              std::to_string(limits.max_height));
        const std::size_t values = std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        return light_by(*scene, {width, height, std::vector<float>(rgb, rgb + values), request->calibrated}, request->options);
    });
}

int32_t halflit_scene_load_environment(halflit_scene* scene, const char* path, const halflit_environment_options* options) {
    return changing(__func__, scene, {{path, "path"}}, [&]() -> Result<void> {
        const auto request = environment_request(options);
        if (!request) return tl::unexpected<Error>(request.error());
        auto image = read_environment(path);
        if (!image) return tl::unexpected<Error>(image.error());
        return light_by(*scene, std::move(*image), request->options);
    });
}

int32_t halflit_scene_set_sky(halflit_scene* scene, const halflit_environment_options* options) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        const auto request = environment_request(options);
        if (!request) return tl::unexpected<Error>(request.error());
        return light_by(*scene, built_in_sky(), request->options);
    });
}
