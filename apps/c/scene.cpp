// Functions of halflit.h that make a scene, and those that read it.
#include "apps/c/convert.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/versioned.hpp"

#include <halflit/model.hpp>

#include <limits>
#include <memory>

using namespace halflit;
using namespace halflit::c;

namespace {

/// name: of the file.
Result<void> hand_over(Result<LoadedScene> loaded, halflit_scene** scene, const char* name = nullptr) {
    if (!loaded) return tl::unexpected<Error>(loaded.error());
    auto made = std::make_unique<halflit_scene>();
    made->scene = std::move(loaded->scene);
    made->file_meshes = made->scene.meshes.size();
    if (name != nullptr) made->name = name, made->info = std::move(loaded->info);
    made->warnings = std::move(loaded->warnings);
    made->animations = std::move(loaded->animations);
    made->motion = std::move(loaded->motion);
    made->world = World(std::move(loaded->placement));
    made->nodes = std::move(loaded->nodes);
    made->node_of_instance = std::move(loaded->node_of_instance);
    made->free_meshes.keep(made->file_meshes);
    made->free_instances.keep(made->scene.instances.size());
    made->free_lights.keep(made->scene.lights.size());
    made->list_instances_of_nodes();
    *scene = made.release();
    return {};
}

std::uint64_t triangle_count(const Scene& scene) {
    std::uint64_t count = 0;
    for (const Instance& instance : scene.instances)
        if (instance.visible) count += triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    return count;
}

template <class T>
std::int32_t count_of(const T& list) {
    return static_cast<std::int32_t>(list.size());
}

}  // namespace

int32_t halflit_load_options_init(halflit_load_options* options, size_t size) {
    return guarded(__func__, {{options, "options"}},
                   [&] { return write_struct(to_c(LoadOptions{}), size, options, "halflit_load_options"); });
}

int32_t halflit_scene_create(halflit_scene** scene) {
    return guarded(__func__, {{scene, "scene"}}, [&] { return hand_over(LoadedScene{}, scene); });
}

int32_t halflit_scene_create_demo(halflit_scene** scene) {
    return guarded(__func__, {{scene, "scene"}}, [&] {
        LoadedScene demo;
        demo.scene = demo_scene();
        return hand_over(std::move(demo), scene);
    });
}

int32_t halflit_scene_load(const char* path, const halflit_load_options* options, halflit_scene** scene) {
    return guarded(__func__, {{path, "path"}, {scene, "scene"}}, [&]() -> Result<void> {
        const auto how = load_options(options);
        if (!how) return tl::unexpected<Error>(how.error());
        return hand_over(load_model(path, *how), scene, path);
    });
}

int32_t halflit_scene_load_memory(const void* bytes, size_t count, const char* name, const char* base_dir,
                                  const halflit_load_options* options, halflit_scene** scene) {
    return guarded(__func__, {{bytes, "bytes"}, {name, "name"}, {scene, "scene"}}, [&]() -> Result<void> {
        const auto how = load_options(options);
        if (!how) return tl::unexpected<Error>(how.error());
        const std::span<const std::byte> file(static_cast<const std::byte*>(bytes), count);
        return hand_over(load_model_bytes(file, name, base_dir != nullptr ? base_dir : "", *how), scene, name);
    });
}

int32_t halflit_scene_set_up(halflit_scene* scene, int32_t up) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        if (up < HALFLIT_UP_BY_FORMAT || up > HALFLIT_UP_MINUS_Z) return fail(ErrorCode::usage, "up is no HALFLIT_UP");
        const Scene& now = scene->scene;
        if (!now.instances.empty() || !now.lights.empty() || !now.cameras.empty())
            return fail(ErrorCode::usage, "up: expected a scene without instances, lights and cameras");
        scene->up_is_set = true;
        scene->world.set_up(up == HALFLIT_UP_BY_FORMAT ? UpAxis::y : static_cast<UpAxis>(up - 1));
        return {};
    });
}

void halflit_scene_destroy(halflit_scene* scene) { delete scene; }

