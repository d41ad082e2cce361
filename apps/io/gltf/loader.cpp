#include "halflit/gltf.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/gltf/animation/animation.hpp"
#include "apps/io/gltf/animation/motion.hpp"
#include "apps/io/gltf/build/choices.hpp"
#include "apps/io/gltf/build/glossiness.hpp"
#include "apps/io/gltf/build/images.hpp"
#include "apps/io/gltf/build/materials.hpp"
#include "apps/io/gltf/build/meshes.hpp"
#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/build/open.hpp"
#include "apps/io/gltf/build/placed.hpp"
#include "apps/io/gltf/build/world.hpp"
#include "apps/io/gltf/file/accessor.hpp"
#include "apps/io/gltf/file/document.hpp"
#include "apps/io/gltf/loader.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

namespace halflit {

using namespace io;

namespace {

using namespace io::detail;

/// Paths of all files that buffers and images name, whether or not they exist and are drawn.
std::vector<std::string> files_of(const Document& document) {
    std::set<std::string_view> uris;
    for (const file::Buffer& buffer : document.file.buffers)
        if (buffer.uri && !is_data_uri(*buffer.uri)) uris.insert(*buffer.uri);
    for (const file::Image& image : document.file.images)
        if (image.uri && !is_data_uri(*image.uri)) uris.insert(*image.uri);
    std::vector<std::string> files;
    for (const std::string_view uri : uris) {
        const Result<std::string> name = decode_file_uri(uri, !document.options.strict);
        if (!name) continue;
        for (std::string& path : document.folder.places(*name)) files.push_back(std::move(path));
    }
    return files;
}

}  // namespace

namespace {

/// True if the scene has instances, and none of them has a volume or an area: an animation may begin with the scale 0, or hide all.
bool has_no_size(const Scene& scene) {
    std::vector<bool> has_extent;  // of each mesh
    TimeCheck check;
    for (const Mesh& mesh : scene.meshes) {
        const auto differs = [&](std::uint32_t index) {
            check();
            return !(mesh.positions[index] == mesh.positions[mesh.indices[0]]);
        };
        has_extent.push_back(mesh.topology == Topology::points ? !mesh.indices.empty()
                                                               : std::any_of(mesh.indices.begin(), mesh.indices.end(), differs));
    }
    const auto is_flat = [&](const Instance& instance) {
        if (!has_extent[static_cast<std::size_t>(instance.mesh)]) return true;
        const Mat4& m = instance.world_from_object;
        const Vec3d xy = cross(axis(m, 0), axis(m, 1)), yz = cross(axis(m, 1), axis(m, 2)), zx = cross(axis(m, 2), axis(m, 0));
        return (dot(xy, xy) + dot(yz, yz)) + dot(zx, zx) == 0.0;
    };
    return !scene.instances.empty() && std::all_of(scene.instances.begin(), scene.instances.end(), is_flat);
}

LoadedScene read_at(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);

}  // namespace

LoadedScene io::detail::read_gltf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    const WorkLimit work(allowed_work(options.limits, bytes.size()));
    LoadedScene loaded = read_at(bytes, base_dir, options);
    loaded.info.exact.clear();  // a stranger's file may say anything
    if (options.strict || options.time_s != 0.0 || options.keep_animations || loaded.animation < 0 || !has_no_size(loaded.scene))
        return loaded;
    const double end_s = loaded.animations.at(static_cast<std::size_t>(loaded.animation)).end_s;
    for (const double share : {0.5, 1.0, 0.25}) {
        LoadOptions later = options;
        later.time_s = share * end_s;
        LoadedScene other = read_at(bytes, base_dir, later);
        if (has_no_size(other.scene)) continue;
        other.warnings.push_back(fmt::format("at the time 0 nothing has a size; drawn at {:g} s", later.time_s));
        return other;
    }
    if (!options.animation.empty()) return loaded;
    LoadOptions still = options;
    still.animation = "none";
    LoadedScene other = read_at(bytes, base_dir, still);
    if (has_no_size(other.scene)) return loaded;
    other.warnings.push_back(fmt::format("animations[{}]: hides all; drawn without it", loaded.animation));
    return other;
}

LoadedScene io::detail::read_imported(std::span<const std::byte> bytes, const LoadOptions& options) {
    const WorkLimit work(allowed_work(options.limits, bytes.size()));
    return read_at(bytes, "", options);
}

