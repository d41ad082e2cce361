// Functions of halflit.h that add and change materials, textures, meshes and instances.
#include "apps/c/convert.hpp"
#include "apps/c/convert_parts.hpp"
#include "apps/c/placing.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/versioned.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

using namespace halflit;
using namespace halflit::c;

namespace {

constexpr std::size_t kMostInstances = 0x7fffffff;

Result<Texture> make_texture(const std::uint8_t* rgba8, std::int32_t width, std::int32_t height, std::size_t row_bytes,
                             std::int32_t color) {
    const auto read = texture_color(color);
    if (!read) return tl::unexpected<Error>(read.error());
    if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide)
        return fail(ErrorCode::usage, "texture: " + std::to_string(width) + " x " + std::to_string(height) + " pixels, expected 1 to " +
                                          std::to_string(kMaxTextureSide) + " on a side");
    const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    if (row_bytes != 0 && row_bytes < row)
        return fail(ErrorCode::usage,
                    "texture: row_bytes is " + std::to_string(row_bytes) + ", expected 0 or at least " + std::to_string(row));
    if (row_bytes == 0 || row_bytes == row) return Texture::from_rgba8({rgba8, row * rows}, width, height, read->space, read->rule);
    std::vector<std::uint8_t> packed(row * rows);
    for (std::size_t y = 0; y < rows; ++y) std::memcpy(packed.data() + y * row, rgba8 + y * row_bytes, row);
    return Texture::from_rgba8(packed, width, height, read->space, read->rule);
}

Result<Material> make_material(const halflit_scene& to, const halflit_material* given) {
    auto made = material(given);
    if (!made) return made;
    for (const TextureUse& use : made->textures)
        if (use.used())
            if (const auto at = check_index(use.texture, to.scene.textures.size(), to.free_textures, "halflit_material: texture"); !at)
                return tl::unexpected<Error>(at.error());
    return made;
}

/// Whether a mesh, whose struct was read before, asks for smooth normals.
bool is_smooth(const halflit_mesh* given) { return read_struct(given, default_mesh(), "halflit_mesh")->smooth != 0; }

/// Where a matrix, of floats or doubles, places an instance of a mesh, in the world that is drawn.
template <class Number>
Result<Mat4> placing(const halflit_scene& to, const Number m[16], int mesh, Vec3d rest = {0, 0, 0}) {
    const auto read = read_placing(m, rest);
    if (!read) return tl::unexpected<Error>(read.error());
    return to.world.into(*read, mesh);
}

/// mesh_of(i): the mesh that the i-th matrix places.
template <class Number, class MeshOf>
Result<std::vector<Mat4>> all_placing(const halflit_scene& to, const Number* matrices, std::int32_t count, const MeshOf& mesh_of) {
    std::vector<Mat4> places;
    places.reserve(static_cast<std::size_t>(count));
    for (std::int32_t i = 0; i < count; ++i) {
        const auto place = placing(to, matrices + 16 * static_cast<std::size_t>(i), mesh_of(i));
        if (!place) return fail(place.error().code, "matrix " + std::to_string(i) + ": " + place.error().message);
        places.push_back(*place);
    }
    return places;
}

/// An instance whose indices are in the scene.
Result<Instance> make_instance(const halflit_scene& to, const halflit_instance* given) {
    const auto read = instance(given);
    if (!read) return tl::unexpected<Error>(read.error());
    Instance made = read->instance;
    if (const auto at = check_index(made.mesh, to.scene.meshes.size(), to.free_meshes, "halflit_instance: mesh"); !at)
        return tl::unexpected<Error>(at.error());
    if (made.material != -1)
        if (const auto at = check_index(made.material, to.scene.materials.size(), "halflit_instance: material"); !at)
            return tl::unexpected<Error>(at.error());
    float matrix[16];
    put(made.world_from_object, matrix);
    const auto place = placing(to, matrix, made.mesh, read->rest);
    if (!place) return tl::unexpected<Error>(place.error());
    made.world_from_object = *place;
    return made;
}

/// Copies an array of T, each made of floats alone; a null pointer gives an empty one.
template <class T>
std::vector<T> copied(const float* from, std::size_t count) {
    if (from == nullptr || count == 0) return {};
    std::vector<T> values(count);
    std::memcpy(static_cast<void*>(values.data()), from, count * sizeof(T));
    return values;
}