int32_t halflit_scene_get_counts(const halflit_scene* scene, halflit_counts* counts) {
    return reading(__func__, scene, {{counts, "counts"}}, [&] {
        const Scene& from = scene->scene;
        halflit_counts found{};
        found.size = sizeof found;
        found.triangles = triangle_count(from);
        found.meshes = count_of(from.meshes);
        found.instances = count_of(from.instances);
        found.materials = count_of(from.materials);
        found.textures = count_of(from.textures);
        found.cameras = count_of(from.cameras);
        found.lights = count_of(from.lights);
        found.nodes = count_of(scene->nodes);
        found.animations = count_of(scene->animations);
        found.warnings = count_of(scene->warnings);
        return write_struct(found, counts, "halflit_counts");
    });
}

int32_t halflit_scene_get_warning(const halflit_scene* scene, int32_t index, const char** text) {
    return reading(__func__, scene, {{text, "text"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->warnings.size(), "warning");
        if (!at) return tl::unexpected<Error>(at.error());
        *text = scene->warnings[*at].c_str();
        return {};
    });
}

int32_t halflit_scene_get_animation(const halflit_scene* scene, int32_t index, halflit_animation* animation) {
    return reading(__func__, scene, {{animation, "animation"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->animations.size(), "animation");
        if (!at) return tl::unexpected<Error>(at.error());
        const AnimationInfo& from = scene->animations[*at];
        const halflit_animation found{sizeof(halflit_animation), from.name.c_str(), from.end_s, from.channels};
        return write_struct(found, animation, "halflit_animation");
    });
}

int32_t halflit_scene_pose(halflit_scene* scene, const char* animation, double time_s) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        if (scene->motion == nullptr)
            return fail(ErrorCode::usage, "halflit_scene_pose: expected a scene that was loaded with keep_animations");
        const auto posed = pose_at(*scene->motion, animation != nullptr ? animation : "", time_s, scene->scene);
        if (!posed) return tl::unexpected<Error>(posed.error());
        for (const std::size_t i : posed->changed_instances) scene->changes.instance(i);
        for (const std::size_t i : posed->deformed_meshes) {
            scene->put_mesh(i, std::move(scene->scene.meshes[i]));
            scene->changes.mesh(i);
        }
        if (posed->materials) scene->changes.materials();
        for (const std::size_t i : scene->free_lights.all()) scene->scene.lights[i].color_linear = {};
        return {};
    });
}

int32_t halflit_scene_get_placement(const halflit_scene* scene, double origin[3], double* scale, int32_t* up) {
    return reading(__func__, scene, {}, [&]() -> Result<void> {
        const Placement& from = scene->world.placement();
        if (origin != nullptr) origin[0] = from.origin.x, origin[1] = from.origin.y, origin[2] = from.origin.z;
        if (scale != nullptr) *scale = from.scale;
        if (up != nullptr) *up = static_cast<std::int32_t>(from.up) + 1;
        return {};
    });
}

namespace {

/// The box of halflit_scene_get_box or halflit_scene_get_bounds.
template <class T>
std::int32_t get_box(const char* function, const halflit_scene* scene, T* min, T* max) {
    return reading(function, scene, {{min, "min"}, {max, "max"}}, [&]() -> Result<void> {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        const Vec3d all{kInfinity, kInfinity, kInfinity};
        const World::Box box = scene->world.out(scene_bounds(scene->scene)).value_or(World::Box{all, all * -1.0});
        put(box.min, min);
        put(box.max, max);
        return {};
    });
}

}  // namespace

int32_t halflit_scene_get_box(const halflit_scene* scene, double min[3], double max[3]) { return get_box(__func__, scene, min, max); }

int32_t halflit_scene_get_bounds(const halflit_scene* scene, float min[3], float max[3]) { return get_box(__func__, scene, min, max); }

int32_t halflit_scene_get_material(const halflit_scene* scene, int32_t index, halflit_material* material) {
    return reading(__func__, scene, {{material, "material"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.materials.size(), "material");
        if (!at) return tl::unexpected<Error>(at.error());
        return write_struct(to_c(scene->scene.materials[*at]), material, "halflit_material");
    });
}

int32_t halflit_scene_get_instance(const halflit_scene* scene, int32_t index, halflit_instance* instance) {
    return reading(__func__, scene, {{instance, "instance"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.instances.size(), scene->free_instances, "instance");
        if (!at) return tl::unexpected<Error>(at.error());
        halflit_instance found = to_c(scene->world.out(scene->scene.instances[*at]));
        if (*at < scene->node_of_instance.size()) found.node = scene->node_of_instance[*at];
        return write_struct(found, instance, "halflit_instance");
    });
}

