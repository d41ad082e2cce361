// Functions of halflit.h that add a model's file to a scene.
#include "apps/c/convert.hpp"
#include "apps/c/placing.hpp"
#include "apps/c/scene_access.hpp"

#include <halflit/model.hpp>

#include <algorithm>
#include <utility>

namespace halflit::c {
namespace {

constexpr double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// world_from_file: takes what a file has, in its own coordinates, into the scene's.
class FilePlace {
public:
    explicit FilePlace(const Placing& matrix) : matrix_(matrix) {}
    [[nodiscard]] Vec3d direction(Vec3d v) const { return (matrix_.axes[0] * v.x + matrix_.axes[1] * v.y) + matrix_.axes[2] * v.z; }
    [[nodiscard]] Vec3d point(Vec3d p) const { return direction(p) + matrix_.place; }
    /// The vector with length 1, for cameras and lights, which have no scale.
    [[nodiscard]] Vec3d unit(Vec3d v) const {
        const Vec3d turned = direction(v);
        const double size = length(turned);
        return size > 0.0 ? turned * (1.0 / size) : v;
    }

private:
    Placing matrix_;
};

Vec3d column(const Mat4& m, int i) { return {m.c[i].x, m.c[i].y, m.c[i].z}; }
Vec4f column(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0}; }

int shifted(int index, std::size_t by) { return index < 0 ? index : index + static_cast<int>(by); }

/// The point in float32 and the rest.
void put(Vec3d p, Vec4f& coarse, Vec3d& rest) {
    coarse = column(p);
    coarse.w = 1;
    rest = p - Vec3d{coarse.x, coarse.y, coarse.z};
}

/// Adds what was loaded. Everything goes through both worlds, so that numbers are the file's.
class Adder {
public:
    Adder(halflit_scene& to, LoadedScene& from, const FilePlace& at) : to_(to), from_(from), at_(at), own_(from.placement) {}

    Result<void> add(std::optional<UpAxis> up) {
        const Scene& scene = to_.scene;
        const bool is_first = scene.meshes.empty() && scene.instances.empty() && scene.lights.empty() && scene.cameras.empty();
        if (up && (!is_first || to_.up_is_set) && *up != to_.world.placement().up)
            return fail(ErrorCode::usage, "up: expected none, or that of the scene, to which the file is added");
        if (is_first && !to_.up_is_set) {
            Placement placement = from_.placement;
            placement.mesh_scales.clear();
            to_.world = World(std::move(placement));
        }
        if (is_first) to_.scene.faces_back = from_.scene.faces_back;
        if (is_first || scene.frame_work > 0) to_.scene.frame_work += from_.scene.frame_work;
        if (scene.lights.empty()) to_.scene.calibrated = from_.scene.calibrated;
        to_.changes.structure();
        add_geometry();
        add_views();
        add_nodes();
        to_.warnings.insert(to_.warnings.end(), from_.warnings.begin(), from_.warnings.end());
        return {};
    }

private:
    void add_geometry() {
        Scene& scene = to_.scene;
        const std::size_t materials = scene.materials.size(), textures = scene.textures.size(), meshes = scene.meshes.size();
        std::move(from_.scene.textures.begin(), from_.scene.textures.end(), std::back_inserter(scene.textures));
        for (Material& material : from_.scene.materials) {
            for (TextureUse& use : material.textures) use.texture = shifted(use.texture, textures);
            scene.materials.push_back(std::move(material));
        }
        for (std::size_t i = 0; i < from_.scene.meshes.size(); ++i) {
            Mesh& mesh = from_.scene.meshes[i];
            mesh.material = shifted(mesh.material, materials);
            if (i < from_.placement.mesh_scales.size()) to_.world.set_mesh_scale(meshes + i, from_.placement.mesh_scales[i]);
            scene.meshes.push_back(std::move(mesh));
        }
        instances_ = scene.instances.size();
        for (const Instance& drawn : from_.scene.instances) {
            const CallersInstance in_file = own_.out(drawn);
            const Mat4& m = in_file.instance.world_from_object;
            Instance added = drawn;
            added.mesh = shifted(drawn.mesh, meshes), added.material = shifted(drawn.material, materials);
            const Placing placing{{at_.direction(column(m, 0)), at_.direction(column(m, 1)), at_.direction(column(m, 2))},
                                  at_.point(column(m, 3) + in_file.rest)};
            added.world_from_object = to_.world.into(placing, added.mesh);
            scene.instances.push_back(added);
        }
    }