/// Gaussians around `count` positions.
Result<Splats> make_splats(const halflit_splats* pointer, std::size_t count) {
    const auto given = read_struct(pointer, default_splats(), "halflit_splats");
    if (!given) return tl::unexpected<Error>(given.error());
    Splats made;
    Members members("halflit_splats");
    members.read(given->degree, 4, "degree", made.degree);
    members.read(given->reference, SplatReference::mip, "reference", made.reference);
    made.linear_light = given->linear_light != 0;
    const auto channels = harmonics_per_splat(made.degree);
    const std::pair<const float*, const char*> arrays[] = {
        {given->rotations, "rotations"}, {given->scales, "scales"}, {given->opacities, "opacities"}, {given->harmonics, "harmonics"}};
    for (const auto& [array, name] : arrays)
        if (array == nullptr && count > 0) members.wrong(name, "is null");
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    made.rotations = copied<Vec4f>(given->rotations, count);
    made.scales = copied<Vec3f>(given->scales, count);
    made.opacities = copied<float>(given->opacities, count);
    made.harmonics = copied<float>(given->harmonics, channels * count);
    return made;
}

Result<Mesh> make_mesh(const Scene& scene, const halflit_mesh* pointer) {
    const auto given = read_struct(pointer, default_mesh(), "halflit_mesh");
    if (!given) return tl::unexpected<Error>(given.error());
    const std::size_t count = given->vertex_count;
    const auto faulty = [](ErrorCode code, std::string what) { return fail(code, "halflit_mesh: " + std::move(what)); };
    if (given->positions == nullptr && count > 0) return faulty(ErrorCode::usage, "positions is null");
    if (given->indices == nullptr && given->index_count > 0) return faulty(ErrorCode::usage, "indices is null, but index_count is not 0");
    if (count > 0x7fffffffu || given->index_count > std::size_t{3} << 28)
        return faulty(ErrorCode::limit, "more than 2^31 vertices or 2^28 triangles");
    const std::size_t corners = given->indices != nullptr ? given->index_count : count;
    Topology topology{};
    Members members("halflit_mesh");
    members.read(given->topology, Topology::points, "topology", topology);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    if (const std::size_t each = corners_of(topology); corners % each != 0)
        return faulty(ErrorCode::bad_input, std::to_string(corners) + " corners, expected " + std::to_string(each) + " for each " +
                                                (topology == Topology::triangles ? "triangle" : "line"));
    if (given->material != -1)
        if (const auto at = check_index(given->material, scene.materials.size(), "halflit_mesh: material"); !at)
            return tl::unexpected<Error>(at.error());
    Mesh mesh;
    if (given->name != nullptr) mesh.name = given->name;
    mesh.positions = copied<Vec3f>(given->positions, count);
    mesh.normals = copied<Vec3f>(given->normals, count);
    mesh.tangents = copied<Vec4f>(given->tangents, count);
    mesh.uv0 = copied<Vec2f>(given->uv0, count);
    mesh.uv1 = copied<Vec2f>(given->uv1, count);
    mesh.colors = copied<Vec4f>(given->colors, count);
    mesh.material = given->material;
    mesh.topology = topology;
    mesh.indices.resize(corners);
    if (given->indices == nullptr) {
        std::iota(mesh.indices.begin(), mesh.indices.end(), 0u);
    } else if (corners > 0) {
        std::copy(given->indices, given->indices + corners, mesh.indices.begin());
        const std::uint32_t largest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
        if (largest >= count)
            return faulty(ErrorCode::bad_input,
                          "index " + std::to_string(largest) + ", but the number of vertices is " + std::to_string(count));
    }
    if (given->splats == nullptr) return mesh;
    if (topology != Topology::points || given->normals || given->tangents || given->uv0 || given->uv1 || given->colors || given->indices)
        return faulty(ErrorCode::usage, "splats: expected points without other arrays");
    auto splats = make_splats(given->splats, count);
    if (!splats) return tl::unexpected<Error>(splats.error());
    Mesh made = make_splat_mesh(std::move(mesh.positions), std::move(*splats));
    made.name = std::move(mesh.name), made.material = mesh.material;
    return made;
}

}  // namespace

// ---- textures and materials --------------------------------------------------------------------------------------------

int32_t halflit_scene_add_texture(halflit_scene* scene, const uint8_t* rgba8, int32_t width, int32_t height, size_t row_bytes,
                                  int32_t color, int32_t* index) {
    return changing(__func__, scene, {{rgba8, "rgba8"}}, [&]() -> Result<void> {
        auto made = make_texture(rgba8, width, height, row_bytes, color);
        if (!made) return tl::unexpected<Error>(made.error());
        scene->changes.materials();
        const std::size_t at = scene->free_textures.next(scene->scene.textures.size());
        if (at == scene->scene.textures.size()) scene->scene.textures.emplace_back();
        scene->scene.textures[at] = std::move(*made);
        scene->free_textures.fill(at);
        tell(at, index);
        return {};
    });
}