int32_t halflit_scene_get_node(const halflit_scene* scene, int32_t index, halflit_node* node) {
    return reading(__func__, scene, {{node, "node"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->nodes.size(), "node");
        if (!at) return tl::unexpected<Error>(at.error());
        const Node& from = scene->nodes[*at];
        const halflit_node found{sizeof(halflit_node), from.name.c_str(), from.instances.data(), count_of(from.instances), from.parent,
                                 from.camera,          from.light};
        return write_struct(found, node, "halflit_node");
    });
}

namespace {

/// The name of a part that has one; of others, its index is checked.
Result<std::string*> name_of(halflit_scene& scene, std::int32_t part, std::int32_t index) {
    const FreePlaces none;
    const auto of = [&](auto& list, const char* thing, const FreePlaces& free) -> Result<std::string*> {
        const auto at = check_index(index, list.size(), free, thing);
        if (!at) return tl::unexpected<Error>(at.error());
        return &list[*at].name;
    };
    switch (part) {
        case HALFLIT_PART_NODE:
            return of(scene.nodes, "node", none);
        case HALFLIT_PART_MESH:
            return of(scene.scene.meshes, "mesh", scene.free_meshes);
        case HALFLIT_PART_MATERIAL:
            return of(scene.scene.materials, "material", none);
        case HALFLIT_PART_CAMERA:
            return of(scene.scene.cameras, "camera", none);
        case HALFLIT_PART_INSTANCE: {
            const auto at = check_index(index, scene.scene.instances.size(), scene.free_instances, "instance");
            if (!at) return tl::unexpected<Error>(at.error());
            if (const auto own = scene.instance_names.find(*at); own != scene.instance_names.end()) return &own->second;
            if (*at < scene.node_of_instance.size() && scene.node_of_instance[*at] >= 0)
                return &scene.nodes[static_cast<std::size_t>(scene.node_of_instance[*at])].name;
            return nullptr;
        }
        default:
            return fail(ErrorCode::usage, "part: " + std::to_string(part) + " is no HALFLIT_PART");
    }
}

}  // namespace

int32_t halflit_scene_get_name(const halflit_scene* scene, int32_t part, int32_t index, const char** name) {
    return reading(__func__, scene, {{name, "name"}}, [&]() -> Result<void> {
        const auto found = name_of(const_cast<halflit_scene&>(*scene), part, index);  // which changes nothing
        if (!found) return tl::unexpected<Error>(found.error());
        *name = *found != nullptr ? (*found)->c_str() : "";
        return {};
    });
}

int32_t halflit_scene_set_name(halflit_scene* scene, int32_t part, int32_t index, const char* name) {
    return changing(__func__, scene, {{name, "name"}}, [&]() -> Result<void> {
        if (part != HALFLIT_PART_INSTANCE && part != HALFLIT_PART_MESH && part != HALFLIT_PART_MATERIAL)
            return fail(ErrorCode::usage, "part: expected an instance, a mesh or a material");
        const auto found = name_of(*scene, part, index);
        if (!found) return tl::unexpected<Error>(found.error());
        if (part == HALFLIT_PART_INSTANCE)
            scene->instance_names.insert_or_assign(static_cast<std::size_t>(index), name);
        else
            **found = name;
        return {};
    });
}

int32_t halflit_scene_get_light(const halflit_scene* scene, int32_t index, halflit_light* light) {
    return reading(__func__, scene, {{light, "light"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.lights.size(), scene->free_lights, "light");
        if (!at) return tl::unexpected<Error>(at.error());
        return write_struct(to_c(scene->world.out(scene->scene.lights[*at])), light, "halflit_light");
    });
}

int32_t halflit_scene_get_camera(const halflit_scene* scene, int32_t index, halflit_camera* camera) {
    return reading(__func__, scene, {{camera, "camera"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.cameras.size(), "camera");
        if (!at) return tl::unexpected<Error>(at.error());
        const CallersCamera found_camera = scene->world.out(scene->scene.cameras[*at]);
        halflit_camera found = to_c(found_camera);
        found.name = scene->scene.cameras[*at].name.c_str();  // valid as long as the scene
        return write_struct(found, camera, "halflit_camera");
    });
}
