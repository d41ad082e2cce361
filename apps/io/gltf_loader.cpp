#include "halflit/gltf.hpp"

#include "apps/io/detail/gltf_accessor.hpp"
#include "apps/io/detail/gltf_animation.hpp"
#include "apps/io/detail/gltf_choices.hpp"
#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_glossiness.hpp"
#include "apps/io/detail/gltf_images.hpp"
#include "apps/io/detail/gltf_materials.hpp"
#include "apps/io/detail/gltf_meshes.hpp"
#include "apps/io/detail/gltf_motion.hpp"
#include "apps/io/detail/gltf_nodes.hpp"
#include "apps/io/detail/gltf_placed.hpp"
#include "apps/io/detail/gltf_world.hpp"
#include "apps/io/detail/uri.hpp"
#include "apps/io/file_access.hpp"
#include "apps/io/model_files.hpp"
#include "apps/io/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <memory>
#include <set>

namespace halflit {

using namespace io;

namespace {

using namespace io::detail;

/// The places where the files may lie that buffers and images name, drawn or not, there or not.
std::vector<std::string> files_of(const Document& document) {
    std::set<std::string_view> uris;
    for (const file::Buffer& buffer : document.file.buffers)
        if (buffer.uri && !is_data_uri(*buffer.uri)) uris.insert(*buffer.uri);
    for (const file::Image& image : document.file.images)
        if (image.uri && !is_data_uri(*image.uri)) uris.insert(*image.uri);
    std::vector<std::string> files;
    for (const std::string_view uri : uris) {
        const Result<std::string> name = decode_file_uri(uri);
        if (!name) continue;
        for (std::string& path : document.folder.places(*name)) files.push_back(std::move(path));
    }
    return files;
}

LoadedScene build(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
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
    const std::shared_ptr<Motion> motion = options.keep_animations ? std::make_shared<Motion>(document->file, tree) : nullptr;
    for (const Animation& animation : animations)
        if (animation.index == loaded.animation) apply(animation, options.time_s, document->file);
    place_nodes(document->file, tree);
    loaded.nodes = make_nodes(*document, tree);
    ImageStore images(*document, loaded.scene.textures);
    loaded.scene.materials = make_materials(*document, images, find_used_materials(*document, tree));
    images.start();
    try {
        place_meshes(*document, accessors, tree, loaded, motion.get());
        std::vector<Mat4> in_file;
        for (const Instance& instance : loaded.scene.instances) in_file.push_back(instance.world_from_object);
        set_thickness(document->file, loaded.scene, in_file);
        const std::vector<double> mesh_scales = recentre(*document, tree, loaded);
        place_cameras(*document, tree, loaded);
        place_lights(*document, tree, loaded);
        if (motion) motion->finish(loaded, std::move(animations), document->animations.hides, mesh_scales);
        loaded.motion = motion;
    } catch (...) {
        images.finish();  // a fault of a picture is reported first
        throw;
    }
    images.finish();
    convert_specular_glossiness(*document, loaded.scene);
    for (const int original : document->unlit_copies) {
        std::vector<Material>& materials = loaded.scene.materials;
        Material copy = original < 0 ? Material{} : materials[static_cast<std::size_t>(original)];
        copy.unlit = true;
        if (motion && original >= 0) motion->add_copy(original, static_cast<int>(materials.size()));
        materials.push_back(std::move(copy));
    }
    loaded.scene.calibrated = loaded.scene.lights.empty();
    if (loaded.scene.instances.empty()) document->warn("the model has nothing to draw");
    loaded.warnings = document->take_warnings();
    loaded.info = std::move(document->info);
    loaded.info.files = files_of(*document);
    return loaded;
}

}  // namespace

std::vector<std::string> io::files_of_gltf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    return files_of(*open_document(bytes, base_dir, options));
}

Result<LoadedScene> load_gltf_bytes(std::span<const std::byte> bytes, const std::string& name, const std::string& base_dir,
                                    const LoadOptions& options) {
    return errors_of(name, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        check_threads(options);
        return build(bytes, base_dir, options);
    });
}

Result<LoadedScene> load_gltf(const std::string& path, const LoadOptions& options) {
    return errors_of(path, options.limits.time_limit_s, [&]() -> Result<LoadedScene> {
        const auto bytes = read_file(path, options.limits.max_file_bytes);
        if (!bytes) return tl::unexpected(bytes.error());
        return load_gltf_bytes(*bytes, path, folder_of(path), options);
    });
}

}  // namespace halflit