int32_t halflit_scene_set_texture(halflit_scene* scene, int32_t index, const uint8_t* rgba8, int32_t width, int32_t height,
                                  size_t row_bytes, int32_t color) {
    return changing(__func__, scene, {{rgba8, "rgba8"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.textures.size(), scene->free_textures, "texture");
        if (!at) return tl::unexpected<Error>(at.error());
        auto made = make_texture(rgba8, width, height, row_bytes, color);
        if (!made) return tl::unexpected<Error>(made.error());
        scene->changes.materials();
        scene->scene.textures[*at] = std::move(*made);
        return {};
    });
}

int32_t halflit_lobe_by_name(const char* name, float wrap, halflit_lobe* lobe) {
    return guarded(__func__, {{name, "name"}, {lobe, "lobe"}}, [&]() -> Result<void> {
        const NamedLobe* found = find_named_lobe(name);
        if (found == nullptr) return fail(ErrorCode::usage, "lobe: " + std::string(name) + ", expected " + lobe_names());
        const float w = found->takes_wrap ? wrap : found->wrap;
        const Lobe made{w, found->power + found->power_per_wrap * w, found->normalize};
        if (auto ok = check_lobe(made); !ok) return fail(ErrorCode::usage, "lobe: " + ok.error().message);
        *lobe = {made.wrap, made.power, made.normalize};
        return {};
    });
}

int32_t halflit_material_init(halflit_material* material, size_t size) {
    return guarded(__func__, {{material, "material"}}, [&] {
        halflit_material defaults = to_c(Material{});
        defaults.name = nullptr;
        return write_struct(defaults, size, material, "halflit_material");
    });
}

int32_t halflit_scene_add_material(halflit_scene* scene, const halflit_material* material, int32_t* index) {
    return changing(__func__, scene, {{material, "material"}}, [&]() -> Result<void> {
        auto made = make_material(*scene, material);
        if (!made) return tl::unexpected<Error>(made.error());
        scene->changes.structure();
        scene->scene.materials.push_back(std::move(*made));
        tell(scene->scene.materials.size() - 1, index);
        return {};
    });
}

int32_t halflit_scene_set_material(halflit_scene* scene, int32_t index, const halflit_material* material) {
    return changing(__func__, scene, {{material, "material"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.materials.size(), "material");
        if (!at) return tl::unexpected<Error>(at.error());
        auto made = make_material(*scene, material);
        if (!made) return tl::unexpected<Error>(made.error());
        scene->changes.materials();
        scene->scene.materials[*at] = std::move(*made);
        scene->complete_meshes_of(*at);
        return {};
    });
}

// ---- meshes and instances ----------------------------------------------------------------------------------------------

int32_t halflit_splats_init(halflit_splats* splats, size_t size) {
    return guarded(__func__, {{splats, "splats"}}, [&] { return write_struct(default_splats(), size, splats, "halflit_splats"); });
}

int32_t halflit_mesh_init(halflit_mesh* mesh, size_t size) {
    return guarded(__func__, {{mesh, "mesh"}}, [&] { return write_struct(default_mesh(), size, mesh, "halflit_mesh"); });
}

int32_t halflit_scene_add_mesh(halflit_scene* scene, const halflit_mesh* mesh, int32_t* index) {
    return changing(__func__, scene, {{mesh, "mesh"}}, [&]() -> Result<void> {
        auto made = make_mesh(scene->scene, mesh);
        if (!made) return tl::unexpected<Error>(made.error());
        const std::size_t at = scene->free_meshes.next(scene->scene.meshes.size());
        if (at == scene->scene.meshes.size())
            scene->changes.structure();
        else
            scene->changes.mesh(at);
        scene->world.forget_mesh_scale(at);
        scene->put_given_mesh(at, std::move(*made), is_smooth(mesh));
        scene->free_meshes.fill(at);
        tell(at, index);
        return {};
    });
}

int32_t halflit_scene_set_mesh(halflit_scene* scene, int32_t index, const halflit_mesh* mesh) {
    return changing(__func__, scene, {{mesh, "mesh"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.meshes.size(), scene->free_meshes, "mesh");
        if (!at) return tl::unexpected<Error>(at.error());
        auto made = make_mesh(scene->scene, mesh);
        if (!made) return tl::unexpected<Error>(made.error());
        scene->world.into(*made, *at);
        scene->changes.mesh(*at);
        scene->put_given_mesh(*at, std::move(*made), is_smooth(mesh));
        return {};
    });
}