    void add_views() {
        Scene& scene = to_.scene;
        lights_ = scene.lights.size(), cameras_ = scene.cameras.size();
        for (const Light& drawn : from_.scene.lights) {
            CallersLight in_file = own_.out(drawn);
            Light& light = in_file.light;
            Vec4f place{};
            put(at_.point(Vec3d{light.position_ws.x, light.position_ws.y, light.position_ws.z} + in_file.rest), place, in_file.rest);
            light.position_ws = {place.x, place.y, place.z};
            const Vec4f way = column(at_.unit({light.direction_ws.x, light.direction_ws.y, light.direction_ws.z}));
            light.direction_ws = {way.x, way.y, way.z};
            scene.lights.push_back(to_.world.into(in_file));
        }
        for (const Camera& drawn : from_.scene.cameras) {
            CallersCamera in_file = own_.out(drawn);
            Mat4& m = in_file.camera.world_from_camera;
            const Vec3d place = at_.point(column(m, 3) + in_file.rest);
            for (int i = 0; i < 3; ++i) m.c[i] = column(at_.unit(column(m, i)));
            put(place, m.c[3], in_file.rest);
            scene.cameras.push_back(to_.world.into(in_file));
        }
    }

    void add_nodes() {
        const std::size_t nodes = to_.nodes.size();
        to_.node_of_instance.resize(instances_, -1);
        for (const int node : from_.node_of_instance) to_.node_of_instance.push_back(shifted(node, nodes));
        for (Node& node : from_.nodes) {
            node.parent = shifted(node.parent, nodes);
            node.camera = shifted(node.camera, cameras_), node.light = shifted(node.light, lights_);
            node.instances.clear();
            to_.nodes.push_back(std::move(node));
        }
        to_.list_instances_of_nodes();
    }

    halflit_scene& to_;
    LoadedScene& from_;
    const FilePlace& at_;
    World own_;
    std::size_t instances_ = 0, lights_ = 0, cameras_ = 0;
};

/// load(how) loads the file.
template <class Load>
std::int32_t add_file(const char* function, halflit_scene* scene, std::initializer_list<Pointer> pointers,
                      const halflit_load_options* options, const double* world_from_file, int32_t* first, int32_t* count,
                      const Load& load) {
    return changing(function, scene, pointers, [&]() -> Result<void> {
        const auto how = load_options(options);
        if (!how) return tl::unexpected<Error>(how.error());
        if (how->keep_animations) return fail(ErrorCode::usage, "keep_animations: expected 0 for a file that is added");
        const auto place = read_placing(world_from_file != nullptr ? world_from_file : kIdentity);
        if (!place) return tl::unexpected<Error>(place.error());
        auto loaded = load(*how);
        if (!loaded) return tl::unexpected<Error>(loaded.error());
        const std::size_t before = scene->scene.instances.size();
        const FilePlace at(*place);
        if (auto ok = Adder(*scene, *loaded, at).add(how->up); !ok) return ok;
        tell(before, first);
        tell(scene->scene.instances.size() - before, count);
        return {};
    });
}

}  // namespace
}  // namespace halflit::c

using namespace halflit;
using namespace halflit::c;

int32_t halflit_scene_add_file(halflit_scene* scene, const char* path, const halflit_load_options* options, const double* world_from_file,
                               int32_t* first, int32_t* count) {
    return add_file(__func__, scene, {{path, "path"}}, options, world_from_file, first, count,
                    [&](const LoadOptions& how) { return load_model(path, how); });
}

int32_t halflit_scene_add_file_memory(halflit_scene* scene, const void* bytes, size_t byte_count, const char* name, const char* base_dir,
                                      const halflit_load_options* options, const double* world_from_file, int32_t* first, int32_t* count) {
    return add_file(__func__, scene, {{bytes, "bytes"}, {name, "name"}}, options, world_from_file, first, count,
                    [&](const LoadOptions& how) {
                        const std::span<const std::byte> file(static_cast<const std::byte*>(bytes), byte_count);
                        return load_model_bytes(file, name, base_dir != nullptr ? base_dir : "", how);
                    });
}
