// Functions of halflit.h that make planes of planes.
#include "apps/c/convert.hpp"
#include "apps/c/scene_access.hpp"

#include <halflit/fragment_planes.hpp>

#include <mutex>
#include <span>

using namespace halflit;
using namespace halflit::c;

int32_t halflit_ray_distances(const halflit_camera* given_camera, int32_t width, int32_t height, const halflit_region* region,
                              float* depth) {
    return guarded(__func__, {{given_camera, "camera"}, {depth, "depth"}}, [&]() -> Result<void> {
        const auto from = camera(given_camera);
        if (!from) return tl::unexpected<Error>(from.error());
        Settings settings;
        if (region != nullptr) settings.region = {region->x, region->y, region->width, region->height};
        if (auto ok = check_settings(settings, width, height); !ok) return ok;
        const Region& part = settings.region;
        const auto w = static_cast<std::size_t>(part.width > 0 ? part.width : width);
        const auto h = static_cast<std::size_t>(part.width > 0 ? part.height : height);
        return make_ray_distances(from->camera, {width, height}, part, {depth, w * h});
    });
}

int32_t halflit_depth_codes(const float* depth, size_t count, uint16_t* codes, double range[2]) {
    return guarded(__func__, {{depth, "depth"}, {codes, "codes"}, {range, "range"}}, [&]() -> Result<void> {
        const DepthRange found = make_depth_codes({depth, count}, {codes, count});
        range[0] = found.least, range[1] = found.most;
        return {};
    });
}

int32_t halflit_view_normals(const halflit_camera* given_camera, float* normal, size_t count) {
    return guarded(__func__, {{given_camera, "camera"}, {normal, "normal"}}, [&]() -> Result<void> {
        const auto from = camera(given_camera);
        if (!from) return tl::unexpected<Error>(from.error());
        return make_view_normals(from->camera, {normal, 3 * count});
    });
}

int32_t halflit_scene_mesh_numbers(const halflit_scene* scene, uint32_t* instance, size_t count) {
    return reading(__func__, scene, {{instance, "instance"}}, [&]() -> Result<void> {
        make_mesh_numbers(scene->scene, {instance, count});
        return {};
    });
}

int32_t halflit_scene_material_numbers(const halflit_scene* scene, uint32_t* instance, size_t count) {
    return reading(__func__, scene, {{instance, "instance"}}, [&]() -> Result<void> {
        make_material_numbers(scene->scene, {instance, count});
        return {};
    });
}

int32_t halflit_motion(const halflit_scene* scene, const halflit_camera* given_camera, const halflit_scene* other,
                       const halflit_camera* other_camera, int32_t width, int32_t height, const uint32_t* instance,
                       const uint32_t* triangle, const float* barycentric, size_t count, float* motion) {
    if (scene == nullptr) return record_failure(ErrorCode::usage, __func__, "scene is null");
    return guarded(__func__,
                   {{given_camera, "camera"},
                    {other, "other"},
                    {other_camera, "other_camera"},
                    {instance, "instance"},
                    {triangle, "triangle"},
                    {barycentric, "barycentric"},
                    {motion, "motion"}},
                   [&]() -> Result<void> {
                       const auto from = camera(given_camera), to = camera(other_camera);
                       for (const auto* view : {&from, &to})
                           if (!*view) return tl::unexpected<Error>(view->error());
                       std::unique_lock first(scene->access, std::defer_lock), second(other->access, std::defer_lock);
                       if (scene == other)
                           first.lock();
                       else
                           std::lock(first, second);
                       return make_motion({scene->scene, scene->world.into(*from)}, {other->scene, other->world.into(*to)}, {width, height},
                                          {{instance, count}, {triangle, count}, {barycentric, 2 * count}}, {motion, 2 * count});
                   });
}