int32_t halflit_scene_set_vertices(halflit_scene* scene, int32_t index, const float* positions, const float* normals, size_t vertex_count) {
    return changing(__func__, scene, {{positions, "positions"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.meshes.size(), scene->free_meshes, "mesh");
        if (!at) return tl::unexpected<Error>(at.error());
        if (*at < scene->file_meshes)
            return fail(ErrorCode::usage,
                        "mesh " + std::to_string(index) + ": comes from a file, and the caller does not know its vertices");
        const auto given = scene->given_meshes.find(*at);
        Mesh mesh = given != scene->given_meshes.end() ? given->second : scene->scene.meshes[*at];
        if (mesh.splats != nullptr)
            return fail(ErrorCode::usage, "mesh " + std::to_string(index) + ": has Gaussians, which are replaced with all their arrays");
        if (vertex_count != mesh.positions.size())
            return fail(ErrorCode::usage, "mesh " + std::to_string(index) + ": " + std::to_string(vertex_count) + " vertices, expected " +
                                              std::to_string(mesh.positions.size()));
        mesh.positions = copied<Vec3f>(positions, vertex_count);
        scene->world.into(mesh, *at);
        const auto without = scene->added_without_normals.find(*at);
        if (normals != nullptr) {
            mesh.normals = copied<Vec3f>(normals, vertex_count);
            scene->added_without_normals.erase(*at);
        } else if (without != scene->added_without_normals.end()) {
            mesh.normals.clear();
            if (without->second) generate_smooth_normals(mesh);
        }
        scene->changes.mesh(*at);
        scene->put_mesh(*at, std::move(mesh));
        return {};
    });
}

int32_t halflit_scene_remove_mesh(halflit_scene* scene, int32_t index) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.meshes.size(), scene->free_meshes, "mesh");
        if (!at) return tl::unexpected<Error>(at.error());
        const std::vector<Instance>& instances = scene->scene.instances;
        for (std::size_t i = 0; i < instances.size(); ++i)
            if (instances[i].mesh == index && !scene->free_instances.has(i))
                return fail(ErrorCode::usage, "mesh " + std::to_string(index) + ": instance " + std::to_string(i) + " places it");
        scene->changes.mesh(*at);
        scene->put_given_mesh(*at, Mesh{}, false);
        scene->free_meshes.add(*at);
        return {};
    });
}

int32_t halflit_scene_remove_texture(halflit_scene* scene, int32_t index) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.textures.size(), scene->free_textures, "texture");
        if (!at) return tl::unexpected<Error>(at.error());
        const std::vector<Material>& materials = scene->scene.materials;
        for (std::size_t i = 0; i < materials.size(); ++i)
            for (const TextureUse& use : materials[i].textures)
                if (use.texture == index)
                    return fail(ErrorCode::usage, "texture " + std::to_string(index) + ": material " + std::to_string(i) + " uses it");
        scene->changes.materials();
        scene->scene.textures[*at] = {};
        scene->free_textures.add(*at);
        return {};
    });
}

// ---- instances ---------------------------------------------------------------------------------------------------------

int32_t halflit_instance_init(halflit_instance* instance, size_t size) {
    return guarded(__func__, {{instance, "instance"}},
                   [&] { return write_struct(to_c(CallersInstance{}), size, instance, "halflit_instance"); });
}

int32_t halflit_scene_add_instance(halflit_scene* scene, int32_t mesh, const float world_from_object[16], int32_t* index) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        if (const auto at = check_index(mesh, scene->scene.meshes.size(), scene->free_meshes, "mesh"); !at)
            return tl::unexpected<Error>(at.error());
        const Mat4 identity;
        float matrix[16];
        put(identity, matrix);
        const auto place = placing(*scene, world_from_object != nullptr ? world_from_object : matrix, mesh);
        if (!place) return tl::unexpected<Error>(place.error());
        const std::size_t at = scene->free_instances.next(scene->scene.instances.size());
        scene->put_instance(at, {mesh, *place});
        scene->free_instances.fill(at);
        tell(at, index);
        return {};
    });
}

