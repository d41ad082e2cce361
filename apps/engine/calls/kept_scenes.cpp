#include "apps/engine/calls/kept_scenes.hpp"

#include "apps/engine/job/built_in_scenes.hpp"
#include "apps/io/gltf/build/pose_sources.hpp"
#include "apps/io/platform/files.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace halflit::engine {
namespace {

/// All that decides what is loaded. The limit of time decides whether it is.
LoadOptions key_of(LoadOptions options) {
    options.threads = 0, options.import_cache = false, options.limits.time_limit_s = 0.0;
    return options;
}

std::size_t bytes_of_scene(const Scene& scene) {
    constexpr std::size_t kTexelBytes = 11;  // with smaller levels
    std::uint64_t bytes = scene.instances.size() * sizeof(Instance) + scene.materials.size() * sizeof(Material);
    for (const Mesh& mesh : scene.meshes) bytes += sizeof mesh + io::detail::bytes_of(mesh);
    for (const Texture& texture : scene.textures)
        bytes += kTexelBytes * static_cast<std::uint64_t>(texture.width()) * static_cast<std::uint64_t>(texture.height());
    return static_cast<std::size_t>(bytes);
}

SceneSource copy_of(const SceneSource& source) {
    SceneSource copy = source;
    copy.scene = std::make_shared<Scene>(*source.scene);
    copy.parts = std::make_shared<Parts>(*source.parts);
    return copy;
}

}  // namespace

KeptScenes::FileState KeptScenes::state_of(const std::string& path) {
    platform::FileStatus status;
    if (platform::status_of(path, status) != 0) return {path};
    return {path, static_cast<std::int64_t>(status.bytes), status.changed_ns, status.id};
}

bool KeptScenes::is_fresh(const Kept& kept) {
    return std::all_of(kept.files.begin(), kept.files.end(), [](const FileState& file) { return state_of(file.path) == file; });
}

Result<SceneSource> KeptScenes::load(const ModelRequest& model) {
    kept_.remove_if([](const Kept& kept) { return !is_fresh(kept); });
    const LoadOptions key = key_of(model.load);
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.scene == model.scene && kept.load == key; });
    if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
        return copy_of(kept_.front().source);
    }
    std::vector<FileState> files{state_of(model.scene)};  // before it is read
    auto source = load_scene(model);
    if (!source || is_built_in_name(model.scene)) return source;
    const std::size_t bytes = bytes_of_scene(*source->scene);
    if (bytes > kMostBytes / 2) return source;
    if (source->file)
        for (const std::string& path : source->file->files) files.push_back(state_of(path));
    kept_.push_front({model.scene, key, std::move(files), copy_of(*source), bytes});
    std::size_t all = 0, scenes = 0;
    for (auto kept = kept_.begin(); kept != kept_.end();) {
        all += kept->bytes;
        kept = ++scenes > kMostScenes || all > kMostBytes ? kept_.erase(kept) : std::next(kept);
    }
    return source;
}

}  // namespace halflit::engine