namespace {

LoadedScene read_at(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) try {
    check_threads(options);
    const std::unique_ptr<Document> document = open_document(bytes, base_dir, options);
    check_time();
    choose_scene(*document);
    choose_variant(*document);
    NodeTree tree = walk_nodes(*document);
    find_animations(*document);
    mark_below(tree, document->animations.hides);
    settle(*document, tree.drawn, tree.parent);
    load_buffers(*document);
    check_time();
    const std::vector<Accessor> accessors = check_accessors(*document);
    std::vector<Animation> animations = read_animations(*document, accessors);
    LoadedScene loaded;
    loaded.animations = describe_animations(document->file, animations);
    loaded.animation = document->animations.drawn;
    const std::shared_ptr<Motion> motion =
        options.keep_animations ? std::make_shared<Motion>(document->file, tree, options.recentre) : nullptr;
    for (const Animation& animation : animations)
        if (animation.index == loaded.animation) apply(animation, options.time_s, document->file);
    place_nodes(document->file, tree);
    loaded.nodes = make_nodes(*document, tree);
    ImageStore images(*document, loaded.scene.textures);
    loaded.scene.materials = make_materials(*document, images, find_used_materials(*document, tree));
    images.start();
    try {
        PoseSources sources;
        place_meshes(*document, accessors, tree, loaded, motion ? &sources : nullptr);
        std::vector<Mat4> in_file;
        for (const Instance& instance : loaded.scene.instances) in_file.push_back(instance.world_from_object);
        set_thickness(document->file, loaded.scene, in_file);
        place_scene(*document, options.up.value_or(UpAxis::y), tree, loaded);
        place_cameras(*document, tree, loaded);
        place_lights(*document, tree, loaded);
        if (motion) motion->finish(std::move(sources), loaded, std::move(animations), document->animations.hides);
        loaded.motion = motion;
    } catch (...) {
        images.finish(loaded.scene.materials);  // a fault of a picture is reported first
        throw;
    }
    images.finish(loaded.scene.materials);
    convert_specular_glossiness(*document, loaded.scene);
    for (const int original : document->unlit_copies) {
        std::vector<Material>& materials = loaded.scene.materials;
        Material copy = original < 0 ? Material{} : materials[static_cast<std::size_t>(original)];
        copy.unlit = true;
        if (motion && original >= 0) motion->add_copy(original, static_cast<int>(materials.size()));
        materials.push_back(std::move(copy));
    }
    if (!motion) make_visible(*document, loaded.scene);
    loaded.scene.calibrated = loaded.scene.lights.empty();
    loaded.scene.frame_work = document->allowed_work();
    const std::vector<std::string_view>& used = document->file.extensions_used;
    loaded.scene.faces_back = std::find(used.begin(), used.end(), "VRM") != used.end();  // VRM 0.x; avatars of VRM 1.0 face +z
    if (loaded.scene.instances.empty() && document->first_failure) throw LoadFailure{*document->first_failure};  // nothing is left
    if (loaded.scene.instances.empty()) document->warn("the model has nothing to draw");
    loaded.warnings = document->take_warnings();
    loaded.info = std::move(document->info);
    loaded.info.files = files_of(*document);
    return loaded;
} catch (LoadFailure& failure) {
    if (const std::size_t missing = missing_bytes(bytes); missing > 0 && failure.error.code == ErrorCode::bad_input)
        failure.error.message = fmt::format("is cut off, the last {} bytes are missing: {}", missing, failure.error.message);
    throw;
}

}  // namespace

std::vector<std::string> io::detail::files_of_gltf(std::span<const std::byte> bytes, const std::string& base_dir,
                                                   const LoadOptions& options) {
    return files_of(*open_document(bytes, base_dir, options));
}

Result<LoadedScene> load_gltf_bytes(std::span<const std::byte> bytes, const std::string& name, const std::string& base_dir,
                                    const LoadOptions& options) {
    return errors_of(name, options.limits.time_limit_s, [&]() -> Result<LoadedScene> { return read_gltf(bytes, base_dir, options); });
}

Result<LoadedScene> load_gltf(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return tl::unexpected(bytes.error());
        return load_gltf_bytes(*bytes, path, folder_of(path), options);
    });
}

}  // namespace halflit