namespace {

template <class Number>
std::int32_t add_instances(const char* function, halflit_scene* scene, std::int32_t mesh, std::int32_t count, const Number* matrices,
                           std::int32_t* first) {
    return changing(function, scene, {{matrices, "world_from_object"}}, [&]() -> Result<void> {
        if (const auto at = check_index(mesh, scene->scene.meshes.size(), scene->free_meshes, "mesh"); !at)
            return tl::unexpected<Error>(at.error());
        std::vector<Instance>& instances = scene->scene.instances;
        if (count < 0 || static_cast<std::size_t>(count) > kMostInstances - std::min(instances.size(), kMostInstances))
            return fail(ErrorCode::usage, "count: " + std::to_string(count) + ", expected 0 or more, and at most 2^31 - 1 instances");
        const auto places = all_placing(*scene, matrices, count, [mesh](std::int32_t) { return mesh; });
        if (!places) return tl::unexpected<Error>(places.error());
        const std::size_t begin = instances.size();
        if (count > 0) scene->changes.structure();
        instances.reserve(begin + places->size());
        for (const Mat4& place : *places) instances.push_back({mesh, place});
        tell(begin, first);
        return {};
    });
}

template <class Number>
std::int32_t place_instances(const char* function, halflit_scene* scene, const std::int32_t* indices, std::int32_t count,
                             const Number* matrices) {
    return changing(function, scene, {{matrices, "world_from_object"}}, [&]() -> Result<void> {
        if (count < 0) return fail(ErrorCode::usage, "count: " + std::to_string(count) + ", expected 0 or more");
        std::vector<Instance>& instances = scene->scene.instances;
        const auto index_of = [&](std::int32_t i) { return indices != nullptr ? indices[i] : i; };
        const auto instance_of = [&](std::int32_t i) -> Instance& { return instances[static_cast<std::size_t>(index_of(i))]; };
        for (std::int32_t i = 0; i < count; ++i)
            if (const auto at = check_index(index_of(i), instances.size(), scene->free_instances, "instance"); !at)
                return tl::unexpected<Error>(at.error());
        const auto places = all_placing(*scene, matrices, count, [&](std::int32_t i) { return instance_of(i).mesh; });
        if (!places) return tl::unexpected<Error>(places.error());
        for (std::int32_t i = 0; i < count; ++i) {
            scene->changes.instance(static_cast<std::size_t>(index_of(i)));
            instance_of(i).world_from_object = (*places)[static_cast<std::size_t>(i)];
        }
        return {};
    });
}

}  // namespace

int32_t halflit_scene_add_instances(halflit_scene* scene, int32_t mesh, int32_t count, const float* world_from_object, int32_t* first) {
    return add_instances(__func__, scene, mesh, count, world_from_object, first);
}

int32_t halflit_scene_add_instances_double(halflit_scene* scene, int32_t mesh, int32_t count, const double* world_from_object,
                                           int32_t* first) {
    return add_instances(__func__, scene, mesh, count, world_from_object, first);
}

int32_t halflit_scene_set_instance(halflit_scene* scene, int32_t index, const halflit_instance* given) {
    return changing(__func__, scene, {{given, "instance"}}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.instances.size(), scene->free_instances, "instance");
        if (!at) return tl::unexpected<Error>(at.error());
        auto made = make_instance(*scene, given);
        if (!made) return tl::unexpected<Error>(made.error());
        made->backdrop = scene->scene.instances[*at].backdrop;  // callers of C do not see it
        scene->put_instance(*at, *made);
        scene->complete_mesh_of(*made);
        return {};
    });
}

int32_t halflit_scene_place_instance(halflit_scene* scene, int32_t index, const float world_from_object[16]) {
    return halflit_scene_place_instances(scene, &index, 1, world_from_object);
}

int32_t halflit_scene_place_instances(halflit_scene* scene, const int32_t* indices, int32_t count, const float* world_from_object) {
    return place_instances(__func__, scene, indices, count, world_from_object);
}

int32_t halflit_scene_place_instances_double(halflit_scene* scene, const int32_t* indices, int32_t count, const double* world_from_object) {
    return place_instances(__func__, scene, indices, count, world_from_object);
}

int32_t halflit_scene_remove_instance(halflit_scene* scene, int32_t index) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        const auto at = check_index(index, scene->scene.instances.size(), scene->free_instances, "instance");
        if (!at) return tl::unexpected<Error>(at.error());
        scene->changes.instance(*at);
        scene->scene.instances[*at].visible = false;
        scene->scene.instances[*at].material = -1;  // which requires nothing of the mesh
        scene->instance_names.erase(*at);
        scene->free_instances.add(*at);
        return {};
    });
}

int32_t halflit_scene_add_ground(halflit_scene* scene, int32_t* instance) {
    return changing(__func__, scene, {}, [&]() -> Result<void> {
        scene->changes.structure();
        add_ground(scene->scene, scene_bounds(scene->scene));
        tell(scene->scene.instances.size() - 1, instance);
        return {};
    });
}
